"""Drilling cycles of a Fanuc: G73, G74, G76, G81 to G86, G88 and G89, called with their first hole.

Facts: FANUC's operator's manuals; docs/controls/fanuc.md lists the words.
"""

from collections.abc import Mapping
from typing import Final

from trunnion.controls.family_writer import FIRST_HOLE, Formats
from trunnion.messages import Wording
from trunnion.model.toolpath import Sense
from trunnion.output.shared.spindle import cycle_dwell_seconds, thread
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

#: G84 for a left-hand thread.
_LEFT_HAND_TAP: Final = "G74"

#: Greatest shift off the wall of a bore, mm.
_MAX_SHIFT: Final = 100.0
#: Least shift, mm: the cycle must not print it as 0.
_MIN_SHIFT: Final = 0.001


def cycle_lines(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """Return the lines that make a cycle modal, the last with the first hole; as ``FamilyWriter.cycle_call``."""
    assert cycle.retract_height is not None
    number = formats["coordinate"].text
    dwell = formats["dwell"].text(dwell_parts(formats) * cycle_dwell_seconds(cycle, spindle)) if cycle.dwell else ""
    if cycle.method not in _CYCLES:
        raise HoleCycleError(Wording("CTL360", "cycle_whether_g84", method=cycle.method))
    plain, with_dwell = _CYCLES[cycle.method]
    code = with_dwell if dwell else plain
    if code is None:
        raise UnsupportedCycleError(Wording("CTL350", "dwell_bottom_no", method=cycle.method, plain=plain))
    missing = [word.strip() for word in settings.get("missing_cycles", "").split(",")]
    if code in missing or (dwell and f"{code} P" in missing):
        raise UnsupportedCycleError(
            Wording("CTL350", "dwell_control_no" if code not in missing else "control_no_cycle", method=cycle.method)
        )
    before: list[str] = []
    if cycle.method in (HoleMethod.TAP, HoleMethod.FLOATING_TAP):
        _, running = thread(cycle, spindle)
        code = code if running.sense is Sense.CLW else _LEFT_HAND_TAP
        if cycle.method is HoleMethod.TAP and settings["rigid_tap"]:
            before = [f"{settings['rigid_tap']} S{formats['speed'].text(running.rpm)}"]
    retract = "G98" if cycle.retract_height > cycle.rapid_height else "G99"
    words = [f"Z{number(top - cycle.depth)}", f"R{number(top + cycle.rapid_height)}"]
    if cycle.method in (HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING):
        words.append(f"Q{number(_peck_depth(cycle))}")
    if cycle.method is HoleMethod.BORE_WITH_LIFT:
        words.append(f"Q{number(_bore_shift(cycle, settings))}")
    if dwell:
        words.append(f"P{dwell}")
    return [*before, " ".join((retract, code, FIRST_HOLE, *words))]


def is_valid_shift(text: str) -> bool:
    """Return whether the setting ``bore_lift`` is empty, or a length by which a tool can be shifted in a bore, mm."""
    try:
        return not text or _MIN_SHIFT <= float(text) < _MAX_SHIFT
    except ValueError:
        return False


def dwell_parts(formats: Formats) -> float:
    """Return what a second of a dwell counts: 1000 in milliseconds, 1 where the format has decimals."""
    return 1.0 if formats["dwell"].decimals else 1000.0


def _peck_depth(cycle: Cycle) -> float:
    """Q: the depth of every peck, the first measured from where the feed begins."""
    if any(cycle.pecks[1:]):
        raise UnsupportedCycleError(Wording("CTL350", "decreasing_peck_depths"))
    return cycle.pecks[0]


def _bore_shift(cycle: Cycle, settings: Mapping[str, str]) -> float:
    """Q of G76: how far the tool is shifted off the wall; a parameter of the control has the direction."""
    if cycle.spindle_angle:
        raise HoleCycleError(Wording("CTL360", "bore_nodrag_angle", spindle_angle=cycle.spindle_angle))
    if not settings["bore_lift"]:
        raise HoleCycleError(Wording("CTL360", "bore_nodrag_does"))
    return float(settings["bore_lift"])
