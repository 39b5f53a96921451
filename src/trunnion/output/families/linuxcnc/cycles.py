"""Hole-making cycles of LinuxCNC: G73, G74, G81 to G86 and G89 with G98 or G99, and G33.1 for rigid taps.

Facts: LinuxCNC's G code reference; docs/controls/linuxcnc.md has them one by one.
"""

from collections.abc import Callable
from typing import Final

from trunnion.controls.family_writer import EACH_HOLE, FIRST_HOLE, Formats
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError

#: What a cycle says besides its heights: the G word, then its own words.
GCodeAndWords = tuple[int, list[str]]


def cycle_lines(cycle: Cycle, top: float, turning: SpindleState | None, formats: Formats) -> list[str]:
    """The lines that make holes at ``top``.

    R is where the feed begins. G99 draws back to R; G98 to where the tool stood when the cycle began.

    Parameters
    ----------
    cycle
        With a retract height.
    top
        Z of the points of the holes, mm.
    turning
        The spindle.
    formats
        ``coordinate``, ``dwell`` and ``pitch`` of the control.

    Raises
    ------
    HoleCycleError
        When the cycle cannot be said.
    """
    assert cycle.retract_height is not None
    number = formats["coordinate"].text
    above, bottom, retract = (
        number(top + height) for height in (cycle.rapid_height, -cycle.depth, cycle.retract_height)
    )
    if cycle.method is HoleMethod.TAP:
        tap = f"G33.1 Z{bottom} K{formats['pitch'].text(_pitch(cycle, turning))}"
        return [f"G0 {EACH_HOLE}", f"Z{above}", tap, *([f"G0 Z{retract}"] if retract != above else [])]
    say = _CYCLES.get(cycle.method)
    if say is None:
        what = f"CYCLE/{cycle.method}: no cycle of LinuxCNC leaves the hole as it asks for"
        raise HoleCycleError(what, "output the holes as motion")
    code, words = say(cycle, turning, formats)
    plane = "G99" if retract == above else "G98"
    return [" ".join((plane, f"G{code}", FIRST_HOLE, f"Z{bottom}", f"R{above}", *words))]


def _running_spindle(turning: SpindleState | None, what: str) -> SpindleState:
    if turning is None or not turning.rpm > 0.0:
        raise HoleCycleError(f"{what} while the spindle stands still", "put SPINDL before the cycle")
    return turning


def _dwell_seconds(cycle: Cycle, turning: SpindleState | None) -> float:
    """The dwell; spindle turns become the time that they take."""
    if not cycle.dwell or not cycle.dwell_in_revolutions:
        return cycle.dwell
    return 60.0 * cycle.dwell / _running_spindle(turning, "DWELL,REV").rpm


def _dwell(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> list[str]:
    seconds = _dwell_seconds(cycle, turning)
    return [f"P{formats['dwell'].text(seconds)}"] if seconds else []


def _drill(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> GCodeAndWords:
    wait = _dwell(cycle, turning, formats)
    return (82, wait) if wait else (81, [])


def _peck(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """Equal strokes of Q, which count from R."""
    if any(cycle.strokes[1:]):
        raise UnsupportedCycleError("strokes that become shorter, where Q is one stroke", "write STEP with one number")
    if cycle.dwell:
        raise UnsupportedCycleError(
            "DWELL at the bottom of a hole in strokes: the control has none there", "leave DWELL out"
        )
    return (83 if cycle.method is HoleMethod.DEEP_DRILLING else 73), [
        f"Q{formats['coordinate'].text(cycle.strokes[0])}"
    ]


def _pitch(cycle: Cycle, turning: SpindleState | None) -> float:
    """Of a rigid tap, mm. The thread has the hand of the spindle."""
    rpm = _running_spindle(turning, "CYCLE/TAP").rpm
    if cycle.feed is None or not cycle.feed > 0.0:
        raise HoleCycleError("CYCLE/TAP without a feed", "write MMPR,pitch")
    if cycle.dwell:
        raise HoleCycleError("DWELL at the bottom of a thread: the control has none there", "leave DWELL out")
    return cycle.feed if cycle.per_rev else cycle.feed / rpm


def _tap_chuck(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """The spindle turns back by itself: G84 wants it clockwise, G74 the other way. Without P they wait as a cycle did
    before."""
    right = _running_spindle(turning, "CYCLE/TAP").sense is Sense.CLW
    return (84 if right else 74), _dwell(cycle, turning, formats) or ["P0"]


def _ream(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """In and out at feed."""
    wait = _dwell(cycle, turning, formats)
    return (89, wait) if wait else (85, [])


def _drag(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """The spindle stops at the bottom; G86 wants a P."""
    _running_spindle(turning, "CYCLE/BORE,DRAG")
    return 86, _dwell(cycle, turning, formats) or ["P0"]


_CYCLES: Final[dict[HoleMethod, Callable[[Cycle, SpindleState | None, Formats], GCodeAndWords]]] = {
    HoleMethod.DRILL: _drill,
    HoleMethod.DEEP_DRILLING: _peck,
    HoleMethod.CHIP_BREAKING: _peck,
    HoleMethod.FLOATING_TAP: _tap_chuck,
    HoleMethod.REAM: _ream,
    HoleMethod.BORE: _drag,
}
