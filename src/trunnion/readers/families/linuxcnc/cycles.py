"""Canned cycles of LinuxCNC as the motions that they make at one hole.

Heights are positions along the axis on the working plane, in the units of the program.
"""

from dataclasses import dataclass
from typing import Final

from trunnion.readers.control.hole_motion import MAX_PECKS, CycleExecutionError, HoleMotion

#: Canned cycles that drill, by their G code in tenths.
CYCLES: Final = frozenset({730, 740, 810, 820, 830, 840, 850, 860, 870, 880, 890})

#: Those that need Q and P when they begin.
NEED_Q: Final = frozenset({730, 830})
NEED_P: Final = frozenset({820, 860, 880, 890})

#: Taps, which wait as the last cycle that waited where they have no P of their own.
KEEP_P: Final = frozenset({740, 840})

#: Words of cycles that hold until another cycle begins.
MODAL_WORDS: Final = "RZPQIJK"

#: How far above the last depth G83 goes back at rapid, and how far G73 backs off, in inches.
CLEARANCE: Final = 0.01


@dataclass(frozen=True, slots=True)
class Hole:
    """What a cycle knows at a hole.

    clear      where it ends
    clearance  as ``CLEARANCE``, in the units of the program
    words      R, Z, P, Q, D, I, J, K as far as they are written; Z and R are heights already
    """

    retract: float
    bottom: float
    clear: float
    clearance: float
    words: dict[str, float]


def cycle_motions(code: int, hole: Hole) -> list[HoleMotion]:
    """Return the motions of a cycle from the retract plane on."""
    bottom, clear = hole.bottom, hole.clear
    dwell = max(hole.words.get("P", 0.0), 0.0)
    match code:
        case 810:
            return [HoleMotion(False, bottom), HoleMotion(True, clear)]
        case 820:
            return [HoleMotion(False, bottom, dwell=dwell), HoleMotion(True, clear)]
        case 730 | 830:
            return _peck(hole, full=code == 830)
        case 740 | 840:
            return [HoleMotion(False, bottom, dwell=dwell), HoleMotion(False, clear)]
        case 850:
            return [HoleMotion(False, bottom), HoleMotion(False, hole.retract), HoleMotion(True, clear)]
        case 860:
            return [HoleMotion(False, bottom, dwell=dwell), HoleMotion(True, clear)]
        case 870:
            return _back_bore(hole)
        case 880:
            return [HoleMotion(False, bottom, dwell=dwell)]
        case _:
            assert code == 890
            return [HoleMotion(False, bottom, dwell=dwell), HoleMotion(False, clear)]


def _peck(hole: Hole, full: bool) -> list[HoleMotion]:
    stroke = hole.words.get("Q", 0.0)
    if stroke <= 0.0:
        raise CycleExecutionError("has a Q that is not above 0")
    back = hole.words.get("D", hole.clearance)
    if (hole.retract - hole.bottom) / stroke > MAX_PECKS:
        raise CycleExecutionError(f"would peck more than {MAX_PECKS} times")
    made: list[HoleMotion] = []
    depth = hole.retract - stroke
    while depth > hole.bottom:
        made.append(HoleMotion(False, depth))
        if full:
            made.append(HoleMotion(True, hole.retract))
        made.append(HoleMotion(True, depth + back))
        depth -= stroke
    return [*made, HoleMotion(False, hole.bottom), HoleMotion(True, hole.clear)]


def _back_bore(hole: Hole) -> list[HoleMotion]:
    """G87: beside the hole down, over to it, up to K and back, and out beside it."""
    missing = [letter for letter in "IJK" if letter not in hole.words]
    if missing:
        raise CycleExecutionError(f"has no {missing[0]}")
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
