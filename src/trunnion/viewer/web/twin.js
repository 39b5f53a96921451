// A second program on its machine, which goes along the same tool path as the first.

import { Listing } from "./listing.js";
import { Program } from "./program.js";
import { Space } from "./space.js";

const TWIN_KINDS = [[200, 120, 40], [30, 110, 200], [20, 150, 130]], DIFFERENT = [220, 30, 40], OTHER = [150, 160, 170];

export class Twin {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {HTMLElement} view of its text
   * @param {import("./data.js").SceneData} scene
   * @param {Record<string, any>} columns of both programs
   * @param {Program} first
   * @param {(file: number) => Promise<Uint8Array>} readText of a file, counted with those of the first program
   */
  constructor(canvas, view, scene, columns, first, readText) {
    const own = Object.fromEntries(Object.entries(columns).filter(([name]) => name.startsWith("b-")).map(([name, column]) => [name.slice(2), column]));
    this.scene = scene.against;
    this.readText = readText;
    this.program = new Program(this.scene, own);
    this.space = new Space(canvas, this.program, own);
    this.listing = new Listing(view, (line) => this.onLine(line));
    this.shownFile = -1;
    this.row = 0;
    /**
     * takes a row of the first program, to which both go
     * @type {(row: number) => void}
     */
    this.onRow = () => {};
    this.ones = columns["pair-one"];
    this.twos = columns["pair-two"];
    const times = (/** @type {Program} */ program, /** @type {Int32Array} */ rows) => Float64Array.from(rows, (row) => program.timeOf(row));
    /** times at which both are at the same place */
    this.times = [times(first, this.ones), times(this.program, this.twos)];
    const differing = new Set(this.scene.differing);
    this.space.paint((/** @type {number} */ piece) => {
      const row = this.program.row[piece];
      return differing.has(row) ? DIFFERENT : TWIN_KINDS[this.program.kind[row]] ?? OTHER;
    });
  }

  /**
   * The last value of some that grow which is not above one, -1 if all are.
   * @param {ArrayLike<number>} sorted
   * @param {number} value
   */
  #before(sorted, value) {
    let low = 0, high = sorted.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (sorted[middle] <= value) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /**
   * Go where the first program is: to the end of the same motion, or as far between two places at which both are.
   * @param {number} time of the first program
   * @param {number} row of the first program
   * @param {boolean} atEnd of the row
   */
  show(time, row, atEnd) {
    const { program } = this;
    const pair = this.#before(this.ones, row);
    if (atEnd && pair >= 0 && this.ones[pair] === row) {
      this.row = this.twos[pair];
      this.space.setPose(program.valuesAfter(this.row), this.row);
    } else {
      const at = this.#timeOf(time);
      this.row = program.rowAt(at);
      this.space.setPose(program.valuesAt(at), this.row);
    }
    this.#showLine(this.row);
  }

  /**
   * The time of this program at a time of the first.
   * @param {number} time
   */
  #timeOf(time) {
    const [one, two] = this.times;
    const k = this.#before(one, time), last = one.length - 1;
    const from = k < 0 ? [0, 0] : [one[k], two[k]];
    if (k >= last) return k < 0 ? 0 : two[last];
    const share = one[k + 1] > from[0] ? (time - from[0]) / (one[k + 1] - from[0]) : 0;
    return from[1] + share * (two[k + 1] - from[1]);
  }

  /** @param {number} row */
  async #showLine(row) {
    if (!this.program.rows) return;
    const file = this.program.file[row];
    if (file !== this.shownFile) {
      this.shownFile = file;
      const text = await this.readText(this.scene.firstText + file);
      if (this.shownFile !== file) return;
      this.listing.marks = new Map(this.scene.differing.map((/** @type {number} */ at) => [this.program.line[at], "finding"]));
      this.listing.setText(text);
    }
    this.listing.show(this.program.line[this.row]);
  }

  /**
   * A line of this program: both go there.
   * @param {number} line
   */
  onLine(line) {
    const k = this.#before(this.twos, this.program.rowOfLine(this.shownFile, line, this.row));
    if (k >= 0) this.onRow(this.ones[k]);
  }
}
