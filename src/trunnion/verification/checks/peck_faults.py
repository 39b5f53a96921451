"""What is wrong with the strokes of a hole: rapids in solid material, wrong pecks, wrong retracts between them.

Heights are as in ``trunnion.verification.expected.holes``.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.drill_motions import DrillMotions, HoleFault
from trunnion.verification.expected.holes import Hole

#: No hole has more strokes.
_MAX_STROKES: Final = 100_000

#: A retract by less than this breaks the chip without leaving the hole, mm.
_CHIP_BREAK: Final = 5.0

#: The row at which faults of the strokes together are named: the first one into the hole.
_FIRST_STROKE: Final = 2


def peck_faults(hole: Hole, motions: DrillMotions) -> Iterator[HoleFault]:
    """Rapids stay above what is drilled; strokes and the retracts between them are those of the cycle."""
    strokes = list[float]()
    between = list[list[int]]()
    yield from _collect_strokes(hole, motions, strokes, between)
    if not hole.cycle.pecks:
        if len(strokes) > 1:
            text = f"drills in {len(strokes)} strokes, the CL file in one"
            yield motions.fault(_FIRST_STROKE, float(len(strokes)), text)
        return
    yield from (_programmed_pecks if motions.by_motion else _cycle_pecks)(hole, motions, strokes)
    for end, rows in zip(strokes, between[:-1], strict=False):
        top = max((float(motions.height[k]) for k in rows), default=-math.inf)
        full, back = abs(top - hole.cycle.clearance) <= hole.tolerance, top - end
        if not rows or full != ("DEEP" in hole.cycle.mode) or (not full and back > _CHIP_BREAK):
            how = "not drawn back" if not rows else "drawn back all the way" if full else "drawn back a little"
            text = f"between strokes the tool is {how}; the CL file says otherwise"
            yield motions.fault(_FIRST_STROKE, top, text)
            break


def _collect_strokes(
    hole: Hole, motions: DrillMotions, strokes: list[float], between: list[list[int]]
) -> Iterator[HoleFault]:
    """Fill in the heights at which strokes end, and the motions after each one; faults of single motions."""
    deepest, bottom = hole.cycle.clearance, motions.bottom
    for k in range(1, len(motions.row)):
        height, kind = float(motions.height[k]), motions.kind[k]
        if kind == Kind.RAPID and height < deepest - hole.tolerance:
            yield motions.fault(k, height, "goes at rapid where nothing is drilled yet")
        elif kind == Kind.LINEAR and height < deepest - 1e-9:
            strokes.append(height)
            between.append([])
        elif motions.by_motion and kind == Kind.LINEAR and k <= bottom:
            yield motions.fault(k, height, "goes at a feed where nothing is left to drill")
        elif between:
            between[-1].append(k)
        deepest = min(deepest, height)


def _cycle_pecks(hole: Hole, motions: DrillMotions, ends: list[float]) -> Iterator[HoleFault]:
    """Strokes of a cycle: the first as deep as STEP says, the others no deeper, and equal if STEP makes them so."""
    # Strokes count from the CL point, or from where the feed begins.
    from_point = not ends or abs(ends[0] + min(hole.cycle.pecks[0], hole.cycle.depth)) <= hole.tolerance
    begin = 0.0 if from_point else hole.cycle.clearance
    first = min(hole.cycle.pecks[0], begin + hole.cycle.depth)
    strokes = np.abs(np.diff([begin, *(ends or [hole.cycle.clearance])]))
    if abs(strokes[0] - first) > hole.tolerance or (np.diff(strokes) > hole.tolerance).any():
        found = ", ".join(f"{stroke:.4f}" for stroke in strokes[:4])
        text = f"drills in strokes of {found}, not of {first:g} and less"
        yield motions.fault(_FIRST_STROKE, float(strokes[0]), text)
    equal = len(hole.cycle.pecks) < 2 or not hole.cycle.pecks[1]
    if equal and len(strokes) > 2 and abs(strokes[:-1] - first).max() > hole.tolerance:
        yield motions.fault(_FIRST_STROKE, float(strokes.min()), f"the strokes are not all {first:g} mm")


def _programmed_pecks(hole: Hole, motions: DrillMotions, ends: list[float]) -> Iterator[HoleFault]:
    """Strokes that the program has itself are those of STEP, one by one: counted from the CL point, or from RAPTO."""
    found = _distinct_heights([hole.cycle.clearance, *ends], hole.tolerance)
    for begin in (0.0, hole.cycle.clearance):
        wanted = _distinct_heights([hole.cycle.clearance, *_step_heights(hole, begin)], hole.tolerance)
        if len(wanted) == len(found) and float(np.abs(wanted - found).max()) <= hole.tolerance:
            return
    heights = ", ".join(f"{-height:.4f}" for height in found[1:5])
    text = f"drills to {heights} and so on, which are not the strokes of STEP in the CL file"
    yield motions.fault(_FIRST_STROKE, float(found[-1]), text)


def _distinct_heights(heights: Sequence[float], tolerance: float) -> Floats:
    """Falling heights without those that are as good as the next one, except for the last."""
    all_ = np.array(heights)
    return np.asarray(all_[np.append(all_[:-1] - all_[1:] > 2.0 * tolerance, True)])


def _step_heights(hole: Hole, begin: float) -> list[float]:
    """Heights to which STEP leads: the first stroke from ``begin``, each next one shorter, none below the shortest."""
    stroke, less, shortest = (*hole.cycle.pecks, 0.0, 0.0, 0.0)[:3]
    height, ends = begin, list[float]()
    while height > -hole.cycle.depth and stroke > 0.0 and len(ends) < _MAX_STROKES:
        height = max(height - stroke, -hole.cycle.depth)
        ends.append(height)
        stroke = stroke if stroke <= shortest else max(stroke - less, shortest)
    return ends
