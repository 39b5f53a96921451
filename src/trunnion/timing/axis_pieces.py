"""The axes of a machine while a run goes on, as pieces in which every axis moves evenly.

In:     a ``Run``, and the length of each tool.
Out:    axis values at the ends of the pieces, chunk after chunk.
Units:  mm and degrees.

Without TCP a block is one piece. With TCP the tip moves on its line or circle while the rotary axes turn: such a block
is cut until the axes, moving evenly in each piece, are nowhere further than ``SAG`` from where the control has them.

The slides stand where the real tool length puts them: a run was read with one length for all tools, or none.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine, forward, kinematic_parameters
from trunnion.machines.links import link_chain
from trunnion.model.axis_positions import RotaryWords, joints_from_rows, resolve_angles
from trunnion.model.run import CHUNK_ROWS, Orientation, ProgrammedWord, Run
from trunnion.model.stated_tips import StatedTips, turns_without_tcp
from trunnion.model.subdivision import circle_points, slerp
from trunnion.model.toolpath import Kind

#: How far an axis may be from where the control has it within a piece, mm; rotary axes count at ``_REACH`` mm.
SAG: Final = 0.02

_REACH: Final = 500.0

#: No block is cut into more pieces.
_MOST_PIECES: Final = 4096

_POSITION_WORDS: Final = int(
    ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.FIRST | ProgrammedWord.SECOND
)


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
    """

    first: int
    end: int
    row: Ints
    begin: Floats
    done: Floats
    joints: Floats
    tool: Ints
    known: Flags


def axis_pieces(run: Run, lengths: Mapping[int, float], end: int | None = None) -> Iterator[AxisPieces]:
    """Yield the motion of all rows, some thousands of them at a time.

    run      the run
    lengths  of tools, from tip to gauge point, mm, by their index in ``Run.tools``; others have that of the machine
    end      the first row that is left out; None: none is
    """
    rows = len(run) if end is None else min(end, len(run))
    motion = _Motion(run, lengths)
    for first in range(0, rows, CHUNK_ROWS):
        yield motion.pieces(first, min(first + CHUNK_ROWS, rows))


