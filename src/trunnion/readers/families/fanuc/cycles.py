"""Canned cycles of a Fanuc as the motions that they make at one hole.

Heights are positions along the axis normal to the working plane, in the units of the program.
"""

from typing import Final

from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.readers.control.hole_motion import (
    CycleExecutionError,
    HoleMotion,
    check_pecks,
    chip_break,
    descent,
    peck_depths,
)
from trunnion.records import dataclass

#: The one whose I and J shift the tool off the wall.
FINE_BORE: Final = 760

#: The one that bores upwards, from Z below the hole.
BACK_BORE: Final = 870

#: Those with such words. Where others know I and J, they describe pecks or a retract.
SHIFTED: Final = (FINE_BORE, BACK_BORE)

#: Cycles of pecks.
PECKS: Final = (730, 830)

#: The cycles that have a use for a word: the dwell P, and the peck or shift Q.
WITH_P: Final = (740, 760, 820, 840, 870, 880, 890)
WITH_Q: Final = (*PECKS, 740, 760, 840, 870)

#: Words of cycles that hold until the cycles end.
MODAL_WORDS: Final = "RZPQIJ"

#: How far G73 backs off, and how far above the last depth the rapid approach of G83 ends, mm: settings of the control.
CHIP_BREAK: Final = 1.0
ABOVE: Final = 1.0


@dataclass(frozen=True, slots=True)
class Hole:
    """The values of a cycle at a hole.

    retract     height R
    bottom      height Z
    initial     height before the cycles began
    to_initial  whether the cycle ends at the initial height (G98), else at R
    peck      Q
    lateral     shift of boring tools in the two axes of the plane
    dwell       seconds
    units       units of the program in a millimetre
    """

    retract: float
    bottom: float
    initial: float
    to_initial: bool
    peck: float
    lateral: tuple[float, float]
    dwell: float
    units: float


def cycle_motions(code: int, hole: Hole) -> list[HoleMotion]:
    """Return the motions of a cycle from the position of the hole on."""
    into = HoleMotion(False, hole.bottom)
    into_and_dwell = HoleMotion(False, hole.bottom, dwell=hole.dwell)
    out = HoleMotion(True, hole.retract)
    back = [HoleMotion(True, hole.initial)] if hole.to_initial and hole.initial != hole.retract else []
    start = [HoleMotion(True, hole.retract)]
    match code:
        case 810 | 860:
            return [*start, into, *(back or [out])]
        case 820:
            return [*start, into_and_dwell, *(back or [out])]
        case 730 | 830:
            return [*start, *_peck(hole, full=code == 830), *(back or [out])]
        case 740 | 840 | 890:
            return [*start, into_and_dwell, HoleMotion(False, hole.retract), *back]
        case 850:
            return [*start, into, HoleMotion(False, hole.retract), *back]
        case 880:
            return [*start, into_and_dwell, out, *back]
        case 760:
            end, lateral = hole.initial if back else hole.retract, hole.lateral
            beside = [HoleMotion(True, hole.bottom, lateral=lateral), HoleMotion(True, end, lateral=lateral)]
            return [*start, into_and_dwell, *beside, HoleMotion(True, end)]
        case _:
            assert code == 870
            return _back_bore(hole)


def spindle_work(code: int, stroke: float) -> SpindleWork | None:
    """Return how a cycle drives the spindle; None: it turns as programmed.

    stroke   Q, mm; how a tap with Q pecks is a setting of the control, and out of the hole is always right
    """
    match code:
        case 740 | 840:
            return SpindleWork(SpindleTask.TAP, hand=1 if code == 840 else -1, stroke=stroke, full=stroke > 0.0)
        case 860:
            return SpindleWork(SpindleTask.STOP)
        case 760 | 870:
            return SpindleWork(SpindleTask.LIFT)
        case 880:
            return SpindleWork(SpindleTask.MANUAL)
    return None


def _peck(hole: Hole, full: bool) -> list[HoleMotion]:
    """Return the pecks of G73, or of G83 with ``full`` retracts."""
    total = abs(hole.retract - hole.bottom)
    check_pecks(total, hole.peck, "Q")
    down = -1.0 if hole.bottom < hole.retract else 1.0

    def height(depth: float) -> float:
        return hole.bottom if depth == total else hole.retract + down * depth

    def out(depth: float) -> list[HoleMotion]:
        above = depth - ABOVE * hole.units
        return [HoleMotion(True, hole.retract), *([HoleMotion(True, height(above))] if above > 0.0 else [])]

    back = chip_break(height, CHIP_BREAK * hole.units, rapid=True, least=0.0)
    return descent(peck_depths(total, hole.peck), height, out if full else back, dwells=(0.0, hole.dwell))


def _back_bore(hole: Hole) -> list[HoleMotion]:
    """Return the motions of G87: beside the hole down to R, over it, up to Z, and out beside it."""
    if not hole.to_initial:
        raise CycleExecutionError(Wording("NC380", "g87_needs_g98"))
    lateral = hole.lateral
    if lateral == (0.0, 0.0):
        raise CycleExecutionError(Wording("NC380", "not_beside_the_wall"))
    return [
        HoleMotion(True, hole.initial, lateral=lateral),
        HoleMotion(True, hole.retract, lateral=lateral),
        HoleMotion(True, hole.retract),
        HoleMotion(False, hole.bottom, dwell=hole.dwell),
        HoleMotion(True, hole.bottom, lateral=lateral),
        HoleMotion(True, hole.initial, lateral=lateral),
        HoleMotion(True, hole.initial),
    ]
