// The sample program: what the definition makes of a CL file, what the proof says of it, and what the last change did.

import { say } from "./texts.js";

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

  /** @param {{lines: string[], all: number, changed: number[], removed: number, checks: {key: string, state: string, summary: string}[],
   *   problems: {severity: string, text: string, cure: string | null, code: string | null, subject: {kind: string, name: string} | null}[], passed: boolean,
   *   standing: {checks: number, ok: number, not_checked: number, warnings: number, not_measured: string[], assumed: string[]} | null}} found
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
    const told = (/** @type {boolean} */ isError) => found.problems.filter((each) => (each.severity === "error") === isError).map((each) => `${each.subject?.kind === "argument" ? `${each.subject.name} ` : ""}${each.text}${each.cure ? "; " + each.cure : ""} [${each.code}]`);
    const checked = (/** @type {string} */ state) => found.checks.filter((each) => each.state === state).map((each) => `${each.key}: ${each.summary}`);
    const unchecked = checked("not checked").map((each) => `${say("notChecked")}: ${each}`);
    const open = [...unchecked, ...told(false), marks ? say("toEnter", marks) : ""];
    const head = found.passed && found.standing ? this.#said(found.standing) : found.checks.length ? say("failed") : say("refused");
    const moved = found.changed.length + found.removed ? say("moved", found.changed.length, found.removed) : "";
    const cut = found.all > found.lines.length ? say("shown", found.lines.length, found.all) : "";
    this.verdict.replaceChildren(...lines([head], found.passed ? (open.some(Boolean) ? "warn" : "good") : "bad"), ...lines([...checked("FAIL"), ...told(true)], "bad"), ...lines(open, "warn"), ...lines([moved, cut], ""));
    this.#showChecks(checked("ok"));
  }

  /** @param {string} why there is none */
  clear(why) {
    this.list.replaceChildren();
    this.verdict.textContent = why;
    this.#showChecks([]);
  }

  /**
   * What "passed" stands on.
   * @param {{checks: number, ok: number, not_checked: number, warnings: number, not_measured: string[], assumed: string[]}} standing
   */
  #said(standing) {
    const parts = [say(standing.not_checked ? "inPart" : "passed", standing.ok, standing.checks)];
    if (standing.not_checked) parts.push(`${standing.not_checked} ${say("notChecked")}`);
    if (standing.warnings) parts.push(say("warnings", standing.warnings));
    if (standing.not_measured.length) parts.push(say("notMeasured", standing.not_measured.length));
    if (standing.assumed.length) parts.push(say("assumed", standing.assumed.join(", ")));
    return parts.join("; ");
  }

  /** @param {string[]} passed */
  #showChecks(passed) {
    this.checks.hidden = !passed.length;
    this.checks.querySelector("ul").replaceChildren(...passed.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  }
}
