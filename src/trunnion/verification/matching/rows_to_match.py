"""Which motions of a run, and which CL points, take part in matching.

Motions in the machine frame and rotary axes positioned without TCP go to no CL point; motions that drill holes are
matched by ``trunnion.verification.matching.hole_matching``. A CL point that repeats the one before makes no block.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.positioning_moves import (
    approach_rows,
    rotary_positioning_flags,
    tool_axis_exit_rows,
)
from trunnion.verification.matching.hole_matching import hole_rows, match_holes
from trunnion.verification.row_ranges import CHUNK, RowRanges, chunk_bounds

#: A point repeats the exit of a hole if it is off by less than this, mm and as the length of a vector.
_SAME = 1e-9


def workpiece_rows(run: Run) -> RowRanges:
    """Rows of a run in the workpiece frame that do more than position rotary axes."""
    frame = run.state.machine_frame
    return RowRanges.from_flags(
        (start, np.asarray(~(rotary_positioning_flags(run, start, end) | frame.part(start, end))))
        for start, end in chunk_bounds(len(run))
    )


def rows_to_match(run: Run, expected: ExpectedPath) -> RowRanges:
    """Rows of a run that should go to CL points: no hole motions, no approach from home, no exit to home.

    Of a spline that the CL files have too it is the end alone.
    """
    rows = workpiece_rows(run)
    inside = [np.arange(spline.first, spline.last) for spline in expected.written_splines]
    holes = hole_rows(match_holes(run, expected))
    without = np.concatenate((holes, approach_rows(run), tool_axis_exit_rows(run), *inside))
    turns = _plane_changes_at_points(run, expected)
    if not len(without) and not len(turns):
        return rows
    flags = np.zeros(len(run), np.bool_)
    for first, count in rows.ranges(0, len(rows)):
        flags[first : first + count] = True
    flags[without] = False
    flags[turns] = True
    return RowRanges.from_flags([(0, flags)])


def _plane_changes_at_points(run: Run, expected: ExpectedPath) -> Ints:
    """Rows that turn the table from one plane to the next, and thereby bring the tool to a CL point at rapid."""
    rows: Ints = np.concatenate(
        [np.zeros(0, np.int64)]
        + [start + np.flatnonzero(rotary_positioning_flags(run, start, end)) for start, end in chunk_bounds(len(run))]
    )
    rows = rows[rows > 0]
    rows = rows[run.state.xyz_is_tip.at(rows - 1) & ~run.state.tcp.at(rows - 1)]
    if not len(rows):
        return rows
    actual, arrives = run.positions(rows), np.zeros(len(rows), np.bool_)
    for section in expected.sections:
        moves, tolerances = section.operation.moves, section.tolerances
        rapids = np.flatnonzero(moves.kind[1:] == Kind.RAPID) + 1
        turns = rapids[(moves.axis[rapids] != moves.axis[rapids - 1]).any(axis=1)]
        for k in turns.tolist():
            at_tip = (np.abs(actual.tip - moves.tip[k]) <= tolerances.tip).all(axis=1)
            at_axis = (np.abs(actual.axis - moves.axis[k]) <= np.radians(2.0 * tolerances.angle)).all(axis=1)
            arrives |= at_tip & at_axis
    return np.asarray(rows[arrives])


def repeats_of_another_kind(run: Run, expected: ExpectedPath, nc: Ints, cl: Ints) -> Flags:
    """Which pairs join a motion and a CL point that repeats the one before it, but is of another kind.

    Such a point makes no block: the motion is another, as one that only turns the rotary axes at the pole, or the
    whole circle that follows.

    nc, cl  (k,): rows of the run and CL rows
    """
    kind, wanted = run.kind[nc], expected.kind(cl)
    found = (kind != wanted) & (wanted != Kind.ARC)
    if found.any():
        found[found] = repeats_exactly(expected, cl[found])
    return np.asarray(found)


def repeats_exactly(expected: ExpectedPath, cl: Ints) -> Flags:
    """Which CL rows are the same as the one before them within an operation, with no hole between, (k,) bool."""
    before = np.maximum(cl - 1, 0)
    same = (expected.tip(cl) == expected.tip(before)).all(axis=1) & (expected.axis(cl) == expected.axis(before)).all(1)
    apart = np.concatenate((expected.first_rows, np.array(sorted(expected.hole_exits), np.int64)))
    return np.asarray(same & (expected.kind(cl) != Kind.ARC) & ~np.isin(cl, apart))


def distinct_cl_rows(expected: ExpectedPath) -> RowRanges:
    """CL rows that do not repeat the point before them within an operation; arcs always count."""
    return RowRanges.from_flags(_distinct_flags(expected))


def _distinct_flags(expected: ExpectedPath) -> Iterator[tuple[int, Flags]]:
    after_holes = np.array(sorted(expected.hole_exits), np.int64)
    for section in expected.sections:
        moves = section.operation.moves
        for start in range(0, len(moves), CHUNK):
            now, before = slice(max(start, 1), start + CHUNK), slice(max(start - 1, 0), start + CHUNK - 1)
            tip, axis = moves.tip[now], moves.axis[now]
            same = (tip == moves.tip[before][: len(tip)]).all(axis=1)
            same &= (axis == moves.axis[before][: len(tip)]).all(axis=1)
            distinct = ~same | (moves.kind[now] == Kind.ARC)
            distinct = distinct if start else np.concatenate(([True], distinct))
            first = section.first + start
            here = slice(*np.searchsorted(after_holes, [max(first, section.first + 1), first + len(distinct)]))
            for row in after_holes[here].tolist():
                (tip, axis), point = expected.hole_exits[row], expected.point(row)
                distinct[row - first] = max(np.abs(point.tip - tip).max(), np.abs(point.axis - axis).max()) > _SAME
            yield first, distinct
