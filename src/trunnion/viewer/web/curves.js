// Curves over time: for each pixel across, the least and the greatest value that it stands for.

import { clock } from "./elements.js";

const LEFT = 76, RIGHT = 10, GAP = 4, FOOT = 16;

/** About how many pixels lie between two ticks of the time. */
const TICKS = 110;

/** Colours of the second curve of a strip and of those after it; readable on light and on dark. */
const MORE = ["#b06a00", "#7d55c7", "#0f8a6d", "#c2417a"];

/**
 * @typedef {(piece: number, share?: number) => number} Value when a share of a piece's time has gone by; 1 is its end
 * @typedef {{name: string, at: Value}} Curve
 * @typedef {{name: string, unit: string, low: number | null, high: number | null, at?: Value, curves?: Curve[]}} Strip
 *   one curve, ``at``, or several with names of their own
 */

export class Curves {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./program.js").Program} program
   * @param {Strip[]} strips
   * @param {(time: number) => void} onTime a time was chosen
   */
  constructor(canvas, program, strips, onTime) {
    this.canvas = canvas;
    this.program = program;
    this.strips = strips;
    this.range = [0, program.end || 1];
    this.cursor = 0;
    /**
     * times of findings
     * @type {number[]}
     */
    this.marks = [];
    this.pointer = document.createElement("div");
    this.pointer.className = "pointer";
    canvas.after(this.pointer);
    new ResizeObserver(() => this.redraw()).observe(canvas);
    const seek = (/** @type {PointerEvent} */ event) => {
      const box = canvas.getBoundingClientRect();
      const share = (event.clientX - box.left - LEFT) / Math.max(box.width - LEFT - RIGHT, 1);
      onTime(this.range[0] + Math.min(Math.max(share, 0), 1) * (this.range[1] - this.range[0]));
    };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); seek(event); });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons & 1) seek(event); });
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.zoom(event.deltaY > 0 ? 1.25 : 0.8); }, { passive: false });
    canvas.addEventListener("dblclick", () => { this.range = [0, program.end || 1]; this.redraw(); });
  }

  /**
   * Show less or more of the time, about the cursor.
   * @param {number} factor
   */
  zoom(factor) {
    const end = this.program.end || 1;
    const width = Math.min(Math.max((this.range[1] - this.range[0]) * factor, end * 1e-5), end);
    const share = (this.cursor - this.range[0]) / (this.range[1] - this.range[0]);
    const first = Math.min(Math.max(this.cursor - Math.min(Math.max(share, 0), 1) * width, 0), end - width);
    this.range = [first, first + width];
    this.redraw();
  }

  /** @param {number} time */
  setCursor(time) {
    this.cursor = time;
    if (time < this.range[0] || time > this.range[1]) {
      const width = this.range[1] - this.range[0];
      const first = Math.min(Math.max(time - width / 2, 0), Math.max(this.program.end - width, 0));
      this.range = [first, first + width];
      this.redraw();
    } else this.#placePointer();
  }

  /**
   * Least and greatest value for each pixel across.
   * @param {Value} at
   * @param {number} width
   */
  #extents(at, width) {
    const { program, range } = this;
    const low = new Float64Array(width).fill(Infinity), high = new Float64Array(width).fill(-Infinity);
    const first = program.pieceAt(range[0]), last = program.pieceAt(range[1]);
    const scale = width / (range[1] - range[0]);
    for (let i = first; i <= last && i < program.pieces; i++) {
      const begin = (program.time[i] - range[0]) * scale, takes = (program.time[i + 1] - program.time[i]) * scale;
      const from = Math.max(Math.floor(begin), 0), to = Math.min(Math.floor(begin + takes), width - 1);
      for (let x = from; x <= to; x++) {
        // What the piece shows from the left edge of the pixel to its right one, as far as the piece goes.
        for (const edge of [x, x + 1]) {
          const value = at(i, takes > 0 ? Math.min(Math.max((edge - begin) / takes, 0), 1) : Number(edge > x));
          if (value < low[x]) low[x] = value;
          if (value > high[x]) high[x] = value;
        }
      }
    }
    return { low, high };
  }

  redraw() {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const pen = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext("2d"));
    pen.scale(ratio, ratio);
    const style = getComputedStyle(this.canvas);
    const across = Math.max(Math.floor(width - LEFT - RIGHT), 1);
    const tall = (height - GAP - FOOT) / this.strips.length - GAP;
    pen.font = "11px system-ui, sans-serif";
    this.strips.forEach((strip, k) => {
      const top = GAP + k * (tall + GAP);
      const drawn = curvesOf(strip).map((curve) => ({ name: curve.name, ...this.#extents(curve.at, across) }));
      let least = Math.min(...drawn.map(({ low }) => Math.min(...low))), most = Math.max(...drawn.map(({ high }) => Math.max(...high)));
      if (!Number.isFinite(least)) [least, most] = [0, 1];
      const room = Math.max((most - least) * 0.08, 1e-3);
      const y = (/** @type {number} */ value) => top + tall - ((value - least + room) / (most - least + 2 * room)) * tall;
      pen.strokeStyle = style.getPropertyValue("--rule");
      pen.strokeRect(LEFT + 0.5, top + 0.5, across, tall);
      for (const limit of [strip.low, strip.high]) {
        if (limit === null || limit < least - room || limit > most + room) continue;
        pen.strokeStyle = style.getPropertyValue("--bad");
        pen.beginPath(); pen.moveTo(LEFT, y(limit)); pen.lineTo(LEFT + across, y(limit)); pen.stroke();
      }
      drawn.forEach(({ name, low, high }, number) => {
        const colour = number ? MORE[(number - 1) % MORE.length] : style.getPropertyValue("--line-1");
        pen.strokeStyle = pen.fillStyle = colour;
        pen.beginPath();
        for (let x = 0; x < across; x++) {
          if (low[x] > high[x]) continue;
          pen.moveTo(LEFT + x + 0.5, y(low[x]) + 0.5);
          pen.lineTo(LEFT + x + 0.5, y(high[x]) - 0.5);
        }
        pen.stroke();
        pen.textAlign = "right";
        if (drawn.length > 1) pen.fillText(name, LEFT - 6 - 11 * (drawn.length - 1 - number), top + tall / 2 + 11);
      });
      pen.fillStyle = style.getPropertyValue("--ink");
      pen.textAlign = "right";
      pen.fillText(`${strip.name} ${strip.unit}`, LEFT - 6, top + tall / 2 + (drawn.length > 1 ? -2 : 4));
      pen.fillStyle = style.getPropertyValue("--soft");
      // Beside the strip where it is tall enough, else within it: it never goes without its scale.
      const beside = tall > (drawn.length > 1 ? 58 : 30);
      if (!beside) pen.textAlign = "left";
      pen.fillText(rounded(most), beside ? LEFT - 6 : LEFT + 3, top + 10);
      if (beside || tall > 22) pen.fillText(rounded(least), beside ? LEFT - 6 : LEFT + 3, top + tall - 2);
      else { pen.textAlign = "right"; pen.fillText(rounded(least), LEFT + across - 3, top + tall - 2); }
    });
    this.#ticks(pen, across, height - 4);
    pen.fillStyle = style.getPropertyValue("--bad");
    for (const time of this.marks) {
      if (time < this.range[0] || time > this.range[1]) continue;
      pen.fillRect(LEFT + ((time - this.range[0]) / (this.range[1] - this.range[0])) * across - 1, 0, 3, GAP);
    }
    this.#placePointer();
  }

  /**
   * What time it is below the strips.
   * @param {CanvasRenderingContext2D} pen
   * @param {number} across
   * @param {number} base of the text
   */
  #ticks(pen, across, base) {
    const [from, to] = this.range, about = ((to - from) * TICKS) / across;
    const power = 10 ** Math.floor(Math.log10(about));
    const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= about) ?? about;
    pen.textAlign = "center";
    for (let time = Math.ceil(from / step) * step; time <= to; time += step) {
      const x = LEFT + ((time - from) / (to - from)) * across;
      pen.fillRect(x, base - 12, 1, 3);
      pen.fillText(step < 0.1 ? `${time.toPrecision(6)} s` : clock(time + 1e-9), Math.min(x, LEFT + across - 16), base);
    }
  }

  /** Move the line at the cursor: an element of its own, so that nothing is drawn anew. */
  #placePointer() {
    const share = (this.cursor - this.range[0]) / (this.range[1] - this.range[0]);
    this.pointer.style.transform = `translateX(${LEFT + share * (this.canvas.clientWidth - LEFT - RIGHT)}px)`;
  }

  /** All curves, one line for each piece. */
  csv() {
    const curves = this.strips.flatMap((strip) => curvesOf(strip).map(({ name, at }) => ({ name: strip.curves ? `${strip.name} ${name}` : name, unit: strip.unit, at })));
    const rows = [["seconds", "line", ...curves.map(({ name, unit }) => `${name} ${unit}`)].join(",")];
    const { program } = this;
    for (let i = 0; i < program.pieces; i++) {
      const values = curves.map(({ at }) => at(i)).map((value) => (Number.isNaN(value) ? "" : Number(value.toFixed(5))));
      rows.push([program.time[i + 1].toFixed(4), program.line[program.row[i]], ...values].join(","));
    }
    return `${rows.join("\n")}\n`;
  }
}

/** @param {number} value */
const rounded = (value) => String(Number(value.toPrecision(5))).replace("-", "−");

/**
 * @param {Strip} strip
 * @returns {Curve[]}
 */
function curvesOf(strip) { return strip.curves ?? [{ name: strip.name, at: strip.at }]; }
