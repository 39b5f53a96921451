// What the page shows, and how time, picture, text and curves follow one another.

import { listen } from "./controls.js";
import { Curves } from "./curves.js";
import { clock, element, escaped, prose, save } from "./elements.js";
import { PathColours } from "./path_colours.js";
import { ProgramText } from "./program_text.js";
import { Places } from "./stock.js";
import { strips } from "./strips.js";
import { say } from "./texts.js";

/** Slowest and fastest play, times real time; the slider is their logarithm. */
const SPEEDS = [0.1, 1000];

export class Page {
  /**
   * @param {import("./program.js").Program} program
   * @param {import("./space.js").Space} space
   * @param {import("./listing.js").Listing} listing
   * @param {import("./stock.js").Stock | null} stock
   * @param {import("./twin.js").Twin | null} twin
   */
  constructor(program, space, listing, stock, twin) {
    this.program = program;
    this.scene = program.scene;
    this.space = space;
    this.listing = listing;
    this.stock = stock;
    this.twin = twin;
    this.spaces = twin ? [space, twin.space] : [space];
    if (twin) twin.onRow = (row) => this.goToRow(row);
    this.text = new ProgramText(program, listing);
    this.places = new Places(space, program.scene.findings);
    this.time = 0;
    this.playing = false;
    /** @type {number[]} */
    this.measuring = [];
    this.isMeasuring = false;
    this.curves = new Curves(element("curves"), program, strips(program), (time) => this.goTo(time));
    this.curves.marks = this.scene.findings.map((each) => program.timeOf(each.row));
    this.colours = new PathColours(program, space, stock);
    this.colours.paint();
    listen(this);
    this.#fillFindings();
  }

  /**
   * Show a moment.
   * @param {number} time
   */
  goTo(time) {
    const { program } = this;
    const within = Math.min(Math.max(time, 0), program.end);
    this.#show(within, program.rowAt(within), program.valuesAt(within));
  }

  /**
   * Show the end of a row: times cannot tell it from rows after it that take none.
   * @param {number} wanted
   */
  goToRow(wanted) {
    const { program } = this;
    const row = Math.min(Math.max(wanted, 0), Math.max(program.rows - 1, 0));
    this.#show(program.timeOf(row), row, program.valuesAfter(row));
  }

