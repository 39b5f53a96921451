"""Hole-making cycles of a Sinumerik: CYCLE81 to CYCLE86, CYCLE840 and CYCLE88, modal by MCALL.

Facts: SINUMERIK cycles manual; docs/controls/sinumerik.md has the parameters one by one.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from trunnion.controls.words import NumberFormat
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState

#: Tool axis of CYCLE83 and CYCLE84: the third axis of the plane G17.
_THIRD_AXIS = "3"

#: mm; NaN is no less.
_MAX_LIFT = 100.0

#: How far a chip-breaking stroke is drawn back, mm.
_CHIP_BREAK = 1.0


@dataclass(frozen=True, slots=True)
class Heights:
    """Of one group of holes, as positions along Z of the frame, mm."""

    retract: float
    top: float
    above: float
    depth: float

    @staticmethod
    def of(cycle: Cycle, top: float) -> "Heights":
        """For holes whose points lie at ``top``."""
        assert cycle.retract_height is not None
        return Heights(top + cycle.retract_height, top, cycle.rapid_height, top - cycle.depth)


def cycle_statement(
    cycle: Cycle, top: float, turning: SpindleState | None, lift: float | None, formats: Mapping[str, NumberFormat]
) -> str:
    """The call of the cycle, as it stands after MCALL.

    Parameters
    ----------
    cycle
        With a retract height.
    top
        Z of the points of the holes, mm.
    turning
        The spindle.
    lift
        How far BORE,NODRAG lifts off along X after the spindle was oriented, mm; None: nobody said so.
    formats
        ``coordinate`` and ``dwell`` of the control.

    Raises
    ------
    HoleCycleError
        When the cycle cannot be said.
    """
    heights = Heights.of(cycle, top)
    number = formats["coordinate"].text
    first = [number(value) for value in (heights.retract, heights.top, heights.above, heights.depth)]
    name, arguments = _CYCLES[cycle.method](cycle, turning, _dwell(cycle, turning, formats), lift, number)
    return f"{name}({','.join([*first, *arguments])})"


def is_valid_lift(text: str) -> bool:
    """Whether the setting ``bore_lift`` is empty, or millimetres that a tool could lift off in a bore."""
    try:
        return not text or abs(float(text)) < _MAX_LIFT
    except ValueError:
        return False


def _dwell(cycle: Cycle, turning: SpindleState | None, formats: Mapping[str, NumberFormat]) -> str:
    """Seconds at the bottom, empty for none; spindle turns become the time that they take."""
    if not cycle.dwell:
        return ""
    if not cycle.dwell_in_revolutions:
        return formats["dwell"].text(cycle.dwell)
    if turning is None or not turning.rpm > 0.0:
        raise HoleCycleError("DWELL,REV while the spindle stands still", "put SPINDL before the cycle")
    return formats["dwell"].text(60.0 * cycle.dwell / turning.rpm)


Number = Callable[[float], str]
CycleArguments = tuple[str, list[str]]


def _drill(
    cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number
) -> CycleArguments:
    return ("CYCLE82", ["", dwell]) if dwell else ("CYCLE81", [])


def _peck(cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number) -> CycleArguments:
    """FDPR, DAM, no dwell on the way, feed factor 1, VARI, the tool axis, least stroke, chip break, dwell, DIS1 0."""
    stroke, less, least = cycle.strokes
    full = cycle.method is HoleMethod.DEEP_DRILLING
    return "CYCLE83", [
        "", "", number(min(stroke, cycle.depth)), number(less), "0", "0", "1", "1" if full else "0", _THIRD_AXIS,
        number(least), "0" if full else number(_CHIP_BREAK), dwell or "0", "0",
    ]  # fmt: skip


def _pitch(cycle: Cycle, turning: SpindleState | None) -> tuple[float, float, str]:
    """Pitch with the sign of the thread's hand, mm; spindle speed; code of its sense."""
    if turning is None or not turning.rpm > 0.0:
        raise HoleCycleError("CYCLE/TAP while the spindle stands still", "put SPINDL before the cycle")
    if cycle.feed is None or not cycle.feed > 0.0:
        raise HoleCycleError("CYCLE/TAP without a feed", "write MMPR,pitch")
    pitch = cycle.feed if cycle.per_rev else cycle.feed / turning.rpm
    right = turning.sense is Sense.CLW
    return pitch if right else -pitch, turning.rpm, "3" if right else "4"


