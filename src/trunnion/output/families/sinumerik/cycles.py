"""Drilling cycles of a Sinumerik: CYCLE81 to CYCLE86, CYCLE840 and CYCLE88.

Facts: SINUMERIK cycles manual; docs/controls/sinumerik.md lists the parameters.
"""

import math
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from trunnion.controls.words import NumberFormat
from trunnion.messages import Wording
from trunnion.model.toolpath import Sense
from trunnion.output.shared.spindle import cycle_dwell_seconds, thread
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError
from trunnion.planning.holes.pecks import peck_depths
from trunnion.records import dataclass

#: Tool axis of CYCLE83 and CYCLE84: the third axis of the plane G17.
_THIRD_AXIS: Final = "3"

#: _PITA: the unit of a pitch, whatever the program counts in.
_MM_PER_TURN: Final = "1"
_INCHES_PER_TURN: Final = "3"

#: Least lift-off in a bore, mm: the cycle must not print it as 0. And the greatest.
_MIN_LIFT: Final = 0.001
_MAX_LIFT: Final = 100.0

#: How far a chip-breaking peck is retracted, mm.
_CHIP_BREAK: Final = 1.0

#: How many parameters a cycle of an 840D sl has before _GMODE, and its _AMODE.
_LONG_FORMS: Final = {
    "CYCLE81": (6, "2"),
    "CYCLE82": (6, "12"),
    "CYCLE83": (17, "111112"),
    "CYCLE84": (21, "0"),
    "CYCLE840": (17, "0"),
    "CYCLE85": (8, "12"),
    "CYCLE86": (11, "12"),
    "CYCLE88": (7, "0"),
}

#: The name of a cycle, and its arguments behind the heights.
CycleArguments = tuple[str, list[str]]


@dataclass(frozen=True, slots=True, eq=False)
class _Input:
    """What the arguments of a cycle are made from.

    cycle    with a retract height
    spindle  None while it is stopped
    dwell    seconds at the bottom as printed; empty for none
    lift     lift-off for BORE,NODRAG, mm; None if it is not set
    number   prints a length
    angle    prints an angle
    pitch    prints a pitch
    inches   the program counts in inches
    feed     prints the feed of the cycle
    """

    cycle: Cycle
    spindle: SpindleState | None
    dwell: str
    lift: float | None
    number: Callable[[float], str]
    angle: Callable[[float], str]
    pitch: Callable[[float], str]
    inches: bool
    feed: Callable[[float], str]


def cycle_statement(
    cycle: Cycle,
    top: float,
    spindle: SpindleState | None,
    lift: float | None,
    formats: Mapping[str, NumberFormat],
    *,
    is_long: bool = False,
) -> str:
    """Return the call of a cycle, as it follows MCALL.

    cycle    with a retract height
    top      Z of the hole points, mm
    spindle  None while it is stopped
    lift     how far BORE,NODRAG lifts off along X after the spindle was oriented, mm; None if it is not set
    is_long  with _GMODE, _DMODE and _AMODE behind all other parameters
    formats  ``coordinate``, ``angle``, ``pitch``, ``feed``, ``feed_per_rev`` and ``dwell`` of the control

    Raises ``HoleCycleError`` if the control cannot make the cycle.
    """
    assert cycle.retract_height is not None
    number = formats["coordinate"].text
    heights = [number(z) for z in (top + cycle.retract_height, top)]
    heights += [number(cycle.rapid_height), number(top - cycle.depth)]
    dwell = formats["dwell"].text(cycle_dwell_seconds(cycle, spindle)) if cycle.dwell else ""
    feed = formats["feed_per_rev" if cycle.per_rev else "feed"].text
    angle, pitch = formats["angle"].text, formats["pitch"]
    inputs = _Input(cycle, spindle, dwell, lift, number, angle, pitch.text, pitch.unit != 1.0, feed)
    name, arguments = _CYCLES[cycle.method](inputs)
    return f"{name}({','.join(_long_form(name, [*heights, *arguments]) if is_long else [*heights, *arguments])})"


def _long_form(name: str, arguments: list[str]) -> list[str]:
    """Return the arguments with empty places up to _GMODE 0 (depth of the tip), _DMODE 1 (G17), and _AMODE.

    Digits of _AMODE that are settled say what is written: an absolute depth, dwells in seconds, a first peck from the
    reference plane, a degression as a length. Where they are not, 0 has the parameters count as in the classic form.
    """
    count, alternatives = _LONG_FORMS[name]
    return [*arguments, *[""] * (count - len(arguments)), "0", "1", alternatives]


def is_valid_lift(text: str) -> bool:
    """Return whether the setting ``bore_lift`` is empty, or a length by which a tool can lift off in a bore, mm."""
    try:
        return not text or _MIN_LIFT <= abs(float(text)) < _MAX_LIFT
    except ValueError:
        return False


def _drill(of: _Input) -> CycleArguments:
    return ("CYCLE82", ["", of.dwell]) if of.dwell else ("CYCLE81", [])


