"""Canned cycles of a Fidia as the motions that they make at one hole.

Z is the height of rapid positioning, R where the feed begins, E the final depth, D a peck and H a dwell, s. Heights are
positions along Z, in the units of the program.
"""

from typing import Final

from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion, check_pecks, descent, peck_depths

#: The cycle of pecks, which alone has a use for D.
PECKS: Final = 830

#: Words of cycles that hold until the cycles end.
MODAL_WORDS: Final = "ZERDH"

#: How far above the last depth the rapid approach of G83 ends unless the definition says otherwise, mm (unconfirmed).
ABOVE: Final = 1.0


def cycle_motions(code: int, words: dict[str, float], above: float) -> list[HoleMotion]:
    """Return the motions of a cycle from the height of positioning on and back to it.

    words   Z, E and R at least
    above   how far above the last depth the rapid approach of G83 ends, in units of the program
    """
    height, start, depth = words["Z"], words["R"], words["E"]
    if not height >= start > depth:
        raise CycleExecutionError(Wording("NC380", "does_not_go_down_z"))
    dwell = max(words.get("H", 0.0), 0.0)
    down = [HoleMotion(True, start)] if start != height else []
    into = HoleMotion(False, depth, dwell=dwell)
    match code:
        case 810 | 820 | 860:
            cut = [into]
        case 830:
            cut = _peck(start, depth, words.get("D", 0.0), dwell, above)
        case _:
            assert code in (840, 850, 890)
            cut = [into, HoleMotion(False, start)]
    back = [HoleMotion(True, height)] if code not in (840, 850, 890) or start != height else []
    return [*down, *cut, *back]


def spindle_work(code: int) -> SpindleWork | None:
    """Return how a cycle drives the spindle; None: it turns as programmed."""
    if code == 840:
        return SpindleWork(SpindleTask.TAP)
    return SpindleWork(SpindleTask.STOP) if code == 860 else None


def _peck(start: float, bottom: float, peck: float, dwell: float, above: float) -> list[HoleMotion]:
    total = start - bottom
    check_pecks(total, peck, "D")

    def height(depth: float) -> float:
        return bottom if depth == total else start - depth

    def out(depth: float) -> list[HoleMotion]:
        approach = [HoleMotion(True, height(depth) + above)] if depth > above else []
        return [HoleMotion(True, start), *approach]

    return descent(peck_depths(total, peck), height, out, dwells=(dwell, dwell))
