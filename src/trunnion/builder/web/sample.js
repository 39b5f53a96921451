// The sample program: what the definition makes of a CL file, what the proof says of it, and what the last change did.

import { say } from "./texts.js";

export class Sample {
  /**
   * @param {HTMLElement} list
   * @param {HTMLElement} verdict
   */
  constructor(list, verdict) {
    this.list = list;
    this.verdict = verdict;
    /** @type {string[]} */
    this.lines = [];
  }

  /** @param {{lines: string[], all: number, changed: number[], removed: number, checks: {key: string, passed: boolean, summary: string}[],
   *   problems: {what: string, cure: string, line: number, error: boolean}[], passed: boolean}} found */
  show(found) {
    this.lines = found.lines;
    const changed = new Set(found.changed);
    const rows = found.lines.map((line, k) => {
      const row = Object.assign(document.createElement("div"), { textContent: line || " " });
      if (changed.has(k)) row.className = "new";
      return row;
    });
    this.list.replaceChildren(...rows);
    this.list.querySelector(".new")?.scrollIntoView({ block: "center" });
    const failed = found.checks.filter((each) => !each.passed).map((each) => `${each.key}: ${each.summary}`);
    const told = found.problems.map((each) => `${each.what}${each.cure ? "; " + each.cure : ""}`);
    const head = found.passed ? say("passed", found.checks.length) : found.checks.length ? say("failed") : say("refused");
    const moved = found.changed.length + found.removed ? say("moved", found.changed.length, found.removed) : "";
    const cut = found.all > found.lines.length ? say("shown", found.lines.length, found.all) : "";
    this.verdict.textContent = [head, moved, cut, ...failed, ...told].filter(Boolean).join("\n");
    this.verdict.className = found.passed ? "good" : "bad";
  }

  /** @param {string} why there is none */
  clear(why) {
    this.list.replaceChildren();
    this.verdict.textContent = why;
    this.verdict.className = "";
  }
}
