"""Canned cycles of LinuxCNC as the motions that they make at one hole.

Heights are positions along the axis normal to the working plane, in the units of the program.
"""

from typing import Final

from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion, check_pecks, descent
from trunnion.records import dataclass

#: Words of cycles that hold until another cycle begins.
MODAL_WORDS: Final = "RZPQIJK"

#: The cycles that have a use for a word; the interpreter refuses it in any other.
OWN_WORDS: Final = {
    "P": (740, 820, 840, 860, 880, 890), "Q": (730, 830), "D": (730, 830), "I": (870,), "J": (870,), "K": (870,),
}  # fmt: skip

#: How far above the last depth the rapid approach of G83 ends, and how far G73 backs off, in inches.
CLEARANCE: Final = 0.01


@dataclass(frozen=True, slots=True)
class Hole:
    """The values of a cycle at a hole.

    retract    height R
    bottom     height Z
    clear      height at which the cycle ends
    clearance  as ``CLEARANCE``, in the units of the program
    words      R, Z, P, Q, D, I, J, K as far as they are written; Z and R are heights
    """

    retract: float
    bottom: float
    clear: float
    clearance: float
    words: dict[str, float]


def cycle_motions(code: int, hole: Hole) -> list[HoleMotion]:
    """Return the motions of a cycle from the retract plane on."""
    bottom, clear = hole.bottom, hole.clear
    into = HoleMotion(False, bottom)
    into_and_dwell = HoleMotion(False, bottom, dwell=max(hole.words.get("P", 0.0), 0.0))
    match code:
        case 810:
            return [into, HoleMotion(True, clear)]
        case 820 | 860:
            return [into_and_dwell, HoleMotion(True, clear)]
        case 730 | 830:
            return _peck(hole, full=code == 830)
        case 740 | 840 | 890:
            return [into_and_dwell, HoleMotion(False, clear)]
        case 850:
            return [into, HoleMotion(False, hole.retract), HoleMotion(True, clear)]
        case 870:
            return _back_bore(hole)
        case _:
            assert code == 880
            return [into_and_dwell]


def spindle_work(code: int) -> SpindleWork | None:
    """Return how a cycle drives the spindle; None: it turns as programmed."""
    match code:
        case 740 | 840:
            return SpindleWork(SpindleTask.TAP, hand=1 if code == 840 else -1, floating=True)
        case 860:
            return SpindleWork(SpindleTask.STOP)
        case 870:
            return SpindleWork(SpindleTask.LIFT)
        case 880:
            return SpindleWork(SpindleTask.MANUAL)
    return None


def _peck(hole: Hole, full: bool) -> list[HoleMotion]:
    """Return the pecks of G73, or of G83 with ``full`` retracts."""
    peck = hole.words.get("Q", 0.0)
    check_pecks(hole.retract - hole.bottom, peck, "Q")
    back = hole.words.get("D", hole.clearance)
    out = [HoleMotion(True, hole.retract)] if full else []
    heights = [hole.retract - peck]
    while heights[-1] > hole.bottom:
        heights.append(heights[-1] - peck)
    heights[-1] = hole.bottom
    motions = descent(heights, lambda height: height, lambda height: [*out, HoleMotion(True, height + back)])
    return [*motions, HoleMotion(True, hole.clear)]


def _back_bore(hole: Hole) -> list[HoleMotion]:
    """Return the motions of G87: beside the hole down, over it, up to K and back, and out beside it."""
    missing = [letter for letter in "IJK" if letter not in hole.words]
    if missing:
        raise CycleExecutionError(Wording("NC380", "has_no", word=missing[0]))
    lateral = hole.words["I"], hole.words["J"]
    return [
        HoleMotion(True, hole.retract, lateral=lateral),
        HoleMotion(True, hole.bottom, lateral=lateral),
        HoleMotion(True, hole.bottom),
        HoleMotion(False, hole.words["K"]),
        HoleMotion(False, hole.bottom),
        HoleMotion(True, hole.bottom, lateral=lateral),
        HoleMotion(True, hole.clear, lateral=lateral),
        HoleMotion(True, hole.clear),
    ]
