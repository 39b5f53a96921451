"""Drilling cycles of LinuxCNC: G73, G74, G81 to G86 and G89 with G98 or G99, and G33.1 for rigid taps.

Facts: LinuxCNC's G code reference; docs/controls/linuxcnc.md lists them.
"""

from collections.abc import Callable
from typing import Final

from trunnion.controls.family_writer import EACH_HOLE, FIRST_HOLE, Formats
from trunnion.messages import Wording
from trunnion.model.toolpath import Sense
from trunnion.output.shared.spindle import cycle_dwell_seconds, running_spindle, thread
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError

#: The G word of a cycle, and its words behind the heights.
GCodeAndWords = tuple[int, list[str]]


def cycle_lines(cycle: Cycle, top: float, spindle: SpindleState | None, formats: Formats) -> list[str]:
    """Return the lines that make holes at ``top``.

    R is where the feed begins. G99 retracts to R; G98 to where the tool was when the cycle began.

    cycle    with a retract height
    top      Z of the hole points, mm
    spindle  None while it is stopped
    formats  ``coordinate``, ``dwell`` and ``pitch`` of the control

    Raises ``HoleCycleError`` if the control cannot make the cycle.
    """
    assert cycle.retract_height is not None
    number = formats["coordinate"].text
    rapid, bottom, retract = (
        number(top + height) for height in (cycle.rapid_height, -cycle.depth, cycle.retract_height)
    )
    if cycle.method is HoleMethod.TAP:
        tap = f"G33.1 Z{bottom} K{formats['pitch'].text(_rigid_pitch(cycle, spindle))}"
        return [f"G0 {EACH_HOLE}", f"Z{rapid}", tap, *([f"G0 Z{retract}"] if retract != rapid else [])]
    make = _CYCLES.get(cycle.method)
    if make is None:
        raise HoleCycleError(Wording("CTL350", "cycle_no_cycle_linuxcnc", method=cycle.method))
    code, words = make(cycle, spindle, formats)
    plane = "G99" if retract == rapid else "G98"
    return [" ".join((plane, f"G{code}", FIRST_HOLE, f"Z{bottom}", f"R{rapid}", *words))]


def _dwell(cycle: Cycle, spindle: SpindleState | None, formats: Formats) -> list[str]:
    seconds = cycle_dwell_seconds(cycle, spindle)
    return [f"P{formats['dwell'].text(seconds)}"] if seconds else []


def _drill(cycle: Cycle, spindle: SpindleState | None, formats: Formats) -> GCodeAndWords:
    dwell = _dwell(cycle, spindle, formats)
    return (82, dwell) if dwell else (81, [])


def _peck(cycle: Cycle, spindle: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """Equal pecks of Q, the first measured from R."""
    if any(cycle.pecks[1:]):
        raise UnsupportedCycleError(Wording("CTL350", "decreasing_peck_depths"))
    if cycle.dwell:
        raise UnsupportedCycleError(Wording("CTL350", "dwell_bottom_pecked"))
    return (83 if cycle.method is HoleMethod.DEEP_DRILLING else 73), [f"Q{formats['coordinate'].text(cycle.pecks[0])}"]


def _rigid_pitch(cycle: Cycle, spindle: SpindleState | None) -> float:
    """K of G33.1, mm: the thread has the hand of the spindle."""
    pitch, _ = thread(cycle, spindle)
    if cycle.dwell:
        raise HoleCycleError(Wording("CTL350", "dwell_bottom_thread"))
    return pitch


def _floating_tap(cycle: Cycle, spindle: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """Return the spindle reverses by itself: G84 expects it clockwise, G74 the other way.

    Without P the cycle would dwell as long as the one before.
    """
    right = running_spindle(spindle, "CYCLE/TAP").sense is Sense.CLW
    return (84 if right else 74), _dwell(cycle, spindle, formats) or ["P0"]


def _ream(cycle: Cycle, spindle: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """In and out at the feed."""
    dwell = _dwell(cycle, spindle, formats)
    return (89, dwell) if dwell else (85, [])


def _bore(cycle: Cycle, spindle: SpindleState | None, formats: Formats) -> GCodeAndWords:
    """Return the spindle stops at the bottom; G86 needs a P."""
    running_spindle(spindle, "CYCLE/BORE,DRAG")
    return 86, _dwell(cycle, spindle, formats) or ["P0"]


_CYCLES: Final[dict[HoleMethod, Callable[[Cycle, SpindleState | None, Formats], GCodeAndWords]]] = {
    HoleMethod.DRILL: _drill,
    HoleMethod.DEEP_DRILLING: _peck,
    HoleMethod.CHIP_BREAKING: _peck,
    HoleMethod.FLOATING_TAP: _floating_tap,
    HoleMethod.REAM: _ream,
    HoleMethod.BORE: _bore,
}
