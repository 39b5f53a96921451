// The stock as it is cut: bricks of its surface, from states in the page or from the server, and its colours.

import { askStock, readStates } from "./data.js";
import { LINEAR } from "./space.js";
import { say } from "./texts.js";

/** Cubes of a brick a side; each takes along the last layer of those before it, and the centres around them. */
const BRICK = 32, CUBES = 33, CENTRES = 34;
const CENTRE_BYTES = CENTRES ** 3 / 8;
const CUBE_STEP = [CUBES * CUBES, CUBES, 1], CENTRE_STEP = [CENTRES * CENTRES, CENTRES, 1];

/** A newer wish does not end a question that is younger than this, ms. */
const PATIENCE = 500;

/** As the design wants it; what is missing and what is left, a little and the most. */
const SOUND = [196, 196, 196], MISSING = [[255, 178, 102], [217, 13, 26]], LEFT_OVER = [[158, 199, 242], [20, 77, 204]];
const STOCK = 0xb9bcc0, INNER = 0x8c5a2b, BACK_SIDE = 1;

/** A click this near to a finding's place means it, CSS pixels. */
const NEAR_PLACE = 10;

/**
 * @typedef {{low: number[], cell: number[], counts: number[], rows: number, simulated: number, remarks: string[],
 *   deviation: {unit: number, limit: number} | null}} StockData
 */

/**
 * Bricks of a message by their numbers; a brick without bytes has no surface.
 * @param {Uint8Array} bytes
 */
export function readMessage(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const word = (/** @type {number} */ k) => view.getInt32(4 * k, true);
  /** @type {Map<number, Uint8Array>} */
  const bricks = new Map();
  const count = word(2);
  for (let k = 0, at = 4 * (3 + 2 * count); k < count; k++) {
    const length = word(4 + 2 * k);
    bricks.set(word(3 + 2 * k), bytes.subarray(at, at + length));
    at += length;
  }
  return { rows: word(0), before: word(1), bricks };
}

/**
 * The facets of a brick: those of each edge between two neighbouring centres of which one is material.
 * @param {Uint8Array} bytes
 * @param {number[]} first of its cubes along X, Y and Z, in the grid of the stock
 * @param {StockData} stock
 */
export function brickFacets(bytes, first, stock) {
  const inside = new Uint8Array(CENTRES ** 3);
  for (let n = 0; n < inside.length; n++) inside[n] = (bytes[n >> 3] >> (n & 7)) & 1;
  const vertices = (bytes.length - CENTRE_BYTES) / 3;
  const places = bytes.subarray(CENTRE_BYTES);
  const position = new Float32Array(3 * vertices), vertex = new Int32Array(CUBES ** 3).fill(-1);
  /** @type {number[]} */
  const index = [];
  const apart = (/** @type {number} */ a, /** @type {number} */ b) =>
    (position[3 * a] - position[3 * b]) ** 2 + (position[3 * a + 1] - position[3 * b + 1]) ** 2 + (position[3 * a + 2] - position[3 * b + 2]) ** 2;
  let m = 0;
  for (let i = 0; i < CUBES; i++) for (let j = 0; j < CUBES; j++) for (let k = 0; k < CUBES; k++) {
    const c = i * CENTRE_STEP[0] + j * CENTRE_STEP[1] + k, low = c + CENTRE_STEP[0];
    const material = inside[c] + inside[c + 1] + inside[c + CENTRES] + inside[c + CENTRES + 1] + inside[low] + inside[low + 1] + inside[low + CENTRES] + inside[low + CENTRES + 1];
    if (material === 0 || material === 8) continue;
    [i, j, k].forEach((at, axis) => {
      position[3 * m + axis] = stock.low[axis] + (first[axis] + at - 0.5 + places[axis * vertices + m] / 254) * stock.cell[axis];
    });
    const cube = i * CUBE_STEP[0] + j * CUBE_STEP[1] + k;
    vertex[cube] = m++;
    if (!i || !j || !k) continue; // of the brick before this one
    for (let w = 0; w < 3; w++) {
      if (inside[c] === inside[c + CENTRE_STEP[w]]) continue;
      const u = CUBE_STEP[(w + 1) % 3], v = CUBE_STEP[(w + 2) % 3];
      const around = [vertex[cube - u - v], vertex[cube - v], vertex[cube], vertex[cube - u]];
      const [p, q, r, s] = inside[c] ? around : around.reverse();
      if (apart(p, r) <= apart(q, s)) index.push(p, q, r, p, r, s);
      else index.push(p, q, s, q, r, s);
    }
  }
  if (m !== vertices) throw new Error(`stock: ${m} vertices, and ${vertices} places`);
  return { position, index };
}

