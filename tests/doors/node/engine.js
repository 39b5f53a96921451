// Stands for Autodesk's post engine: runs a post (.cps) on streams of events and gives what it writes.
//
//   node engine.js POST < STREAMS.json > RESULTS.json
//
// A stream is a program: its unit, properties, sections and, for each section, what the engine would call. What the engine does
// between a stream and the post is here as its public reference says it: it splits arcs by maximumCircularSweep, flips the normal
// of clockwise arcs, expands cycles that the post does not write, and maps points of a section by its work plane.
"use strict";
const fs = require("fs");
const vm = require("vm");

const NAMES = {
  COMMAND: ["STOP", "OPTIONAL_STOP", "END", "SPINDLE_CLOCKWISE", "SPINDLE_COUNTERCLOCKWISE", "START_SPINDLE", "STOP_SPINDLE",
    "ORIENTATE_SPINDLE", "LOAD_TOOL", "COOLANT_ON", "COOLANT_OFF", "LOCK_MULTI_AXIS", "UNLOCK_MULTI_AXIS", "EXACT_STOP",
    "START_CHIP_TRANSPORT", "STOP_CHIP_TRANSPORT", "OPEN_DOOR", "CLOSE_DOOR", "BREAK_CONTROL", "TOOL_MEASURE", "CALIBRATE",
    "VERIFY", "CLEAN", "ALARM", "ALERT", "CHANGE_PALLET"],
  COOLANT: ["OFF", "FLOOD", "MIST", "THROUGH_TOOL", "AIR", "AIR_THROUGH_TOOL", "SUCTION", "FLOOD_MIST", "FLOOD_THROUGH_TOOL"],
  TOOL: ["UNSPECIFIED", "DRILL", "DRILL_CENTER", "DRILL_SPOT", "MILLING_END_FLAT", "MILLING_END_BALL", "MILLING_END_BULLNOSE",
    "MILLING_CHAMFER", "MILLING_FACE", "MILLING_SLOT", "MILLING_RADIUS", "MILLING_DOVETAIL", "MILLING_TAPERED",
    "MILLING_LOLLIPOP", "MILLING_FORM", "MILLING_THREAD", "TAP_RIGHT_HAND", "TAP_LEFT_HAND", "REAMER", "BORING_BAR",
    "COUNTER_BORE", "COUNTER_SINK", "PROBE"],
  RADIUS_COMPENSATION: ["OFF", "LEFT", "RIGHT"],
  FEED: ["PER_MINUTE", "PER_REVOLUTION", "INVERSE_TIME"],
  TYPE: ["MILLING", "TURNING", "JET"],
  CAPABILITY: ["MILLING", "TURNING"],
  PLANE: ["XY", "ZX", "YZ"],
};