class _Motion:
    """Walks through a run and knows where the axes stand."""

    def __init__(self, run: Run, lengths: Mapping[int, float]) -> None:
        self.run, self.lengths = run, lengths
        self.read_with = run.machine.tool_length or 0.0
        self.joints = np.array(run.start, np.float64)
        self.from_machine = np.ones(3, np.bool_)
        self._machines: dict[float, Machine] = {}
        self._slides = np.array([run.machine.column(name) for name in "XYZ"])
        chain = link_chain(run.machine)
        # What moves the gauge point along the spindle, all rotary axes at zero.
        self._along = np.linalg.solve(chain.direction[self._slides].T, np.array(run.machine.spindle_direction))

    def pieces(self, first: int, end: int) -> AxisPieces:
        """Return the pieces of rows, which follow those of the last call."""
        run, n = self.run, end - first
        tool = run.state.tool.part(first, end).astype(np.int64)
        length = np.array([self.lengths.get(int(k), self.read_with) for k in tool.tolist()]) if n else np.zeros(0)
        xyz_is_tip = run.state.xyz_is_tip.part(first, end)
        machine = self._from_machine(first, end, xyz_is_tip)
        joints = self._row_joints(first, end, xyz_is_tip, length, machine)
        tips = StatedTips.of(run)
        known = tips.before[first:end] & tips.after[first:end]
        if run.machine.workpiece_zero is None:
            known &= ~turns_without_tcp(run, np.arange(first, end))
        else:  # with its real length, the tool's place follows from the slides
            known |= ~xyz_is_tip
        before = np.concatenate((self.joints[None], joints))
        for lost in np.flatnonzero(~np.isfinite(joints).all(axis=1)).tolist():
            before[lost + 1] = before[lost]  # the reader has said that no position is known there
        counts = np.ones(n, np.int64)
        bent = np.flatnonzero(self._may_bend(first, end, xyz_is_tip, before))
        if len(bent):
            counts[bent] = self._counts(first, bent, before, length)
        row = np.repeat(np.arange(n), counts)
        place = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
        done = (place + 1) / counts[row]
        along = before[row] + done[:, None] * (before[row + 1] - before[row])
        inner = (counts[row] > 1) & (place + 1 < counts[row])
        if inner.any():
            along[inner] = self._interpolated(first, row[inner], done[inner], before, length)
            along[inner] = np.where(np.isfinite(along[inner]), along[inner], before[row[inner] + 1])
        start, self.joints = self.joints, before[-1].copy()
        along = np.concatenate((start[None], along))
        return AxisPieces(first, end, row + first, place / counts[row], done, along, tool[row], known[row])

    def _row_joints(self, first: int, end: int, xyz_is_tip: Flags, length: Floats, machine: Flags) -> Floats:
        """Axis values at the end of rows, with the real lengths of tools."""
        run = self.run
        xyz, rotary = run.xyz[first:end], run.rotary[first:end]
        joints = np.empty((end - first, 5))
        for each in np.unique(length).tolist():
            of = length == each
            joints[of] = self._solved(each, xyz_is_tip[of], xyz[of], rotary[of])
        from_work = ~xyz_is_tip & self._active(first, end)
        longer = np.where(from_work, length - self.read_with, 0.0)
        joints[:, self._slides] += np.where(machine, 0.0, longer[:, None] * self._along)
        return joints

    def _from_machine(self, first: int, end: int, xyz_is_tip: Flags) -> Flags:
        """Which slides stand where coordinates of the machine have put them, (n, 3)."""
        run = self.run
        words, frame = run.programmed[first:end], run.state.machine_frame.part(first, end)
        found = np.empty((end - first, 3), np.bool_)
        nothing = (words & _POSITION_WORDS) == 0
        for k, word in enumerate((ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z)):
            named = ((words & int(word)) != 0) | xyz_is_tip | nothing
            last = np.maximum.accumulate(np.where(named, np.arange(end - first), -1))
            found[:, k] = np.where(last >= 0, (frame & ~xyz_is_tip)[last], self.from_machine[k])
        if end > first:
            self.from_machine = found[-1].copy()
        return found

    def _active(self, first: int, end: int) -> Flags:
        """Where the control counts the length of the tool."""
        edge = self.run.state.edge.part(first, end)
        return np.asarray(edge > 0 if self.run.uses_length_numbers else edge != 0)

    def _solved(self, length: float, xyz_is_tip: Flags, xyz: Floats, rotary: Floats) -> Floats:
        machine = self._machine(length)
        return joints_from_rows(machine, kinematic_parameters(machine), xyz_is_tip, xyz, rotary)

    def _may_bend(self, first: int, end: int, xyz_is_tip: Flags, before: Floats) -> Flags:
        """Rows in which an axis may move unevenly."""
        run = self.run
        tcp = run.state.tcp.part(first, end) & ~run.state.machine_frame.part(first, end) & xyz_is_tip
        rotary = before[:, list(run.machine.rotary)]
        turns = (np.abs(np.diff(rotary, axis=0)) > 1e-9).any(axis=1)
        return np.asarray((tcp & turns) | (run.kind[first:end] == Kind.ARC))

    def _counts(self, first: int, rows: Ints, before: Floats, length: Floats) -> Ints:
        """How many pieces rows are cut into: their sag falls with the square of the number."""
        half = np.full(len(rows), 0.5)
        middle = self._interpolated(first, rows, half, before, length)
        away = np.abs(middle - (before[rows] + before[rows + 1]) / 2.0)
        away[:, list(self.run.machine.rotary)] *= np.pi / 180.0 * _REACH
        sag = np.nan_to_num(away, nan=0.0).max(axis=1)
        arc = self.run.kind[first + rows] == Kind.ARC
        if arc.any():
            k = np.searchsorted(self.run.arcs.row, first + rows[arc])
            ends = forward(self.run.machine, before[rows[arc] + 1])[0]
            reach = np.linalg.norm(ends - self.run.arcs.centre[k], axis=1)
            turns = self.run.arcs.full_turns[k] + 1
            # A full circle, whose middle says nothing: sag of a quarter of its pieces.
            sag[arc] = np.maximum(sag[arc], 2.0 * reach * turns**2)
        counts = np.ceil(np.sqrt(4.0 * sag / SAG))
        turned = np.abs(before[rows + 1] - before[rows])[:, list(self.run.machine.rotary)].max(axis=1)
        counts = np.clip(np.maximum(counts, np.ceil(turned / 30.0)), 1, _MOST_PIECES)
        return np.asarray(counts, np.int64)

    def _interpolated(self, first: int, rows: Ints, done: Floats, before: Floats, length: Floats) -> Floats:
        """Axis values within rows on which the tip is guided, as the control has them, (k, 5)."""
        run, columns = self.run, list(self.run.machine.rotary)
        start = before[rows]
        joints = start + done[:, None] * (before[rows + 1] - start)
        end = first + len(before) - 1
        great = run.state.tcp.part(first, end)[rows] & (run.kind[first + rows] != Kind.ARC)
        great &= run.orientation_between(first, end)[rows] == Orientation.GREAT_CIRCLE
        if great.any():
            joints[np.ix_(great, columns)] = self._on_great_circles(start[great], before[rows[great] + 1], done[great])
        for each in np.unique(length[rows]).tolist():
            of = length[rows] == each
            tips = self._tips(first, rows[of], done[of], before, each)
            joints[of] = self._solved(each, np.ones(len(tips), np.bool_), tips, joints[np.ix_(of, columns)])
        return joints

    def _tips(self, first: int, rows: Ints, done: Floats, before: Floats, length: float) -> Floats:
        """Tips within rows, on their line or circle, (k, 3)."""
        run, machine = self.run, self._machine(length)
        start, end = forward(machine, before[rows])[0], forward(machine, before[rows + 1])[0]
        tips = start + done[:, None] * (end - start)
        arc = run.kind[first + rows] == Kind.ARC
        if arc.any():
            k = np.searchsorted(run.arcs.row, first + rows[arc])
            tips[arc] = circle_points(
                start[arc], end[arc], run.arcs.centre[k], run.arcs.normal[k], run.arcs.full_turns[k], done[arc]
            )
        return np.asarray(tips)

    def _on_great_circles(self, start: Floats, end: Floats, done: Floats) -> Floats:
        """Rotary positions of tool axes on great circles, (k, 2)."""
        machine = self.run.machine
        columns = list(machine.rotary)
        vectors = slerp(forward(machine, start)[1], forward(machine, end)[1], done)
        found = np.empty((len(done), 2))
        rules = np.zeros(len(done), np.uint8)
        beginnings = np.flatnonzero(np.concatenate(([True], done[1:] <= done[:-1])))
        for one, last in zip(beginnings, np.append(beginnings[1:], len(done)), strict=True):
            words = RotaryWords(np.empty((last - one, 2)), rules[one:last].copy(), vectors[one:last])
            resolve_angles(machine, words, start[one, columns], rules[one:last].copy())
            found[one:last] = words.rotary
        return found

    def _machine(self, length: float) -> Machine:
        """The machine with a tool of this length."""
        if length not in self._machines:
            self._machines[length] = replace(self.run.machine, tool_length=length)
        return self._machines[length]
