// The page: what its controls do, and how time, picture, text and curves follow one another.

import { readColumn, readLine, readScene, readText } from "./data.js";
import { Curves } from "./curves.js";
import { Listing } from "./listing.js";
import { followMachine } from "./live.js";
import { Program } from "./program.js";
import { Space } from "./space.js";
import { Places, Stock } from "./stock.js";
import { LANGUAGE, say } from "./texts.js";
import { Twin } from "./twin.js";

/** Slowest and fastest play, times real time; the slider is their logarithm. */
const SPEEDS = [0.1, 1000];

/** A cursor that has not moved for so long rests, ms. */
const RESTS = 80;

/** Keys that a slider or a text that has the focus takes itself. */
const OF_SLIDERS = new Set(["ArrowLeft", "ArrowRight", "Home", "End"]);

/**
 * @param {string} id
 * @returns {any}
 */
const element = (id) => document.getElementById(id);

/** What a piece is coloured by: least and greatest become the ends of the scale. */
const SCALE = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const KINDS = [[200, 120, 40], [30, 110, 200], [20, 150, 130]];
const PALETTE = [[31, 119, 180], [255, 127, 14], [44, 160, 44], [214, 39, 40], [148, 103, 189], [140, 86, 75], [227, 119, 194], [23, 190, 207]];
/** Phases of motions, from 1, as trunnion.model.toolpath has them. */
const PHASES = ["rapid", "approach", "engage", "cut", "stepover", "retract", "departure", "traverse"];
/** Colours that the legend tells at most. */
const MOST_ENTRIES = 8;
const FINDING = [220, 30, 40], QUIET = [150, 160, 170];

/** @param {number} share from 0 to 1 */
function scaled(share) {
  const at = Math.min(Math.max(share, 0), 1) * (SCALE.length - 1), k = Math.min(Math.floor(at), SCALE.length - 2);
  return SCALE[k].map((low, j) => Math.round(low + (at - k) * (SCALE[k + 1][j] - low)));
}

class Page {
  /**
   * @param {Program} program
   * @param {Space} space
   * @param {Listing} listing
   * @param {Stock | null} stock
   * @param {Twin | null} twin
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
    this.places = new Places(space, program.scene.findings);
    this.time = 0;
    this.playing = false;
    this.shownFile = -1;
    this.placesAsked = 0;
    /** Whether the text of that file is there, and still wanted. */
    this.opening = Promise.resolve(true);
    /** @type {number[]} */
    this.measuring = [];
    this.isMeasuring = false;
    /** File and line of the CL statement that is shown. */
    this.clLine = "";
    this.clTimer = 0;
    this.curves = new Curves(element("curves"), program, this.#strips(), (time) => this.goTo(time));
    this.curves.marks = this.scene.findings.map((each) => program.timeOf(each.row));
    if (!program.phase) document.querySelector("#colour option[value=phase]")?.remove();
    this.paint();
    this.#listen();
    this.#fillFindings();
  }

