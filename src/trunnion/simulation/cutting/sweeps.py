"""The motions of a tool, cut into short straight ones.

In:     a run, the workpiece's box, and the size of the tool.
Out:    for consecutive rows the poses at the start and the end of each sweep.
Units:  mm, unit vectors, workpiece frame.

In a sweep the tip moves on a straight line and the tool axis turns a little. Rows are divided until the chords of the
tool's outermost cutting point and of the tip are within the tolerance of the motion.

What begins or ends where nobody knows is not swept (``stated_tips``). There the tool is taken to leave the part for far
away, and to come to it from far away, along what is not known; where that is not along the tool, the end alone counts.
"""

import math
from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import forward
from trunnion.model.run import Orientation, ProgrammedWord, Run
from trunnion.model.stated_tips import StatedTips, turns_without_tcp
from trunnion.model.subdivision import subdivide
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass

_XYZ = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)

#: Rows whose sweeps are made at a time.
CHUNK_ROWS = 8192

#: Sweeps that one row may have: a rotary axis that winds a thousand turns is an error of the program.
MOST_PIECES = 4096


@dataclass(frozen=True, slots=True, eq=False)
class RowSweeps:
    """The sweeps of consecutive rows ``first`` to ``end`` (exclusive) with one tool, in order.

    row         (m,)    int64    row of the run that each belongs to
    start, end_tip      (m, 3)   tip at start and end, mm
    axis, end_axis      (m, 3)   tool axis at start and end
    """

    first: int
    end: int
    tool: int
    row: Ints
    start: Floats
    end_tip: Floats
    axis: Floats
    end_axis: Floats

    def poses(self, axes: tuple[int, int, int]) -> Floats:
        """Columns of ``tool_table.Motion`` in the coordinates of a bundle, (m, 12)."""
        columns = list(axes)
        return np.concatenate(
            (
                self.start[:, columns],
                self.axis[:, columns],
                (self.end_tip - self.start)[:, columns],
                self.end_axis[:, columns],
            ),
            axis=1,
        )


@dataclass(frozen=True, slots=True)
class SweepSizes:
    """What motions of a tool are divided for, mm.

    reach      from the tip to the farthest point that cuts
    radius     greatest radius of what cuts
    tolerance  of the motion
    away       how far from the part it is clear of everything
    """

    reach: float
    radius: float
    tolerance: float
    away: float


def tool_ranges(run: Run, end: int, start: int = 0) -> Iterator[tuple[int, int, int]]:
    """Rows from ``start`` to ``end`` (exclusive) with one tool, at most ``CHUNK_ROWS`` at a time: first row, row after
    the last, index of the tool."""
    column = run.state.tool
    changes = [int(row) for row in column.rows if start < row < end] + [end]
    first = start
    for change in changes:
        for begin in range(first, change, CHUNK_ROWS):
            yield begin, min(begin + CHUNK_ROWS, change), int(column[begin])
        first = change


def row_sweeps(run: Run, first: int, end: int, sizes: SweepSizes) -> RowSweeps:
    """Divide consecutive rows that have one tool."""
    count = end - first
    joints = np.vstack((run.start[None] if first == 0 else run.joints[first - 1 : first], run.joints[first:end]))
    before = run.positions(np.array([first - 1]))
    tip, axis = np.vstack((before.tip, run.tip[first:end])), np.vstack((before.axis, run.axis[first:end]))
    pieces = _pieces(run, first, joints, tip, axis, sizes)
    samples = subdivide(run, pieces, slice(first, end))
    last = np.cumsum(pieces) - 1
    starts = last - pieces + 1
    before_tip, before_axis = np.empty_like(samples.tip), np.empty_like(samples.axis)
    before_tip[1:], before_axis[1:] = samples.tip[:-1], samples.axis[:-1]
    before_tip[starts], before_axis[starts] = tip[:-1], axis[:-1]
    sweeps = RowSweeps(
        first, end, int(run.state.tool[first]), samples.row, before_tip, samples.tip, before_axis, samples.axis
    )
    return _where_stated(run, sweeps, sizes) if count else sweeps


