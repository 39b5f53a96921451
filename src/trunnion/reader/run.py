"""What a control did with a program: one row a motion, in columns, and what happened between the rows.

Units: mm, degrees, unit vectors, rev/min; feeds in mm/min, mm/rev or 1/min as ``feed_mode`` says.
Frame: the workpiece frame of the machine, that is the zero point set by the work offset; programmable frames and
swivelled planes are already resolved to it.
"""

from dataclasses import dataclass, field
from enum import IntEnum, IntFlag

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Codes, Flags, Floats, Lines
from trunnion.errors import Severity
from trunnion.machine import Machine
from trunnion.toolpath import Arcs


class Written(IntFlag):
    """Words that a block really wrote, as bits of ``Run.programmed``."""

    X = 1
    Y = 2
    Z = 4
    FIRST = 8
    SECOND = 16
    VECTOR = 32
    FEED = 64


class Orientation(IntEnum):
    """How the tool axis moves between rows while TCP is on: angles linear, or the vector on a great circle."""

    ANGLES = 0
    GREAT_CIRCLE = 1


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that the reader did not know, could not do or finds odd; line from 1, in ``file``."""

    line: int
    text: str
    severity: Severity = Severity.ERROR
    file: str = ""

    def __str__(self) -> str:
        """Return ``file:line: severity: text``."""
        return f"{self.file}:{self.line}: {self.severity}: {self.text}"


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment of the program, without its semicolon, and the row before which it stands; file as in ``Run.file``."""

    line: int
    before_row: int
    text: str
    file: int = 0


Value = float | str | tuple[float | str | None, ...] | None


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that happens before row ``before_row`` (``before_row == n``: after the last one).

    kind    one of the names in ``docs/reader.md``: tool, tool_change, spindle, coolant, dwell, stop, message, ...
    value   a number, a text or the values of the cycle, as the kind has it
    file    as in ``Run.file``
    """

    line: int
    before_row: int
    kind: str
    value: Value = None
    file: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """A program as a machine's control ran it; columns have n rows and are read-only.

    block          (n,)   int32    line of the file, from 1
    file           (n,)   uint16   index into ``files``: 0 is the program itself, others are its subprograms
    number         (n,)   int64    N number of the block, -1 where it has none
    kind           (n,)   uint8    a ``trunnion.toolpath.Kind``
    programmed     (n,)   uint8    ``Written`` bits
    tip            (n, 3) float64  tool tip, mm, workpiece frame
    axis           (n, 3) float64  unit vector from tip to holder, workpiece frame
    joints         (n, 5) float64  axis values as displayed, mm or deg, machine order; rotary values as they wind
    feed           (n,)   float64  NaN before the first F; rapids carry it on
    feed_mode      (n,)   uint8    94 mm/min, 95 mm/rev, 93 inverse time (1/min)
    rpm            (n,)   float64  programmed spindle speed, 0 before the first S
    spindle        (n,)   int8     +1 M3, -1 M4, 0 off
    tool           (n,)   int32    index into ``tools``; 0 is the empty name, no tool yet
    edge           (n,)   int32    D number, -1 before the first D
    offset         (n,)   uint16   work offset 54..57, 505..599, 500 for none, 0 before the first
    tcp            (n,)   bool     TRAORI was on
    machine_frame  (n,)   bool     a SUPA, G53 or G153 block: positions of machine axes
    inches         (n,)   bool     lengths were programmed in inches (the columns are in mm)
    orientation    (n,)   uint8    an ``Orientation``: how the tool axis got here from the row before
    start          (5,)   float64  axis values before row 0
    """

    machine: Machine
    files: tuple[str, ...]
    block: Lines
    file: NDArray[np.uint16]
    number: NDArray[np.int64]
    kind: Codes
    programmed: Codes
    tip: Floats
    axis: Floats
    joints: Floats
    feed: Floats
    feed_mode: Codes
    rpm: Floats
    spindle: NDArray[np.int8]
    tool: Lines
    edge: Lines
    offset: NDArray[np.uint16]
    tcp: Flags
    machine_frame: Flags
    inches: Flags
    orientation: Codes
    start: Floats
    arcs: Arcs
    tools: tuple[str, ...] = ("",)
    comments: list[Comment] = field(default_factory=list)
    events: list[Happening] = field(default_factory=list)
    findings: tuple[Finding, ...] = ()

    def __post_init__(self) -> None:
        for name in self.__slots__:
            column = getattr(self, name)
            if isinstance(column, np.ndarray):
                column.setflags(write=False)

    def __len__(self) -> int:
        return len(self.block)

    @property
    def errors(self) -> tuple[Finding, ...]:
        """Findings that make the columns doubtful: words unknown or not acted upon."""
        return tuple(finding for finding in self.findings if finding.severity is Severity.ERROR)
