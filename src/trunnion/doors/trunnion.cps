/**
  Trunnion APT, profile 1: a post of Autodesk Fusion, HSMWorks and Inventor CAM that writes CL data for Trunnion.

  It writes what the CAM system knows of a path: points and tool axes, the plane of each operation, tools, feeds, cycles, coolant,
  names, stops and texts. It plans nothing: `trunnion post` makes the program for a machine of it, and proves it.
  What the profile cannot say is an error with the name of the operation. Nothing is left out in silence.

  Lengths and feeds are in the output unit of the post dialog. Points of an operation are in its work plane, which MSYS states in the
  work coordinate system (WCS) of its set-up; those of five-axis operations are in the WCS. Arrays are [x, y, z].
  The language is ECMAScript 5, as the post engine has it.
*/

description = "Trunnion APT";
longDescription = "CL data for Trunnion, which makes proven five-axis programs of it: trunnion post part.apt --machine NAME.";
vendor = "Trunnion";
certificationLevel = 2;
minimumRevision = 45702;
extension = "apt";
setCodePage("utf-8");
if (typeof setWriteBOM == "function") {
  setWriteBOM(false);
}

capabilities = CAPABILITY_MILLING;
tolerance = spatial(0.001, MM);
minimumChordLength = spatial(0.01, MM);
minimumCircularRadius = spatial(0.01, MM);
maximumCircularRadius = spatial(10000, MM);
minimumCircularSweep = toRad(0.01);
maximumCircularSweep = toRad(120); // ends and centre then say all of an arc, and a half circle cannot hide its sense
allowHelicalMoves = true;
allowSpiralMoves = false;
allowedCircularPlanes = undefined; // any plane

properties = {
  probing: {
    title: "Probing",
    description: "Refused, or PROBE statements, for which the definition of the machine says what they become.",
    type: "enum",
    values: [
      {title: "refuse", id: "refuse"},
      {title: "PROBE statements", id: "events"}
    ],
    value: "refuse",
    scope: "post"
  },
  inserts: {
    title: "Lines of the program",
    description: "What becomes of commands that CL data cannot say: OPEN_DOOR=M38; ACTION:PALLET=M60; VERIFY= (nothing).",
    type: "string",
    value: "",
    scope: "post"
  }
};

var VERSION = 1;
var COOLANTS = {};
COOLANTS[COOLANT_OFF] = "OFF";
COOLANTS[COOLANT_FLOOD] = "FLOOD";
COOLANTS[COOLANT_MIST] = "MIST";
COOLANTS[COOLANT_THROUGH_TOOL] = "THRU";
COOLANTS[COOLANT_AIR] = "AIR";
var OTHER_COOLANTS = {};
OTHER_COOLANTS[COOLANT_AIR_THROUGH_TOOL] = "COOLANT_AIR_THROUGH_TOOL";
OTHER_COOLANTS[COOLANT_SUCTION] = "COOLANT_SUCTION";
OTHER_COOLANTS[COOLANT_FLOOD_MIST] = "COOLANT_FLOOD_MIST";
OTHER_COOLANTS[COOLANT_FLOOD_THROUGH_TOOL] = "COOLANT_FLOOD_THROUGH_TOOL";

var isOpen = false; // an operation has begun, and its END-OF-PATH is not written yet
var isInside = false; // between onSection and onSectionEnd
var pending = []; // statements between operations: they belong to the next one, or to the end of the last
var inserts = {}; // property `inserts`: lines by command
var operation = ""; // name of the operation, for messages
var state = {}; // of the operation: position, axis, feed, cycle, isFiveAxis, isTilted

// Text and numbers

function number(value, decimals) {
  var text = Number(value).toFixed(decimals === undefined ? 6 : decimals);
  return (Number(text) === 0) ? text.replace("-", "") : text;
}

function listed(values, decimals) {
  var texts = [];
  for (var i = 0; i < values.length; ++i) {
    texts.push(number(values[i], decimals));
  }
  return texts.join(",");
}

/** One line without control characters. */
function line(text) {
  return String(text).replace(/[\u0000-\u001f\u007f]+/g, " ").replace(/^ +| +$/g, "");
}

/** Lines of a text that have something in them. */
function linesOf(text) {
  var found = [];
  var all = String(text).split(/\r\n|\r|\n/);
  for (var i = 0; i < all.length; ++i) {
    if (line(all[i])) {
      found.push(line(all[i]));
    }
  }
  return found;
}

