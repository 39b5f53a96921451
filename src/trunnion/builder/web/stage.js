// The machine as it moves: its bodies, its axes as arrows and lines of rotation, and the tool, jogged by hand.

import { jointMatrix, toolAt } from "../../viewer/web/kinematics.js";

/** A tool of this length stands in the spindle, mm. */
export const TOOL = 100;

/** X, Y and Z of the workpiece. */
const FRAME = ["#d04040", "#3a9a3a", "#4060d0"];

export const COLOURS = ["#c8372d", "#1f77b4", "#2c8f5a", "#b5651d", "#7d4fb0"];

export class Stage {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 1, 50_000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x777777, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-300, -500, 900);
    this.scene.add(sun);
    /** @type {any} */
    this.root = null;
    this.chain = "";
    this.pending = 0;
    /** @type {number[]} */
    this.values = [];
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /**
   * Show a machine.
   * @param {any} machine
   * @param {any[]} bodies
   */
  show(machine, bodies) {
    if (this.root) this.scene.remove(this.root);
    this.machine = machine;
    this.root = new THREE.Group();
    this.scene.add(this.root);
    /** @type {any[]} */
    this.joints = [];
    const links = this.#links();
    for (const body of bodies) links.get(body.link).add(this.#mesh(body));
    this.#drawAxes(links);
    const zero = machine.zero ?? [0, 0, 0];
    for (const k of [0, 1, 2]) links.get("workpiece").add(this.#line([zero, zero.map((/** @type {number} */ at, /** @type {number} */ i) => at + (i === k ? 60 : 0))], FRAME[k]));
    const g = machine.gauge, s = machine.spindle;
    links.get("spindle").add(this.#line([[g[0] - TOOL * s[0], g[1] - TOOL * s[1], g[2] - TOOL * s[2]], g], "#d9a441"));
    const order = machine.axes.map((/** @type {any} */ axis) => axis.name + axis.direction).join();
    const isNew = order !== this.chain;
    this.chain = order;
    this.jog(isNew ? machine.homes : this.values);
    if (isNew) this.look();
  }

  #links() {
    const { axes, partAxes } = this.machine;
    /** @type {Map<string, any>} */
    const groups = new Map([["bed", this.root]]);
    const hang = (/** @type {number} */ joint, /** @type {string} */ on) => {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      groups.get(on).add(group);
      groups.set(axes[joint].name, group);
      this.joints[joint] = group;
    };
    for (let k = partAxes - 1; k >= 0; k--) hang(k, k === partAxes - 1 ? "bed" : axes[k + 1].name);
    for (let k = partAxes; k < 5; k++) hang(k, k === partAxes ? "bed" : axes[k - 1].name);
    groups.set("workpiece", groups.get(partAxes ? axes[0].name : "bed"));
    groups.set("spindle", groups.get(partAxes < 5 ? axes[4].name : "bed"));
    return groups;
  }

  /** @param {any} body */
  #mesh(body) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(body.vertices), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(body.faces), 1));
    const flat = geometry.toNonIndexed();
    flat.computeVertexNormals();
    const material = new THREE.MeshLambertMaterial({ color: body.colour, side: THREE.DoubleSide, transparent: true, opacity: 0.8 });
    return new THREE.Mesh(flat, material);
  }

  /**
   * Lines of rotation with a ring, slides as lines.
   * @param {Map<string, any>} links
   */
  #drawAxes(links) {
    this.machine.axes.forEach((/** @type {any} */ axis, /** @type {number} */ k) => {
      const d = axis.direction, p = axis.rotary ? axis.point : [0, 0, 0], reach = axis.rotary ? 130 : 180;
      const ends = [-reach, reach].map((far) => [0, 1, 2].map((i) => p[i] + far * d[i]));
      const group = links.get(axis.name);
      group.add(this.#line(ends, COLOURS[k]));
      if (!axis.rotary) return;
      const normal = new THREE.Vector3(d[0], d[1], d[2]);
      const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
      const ring = Array.from({ length: 49 }, (_, i) => {
        const v = new THREE.Vector3(60 * Math.cos((i * Math.PI) / 24), 60 * Math.sin((i * Math.PI) / 24), 0).applyQuaternion(turn);
        return [v.x + p[0], v.y + p[1], v.z + p[2]];
      });
      group.add(this.#line(ring, COLOURS[k]));
    });
  }

  /**
   * @param {number[][]} points
   * @param {string} colour
   */
  #line(points, colour) {
    const geometry = new THREE.BufferGeometry().setFromPoints(points.map((p) => new THREE.Vector3(p[0], p[1], p[2])));
    return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colour }));
  }

  /**
   * Move the axes.
   * @param {number[]} values as the control displays them
   */
  jog(values) {
    this.values = values.slice();
    this.joints.forEach((/** @type {any} */ group, /** @type {number} */ k) => group.matrix.fromArray(jointMatrix(this.machine, k, values[k])));
    this.draw();
  }

  /** Where the tool is in the workpiece frame; without a workpiece zero, in the frame of the machine at the table. */
  tool() {
    const tip = new Float64Array(3), axis = new Float64Array(3);
    toolAt(this.machine, this.values, TOOL, tip);
    toolAt(this.machine, this.values, 0, axis, true);
    return { tip: Array.from(tip), axis: Array.from(axis) };
  }

  look() {
    this.root.updateMatrixWorld(true);
    const box = new THREE.Box3().setFromObject(this.root);
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const far = (1.05 * sphere.radius) / Math.sin((this.camera.fov / 2) * (Math.PI / 180));
    this.controls.target.copy(sphere.center);
    this.camera.position.set(-0.55, -1, 0.6).setLength(far).add(sphere.center);
    this.camera.near = far / 200;
    this.camera.far = far * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.renderer.setClearColor(getComputedStyle(document.body).getPropertyValue("--sky").trim() || "#fff");
      this.renderer.render(this.scene, this.camera);
    });
  }
}
