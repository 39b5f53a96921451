// What the curves show over the program: its axes, feed, speed of turning, and room to the limits.

import { say } from "./texts.js";

/** @typedef {import("./program.js").Program} ShownProgram */

/**
 * One strip for each curve.
 * @param {ShownProgram} program
 */
export function strips(program) {
  const axes = program.machine.axes.map((axis, k) => ({
    name: axis.name, unit: axis.rotary ? "°" : "mm", low: axis.placed ? axis.low : null, high: axis.placed ? axis.high : null,
    at: (/** @type {number} */ piece, share = 1) => positionOf(program, k, piece, share),
  }));
  /** @type {any} */
  const feed = { name: "F", unit: "mm/min", low: null, high: null, at: (/** @type {number} */ piece) => program.feedOf(program.row[piece]) };
  /** @type {any} */
  const rotary = { name: "ω", unit: "°/min", low: null, high: null, at: (/** @type {number} */ piece) => rotarySpeed(program, piece) };
  const limited = program.machine.axes.flatMap((axis, k) => (axis.placed && axis.low !== null && axis.high !== null ? [k] : []));
  /** @type {any} */
  const room = {
    name: say("limits"), unit: "%", low: 0, high: null,
    curves: limited.map((k) => ({ name: program.machine.axes[k].name, at: (/** @type {number} */ piece, share = 1) => roomOf(program, k, piece, share) })),
  };
  return [...axes, rotary, feed, ...(limited.length ? [room] : [])];
}

/**
 * Where an axis is within a piece, as ``valuesAt`` has it.
 * @param {ShownProgram} program
 * @param {number} k number of the axis
 * @param {number} piece
 * @param {number} share of its time that has gone by
 */
function positionOf(program, k, piece, share) {
  const from = program.axes[k][piece];
  return share < 1 ? from + share * (program.axes[k][piece + 1] - from) : program.axes[k][piece + 1];
}

/**
 * Speed of the faster rotary axis, degrees a minute; 0 in no time, NaN where that is not known.
 * @param {ShownProgram} program
 * @param {number} piece
 */
export function rotarySpeed(program, piece) {
  const takes = program.time[piece + 1] - program.time[piece];
  if (!(takes > 0) || !program.scene.timed) return 0;
  if (Number.isNaN(program.feedOf(program.row[piece]))) return NaN;
  let most = 0;
  program.machine.axes.forEach((axis, k) => {
    if (axis.rotary) most = Math.max(most, Math.abs(program.axes[k][piece + 1] - program.axes[k][piece]));
  });
  return (60 * most) / takes;
}

/**
 * How far an axis is from the nearer of its limits, in parts of a hundred of its travel.
 * @param {ShownProgram} program
 * @param {number} k number of the axis
 * @param {number} piece
 * @param {number} share of its time that has gone by
 */
function roomOf(program, k, piece, share) {
  const { low, high } = program.machine.axes[k], value = positionOf(program, k, piece, share);
  return (100 * Math.min(value - low, high - value)) / (high - low);
}