def _tap(cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number) -> CycleArguments:
    """Sense after the cycle, no size, pitch, spindle position 0, speed in and out."""
    pitch, rpm, sense = _pitch(cycle, turning)
    return "CYCLE84", ["", dwell, sense, "", number(pitch), "0", f"{rpm:g}", f"{rpm:g}"]


def _tap_in_strokes(
    cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number
) -> CycleArguments:
    """As in one stroke; the tool axis, PIT in mm, technology as it is, VARI, DAM the stroke, VRT."""
    stroke, less, _ = cycle.strokes
    if less:
        what = "a thread in strokes that become shorter: the control has equal ones"
        raise HoleCycleError(what, "write STEP with one number")
    full = cycle.method is HoleMethod.DEEP_TAP
    name, arguments = _tap(cycle, turning, dwell, lift, number)
    back = "0" if full else number(_CHIP_BREAK)
    return name, [*arguments, _THIRD_AXIS, "1", "0", "2" if full else "1", number(min(stroke, cycle.depth)), back]


def _tap_chuck(
    cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number
) -> CycleArguments:
    """The spindle turns back by itself; sense after the cycle, with encoder, no size, pitch."""
    pitch, _, sense = _pitch(cycle, turning)
    return "CYCLE840", ["", dwell, "0", sense, "0", "", number(pitch)]


def _ream(cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number) -> CycleArguments:
    """In and out at the feed of the cycle."""
    if cycle.feed is None:
        raise HoleCycleError("CYCLE/BORE without a feed", "write MMPM,feed")
    return "CYCLE85", ["", dwell, number(cycle.feed), number(cycle.feed)]


def _oriented(
    cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number
) -> CycleArguments:
    """Spindle sense, lift-off in three axes, angle of the spindle."""
    sense = "4" if turning is not None and turning.sense is Sense.CCLW else "3"
    if cycle.method is HoleMethod.BORE_WITH_LIFT and not lift:
        what = "BORE,NODRAG does not say how far and to which side the tool lifts off"
        raise HoleCycleError(what, "--set bore_lift=MM says it, along X with the spindle at its angle")
    aside = lift if cycle.method is HoleMethod.BORE_WITH_LIFT and lift else 0.0
    return "CYCLE86", ["", dwell, sense, number(aside), "0", "0", number(cycle.spindle_angle)]


def _manual(
    cycle: Cycle, turning: SpindleState | None, dwell: str, lift: float | None, number: Number
) -> CycleArguments:
    sense = "4" if turning is not None and turning.sense is Sense.CCLW else "3"
    return "CYCLE88", ["", dwell or "0", sense]


_CYCLES: dict[HoleMethod, Callable[[Cycle, SpindleState | None, str, float | None, Number], CycleArguments]] = {
    HoleMethod.DRILL: _drill,
    HoleMethod.DEEP_DRILLING: _peck,
    HoleMethod.CHIP_BREAKING: _peck,
    HoleMethod.TAP: _tap,
    HoleMethod.FLOATING_TAP: _tap_chuck,
    HoleMethod.CHIP_BREAKING_TAP: _tap_in_strokes,
    HoleMethod.DEEP_TAP: _tap_in_strokes,
    HoleMethod.REAM: _ream,
    HoleMethod.BORE: _oriented,
    HoleMethod.BORE_WITH_LIFT: _oriented,
    HoleMethod.BORE_MANUAL: _manual,
}
