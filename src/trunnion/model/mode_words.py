"""Modes that a program says, which another may have left otherwise."""

from typing import Final

from trunnion.records import dataclass

#: The mode that says where cycles end, which counts for a cycle alone.
END_OF_CYCLES: Final = "end of cycles"

#: Modes that count within radius compensation alone.
WAY_TO_CONTOUR: Final = "way to the contour"
CORNERS: Final = "corners of the contour"
BOTTLENECKS: Final = "bottlenecks of the contour"
FEED_ALONG: Final = "where the feed counts"
CONSTANT_FEED: Final = "constant compensation"
DIMENSIONS: Final = "dimensions of compensation"
OF_COMPENSATION: Final = frozenset({WAY_TO_CONTOUR, CORNERS, BOTTLENECKS, FEED_ALONG, CONSTANT_FEED, DIMENSIONS})

#: The mode that says by what the tool axis is programmed under TCP: rotary words or vectors, and in which frame.
TOOL_AXIS: Final = "tool axis under TCP"

#: Modes that count under TCP alone; the other one is how fast the linear axes may follow the rotary ones.
FOLLOWING: Final = "compensating motions"
UNDER_TCP: Final = frozenset({TOOL_AXIS, FOLLOWING})


@dataclass(frozen=True, slots=True)
class ModeWord:
    """A mode that holds from row ``before_row`` on because the program says so.

    mode  what it is of, such as ``plane``
    word  the word that holds; empty where the path shows which one: then it matters only that there is one
    """

    before_row: int
    mode: str
    word: str = ""
