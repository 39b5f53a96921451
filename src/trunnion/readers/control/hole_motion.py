"""The motions of a drilling cycle at one hole."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.worded_error import WordedError
from trunnion.records import dataclass

#: Faster feeds, mm/min, are mistakes of the program.
MAX_FEED: Final = 1e9

#: Gaps in a hole are the same within this, mm: programs in inches print no finer.
SAME_GAP: Final = 0.003

#: More pecks than this at one hole are a mistake of the program.
MAX_PECKS: Final = 1000


class CycleExecutionError(WordedError):
    """The reason why a cycle cannot be executed; the message continues "the cycle"."""


@dataclass(frozen=True, slots=True, eq=False)
class HoleMotion:
    """One motion at a hole; lengths in the units of the program.

    rapid    at rapid instead of at feed
    height   position along the drilling axis at the end; None: stay
    feed     mm/min; None: the feed in force; negative: that fraction of the feed in force
    lateral  offsets from the hole in the first and second axis of the plane
    dwell    seconds to wait afterwards; negative: spindle revolutions
    turns    whole turns about the hole on the way, positive counter-clockwise
    """

    rapid: bool
    height: float | None
    feed: float | None = None
    lateral: tuple[float, float] = (0.0, 0.0)
    dwell: float = 0.0
    turns: int = 0

    def with_lengths_in(self, unit: float) -> "HoleMotion":
        """Return the motion with its lengths, now mm, in a unit of so many mm."""
        if unit == 1.0:
            return self
        height = None if self.height is None else self.height / unit
        return replace(self, height=height, lateral=(self.lateral[0] / unit, self.lateral[1] / unit))


#: The height of a depth; and the motions from a depth on before the next feed.
Height = Callable[[float], float]
Between = Callable[[float], list[HoleMotion]]


def check_pecks(depth: float, peck: float, word: str) -> None:
    """Refuse pecks, given by ``word``, that would not get to a depth within ``MAX_PECKS`` pecks."""
    if peck <= 0.0:
        raise CycleExecutionError(Wording("NC380", "not_above_zero", word=word))
    if depth / peck > MAX_PECKS:
        raise CycleExecutionError(Wording("NC380", "too_many_pecks", most=MAX_PECKS))


def peck_depths(total: float, first: float, less: float = 0.0, least: float = 0.0) -> list[float]:
    """Return the depths of the pecks: each peck is shorter by ``less``, but not shorter than ``least``.

    A first peck that is not positive, or longer than the total, is the total.
    """
    if not 0.0 < first < total:
        return [total]
    depths = [first]
    peck = first
    while total - depths[-1] > 1e-9:
        peck = max(peck - less, least)
        if peck <= 0.0 or len(depths) >= MAX_PECKS:
            raise CycleExecutionError(Wording("NC380", "too_many_pecks", most=MAX_PECKS))
        depths.append(min(depths[-1] + peck, total))
    depths[-1] = total
    return depths


def full_retract(top: float, height: Height, gap: float, *, dwell: float = 0.0, least: float = -math.inf) -> Between:
    """Return a retract to a height, with a dwell, and the approach to a gap above the depth, from ``least`` on."""
    return lambda depth: [HoleMotion(True, top, dwell=dwell), HoleMotion(True, height(max(depth - gap, least)))]


def chip_break(
    height: Height, gap: float, feed: float | None = None, *, rapid: bool = False, least: float = -math.inf
) -> Between:
    """Return the way back by a gap, no farther than to the depth ``least``."""
    return lambda depth: [HoleMotion(rapid, height(max(depth - gap, least)), feed)]


def descent(
    depths: Sequence[float],
    height: Height,
    between: Between,
    feed: float | None = None,
    dwells: tuple[float, float] = (0.0, 0.0),
) -> list[HoleMotion]:
    """Return the feeds from depth to depth, and what is between two of them.

    feed     as that of ``HoleMotion``
    dwells   after a peck, and after the last one
    """
    motions: list[HoleMotion] = []
    for count, depth in enumerate(depths, 1):
        if motions:
            motions += between(depths[count - 2])
        motions.append(HoleMotion(False, height(depth), feed, dwell=dwells[count == len(depths)]))
    return motions


def finite(value: float | None) -> float | None:
    """Return a number of a cycle; refuse infinity and NaN."""
    if value is not None and not math.isfinite(value):
        raise CycleExecutionError(Wording("NC380", "number_not_finite"))
    return value
