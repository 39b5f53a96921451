"""Canned cycles of a Fidia as the motions that they make at one hole.

Z is the height of rapid positioning, R where the feed begins, E the final depth, D a peck and H a dwell, s. Heights are
positions along Z, in the units of the program.
"""

from typing import Final

from trunnion.readers.common.drilling import MOST_PECKS, CycleError, Step

#: Canned cycles, by their G code in tenths.
CYCLES: Final = frozenset({810, 820, 830, 840, 850, 860, 890})

#: Words of cycles that hold until they end.
STICKY: Final = "ZERDH"

#: How far above the last depth G83 goes back at rapid, mm (unconfirmed).
ABOVE: Final = 1.0


def steps(code: int, words: dict[str, float], units: float) -> list[Step]:
    """Return the motions of a cycle from the height of positioning on and back to it.

    words   Z, E and R at least
    units   the program's units in a millimetre
    """
    height, start, depth = words["Z"], words["R"], words["E"]
    if not height >= start > depth:
        raise CycleError("does not go down from Z by R to E")
    dwell = max(words.get("H", 0.0), 0.0)
    down = [Step(True, start)] if start != height else []
    into = Step(False, depth, dwell=dwell)
    match code:
        case 810 | 820 | 860:
            made = [into]
        case 830:
            made = _peck(start, depth, words.get("D", 0.0), dwell, units)
        case _:
            assert code in (840, 850, 890)
            made = [into, Step(False, start)]
    back = [Step(True, height)] if code not in (840, 850, 890) or start != height else []
    return [*down, *made, *back]


def _peck(start: float, depth: float, stroke: float, dwell: float, units: float) -> list[Step]:
    if stroke <= 0.0:
        raise CycleError("has a D that is not above 0")
    total = start - depth
    if total / stroke > MOST_PECKS:
        raise CycleError(f"would peck more than {MOST_PECKS} times")
    made: list[Step] = []
    reached = stroke
    while reached < total - 1e-9:
        made.append(Step(False, start - reached, dwell=dwell))
        made.append(Step(True, start))
        if reached > ABOVE * units:
            made.append(Step(True, start - reached + ABOVE * units))
        reached += stroke
    return [*made, Step(False, depth, dwell=dwell)]
