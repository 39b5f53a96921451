// The fields of one page: values, units, where they stand in the file, and what is wrong with them.

import { say } from "../../viewer/web/texts.js";

/**
 * @typedef {(string | string[])[]} Path
 * @typedef {{path: Path, key: string, kind: string, unit: string, choices: string[], size: number, optional: boolean, name: string, help: string,
 *   value: any, inherited: any, own: boolean, from: string}} FieldData
 * @typedef {{line: number, place: string, path: Path, text: string, code: string}} ProblemData
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

/**
 * Replace what stands in a part of the page; a button that has the focus keeps it, by its data-key.
 * @param {Element} element
 * @param {Node[]} children
 */
export function refill(element, children) {
  const key = element.contains(document.activeElement) ? /** @type {HTMLElement} */ (document.activeElement).dataset.key : "";
  element.replaceChildren(...children);
  if (!key) return;
  const again = Array.from(element.querySelectorAll("button")).find((each) => each.dataset.key === key);
  // An axis that has come to an end of the order can only go back.
  const other = /** @type {HTMLElement | null | undefined} */ (again?.parentElement?.querySelector("button:enabled"));
  (again?.disabled ? other : again)?.focus();
}

/**
 * @param {string[]} one
 * @param {string[]} other
 */
const alike = (one, other) => one.length === other.length && one.every((text, k) => text === other[k]);

export class Form {
  /**
   * @param {HTMLElement} element
   * @param {(path: Path, value: any, entered: string[]) => void} onChange entered: what settle takes
   * @param {(from: string) => void} onFocus
   */
  constructor(element, onChange, onFocus) {
    this.element = element;
    this.onChange = onChange;
    this.onFocus = onFocus;
    this.shape = "";
    this.isBuilding = false;
    /** @type {Map<string, HTMLElement>} */
    this.rows = new Map();
    /** @type {Map<string, FieldData>} */
    this.fields = new Map();
    /** What the user has entered and the definition does not have yet: no answer overwrites it. @type {Map<string, string[]>} */
    this.held = new Map();
    /** What of it is on its way. @type {Map<string, string[]>} */
    this.sent = new Map();
    this.order = document.createElement("div");
    this.list = document.createElement("div");
    element.replaceChildren(this.order, this.list);
  }

  /**
   * Show fields; those that are there already keep their place and the focus, and what is entered in them.
   * @param {FieldData[]} fields
   * @param {ProblemData[]} problems
   * @param {{path: Path, text: string}[]} marks values that are still to be entered
   * @param {HTMLElement | null} before
   */
  show(fields, problems, marks, before) {
    if (this.order.textContent !== (before?.textContent ?? "")) refill(this.order, before ? [before] : []);
    const shape = JSON.stringify(fields.map(({ path, kind, choices, help }) => [path, kind, choices, help]));
    this.fields = new Map(fields.map((each) => [idOf(each.path), each]));
    if (shape !== this.shape) this.#build(fields);
    this.shape = shape;
    for (const field of fields) {
      this.#fill(field, problems.filter((each) => covers(each.path, field.path)), marks.filter((each) => covers(each.path, field.path)));
    }
  }