def _peck(of: _Input) -> CycleArguments:
    """FDPR, DAM, no dwell at the top, feed factor 1, VARI, tool axis, least peck, chip break, dwell, DIS1 0."""
    peck, decrement, least = of.cycle.pecks
    full = of.cycle.method is HoleMethod.DEEP_DRILLING
    degression = of.number(decrement)
    if decrement > least >= peck - decrement:  # no peck falls below an amount; a factor goes to the least at once
        degression = of.number(-math.floor(1000.0 * least / peck) / 1000.0)
    elif any(each < decrement - 1e-9 for each in np.diff(peck_depths(of.cycle), prepend=0.0)[:-1].tolist()):
        raise UnsupportedCycleError(Wording("CTL350", "decreasing_peck_depths_dam"))
    return "CYCLE83", [
        "", "", of.number(min(peck, of.cycle.depth)), degression, "0", "0", "1", "1" if full else "0",
        _THIRD_AXIS, of.number(least), "0" if full else of.number(_CHIP_BREAK), of.dwell or "0", "0",
    ]  # fmt: skip


def _signed_pitch(of: _Input) -> tuple[float, SpindleState]:
    """Pitch with the sign of the thread's hand, mm; and the spindle."""
    pitch, spindle = thread(of.cycle, of.spindle)
    return pitch if spindle.sense is Sense.CLW else -pitch, spindle


def _sense_code(spindle: SpindleState | None) -> str:
    return "4" if spindle is not None and spindle.sense is Sense.CCLW else "3"


def _tap(of: _Input) -> CycleArguments:
    """Sense after the cycle, no size, pitch, spindle position 0, speeds; in inches tool axis and unit of PIT."""
    pitch, spindle = _signed_pitch(of)
    speed = f"{spindle.rpm:g}"
    unit = [_THIRD_AXIS, _INCHES_PER_TURN] if of.inches else []
    return "CYCLE84", ["", of.dwell, _sense_code(spindle), "", of.pitch(pitch), "0", speed, speed, *unit]


def _tap_in_pecks(of: _Input) -> CycleArguments:
    """As a tap in one pass; then tool axis, unit of PIT, technology unchanged, VARI, the peck DAM, VRT."""
    peck, decrement, _ = of.cycle.pecks
    if decrement:
        raise HoleCycleError(Wording("CTL350", "decreasing_peck_depths_thread"))
    full = of.cycle.method is HoleMethod.DEEP_TAP
    name, arguments = _tap(of)
    pecks = ["2" if full else "1", of.number(min(peck, of.cycle.depth)), "0" if full else of.number(_CHIP_BREAK)]
    unit = [] if of.inches else [_THIRD_AXIS, _MM_PER_TURN]
    return name, [*arguments, *unit, "0", *pecks]


def _floating_tap(of: _Input) -> CycleArguments:
    """Return the spindle reverses by itself; sense after the cycle, with encoder, no size, pitch."""
    pitch, spindle = _signed_pitch(of)
    unit = [_THIRD_AXIS, _INCHES_PER_TURN] if of.inches else []
    return "CYCLE840", ["", of.dwell, "0", _sense_code(spindle), "0", "", of.pitch(pitch), *unit]


def _ream(of: _Input) -> CycleArguments:
    """In and out at the feed of the cycle."""
    if of.cycle.feed is None:
        raise HoleCycleError(Wording("PLN610", "cycle_bore_without"))
    return "CYCLE85", ["", of.dwell, of.feed(of.cycle.feed), of.feed(of.cycle.feed)]


def _bore(of: _Input) -> CycleArguments:
    """Spindle sense, lift-off in three axes, angle of the spindle."""
    lifts = of.cycle.method is HoleMethod.BORE_WITH_LIFT
    if lifts and not of.lift:
        raise HoleCycleError(Wording("CTL360", "bore_nodrag_does_not_say"))
    lift = of.number(of.lift if lifts and of.lift else 0.0)
    return "CYCLE86", ["", of.dwell, _sense_code(of.spindle), lift, "0", "0", of.angle(of.cycle.spindle_angle)]


def _manual(of: _Input) -> CycleArguments:
    return "CYCLE88", ["", of.dwell or "0", _sense_code(of.spindle)]


_CYCLES: Final[dict[HoleMethod, Callable[[_Input], CycleArguments]]] = {
    HoleMethod.DRILL: _drill,
    HoleMethod.DEEP_DRILLING: _peck,
    HoleMethod.CHIP_BREAKING: _peck,
    HoleMethod.TAP: _tap,
    HoleMethod.FLOATING_TAP: _floating_tap,
    HoleMethod.CHIP_BREAKING_TAP: _tap_in_pecks,
    HoleMethod.DEEP_TAP: _tap_in_pecks,
    HoleMethod.REAM: _ream,
    HoleMethod.BORE: _bore,
    HoleMethod.BORE_WITH_LIFT: _bore,
    HoleMethod.BORE_MANUAL: _manual,
}
