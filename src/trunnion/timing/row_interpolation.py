"""Where the axes are within rows, and into how many pieces a row is cut for every axis to move evenly in each.

In:     a run, rows of it, and where the axes stand before and after them.
Out:    numbers of pieces; axis values within rows, as the control has them.
Units:  mm and degrees.

Without TCP a block is one piece. With TCP the tip moves on its line or circle while the rotary axes turn: such a block
is cut until the axes, moving evenly in each piece, are nowhere further than ``SAG`` from where the control has them.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.machines import Machine, forward, kinematic_parameters
from trunnion.model.axis_positions import RotaryWords, joints_from_rows, resolve_angles
from trunnion.model.run import Orientation, Run
from trunnion.model.subdivision import circle_points, slerp
from trunnion.model.toolpath import Kind

#: How far an axis may be from where the control has it within a piece, mm; rotary axes count at ``_REACH`` mm.
SAG: Final = 0.02

_REACH: Final = 500.0

#: No block is cut into more pieces.
_MOST_PIECES: Final = 4096

#: Rotary axes that turn by no more than this, degrees, are still.
_STILL: Final = 1e-9


class RowInterpolation:
    """The motion of the axes within the rows of a run, whose tools may be longer than it was read with."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self._of_rows = run.machine
        self._machines: dict[tuple[int, float], Machine] = {}

    def take_rows(self, first: int) -> Machine:
        """Take the set-up of rows from ``first`` on, and return its machine."""
        self._of_rows = self.run.machine_at(first)
        return self._of_rows

    def solved(self, length: float, xyz_is_tip: Flags, xyz: Floats, rotary: Floats) -> Floats:
        """Return axis values at positions of rows, (k, 5), with a tool of this length."""
        machine = self._machine(length)
        return joints_from_rows(machine, kinematic_parameters(machine), xyz_is_tip, xyz, rotary)

    def counts(self, first: int, before: Floats, length: Floats, least_turn: float = _STILL) -> Ints:
        """Return into how many pieces rows are cut, (k,).

        first       the first of the rows, which are in one set-up
        before      (k + 1, 5)  axis values before the first and after each
        length      (k,)        of the tools, mm
        least_turn  rows in which rotary axes turn by no more than this, degrees, stay whole
        """
        self.take_rows(first)
        counts = np.ones(len(before) - 1, np.int64)
        bent = np.flatnonzero(self._may_bend(first, before, least_turn))
        if len(bent):
            counts[bent] = self._counts(first, bent, before, length)
        return counts

    def pieces(self, first: int, before: Floats, length: Floats, counts: Ints) -> tuple[Ints, Floats, Floats, Floats]:
        """Cut rows into pieces: the row of each, the shares of it where it begins and ends, and axis values there.

        The last are those at the ends of the pieces, (m, 5). Arguments as of ``counts``, and what that returns.
        """
        self.take_rows(first)
        row = np.repeat(np.arange(len(counts)), counts)
        place = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
        done = (place + 1) / counts[row]
        along = before[row] + done[:, None] * (before[row + 1] - before[row])
        inner = (counts[row] > 1) & (place + 1 < counts[row])
        if inner.any():
            along[inner] = self.inside(first, row[inner], done[inner], before, length)
            along[inner] = np.where(np.isfinite(along[inner]), along[inner], before[row[inner] + 1])
        return row, place / counts[row], done, along

    def _may_bend(self, first: int, before: Floats, least_turn: float) -> Flags:
        """Rows in which an axis may move unevenly."""
        run, end = self.run, first + len(before) - 1
        arcs = run.kind[first:end] == Kind.ARC
        guided = run.state.tcp.part(first, end) & run.state.xyz_is_tip.part(first, end)
        guided &= ~run.state.machine_frame.part(first, end)
        if not guided.any():
            return np.asarray(arcs)
        rotary = before[:, list(run.machine.rotary)]
        turns = (np.abs(np.diff(rotary, axis=0)) > least_turn).any(axis=1)
        return np.asarray((guided & turns) | arcs)

    def _counts(self, first: int, rows: Ints, before: Floats, length: Floats) -> Ints:
        """How many pieces rows are cut into: their sag falls with the square of the number."""
        half = np.full(len(rows), 0.5)
        middle = self.inside(first, rows, half, before, length)
        away = np.abs(middle - (before[rows] + before[rows + 1]) / 2.0)
        away[:, list(self.run.machine.rotary)] *= np.pi / 180.0 * _REACH
        sag = np.nan_to_num(away, nan=0.0).max(axis=1)
        arc = self.run.kind[first + rows] == Kind.ARC
        if arc.any():
            k = np.searchsorted(self.run.arcs.row, first + rows[arc])
            ends = forward(self._of_rows, before[rows[arc] + 1])[0]
            reach = np.linalg.norm(ends - self.run.arcs.centre[k], axis=1)
            turns = self.run.arcs.full_turns[k]
            # The middle of one turn or less says how far it is from its chord; that of several says nothing.
            sag[arc] = np.maximum(sag[arc], np.where(turns > 0, 2.0 * reach * (turns + 1) ** 2, 0.0))
        counts = np.ceil(np.sqrt(4.0 * sag / SAG))
        turned = np.abs(before[rows + 1] - before[rows])[:, list(self.run.machine.rotary)].max(axis=1)
        counts = np.clip(np.maximum(counts, np.ceil(turned / 30.0)), 1, _MOST_PIECES)
        return np.asarray(counts, np.int64)

    def inside(self, first: int, rows: Ints, done: Floats, before: Floats, length: Floats) -> Floats:
        """Return axis values within rows on which the tip is guided, as the control has them, (k, 5).

        rows    (k,)  counted from ``first``
        done    (k,)  share of each row
        before, length  as of ``counts``
        """
        run, columns = self.run, list(self.run.machine.rotary)
        start = before[rows]
        joints = start + done[:, None] * (before[rows + 1] - start)
        end = first + len(before) - 1
        great = run.state.tcp.part(first, end)[rows] & (run.kind[first + rows] != Kind.ARC)
        great &= run.orientation_between(first, end)[rows] == Orientation.GREAT_CIRCLE
        if great.any():
            joints[np.ix_(great, columns)] = self._on_great_circles(start[great], before[rows[great] + 1], done[great])
        for each in distinct(length[rows]).tolist():
            of = length[rows] == each
            tips = self._tips(first, rows[of], done[of], before, each)
            joints[of] = self.solved(each, np.ones(len(tips), np.bool_), tips, joints[np.ix_(of, columns)])
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
        """Return the machine with a tool of this length."""
        key = id(self._of_rows), length
        if key not in self._machines:
            self._machines[key] = replace(self._of_rows, tool_length=length)
        return self._machines[key]