/** A statement that is no motion: inside an operation at once, between two for the next one. */
function say(statement) {
  if (isInside) {
    writeln(statement);
  } else {
    pending.push(statement);
  }
}

function sayPending() {
  for (var i = 0; i < pending.length; ++i) {
    writeln(pending[i]);
  }
  pending = [];
}

function refuse(what) {
  var where = operation ? (isInside ? "operation '" : "behind operation '") + operation + "': " : "";
  error(where + what);
}

/** What the property `inserts` says of a command; else it is refused. */
function insertOrRefuse(command, what) {
  var key = command.toUpperCase();
  if (!inserts.hasOwnProperty(key)) {
    refuse(what + " cannot be said in CL data. Remove it, or state the line of the program in the post property 'Lines of the program': " + key + "=...");
    return;
  }
  if (inserts[key]) {
    say("INSERT/" + inserts[key]);
  }
}

function readInserts(text) {
  var parts = String(text).split(";");
  for (var i = 0; i < parts.length; ++i) {
    var at = parts[i].indexOf("=");
    if (at > 0) {
      inserts[line(parts[i].substring(0, at)).toUpperCase()] = line(parts[i].substring(at + 1));
    } else if (line(parts[i])) {
      error("post property 'Lines of the program': '" + line(parts[i]) + "' has no '='");
    }
  }
}

// Geometry

function array(vector) {
  return [vector.x, vector.y, vector.z];
}