/**
 * The colour of a deviation.
 * @param {number} off mm
 * @param {number} limit mm
 * @param {number} least
 * @param {number} most
 */
export function deviationColour(off, limit, least, most) {
  if (Math.abs(off) <= limit) return SOUND;
  const [little, full] = off < 0 ? MISSING : LEFT_OVER;
  const share = Math.min(off / (off < 0 ? least : most), 1);
  return little.map((part, k) => Math.round(part + share * (full[k] - part)));
}

export class Stock {
  /**
   * @param {import("./space.js").Space} space
   * @param {import("./program.js").Program} program
   * @param {Record<string, any>} columns
   * @param {HTMLElement} status what is told of it
   */
  constructor(space, program, columns, status) {
    this.space = space;
    this.program = program;
    this.status = status;
    /** @type {StockData} */
    this.data = /** @type {any} */ (program.scene).stock;
    this.many = this.data.counts.map((count) => Math.ceil((count + 1) / BRICK));
    const { deviation } = this.data;
    /** of the vertices of the finished stock, and the worst that each row left, mm */
    this.off = deviation ? Float32Array.from(columns["stock-deviation"], (count) => count * deviation.unit) : new Float32Array(0);
    /** what each row takes away, mm³ */
    this.removed = columns.removed;
    this.rowOff = deviation ? Float32Array.from(columns["row-deviation"], (count) => count * deviation.unit) : new Float32Array(0);
    this.least = this.off.reduce((low, value) => Math.min(low, value), 0);
    this.most = this.off.reduce((high, value) => Math.max(high, value), 0);
    this.group = new THREE.Group();
    const flat = { flatShading: true, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 }; // before what it touches
    this.material = new THREE.MeshLambertMaterial({ color: STOCK, ...flat });
    this.coloured = new THREE.MeshLambertMaterial({ vertexColors: true, ...flat });
    // What a section opens is filled: behind it the inner sides are seen, which no light reaches.
    this.inner = new THREE.MeshLambertMaterial({ color: 0, emissive: INNER, side: BACK_SIDE, visible: false, ...flat });
    this.mode = "cut";
    this.wanted = 0;
    this.shown = -1;
    /**
     * bricks that are shown, and their meshes
     * @type {Map<number, Uint8Array>}
     */
    this.bricks = new Map();
    /** @type {Map<number, any[]>} */
    this.meshes = new Map();
    this.asked = -1;
    this.askedAt = 0;
    this.abort = new AbortController();
    /**
     * states of a page that has no server
     * @type {{rows: number, bricks: Map<number, Uint8Array>}[] | null}
     */
    this.states = null;
  }

  /** Read what the page holds. */
  async open() {
    const messages = await readStates();
    if (!messages) return;
    let bricks = new Map();
    this.states = messages.map((bytes) => {
      const { rows, bricks: changed } = readMessage(bytes);
      bricks = new Map([...bricks, ...changed]);
      return { rows, bricks };
    });
  }

  /**
   * Show inner sides: whole, the stock has none.
   * @param {boolean} on
   */
  setOpen(on) { this.inner.visible = on; }

  /** @param {string} mode cut, deviation or off */
  setMode(mode) {
    this.mode = mode;
    if (mode === "off") this.space.place.remove(this.group);
    else this.space.place.add(this.group);
    this.space.bodies.forEach((mesh, k) => {
      if (this.program.scene.bodies[k].kind === "part") mesh.userData.hidden = mode !== "off";
    });
    this.shown = -1;
    this.bricks = new Map();
    this.show(this.wanted);
  }

