// The definition as text: numbered lines, marks at mistakes, and the line of the field that has the focus.

/** So many changes can be undone. */
const MOST_UNDONE = 200;

export class Editor {
  /**
   * @param {HTMLTextAreaElement} area
   * @param {HTMLElement} gutter
   * @param {() => void} onType at each change
   * @param {() => void} onRest after a rest
   */
  constructor(area, gutter, onType, onRest) {
    this.area = area;
    this.gutter = gutter;
    this.timer = 0;
    this.onChange = () => { onType(); onRest(); };
    // What the text was before each change from elsewhere, of which the browser's own undo knows nothing.
    /** @type {string[]} */
    this.past = [];
    /** @type {string[]} */
    this.future = [];
    this.given = "";
    area.addEventListener("input", () => {
      onType();
      this.#number();
      this.future = [];
      clearTimeout(this.timer);
      this.timer = setTimeout(onRest, 350);
    });
    area.addEventListener("scroll", () => { gutter.scrollTop = area.scrollTop; });
    /** @type {Map<number, string>} */
    this.marks = new Map();
  }

  get text() { return this.area.value; }

  /**
   * Show a text that has been changed elsewhere; the cursor stays where it is in what stays.
   * @param {string} text
   */
  set(text) {
    if (this.area.value === text) return;
    if (this.area.value) this.past.push(this.area.value);
    if (this.past.length > MOST_UNDONE) this.past.shift();
    this.future = [];
    this.#replace(text);
  }

  /**
   * Undo and redo changes from elsewhere, once the browser has undone what was typed after them.
   * @param {KeyboardEvent} event
   */
  undoKey(event) {
    const key = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || (key !== "z" && key !== "y") || this.area.value !== this.given) return;
    const [from, to] = key === "y" || event.shiftKey ? [this.future, this.past] : [this.past, this.future];
    const text = from.pop();
    if (text === undefined) return;
    event.preventDefault();
    to.push(this.area.value);
    this.#replace(text);
    this.onChange();
  }

  /** @param {string} text */
  #replace(text) {
    const old = this.area.value;
    this.given = text;
    const most = Math.min(old.length, text.length);
    let before = 0;
    while (before < most && old[before] === text[before]) before++;
    let after = 0;
    while (after < most - before && old.at(-1 - after) === text.at(-1 - after)) after++;
    const { scrollTop } = this.area;
    this.area.setRangeText(text.slice(before, text.length - after), before, old.length - after, "preserve");
    this.area.scrollTop = scrollTop;
    this.#number();
  }

  /**
   * Mark lines.
   * @param {{line: number, text: string}[]} problems
   */
  mark(problems) {
    this.marks = new Map(problems.filter((each) => each.line).map((each) => [each.line, each.text]));
    this.#number();
  }

  /**
   * Bring a line into sight, and show it for a moment.
   * @param {number} line from 1
   */
  show(line) {
    const height = parseFloat(getComputedStyle(this.area).lineHeight);
    const top = (line - 1) * height;
    if (top < this.area.scrollTop || top > this.area.scrollTop + this.area.clientHeight - 2 * height) this.area.scrollTop = Math.max(0, top - 4 * height);
    this.gutter.querySelector(".here")?.classList.remove("here");
    this.gutter.children[line - 1]?.classList.add("here");
  }

  #number() {
    const count = this.area.value.split("\n").length;
    const rows = Array.from({ length: count }, (_, k) => {
      const row = Object.assign(document.createElement("div"), { textContent: String(k + 1) });
      const what = this.marks.get(k + 1);
      if (what) { row.className = "wrong"; row.title = what; }
      return row;
    });
    this.gutter.replaceChildren(...rows);
    this.gutter.scrollTop = this.area.scrollTop;
  }
}
