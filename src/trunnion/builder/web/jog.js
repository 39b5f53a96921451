// The machine moved by hand: a slider and a box for each axis, and where the tool is then.

import { COLOURS } from "./stage.js";
import { say } from "../../viewer/web/texts.js";

export class Jog {
  /**
   * @param {HTMLElement} box
   * @param {HTMLElement} pose
   * @param {import("./stage.js").Stage} stage
   */
  constructor(box, pose, stage) {
    this.box = box;
    this.pose = pose;
    this.stage = stage;
    this.shape = "";
    this.remark = "";
  }

  /**
   * Fit the machine that the stage shows. It stays while the definition has mistakes.
   * @param {string} remark
   */
  show(remark) {
    const { axes } = this.stage.machine;
    this.remark = remark;
    const shape = axes.map((/** @type {any} */ axis) => [axis.name, axis.rotary].join()).join(";");
    if (this.shape !== shape) {
      const home = Object.assign(document.createElement("button"), { type: "button", textContent: say("home") });
      home.addEventListener("click", () => this.move(this.stage.machine.homes));
      this.box.replaceChildren(...axes.map((/** @type {any} */ axis, /** @type {number} */ k) => this.#slider(axis, k)), home);
      this.shape = shape;
    }
    this.#rows().forEach(([range], k) => {
      const { low, high, rotary } = axes[k];
      range.min = String(low ?? (rotary ? -360 : -500));
      range.max = String(high ?? (rotary ? 360 : 500));
    });
    this.move(this.stage.values);
  }

  /** @returns {HTMLInputElement[][]} slider and box of each axis */
  #rows() { return Array.from(this.box.querySelectorAll("label"), (row) => Array.from(row.querySelectorAll("input"))); }

  /**
   * @param {any} axis
   * @param {number} k
   */
  #slider(axis, k) {
    const row = document.createElement("label");
    const name = Object.assign(document.createElement("span"), { textContent: axis.name });
    name.style.borderColor = COLOURS[k];
    const range = Object.assign(document.createElement("input"), { type: "range", step: "any" });
    range.dataset.axis = axis.name;
    range.setAttribute("aria-label", `${say("jog")} ${axis.name}`);
    const moveTo = (/** @type {number} */ value) => this.move(this.stage.values.map((old, j) => (j === k ? value : old)));
    range.addEventListener("input", () => moveTo(Number(range.value)));
    const box = Object.assign(document.createElement("input"), { type: "text", inputMode: "decimal" });
    box.setAttribute("aria-label", `${axis.name} ${axis.rotary ? "°" : "mm"}`);
    // What is being typed is not overwritten, and what is no number stays, in red.
    box.addEventListener("input", () => { box.dataset.held = "true"; });
    box.addEventListener("change", () => {
      const value = box.value.trim() ? Number(box.value) : NaN;
      box.setAttribute("aria-invalid", String(!Number.isFinite(value)));
      if (!Number.isFinite(value)) return;
      delete box.dataset.held;
      moveTo(value);
    });
    const unit = Object.assign(document.createElement("span"), { className: "unit", textContent: axis.rotary ? "°" : "mm" });
    row.append(name, range, box, unit);
    return row;
  }

  /**
   * Move the machine, and say where the tool is; a value beyond its limits is red.
   * @param {number[]} values
   */
  move(values) {
    this.stage.jog(values);
    const { axes, zero } = this.stage.machine;
    this.#rows().forEach(([range, box], k) => {
      range.value = String(values[k]);
      if (box.dataset.held) return;
      box.value = values[k].toFixed(axes[k].rotary ? 3 : 2);
      box.setAttribute("aria-invalid", String(values[k] < (axes[k].low ?? -Infinity) || values[k] > (axes[k].high ?? Infinity)));
    });
    const { tip, axis } = this.stage.tool();
    const of = (/** @type {number[]} */ v, /** @type {number} */ digits) => v.map((x) => x.toFixed(digits)).join("  ");
    this.pose.textContent = [`${say("tip")} ${of(tip, 3)} mm   ${say("toolAxis")} ${of(axis, 6)}`, zero ? "" : say("zero"), this.remark].filter(Boolean).join("\n");
  }
}
