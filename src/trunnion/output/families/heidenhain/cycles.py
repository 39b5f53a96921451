"""Hole-making cycles of iTNC 530 and TNC 640: the definition with its Q parameters; ``M99`` calls it hole by hole.

Facts: the cycles manuals of both controls; docs/controls/heidenhain.md has the parameters one by one.
"""

import math
from collections.abc import Callable, Mapping
from typing import Final

from trunnion.controls.words import NumberFormat
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState

Formats = Mapping[str, NumberFormat]

#: Number of a parameter -> value, in the order in which the cycle has them; ``RAPID`` is a feed.
QParameters = dict[int, float]
RAPID: Final = math.inf

#: How far a chip-breaking stroke is drawn back, and how far above the last depth a rapid into the hole ends, mm.
_CHIP_BREAK: Final = 0.2

#: The same of a thread, in pitches.
_CHIP_BREAK_PITCHES: Final = 1.0

_ADVANCED_STOP: Final = 0.2

#: Number and name of a cycle, and its parameters from the set-up clearance on.
CycleDefinition = tuple[int, str, QParameters]

_PARAMETER_NAMES: Final = {
    200: "SET-UP CLEARANCE",
    201: "DEPTH",
    202: "PLUNGING DEPTH",
    203: "SURFACE COORDINATE",
    204: "2ND SET-UP CLEARANCE",
    205: "MIN. PLUNGING DEPTH",
    206: "FEED RATE FOR PLNGNG",
    208: "RETRACTION FEED RATE",
    210: "DWELL TIME AT TOP",
    211: "DWELL TIME AT DEPTH",
    212: "DECREMENT",
    213: "NR OF BREAKS",
    214: "DISENGAGING DIRECTN",
    239: "THREAD PITCH",
    253: "F PRE-POSITIONING",
    256: "DIST FOR CHIP BRKNG",
    257: "DEPTH FOR CHIP BRKNG",
    258: "UPPER ADV STOP DIST",
    259: "LOWER ADV STOP DIST",
    336: "ANGLE OF SPINDLE",
    379: "STARTING POINT",
    403: "RPM FACTOR",
}

_PARAMETER_FORMATS: Final = {206: "feed", 208: "feed", 253: "feed", 210: "dwell", 211: "dwell", 336: "angle"}

#: Most chip breaks that Q213 counts.
_MOST_BREAKS: Final = 99999


def cycle_definition(
    cycle: Cycle, top: float, turning: SpindleState | None, formats: Formats, side: str = ""
) -> list[str]:
    """The lines of one ``CYCL DEF``, all but the last of which go on in the next.

    Parameters
    ----------
    cycle
        With a retract height and a feed.
    top
        Z of the points of the holes, mm.
    turning
        The spindle.
    formats
        ``coordinate``, ``feed``, ``dwell`` and ``angle`` of the control.
    side
        To which side a tool is moved off the wall of a bore, as Q214 counts them; empty: nobody said so.

    Raises
    ------
    HoleCycleError
        When the cycle cannot be said.
    """
    say = _DEFINITIONS.get(cycle.method)
    if say is None:
        what = f"CYCLE/{cycle.method}: no cycle of the control leaves the hole as it asks for"
        raise HoleCycleError(what, "output the holes as motion")
    number, name, values = say(cycle, top, turning)
    if cycle.method is HoleMethod.BORE_WITH_LIFT:
        if not side:
            what = "BORE,NODRAG does not say to which side the tool moves off the wall"
            raise HoleCycleError(what, "--set disengage=1 is -X, 2 -Y, 3 +X, 4 +Y, with the spindle at its angle")
        values = {**values, 214: float(side), 336: cycle.spindle_angle}
    lines = [f"CYCL DEF {number} {name}"]
    for q, value in values.items():
        form = formats[_PARAMETER_FORMATS.get(q, "coordinate")]
        if value == RAPID:
            lines.append(f"  Q{q}=MAX ;{_PARAMETER_NAMES[q]}")
            continue
        if value and not form.least <= value <= form.greatest:
            raise HoleCycleError(
                f"CYCLE with Q{q}={value:g} ({_PARAMETER_NAMES[q].lower()})", f"up to {form.greatest:g} can be said"
            )
        text = form.text(value)
        lines.append(f"  Q{q}={text if text[0] in '+-' else '+' + text} ;{_PARAMETER_NAMES[q]}")
    return [f"{line} ~" for line in lines[:-1]] + lines[-1:]


def _heights(cycle: Cycle, top: float) -> tuple[QParameters, QParameters]:
    """Q200 and Q201, and Q203 and Q204, which all cycles have.

    Clearances count from the surface, depths are negative.
    """
    assert cycle.retract_height is not None
    return {200: cycle.rapid_height, 201: -cycle.depth}, {203: top, 204: cycle.retract_height}


def _spindle_speed(turning: SpindleState | None, what: str) -> float:
    if turning is None or not turning.rpm > 0.0:
        raise HoleCycleError(f"{what} while the spindle stands still", "put SPINDL before the cycle")
    return turning.rpm


