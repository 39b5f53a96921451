"""A recording: what a running machine showed, as columns over time.

Units: mm and degrees as the machine shows them, rev/min; times in microseconds since 1970, UTC.
"""

from collections.abc import Mapping
from enum import StrEnum
from pathlib import PurePath
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.records import dataclass

#: A time that was not stated.
NO_TIME: Final = -1

#: Columns of the spindle's speed, rev/min, of the line that runs, and of the file that it is in.
SPINDLE: Final = "spindle"
LINE: Final = "line"
PROGRAM: Final = "program"

#: Columns of the tool tip in the workpiece frame, mm, where a recording has that in place of the slides.
TIP: Final = ("tip_x", "tip_y", "tip_z")


class Mark(StrEnum):
    """What is odd before a row of a recording.

    GAP   the connection was broken: what the machine did since the row before is not known
    LOST  the server dropped values, as its queue was full
    BACK  the clock of the machine went backwards
    JUMP  the clock of the machine jumped ahead
    """

    GAP = "gap"
    LOST = "lost"
    BACK = "back"
    JUMP = "jump"


@dataclass(frozen=True, slots=True, eq=False)
class TextColumn:
    """A column of texts that change seldom: ``names[codes]``; an empty text where none is known."""

    codes: Ints
    names: tuple[str, ...]

    def __getitem__(self, row: int) -> str:
        return self.names[int(self.codes[row])]


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """What a machine showed, in the order in which it became known; n rows.

    file      where it was read from
    source    (n,) int64  when the machine had the values; ``NO_TIME`` where it did not say so, and in gaps
    received  (n,) int64  when they arrived, by the clock of the computer that recorded them
    marks     by row, in order
    values    numbers by the names of their columns, (n,) float64, NaN where not known
    texts     texts by the names of their columns
    """

    file: str
    source: Ints
    received: Ints
    marks: Mapping[int, tuple[Mark, ...]]
    values: Mapping[str, Floats]
    texts: Mapping[str, TextColumn]

    def __len__(self) -> int:
        return len(self.source)

    @property
    def name(self) -> str:
        """Name of the file, without its folder."""
        return PurePath(self.file).name

    def marked(self, *wanted: Mark) -> Flags:
        """Which rows have one of some marks, (n,)."""
        found = np.zeros(len(self), np.bool_)
        found[[row for row, marks in self.marks.items() if set(marks) & set(wanted)]] = True
        return found

    def elapsed(self) -> Floats:
        """Seconds from the first row to each, (n,), never falling.

        By the clock of the machine; across gaps, and where that clock was set, by that of the computer that recorded.
        """
        if not len(self):
            return np.zeros(0)
        by_source = np.diff(self.source, prepend=self.source[:1])
        by_arrival = np.diff(self.received, prepend=self.received[:1])
        is_stated = self.source != NO_TIME
        usable = is_stated & np.concatenate((is_stated[:1], is_stated[:-1])) & ~self.marked(Mark.BACK, Mark.JUMP)
        return np.asarray(np.cumsum(np.maximum(np.where(usable, by_source, by_arrival), 0)) / 1e6)
