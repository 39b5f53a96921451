"""What is wrong with the pecks of a hole: rapids in solid material, wrong pecks, wrong retracts between them.

Heights are as in ``trunnion.verification.expected.holes``.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.drill_motions import DrillMotions, HoleFault
from trunnion.verification.expected.holes import Hole

#: How far ``post`` lifts a tool to break chips by motions, mm, and no farther than half of what is drilled.
REENTRY_CLEARANCE: Final = 0.5

#: No hole has more pecks.
_MAX_PECKS: Final = 100_000

#: A retract by less than this breaks the chip without leaving the hole, mm.
_CHIP_BREAK: Final = 5.0

#: Behind a full retract motions of the program feed no farther than this through what is drilled, mm.
_MOST_AT_FEED: Final = 3.0

#: A last peck no longer than this may go with the one before, mm: programs may print no less.
_SHORTEST_REST: Final = 0.005

#: The row at which faults of the pecks together are named: the first one into the hole.
_FIRST_PECK: Final = 2


def peck_faults(hole: Hole, motions: DrillMotions) -> Iterator[HoleFault]:
    """Rapids stay above what is drilled; pecks and the retracts between them are those of the cycle."""
    pecks = list[float]()
    between = list[list[int]]()
    yield from _collect_pecks(hole, motions, pecks, between)
    if motions.by_motion:
        whole = [k for k, rows in enumerate(between) if rows or k + 1 == len(pecks)]
        joined = [pecks[k] for k in whole]
        # A line may be made in pieces: those of STEP are the pecks where they are right together.
        if not hole.cycle.pecks or next(_programmed_pecks(hole, motions, joined), None) is None:
            pecks, between = joined, [between[k] for k in whole]
    if not hole.cycle.pecks:
        if len(pecks) > 1:
            yield motions.fault(_FIRST_PECK, float(len(pecks)), Wording("holes", "pecks", count=len(pecks)))
        return
    yield from (_programmed_pecks if motions.by_motion else _cycle_pecks)(hole, motions, pecks)
    for end, rows in zip(pecks, between[:-1], strict=False):
        top = max((float(motions.height[k]) for k in rows), default=-math.inf)
        full, back = abs(top - hole.cycle.clearance) <= hole.tolerance, top - end
        if not rows or full != ("DEEP" in hole.cycle.mode) or (not full and back > _CHIP_BREAK):
            how = "not_back" if not rows else "back_all_the_way" if full else "back_a_little"
            yield motions.fault(_FIRST_PECK, top, Wording("holes", how))
            break


def _collect_pecks(
    hole: Hole, motions: DrillMotions, pecks: list[float], between: list[list[int]]
) -> Iterator[HoleFault]:
    """Fill in the heights at which pecks end, and the motions after each one; faults of single motions."""
    deepest, bottom = hole.cycle.clearance, motions.bottom
    for k in range(1, len(motions.row)):
        height, kind = float(motions.height[k]), motions.kind[k]
        if kind == Kind.RAPID and height < deepest - hole.tolerance:
            yield motions.fault(k, height, Wording("holes", "rapid_in_solid"))
        elif kind == Kind.LINEAR and height < deepest - 1e-9:
            start = float(motions.height[k - 1])
            was_out = _was_out(hole, motions, between)
            if motions.by_motion and was_out and start - deepest > _MOST_AT_FEED:
                yield motions.fault(k, height, Wording("holes", "no_rapid_back", way=start - deepest))
            pecks.append(height)
            between.append([])
        elif motions.by_motion and kind == Kind.LINEAR and k <= bottom:
            yield motions.fault(k, height, Wording("holes", "feed_in_air"))
        elif between:
            between[-1].append(k)
        deepest = min(deepest, height)


def _was_out(hole: Hole, motions: DrillMotions, between: Sequence[Sequence[int]]) -> bool:
    """Whether the tool has been out of the hole since the last peck: the way back in is made at rapid then."""
    return any(motions.height[k] >= hole.cycle.clearance - hole.tolerance for rows in between[-1:] for k in rows)


def _cycle_pecks(hole: Hole, motions: DrillMotions, ends: list[float]) -> Iterator[HoleFault]:
    """Pecks of a cycle: the first as deep as STEP says, the others no deeper, and equal if STEP makes them so."""
    # Pecks count from the CL point, or from where the feed begins.
    from_point = not ends or abs(ends[0] + min(hole.cycle.pecks[0], hole.cycle.depth)) <= hole.tolerance
    begin = 0.0 if from_point else hole.cycle.clearance
    first = min(hole.cycle.pecks[0], begin + hole.cycle.depth)
    pecks = np.abs(np.diff([begin, *(ends or [hole.cycle.clearance])]))
    if abs(pecks[0] - first) > hole.tolerance or (np.diff(pecks) > hole.tolerance).any():
        said = Wording("holes", "other_pecks", pecks=tuple(f"{peck:.4f}" for peck in pecks[:4]), first=first)
        yield motions.fault(_FIRST_PECK, float(pecks[0]), said)
    less = (*hole.cycle.pecks, 0.0)[1]
    if not less and len(pecks) > 2 and abs(pecks[:-1] - first).max() > hole.tolerance:
        yield motions.fault(_FIRST_PECK, float(pecks.min()), Wording("holes", "unequal_pecks", first=first))
    if less:
        yield from _shorter_pecks(hole, motions, pecks)


def _shorter_pecks(hole: Hole, motions: DrillMotions, pecks: Floats) -> Iterator[HoleFault]:
    """Pecks that STEP makes shorter one by one: the last two may share what is left, as controls divide it."""
    less, shortest = (*hole.cycle.pecks, 0.0, 0.0)[1:3]
    wanted = np.maximum(pecks[0] - less * np.arange(len(pecks)), min(shortest or less, pecks[0]))
    alone = max(len(pecks) - 2, 0)
    apart = np.abs(pecks - wanted)
    apart[alone:] = np.maximum(pecks[alone:] - wanted[alone:], 0.0)
    if apart.max() <= hole.tolerance:
        return
    k = int(np.argmax(apart > hole.tolerance))
    said = Wording("holes", "other_decrement", count=k + 1, peck=pecks[k], wanted=wanted[k])
    yield motions.fault(_FIRST_PECK, float(pecks[k]), said)


def odd_lifts(hole: Hole, motions: DrillMotions) -> Iterator[tuple[int, float]]:
    """Yield rows of motions of the program that lift the tool to break chips, and how far, mm.

    Only where that is not what ``post`` does: no CL file says how far.
    """
    if not (motions.by_motion and "BRKCHP" in hole.cycle.mode):
        return
    height = motions.height
    for k in range(1, len(height)):
        lift, drilled = float(height[k] - height[k - 1]), -float(height[k - 1])
        inside = height[k] < hole.cycle.clearance - hole.tolerance
        usual = min(REENTRY_CLEARANCE, 0.5 * drilled)
        if motions.kind[k] == Kind.RAPID and inside and lift > hole.tolerance and abs(lift - usual) > hole.tolerance:
            yield int(motions.row[k]), lift


def _programmed_pecks(hole: Hole, motions: DrillMotions, ends: list[float]) -> Iterator[HoleFault]:
    """Pecks that the program has itself are those of STEP, one by one: counted from the CL point, or from RAPTO."""
    found = np.array([hole.cycle.clearance, *ends])
    for begin, rest in product((0.0, hole.cycle.clearance), (0.0, _SHORTEST_REST)):
        wanted = np.array([hole.cycle.clearance, *_step_heights(hole, begin, rest)])
        if _all_near(found, wanted, hole.tolerance) and _all_near(wanted, found, hole.tolerance):
            return
    depths = tuple(f"{-height:.4f}" for height in found[1:5])
    yield motions.fault(_FIRST_PECK, float(found[-1]), Wording("holes", "other_heights", depths=depths))


def _all_near(heights: Floats, falling: Floats, tolerance: float) -> bool:
    """Whether each height is one of the falling heights (n,), as near as they are printed: n >= 1."""
    after = np.searchsorted(-falling, -heights).clip(0, len(falling) - 1)
    nearest = np.minimum(np.abs(heights - falling[after]), np.abs(heights - falling[np.maximum(after - 1, 0)]))
    return bool((nearest <= tolerance).all())


def _step_heights(hole: Hole, begin: float, rest: float) -> list[float]:
    """Heights to which STEP leads: the first peck from ``begin``, each next one shorter, none below the shortest; what
    is left goes with the peck before if it is no more than ``rest``.
    """
    peck, less, shortest = (*hole.cycle.pecks, 0.0, 0.0, 0.0)[:3]
    height, ends = begin, list[float]()
    while height > -hole.cycle.depth and peck > 0.0 and len(ends) < _MAX_PECKS:
        height = max(height - peck, -hole.cycle.depth)
        ends.append(height)
        peck = peck if peck <= shortest else max(peck - less, shortest)
    if len(ends) > 1 and ends[-2] - ends[-1] <= rest:
        del ends[-2]
    return ends
