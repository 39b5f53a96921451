// How the path is coloured, and what its colours mean.

import { element } from "./elements.js";
import { rotarySpeed } from "./strips.js";
import { say } from "./texts.js";

/** What a piece is coloured by: least and greatest become the ends of the scale. */
const SCALE = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const KINDS = [[200, 120, 40], [30, 110, 200], [20, 150, 130]];
const PALETTE = [[31, 119, 180], [255, 127, 14], [44, 160, 44], [214, 39, 40], [148, 103, 189], [140, 86, 75], [227, 119, 194], [23, 190, 207]];
/** Phases of motions, from 1, as trunnion.model.toolpath has them. */
const PHASES = /** @type {PlainKey[]} */ (["rapid", "approach", "engage", "cut", "stepover", "retract", "departure", "traverse"]);
/** Colours that the legend tells at most. */
const MOST_ENTRIES = 8;
/** That of the current block, as ``space.js`` draws it. */
const CURRENT = [255, 45, 160];
const FINDING = [220, 30, 40], QUIET = [150, 160, 170];

/** @param {number} share from 0 to 1 */
function scaled(share) {
  const at = Math.min(Math.max(share, 0), 1) * (SCALE.length - 1), k = Math.min(Math.floor(at), SCALE.length - 2);
  return SCALE[k].map((low, j) => Math.round(low + (at - k) * (SCALE[k + 1][j] - low)));
}

export class PathColours {
  /**
   * @param {import("./program.js").Program} program
   * @param {import("./space.js").Space} space
   * @param {import("./stock.js").Stock | null} stock
   */
  constructor(program, space, stock) {
    this.program = program;
    this.scene = program.scene;
    this.space = space;
    this.stock = stock;
    if (!program.phase) document.querySelector("#colour option[value=phase]")?.remove();
  }

  /** Colour the path by what is chosen. */
  paint() {
    const { program } = this;
    const by = element("colour").value;
    if (by === "kind") {
      this.space.paint((piece) => KINDS[program.kind[program.row[piece]]] ?? QUIET);
      this.#legend(/** @type {PlainKey[]} */ (["rapid", "straight", "circle"]).map((kind, k) => [say(kind), KINDS[k]]));
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
      const speed = by === "feed" ? (/** @type {number} */ piece) => program.feedOf(program.row[piece]) : (/** @type {number} */ piece) => rotarySpeed(program, piece);
      const value = (/** @type {number} */ piece) => speed(piece) || 0; // one that is not known has the colour of none
      let most = 0;
      for (let i = 0; i < program.pieces; i++) if (program.kind[program.row[i]] !== 0) most = Math.max(most, value(i));
      const isRapid = (/** @type {number} */ piece) => by === "feed" && program.kind[program.row[piece]] === 0;
      this.space.paint((piece) => (isRapid(piece) ? QUIET : scaled(value(piece) / (most || 1))));
      const unit = by === "feed" ? "mm/min" : "°/min";
      const scale = SCALE.map((colour, k) => [`${((most * k) / (SCALE.length - 1)).toFixed(0)}${k === SCALE.length - 1 ? ` ${unit}` : ""}`, colour]);
      this.#legend(by === "feed" ? [...scale, [say("rapid"), QUIET]] : scale);
    }
    this.showScale();
  }

  /**
   * What the colours of the path mean, the first of them.
   * @param {(string | number[])[][]} entries name and colour
   */
  #legend(entries) {
    const shown = (/** @type {(string | number[])[]} */ [name, colour]) => {
      const className = name === say("rapid") ? "entry dashed" : "entry";
      const entry = Object.assign(document.createElement("span"), { className, textContent: String(name) });
      entry.style.borderColor = `rgb(${/** @type {number[]} */ (colour).join()})`;
      return entry;
    };
    element("legend").replaceChildren(...entries.slice(0, MOST_ENTRIES).map(shown));
    if (entries.length > MOST_ENTRIES) element("legend").append("…");
    element("legend").append(shown([say("block"), CURRENT]));
  }

  /** The scale of deviations stands where something is coloured by them. */
  showScale() {
    const { stock } = this;
    element("scale").hidden = !stock?.data.deviation || (stock.mode !== "deviation" && element("colour").value !== "deviation");
    if (stock && !element("scale").hidden) stock.drawScale(element("scale-bar"), element("scale-text"));
  }

  /** @param {number} row */
  #operationOf(row) {
    const found = this.scene.operations.findIndex((one) => row >= one.first && row < one.end);
    return found < 0 ? PALETTE.length - 1 : found;
  }
}