class Vector {
  constructor(x, y, z) { this.x = x; this.y = y; this.z = z; }
}
const vector = (numbers) => new Vector(...numbers);
const plus = (a, b, by = 1) => a.map((each, n) => each + by * b[n]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** A direction or position turned about a unit vector by an angle in radians. */
function turned(p, n, angle) {
  const along = n.map((each) => each * dot(p, n));
  const u = plus(p, along, -1);
  return plus(plus(along, u.map((each) => each * Math.cos(angle))), cross(n, u).map((each) => each * Math.sin(angle)));
}

class Refused extends Error {}

/** A section as the post sees it. */
function sectionOf(given, id) {
  const [x, y, z] = given.plane;
  const origin = given.origin || [0, 0, 0];
  const parameters = given.parameters;
  return {
    workPlane: {right: vector(x), up: vector(y), forward: vector(z)},
    workOrigin: vector(origin),
    workOffset: given.offset,
    wcsOrigin: vector(given.wcs.origin),
    wcsPlane: {right: vector(given.wcs.x), up: vector(given.wcs.y)},
    axisSubstitution: Boolean(given.wrapped),
    feedMode: given.perRevolution ? 1 : 0,
    getId: () => id,
    getType: () => given.type || 0,
    getTool: () => given.tool,
    isMultiAxis: () => given.fiveAxis,
    isOptimizedForMachine: () => Boolean(given.optimized),
    isOptional: () => Boolean(given.optional),
    isPatterned: () => given.pattern !== undefined,
    getPatternId: () => given.pattern || 0,
    getForceToolChange: () => Boolean(given.forced),
    hasDynamicWorkOffset: () => false,
    getInitialPosition: () => vector(given.start),
    getInitialToolAxis: () => vector(given.axis),
    getWCSPosition: (p) => vector(plus(given.engineShift || [0, 0, 0],
      plus(origin, [0, 1, 2].map((n) => x[n] * p.x + y[n] * p.y + z[n] * p.z)))),
    hasParameter: (name) => name in parameters,
    getParameter: (name) => parameters[name],
  };
}

/** A tool with its holder as the post sees them. */
function toolOf(given) {
  const pieces = given.holder || [];
  const holder = {
    hasSections: () => pieces.length > 0, getNumberOfSections: () => pieces.length,
    getDiameter: (n) => pieces[n][0], getLength: (n) => pieces[n][1],
  };
  return {...given, holder};
}

function run(source, stream) {
  const lines = [], warnings = [];
  const sections = stream.sections.map(sectionOf);
  let now = null, position = null, arc = null;
  const post = {
    Vector, programName: stream.name, programComment: stream.comment || "", unit: stream.inch ? 1 : 0, MM: 0, IN: 1,
    currentSection: undefined, tool: undefined, spindleSpeed: 0, cycle: undefined, cycleType: undefined, radiusCompensation: 0,
    spatial: (value, unit) => value * (unit === post.unit ? 1 : unit === 1 ? 25 : 1 / 25),
    toRad: (degrees) => degrees * Math.PI / 180, toDeg: (radians) => radians * 180 / Math.PI,
    setCodePage: () => {}, setWriteBOM: () => {},
    writeln: (text) => lines.push(text), warning: (text) => warnings.push(text),
    error: (text) => { throw new Refused(text); },
    getProperty: (name) => (name in stream.properties ? stream.properties[name] : post.properties[name].value),
    getNumberOfSections: () => sections.length, getSection: (n) => sections[n], getCurrentSectionId: () => now,
    getWorkpiece: () => ({lower: vector(stream.stock[0]), upper: vector(stream.stock[1])}),
    hasParameter: (name) => post.currentSection.hasParameter(name),
    getParameter: (name) => post.currentSection.getParameter(name),
    getCommandStringId: (n) => "COMMAND_" + NAMES.COMMAND[n],
    getCurrentPosition: () => vector(position),
    getCircularNormal: () => vector(arc.normal), getCircularSweep: () => arc.sweep,
    linearize: () => {
      const {start, end, n, centre, sweep, rise, feed} = arc;
      for (let k = 1; k < 8; ++k) {
        post.onLinear(...plus(plus(centre, turned(plus(start, centre, -1), n, sweep * k / 8)), n, rise * k / 8), feed);
      }
      post.onLinear(...end, feed);
    },
    expandCyclePoint: (x, y, z) => {
      post.onRapid(x, y, post.cycle.clearance);
      post.onRapid(x, y, post.cycle.retract);
      post.onLinear(x, y, z, post.cycle.feedrate);
      post.onRapid(x, y, post.cycle.clearance);
    },
  };
  for (const [kind, names] of Object.entries(NAMES)) names.forEach((name, n) => { post[kind + "_" + name] = n; });

  const calls = {
    rapid: (p) => { post.onRapid(...p); position = p; },
    line: (p, feed) => { post.onLinear(...p, feed); position = p; },
    rapid5: (p, v) => { post.onRapid5D(...p, ...v); position = p; },
    line5: (p, v, feed, mode) => { post.onLinear5D(...p, ...v, feed, mode); position = p; },
    arc: (centre, n, degrees, rise, feed, claimed) => {
      // n: right-handed; the engine gives the axis of the plane (G17, G18, G19) and the sense.
      const all = degrees * Math.PI / 180;
      const parts = Math.ceil(all / post.maximumCircularSweep - 1e-9);
      for (let k = 0; k < parts; ++k) {
        const sweep = all / parts;
        const end = plus(plus(centre, turned(plus(position, centre, -1), n, sweep)), n, rise / parts);
        const isClockwise = n.reduce((sum, each) => sum + each, 0) < 0;
        arc = {start: position, end, n, centre, rise: rise / parts, feed, sweep: claimed ? claimed * Math.PI / 180 : sweep,
          normal: isClockwise ? n.map((each) => -each) : n};
        post.onCircular(isClockwise, ...centre, ...end, feed);
        position = end;
      }
    },
    cycle: (type, words, holes) => {
      post.cycleType = type;
      post.onCycle();
      for (const {point, ...own} of holes) {
        post.cycle = {...words, ...own};
        post.onCyclePoint(...point);
      }
      post.onCycleEnd();
    },
    compensation: (side) => { post.radiusCompensation = side; post.onRadiusCompensation(); },
    speed: (rpm) => { post.spindleSpeed = rpm; post.onSpindleSpeed(rpm); },
    command: (name) => post.onCommand(NAMES.COMMAND.indexOf(name)),
    comment: (text) => post.onComment(text), passThrough: (text) => post.onPassThrough(text),
    dwell: (seconds) => post.onDwell(seconds), parameter: (name, value) => post.onParameter(name, value),
    orient: (angle) => post.onOrientateSpindle(angle),
  };
  const play = (events) => events.forEach(([what, ...given]) => calls[what](...given));

  let error = null;
  try {
    vm.createContext(post);
    vm.runInContext(source, post);
    post.onOpen();
    stream.sections.forEach((given, id) => {
      play(given.before);
      now = id;
      Object.assign(post, {currentSection: sections[id], tool: toolOf(given.tool), spindleSpeed: given.spindle});
      position = given.start;
      post.onSection();
      play(given.events);
      post.onSectionEnd();
    });
    play(stream.after);
    post.onClose();
  } catch (fault) {
    if (!(fault instanceof Refused)) throw fault;
    error = fault.message;
  }
  return {text: lines.map((each) => each + "\n").join(""), error, warnings};
}

const source = fs.readFileSync(process.argv[2], "utf8");
const streams = JSON.parse(fs.readFileSync(0, "utf8"));
process.stdout.write(JSON.stringify(streams.map((stream) => run(source, stream))));
