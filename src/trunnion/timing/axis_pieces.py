"""The axes of a machine while a run goes on, as pieces in which every axis moves evenly.

In:     a ``Run``, and the length of each tool.
Out:    axis values at the ends of the pieces, chunk after chunk.
Units:  mm and degrees.

``row_interpolation`` says into how many pieces a block is cut.

The slides stand where the real tool length puts them: a run was read with one length for all tools, or none.
"""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.errors import InputError, Problem
from trunnion.machines.links import link_chain
from trunnion.messages import Wording
from trunnion.model.machine_slides import at_machine
from trunnion.model.run import Run
from trunnion.model.stated_tips import StatedTips, turns_without_tcp
from trunnion.model.unknown_setups import rows_elsewhere, stated_rows
from trunnion.records import dataclass
from trunnion.timing.row_interpolation import RowInterpolation

#: Pieces of a program that is kept whole, as who keeps it says: some 2 GB of motion in time. A loop of ten lines may
#: make hundreds of millions; those of programs for parts have about one for each block.
MOST_PIECES: Final = 3_000_000


@dataclass(frozen=True, slots=True, eq=False)
class AxisPieces:
    """Consecutive pieces of a run.

    first, end  rows that they belong to
    row         (k,)      row of each piece
    begin       (k,)      part of the row that is done where the piece begins
    done        (k,)      and where it ends
    joints      (k + 1, 5)  axis values before the first piece and after each; mm or deg, machine order
    tool        (k,)      index of the tool in ``Run.tools``
    known       (k,)      where the tool is at the workpiece is known: no coordinate of it is left unstated
    at_machine  (k,)      a slide begins or ends where coordinates of the machine put it, or nothing else has
    """

    first: int
    end: int
    row: Ints
    begin: Floats
    done: Floats
    joints: Floats
    tool: Ints
    known: Flags
    at_machine: Flags


def axis_pieces(
    run: Run, lengths: Mapping[int, float], end: int | None = None, most: int | None = None
) -> Iterator[AxisPieces]:
    """Yield the motion of all rows, some thousands of them at a time.

    run      the run
    lengths  of tools, from tip to gauge point, mm, by their index in ``Run.tools``; others have that of the machine
    end      the first row that is left out; None: none is
    most     how many pieces there may be; None: any number

    Raises
    ------
    InputError
        At the block with which there are more.
    """
    rows = len(run) if end is None else min(end, len(run))
    motion = _Motion(run, lengths, most)
    for first, last in run.chunk_bounds(rows):
        yield motion.pieces(first, last)


class _Motion:
    """Walks through a run and knows where the axes stand."""

    def __init__(self, run: Run, lengths: Mapping[int, float], most: int | None) -> None:
        self.run, self.lengths = run, lengths
        self._most, self._made = most, 0
        self.read_with = 0.0
        self.joints = np.array(run.start, np.float64)
        self.from_machine = np.ones(3, np.bool_)
        self._inside = RowInterpolation(run)
        self._stated_length, self._elsewhere = stated_rows(run)[1], rows_elsewhere(run)
        self._slides = np.array([run.machine.column(name) for name in "XYZ"])
        chain = link_chain(run.machine)
        # What moves the gauge point along the spindle, all rotary axes at zero.
        self._along = np.linalg.solve(chain.direction[self._slides].T, np.array(run.machine.spindle_direction))

    def pieces(self, first: int, end: int) -> AxisPieces:
        """Return the pieces of rows, which follow those of the last call."""
        run, n = self.run, end - first
        self.read_with = self._inside.take_rows(first).tool_length or 0.0
        tool = run.state.tool.part(first, end).astype(np.int64)
        length = np.array([self.lengths.get(int(k), self.read_with) for k in tool.tolist()]) if n else np.zeros(0)
        xyz_is_tip = run.state.xyz_is_tip.part(first, end)
        began_at_machine = self.from_machine.any(keepdims=True)
        machine = self._from_machine(first, end, xyz_is_tip)
        joints = self._row_joints(first, end, xyz_is_tip, length, machine)
        tips = StatedTips.of(run)
        known = tips.before[first:end] & tips.after[first:end]
        if run.machine.workpiece_zero is None:
            known &= ~turns_without_tcp(run, np.arange(first, end))
        else:  # with its real length, the tool's place follows from the slides
            known |= ~xyz_is_tip & self._has_length(first, end, tool) & ~self._elsewhere[first:end]
        before = np.concatenate((self.joints[None], joints))
        for lost in np.flatnonzero(~np.isfinite(joints).all(axis=1)).tolist():
            before[lost + 1] = before[lost]  # the reader has said that no position is known there
        counts = self._inside.counts(first, before, length)
        self._check_count(first, counts)
        row, begin, done, along = self._inside.pieces(first, before, length, counts)
        start, self.joints = self.joints, before[-1].copy()
        along = np.concatenate((start[None], along))
        ends = machine.any(axis=1)
        at_machine = ends | np.concatenate((began_at_machine, ends))[:-1]
        if not run.machine.spindle_point_is_stated:
            strict = StatedTips.of(run, needs_gauge_point=True)
            stated = ~xyz_is_tip & self._has_length(first, end, tool) & ~ends
            at_machine |= ~(stated | (strict.before[first:end] & strict.after[first:end]))
        return AxisPieces(first, end, row + first, begin, done, along, tool[row], known[row], at_machine[row])

    def _check_count(self, first: int, counts: Ints) -> None:
        """Count pieces before they are made, those of the rows from ``first`` on."""
        made = self._made + np.cumsum(counts)
        self._made = int(made[-1]) if len(made) else self._made
        if self._most is not None and self._made > self._most:
            row = first + int(np.searchsorted(made, self._most, "right"))
            file = self.run.files[int(self.run.state.file[row])]
            raise InputError(
                Problem(file, int(self.run.lines[row]), Wording("TWN112", "where_program_makes", most=self._most))
            )

    def _has_length(self, first: int, end: int, tool: Ints) -> Flags:
        """Which rows have a tool of which somebody has stated the length, (n,)."""
        given = np.array([bool(self.lengths.get(int(k))) for k in tool.tolist()], np.bool_)
        return np.asarray(given | self._stated_length.part(first, end))

    def _row_joints(self, first: int, end: int, xyz_is_tip: Flags, length: Floats, machine: Flags) -> Floats:
        """Axis values at the end of rows, with the real lengths of tools."""
        run = self.run
        xyz, rotary = run.xyz[first:end], run.rotary[first:end]
        joints = np.empty((end - first, 5))
        for each in distinct(length).tolist():
            of = length == each
            joints[of] = self._inside.solved(each, xyz_is_tip[of], xyz[of], rotary[of])
        from_work = ~xyz_is_tip & self._active(first, end)
        longer = np.where(from_work, length - self.read_with, 0.0)
        joints[:, self._slides] += np.where(machine, 0.0, longer[:, None] * self._along)
        return joints

    def _from_machine(self, first: int, end: int, xyz_is_tip: Flags) -> Flags:
        """Which slides stand where coordinates of the machine have put them, (n, 3)."""
        words, frame = self.run.programmed[first:end], self.run.state.machine_frame.part(first, end)
        found = at_machine(words, frame, xyz_is_tip, self.from_machine)
        if end > first:
            self.from_machine = found[-1].copy()
        return found

    def _active(self, first: int, end: int) -> Flags:
        """Where the control counts the length of the tool."""
        edge = self.run.state.edge.part(first, end)
        return np.asarray(edge > 0 if self.run.uses_length_numbers else edge != 0)
