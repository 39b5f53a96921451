// The fields of one page: values, units, where they stand in the file, and what is wrong with them.

import { fieldTexts, say } from "./texts.js";

/**
 * @typedef {(string | string[])[]} Path
 * @typedef {{path: Path, key: string, kind: string, unit: string, choices: string[], size: number, optional: boolean, note: string,
 *   allowed: string, value: any, inherited: any, own: boolean, from: string}} FieldData
 * @typedef {{line: number, place: string, path: Path, what: string, cure: string}} ProblemData
 */

/** @param {Path} path */
export const idOf = (path) => JSON.stringify(path);

/**
 * A path as a person reads it: axis B, limits_deg.
 * @param {Path} path
 */
export function pathText(path) {
  return path.map((step) => (Array.isArray(step) ? ` ${step[0]} ` : `.${step}`)).join("").replace(/^\./, "").replace(/ \./g, " · ");
}

export class Form {
  /**
   * @param {HTMLElement} element
   * @param {(path: Path, value: any) => void} onChange
   * @param {(from: string) => void} onFocus
   */
  constructor(element, onChange, onFocus) {
    this.element = element;
    this.onChange = onChange;
    this.onFocus = onFocus;
    this.shape = "";
    /** @type {Map<string, HTMLElement>} */
    this.rows = new Map();
  }

  /**
   * Show fields; those that are there already keep their place and the focus.
   * @param {FieldData[]} fields
   * @param {ProblemData[]} problems
   * @param {HTMLElement | null} before
   */
  show(fields, problems, before) {
    const shape = fields.map((each) => idOf(each.path) + each.kind).join() + (before ? before.textContent : "");
    if (shape !== this.shape) this.#build(fields, before);
    this.shape = shape;
    for (const field of fields) this.#fill(field, problems.filter((each) => covers(each.path, field.path)));
  }

  /**
   * @param {FieldData[]} fields
   * @param {HTMLElement | null} before
   */
  #build(fields, before) {
    const focus = document.activeElement?.id;
    this.rows.clear();
    this.element.replaceChildren(...(before ? [before] : []));
    let group = "";
    for (const field of fields) {
      const name = field.path.find(Array.isArray)?.[0] ?? "";
      const head = field.path[0] === "axis" ? name : name && `${field.path.at(-3)} ${name}`;
      if (head !== group && head) this.element.append(Object.assign(document.createElement("h3"), { textContent: String(head) }));
      group = String(head);
      const row = this.#row(field);
      this.rows.set(idOf(field.path), row);
      this.element.append(row);
    }
    if (focus) document.getElementById(focus)?.focus();
  }

  /** @param {FieldData} field */
  #row(field) {
    const row = document.createElement("div");
    row.className = "field";
    row.dataset.path = idOf(field.path);
    const id = `field-${idOf(field.path)}`;
    const [name, help] = fieldTexts(field);
    const label = Object.assign(document.createElement("label"), { htmlFor: id, textContent: name });
    const inputs = document.createElement("span");
    inputs.className = "inputs";
    for (const input of inputsOf(field)) {
      input.id = inputs.childElementCount ? `${id}-${inputs.childElementCount}` : id;
      input.setAttribute("aria-describedby", `${id}-help`);
      if (inputs.childElementCount || field.size) input.setAttribute("aria-label", `${name} ${["X", "Y", "Z"][inputs.childElementCount] ?? ""}`);
      input.addEventListener("change", () => {
        row.dataset.pending = "true";
        const filled = texts(row).filter((text) => text.trim()).length;
        if (filled === 0 || filled === texts(row).length) this.#send(field, row);
      });
      input.addEventListener("focus", () => { if (row.dataset.from) this.onFocus(row.dataset.from); });
      inputs.append(input);
    }
    // Half a pair of numbers is no mistake yet while the user is on the way to the other half.
    row.addEventListener("focusout", (event) => {
      if (row.dataset.pending && !row.contains(/** @type {Node | null} */ (event.relatedTarget))) this.#send(field, row);
    });
    const unit = Object.assign(document.createElement("span"), { className: "unit", textContent: field.unit });
    const reset = Object.assign(document.createElement("button"), { type: "button", className: "reset", textContent: "↺" });
    reset.addEventListener("click", () => this.onChange(field.path, null));
    const place = Object.assign(document.createElement("code"), { textContent: pathText(field.path) });
    const told = Object.assign(document.createElement("p"), { id: `${id}-help`, className: "help", textContent: help });
    const from = Object.assign(document.createElement("span"), { className: "from" });
    const error = Object.assign(document.createElement("p"), { className: "error" });
    error.setAttribute("role", "alert");
    const meta = Object.assign(document.createElement("span"), { className: "meta" });
    meta.append(place, from);
    row.append(label, inputs, unit, reset, meta, told, error);
    return row;
  }

  /**
   * @param {FieldData} field
   * @param {HTMLElement} row
   */
  #send(field, row) {
    delete row.dataset.pending;
    this.onChange(field.path, readValue(field, row));
  }

  /**
   * @param {FieldData} field
   * @param {ProblemData[]} problems
   */
  #fill(field, problems) {
    const row = /** @type {HTMLElement} */ (this.rows.get(idOf(field.path)));
    const values = Array.isArray(field.value) ? field.value : [field.value];
    row.querySelectorAll(".inputs > *").forEach((input, k) => {
      const shown = values.length > 1 || field.size || field.kind === "interval" ? values[k] : field.value;
      const text = shown === null || shown === undefined ? "" : String(shown);
      const box = /** @type {HTMLInputElement} */ (input);
      if (box.value !== text) box.value = text;
      box.setAttribute("aria-invalid", String(problems.length > 0));
    });
    row.classList.toggle("own", field.own);
    row.dataset.from = field.own ? field.from : "";
    const reset = /** @type {HTMLButtonElement} */ (row.querySelector(".reset"));
    reset.hidden = !field.own || field.inherited === null;
    reset.title = say("reset", String(field.inherited));
    reset.setAttribute("aria-label", reset.title);
    /** @type {HTMLElement} */ (row.querySelector(".from")).textContent = field.from ? (field.own ? say("own") : field.from) : say("notStated");
    /** @type {HTMLElement} */ (row.querySelector(".error")).textContent = problems.map((each) => `${each.what}; ${each.cure}`).join("\n");
  }

  /**
   * Go to a field.
   * @param {Path} path
   */
  focus(path) {
    const row = this.rows.get(idOf(path));
    row?.scrollIntoView({ block: "center" });
    /** @type {HTMLElement | null | undefined} */ (row?.querySelector(".inputs > *"))?.focus();
  }
}