  /**
   * @param {number} time
   * @param {number} row
   * @param {number[]} values of the five axes
   */
  #show(time, row, values) {
    this.time = time;
    this.row = row;
    this.space.setPose(values, row);
    const atEnd = time >= this.program.timeOf(row);
    this.stock?.show(atEnd ? row + 1 : row);
    this.twin?.show(time, row, atEnd);
    this.curves.setCursor(time);
    element("scrub").value = String(this.program.end ? time / this.program.end : 0);
    this.#readOut(values, row);
    this.text.showRow(row);
  }

  /**
   * Show a machine where it is, at the row that it runs.
   * @param {number[]} values of the five axes
   * @param {number} row
   */
  showMachineAt(values, row) {
    this.row = row;
    this.time = this.program.timeOf(row);
    this.space.setPose(values, row);
    this.curves.setCursor(this.time);
    element("scrub").value = String(this.program.end ? this.time / this.program.end : 0);
    this.#readOut(values, row);
    this.text.showRow(row);
  }

  /**
   * Go to what was found: to its block, and to its line where no block moves.
   * @param {import("./data.js").Mark} finding
   */
  async goToFinding(finding) {
    const { program } = this, { place } = finding;
    this.goToRow(finding.row);
    // A motion may be long: what was found stands where it is, and not at its end.
    if (place) {
      const time = program.timeNear(finding.row, place);
      this.#show(time, finding.row, program.valuesIn(finding.row, time));
    }
    if (finding.line > 0) await this.text.showPlace(finding.file, finding.line);
  }

  /**
   * @param {number[]} values
   * @param {number} row
   */
  #readOut(values, row) {
    const { program } = this;
    const { tip, axis } = this.space.toolOf(values, row);
    const shown = program.machine.axes.map((one, k) => {
      const value = one.displayLow === null ? values[k] : ((((values[k] - one.displayLow) % 360) + 360) % 360) + one.displayLow;
      const out = one.placed && ((one.low !== null && values[k] < one.low - 1e-6) || (one.high !== null && values[k] > one.high + 1e-6));
      return `<dt>${escaped(one.name)}</dt><dd class="${out ? "out" : ""}">${value.toFixed(4)} ${one.rotary ? "°" : "mm"}</dd>`;
    });
    const three = (/** @type {ArrayLike<number>} */ v, /** @type {number} */ digits) => Array.from(v, (part) => part.toFixed(digits)).join("  ");
    const tool = this.scene.tools[program.rows ? program.tool[row] : 0]?.name ?? "";
    const rows = [
      [say("tip"), `${three(tip, 4)} mm`], [say("toolAxis"), three(axis, 5)], ["F", program.rows && program.feed[row] >= 0 ? `${program.feed[row].toFixed(0)} mm/min` : ""], [say("tool"), tool],
      [say("against"), `${clock(this.time)} / ${clock(program.end)} min`],
    ];
    element("values").innerHTML = shown.join("") + rows.map(([name, value]) => `<dt>${escaped(name)}</dt><dd>${escaped(value)}</dd>`).join("");
    this.text.showClLine(row);
  }

  #fillFindings() {
    const list = element("findings");
    element("standing").textContent = this.scene.standing;
    element("basis").className = this.scene.verdict;
    element("findings-title").textContent = say("findings", { count: this.scene.findings.length });
    for (const check of this.scene.checks.filter((one) => one.state !== "ok")) {
      const line = document.createElement("li");
      line.append(...prose(say("judged", { check: check.key, state: check.said, what: check.summary })));
      (check.state === "FAIL" ? list : element("unchecked")).append(line);
    }
    for (const text of this.scene.stands) {
      const line = document.createElement("li");
      line.append(...prose(text));
      element("unchecked").append(line);
    }
    this.scene.findings.forEach((each) => {
      const line = document.createElement("li"), button = document.createElement("button");
      button.type = "button";
      button.append(...prose(say("found", { line: each.line, what: each.text })));
      button.addEventListener("click", () => this.goToFinding(each));
      line.append(button);
      list.append(line);
    });
  }

  /**
   * Go to the next or the previous of some rows.
   * @param {number[]} rows
   * @param {number} step 1 or -1
   * @returns {number | undefined} the row
   */
  jump(rows, step) {
    const sorted = [...new Set(rows)].sort((a, b) => a - b);
    const found = step > 0 ? sorted.find((row) => row > this.row) : sorted.reverse().find((row) => row < this.row);
    if (found !== undefined) this.goToRow(found);
    return found;
  }

  /**
   * Go to the next or the previous finding.
   * @param {number} step 1 or -1
   */
  jumpToFinding(step) {
    const { findings } = this.scene, row = this.jump(findings.map((each) => each.row), step);
    const found = findings.find((each) => each.row === row);
    if (found) this.goToFinding(found);
  }

  play() {
    this.playing = !this.playing;
    element("play").textContent = this.playing ? "❚❚" : "▶";
    element("play").setAttribute("aria-label", say(this.playing ? "pause" : "play"));
    if (!this.playing) { this.space.hurry(false); return; }
    if (this.time >= this.program.end) this.time = 0;
    let before = performance.now();
    const next = (/** @type {number} */ now) => {
      if (!this.playing) return;
      this.goTo(this.time + ((now - before) / 1000) * this.speed);
      before = now;
      if (this.time >= this.program.end) this.play();
      else requestAnimationFrame(next);
    };
    this.space.hurry(true);
    requestAnimationFrame(next);
  }

  get speed() {
    const share = Number(element("speed").value);
    return SPEEDS[0] * (SPEEDS[1] / SPEEDS[0]) ** share;
  }

  /** @param {number} change of the slider */
  changeSpeed(change) {
    element("speed").value = String(Number(element("speed").value) + change);
    this.tellSpeed();
  }

  tellSpeed() { element("speed-text").textContent = `${this.speed < 10 ? this.speed.toFixed(1) : this.speed.toFixed(0)} ×`; }

  search(backwards = false) {
    const words = element("search").value.trim();
    if (!words) return;
    const line = this.listing.find(words, this.listing.current || 1, backwards);
    element("status").textContent = line ? "" : say("notFound");
    if (line) this.goToLine(line);
  }

  /** @param {number} line of the file that is shown, from 1 */
  goToLine(line) {
    this.goToRow(this.program.rowOfLine(this.text.shownFile, line, this.row));
    this.text.showHere(line);
  }

  picture() { save(this.space.picture(), "view.png"); }

  showStock() {
    this.stock?.setMode(element("stock").value);
    this.colours.showScale();
  }

  /** Show the stock otherwise. */
  nextStock() {
    const values = Array.from(element("stock").options).filter((each) => !each.disabled).map((each) => each.value);
    element("stock").value = values[(values.indexOf(element("stock").value) + 1) % values.length];
    this.showStock();
  }

  /**
   * @param {string} from
   * @param {boolean} near
   */
  look(from, near = false) {
    element("view").value = from;
    for (const space of this.spaces) space.look(from, near);
  }

  /** @param {any} frame */
  setFrame(frame) { for (const space of this.spaces) space.setFrame(frame); }

  section() {
    const isOpen = element("section").value !== "";
    element("section-at").hidden = !isOpen;
    this.stock?.setOpen(isOpen);
    for (const space of this.spaces) space.section(element("section").value, Number(element("section-at").value));
  }

  pickAt(/** @type {PointerEvent} */ event) {
    const box = this.space.canvas.getBoundingClientRect();
    const finding = this.isMeasuring ? -1 : this.places.pick(event.clientX - box.left, event.clientY - box.top);
    if (finding >= 0) { this.goToFinding(this.scene.findings[finding]); return; }
    const piece = this.space.pick(event.clientX - box.left, event.clientY - box.top);
    if (piece < 0) return;
    if (!this.isMeasuring) { this.goToRow(this.program.row[piece]); return; }
    this.measuring = [...this.measuring, piece].slice(-2);
    if (this.measuring.length < 2) return;
    const { length, away } = this.space.measure(this.measuring[0], this.measuring[1]);
    element("status").textContent = `${say("distance")} ${length.toFixed(4)} mm (${away.map((/** @type {number} */ part) => part.toFixed(4)).join("  ")} mm)`;
    this.measuring = [];
  }

  measure() {
    this.isMeasuring = !this.isMeasuring;
    this.measuring = [];
    element("measure").setAttribute("aria-pressed", String(this.isMeasuring));
    element("status").textContent = this.isMeasuring ? say("measureHint") : "";
    if (!this.isMeasuring) this.space.clearMeasure();
  }

  /** @param {number} file */
  chooseFile(file) {
    const row = this.program.rowOfLine(file, 0);
    if (this.program.rows && this.program.file[row] === file) this.goToRow(row);
    else this.text.showFile(file);
  }

}