def _pieces(run: Run, first: int, joints: Floats, tip: Floats, axis: Floats, sizes: SweepSizes) -> Ints:
    """Return number of sweeps of each row."""
    end = first + len(joints) - 1
    kind = run.kind[first:end]
    tcp = run.state.tcp.part(first, end) & ~run.state.machine_frame.part(first, end)
    great_circle = tcp & (kind != Kind.ARC) & (run.orientation_between(first, end) == Orientation.GREAT_CIRCLE)
    turned = np.radians(np.abs(np.diff(joints[:, list(run.machine.rotary)], axis=0)).sum(axis=1))
    swung = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(np.diff(axis, axis=0), axis=1), 1.0))
    angle = np.where(great_circle, swung, turned)
    pieces = np.maximum(1.0, np.ceil(angle / math.sqrt(8.0 * sizes.tolerance / sizes.reach)))
    length = np.linalg.norm(np.diff(tip, axis=0), axis=1)
    # Across its axis, a tool that turns while it moves leaves the chord by a quarter of both.
    pieces = np.maximum(pieces, np.ceil(np.sqrt(0.25 * angle * length / sizes.tolerance)))
    curved = ~tcp & (kind != Kind.ARC) & (angle > 1e-12)
    if curved.any():
        between = forward(run.machine_at(first), 0.5 * (joints[:-1] + joints[1:])[curved])[0]
        bulge = np.linalg.norm(between - 0.5 * (tip[:-1] + tip[1:])[curved], axis=1)
        # Half of the way of a half turn and more says nothing: the angle has divided it already.
        pieces[curved] = np.maximum(pieces[curved], np.ceil(np.sqrt(bulge / sizes.tolerance)))
        length[curved] += 4.0 * bulge
    arcs = np.flatnonzero((run.arcs.row >= first) & (run.arcs.row < end))
    for k in arcs.tolist():
        row = int(run.arcs.row[k]) - first
        radius = float(np.linalg.norm(tip[row + 1] - run.arcs.centre[k]))
        turn = 2.0 * math.pi * (1.0 + float(run.arcs.full_turns[k]))
        pieces[row] = max(
            pieces[row], math.ceil(turn / math.sqrt(8.0 * sizes.tolerance / max(radius, sizes.tolerance)))
        )
        length[row] = turn * radius
    pieces = np.maximum(pieces, np.ceil(length / (2.0 * sizes.radius)))
    return np.asarray(np.minimum(pieces, MOST_PIECES), np.int64)


def unknown_swivels(run: Run, low: Floats, high: Floats) -> Ints:
    """Rows that turn rotary axes without TCP, nobody knowing about which place of the workpiece frame.

    Those with the tool farther from a box, (3,) to (3,) mm, than the box is large are left out, and those that begin or
    end at a machine position.
    """
    tips = StatedTips.of(run, needs_gauge_point=True)
    rows = np.flatnonzero(tips.before & ~tips.placed)
    rows = rows[turns_without_tcp(run, rows)]
    to_machine = run.state.machine_frame.at(rows) & ((run.programmed[rows] & _XYZ) != 0)
    rows = rows[~to_machine]
    tip = run.positions(rows - 1).tip
    apart = np.linalg.norm(np.maximum(np.maximum(low - tip, tip - high), 0.0), axis=1)
    return np.asarray(rows[apart < np.linalg.norm(high - low)])


def sideways_exits(run: Run, low: Floats, high: Floats) -> Ints:
    """Rows that go to a machine position across the tool axis, the tool being no higher than a box, (3,) to (3,) mm.

    Where it stands in the workpiece frame is not known after them: it may have gone through the box.
    """
    rows = StatedTips.of(run, needs_gauge_point=True).aside
    poses = run.positions(rows - 1)
    top = np.maximum(low * poses.axis, high * poses.axis).sum(axis=1)
    below = np.einsum("ij,ij->i", poses.tip, poses.axis) < top - 1e-6
    return np.asarray(rows[below])


def _where_stated(run: Run, sweeps: RowSweeps, sizes: SweepSizes) -> RowSweeps:
    """Return the sweeps between known places, and those that leave for unknown ones, or come from them."""
    tips, row = StatedTips.of(run, needs_gauge_point=True), sweeps.row
    before, after = tips.before[row], tips.after[row]
    turns = ~tips.placed[row] & turns_without_tcp(run, row)
    keep = before & after & ~turns
    if keep.all():
        return sweeps
    begins = np.concatenate(([True], row[1:] != row[:-1]))
    ends = np.concatenate((row[1:] != row[:-1], [True]))
    start, end_tip = sweeps.start.copy(), sweeps.end_tip.copy()
    axis, end_axis = sweeps.axis.copy(), sweeps.end_axis.copy()
    # Out: the first sweep of a row that leaves; in: the last one of a row that comes back.
    for k in np.flatnonzero(before & ~after & begins).tolist():
        way = tips.ways.get(int(row[k]))
        if way is not None:
            end_axis[k], end_tip[k] = axis[k], start[k] + sizes.away * way
            keep[k] = True
    for k in np.flatnonzero(after & ~(before & ~turns) & ends).tolist():
        way = tips.ways.get(int(row[k]))
        axis[k] = end_axis[k]
        start[k] = end_tip[k] if way is None else end_tip[k] + sizes.away * way
        keep[k] = True
    return RowSweeps(
        sweeps.first, sweeps.end, sweeps.tool, row[keep], start[keep], end_tip[keep], axis[keep], end_axis[keep]
    )