  #strips() {
    const { program } = this;
    const axes = program.machine.axes.map((axis, k) => ({
      name: axis.name, unit: axis.rotary ? "°" : "mm", low: axis.placed ? axis.low : null, high: axis.placed ? axis.high : null,
      at: (/** @type {number} */ piece) => program.axes[k][piece + 1],
    }));
    /** @type {any} */
    const feed = { name: "F", unit: "mm/min", low: null, high: null, at: (/** @type {number} */ piece) => program.feed[program.row[piece]] };
    /** @type {any} */
    const rotary = { name: "ω", unit: "°/min", low: null, high: null, at: (/** @type {number} */ piece) => this.rotarySpeed(piece) };
    const limited = program.machine.axes.flatMap((axis, k) => (axis.placed && axis.low !== null && axis.high !== null ? [k] : []));
    /** @type {any} */
    const room = {
      name: say("limits"), unit: "%", low: 0, high: null,
      curves: limited.map((k) => ({ name: program.machine.axes[k].name, at: (/** @type {number} */ piece) => this.room(k, piece) })),
    };
    return [...axes, rotary, feed, ...(limited.length ? [room] : [])];
  }

  /**
   * Speed of the faster rotary axis, degrees a minute; 0 where no time is known.
   * @param {number} piece
   */
  rotarySpeed(piece) {
    const { program } = this;
    const takes = program.time[piece + 1] - program.time[piece];
    if (!(takes > 0) || !this.scene.timed) return 0;
    let most = 0;
    program.machine.axes.forEach((axis, k) => {
      if (axis.rotary) most = Math.max(most, Math.abs(program.axes[k][piece + 1] - program.axes[k][piece]));
    });
    return (60 * most) / takes;
  }

  /**
   * How far an axis is from the nearer of its limits, in parts of a hundred of its travel.
   * @param {number} k number of the axis
   * @param {number} piece
   */
  room(k, piece) {
    const { low, high } = this.program.machine.axes[k], value = this.program.axes[k][piece + 1];
    return (100 * Math.min(value - low, high - value)) / (high - low);
  }

  /** Colour the path by what is chosen. */
  paint() {
    const { program } = this;
    const by = element("colour").value;
    if (by === "kind") {
      this.space.paint((piece) => KINDS[program.kind[program.row[piece]]] ?? QUIET);
      this.#legend(["rapid", "straight", "circle"].map((kind, k) => [say(kind), KINDS[k]]));
    } else if (by === "phase") {
      this.space.paint((piece) => PALETTE[program.phase[program.row[piece]] - 1] ?? QUIET);
      const there = new Set(program.phase);
      this.#legend(PHASES.map((name, k) => [say(name), PALETTE[k]]).filter((_, k) => there.has(k + 1)));
    } else if (by === "tool") {
      this.space.paint((piece) => PALETTE[program.tool[program.row[piece]] % PALETTE.length]);
      this.#legend(this.scene.tools.map((tool, k) => [tool.name || "0", PALETTE[k % PALETTE.length]]));
    } else if (by === "operation") {
      this.space.paint((piece) => PALETTE[this.#operationOf(program.row[piece]) % PALETTE.length] ?? QUIET);
      this.#legend(this.scene.operations.map((one, k) => [one.name, PALETTE[k % PALETTE.length]]));
    } else if (by === "finding") {
      const rows = new Set(this.scene.findings.map((each) => each.row));
      this.space.paint((piece) => (rows.has(program.row[piece]) ? FINDING : QUIET));
      this.#legend([[say("finding"), FINDING]]);
    } else if (by === "deviation" && this.stock) {
      const { stock } = this;
      this.space.paint((piece) => stock.colourOf(stock.rowOff[program.row[piece]]));
      this.#legend([]);
    } else {
      const value = by === "feed" ? (/** @type {number} */ piece) => program.feed[program.row[piece]] : (/** @type {number} */ piece) => this.rotarySpeed(piece);
      let most = 0;
      for (let i = 0; i < program.pieces; i++) if (program.kind[program.row[i]] !== 0) most = Math.max(most, value(i));
      this.space.paint((piece) => scaled(value(piece) / (most || 1)));
      const unit = by === "feed" ? "mm/min" : "°/min";
      this.#legend(SCALE.map((colour, k) => [`${((most * k) / (SCALE.length - 1)).toFixed(0)}${k === SCALE.length - 1 ? ` ${unit}` : ""}`, colour]));
    }
    this.#scale();
  }

  /**
   * What the colours of the path mean, the first of them.
   * @param {(string | number[])[][]} entries name and colour
   */
  #legend(entries) {
    element("legend").replaceChildren(...entries.slice(0, MOST_ENTRIES).map(([name, colour]) => {
      const entry = Object.assign(document.createElement("span"), { className: "entry", textContent: String(name) });
      entry.style.borderColor = `rgb(${/** @type {number[]} */ (colour).join()})`;
      return entry;
    }));
    if (entries.length > MOST_ENTRIES) element("legend").append("…");
  }

  /** The scale of deviations stands where something is coloured by them. */
  #scale() {
    const { stock } = this;
    element("scale").hidden = !stock?.data.deviation || (stock.mode !== "deviation" && element("colour").value !== "deviation");
    if (stock && !element("scale").hidden) stock.drawScale(element("scale-bar"), element("scale-text"));
  }

  /** @param {number} row */
  #operationOf(row) {
    const found = this.scene.operations.findIndex((one) => row >= one.first && row < one.end);
    return found < 0 ? PALETTE.length - 1 : found;
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
    this.#showLine(row);
  }

  /**
   * Show a machine where it is, at the row that it runs.
   * @param {number[]} values of the five axes
   * @param {number} row
   */
  showMachineAt(values, row) {
    this.row = row;
    this.space.setPose(values, row);
    this.#readOut(values, row);
    this.#showLine(row);
  }

  /** @param {number} row */
  async #showLine(row) {
    if (!this.program.rows) await this.#showFile(Math.max(this.shownFile, 0));
    else await this.#showPlace(this.program.file[row], this.program.line[row]);
  }

  /**
   * Show a line of a file, unless another one has been asked for when its text is there.
   * @param {number} file
   * @param {number} line from 1
   */
  async #showPlace(file, line) {
    const place = ++this.placesAsked;
    if (await this.#showFile(file) && place === this.placesAsked) this.listing.show(line);
  }

  /**
   * Show the text of a file of the program; whether it is still the one that is wanted when it is there.
   * @param {number} file
   */
  #showFile(file) {
    if (file !== this.shownFile) {
      this.shownFile = file;
      element("file").value = String(file);
      this.opening = this.#open(file);
    }
    return this.opening;
  }

  /** @param {number} file */
  async #open(file) {
    const text = await readTextOnce(file);
    if (this.shownFile !== file) return false;
    this.listing.marks = new Map(this.scene.findings.filter((each) => each.file === file).map((each) => [each.line, "finding"]));
    this.listing.setText(text);
    return true;
  }

  /**
   * Go to what was found: to its block, and to its line where no block moves.
   * @param {import("./data.js").Mark} finding
   */
  async goToFinding(finding) {
    this.goToRow(finding.row);
    if (finding.line > 0) await this.#showPlace(finding.file, finding.line);
  }

  /**
   * The line of the CL file that a row comes from; its text follows where the cursor rests.
   * @param {number} row
   */
  #showClLine(row) {
    const line = this.program.rows ? this.program.cl[row] : 0;
    const file = this.scene.operations.find((one) => row >= one.first && row < one.end)?.cl ?? -1;
    const wanted = `${file}:${line}`;
    if (wanted === this.clLine) return;
    this.clLine = wanted;
    const several = this.scene.clFiles.length > 1 && file >= 0 ? `${this.scene.clFiles[file].split(/[\\/]/).pop()}:` : "";
    element("cl").textContent = line > 0 ? `${say("cl")} ${several}${line}` : "";
    clearTimeout(this.clTimer);
    if (!(line > 0) || file < 0) return;
    this.clTimer = setTimeout(async () => {
      const text = await readLine(this.scene.clText + file, line);
      if (this.clLine === wanted) element("cl").textContent += `: ${text}`;
    }, RESTS);
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
      return `<dt>${escaped(one.name)}</dt><dd class="${out ? "out" : ""}">${value.toFixed(4)}</dd>`;
    });
    const three = (/** @type {ArrayLike<number>} */ v, /** @type {number} */ digits) => Array.from(v, (part) => part.toFixed(digits)).join("  ");
    const tool = this.scene.tools[program.rows ? program.tool[row] : 0]?.name ?? "";
    const rows = [
      [say("tip"), three(tip, 4)], [say("toolAxis"), three(axis, 5)], ["F", program.rows ? program.feed[row].toFixed(0) : ""], [say("tool"), tool],
      [say("against"), `${clock(this.time)} / ${clock(program.end)}`],
    ];
    element("values").innerHTML = shown.join("") + rows.map(([name, value]) => `<dt>${escaped(name)}</dt><dd>${escaped(value)}</dd>`).join("");
    this.#showClLine(row);
  }

  #fillFindings() {
    const list = element("findings");
    const failed = this.scene.checks.filter((check) => !check.passed);
    element("findings-title").textContent = `${say("findings")}: ${this.scene.findings.length}`;
    for (const check of failed) {
      const line = document.createElement("li");
      line.textContent = `${check.key}: ${check.summary}`;
      list.append(line);
    }
    this.scene.findings.forEach((each) => {
      const line = document.createElement("li"), button = document.createElement("button");
      button.type = "button";
      button.textContent = `${say("line")} ${each.line}: ${each.text}`;
      button.addEventListener("click", () => this.goToFinding(each));
      line.append(button);
      list.append(line);
    });
  }

  /**
   * Go to the next or the previous of some rows.
   * @param {number[]} rows
   * @param {number} step 1 or -1
   */
  jump(rows, step) {
    const sorted = [...new Set(rows)].sort((a, b) => a - b);
    const found = step > 0 ? sorted.find((row) => row > this.row) : sorted.reverse().find((row) => row < this.row);
    if (found !== undefined) this.goToRow(found);
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
    this.#tellSpeed();
  }

  #tellSpeed() { element("speed-text").textContent = `${this.speed < 10 ? this.speed.toFixed(1) : this.speed.toFixed(0)} ×`; }

  search(backwards = false) {
    const words = element("search").value.trim();
    if (!words) return;
    const line = this.listing.find(words, this.listing.current || 1, backwards);
    element("status").textContent = line ? "" : say("notFound");
    if (line) this.goToLine(line);
  }

  /** @param {number} line of the file that is shown, from 1 */
  goToLine(line) {
    const row = this.program.rowOfLine(this.shownFile, line, this.row);
    this.goToRow(row);
    this.placesAsked++;
    this.listing.show(line);
  }

  picture() { save(this.space.picture(), "view.png"); }

  #showStock() {
    this.stock?.setMode(element("stock").value);
    this.#scale();
  }

  /** Show the stock otherwise. */
  #nextStock() {
    const values = Array.from(element("stock").options).filter((each) => !each.disabled).map((each) => each.value);
    element("stock").value = values[(values.indexOf(element("stock").value) + 1) % values.length];
    this.#showStock();
  }

  /**
   * @param {string} from
   * @param {boolean} near
   */
  #look(from, near = false) { for (const space of this.spaces) space.look(from, near); }

  /** @param {any} frame */
  #setFrame(frame) { for (const space of this.spaces) space.setFrame(frame); }

  #section() {
    this.stock?.setOpen(element("section").value !== "");
    for (const space of this.spaces) space.section(element("section").value, Number(element("section-at").value));
  }

  #pickAt(/** @type {PointerEvent} */ event) {
    const box = this.space.canvas.getBoundingClientRect();
    const finding = this.isMeasuring ? -1 : this.places.pick(event.clientX - box.left, event.clientY - box.top);
    if (finding >= 0) { this.goToFinding(this.scene.findings[finding]); return; }
    const piece = this.space.pick(event.clientX - box.left, event.clientY - box.top);
    if (piece < 0) return;
    if (!this.isMeasuring) { this.goToRow(this.program.row[piece]); return; }
    this.measuring = [...this.measuring, piece].slice(-2);
    if (this.measuring.length < 2) return;
    const { length, away } = this.space.measure(this.measuring[0], this.measuring[1]);
    element("status").textContent = `${say("distance")} ${length.toFixed(4)} mm (${away.map((/** @type {number} */ part) => part.toFixed(4)).join("  ")})`;
    this.measuring = [];
  }

  #measure() {
    this.isMeasuring = !this.isMeasuring;
    this.measuring = [];
    element("measure").setAttribute("aria-pressed", String(this.isMeasuring));
    element("status").textContent = this.isMeasuring ? say("measureHint") : "";
    if (!this.isMeasuring) this.space.clearMeasure();
  }

  #listen() {
    const on = (/** @type {string} */ id, /** @type {string} */ kind, /** @type {(event: any) => void} */ done) => element(id).addEventListener(kind, done);
    on("play", "click", () => this.play());
    on("first", "click", () => this.goToRow(0));
    on("back", "click", () => this.goToRow(this.row - 1));
    on("step", "click", () => this.goToRow(this.row + 1));
    on("last", "click", () => this.goToRow(this.program.rows - 1));
    on("scrub", "input", (event) => { this.space.hurry(true); this.goTo(Number(event.target.value) * this.program.end); });
    on("scrub", "change", () => this.space.hurry(false));
    on("speed", "input", () => this.#tellSpeed());
    on("colour", "change", () => this.paint());
    on("stock", "change", () => this.#showStock());
    on("view", "change", (event) => this.#look(event.target.value, true));
    on("frame", "change", (event) => this.#setFrame(event.target.value));
    on("section", "change", () => this.#section());
    on("section-at", "input", () => this.#section());
    on("bodies", "change", (event) => this.spaces.forEach((space) => space.showMachine(event.target.checked)));
    on("path", "change", (event) => this.spaces.forEach((space) => space.showPath(event.target.checked)));
    on("file", "change", (event) => this.#chooseFile(Number(event.target.value)));
    on("search", "keydown", (event) => { if (event.key === "Enter") this.search(event.shiftKey); });
    on("measure", "click", () => this.#measure());
    on("picture", "click", () => this.picture());
    on("csv", "click", () => save(URL.createObjectURL(new Blob([this.curves.csv()], { type: "text/csv" })), "curves.csv"));
    on("help", "click", () => element("keys").showModal());
    on("close", "click", () => element("keys").close());
    let down = [0, 0];
    on("space", "pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    on("space", "pointerup", (event) => { if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) this.#pickAt(event); });
    document.addEventListener("keydown", (event) => this.#key(event));
    this.#tellSpeed();
  }

  /** @param {number} file */
  #chooseFile(file) {
    const row = this.program.rowOfLine(file, 0);
    if (this.program.rows && this.program.file[row] === file) this.goToRow(row);
    else this.#showFile(file);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const target = /** @type {HTMLElement} */ (event.target);
    if (event.ctrlKey || event.metaKey || event.altKey || target.matches("input[type=search], select") || element("keys").open) return;
    // Controls keep the keys that are theirs: the space bar presses and ticks, arrows move a slider, Home scrolls a text.
    if (event.key === " " && target.matches("button, input")) return;
    if (OF_SLIDERS.has(event.key) && target.matches("input[type=range], #listing, #listing-b")) return;
    const rows = (/** @type {string} */ kind) => this.scene.events.filter((each) => each.kind.startsWith(kind)).map((each) => each.row);
    /** @type {Record<string, () => void>} */
    const keys = {
      " ": () => this.play(), ArrowRight: () => this.goToRow(this.row + 1), ArrowLeft: () => this.goToRow(this.row - 1),
      Home: () => this.goToRow(0), End: () => this.goToRow(this.program.rows - 1),
      "+": () => this.changeSpeed(0.05), "-": () => this.changeSpeed(-0.05),
      n: () => this.jump(this.scene.findings.map((each) => each.row), 1), N: () => this.jump(this.scene.findings.map((each) => each.row), -1),
      t: () => this.jump(rows("tool"), 1), T: () => this.jump(rows("tool"), -1),
      o: () => this.jump(this.scene.operations.map((one) => one.first), 1), O: () => this.jump(this.scene.operations.map((one) => one.first), -1),
      r: () => this.jump(rows("rewind"), 1), R: () => this.jump(rows("rewind"), -1),
      1: () => this.#look("iso"), 2: () => this.#look("top", true), 3: () => this.#look("front", true), 4: () => this.#look("right", true),
      f: () => { const other = element("frame").value === "part" ? "machine" : "part"; element("frame").value = other; this.#setFrame(other); },
      s: () => this.#nextStock(),
      "/": () => element("search").focus(), m: () => this.#measure(), p: () => this.picture(), "?": () => element("keys").showModal(),
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  }
}

/** @type {Map<number, Promise<Uint8Array>>} */
const TEXTS_READ = new Map();

/** @param {number} file */
function readTextOnce(file) {
  if (!TEXTS_READ.has(file)) TEXTS_READ.set(file, readText(file));
  return /** @type {Promise<Uint8Array>} */ (TEXTS_READ.get(file));
}

/** @param {string} text */
function escaped(text) {
  const box = document.createElement("span");
  box.textContent = text;
  return box.innerHTML;
}

/** @param {number} seconds */
function clock(seconds) {
  const whole = Math.floor(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}.${Math.floor((seconds - whole) * 10)}`;
}

/**
 * @param {string} address
 * @param {string} name
 */
function save(address, name) {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}

/** Put the words of the language where the page has keys for them. */
function putTexts() {
  document.documentElement.lang = LANGUAGE;
  document.querySelectorAll("[data-say]").forEach((each) => { each.textContent = say(/** @type {HTMLElement} */ (each).dataset.say ?? ""); });
  document.querySelectorAll("[data-label]").forEach((each) => {
    const text = say(/** @type {HTMLElement} */ (each).dataset.label ?? "");
    each.setAttribute("aria-label", text);
    each.setAttribute("title", text);
  });
}

/** @param {import("./data.js").SceneData} scene */
function remarksOf(scene) {
  const found = scene.tools.filter((tool) => !tool.known).map((tool) => say("toolForm", tool.name));
  if (!scene.machine.zero) found.unshift(say("zero"));
  if (!scene.timed) found.push(say("untimed"));
  if (scene.against?.pairs === 0) found.push(say("apart"));
  return [...found, ...(scene.stock?.remarks ?? [])];
}

/**
 * Read what the page holds of the stock, and show its controls.
 * @param {Stock} stock
 */
async function openStock(stock) {
  await stock.open();
  element("stock-label").hidden = false;
  for (const option of document.querySelectorAll("option[value=deviation]")) {
    const lacks = !stock.data.deviation;
    Object.assign(option, { hidden: lacks, disabled: lacks });
  }
}

/**
 * The second program, if there is one, with what the page has for it.
 * @param {import("./data.js").SceneData} scene
 * @param {Record<string, any>} columns
 * @param {Program} program
 */
function openTwin(scene, columns, program) {
  if (!scene.against) return null;
  document.body.classList.add("twin");
  for (const id of ["space-b", "listing-b"]) element(id).hidden = false;
  return new Twin(element("space-b"), element("listing-b"), scene, columns, program, readTextOnce);
}

async function start() {
  putTexts();
  const scene = readScene();
  /** @type {Record<string, any>} */
  const columns = {};
  await Promise.all(Object.keys(scene.columns).map(async (name) => { columns[name] = await readColumn(scene, name); }));
  const program = new Program(scene, columns);
  const space = new Space(element("space"), program, columns);
  const file = element("file");
  scene.files.forEach((name, k) => file.append(new Option(name.split(/[\\/]/).pop(), String(k))));
  /** @type {Listing} */
  const listing = new Listing(element("listing"), (line) => page.goToLine(line));
  const stock = scene.stock ? new Stock(space, program, columns, element("stock-status")) : null;
  if (stock) await openStock(stock);
  /** @type {Page} */
  const page = new Page(program, space, listing, stock, openTwin(scene, columns, program));
  const paper = () => page.spaces.forEach((each) => each.setBackground(getComputedStyle(document.body).getPropertyValue("--sky").trim()));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { paper(); page.curves.redraw(); });
  paper();
  page.goToRow(0);
  stock?.setMode("cut");
  for (const each of page.spaces) { each.look("iso"); each.tryPace(); }
  element("remarks").textContent = remarksOf(scene).join(" ");
  element("status").textContent = "";
  if (scene.live) followMachine(page, element("live-place"));
  Object.assign(window, { page });
  document.documentElement.dataset.ready = "true";
}

start().catch((error) => { element("status").textContent = String(error); });