  /** @param {FieldData[]} fields */
  #build(fields) {
    const focus = /** @type {HTMLInputElement | null} */ (this.list.contains(document.activeElement) ? document.activeElement : null);
    const { id, selectionStart, selectionEnd } = focus ?? { id: "", selectionStart: null, selectionEnd: null };
    this.isBuilding = true;
    this.rows.clear();
    this.list.replaceChildren();
    let group = "";
    for (const field of fields) {
      const name = field.path.find(Array.isArray)?.[0] ?? "";
      const head = field.path[0] === "axis" ? name : name && `${field.path.at(-3)} ${name}`;
      if (head !== group && head) this.list.append(Object.assign(document.createElement("h3"), { textContent: String(head) }));
      group = String(head);
      const row = this.#row(field, String(head));
      this.rows.set(idOf(field.path), row);
      this.list.append(row);
      this.#write(field, row);
    }
    this.isBuilding = false;
    const again = /** @type {HTMLInputElement | null} */ (id ? document.getElementById(id) : null);
    again?.focus();
    if (again && typeof selectionStart === "number") again.setSelectionRange(selectionStart, selectionEnd);
  }

  /**
   * @param {FieldData} field
   * @param {string} head of the group: the letter of an axis
   */
  #row(field, head) {
    const row = document.createElement("div");
    row.className = "field";
    row.dataset.path = idOf(field.path);
    const id = `field-${idOf(field.path)}`;
    const { name, help } = field;
    const label = Object.assign(document.createElement("label"), { htmlFor: id, textContent: name });
    const inputs = document.createElement("span");
    inputs.className = "inputs";
    for (const input of inputsOf(field)) {
      input.id = inputs.childElementCount ? `${id}-${inputs.childElementCount}` : id;
      input.setAttribute("aria-describedby", `${id}-help`);
      // Travel of which axis, and in what: the headline and the unit are not part of the label that is seen.
      input.setAttribute("aria-label", [head, name, partOf(field, inputs.childElementCount), field.unit].filter(Boolean).join(" "));
      input.addEventListener("input", () => this.held.set(idOf(field.path), texts(row)));
      input.addEventListener("change", () => {
        const filled = texts(row).filter((text) => text.trim()).length;
        if (filled === 0 || filled === texts(row).length) this.#send(idOf(field.path));
      });
      input.addEventListener("focus", () => { if (row.dataset.from) this.onFocus(row.dataset.from); });
      inputs.append(input);
    }
    // Half a pair of numbers is no mistake yet while the user is on the way to the other half.
    row.addEventListener("focusout", (event) => {
      if (!this.isBuilding && !row.contains(/** @type {Node | null} */ (event.relatedTarget))) this.#send(idOf(field.path));
    });
    const unit = Object.assign(document.createElement("span"), { className: "unit", textContent: field.unit });
    const reset = Object.assign(document.createElement("button"), { type: "button", className: "reset", textContent: "↺" });
    reset.addEventListener("click", () => {
      this.held.delete(idOf(field.path));
      this.onChange(field.path, null, []);
    });
    const place = Object.assign(document.createElement("code"), { textContent: pathText(field.path) });
    const told = Object.assign(document.createElement("p"), { id: `${id}-help`, className: "help", textContent: help });
    const from = Object.assign(document.createElement("span"), { className: "from" });
    const error = Object.assign(document.createElement("p"), { className: "error" });
    error.setAttribute("role", "alert");
    const meta = Object.assign(document.createElement("span"), { className: "meta" });
    meta.append(place, from);
    const mark = Object.assign(document.createElement("p"), { className: "mark warn" });
    row.append(label, inputs, unit, reset, meta, told, mark, error);
    return row;
  }

  /**
   * Send what is entered in a field, unless it is on its way, or the definition has it.
   * @param {string} id
   */
  #send(id) {
    const field = this.fields.get(id);
    const entered = this.held.get(id);
    if (!field || !entered || this.sent.get(id) === entered) return;
    if (!this.sent.has(id) && alike(entered, shownTexts(field, entered.length))) {
      this.held.delete(id);
      return;
    }
    this.sent.set(id, entered);
    this.onChange(field.path, readValue(field, entered), entered);
  }

  /** Send all that is entered. */
  sendAll() { for (const id of this.held.keys()) this.#send(id); }

  /**
   * A change has had its answer: its field shows the definition again, unless the user has gone on in it.
   * @param {Path} path
   * @param {string[]} entered
   */
  settle(path, entered) {
    for (const each of [this.held, this.sent]) if (each.get(idOf(path)) === entered) each.delete(idOf(path));
  }

  /**
   * Write into the inputs of a row what they are to show.
   * @param {FieldData} field
   * @param {HTMLElement} row
   */
  #write(field, row) {
    const boxes = /** @type {HTMLInputElement[]} */ (Array.from(row.querySelectorAll(".inputs > *")));
    const shown = this.held.get(idOf(field.path)) ?? shownTexts(field, boxes.length);
    boxes.forEach((box, k) => {
      const options = box instanceof HTMLSelectElement ? Array.from(box.options, (option) => option.value) : [shown[k]];
      if (box instanceof HTMLSelectElement && !options.includes(shown[k])) box.append(new Option(shown[k], shown[k]));
      if (box.value !== shown[k]) box.value = shown[k];
    });
  }

  /**
   * @param {FieldData} field
   * @param {ProblemData[]} problems
   * @param {{text: string}[]} marks
   */
  #fill(field, problems, marks) {
    const row = /** @type {HTMLElement} */ (this.rows.get(idOf(field.path)));
    this.#write(field, row);
    row.querySelectorAll(".inputs > *").forEach((box) => box.setAttribute("aria-invalid", String(problems.length > 0)));
    row.classList.toggle("own", field.own);
    row.dataset.from = field.own ? field.from : "";
    const reset = /** @type {HTMLButtonElement} */ (row.querySelector(".reset"));
    reset.hidden = !field.own || field.inherited === null;
    reset.title = say("reset", { value: String(field.inherited) });
    reset.setAttribute("aria-label", reset.title);
    /** @type {HTMLElement} */ (row.querySelector(".from")).textContent = field.from ? (field.own ? say("own") : field.from) : say("notStated");
    /** @type {HTMLElement} */ (row.querySelector(".mark")).textContent = marks.map((each) => each.text).join("\n");
    /** @type {HTMLElement} */ (row.querySelector(".error")).textContent = problems.map((each) => each.text).join("\n");
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

