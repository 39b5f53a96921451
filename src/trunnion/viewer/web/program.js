// A program in time: which piece of its motion is when, and where the axes are then.

import { toolAt, unwrapped } from "./kinematics.js";

const COUNT = 1e-5;

/** Places of a piece that are compared with one that is wanted. */
const STEPS = 64;

export class Program {
  /**
   * @param {import("./data.js").SceneData} scene
   * @param {Record<string, any>} columns
   */
  constructor(scene, columns) {
    this.scene = scene;
    this.machine = scene.machine;
    /**
     * axis values before the first piece and after each
     * @type {Float64Array[]}
     */
    this.axes = [0, 1, 2, 3, 4].map((k) => unwrapped(columns[`axis-${k}`], COUNT));
    /**
     * row of each piece
     * @type {Int32Array}
     */
    this.row = columns.row;
    this.known = columns.known;
    this.line = columns.line;
    this.file = columns.file;
    this.kind = columns.kind;
    this.tool = columns.tool;
    this.feed = columns.feed;
    this.cl = columns.cl;
    /** phase of each row, -1 for none; not there without CL files */
    this.phase = columns.phase;
    this.pieces = this.row.length;
    this.rows = this.line.length;
    /** seconds at which pieces begin, and the end */
    this.time = new Float64Array(this.pieces + 1);
    for (let i = 0; i < this.pieces; i++) this.time[i + 1] = this.time[i] + columns.seconds[i];
    /** last piece of each row, and -1 before */
    this.last = new Int32Array(this.rows).fill(-1);
    for (let i = 0; i < this.pieces; i++) this.last[this.row[i]] = i;
    for (let i = 1; i < this.rows; i++) if (this.last[i] < 0) this.last[i] = this.last[i - 1];
  }

  get end() { return this.time[this.pieces]; }

  /**
   * The piece that runs at a time.
   * @param {number} time
   */
  pieceAt(time) {
    let low = 0, high = this.pieces - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time[middle + 1] > time) high = middle;
      else low = middle + 1;
    }
    return Math.max(low, 0);
  }

  /**
   * Axis values at a time.
   * @param {number} time
   * @returns {number[]}
   */
  valuesAt(time) {
    if (!this.pieces) return this.axes.map((column) => column[0]);
    const piece = this.pieceAt(time);
    const takes = this.time[piece + 1] - this.time[piece];
    const share = takes > 0 ? Math.min(Math.max((time - this.time[piece]) / takes, 0), 1) : 1;
    return this.axes.map((column) => column[piece] + share * (column[piece + 1] - column[piece]));
  }

  /**
   * Axis values at the end of a row.
   * @param {number} row
   */
  valuesAfter(row) {
    const piece = this.rows ? this.last[row] + 1 : 0;
    return this.axes.map((column) => column[piece]);
  }

  /**
   * Time at the end of a row.
   * @param {number} row
   */
  timeOf(row) {
    return this.pieces ? this.time[Math.max(this.last[Math.min(Math.max(row, 0), this.rows - 1)], -1) + 1] : 0;
  }

  /**
   * Axis values at a time within a row: pieces of other rows take the same time where theirs is none.
   * @param {number} row
   * @param {number} time
   */
  valuesIn(row, time) { return this.rowAt(time) === row ? this.valuesAt(time) : this.valuesAfter(row); }

  /**
   * When the tip is nearest to a place within a row.
   * @param {number} row
   * @param {number[]} place mm, in the workpiece frame
   */
  timeNear(row, place) {
    const last = this.last[row], values = new Float64Array(5), p = new Float64Array(3);
    let best = this.timeOf(row), least = Infinity;
    const first = row > 0 ? this.last[row - 1] + 1 : 0;
    for (let piece = Math.max(first, 0); piece <= last; piece++) {
      for (let k = 0; k <= STEPS; k++) {
        const share = k / STEPS;
        for (let axis = 0; axis < 5; axis++) values[axis] = this.axes[axis][piece] + share * (this.axes[axis][piece + 1] - this.axes[axis][piece]);
        toolAt(this.machine, values, this.lengthAt(row), p);
        const away = Math.hypot(p[0] - place[0], p[1] - place[1], p[2] - place[2]);
        if (away < least) { least = away; best = this.time[piece] + share * (this.time[piece + 1] - this.time[piece]); }
      }
    }
    return best;
  }

  /**
   * The row that runs at a time.
   * @param {number} time
   */
  rowAt(time) { return this.pieces ? this.row[this.pieceAt(time)] : 0; }

  /**
   * Speed of the tip in a row, mm/min; NaN where its time is not known.
   * @param {number} row
   */
  feedOf(row) { return this.feed[row] < 0 ? NaN : this.feed[row]; }

  /**
   * Length of the tool of a row, mm.
   * @param {number} row
   */
  lengthAt(row) { return this.scene.tools[this.rows ? this.tool[row] : 0]?.length ?? 0; }

  /**
   * The row at a line: of those of the line, or of the nearest line after it that moves, or before it, the one nearest to a row,
   * which says in which pass of a loop or call. Rows are in the order in which the program runs, and not in that of lines.
   * @param {number} file
   * @param {number} line
   * @param {number} near
   */
  rowOfLine(file, line, near = 0) {
    let found = -1, at = 0;
    for (let row = 0; row < this.rows; row++) {
      if (this.file[row] !== file) continue;
      const here = this.line[row];
      const nearer = found >= 0 && here === at && Math.abs(row - near) < Math.abs(found - near);
      const better = here >= line ? at < line || here < at : at < line && here > at;
      if (found < 0 || better || nearer) { found = row; at = here; }
    }
    return found < 0 ? Math.max(this.rows - 1, 0) : found;
  }

  /**
   * Tips (pieces + 1, 3) in the workpiece frame.
   * @returns {Float32Array}
   */
  tips() {
    const found = new Float32Array(3 * (this.pieces + 1));
    const values = new Float64Array(5), p = new Float64Array(3);
    for (let i = 0; i <= this.pieces; i++) {
      for (let k = 0; k < 5; k++) values[k] = this.axes[k][i];
      toolAt(this.machine, values, this.lengthAt(i ? this.row[i - 1] : 0), p);
      found[3 * i] = p[0]; found[3 * i + 1] = p[1]; found[3 * i + 2] = p[2];
    }
    return found;
  }
}