def _dwell(cycle: Cycle, turning: SpindleState | None) -> QParameters:
    """Seconds at the bottom; spindle turns become the time that they take."""
    if not cycle.dwell or not cycle.dwell_in_revolutions:
        return {211: cycle.dwell}
    return {211: 60.0 * cycle.dwell / _spindle_speed(turning, "DWELL,REV")}


def _feed(cycle: Cycle, turning: SpindleState | None) -> float:
    """mm/min: the cycles have no other feeds."""
    if cycle.feed is None:
        return 0.0
    return cycle.feed * _spindle_speed(turning, "a feed per revolution") if cycle.per_rev else cycle.feed


def _drill(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    low, high = _heights(cycle, top)
    values = {206: _feed(cycle, turning), 202: cycle.depth, 210: 0.0}
    return 200, "DRILLING", {**low, **values, **high, **_dwell(cycle, turning)}


def _peck(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    """All the way out after each stroke; or one stroke in which chips are broken, always after the same depth."""
    stroke, less, least = cycle.strokes
    full = cycle.method is HoleMethod.DEEP_DRILLING
    if less and not least > 0.0:
        raise HoleCycleError("STEP without a shortest stroke", "write STEP,first,less,shortest")
    if less and not full:
        return _peck_with_shrinking_strokes(cycle, top, turning)
    low, high = _heights(cycle, top)
    stroke = min(stroke, cycle.depth)
    values = {206: _feed(cycle, turning), 202: stroke if full else cycle.depth, **high}
    values |= {212: less, 205: (min(least, stroke) if less else stroke) if full else 0.0}
    values |= {
        258: _ADVANCED_STOP,
        259: _ADVANCED_STOP,
        257: 0.0 if full else stroke,
        256: 0.0 if full else _CHIP_BREAK,
    }
    return 205, "UNIVERSAL PECKING", {**low, **values, **_dwell(cycle, turning), 379: 0.0, 253: _feed(cycle, turning)}


def _peck_with_shrinking_strokes(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    """Strokes that become shorter, with as many chip breaks as there can be before a full retract."""
    stroke, less, least = cycle.strokes
    low, high = _heights(cycle, top)
    stroke = min(stroke, cycle.depth)
    values = {206: _feed(cycle, turning), 202: stroke, 210: 0.0, **high, 212: less, 213: _MOST_BREAKS}
    values |= {205: min(least, stroke), **_dwell(cycle, turning), 208: RAPID, 256: _CHIP_BREAK}
    return 203, "UNIVERSAL DRILLING", {**low, **values}


def _tap(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    """Without a floating holder: the pitch has the sign of the thread's hand."""
    if cycle.dwell:
        raise HoleCycleError("DWELL at the bottom of a thread: the control has none there", "leave DWELL out")
    rpm = _spindle_speed(turning, "CYCLE/TAP")
    assert turning is not None
    low, high = _heights(cycle, top)
    pitch = _feed(cycle, turning) / rpm
    return 207, "RIGID TAPPING NEW", {**low, 239: pitch if turning.sense is Sense.CLW else -pitch, **high}


def _tap_chuck(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    _spindle_speed(turning, "CYCLE/TAP")
    low, high = _heights(cycle, top)
    return 206, "TAPPING NEW", {**low, 206: _feed(cycle, turning), **_dwell(cycle, turning), **high}


def _tap_in_strokes(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    """As a rigid tap, in strokes: all the way out between them, or back by so many pitches."""
    if any(cycle.strokes[1:]):
        raise HoleCycleError(
            "a thread in strokes that become shorter: the control has equal ones", "write STEP with one number"
        )
    _, _, values = _tap(cycle, top, turning)
    back = 0.0 if cycle.method is HoleMethod.DEEP_TAP else _CHIP_BREAK_PITCHES
    strokes = {257: min(cycle.strokes[0], cycle.depth), 256: back, 336: 0.0, 403: 1.0}
    return 209, "TAPPING W/ CHIP BRKG", {**values, **strokes}


def _bore(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    """The spindle stops at an angle at the bottom, and the tool comes out at rapid."""
    low, high = _heights(cycle, top)
    feeds = {206: _feed(cycle, turning), **_dwell(cycle, turning), 208: RAPID}
    return 202, "BORING", {**low, **feeds, **high, 214: 0.0, 336: 0.0}


def _ream(cycle: Cycle, top: float, turning: SpindleState | None) -> CycleDefinition:
    """In and out at the feed of the cycle."""
    low, high = _heights(cycle, top)
    feed = _feed(cycle, turning)
    return 201, "REAMING", {**low, 206: feed, **_dwell(cycle, turning), 208: feed, **high}


_DEFINITIONS: Final[dict[HoleMethod, Callable[[Cycle, float, SpindleState | None], CycleDefinition]]] = {
    HoleMethod.DRILL: _drill,
    HoleMethod.DEEP_DRILLING: _peck,
    HoleMethod.CHIP_BREAKING: _peck,
    HoleMethod.TAP: _tap,
    HoleMethod.FLOATING_TAP: _tap_chuck,
    HoleMethod.DEEP_TAP: _tap_in_strokes,
    HoleMethod.CHIP_BREAKING_TAP: _tap_in_strokes,
    HoleMethod.BORE: _bore,
    HoleMethod.BORE_WITH_LIFT: _bore,
    HoleMethod.REAM: _ream,
}
