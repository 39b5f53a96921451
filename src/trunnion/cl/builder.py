"""What the interpreter of a CL dialect writes down, in units of the file, until the end of the file settles them."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Lines
from trunnion.model.toolpath import Event, Frame, Sense, Tool


@dataclass(slots=True)
class MoveColumns:
    """The columns of the whole file, with room for ``n`` rows; operations are slices of them.

    Tip and axis are written while the file is scanned, the others when an operation is assembled.
    Untouched rows cost nothing: the system gives memory only to what was written.
    """

    tip: Floats
    axis: Floats
    kind: Codes
    phase: Codes
    feed: Floats
    per_rev: Flags
    line: Lines

    def grow(self) -> None:
        """Make room for half as many rows again."""
        for name in ("tip", "axis", "kind", "phase", "feed", "per_rev", "line"):
            old = getattr(self, name)
            new = np.empty((len(old) * 3 // 2 + 1, *old.shape[1:]), old.dtype)
            new[: len(old)] = old
            setattr(self, name, new)

    @staticmethod
    def allocate(n: int) -> "MoveColumns":
        """Return columns of ``n`` rows, not yet written."""
        return MoveColumns(
            tip=np.empty((n, 3)),
            axis=np.empty((n, 3)),
            kind=np.empty(n, np.uint8),
            phase=np.empty(n, np.uint8),
            feed=np.empty(n),
            per_rev=np.empty(n, np.bool_),
            line=np.empty(n, np.int32),
        )


@dataclass(frozen=True, slots=True)
class SurfaceSpeed(Event):
    """A spindle speed at the cutting edge, mm/min; the tool's diameter turns it into rev/min."""

    speed: float
    sense: Sense
    diameter: float | None


class FeedChange(NamedTuple):
    """A FEDRAT: ``value`` in mm/min or mm/rev, or in units of the file if it named none."""

    row: int
    value: float
    per_rev: bool
    in_file_units: bool


class CircleStatement(NamedTuple):
    """A CIRCLE: xc, yc, zc, i, j, k, r in units of the file, and the turns that it begins."""

    row: int
    line: int
    numbers: tuple[float, ...]
    turns: int


class FromStatement(NamedTuple):
    """A FROM: the tip, and the axis if one was given."""

    row: int
    line: int
    tip: tuple[float, float, float]
    axis: tuple[float, float, float] | None


@dataclass(slots=True)
class OperationBuilder:
    """An operation while it is read. Rows count from ``first``, the operation's first row in the columns."""

    name: str
    line: int
    first: int
    stop: int = 0
    tool: Tool = field(default_factory=Tool)
    frame: Frame = field(default_factory=Frame)
    intol: float | None = None
    outtol: float | None = None
    events: list[Event] = field(default_factory=list)
    feeds: list[FeedChange] = field(default_factory=list)
    colours: list[tuple[int, int]] = field(default_factory=list)
    rapids: list[int] = field(default_factory=list)
    circles: list[CircleStatement] = field(default_factory=list)
    starts: list[FromStatement] = field(default_factory=list)
