"""Drilling cycles as the motions that they make at one hole; heights in the program's units."""

from collections.abc import Mapping
from typing import Final

from trunnion.reader.drilling import FASTEST, MOST_PECKS, CycleError, Step

#: How far G73 backs off, and how far above the last depth G83 ends its rapid, inches.
CLEARANCE: Final = 0.010


def steps(code: int, words: Mapping[str, float], here: float, back: float, unit: float, turns: float) -> list[Step]:
    """Return the motions of a cycle over the hole.

    Parameters
    ----------
    code
        Ten times the G number, one of ``words.CYCLES``.
    words
        Z (bottom), R, and Q and P where the cycle has them; absolute.
    here, back
        Height before the cycle, and where it ends.
    unit
        Millimetres of a length.
    turns
        Spindle speed, rev/min, for nothing but to refuse tapping without it.
    """
    bottom, top = words["Z"], words["R"]
    if bottom >= top:
        raise CycleError("has its bottom above R")
    pause = words.get("P", 0.0)
    if not 0.0 <= pause <= FASTEST:
        raise CycleError("has a dwell that is none")
    made = [] if here == top else [Step(True, top)]
    if code in (730, 830):
        made += _pecks(code, bottom, top, words.get("Q"), CLEARANCE * 25.4 / unit)
    else:
        made.append(Step(False, bottom, dwell=pause if code in (820, 860, 890) else 0.0))
    if code in (740, 840) and not turns:
        raise CycleError("taps without a spindle speed")
    if code in (740, 840, 850, 890):
        made.append(Step(False, top))
        return made if back == top else [*made, Step(True, back)]
    return [*made, Step(True, back)]


def _pecks(code: int, bottom: float, top: float, stroke: float | None, clearance: float) -> list[Step]:
    if stroke is None or stroke <= 0.0:
        raise CycleError("needs a positive Q")
    if (top - bottom) / stroke > MOST_PECKS:
        raise CycleError(f"would peck more than {MOST_PECKS} times")
    made: list[Step] = []
    depth = top
    while depth > bottom:
        if depth < top and code == 830:
            made.append(Step(True, top))
            made.append(Step(True, min(depth + clearance, top)))
        elif depth < top:
            made.append(Step(True, min(depth + clearance, top)))
        depth = max(depth - stroke, bottom)
        made.append(Step(False, depth))
    return made
