"""The motions that make one hole: pecks, returns to clear the chips, and the retract."""

from typing import Final

from trunnion.messages import Wording
from trunnion.model.toolpath import Kind
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod
from trunnion.records import dataclass

#: A rapid back into a hole ends this far above the drilled depth, and a chip-breaking peck returns as far, mm.
REENTRY_CLEARANCE: Final = 0.5

#: Heights are the same if they differ by no more than this, mm.
SAME_HEIGHT: Final = 1e-9

#: The peck before the last one goes on to the depth if no more than this is left, mm: programs may print no less.
SHORTEST_REST: Final = 0.005

#: The most pecks that a hole may have.
_MOST_PECKS: Final = 10_000


@dataclass(frozen=True, slots=True)
class HoleMotions:
    """The motions in a hole from the height of RAPTO on, in their order.

    heights  to which they lead, mm
    bottom   index of the one that reaches the bottom
    """

    heights: tuple[float, ...]
    kinds: tuple[Kind, ...]
    bottom: int


def hole_motions(cycle: Cycle) -> HoleMotions:
    """Return the motions of a cycle whose retract height is known.

    Raises ``HoleCycleError`` when its pecks never reach the depth.
    """
    assert cycle.retract_height is not None
    motions: list[tuple[float, Kind]] = []
    drilled = 0.0
    for number, depth in enumerate(peck_depths(cycle)):
        if number and cycle.method is HoleMethod.DEEP_DRILLING:
            motions.append((cycle.rapid_height, Kind.RAPID))
            if REENTRY_CLEARANCE - drilled < cycle.rapid_height - SAME_HEIGHT:
                motions.append((REENTRY_CLEARANCE - drilled, Kind.RAPID))
        elif number:
            motions.append((min(REENTRY_CLEARANCE, 0.5 * drilled) - drilled, Kind.RAPID))
        motions.append((-depth, Kind.LINEAR))
        drilled = depth
    bottom = len(motions) - 1
    if cycle.method is HoleMethod.REAM:
        motions.append((cycle.rapid_height, Kind.LINEAR))
    if cycle.method is not HoleMethod.REAM or cycle.retract_height > cycle.rapid_height + SAME_HEIGHT:
        motions.append((cycle.retract_height, Kind.RAPID))
    return HoleMotions(tuple(height for height, _ in motions), tuple(kind for _, kind in motions), bottom)


def peck_depths(cycle: Cycle) -> list[float]:
    """Return the depths below the point of the hole, mm, at which the pecks end.

    Raises ``HoleCycleError`` when the pecks never reach the depth, or there are too many.
    """
    if cycle.method not in (HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING):
        return [cycle.depth]
    peck, decrement, shortest = cycle.pecks
    if decrement < 0.0 or shortest < 0.0:
        raise HoleCycleError(Wording("PLN620", "step_number_below"))
    depths = [min(peck, cycle.depth)]
    while cycle.depth - depths[-1] > SHORTEST_REST:
        peck = max(peck - decrement, min(shortest, peck))
        if not peck > 0.0:
            raise HoleCycleError(Wording("PLN610", "step_without_shortest"))
        if len(depths) >= _MOST_PECKS:
            raise HoleCycleError(Wording("PLN620", "hole_more_pecks", most_pecks=_MOST_PECKS))
        depths.append(min(depths[-1] + peck, cycle.depth))
    return [*depths[:-1], cycle.depth]
