// What the page shows: from the server, or from elements of the page itself.

/**
 * @typedef {{name: string, rotary: boolean, direction: number[], point: number[], low: number | null, high: number | null,
 *   rapid: number | null, placed: boolean, displayLow: number | null}} Axis
 * @typedef {{key: string, name: string, partAxes: number, zero: number[] | null, gauge: number[], spindle: number[], axes: Axis[]}} Machine
 * @typedef {{kind: string, row: number, line: number, file: number, text: string, place?: number[] | null}} Mark
 * @typedef {{title: string, machine: Machine, bodies: {name: string, link: string, kind: string, tool: string | null, colour: string}[],
 *   tools: {name: string, length: number, known: boolean}[], files: string[], clFiles: string[], clText: number,
 *   operations: {name: string, first: number, end: number, cl: number}[],
 *   events: Mark[], findings: Mark[], timed: boolean, checks: {key: string, state: string, said: string, summary: string}[], standing: string, verdict: string, stands: string[], remarks: string[],
 *   live?: boolean, against?: any, columns: Record<string, string>, stock?: import("./stock.js").StockData}} SceneData
 */

/** Of all texts. */
export const DECODER = new TextDecoder();

/**
 * texts that the page holds, as lines
 * @type {Map<number, Promise<string[]>>}
 */
const LINES = new Map();

const EMBEDDED = document.documentElement.dataset.embedded === "true";

/** @param {string} id of an element with base64 of deflated bytes; the element goes */
async function inflated(id) {
  const element = /** @type {HTMLElement} */ (document.getElementById(id));
  const text = atob(/** @type {string} */ (element.textContent));
  element.remove();
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** @param {string} name of a column or a text on the server */
async function fetched(name) {
  const answer = await fetch(`data/${name}`);
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer.arrayBuffer();
}

/** @returns {SceneData} */
export function readScene() {
  return JSON.parse(/** @type {string} */ (document.getElementById("scene")?.textContent));
}

/**
 * A column by its name; "f" holds float32, "i" int32.
 * @param {SceneData} scene
 * @param {string} name
 * @returns {Promise<any>}
 */
export async function readColumn(scene, name) {
  const words = EMBEDDED ? (await unpack(`column-${name}`)).buffer : await fetched(`column/${name}`);
  return scene.columns[name] === "f" ? new Float32Array(words) : new Int32Array(words);
}

/**
 * The text of a file of the program.
 * @param {number} number
 */
export async function readText(number) {
  return EMBEDDED ? inflated(`text-${number}`) : new Uint8Array(await fetched(`text/${number}`));
}

/**
 * One line of a text, without its end: of a long text, a page of a server needs no more.
 * @param {number} number
 * @param {number} line from 1
 */
export async function readLine(number, line) {
  if (!EMBEDDED) return DECODER.decode(await fetched(`text/${number}/${line}`)).trimEnd();
  if (!LINES.has(number)) LINES.set(number, readText(number).then((bytes) => DECODER.decode(bytes).split("\n")));
  return (await /** @type {Promise<string[]>} */ (LINES.get(number)))[line - 1]?.trimEnd() ?? "";
}

/**
 * The states of the stock that the page holds, each a message; null: the server has them.
 * @returns {Promise<Uint8Array[] | null>}
 */
export async function readStates() {
  if (!EMBEDDED) return null;
  const bytes = await inflated("stock-states"), view = new DataView(bytes.buffer);
  const found = [];
  for (let at = 0; at < bytes.length; at += found[found.length - 1].length) {
    const length = view.getInt32(at, true);
    at += 4;
    found.push(bytes.subarray(at, at + length));
  }
  return found;
}

/**
 * The stock after some rows, as a message; null: another question came between.
 * @param {number} rows
 * @param {number} before rows of the stock that is shown, -1 for none
 * @param {AbortSignal} signal
 */
export async function askStock(rows, before, signal) {
  const answer = await fetch(`data/stock/${rows}${before < 0 ? "" : `?before=${before}`}`, { signal });
  if (answer.status === 409) return null;
  if (!answer.ok) throw new Error(`stock: ${answer.status}`);
  return new Uint8Array(await answer.arrayBuffer());
}
