"""What the spindle does in a hole besides turning: threads, oriented and stopped bores."""

import math
from enum import StrEnum

from trunnion.records import dataclass


class SpindleTask(StrEnum):
    """What the spindle does in a hole besides turning, by the words of ``CYCLE``."""

    TAP = "TAP"
    STOP = "BORE,DRAG"
    LIFT = "BORE,NODRAG"
    MANUAL = "BORE,MANUAL"


@dataclass(frozen=True, slots=True)
class SpindleWork:
    """How a cycle drives the spindle: motions alone do not make such a hole.

    pitch        of a thread, mm; NaN: it follows from feed and speed
    hand         of a thread: 1 right, -1 left, 0 that of the spindle
    rpm          0: the programmed speed
    floating     the cycle is for a compensating chuck
    stroke       a thread in strokes of this length, mm; 0: in one
    full         between strokes the tool leaves the hole
    clearance    from the surface of the hole up to where the feed begins, mm
    after        sense in which the spindle turns after it: 1, -1, 0 for standing; None: as before
    """

    task: SpindleTask
    pitch: float = math.nan
    hand: int = 0
    rpm: float = 0.0
    floating: bool = False
    stroke: float = 0.0
    full: bool = False
    clearance: float = 0.0
    after: int | None = None


@dataclass(frozen=True, slots=True)
class SpindleHole:
    """A hole whose cycle drives the spindle: rows ``first`` to ``end`` (exclusive); ``file`` as in ``Run.file``."""

    first: int
    end: int
    line: int
    file: int
    work: SpindleWork
