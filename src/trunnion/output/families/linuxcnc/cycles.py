"""Hole-making cycles of LinuxCNC: G73, G74, G81 to G86 and G89 with G98 or G99, and G33.1 for rigid taps.

Facts: LinuxCNC's G code reference; docs/controls/linuxcnc.md has them one by one.
"""

from collections.abc import Callable
from typing import Final

from trunnion.controls.family import EACH_HOLE, FIRST_HOLE, Formats
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, CycleError, Making, Turning, UnsaidError

#: What a cycle says besides its heights: the G word, then its own words.
Words = tuple[int, list[str]]


def cycle_lines(cycle: Cycle, top: float, turning: Turning | None, formats: Formats) -> list[str]:
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
    CycleError
        When the cycle cannot be said.
    """
    assert cycle.retract is not None
    number = formats["coordinate"].text
    above, bottom, retract = (number(top + height) for height in (cycle.above, -cycle.depth, cycle.retract))
    if cycle.making is Making.TAP:
        tap = f"G33.1 Z{bottom} K{formats['pitch'].text(_pitch(cycle, turning))}"
        return [f"G0 {EACH_HOLE}", f"Z{above}", tap, *([f"G0 Z{retract}"] if retract != above else [])]
    say = _SAY.get(cycle.making)
    if say is None:
        what = f"CYCLE/{cycle.making}: no cycle of LinuxCNC leaves the hole as it asks for"
        raise CycleError(what, "output the holes as motion")
    code, words = say(cycle, turning, formats)
    plane = "G99" if retract == above else "G98"
    return [" ".join((plane, f"G{code}", FIRST_HOLE, f"Z{bottom}", f"R{above}", *words))]


def _turns(turning: Turning | None, what: str) -> Turning:
    if turning is None or not turning.rpm > 0.0:
        raise CycleError(f"{what} while the spindle stands still", "put SPINDL before the cycle")
    return turning


def _seconds(cycle: Cycle, turning: Turning | None) -> float:
    """The dwell; spindle turns become the time that they take."""
    if not cycle.dwell or not cycle.dwell_turns:
        return cycle.dwell
    return 60.0 * cycle.dwell / _turns(turning, "DWELL,REV").rpm


def _dwell(cycle: Cycle, turning: Turning | None, formats: Formats) -> list[str]:
    seconds = _seconds(cycle, turning)
    return [f"P{formats['dwell'].text(seconds)}"] if seconds else []


def _drill(cycle: Cycle, turning: Turning | None, formats: Formats) -> Words:
    wait = _dwell(cycle, turning, formats)
    return (82, wait) if wait else (81, [])


def _peck(cycle: Cycle, turning: Turning | None, formats: Formats) -> Words:
    """Equal strokes of Q, which count from R."""
    if any(cycle.steps[1:]):
        raise UnsaidError("strokes that become shorter, where Q is one stroke", "write STEP with one number")
    if cycle.dwell:
        raise UnsaidError("DWELL at the bottom of a hole in strokes: the control has none there", "leave DWELL out")
    return (83 if cycle.making is Making.DEEP else 73), [f"Q{formats['coordinate'].text(cycle.steps[0])}"]


def _pitch(cycle: Cycle, turning: Turning | None) -> float:
    """Of a rigid tap, mm. The thread has the hand of the spindle."""
    rpm = _turns(turning, "CYCLE/TAP").rpm
    if cycle.feed is None or not cycle.feed > 0.0:
        raise CycleError("CYCLE/TAP without a feed", "write MMPR,pitch")
    if cycle.dwell:
        raise CycleError("DWELL at the bottom of a thread: the control has none there", "leave DWELL out")
    return cycle.feed if cycle.per_rev else cycle.feed / rpm


def _tap_chuck(cycle: Cycle, turning: Turning | None, formats: Formats) -> Words:
    """The spindle turns back by itself: G84 wants it clockwise, G74 the other way. Without P they wait as a cycle did
    before."""
    right = _turns(turning, "CYCLE/TAP").sense is Sense.CLW
    return (84 if right else 74), _dwell(cycle, turning, formats) or ["P0"]


def _ream(cycle: Cycle, turning: Turning | None, formats: Formats) -> Words:
    """In and out at feed."""
    wait = _dwell(cycle, turning, formats)
    return (89, wait) if wait else (85, [])


def _drag(cycle: Cycle, turning: Turning | None, formats: Formats) -> Words:
    """The spindle stops at the bottom; G86 wants a P."""
    _turns(turning, "CYCLE/BORE,DRAG")
    return 86, _dwell(cycle, turning, formats) or ["P0"]


_SAY: Final[dict[Making, Callable[[Cycle, Turning | None, Formats], Words]]] = {
    Making.DRILL: _drill,
    Making.DEEP: _peck,
    Making.CHIPS: _peck,
    Making.TAP_CHUCK: _tap_chuck,
    Making.REAM: _ream,
    Making.DRAG: _drag,
}
