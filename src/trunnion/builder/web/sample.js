// The sample program: what the definition makes of a CL file, what the proof says of it, and what the last change did.

import { say } from "../../viewer/web/texts.js";

export class Sample {
  /**
   * @param {HTMLElement} list
   * @param {HTMLElement} verdict
   * @param {HTMLElement} checks what each check has seen
   */
  constructor(list, verdict, checks) {
    this.list = list;
    this.verdict = verdict;
    this.checks = checks;
    /** @type {string[]} */
    this.lines = [];
  }

  /** @param {{lines: string[], all: number, changed: number[], removed: number, checks: {key: string, state: string, said: string, summary: string}[],
   *   problems: {severity: string, text: string}[], passed: boolean, standing: string}} found
   * @param {number} marks values that are still to be entered */
  show(found, marks) {
    if (found.lines.length) this.lines = found.lines;
    const changed = new Set(found.changed);
    const rows = found.lines.map((line, k) => {
      const row = Object.assign(document.createElement("div"), { textContent: line || " " });
      if (changed.has(k)) row.className = "new";
      return row;
    });
    this.list.replaceChildren(...rows);
    this.list.querySelector(".new")?.scrollIntoView({ block: "center" });
    const lines = (/** @type {string[]} */ texts, /** @type {string} */ kind) => texts.filter(Boolean).map((text) => Object.assign(document.createElement("div"), { textContent: text, className: kind }));
    const told = (/** @type {boolean} */ isError) => found.problems.filter((each) => (each.severity === "error") === isError).map((each) => each.text);
    const checked = (/** @type {string} */ state) => found.checks.filter((each) => each.state === state).map((each) => say("answer", { check: each.key, what: each.summary }));
    const unchecked = found.checks.filter((each) => each.state === "not checked").map((each) => say("unanswered", { state: each.said, check: each.key, what: each.summary }));
    const open = [...unchecked, ...told(false), marks ? say("toEnter", { count: marks }) : ""];
    const head = found.passed && found.standing ? found.standing : found.checks.length ? say("failed") : say("refused");
    const moved = found.changed.length + found.removed ? say("moved", { new: found.changed.length, gone: found.removed }) : "";
    const cut = found.all > found.lines.length ? say("shown", { count: found.lines.length, all: found.all }) : "";
    this.verdict.replaceChildren(...lines([head], found.passed ? (open.some(Boolean) ? "warn" : "good") : "bad"), ...lines([...checked("FAIL"), ...told(true)], "bad"), ...lines(open, "warn"), ...lines([moved, cut], ""));
    this.#showChecks(checked("ok"));
  }

  /** @param {string} why there is none */
  clear(why) {
    this.list.replaceChildren();
    this.verdict.textContent = why;
    this.#showChecks([]);
  }

  /** @param {string[]} passed */
  #showChecks(passed) {
    this.checks.hidden = !passed.length;
    this.checks.querySelector("ul").replaceChildren(...passed.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  }
}
