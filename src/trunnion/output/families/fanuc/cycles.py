"""Hole-making cycles of a Fanuc: G73, G74, G76, G81 to G86, G88 and G89, called with their first hole.

Facts: FANUC's operator's manuals; docs/controls/fanuc.md has the words one by one.
"""

import math
from collections.abc import Mapping
from typing import Final

from trunnion.controls.family_writer import FIRST_HOLE, Formats
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError

#: The G word of each cycle, without a dwell and with one; None: it has no word for a dwell.
_CYCLES: Final[Mapping[HoleMethod, tuple[str, str | None]]] = {
    HoleMethod.DRILL: ("G81", "G82"),
    HoleMethod.DEEP_DRILLING: ("G83", None),
    HoleMethod.CHIP_BREAKING: ("G73", None),
    HoleMethod.TAP: ("G84", "G84"),
    HoleMethod.FLOATING_TAP: ("G84", "G84"),
    HoleMethod.REAM: ("G85", "G89"),
    HoleMethod.BORE: ("G86", None),
    HoleMethod.BORE_WITH_LIFT: ("G76", "G76"),
    HoleMethod.BORE_MANUAL: ("G88", "G88"),
}

#: What G84 is for a left-hand thread.
_LEFT_HAND_TAP: Final = "G74"

#: mm; NaN is no less.
_MAX_SHIFT: Final = 100.0


def cycle_lines(
    cycle: Cycle, top: float, turning: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """The lines that make a cycle modal, with the first hole in the last of them; arguments as
    ``FamilyWriter.cycle_call``."""
    assert cycle.retract_height is not None
    number = formats["coordinate"].text
    dwell = _dwell(cycle, turning, formats)
    if cycle.method not in _CYCLES:
        what = f"CYCLE/{cycle.method}: whether G84 pecks, and how, is a parameter of the control"
        raise HoleCycleError(what, "leave DEEP or BRKCHP out, or output the holes as motion")
    plain, waiting = _CYCLES[cycle.method]
    code = waiting if dwell else plain
    if code is None:
        what = f"{cycle.method} with a dwell at the bottom, for which {plain} has no word"
        raise UnsupportedCycleError(what, "leave DWELL out")
    before: list[str] = []
    if cycle.method in (HoleMethod.TAP, HoleMethod.FLOATING_TAP):
        spindle = _checked_thread(cycle, turning)
        code = code if spindle.sense is Sense.CLW else _LEFT_HAND_TAP
        if cycle.method is HoleMethod.TAP and settings["rigid_tap"]:
            before = [f"{settings['rigid_tap']} S{formats['speed'].text(spindle.rpm)}"]
    back = "G98" if cycle.retract_height > cycle.rapid_height else "G99"
    words = [f"Z{number(top - cycle.depth)}", f"R{number(top + cycle.rapid_height)}"]
    if cycle.method in (HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING):
        words.append(f"Q{number(_peck_depth(cycle))}")
    if cycle.method is HoleMethod.BORE_WITH_LIFT:
        words.append(f"Q{number(_bore_shift(cycle, settings))}")
    if dwell:
        words.append(f"P{dwell}")
    return [*before, " ".join((back, code, FIRST_HOLE, *words))]


def is_valid_shift(text: str) -> bool:
    """Whether the setting ``bore_lift`` is empty, or millimetres that a tool could be shifted by in a bore."""
    try:
        return not text or 0.0 < float(text) < _MAX_SHIFT
    except ValueError:
        return False


def _dwell(cycle: Cycle, turning: SpindleState | None, formats: Formats) -> str:
    """Milliseconds at the bottom, empty for none; spindle turns become the time that they take."""
    if not cycle.dwell:
        return ""
    if not cycle.dwell_in_revolutions:
        return formats["dwell"].text(1000.0 * cycle.dwell)
    if turning is None or not turning.rpm > 0.0:
        raise HoleCycleError("DWELL,REV while the spindle stands still", "put SPINDL before the cycle")
    return formats["dwell"].text(60000.0 * cycle.dwell / turning.rpm)


def _peck_depth(cycle: Cycle) -> float:
    """Q: all strokes are alike, and counted from where the feed begins."""
    if any(cycle.strokes[1:]):
        raise UnsupportedCycleError("strokes that become shorter, where Q is one stroke", "write STEP with one number")
    return cycle.strokes[0]


def _bore_shift(cycle: Cycle, settings: Mapping[str, str]) -> float:
    """Q of G76: how far the tool is shifted off the wall, to the side that a parameter of the control says."""
    if cycle.spindle_angle:
        what = (
            f"BORE,NODRAG,{cycle.spindle_angle:g}: the angle at which the spindle stops is a parameter of the control"
        )
        raise HoleCycleError(what, "write BORE,NODRAG without an angle")
    if not settings["bore_lift"]:
        what = "BORE,NODRAG does not say how far the tool lifts off"
        raise HoleCycleError(what, "--set bore_lift=MM says it; to which side is a parameter of the control")
    return float(settings["bore_lift"])


def _checked_thread(cycle: Cycle, turning: SpindleState | None) -> SpindleState:
    """The spindle that cuts a thread; F is per minute, and feed over speed is the pitch."""
    if turning is None or not (turning.rpm > 0.0 and math.isfinite(turning.rpm)):
        raise HoleCycleError("CYCLE/TAP while the spindle stands still", "put SPINDL before the cycle")
    if cycle.feed is None or not cycle.feed > 0.0:
        raise HoleCycleError("CYCLE/TAP without a feed", "write MMPR,pitch")
    return turning