  /**
   * Show the stock after some rows.
   * @param {number} rows
   */
  show(rows) {
    this.wanted = Math.min(rows, this.data.rows);
    const goal = this.mode === "deviation" ? this.data.rows : this.wanted;
    if (this.mode === "off" || goal === this.shown) { this.#tell(); return; }
    if (this.states) {
      const state = this.#stateAt(goal);
      if (state.rows !== this.shown) this.#put(state.rows, state.bricks);
      this.#tell();
    } else this.#ask(goal);
  }

  /**
   * The last state before or at some rows.
   * @param {number} rows
   */
  #stateAt(rows) {
    /** @type {any[]} */
    const states = this.states ?? [];
    return states.filter((state) => state.rows <= rows).pop() ?? states[0];
  }

  /**
   * Ask the server; while it answers, only the last wish is kept.
   * @param {number} goal
   */
  async #ask(goal) {
    if (this.asked >= 0) {
      if (performance.now() - this.askedAt < PATIENCE || goal === this.asked) return;
      this.abort.abort();
    }
    this.asked = goal;
    this.askedAt = performance.now();
    const abort = this.abort = new AbortController();
    this.#tell();
    let again = 0;
    try {
      const bytes = await askStock(goal, this.shown, abort.signal);
      if (abort !== this.abort) return;
      if (bytes) {
        const { rows, before, bricks } = readMessage(bytes);
        if (before < 0) this.#put(rows, bricks);
        else if (before === this.shown) this.#put(rows, new Map([...this.bricks, ...bricks]));
      } else again = PATIENCE;
    } catch (error) {
      if (abort !== this.abort) return;
      this.asked = -1;
      this.status.textContent = String(error);
      return;
    }
    this.asked = -1;
    if (again) setTimeout(() => this.show(this.wanted), again);
    else this.show(this.wanted);
  }

  /**
   * Show bricks; those that are shown already stay.
   * @param {number} rows
   * @param {Map<number, Uint8Array>} bricks
   */
  #put(rows, bricks) {
    for (const number of new Set([...this.bricks.keys(), ...bricks.keys()])) {
      if (this.bricks.get(number) === bricks.get(number)) continue;
      this.meshes.get(number)?.forEach((mesh) => { this.group.remove(mesh); mesh.geometry.dispose(); });
      this.meshes.delete(number);
    }
    this.bricks = new Map(bricks);
    let vertices = 0;
    for (const number of [...bricks.keys()].sort((a, b) => a - b)) {
      const bytes = /** @type {Uint8Array} */ (bricks.get(number));
      if (!bytes.length) continue;
      if (!this.meshes.has(number)) this.#add(number, bytes, vertices);
      vertices += (bytes.length - CENTRE_BYTES) / 3;
    }
    this.shown = rows;
    this.space.setPose(this.space.values, this.space.row);
  }

  /**
   * @param {number} number
   * @param {Uint8Array} bytes
   * @param {number} before vertices of the bricks before it
   */
  #add(number, bytes, before) {
    const [, y, z] = this.many;
    const first = [Math.floor(number / (y * z)), Math.floor(number / z) % y, number % z].map((at) => BRICK * at - 1);
    const { position, index } = brickFacets(bytes, first, this.data);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(index), 1));
    if (this.mode === "deviation") {
      const colours = new Uint8Array(position.length);
      for (let n = 0; 3 * n < colours.length; n++) colours.set(this.colourOf(this.off[before + n]).map((part) => LINEAR[Math.round(part)]), 3 * n);
      geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3, true));
    }
    const meshes = [new THREE.Mesh(geometry, this.mode === "deviation" ? this.coloured : this.material), new THREE.Mesh(geometry, this.inner)];
    this.group.add(...meshes);
    this.meshes.set(number, meshes);
  }

  /** @param {number} off mm */
  colourOf(off) {
    return deviationColour(off, this.data.deviation?.limit ?? 0, this.least, this.most);
  }

  /** Whether nothing is taken away between the stock that is shown and the cursor. */
  #isExact() { return this.removed.subarray(this.shown, this.wanted).every((/** @type {number} */ volume) => volume === 0); }

  /**
   * The line of the last of some rows, with its file where there are several.
   * @param {number} rows
   */
  #lineAfter(rows) {
    const { program } = this, { files } = program.scene;
    if (!rows) return 0;
    const line = program.line[rows - 1];
    return files.length > 1 ? `${line} (${files[program.file[rows - 1]].split(/[\\/]/).pop()})` : line;
  }

  #tell() {
    const { shown, states, mode } = this;
    if (mode === "off") { this.status.textContent = ""; return; }
    const cells = `${[...new Set(this.data.cell.map((width) => Number(width.toPrecision(3))))].join(" × ")} mm`;
    const words = [say("stockCells", { cells })];
    if (this.asked >= 0) words.unshift(say("stockCutting", { line: this.#lineAfter(this.asked) }));
    else if (mode === "deviation") words.unshift(say("stockFinished"));
    else if (this.#isExact()) words.unshift(shown ? say("stockAfter", { line: this.#lineAfter(this.wanted) }) : say("stockUncut"));
    else if (states) {
      const next = states.find((state) => state.rows > shown);
      words.unshift(say("stockBetween", { line: this.#lineAfter(shown), next: this.#lineAfter(next ? next.rows : shown), count: states.length }));
    }
    if (this.data.rows < this.program.rows) words.push(say("stockEnds", { line: this.#lineAfter(this.data.rows) }));
    this.status.textContent = words.join(" ");
  }

  /**
   * Draw the scale of deviations.
   * @param {HTMLCanvasElement} canvas
   * @param {HTMLElement} text
   */
  drawScale(canvas, text) {
    const { least, most } = this, limit = this.data.deviation?.limit ?? 0;
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    const low = Math.min(least, -limit), high = Math.max(most, limit);
    for (let x = 0; x < canvas.width; x++) {
      const half = canvas.width / 2, share = (x + 0.5) / half - 1;
      pen.fillStyle = `rgb(${this.colourOf(share < 0 ? -share * low : share * high).join(",")})`;
      pen.fillRect(x, 0, 1, canvas.height);
    }
    const name = (/** @type {"gouge" | "left"} */ key, /** @type {number} */ most_) => (Math.abs(most_) > limit ? `${say(key)} ${Math.abs(most_).toFixed(3)} mm` : `${say(key)} –`);
    text.textContent = `${name("gouge", least)} | ± ${limit.toFixed(3)} mm | ${name("left", most)}`;
  }
}

/** Places of findings, as marks that a click finds. */
export class Places {
  /**
   * @param {import("./space.js").Space} space
   * @param {{place?: number[] | null}[]} findings
   */
  constructor(space, findings) {
    this.space = space;
    /** their numbers in the list */
    this.numbers = findings.flatMap((each, k) => (each.place ? [k] : []));
    this.points = new Float32Array(this.numbers.flatMap((k) => findings[k].place ?? []));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.points, 3));
    this.marks = new THREE.Points(geometry, new THREE.PointsMaterial({ color: 0xdc1e28, size: 9, sizeAttenuation: false, depthTest: false }));
    this.marks.frustumCulled = false;
    this.marks.renderOrder = 4;
    space.place.add(this.marks);
  }

  /**
   * The number of the finding whose place is drawn there; -1 if none is.
   * @param {number} x CSS pixels from the left of the canvas
   * @param {number} y from its top
   */
  pick(x, y) {
    const { space, points } = this;
    space.root.updateMatrixWorld(true);
    let found = -1, best = NEAR_PLACE;
    this.numbers.forEach((number, k) => {
      const at = new THREE.Vector3().fromArray(points, 3 * k).applyMatrix4(space.place.matrixWorld).project(space.camera);
      const off = Math.hypot(((at.x + 1) / 2) * space.canvas.clientWidth - x, ((1 - at.y) / 2) * space.canvas.clientHeight - y);
      if (at.z < 1 && off < best) { best = off; found = number; }
    });
    return found;
  }
}
