// The machine, what is on it and the path, in space.

import { pathSegments } from "./dashes.js";
import { jointMatrix, toolAt } from "./kinematics.js";

/** Segments that are drawn while the picture moves; the rest follows when it rests. */
const FAST_SEGMENTS = 8_000;

/** Pictures that take longer lose detail while something moves, milliseconds. */
const SLOW = 25;

/** A click this near to a point of the path means it, CSS pixels. */
const NEAR = 12;

/** What a vertex has to say for a colour of the screen to come out: three.js takes it as linear light. */
export const LINEAR = Uint8Array.from({ length: 256 }, (_, k) => Math.round(255 * (k <= 10 ? k / 255 / 12.92 : ((k / 255 + 0.055) / 1.055) ** 2.4)));

export class Space {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./program.js").Program} program
   * @param {Record<string, any>} columns with vertices and faces of the bodies
   */
  constructor(canvas, program, columns) {
    this.canvas = canvas;
    this.program = program;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 1, 20_000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => this.hurry(true));
    this.controls.addEventListener("end", () => this.hurry(false));
    this.frame = "machine";
    this.root = new THREE.Group();
    this.root.matrixAutoUpdate = false;
    this.scene.add(this.root, new THREE.HemisphereLight(0xffffff, 0x777777, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-300, -500, 900);
    this.scene.add(sun);
    this.links = this.#linkGroups();
    this.bodies = this.#bodyMeshes(columns);
    this.tips = program.tips();
    this.#pathLines();
    this.pending = 0;
    this.resting = 0;
    this.isMoving = false;
    this.isSlow = false;
    this.detail = 1;
    this.drawn = 0;
    this.pace = 0;
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** A group for each link, hung on the one that carries it. */
  #linkGroups() {
    const { axes, partAxes } = this.program.machine;
    /** @type {Map<string, any>} */
    const groups = new Map([["bed", this.root]]);
    const hang = (/** @type {number} */ joint, /** @type {string} */ on) => {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      groups.get(on).add(group);
      groups.set(axes[joint].name, group);
    };
    for (let k = partAxes - 1; k >= 0; k--) hang(k, k === partAxes - 1 ? "bed" : axes[k + 1].name);
    for (let k = partAxes; k < 5; k++) hang(k, k === partAxes ? "bed" : axes[k - 1].name);
    groups.set("workpiece", groups.get(partAxes ? axes[0].name : "bed"));
    groups.set("spindle", groups.get(partAxes < 5 ? axes[4].name : "bed"));
    return groups;
  }

