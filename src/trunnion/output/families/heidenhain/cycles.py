"""Drilling cycles of iTNC 530 and TNC 640: CYCL DEF with its Q parameters; M99 calls the cycle hole by hole.

Facts: the cycles manuals of both controls; docs/controls/heidenhain.md lists the parameters.
"""

import math
from collections.abc import Callable, Mapping
from typing import Final

from trunnion.controls.words import NumberFormat
from trunnion.messages import Wording
from trunnion.model.toolpath import Sense
from trunnion.output.shared.spindle import cycle_dwell_seconds, running_spindle, thread
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState

Formats = Mapping[str, NumberFormat]

#: Number of a Q parameter -> value, in the order of the cycle; ``RAPID`` is a feed.
QParameters = dict[int, float]
RAPID: Final = math.inf

#: How far a chip-breaking peck is retracted, mm.
_CHIP_BREAK: Final = 0.2

#: How far a chip-breaking peck of a thread is retracted, pitches.
_CHIP_BREAK_PITCHES: Final = 1.0

#: How far above the last depth a rapid into the hole ends, mm.
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

#: Formats of parameters that are no lengths; counts, directions and factors print like angles.
_PARAMETER_FORMATS: Final = {
    **dict.fromkeys((206, 208, 253), "feed"),
    **dict.fromkeys((210, 211), "dwell"),
    **dict.fromkeys((213, 214, 336, 403), "angle"),
}

#: Greatest value of Q213.
_MOST_BREAKS: Final = 99999


def cycle_definition(
    cycle: Cycle, top: float, spindle: SpindleState | None, formats: Formats, side: str = ""
) -> list[str]:
    """Return the lines of a CYCL DEF; each but the last ends with the continuation sign.

    cycle    with a retract height and a feed
    top      Z of the hole points, mm
    spindle  None while it is stopped
    formats  ``coordinate``, ``feed``, ``dwell`` and ``angle`` of the control
    side     the side to which the tool moves off the wall of a bore, as Q214 numbers them; empty if it is not set

    Raises ``HoleCycleError`` if the control cannot make the cycle.
    """
    define = _DEFINITIONS.get(cycle.method)
    if define is None:
        raise HoleCycleError(Wording("CTL350", "cycle_no_cycle", method=cycle.method))
    number, name, values = define(cycle, top, spindle)
    if cycle.method is HoleMethod.BORE_WITH_LIFT:
        if not side:
            raise HoleCycleError(Wording("CTL360", "bore_nodrag_does_not"))
        values = {**values, 214: float(side), 336: cycle.spindle_angle}
    lines = [f"CYCL DEF {number} {name}", *(_parameter_line(q, value, formats) for q, value in values.items())]
    return [f"{line} ~" for line in lines[:-1]] + lines[-1:]


def _parameter_line(q: int, value: float, formats: Formats) -> str:
    number_format, name = formats[_PARAMETER_FORMATS.get(q, "coordinate")], _PARAMETER_NAMES[q]
    if value == RAPID:
        return f"  Q{q}=MAX ;{name}"
    if value and not number_format.least <= value <= number_format.greatest:
        raise HoleCycleError(
            Wording(
                "CTL110",
                "cycle_q",
                q=q,
                value=value,
                name=name.lower(),
                least=number_format.least,
                greatest=number_format.greatest,
            )
        )
    text = number_format.text(value)
    return f"  Q{q}={text if text[0] in '+-' else '+' + text} ;{name}"


def _heights(cycle: Cycle, top: float) -> tuple[QParameters, QParameters]:
    """Q200 and Q201, then Q203 and Q204, which all cycles have; depths are negative."""
    assert cycle.retract_height is not None
    return {200: cycle.rapid_height, 201: -cycle.depth}, {203: top, 204: cycle.retract_height}


def _dwell(cycle: Cycle, spindle: SpindleState | None) -> QParameters:
    return {211: cycle_dwell_seconds(cycle, spindle)}


def _feed(cycle: Cycle, spindle: SpindleState | None) -> float:
    """mm/min, as all cycles have it."""
    if cycle.feed is None:
        return 0.0
    return cycle.feed * running_spindle(spindle, "a feed per revolution").rpm if cycle.per_rev else cycle.feed