/**
 * Which of several inputs one is.
 * @param {FieldData} field
 * @param {number} number
 */
function partOf(field, number) {
  if (field.kind === "interval") return say(number ? "highest" : "lowest");
  return field.size ? ["X", "Y", "Z"][number] ?? "" : "";
}

/** @param {FieldData} field */
function selectOf(field) {
  const select = document.createElement("select");
  const words = field.kind === "flag" ? ["true", "false"] : field.choices;
  for (const word of ["", ...words]) select.append(new Option(word || "—", word));
  return select;
}

/**
 * What stands in the inputs of a row.
 * @param {HTMLElement} row
 */
function texts(row) { return Array.from(row.querySelectorAll(".inputs > *"), (input) => /** @type {HTMLInputElement} */ (input).value); }

/**
 * What stands in the inputs of a field when the definition alone is asked.
 * @param {FieldData} field
 * @param {number} count of its inputs
 */
function shownTexts(field, count) {
  const listed = Array.isArray(field.value) ? field.value : [field.value];
  const values = field.kind === "lines" ? [listed.join("\n")] : listed;
  return Array.from({ length: count }, (_, k) => (values[k] === null || values[k] === undefined ? "" : String(values[k])));
}

/**
 * The value that the user has entered; null: nothing.
 * @param {FieldData} field
 * @param {string[]} entered
 */
function readValue(field, entered) {
  if (entered.every((text) => text.trim() === "")) return ["text", "lines"].includes(field.kind) && field.inherited ? "" : null;
  if (field.kind === "flag") return entered[0] === "true";
  if (field.kind === "text" || field.kind === "choice") return entered[0];
  if (field.kind === "lines") return entered[0].replace(/\r\n/g, "\n").replace(/\n?$/, "\n");
  const numbers = entered.map((text) => (text.trim() === "" ? NaN : Number(text)));
  // What is no number goes into the file as it is, so that the mistake is told at its field.
  if (numbers.some((number) => !Number.isFinite(number))) return entered.join(", ");
  return numbers.length > 1 ? numbers : numbers[0];
}