function minus(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function norm(a) {
  return Math.sqrt(dot(a, a));
}

function isSame(a, b, within) {
  return norm(minus(a, b)) <= within;
}

/** Lengths that differ by less are the same. */
function small() {
  return (unit == IN) ? 0.00004 : 0.001;
}

// Program

function nameOf(section, id) {
  var name = section.hasParameter("operation-comment") ? line(section.getParameter("operation-comment")) : "";
  return (name || ("OPERATION " + (id + 1))).replace(/, *tool *,/gi, " TOOL ");
}

function offsetOf(section) {
  return (section.workOffset > 0) ? section.workOffset : 1; // 0: the first
}

/** Several set-ups: each work offset is one zero. Whether there are several, and whether any is stated. */
function checkOffsets() {
  var first = {};
  var count = 0;
  for (var i = 0; i < getNumberOfSections(); ++i) {
    var section = getSection(i);
    var offset = offsetOf(section);
    statesOffsets = statesOffsets || (section.workOffset > 0);
    if (!first.hasOwnProperty(offset)) {
      first[offset] = {section: section, name: nameOf(section, i)};
      count += 1;
    } else if (section.wcsOrigin && section.wcsPlane) {
      var other = first[offset].section;
      if (!isSame(array(section.wcsOrigin), array(other.wcsOrigin), small()) ||
          !isSame(array(section.wcsPlane.right), array(other.wcsPlane.right), 1e-6) ||
          !isSame(array(section.wcsPlane.up), array(other.wcsPlane.up), 1e-6)) {
        error("operations '" + first[offset].name + "' and '" + nameOf(section, i) + "' have one work offset (" + offset +
          ") and different coordinate systems: give their set-ups different work offsets, or post each set-up by itself");
        return false;
      }
    }
  }
  return count > 1;
}

var hasOffsets = false;
var statesOffsets = false;

function onOpen() {
  readInserts(getProperty("inserts"));
  statesOffsets = false;
  hasOffsets = checkOffsets();
  writeln("$$-> TRUNNION / " + VERSION);
  if (programName) {
    writeln("PARTNO/" + line(programName));
  }
  writeln("UNITS/" + ((unit == IN) ? "INCHES" : "MM"));
  var stock = getWorkpiece();
  var size = minus(array(stock.upper), array(stock.lower));
  if (!hasOffsets && size[0] > 0 && size[1] > 0 && size[2] > 0) {
    writeln("$$-> STOCK / BOX," + listed(size) + "," + listed(array(stock.lower)));
  }
  if (programComment) {
    onComment(programComment);
  }
}

function endOperation() {
  if (isOpen) {
    writeln("END-OF-PATH");
  }
  isOpen = false;
}

function onClose() {
  if (isOpen) {
    sayPending();
  } else if (pending.length) {
    refuse("the program has no operation");
  }
  endOperation();
  writeln("FINI");
}

// Tools

function tipDiameter(tool) {
  return (tool.tipDiameter !== undefined) ? tool.tipDiameter : (tool.getTipDiameter ? tool.getTipDiameter() : undefined);
}

/** Form and sizes, by the words of the profile; undefined: the form of such tools is not settled. */
function formOf(tool) {
  var d = tool.diameter;
  var r = tool.cornerRadius;
  var angle = toDeg(tool.taperAngle || 0);
  switch (tool.type) {
  case TOOL_MILLING_END_FLAT:
  case TOOL_REAMER:
  case TOOL_BORING_BAR:
  case TOOL_COUNTER_BORE:
  case TOOL_TAP_RIGHT_HAND:
  case TOOL_TAP_LEFT_HAND:
    return {form: "MILL", words: [["DIAMETER", d]], isWhole: true};
  case TOOL_MILLING_END_BALL:
    return {form: "MILL", words: [["DIAMETER", d], ["CORNER", d / 2]], isWhole: true};
  case TOOL_MILLING_END_BULLNOSE:
    return {form: "MILL", words: [["DIAMETER", d], ["CORNER", r]], isWhole: true};
  case TOOL_MILLING_FACE:
    return angle ? undefined : {form: "MILL", words: [["DIAMETER", d], ["CORNER", r]], isWhole: true};
  case TOOL_MILLING_TAPERED: // the diameter is where side and bottom would meet; the corner touches both
    var b = tool.taperAngle || 0;
    var words = [["DIAMETER", d], ["CORNER", r], ["TAPER", angle]];
    if (r > 0) {
      words.push(["CENTRE", d / 2 - r * (1 - Math.sin(b)) / Math.cos(b), r]);
    }
    return {form: "MILL", words: words, isWhole: true};
  case TOOL_MILLING_CHAMFER: // the angle is half of the whole one
    var tip = tipDiameter(tool);
    if (tip > 0 && angle > 0 && angle < 90) {
      var cone = (d - tip) / 2 / Math.tan(tool.taperAngle);
      return {form: "MILL", words: [["DIAMETER", tip], ["TAPER", angle], ["LENGTH", cone]], isWhole: false};
    }
    return (tip === 0 && angle > 0 && angle < 90) ? {form: "DRILL", words: [["DIAMETER", d], ["TIP", 2 * angle]], isWhole: true} : undefined;
  case TOOL_MILLING_SLOT:
    return {form: "TCUTTER", words: [["DIAMETER", d], ["CORNER", r], ["UPPER", r], ["LENGTH", Math.max(tool.fluteLength, 2 * r)]], isWhole: false};
  case TOOL_DRILL:
  case TOOL_DRILL_SPOT: // the angle is the whole one of the point
    return angle ? {form: "DRILL", words: [["DIAMETER", d], ["TIP", angle]], isWhole: true} : undefined;
  default:
    return undefined;
  }
}

function writeTool(tool) {
  var found = formOf(tool);
  if (!found) {
    warning("operation '" + operation + "': the form of tool " + tool.number + " cannot be said in CL data; give it to a simulation by a tool library.");
    found = {form: "UNKNOWN", words: [["DIAMETER", tool.diameter]], isWhole: false};
  }
  var words = found.words;
  if (found.isWhole) {
    words = words.concat([["LENGTH", tool.bodyLength], ["FLUTE", Math.min(tool.fluteLength, tool.bodyLength)]]);
  }
  words = words.concat([["EXTENSION", tool.bodyLength]]);
  var text = "";
  for (var i = 0; i < words.length; ++i) {
    if (words[i][0] == "CENTRE" || words[i][1] > 0) {
      text += "," + words[i][0] + "," + listed(words[i].slice(1));
    }
  }
  writeln("$$-> TOOL / " + found.form + text);
  if (tool.holder && tool.holder.hasSections() && tool.holderDescription) {
    writeln("$$-> HOLDER / " + line(tool.holderDescription));
  }
}

function writeSpindle(speed, isClockwise) {
  say((speed > 0) ? "SPINDL/RPM," + number(speed) + "," + (isClockwise ? "CLW" : "CCLW") : "SPINDL/OFF");
}

function writeCoolant(kind) {
  if (COOLANTS.hasOwnProperty(kind)) {
    say("COOLNT/" + COOLANTS[kind]);
  } else if (OTHER_COOLANTS.hasOwnProperty(kind)) {
    insertOrRefuse(OTHER_COOLANTS[kind], "coolant of the kind " + OTHER_COOLANTS[kind].substring(8).toLowerCase().replace(/_/g, " "));
  } else {
    refuse("coolant of an unknown kind (" + kind + ")");
  }
}

// Operations

/** What an operation is that CL data cannot say; empty: nothing. */
function unsayable() {
  if (currentSection.getType() != TYPE_MILLING) {
    return "turning and jet cutting are not read";
  }
  if (currentSection.axisSubstitution) {
    return "a wrapped path is in the coordinates of a rotary axis: use a five-axis operation, or unwrap it";
  }
  if (currentSection.isOptimizedForMachine && currentSection.isOptimizedForMachine()) {
    return "its tool axes are angles of a machine: take the machine out of the set-up, for Trunnion has its own";
  }
  if (currentSection.hasDynamicWorkOffset && currentSection.hasDynamicWorkOffset()) {
    return "it has a dynamic work offset";
  }
  if (currentSection.getForceToolChange && currentSection.getForceToolChange() && tool.number == state.tool) {
    return "the tool change is forced, and a tool that is in the spindle is not loaded again: use a stop";
  }
  return "";
}

/** The work plane as columns X, Y, Z and its origin, in the WCS. */
function planeOf(section) {
  var w = section.workPlane;
  return {x: array(w.right), y: array(w.up), z: array(w.forward), origin: section.workOrigin ? array(section.workOrigin) : [0, 0, 0]};
}

/** Whether the engine maps points of the section into the WCS by the plane that MSYS states. */
function isPlaneOfEngine(plane) {
  if (typeof currentSection.getWCSPosition != "function") {
    return true;
  }
  var local = array(currentSection.getInitialPosition());
  var mapped = array(currentSection.getWCSPosition(currentSection.getInitialPosition()));
  for (var i = 0; i < 3; ++i) {
    if (Math.abs(plane.origin[i] + plane.x[i] * local[0] + plane.y[i] * local[1] + plane.z[i] * local[2] - mapped[i]) > small()) {
      return false;
    }
  }
  return true;
}

function writePlane() {
  var plane = planeOf(currentSection);
  state.isFiveAxis = currentSection.isMultiAxis();
  var isLevel = isSame(plane.x, [1, 0, 0], 1e-9) && isSame(plane.y, [0, 1, 0], 1e-9) && isSame(plane.origin, [0, 0, 0], 1e-9);
  if (state.isFiveAxis && !isLevel) {
    refuse("a five-axis operation with a work plane of its own: published posts differ in what its points mean. Take its tool orientation away");
    return;
  }
  if (!isPlaneOfEngine(plane)) {
    refuse("the post engine maps its points otherwise than its work plane says");
    return;
  }
  writeln("MSYS/" + listed(plane.origin) + "," + listed(plane.x, 9) + "," + listed(plane.y, 9));
}

function writeTolerance() {
  var given = hasParameter("operation:tolerance") ? Number(getParameter("operation:tolerance")) : 0;
  if (given > 0 && given < 1) {
    writeln("INTOL/" + number(given));
    writeln("OUTTOL/" + number(given));
  }
}

function onSection() {
  endOperation();
  operation = nameOf(currentSection, getCurrentSectionId());
  isInside = true;
  var fault = unsayable();
  if (fault) {
    refuse(fault);
    return;
  }
  state = {tool: tool.number};
  isOpen = true;
  writeln("TOOL PATH/" + operation + ",TOOL," + (line(tool.description || "") || ("T" + tool.number)));
  writeTool(tool);
  writePlane();
  writeTolerance();
  if (statesOffsets) {
    writeln("$$-> WORK-OFFSET / " + offsetOf(currentSection));
  }
  sayPending();
  if (tool.manualToolChange) {
    writeln("STOP/T" + tool.number);
  }
  writeln("LOADTL/" + tool.number + ((tool.lengthOffset > 0) ? ",ADJUST," + tool.lengthOffset : ""));
  if (hasParameter("notes")) {
    onComment(getParameter("notes"));
  }
  if (tool.type != TOOL_PROBE) {
    writeSpindle(spindleSpeed, tool.clockwise);
    writeCoolant(tool.coolant);
  }
  state.axis = state.isFiveAxis ? array(currentSection.getInitialToolAxis()) : [0, 0, 1];
  writeMove(array(currentSection.getInitialPosition()), state.axis, undefined);
  if (currentSection.isOptional && currentSection.isOptional()) {
    writeln("OPSKIP/ON"); // behind the point to which the tool comes from home
    state.isOptional = true;
  }
}

function onSectionEnd() {
  endCycle();
  if (state.side) {
    writeln("CUTCOM/OFF");
  }
  if (state.isOptional) {
    writeln("OPSKIP/OFF");
  }
  if (tool.breakControl) {
    insertOrRefuse("BREAK_CONTROL", "the break control of tool " + tool.number);
  }
  isInside = false;
}

// Motion

/** A rapid (feed: undefined) or a line, in coordinates of the plane; a rapid to where the tool is, is none. */
function writeMove(point, axis, feed) {
  endCycle();
  if (feed === undefined) {
    if (state.point && isSame(state.point, point, 1e-9) && isSame(state.axis, axis, 1e-9)) {
      return;
    }
    writeln("RAPID");
  } else {
    writeFeed(feed);
  }
  writeGoto(point, axis);
}

function writeGoto(point, axis) {
  writeln("GOTO/" + listed(point) + (state.isFiveAxis ? "," + listed(axis, 9) : ""));
  state.point = point;
  state.axis = axis;
}

function feedWord() {
  var isPerTurn = currentSection.feedMode !== undefined && currentSection.feedMode == FEED_PER_REVOLUTION;
  return (unit == IN) ? (isPerTurn ? "IPR" : "IPM") : (isPerTurn ? "MMPR" : "MMPM");
}

function writeFeed(feed) {
  if (feed !== state.feed) {
    writeln("FEDRAT/" + feedWord() + "," + number(feed));
    state.feed = feed;
  }
}

function onRapid(x, y, z) {
  writeMove([x, y, z], state.axis, undefined);
}

function onLinear(x, y, z, feed) {
  writeMove([x, y, z], state.axis, feed);
}

/** The tool axis of a five-axis move, or undefined with an error. */
function axisOf(a, b, c) {
  if (!state.isFiveAxis || Math.abs(norm([a, b, c]) - 1) > 1e-3) {
    refuse("a tool axis is no unit vector (" + listed([a, b, c]) + "): take the machine out of the set-up, for Trunnion has its own");
    return undefined;
  }
  return [a, b, c];
}

function onRapid5D(x, y, z, a, b, c) {
  var axis = axisOf(a, b, c);
  if (axis) {
    writeMove([x, y, z], axis, undefined);
  }
}

function onLinear5D(x, y, z, a, b, c, feed, feedMode) {
  var axis = axisOf(a, b, c);
  if (feedMode !== undefined && feedMode != FEED_PER_MINUTE) {
    refuse("a feed of a five-axis move that is not per minute");
  } else if (axis) {
    writeMove([x, y, z], axis, feed);
  }
}

function onCircular(clockwise, cx, cy, cz, x, y, z, feed) {
  var start = array(getCurrentPosition());
  var n = array(getCircularNormal());
  if (clockwise) {
    n = [-n[0], -n[1], -n[2]];
  }
  var centre = [cx, cy, cz];
  var from = minus(start, centre);
  var to = minus([x, y, z], centre);
  var u = minus(from, [n[0] * dot(from, n), n[1] * dot(from, n), n[2] * dot(from, n)]);
  var v = minus(to, [n[0] * dot(to, n), n[1] * dot(to, n), n[2] * dot(to, n)]);
  var sweep = Math.atan2(dot(cross(n, u), v), dot(u, v));
  sweep = (sweep < 0) ? sweep + 2 * Math.PI : sweep;
  var off = Math.abs(sweep - getCircularSweep());
  if (state.isFiveAxis || Math.abs(norm(u) - norm(v)) > small() || getCircularSweep() > toRad(150)) {
    linearize(tolerance);
    return;
  }
  if (off > 0.01) {
    refuse("an arc whose ends contradict its angle (" + number(toDeg(sweep), 3) + " and " + number(toDeg(getCircularSweep()), 3) + " degrees)");
    return;
  }
  endCycle();
  writeFeed(feed);
  writeln("CIRCLE/" + listed(centre) + "," + listed(n, 9) + "," + number(norm(u)));
  writeGoto([x, y, z], state.axis);
}

function onRadiusCompensation() {
  endCycle();
  if (radiusCompensation == RADIUS_COMPENSATION_OFF) {
    if (state.side) {
      writeln("CUTCOM/OFF");
    }
    state.side = "";
    return;
  }
  var kind = hasParameter("operation:compensationType") ? getParameter("operation:compensationType") : "";
  if (kind != "control" && kind != "wear") {
    refuse("radius compensation of the type '" + kind + "': only 'in control' (points of the contour) and 'wear' (of the tool's centre) are known");
    return;
  }
  state.side = (radiusCompensation == RADIUS_COMPENSATION_LEFT) ? "LEFT" : "RIGHT";
  writeln("CUTCOM/" + state.side + ((kind == "control") ? ",CONTACT" : "") + ((tool.diameterOffset > 0) ? "," + tool.diameterOffset : ""));
}

// Cycles

function endCycle() {
  if (state.cycle) {
    writeln("CYCLE/OFF");
  }
  state.cycle = "";
}

/** Steps of pecks: the first, how much shorter each is, the shortest. */
function pecks() {
  var first = cycle.incrementalDepth;
  var less = cycle.incrementalDepthReduction || 0;
  var least = cycle.minimumIncrementalDepth || 0;
  return ",STEP," + listed((less > 0) ? ((least > 0) ? [first, less, Math.min(least, first)] : [first, less]) : [first]);
}

/** Mode and words of the cycle for a hole; empty: written as moves; undefined: refused. */
function cycleWords() {
  var dwell = (cycle.dwell > 0) ? ",DWELL," + number(cycle.dwell) : "";
  var isBroken = cycle.accumulatedDepth !== undefined && cycle.accumulatedDepth < cycle.depth;
  var isEven = cycle.retractFeedrate === undefined || Math.abs(cycle.retractFeedrate - cycle.feedrate) < 1e-6;
  switch (cycleType) {
  case "drilling":
    return "DRILL";
  case "counter-boring":
    return "FACE" + dwell;
  case "chip-breaking":
    return (isBroken || dwell) ? "" : "DRILL,BRKCHP" + pecks();
  case "deep-drilling":
    return dwell ? "" : "DRILL,DEEP" + pecks();
  case "tapping":
  case "left-tapping":
  case "right-tapping":
    return "TAP";
  case "tapping-with-chip-breaking":
  case "left-tapping-with-chip-breaking":
  case "right-tapping-with-chip-breaking":
    return "TAP,BRKCHP" + pecks();
  case "reaming":
    return isEven ? "REAM" + dwell : "";
  case "boring":
    return isEven ? "BORE" + dwell : "";
  case "stop-boring":
    return dwell ? "" : "BORE,DRAG";
  case "fine-boring":
  case "back-boring":
  case "manual-boring":
    return undefined;
  default:
    return "";
  }
}

/** Feed of a cycle: of a thread its pitch, whose hand is that of the spindle. */
function cycleFeed() {
  if (cycleType.indexOf("tapping") < 0) {
    return "," + feedWord() + "," + number(cycle.feedrate);
  }
  var isLeft = cycleType.indexOf("left-") == 0 || (cycleType.indexOf("right-") != 0 && tool.type == TOOL_TAP_LEFT_HAND);
  if (isLeft == tool.clockwise) {
    refuse("a " + (isLeft ? "left" : "right") + "-hand thread with the spindle turning " + (tool.clockwise ? "clockwise" : "counter-clockwise"));
    return undefined;
  }
  if (!(tool.threadPitch > 0)) {
    refuse("the pitch of tap " + tool.number + " is not known");
    return undefined;
  }
  return "," + ((unit == IN) ? "IPR" : "MMPR") + "," + number(tool.threadPitch);
}

function onCycle() {
}

function onCyclePoint(x, y, z) {
  if (isProbingCycle()) {
    writeProbing(x, y, z);
    return;
  }
  var words = state.isFiveAxis ? "" : cycleWords();
  if (words === undefined) {
    refuse("the cycle '" + cycleType + "' cannot be said in CL data: how far and to which side the tool moves off differs from control to control");
    return;
  }
  if (!words) {
    expandCyclePoint(x, y, z);
    return;
  }
  // Points are at the bottom; heights are coordinates along the tool.
  var rapid = cycle.retract - cycle.stock;
  var depth = cycle.stock - z;
  if (rapid < -1e-9 || depth < -1e-9) {
    refuse("a hole whose top is above its feed height or below its bottom");
    return;
  }
  var feed = cycleFeed();
  if (feed === undefined) {
    return;
  }
  var statement = "CYCLE/" + words + ",RAPTO," + number(rapid) + ",FEDTO," + number(-depth) + ",RTRCTO," +
    number(Math.max(cycle.clearance - cycle.stock, rapid)) + feed;
  if (statement != state.cycle) {
    endCycle();
    writeln(statement);
    state.cycle = statement;
  }
  writeln("GOTO/" + listed([x, y, cycle.stock]));
  state.point = undefined;
}

function onCycleEnd() {
  endCycle();
}

// Probing

function isProbingCycle() {
  return cycleType.indexOf("probing") == 0 || cycleType == "inspect";
}

function probeWord(name) {
  return name.replace(/([a-z])([A-Z])/g, "$1-$2").toUpperCase();
}

/** The way to where a probing cycle begins, and the cycle with its numbers, in the order of their names. */
function writeProbing(x, y, z) {
  if (getProperty("probing") != "events") {
    refuse("probing ('" + cycleType + "') cannot be said in CL data: post it apart, or set the post property 'Probing'");
    return;
  }
  writeMove([x, y, cycle.clearance], state.axis, undefined);
  writeMove([x, y, z], state.axis, cycle.feedrate);
  var names = [];
  for (var name in cycle) {
    if (typeof cycle[name] == "number") {
      names.push(name);
    }
  }
  names.sort();
  var text = "PROBE/" + probeWord(cycleType.replace("probing-", ""));
  for (var i = 0; i < names.length; ++i) {
    text += "," + probeWord(names[i]) + "," + number(cycle[names[i]]);
  }
  writeln(text);
  writeMove([x, y, cycle.clearance], state.axis, undefined);
}

// Texts, stops and commands

function onComment(text) {
  var found = linesOf(text);
  for (var i = 0; i < found.length; ++i) {
    say("PPRINT/" + found[i]);
  }
}

function onPassThrough(text) {
  var found = linesOf(text);
  for (var i = 0; i < found.length; ++i) {
    say("INSERT/" + found[i]);
  }
}

function onParameter(name, value) {
  if (name == "action") {
    insertOrRefuse("ACTION:" + line(value), "the action '" + line(value) + "'");
  } else if (name == "call-subprogram") {
    insertOrRefuse("CALL:" + line(value), "the call of program '" + line(value) + "'");
  } else if (name == "display") {
    say("DISPLY/" + line(value));
  } else if (name == "print") {
    say("PPRINT/" + line(value));
  }
}

function onDwell(seconds) {
  say("DELAY/" + number(seconds));
}

function onSpindleSpeed(speed) {
  writeSpindle(speed, tool.clockwise);
}

function onOrientateSpindle(angle) {
  insertOrRefuse("ORIENTATE_SPINDLE", "orienting the spindle");
}

function onMachineCommand(command) {
  insertOrRefuse("MACHINE_COMMAND:" + command, "machine command " + command);
}

function onCommand(command) {
  switch (command) {
  case COMMAND_STOP:
    say("STOP");
    return;
  case COMMAND_OPTIONAL_STOP:
    say("OPSTOP");
    return;
  case COMMAND_STOP_SPINDLE:
    say("SPINDL/OFF");
    return;
  case COMMAND_COOLANT_OFF:
    say("COOLNT/OFF");
    return;
  case COMMAND_COOLANT_ON:
    writeCoolant(tool.coolant);
    return;
  case COMMAND_START_SPINDLE:
    writeSpindle(spindleSpeed, tool.clockwise);
    return;
  case COMMAND_SPINDLE_CLOCKWISE:
    writeSpindle(spindleSpeed, true);
    return;
  case COMMAND_SPINDLE_COUNTERCLOCKWISE:
    writeSpindle(spindleSpeed, false);
    return;
  case COMMAND_LOCK_MULTI_AXIS: // clamping is planned
  case COMMAND_UNLOCK_MULTI_AXIS:
    return;
  default:
    var id = getCommandStringId(command);
    insertOrRefuse(id.replace("COMMAND_", ""), "the command " + id.replace("COMMAND_", "").toLowerCase().replace(/_/g, " "));
  }
}