  /** @param {Record<string, any>} columns */
  #bodyMeshes(columns) {
    return this.program.scene.bodies.map((body, k) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(columns[`vertices-${k}`], 3));
      geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(columns[`faces-${k}`].buffer), 1));
      const flat = geometry.toNonIndexed();
      flat.computeVertexNormals();
      const see = body.kind === "part" ? 0.85 : 1;
      const material = new THREE.MeshLambertMaterial({ color: body.colour, side: THREE.DoubleSide, transparent: see < 1, opacity: see });
      const mesh = new THREE.Mesh(flat, material);
      mesh.name = body.name;
      this.links.get(body.link).add(mesh);
      return mesh;
    });
  }

  #pathLines() {
    const { program, tips } = this;
    const zero = program.machine.zero ?? [0, 0, 0];
    this.place = new THREE.Group();
    this.place.position.set(zero[0], zero[1], zero[2]);
    this.links.get("workpiece").add(this.place);
    const isRapid = (/** @type {number} */ piece) => program.kind[program.row[piece]] === 0;
    const { segments, points } = pathSegments(tips, program.row, program.pieces, (piece) => this.#isDrawn(piece), isRapid);
    const count = segments.length;
    /** piece of each segment */
    this.segments = segments;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    this.colours = new Uint8Array(6 * count);
    geometry.setAttribute("color", new THREE.BufferAttribute(this.colours, 3, true));
    this.lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
    this.lines.frustumCulled = false;
    this.place.add(this.lines);
    this.stride = Math.max(1, Math.ceil(count / FAST_SEGMENTS));
    this.coarse = this.#coarseLines(points, count);
    // The current block is a range of the path: no picture has points of its own to send.
    const now = new THREE.BufferGeometry();
    now.setAttribute("position", geometry.getAttribute("position"));
    now.setDrawRange(0, 0);
    this.current = new THREE.LineSegments(now, new THREE.LineBasicMaterial({ color: 0xff2da0, depthTest: false }));
    this.current.frustumCulled = false;
    this.current.renderOrder = 2;
    this.place.add(this.current);
    const way = new THREE.BufferGeometry();
    way.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
    way.setDrawRange(0, 0);
    this.measured = new THREE.Line(way, new THREE.LineBasicMaterial({ color: 0x12a594, depthTest: false }));
    this.measured.frustumCulled = false;
    this.measured.renderOrder = 3;
    this.place.add(this.measured);
  }

  /** @param {number} piece */
  #isDrawn(piece) { return this.program.known[piece] !== 0; }

  /**
   * One chord for every few segments, for pictures in motion.
   * @param {Float32Array} points
   * @param {number} count
   */
  #coarseLines(points, count) {
    if (this.stride === 1) return null;
    const many = Math.floor(count / this.stride);
    const coarse = new Float32Array(6 * many);
    for (let n = 0; n < many; n++) {
      const first = 6 * n * this.stride, last = 6 * ((n + 1) * this.stride - 1) + 3;
      coarse.set(points.subarray(first, first + 3), 6 * n);
      coarse.set(points.subarray(last, last + 3), 6 * n + 3);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(coarse, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(6 * many), 3, true));
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
    lines.frustumCulled = false;
    lines.visible = false;
    this.place.add(lines);
    return lines;
  }

  /**
   * Colour the path.
   * @param {(piece: number) => number[]} colourOf red, green and blue of a piece, 0 to 255
   */
  paint(colourOf) {
    const { segments, colours } = this;
    for (let n = 0; n < segments.length; n++) {
      const colour = colourOf(segments[n]);
      for (let k = 0; k < 3; k++) colours[6 * n + k] = colours[6 * n + 3 + k] = LINEAR[colour[k]];
    }
    this.lines.geometry.attributes.color.needsUpdate = true;
    if (this.coarse) {
      const coarse = this.coarse.geometry.attributes.color;
      for (let n = 0; 6 * n < coarse.array.length; n++) {
        const from = 6 * n * this.stride;
        coarse.array.set(colours.subarray(from, from + 6), 6 * n);
      }
      coarse.needsUpdate = true;
    }
    this.draw();
  }

  /**
   * While pictures follow each other, a long path is drawn coarsely.
   * @param {boolean} on
   */
  hurry(on) {
    clearTimeout(this.resting);
    if (on) {
      if (!this.isMoving) this.pace = 0;
      this.isMoving = true;
      if (this.isSlow && this.detail === 1) this.#setDetail(0.5);
      this.#show(true);
    } else {
      this.resting = window.setTimeout(() => {
        this.isMoving = false;
        this.#show(false);
        this.#setDetail(1);
        this.draw();
      }, 250);
    }
  }

  /**
   * Draw with fewer points of the screen, or with all.
   * @param {number} detail 1 for all of them
   */
  #setDetail(detail) {
    if (this.detail === detail) return;
    this.detail = detail;
    this.resize();
  }

  /** While something moves, fewer points make up for a slow computer. */
  #keepPace() {
    const now = performance.now(), took = now - this.drawn;
    this.drawn = now;
    if (!this.isMoving || took > 500) return;
    this.pace = this.pace ? 0.7 * this.pace + 0.3 * took : took;
    if (this.pace <= SLOW) return;
    this.isSlow = true;
    this.pace = 0;
    this.#setDetail(this.detail > 0.5 ? 0.5 : 0.35);
  }

  /**
   * Draw the first picture, a long path coarsely as in motion, and see whether it takes too long to be done for every
   * picture. The whole path follows when the first picture has been seen: on a slow computer it takes a second.
   */
  tryPace() {
    const gl = this.renderer.getContext();
    const timed = () => {
      const start = performance.now();
      this.drawNow();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
      return performance.now() - start;
    };
    this.#show(true);
    timed(); // sends what later pictures have already
    this.isSlow = timed() > SLOW / 2;
    this.hurry(false);
  }

  /** @param {boolean} coarse */
  #show(coarse) {
    if (!this.coarse) return;
    this.coarse.visible = coarse && this.pathIsShown !== false;
    this.lines.visible = !coarse && this.pathIsShown !== false;
  }

  /** @param {boolean} on */
  showPath(on) {
    this.pathIsShown = on;
    this.lines.visible = this.current.visible = on;
    if (this.coarse) this.coarse.visible = false;
    this.draw();
  }

  /** @param {boolean} on */
  showMachine(on) {
    this.program.scene.bodies.forEach((body, k) => { if (body.kind === "machine") this.bodies[k].userData.hidden = !on; });
    this.setPose(this.values, this.row);
  }

  /**
   * Move all links.
   * @param {number[]} values of the five axes
   * @param {number} row
   */
  setPose(values, row) {
    this.values = values;
    this.row = row;
    const { machine, scene } = this.program;
    machine.axes.forEach((axis, joint) => {
      const group = this.links.get(axis.name);
      group.matrix.fromArray(jointMatrix(machine, joint, values[joint]));
    });
    this.root.matrix.identity();
    if (this.frame === "part") {
      this.root.updateMatrixWorld(true);
      this.root.matrix.copy(this.links.get("workpiece").matrixWorld).invert();
    }
    const tool = scene.tools[this.program.rows ? this.program.tool[row] : 0]?.name ?? "";
    scene.bodies.forEach((body, k) => {
      this.bodies[k].visible = !this.bodies[k].userData.hidden && (body.tool === null || body.tool === tool);
    });
    this.#markCurrent(row);
    this.draw();
  }

  /** @param {number} row */
  #markCurrent(row) {
    const { program } = this;
    const last = program.rows ? program.last[row] : -1;
    let first = last;
    while (first > 0 && program.row[first - 1] === row) first--;
    const from = this.#segmentFrom(first), to = this.#segmentFrom(last + 1);
    this.current.geometry.setDrawRange(2 * from, 2 * (to - from));
  }

  /**
   * The first segment of a piece, or of the next that is drawn.
   * @param {number} piece
   */
  #segmentFrom(piece) {
    let low = 0, high = this.segments.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.segments[middle] < piece) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Tip and tool axis of the pose that is shown, as the scene has them, in the workpiece frame. */
  shownTool() {
    this.root.updateMatrixWorld(true);
    const { machine } = this.program;
    const back = this.place.matrixWorld.clone().invert().multiply(this.links.get("spindle").matrixWorld);
    const length = this.program.lengthAt(this.row);
    const tip = new THREE.Vector3(...machine.gauge.map((value, k) => value - length * machine.spindle[k])).applyMatrix4(back);
    const axis = new THREE.Vector3(...machine.spindle).transformDirection(back);
    return { tip: tip.toArray(), axis: axis.toArray() };
  }

  /**
   * Tip and tool axis by the formula, for axis values.
   * @param {number[]} values
   * @param {number} row
   */
  toolOf(values, row) {
    const tip = new Float64Array(3), axis = new Float64Array(3);
    toolAt(this.program.machine, values, this.program.lengthAt(row), tip);
    toolAt(this.program.machine, values, 0, axis, true);
    return { tip, axis };
  }

  /** @param {"machine" | "part"} frame */
  setFrame(frame) {
    this.frame = frame;
    this.setPose(this.values, this.row);
    this.look("iso");
  }

  /**
   * Show everything, or the part and its path.
   * @param {string} from iso, top, front or right
   * @param {boolean} near
   */
  look(from, near = false) {
    this.root.updateMatrixWorld(true);
    const box = new THREE.Box3();
    if (near || this.frame === "part" || !this.bodies.length) box.setFromObject(this.place);
    else box.setFromObject(this.root);
    if (box.isEmpty()) box.set(new THREE.Vector3(-50, -50, -50), new THREE.Vector3(50, 50, 50));
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const direction = { iso: [-0.55, -1, 0.6], top: [0, -0.001, 1], front: [0, -1, 0], right: [1, 0, 0] }[from] ?? [0, -1, 0];
    const far = (1.15 * sphere.radius) / Math.sin((this.camera.fov / 2) * (Math.PI / 180));
    this.controls.target.copy(sphere.center);
    this.camera.position.set(...direction).setLength(far).add(sphere.center);
    this.camera.near = far / 200;
    this.camera.far = far * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /**
   * Cut the picture open.
   * @param {string} axis x, y, z, or "" for no section
   * @param {number} share from 0 to 1 of the path's box
   */
  section(axis, share) {
    if (!axis) this.renderer.clippingPlanes = [];
    else {
      this.root.updateMatrixWorld(true);
      const box = new THREE.Box3().setFromObject(this.frame === "part" ? this.place : this.root);
      const normal = new THREE.Vector3(axis === "x" ? -1 : 0, axis === "y" ? 1 : 0, axis === "z" ? -1 : 0);
      const low = box.min[axis], high = box.max[axis];
      const at = low + share * (high - low);
      this.renderer.clippingPlanes = [new THREE.Plane(normal, axis === "y" ? -at : at)];
    }
    this.draw();
  }

  /**
   * The piece whose end is nearest to a place of the picture; -1 if none is near.
   * @param {number} x CSS pixels from the left of the canvas
   * @param {number} y from its top
   */
  pick(x, y) {
    this.root.updateMatrixWorld(true);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const e = new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).multiply(this.place.matrixWorld).elements;
    let best = NEAR * NEAR, found = -1, depth = Infinity;
    for (const piece of this.segments) {
      const [px, py, pz] = [this.tips[3 * piece + 3], this.tips[3 * piece + 4], this.tips[3 * piece + 5]];
      const w = e[3] * px + e[7] * py + e[11] * pz + e[15];
      if (w <= 0) continue;
      const dx = (((e[0] * px + e[4] * py + e[8] * pz + e[12]) / w + 1) / 2) * width - x;
      const dy = ((1 - (e[1] * px + e[5] * py + e[9] * pz + e[13]) / w) / 2) * height - y;
      const off = dx * dx + dy * dy;
      if (off < best - 1 || (off < best + 1 && off < NEAR * NEAR && w < depth)) { best = Math.min(off, best); found = piece; depth = w; }
    }
    return found;
  }

  /**
   * The way between two points of the path, drawn; its length, mm.
   * @param {number} first piece
   * @param {number} second
   */
  measure(first, second) {
    const ends = [first, second].map((piece) => new THREE.Vector3().fromArray(this.tips, 3 * piece + 3));
    this.measured.geometry.setFromPoints(ends).setDrawRange(0, 2);
    this.draw();
    return { length: ends[0].distanceTo(ends[1]), away: ends[1].clone().sub(ends[0]).toArray() };
  }

  clearMeasure() { this.measured.geometry.setDrawRange(0, 0); this.draw(); }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2) * this.detail);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    // A size that is set clears the canvas: what was drawn is drawn again before the screen shows it empty.
    if (this.drawn) this.drawNow();
    else this.draw();
  }

  /** @param {string} colour of the background */
  setBackground(colour) { this.renderer.setClearColor(colour); this.draw(); }

  /** Draw once, before the next picture of the screen. */
  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => { this.pending = 0; this.renderer.render(this.scene, this.camera); this.#keepPace(); });
  }

  /** What is shown, in full detail also while it moves: the address of a PNG. */
  picture() {
    const { detail, isMoving } = this;
    this.#show(false);
    this.#setDetail(1);
    this.drawNow();
    const picture = this.canvas.toDataURL("image/png");
    this.#show(isMoving);
    this.#setDetail(detail);
    return picture;
  }

  drawNow() { this.renderer.render(this.scene, this.camera); }
}
