// The text of the program where the cursor is, and the line of the CL file that it comes from.

import { readLine, readText } from "./data.js";
import { element } from "./elements.js";
import { say } from "./texts.js";

/** A cursor that has not moved for so long rests, ms. */
const RESTS = 80;

/** @type {Map<number, Promise<Uint8Array>>} */
const TEXTS_READ = new Map();

/**
 * The text of a file, which is fetched once.
 * @param {number} file
 */
export function readTextOnce(file) {
  if (!TEXTS_READ.has(file)) TEXTS_READ.set(file, readText(file));
  return /** @type {Promise<Uint8Array>} */ (TEXTS_READ.get(file));
}

export class ProgramText {
  /**
   * @param {import("./program.js").Program} program
   * @param {import("./listing.js").Listing} listing
   */
  constructor(program, listing) {
    this.program = program;
    this.scene = program.scene;
    this.listing = listing;
    this.shownFile = -1;
    this.placesAsked = 0;
    /** Whether the text of that file is there, and still wanted. */
    this.opening = Promise.resolve(true);
    /** File and line of the CL statement that is shown. */
    this.clLine = "";
    this.clTimer = 0;
  }

  /**
   * Show the line of a row.
   * @param {number} row
   */
  async showRow(row) {
    if (!this.program.rows) await this.showFile(Math.max(this.shownFile, 0));
    else await this.showPlace(this.program.file[row], this.program.line[row]);
  }

  /**
   * Show a line of a file, unless another one has been asked for when its text is there.
   * @param {number} file
   * @param {number} line from 1
   */
  async showPlace(file, line) {
    const place = ++this.placesAsked;
    if (await this.showFile(file) && place === this.placesAsked) this.listing.show(line);
  }

  /**
   * Show the text of a file of the program; whether it is still the one that is wanted when it is there.
   * @param {number} file
   */
  showFile(file) {
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
   * Show a line of the file that is there.
   * @param {number} line from 1
   */
  showHere(line) {
    this.placesAsked++;
    this.listing.show(line);
  }

  /**
   * The line of the CL file that a row comes from; its text follows where the cursor rests.
   * @param {number} row
   */
  showClLine(row) {
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
}
