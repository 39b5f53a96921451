"""Canned cycles of a Fanuc as the motions that they make at one hole.

Heights are positions along the axis on the working plane, in the units of the program.
"""

from dataclasses import dataclass
from typing import Final

from trunnion.readers.control.hole_motion import MAX_PECKS, CycleExecutionError, HoleMotion

#: Canned cycles, by their G code in tenths.
CYCLES: Final = frozenset({730, 740, 760, 810, 820, 830, 840, 850, 860, 870, 880, 890})

#: Those that need Q.
NEED_Q: Final = frozenset({730, 830})

#: Words of cycles that hold until they end.
MODAL_WORDS: Final = "RZPQIJ"

#: How far G73 backs off and how far above the last depth G83 goes back at rapid, mm: parameters of the control.
CHIP_BREAK: Final = 1.0
ABOVE: Final = 1.0


@dataclass(frozen=True, slots=True)
class Hole:
    """What a cycle knows at a hole.

    initial   height before the cycles began
    back      whether it ends there (G98), else at R
    aside     shift of boring tools in the two axes of the plane
    units     the program's units in a millimetre
    dwell     seconds
    """

    retract: float
    bottom: float
    initial: float
    back: bool
    stroke: float
    lateral: tuple[float, float]
    dwell: float
    units: float


def cycle_motions(code: int, hole: Hole) -> list[HoleMotion]:
    """Return the motions of a cycle from the hole's position on."""
    into = HoleMotion(False, hole.bottom)
    stay = HoleMotion(False, hole.bottom, dwell=hole.dwell)
    out = HoleMotion(True, hole.retract)
    back = [HoleMotion(True, hole.initial)] if hole.back and hole.initial != hole.retract else []
    start = [HoleMotion(True, hole.retract)]
    match code:
        case 810:
            return [*start, into, *(back or [out])]
        case 820:
            return [*start, stay, *(back or [out])]
        case 730 | 830:
            return [*start, *_peck(hole, full=code == 830), *(back or [out])]
        case 740 | 840 | 890:
            return [*start, stay, HoleMotion(False, hole.retract), *back]
        case 850:
            return [*start, into, HoleMotion(False, hole.retract), *back]
        case 860:
            return [*start, into, *(back or [out])]
        case 880:
            return [*start, stay, out, *back]
        case 760:
            end = hole.initial if back else hole.retract
            lateral = hole.lateral
            return [
                *start,
                stay,
                HoleMotion(True, hole.bottom, lateral=lateral),
                HoleMotion(True, end, lateral=lateral),
                HoleMotion(True, end),
            ]
        case _:
            assert code == 870
            return _back_bore(hole)


def _peck(hole: Hole, full: bool) -> list[HoleMotion]:
    if hole.stroke <= 0.0:
        raise CycleExecutionError("has a Q that is not above 0")
    total = abs(hole.retract - hole.bottom)
    if total / hole.stroke > MAX_PECKS:
        raise CycleExecutionError(f"would peck more than {MAX_PECKS} times")
    down = -1.0 if hole.bottom < hole.retract else 1.0
    made: list[HoleMotion] = []
    depth = hole.stroke
    while depth < total - 1e-9:
        made.append(HoleMotion(False, hole.retract + down * depth))
        if full:
            made.append(HoleMotion(True, hole.retract))
            if depth > ABOVE * hole.units:
                made.append(HoleMotion(True, hole.retract + down * (depth - ABOVE * hole.units)))
        else:
            made.append(HoleMotion(True, hole.retract + down * max(depth - CHIP_BREAK * hole.units, 0.0)))
        depth += hole.stroke
    return [*made, HoleMotion(False, hole.bottom)]


def _back_bore(hole: Hole) -> list[HoleMotion]:
    """G87: beside the hole down to R, over to it, up to Z and a little back, out beside it."""
    if not hole.back:
        raise CycleExecutionError("G87 needs G98")
    lateral = hole.lateral
    return [
        HoleMotion(True, hole.initial, lateral=lateral),
        HoleMotion(True, hole.retract, lateral=lateral),
        HoleMotion(True, hole.retract),
        HoleMotion(False, hole.bottom, dwell=hole.dwell),
        HoleMotion(True, hole.bottom, lateral=lateral),
        HoleMotion(True, hole.initial, lateral=lateral),
        HoleMotion(True, hole.initial),
    ]
