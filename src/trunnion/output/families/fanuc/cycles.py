"""Hole-making cycles of a Fanuc: G73, G74, G76, G81 to G86, G88 and G89, called with their first hole.

Facts: FANUC's operator's manuals; docs/controls/fanuc.md has the words one by one.
"""

import math
from collections.abc import Mapping
from typing import Final

from trunnion.controls.family import FIRST_HOLE, Formats
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, CycleError, Making, Turning, UnsaidError

#: The G word of each cycle, without a dwell and with one; None: it has no word for a dwell.
_CYCLES: Final[Mapping[Making, tuple[str, str | None]]] = {
    Making.DRILL: ("G81", "G82"),
    Making.DEEP: ("G83", None),
    Making.CHIPS: ("G73", None),
    Making.TAP: ("G84", "G84"),
    Making.TAP_CHUCK: ("G84", "G84"),
    Making.REAM: ("G85", "G89"),
    Making.DRAG: ("G86", None),
    Making.LIFT: ("G76", "G76"),
    Making.MANUAL: ("G88", "G88"),
}

#: What G84 is for a left-hand thread.
_LEFT: Final = "G74"

#: mm; NaN is no less.
_FARTHEST_SHIFT: Final = 100.0


def cycle_call(
    cycle: Cycle, top: float, turning: Turning | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """The lines that make a cycle modal, with the first hole in the last of them; arguments as ``FamilyWriter.hole_call``."""
    assert cycle.retract is not None
    number = formats["coordinate"].text
    dwell = _dwell(cycle, turning, formats)
    if cycle.making not in _CYCLES:
        what = f"CYCLE/{cycle.making}: whether G84 pecks, and how, is a parameter of the control"
        raise CycleError(what, "leave DEEP or BRKCHP out, or output the holes as motion")
    plain, waiting = _CYCLES[cycle.making]
    code = waiting if dwell else plain
    if code is None:
        what = f"{cycle.making} with a dwell at the bottom, for which {plain} has no word"
        raise UnsaidError(what, "leave DWELL out")
    before: list[str] = []
    if cycle.making in (Making.TAP, Making.TAP_CHUCK):
        spindle = _checked_thread(cycle, turning)
        code = code if spindle.sense is Sense.CLW else _LEFT
        if cycle.making is Making.TAP and settings["rigid_tap"]:
            before = [f"{settings['rigid_tap']} S{formats['speed'].text(spindle.rpm)}"]
    back = "G98" if cycle.retract > cycle.above else "G99"
    words = [f"Z{number(top - cycle.depth)}", f"R{number(top + cycle.above)}"]
    if cycle.making in (Making.DEEP, Making.CHIPS):
        words.append(f"Q{number(_stroke(cycle))}")
    if cycle.making is Making.LIFT:
        words.append(f"Q{number(_shift(cycle, settings))}")
    if dwell:
        words.append(f"P{dwell}")
    return [*before, " ".join((back, code, FIRST_HOLE, *words))]


def is_shift(text: str) -> bool:
    """Whether the setting ``bore_lift`` is empty, or millimetres that a tool could be shifted by in a bore."""
    try:
        return not text or 0.0 < float(text) < _FARTHEST_SHIFT
    except ValueError:
        return False


def _dwell(cycle: Cycle, turning: Turning | None, formats: Formats) -> str:
    """Milliseconds at the bottom, empty for none; spindle turns become the time that they take."""
    if not cycle.dwell:
        return ""
    if not cycle.dwell_turns:
        return formats["dwell"].text(1000.0 * cycle.dwell)
    if turning is None or not turning.rpm > 0.0:
        raise CycleError("DWELL,REV while the spindle stands still", "put SPINDL before the cycle")
    return formats["dwell"].text(60000.0 * cycle.dwell / turning.rpm)


def _stroke(cycle: Cycle) -> float:
    """Q: all strokes are alike, and counted from where the feed begins."""
    if any(cycle.steps[1:]):
        raise UnsaidError("strokes that become shorter, where Q is one stroke", "write STEP with one number")
    return cycle.steps[0]


def _shift(cycle: Cycle, settings: Mapping[str, str]) -> float:
    """Q of G76: how far the tool is shifted off the wall, to the side that a parameter of the control says."""
    if cycle.angle:
        what = f"BORE,NODRAG,{cycle.angle:g}: the angle at which the spindle stops is a parameter of the control"
        raise CycleError(what, "write BORE,NODRAG without an angle")
    if not settings["bore_lift"]:
        what = "BORE,NODRAG does not say how far the tool lifts off"
        raise CycleError(what, "--set bore_lift=MM says it; to which side is a parameter of the control")
    return float(settings["bore_lift"])


def _checked_thread(cycle: Cycle, turning: Turning | None) -> Turning:
    """The spindle that cuts a thread; F is per minute, and feed over speed is the pitch."""
    if turning is None or not (turning.rpm > 0.0 and math.isfinite(turning.rpm)):
        raise CycleError("CYCLE/TAP while the spindle stands still", "put SPINDL before the cycle")
    if cycle.feed is None or not cycle.feed > 0.0:
        raise CycleError("CYCLE/TAP without a feed", "write MMPR,pitch")
    return turning
