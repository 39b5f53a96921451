"""The rows of a path as placing takes them."""

from collections.abc import Sequence
from dataclasses import field, replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.model.arc_extremes import ArcPaths
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class Stretch:
    """Rows that follow each other at the workpiece, such as those of one operation.

    first      its first row
    file       that its lines are of
    operation  empty: it has no name
    tool       that CL files load for it; empty: none, or the rows say it
    """

    first: int
    file: str
    operation: str = ""
    tool: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class PathRows:
    """A path of n rows, in the workpiece frame.

    tip       (n, 3) mm
    axis      (n, 3) unit vectors from tip to holder
    branch    (n,) uint8: the solution of the inverse map that the planner, or the program, takes
    line      (n,) int64: of the stretch's file
    straight  (n,) bool: the tip goes straight to the row while rotary axes turn (TCP); else the slides do
    seconds   (n,) the time of the way to the row at the programmed feed; 0: at rapid, or as the axes can
    stretches in the order of their rows
    start     (m, 2) positions of the rotary axes before each stretch, degrees
    arcs, arc_row  the arcs among the ways to rows, and those rows
    length    (n,) of the tools, gauge point to tip, mm; NaN, and None for all: that of the machine
    """

    tip: Floats
    axis: Floats
    branch: Codes
    line: Ints
    straight: Flags
    seconds: Floats
    stretches: tuple[Stretch, ...]
    start: Floats
    arcs: ArcPaths
    arc_row: Ints
    length: Floats | None = None
    _firsts: Ints = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_firsts", np.array([stretch.first for stretch in self.stretches], np.int64))

    def __len__(self) -> int:
        return len(self.tip)

    @property
    def begins(self) -> Flags:
        """Whether a row is the first of its stretch, (n,)."""
        flags = np.zeros(len(self), np.bool_)
        flags[self._firsts] = True
        return flags

    def length_at(self, rows: Ints) -> Floats | None:
        """Return the lengths of the tools in some rows, (k,) mm."""
        return None if self.length is None else self.length[rows]

    def stretch_of(self, row: int) -> Stretch:
        """Return the stretch of a row."""
        return self.stretches[int(np.searchsorted(self._firsts, row, "right")) - 1]

    def turned(self, turn: Floats) -> "PathRows":
        """Return the path of the part turned about the origin of the workpiece frame by a matrix (3, 3)."""
        if np.array_equal(turn, np.eye(3)):
            return self
        arcs, turn = self.arcs, turn.T
        return replace(
            self,
            tip=self.tip @ turn,
            axis=self.axis @ turn,
            arcs=ArcPaths(arcs.start @ turn, arcs.end @ turn, arcs.centre @ turn, arcs.normal @ turn, arcs.full_turns),
        )

    def with_branch(self, branch: int) -> "PathRows":
        """Return the path with all rows in one branch."""
        return replace(self, branch=np.full(len(self), branch, np.uint8))

    def select(self, keep: Flags) -> "PathRows":
        """Return some rows, (n,) bool, in the stretches that they are in."""
        rows = np.flatnonzero(keep)
        owner = np.searchsorted(self._firsts, rows, "right") - 1
        firsts = np.flatnonzero(np.diff(owner, prepend=-1) > 0)
        arc = np.flatnonzero(keep[self.arc_row])
        return PathRows(
            self.tip[rows], self.axis[rows], self.branch[rows], self.line[rows], self.straight[rows],
            self.seconds[rows],
            tuple(replace(self.stretches[owner[first]], first=first) for first in firsts.tolist()),
            self.start[owner[firsts]], self.arcs.select(arc), np.searchsorted(rows, self.arc_row[arc]),
            self.length_at(rows),
        )  # fmt: skip


def joined_rows(parts: Sequence[PathRows]) -> PathRows:
    """Paths one after the other, whose tools have no lengths yet."""
    firsts = np.cumsum([0, *(len(part) for part in parts)]).tolist()[:-1]
    arcs = [part.arcs for part in parts]
    return PathRows(
        tip=np.concatenate([part.tip for part in parts]),
        axis=np.concatenate([part.axis for part in parts]),
        branch=np.concatenate([part.branch for part in parts]),
        line=np.concatenate([part.line for part in parts]),
        straight=np.concatenate([part.straight for part in parts]),
        seconds=np.concatenate([part.seconds for part in parts]),
        stretches=tuple(
            replace(stretch, first=stretch.first + first)
            for part, first in zip(parts, firsts, strict=True)
            for stretch in part.stretches
        ),
        start=np.concatenate([part.start for part in parts]),
        arcs=ArcPaths(
            np.concatenate([one.start for one in arcs]),
            np.concatenate([one.end for one in arcs]),
            np.concatenate([one.centre for one in arcs]),
            np.concatenate([one.normal for one in arcs]),
            np.concatenate([one.full_turns for one in arcs]),
        ),
        arc_row=np.concatenate([part.arc_row + first for part, first in zip(parts, firsts, strict=True)]),
    )


def no_arcs() -> ArcPaths:
    """No arcs at all."""
    none = np.zeros((0, 3))
    return ArcPaths(none, none, none, none, np.zeros(0, np.int64))