def _drill(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    low, high = _heights(cycle, top)
    values = {206: _feed(cycle, spindle), 202: cycle.depth, 210: 0.0}
    return 200, "DRILLING", {**low, **values, **high, **_dwell(cycle, spindle)}


def _peck(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    """Full retract after each peck; or one peck with chip breaks at equal distances."""
    peck, decrement, least = cycle.pecks
    full = cycle.method is HoleMethod.DEEP_DRILLING
    if decrement and not least > 0.0:
        raise HoleCycleError(Wording("PLN610", "step_without_shortest"))
    if decrement and not full:
        return _peck_with_decreasing_depths(cycle, top, spindle)
    low, high = _heights(cycle, top)
    peck = min(peck, cycle.depth)
    values = {206: _feed(cycle, spindle), 202: peck if full else cycle.depth, **high}
    values |= {212: decrement, 205: (min(least, peck) if decrement else peck) if full else 0.0}
    values |= {
        258: _ADVANCED_STOP,
        259: _ADVANCED_STOP,
        257: 0.0 if full else peck,
        256: 0.0 if full else _CHIP_BREAK,
    }
    return 205, "UNIVERSAL PECKING", {**low, **values, **_dwell(cycle, spindle), 379: 0.0, 253: _feed(cycle, spindle)}


def _peck_with_decreasing_depths(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    """Decreasing pecks, with as many chip breaks as possible before a full retract."""
    peck, decrement, least = cycle.pecks
    low, high = _heights(cycle, top)
    peck = min(peck, cycle.depth)
    values = {206: _feed(cycle, spindle), 202: peck, 210: 0.0, **high, 212: decrement, 213: _MOST_BREAKS}
    values |= {205: min(least, peck), **_dwell(cycle, spindle), 208: RAPID, 256: _CHIP_BREAK}
    return 203, "UNIVERSAL DRILLING", {**low, **values}


def _tap(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    """Without a floating holder: the pitch has the sign of the thread's hand."""
    if cycle.dwell:
        raise HoleCycleError(Wording("CTL350", "dwell_bottom_thread"))
    pitch, running = thread(cycle, spindle)
    low, high = _heights(cycle, top)
    return 207, "RIGID TAPPING NEW", {**low, 239: pitch if running.sense is Sense.CLW else -pitch, **high}


def _floating_tap(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    thread(cycle, spindle)
    low, high = _heights(cycle, top)
    return 206, "TAPPING NEW", {**low, 206: _feed(cycle, spindle), **_dwell(cycle, spindle), **high}


def _tap_in_pecks(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    """Return a rigid tap in pecks, with full retracts or chip breaks between them."""
    if any(cycle.pecks[1:]):
        raise HoleCycleError(Wording("CTL350", "decreasing_peck_depths_thread"))
    _, _, values = _tap(cycle, top, spindle)
    back = 0.0 if cycle.method is HoleMethod.DEEP_TAP else _CHIP_BREAK_PITCHES
    pecks = {257: min(cycle.pecks[0], cycle.depth), 256: back, 336: 0.0, 403: 1.0}
    return 209, "TAPPING W/ CHIP BRKG", {**values, **pecks}


def _bore(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    """Return the spindle stops at an angle at the bottom, and the tool retracts at rapid."""
    low, high = _heights(cycle, top)
    feeds = {206: _feed(cycle, spindle), **_dwell(cycle, spindle), 208: RAPID}
    return 202, "BORING", {**low, **feeds, **high, 214: 0.0, 336: 0.0}


def _ream(cycle: Cycle, top: float, spindle: SpindleState | None) -> CycleDefinition:
    """In and out at the feed of the cycle."""
    low, high = _heights(cycle, top)
    feed = _feed(cycle, spindle)
    return 201, "REAMING", {**low, 206: feed, **_dwell(cycle, spindle), 208: feed, **high}


_DEFINITIONS: Final[dict[HoleMethod, Callable[[Cycle, float, SpindleState | None], CycleDefinition]]] = {
    HoleMethod.DRILL: _drill,
    HoleMethod.DEEP_DRILLING: _peck,
    HoleMethod.CHIP_BREAKING: _peck,
    HoleMethod.TAP: _tap,
    HoleMethod.FLOATING_TAP: _floating_tap,
    HoleMethod.DEEP_TAP: _tap_in_pecks,
    HoleMethod.CHIP_BREAKING_TAP: _tap_in_pecks,
    HoleMethod.BORE: _bore,
    HoleMethod.BORE_WITH_LIFT: _bore,
    HoleMethod.REAM: _ream,
}
