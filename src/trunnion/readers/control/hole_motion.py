"""What a drilling cycle does at one hole, as the motions of the virtual control."""

import math
from dataclasses import dataclass
from typing import Final

#: Faster feeds, mm/min, are none that a cycle means.
MAX_FEED: Final = 1e9

#: More pecks than this at one hole are a mistake.
MAX_PECKS: Final = 1000


class CycleExecutionError(Exception):
    """Why a cycle cannot be done, in words."""


@dataclass(frozen=True, slots=True)
class HoleMotion:
    """One motion at a hole.

    rapid     at rapid instead of at feed
    height    where to, along the drilling axis; None: stay
    feed      mm/min, or None: the feed in force; negative: that part of it
    aside     offsets in the first and second axis of the plane, mm, from the hole
    dwell     seconds to wait afterwards, negative: spindle turns
    turns     whole turns about the hole on the way, positive counter-clockwise
    """

    rapid: bool
    height: float | None
    feed: float | None = None
    lateral: tuple[float, float] = (0.0, 0.0)
    dwell: float = 0.0
    turns: int = 0


def finite(value: float | None) -> float | None:
    """Return a cycle's number, refusing what no program means."""
    if value is not None and not math.isfinite(value):
        raise CycleExecutionError("has a number that is none")
    return value
