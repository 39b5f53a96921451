// The machine as it moves: the same chain as in trunnion.machines.links, for one pose or for all of a program.

/** @typedef {import("./data.js").Machine} Machine */

/**
 * Move a point as a joint moves it; `back` undoes that.
 * @param {import("./data.js").Axis} axis
 * @param {number} value mm or degrees, as the axis moves what it carries
 * @param {Float64Array} p (3,), changed
 * @param {boolean} turnOnly a direction, which slides leave alone
 */
function moveBy(axis, value, p, turnOnly) {
  const [a, b, c] = axis.direction;
  if (!axis.rotary) {
    if (turnOnly) return;
    p[0] += a * value; p[1] += b * value; p[2] += c * value;
    return;
  }
  const angle = ((value - 360 * Math.floor(value / 360 + 0.5)) * Math.PI) / 180;
  const cos = Math.cos(angle), sin = Math.sin(angle);
  const [u, v, w] = turnOnly ? [0, 0, 0] : axis.point;
  const x = p[0] - u, y = p[1] - v, z = p[2] - w;
  const along = (a * x + b * y + c * z) * (1 - cos);
  p[0] = u + x * cos + (b * z - c * y) * sin + a * along;
  p[1] = v + y * cos + (c * x - a * z) * sin + b * along;
  p[2] = w + z * cos + (a * y - b * x) * sin + c * along;
}

/**
 * Tip of the tool (or, with `direction`, the tool axis) in the workpiece frame.
 * @param {Machine} machine
 * @param {ArrayLike<number>} values of the five axes
 * @param {number} length of the tool, mm
 * @param {Float64Array} p (3,), written
 * @param {boolean} direction
 */
export function toolAt(machine, values, length, p, direction = false) {
  for (let k = 0; k < 3; k++) p[k] = direction ? machine.spindle[k] : machine.gauge[k] - length * machine.spindle[k];
  const axes = machine.axes;
  for (let k = 4; k >= machine.partAxes; k--) moveBy(axes[k], values[k], p, direction);
  // The part goes against displayed values, so that undoing it goes with them.
  for (let k = machine.partAxes - 1; k >= 0; k--) moveBy(axes[k], values[k], p, direction);
  if (!direction && machine.zero) for (let k = 0; k < 3; k++) p[k] -= machine.zero[k];
}

/**
 * The map (16, column by column) by which one joint moves what it carries.
 * @param {Machine} machine
 * @param {number} joint
 * @param {number} value as displayed
 */
export function jointMatrix(machine, joint, value) {
  const axis = machine.axes[joint];
  const moved = joint < machine.partAxes ? -value : value;
  const found = new Array(16).fill(0);
  found[15] = 1;
  const p = new Float64Array(3);
  for (let column = 0; column < 4; column++) {
    p.fill(0);
    if (column < 3) p[column] = 1;
    moveBy(axis, moved, p, column < 3);
    for (let k = 0; k < 3; k++) found[4 * column + k] = p[k];
  }
  return found;
}

/**
 * Columns of axis values in counts of 32 bits, whole again: the steps between them are small.
 * @param {Int32Array} counts
 * @param {number} count mm or degrees
 */
export function unwrapped(counts, count) {
  const found = new Float64Array(counts.length);
  let whole = counts.length ? counts[0] : 0;
  if (counts.length) found[0] = whole * count;
  for (let i = 1; i < counts.length; i++) {
    whole += (counts[i] - counts[i - 1]) | 0;
    found[i] = whole * count;
  }
  return found;
}