/**
 * Whether a problem at a path concerns a field: the field itself, or a table around it has nothing nearer.
 * @param {Path} problem
 * @param {Path} field
 */
export function covers(problem, field) { return problem.length > 0 && idOf(problem) === idOf(field); }

/**
 * @param {FieldData} field
 * @returns {HTMLInputElement[]}
 */
function inputsOf(field) {
  const many = field.kind === "interval" ? 2 : field.size || 1;
  return Array.from({ length: many }, () => {
    if (field.kind === "lines") return /** @type {any} */ (Object.assign(document.createElement("textarea"), { rows: 6, spellcheck: false, wrap: "off" }));
    if (field.kind === "choice" || field.kind === "flag") return /** @type {any} */ (selectOf(field));
    const input = Object.assign(document.createElement("input"), { type: "text", autocomplete: "off", spellcheck: false });
    if (field.kind !== "text") input.inputMode = "decimal";
    return input;
  });
}

/** @param {FieldData} field */
function selectOf(field) {
  const select = document.createElement("select");
  const words = field.kind === "flag" ? ["true", "false"] : field.choices;
  const extra = field.value !== null && field.kind === "choice" && !words.includes(field.value) ? [String(field.value)] : [];
  for (const word of ["", ...words, ...extra]) select.append(new Option(word || "—", word));
  return select;
}

/**
 * What stands in the inputs of a row.
 * @param {HTMLElement} row
 */
function texts(row) { return Array.from(row.querySelectorAll(".inputs > *"), (input) => /** @type {HTMLInputElement} */ (input).value); }

/**
 * What the user has entered; null: nothing.
 * @param {FieldData} field
 * @param {HTMLElement} row
 */
function readValue(field, row) {
  const entered = texts(row);
  if (entered.every((text) => text.trim() === "")) return field.kind === "text" && field.inherited ? "" : null;
  if (field.kind === "flag") return entered[0] === "true";
  if (field.kind === "text" || field.kind === "choice") return entered[0];
  if (field.kind === "lines") return entered[0].replace(/\r\n/g, "\n").replace(/\n?$/, "\n");
  const numbers = entered.map((text) => (text.trim() === "" ? NaN : Number(text)));
  // What is no number goes into the file as it is, so that the mistake is told at its field.
  if (numbers.some((number) => !Number.isFinite(number))) return entered.join(", ");
  return numbers.length > 1 ? numbers : numbers[0];
}
