/* The path in space: unpacks the columns of the page, draws them with WebGL, and follows the mouse.
 *
 * Each operation is two lists of line segments, at feed and rapid, in one buffer each. Without WebGL the same segments
 * are drawn on the plain canvas, at most `MOST_PLAIN` of them. The camera looks along -z of `turn`, without perspective.
 */
"use strict";
(async () => {
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);
  const COLOURS = [
    [31, 119, 180], [214, 92, 10], [44, 140, 44], [200, 50, 50], [130, 90, 180], [150, 95, 80], [210, 90, 170],
    [110, 110, 110], [150, 150, 20], [20, 160, 175],
  ];
  const RAPID = [150, 150, 150];
  const DASH = 5; // pixels of a dash of a rapid, and of the gap behind it
  const MOST_PLAIN = 60000;
  const space = byId("space"), marks = byId("marks"), status = byId("status");

  /* Segments of one kind: two points of three numbers each, and for rapids how far along the path each is. */
  function segments(x, y, z, rapid, wanted) {
    let count = 0;
    for (let i = 1; i < x.length; i++) if (rapid[i] === wanted) count++;
    const made = new Float32Array(count * 8);
    for (let i = 1, at = 0, along = 0; i < x.length; i++) {
      if (rapid[i] !== wanted) { along = 0; continue; }
      const further = wanted ? along + Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1], z[i] - z[i - 1]) : 0;
      made.set([x[i - 1], y[i - 1], z[i - 1], along, x[i], y[i], z[i], further], at);
      along = further;
      at += 8;
    }
    return made;
  }

  byId("title").textContent = data.title;
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const operations = [];
  for (let k = 0; k < data.operations.length; k++) {
    const columns = [];
    for (let c = 0; c < 3; c++) {
      const column = new Float32Array((await unpack(`${k}-${"xyz"[c]}`)).buffer);
      for (const value of column) {
        if (value < low[c]) low[c] = value;
        if (value > high[c]) high[c] = value;
      }
      columns.push(column);
    }
    const rapid = await unpack(`${k}-rapid`);
    operations.push({
      colour: COLOURS[k % COLOURS.length], shown: true,
      cut: segments(...columns, rapid, 0), rapids: segments(...columns, rapid, 1),
    });
  }
  const centre = low.map((value, c) => (value + high[c]) / 2 || 0);
  const size = Math.max(Math.hypot(...low.map((value, c) => high[c] - value)), 1e-6) || 1;

  // ------------------------------------------------------------------------------------------------------------------
  // The list of operations

  operations.forEach((operation, k) => {
    const item = document.createElement("li"), label = document.createElement("label");
    const box = document.createElement("input"), colour = document.createElement("canvas");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => { operation.shown = box.checked; draw(); });
    colour.width = 14;
    colour.height = 10;
    const pen = colour.getContext("2d");
    pen.fillStyle = `rgb(${operation.colour})`;
    pen.fillRect(0, 0, 14, 10);
    const details = document.createElement("small");
    details.textContent = data.operations[k].details;
    label.append(box, " ", colour, ` ${k + 1} ${data.operations[k].name}`);
    item.append(label, details);
    byId("operations").append(item);
  });
  status.textContent = data.status;

  // ------------------------------------------------------------------------------------------------------------------
  // The camera: rows of `turn` are the directions right, up and towards the eye in coordinates of the part

  const VIEWS = {
    top: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    front: [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    right: [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
    space: [[0.7071, 0.7071, 0], [-0.4082, 0.4082, 0.8165], [0.5774, -0.5774, 0.5774]],
  };
  let turn, zoom, shift;
  function look(name) {
    turn = VIEWS[name].map((row) => row.slice());
    zoom = 1.8 / size;
    shift = [0, 0];
  }

  /* Turns the camera about its own right (by b) and up (by a), radians. */
  function rotate(a, b) {
    const mix = (p, q, angle) => [
      p.map((v, i) => v * Math.cos(angle) + q[i] * Math.sin(angle)),
      q.map((v, i) => v * Math.cos(angle) - p[i] * Math.sin(angle)),
    ];
    let [right, up, eye] = turn;
    [right, eye] = mix(right, eye, -a);
    [up, eye] = mix(up, eye, b);
    turn = [right, up, eye];
  }

  const project = (x, y, z) => {
    const d = [x - centre[0], y - centre[1], z - centre[2]];
    const on = (row) => row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
    const narrow = Math.min(space.width, space.height) / 2;
    return [
      space.width / 2 + (on(turn[0]) * zoom + shift[0]) * narrow,
      space.height / 2 - (on(turn[1]) * zoom + shift[1]) * narrow,
    ];
  };

  // ------------------------------------------------------------------------------------------------------------------
  // Drawing

  const gl = space.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  let program, uniforms, point;
  if (gl) {
    const shader = (type, source) => {
      const made = gl.createShader(type);
      gl.shaderSource(made, source);
      gl.compileShader(made);
      return made;
    };
    program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, `
      attribute vec4 point; varying float along; uniform vec3 centre, right, up, eye; uniform vec2 scale, shift; uniform float depth;
      void main() {
        vec3 d = point.xyz - centre;
        along = point.w;
        gl_Position = vec4((vec2(dot(d, right), dot(d, up)) + shift) * scale, -dot(d, eye) * depth, 1.0);
      }`));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `
      precision highp float; varying float along; uniform vec4 colour; uniform float dash;
      void main() { if (mod(along, 2.0 * dash) > dash) discard; gl_FragColor = colour; }`));
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    point = gl.getAttribLocation(program, "point");
    gl.enableVertexAttribArray(point);
    uniforms = {};
    for (const name of ["centre", "right", "up", "eye", "scale", "shift", "depth", "colour", "dash"]) {
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    for (const operation of operations) {
      for (const kind of ["cut", "rapids"]) {
        const buffer = gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, operation[kind], gl.STATIC_DRAW);
        operation[kind] = { buffer, count: operation[kind].length / 4 };
      }
    }
  }

  function drawWithGl() {
    const narrow = Math.min(space.width, space.height);
    gl.viewport(0, 0, space.width, space.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniform3fv(uniforms.centre, centre);
    gl.uniform3fv(uniforms.right, turn[0]);
    gl.uniform3fv(uniforms.up, turn[1]);
    gl.uniform3fv(uniforms.eye, turn[2]);
    gl.uniform2f(uniforms.scale, zoom * narrow / space.width, zoom * narrow / space.height);
    gl.uniform2f(uniforms.shift, shift[0] / zoom, shift[1] / zoom);
    gl.uniform1f(uniforms.depth, 0.9 / size);
    gl.uniform1f(uniforms.dash, (2 * DASH * scale) / (zoom * narrow));
    for (const operation of operations) {
      if (!operation.shown) continue;
      for (const kind of byId("rapids").checked ? ["cut", "rapids"] : ["cut"]) {
        const colour = kind === "cut" ? operation.colour : RAPID;
        gl.uniform4f(uniforms.colour, colour[0] / 255, colour[1] / 255, colour[2] / 255, 1);
        gl.bindBuffer(gl.ARRAY_BUFFER, operation[kind].buffer);
        gl.vertexAttribPointer(point, 4, gl.FLOAT, false, 0, 0);
        gl.drawArrays(gl.LINES, 0, operation[kind].count);
      }
    }
  }

  function drawPlain() {
    const pen = space.getContext("2d");
    pen.clearRect(0, 0, space.width, space.height);
    const every = Math.max(1, Math.ceil(shown / MOST_PLAIN));
    for (const operation of operations) {
      if (!operation.shown) continue;
      for (const kind of byId("rapids").checked ? ["rapids", "cut"] : ["cut"]) {
        pen.setLineDash(kind === "cut" ? [] : [DASH * scale, DASH * scale]);
        pen.strokeStyle = `rgb(${kind === "cut" ? operation.colour : RAPID})`;
        pen.beginPath();
        const list = operation[kind];
        for (let i = 0; i < list.length; i += 8 * every) {
          pen.moveTo(...project(list[i], list[i + 1], list[i + 2]));
          pen.lineTo(...project(list[i + 4], list[i + 5], list[i + 6]));
        }
        pen.stroke();
      }
    }
  }

  /* The directions of the axes, in the lower right corner. */
  function drawMarks() {
    const pen = marks.getContext("2d");
    const unit = 46 * scale, x = marks.width - 1.8 * unit, y = marks.height - 1.8 * unit;
    pen.clearRect(0, 0, marks.width, marks.height);
    pen.font = `${14 * scale}px sans-serif`;
    pen.lineWidth = 2 * scale;
    ["X", "Y", "Z"].forEach((name, c) => {
      pen.strokeStyle = pen.fillStyle = `rgb(${[[200, 50, 50], [44, 140, 44], [31, 119, 180]][c]})`;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + turn[0][c] * unit, y - turn[1][c] * unit);
      pen.stroke();
      pen.fillText(name, x + turn[0][c] * unit * 1.2 - 4 * scale, y - turn[1][c] * unit * 1.2 + 5 * scale);
    });
  }

  let due = false, scale = 1;
  function draw() {
    if (due) return;
    due = true;
    requestAnimationFrame(() => {
      due = false;
      scale = window.devicePixelRatio || 1;
      for (const canvas of [space, marks]) {
        const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
      }
      if (gl) drawWithGl(); else drawPlain();
      drawMarks();
    });
  }

  // ------------------------------------------------------------------------------------------------------------------
  // The mouse

  let held = null;
  marks.addEventListener("pointerdown", (event) => {
    held = { x: event.clientX, y: event.clientY, moves: event.shiftKey || event.button !== 0 };
    marks.setPointerCapture(event.pointerId);
  });
  marks.addEventListener("pointermove", (event) => {
    if (!held) return;
    const dx = event.clientX - held.x, dy = event.clientY - held.y;
    const narrow = Math.min(marks.clientWidth, marks.clientHeight) / 2;
    if (held.moves) shift = [shift[0] + dx / narrow, shift[1] - dy / narrow];
    else rotate(dx / narrow, dy / narrow);
    [held.x, held.y] = [event.clientX, event.clientY];
    draw();
  });
  for (const name of ["pointerup", "pointercancel"]) marks.addEventListener(name, () => { held = null; });
  marks.addEventListener("contextmenu", (event) => event.preventDefault());
  marks.addEventListener("wheel", (event) => {
    event.preventDefault();
    const factor = Math.exp(-event.deltaY * 0.0015);
    const narrow = Math.min(marks.clientWidth, marks.clientHeight) / 2;
    const at = [(event.clientX - marks.clientWidth / 2) / narrow, (marks.clientHeight / 2 - event.clientY) / narrow];
    shift = shift.map((value, i) => at[i] + (value - at[i]) * factor); // what is under the mouse stays there
    zoom *= factor;
    draw();
  }, { passive: false });
  byId("rapids").addEventListener("change", draw);
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => { look(button.dataset.view); draw(); });
  }
  window.addEventListener("resize", draw);
  look("space");
  draw();
})();
