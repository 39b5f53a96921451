// The program's text: only the lines that are in sight are elements, so that a million scroll as smoothly as ten.

import { DECODER } from "./data.js";

/** Height of a line, CSS pixels. */
const LINE = 18;

/** Browsers stop at a height near 2^25 pixels: beyond it, a pixel of the scroll bar is more than one of the text. */
const HIGHEST = 15_000_000;

export class Listing {
  /**
   * @param {HTMLElement} view
   * @param {(line: number) => void} onLine a line, from 1, was chosen
   */
  constructor(view, onLine) {
    this.view = view;
    this.onLine = onLine;
    this.space = document.createElement("div");
    this.space.className = "lines";
    view.replaceChildren(this.space);
    /** @type {Uint8Array} */
    this.text = new Uint8Array(0);
    this.starts = new Uint32Array([0, 0]);
    this.current = 0;
    /**
     * lines to mark, by their class
     * @type {Map<number, string>}
     */
    this.marks = new Map();
    view.addEventListener("scroll", () => this.fill());
    new ResizeObserver(() => this.fill()).observe(view);
    this.space.addEventListener("click", (event) => {
      const row = /** @type {HTMLElement} */ (event.target).closest?.("[data-line]");
      if (row instanceof HTMLElement) this.onLine(Number(row.dataset.line));
    });
  }

  get count() { return this.starts.length - 1; }

  /** @param {Uint8Array} text */
  setText(text) {
    this.text = text;
    let count = 1;
    for (let i = 0; i < text.length; i++) if (text[i] === 10) count++;
    if (text.length && text[text.length - 1] === 10) count--;
    this.starts = new Uint32Array(count + 1);
    for (let i = 0, n = 1; i < text.length; i++) if (text[i] === 10 && n < count) this.starts[n++] = i + 1;
    this.starts[count] = text.length;
    this.height = Math.min(count * LINE, HIGHEST);
    this.space.style.height = `${this.height}px`;
    this.view.scrollTop = 0;
    this.fill();
  }

  /**
   * A line's text, without its end.
   * @param {number} line from 1
   */
  lineText(line) { return DECODER.decode(this.text.subarray(this.starts[line - 1], this.starts[line])).replace(/[\r\n]+$/, ""); }

  /** The line at the top, from 0; not whole while scrolling. */
  get top() {
    const hidden = this.height - this.view.clientHeight;
    const most = this.count - this.view.clientHeight / LINE;
    return hidden > 0 ? (this.view.scrollTop / hidden) * Math.max(most, 0) : 0;
  }

  fill() {
    const first = Math.max(Math.floor(this.top) - 2, 0);
    const last = Math.min(first + Math.ceil(this.view.clientHeight / LINE) + 5, this.count);
    const offset = this.view.scrollTop - this.top * LINE;
    const made = document.createDocumentFragment();
    for (let k = first; k < last; k++) {
      const row = document.createElement("div");
      row.className = `line ${this.marks.get(k + 1) ?? ""}${k + 1 === this.current ? " current" : ""}`;
      row.dataset.line = String(k + 1);
      row.style.top = `${offset + k * LINE}px`;
      const number = document.createElement("span");
      number.textContent = String(k + 1);
      row.append(number, this.lineText(k + 1));
      made.append(row);
    }
    this.space.replaceChildren(made);
  }

  /**
   * Mark a line as the current one, and bring it into sight.
   * @param {number} line from 1
   */
  show(line) {
    if (line === this.current) return;
    this.current = line;
    const seen = this.view.clientHeight / LINE;
    if (line - 1 < this.top + 1 || line > this.top + seen - 2) {
      const most = Math.max(this.count - seen, 1);
      const share = Math.min(Math.max(line - seen / 2, 0) / most, 1);
      this.view.scrollTop = share * (this.height - this.view.clientHeight);
    }
    this.fill();
  }

  /**
   * The next line with some words, after a line, round the end; 0 if there is none.
   * @param {string} words
   * @param {number} after
   * @param {boolean} backwards
   */
  find(words, after, backwards = false) {
    const sought = words.toUpperCase();
    const step = backwards ? -1 : 1;
    for (let k = 1; k <= this.count; k++) {
      const line = ((((after - 1 + step * k) % this.count) + this.count) % this.count) + 1;
      if (this.lineText(line).toUpperCase().includes(sought)) return line;
    }
    return 0;
  }
}
