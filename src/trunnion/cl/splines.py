"""Splines become points: as many that the chords between them stay within a tolerance.

In:     operations as they were read, in which each control point has a row; lengths in mm.
Out:    the same with the points of the splines in place of their control points, the last of which is their end; and
        the splines themselves beside these points.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.cl.builder import MoveColumns, OperationBuilder, SplineStatement
from trunnion.cl.diagnostics import Diagnostics
from trunnion.messages import Wording
from trunnion.model.splines import Spline, SplineRows

#: Where a file states no tolerance, mm; and the largest that is taken from INTOL and OUTTOL, and the smallest.
_TOLERANCE: Final = 0.001
_MAX_TOLERANCE: Final = 0.01
_MIN_TOLERANCE: Final = 1e-4

#: More points than this are a mistake in the file, or would fill the memory.
_MAX_POINTS: Final = 20_000_000
_MAX_POINTS_OF_ONE: Final = 1_000_000

_DEGREE: Final = 3
#: How far the last knot may be off 1: knots have seven decimals.
_AT_END: Final = 1e-6

_CURE: Final = "output the spline again, or turn spline output off in the CAM system"


def with_spline_points(
    builders: Sequence[OperationBuilder],
    columns: MoveColumns,
    rows: int,
    unit: float,
    tolerance: float | None,
    diagnostics: Diagnostics,
) -> MoveColumns:
    """Return the columns with points in place of control points; ``builders`` get their rows, and the splines as
    curves.

    builders     the operations
    columns      tip in mm, axis and line of each row
    rows         how many there are
    unit         length unit of the file, mm
    tolerance    greatest distance of a spline from the chords of its points, mm; None: by INTOL and OUTTOL
    diagnostics  takes splines that cannot be evaluated, and a remark on how many points come of the others
    """
    blocks: list[_Block] = []
    finest, poles, total, line = math.inf, 0, 0, 0
    for builder in builders:
        if not builder.splines:
            continue
        within = _tolerance(builder, unit) if tolerance is None else tolerance
        finest = min(finest, within)
        for spline in builder.splines:
            block = _block_of(builder, spline, columns, unit, within, diagnostics)
            if block is not None:
                blocks.append(block)
                poles, total, line = poles + spline.points, total + len(block.points), line or spline.line
            if total > _MAX_POINTS:
                raise diagnostics.fatal(
                    spline.line, Wording("CL600", "splines_take_more", max_points=_MAX_POINTS, within=within)
                )
    if not blocks or diagnostics.has_errors:
        return columns
    diagnostics.remark(
        line, Wording("CL610", "spline_nurbs_control", count=len(blocks), poles=poles, total=total, finest=finest)
    )
    return _insert(builders, columns, rows, blocks)


def _tolerance(builder: OperationBuilder, unit: float) -> float:
    """Return the smaller one of INTOL and OUTTOL, within limits."""
    given = [value * unit for value in (builder.intol, builder.outtol) if value is not None and value > 0.0]
    return min(max(min(given), _MIN_TOLERANCE), _MAX_TOLERANCE) if given else _TOLERANCE


class _Block(NamedTuple):
    """A spline of ``builder``: the row of the file of its first control point behind its start, and its points (m, 3)
    behind the start, mm.
    """

    builder: OperationBuilder
    row: int
    poles: Floats
    knots: Floats
    points: Floats


def _block_of(
    builder: OperationBuilder,
    spline: SplineStatement,
    columns: MoveColumns,
    unit: float,
    tolerance: float,
    diagnostics: Diagnostics,
) -> _Block | None:
    """Return a spline with its points; None if it has none, which is reported."""
    fault = _fault(builder, spline)
    first = builder.first + spline.row
    if fault is None:
        starts = [start.tip for start in builder.starts if start.row == spline.row]
        start = np.array(starts[-1]) * unit if starts else columns.tip[first - 1]
        poles = np.vstack((start, columns.tip[first : first + spline.points]))
        knots = np.array(spline.knots)
        counts = _counts(poles, knots, tolerance)
        if float(counts.sum()) <= _MAX_POINTS_OF_ONE:
            return _Block(builder, first, poles, knots, evaluate(poles, knots, counts.astype(np.int64)))
        fault = Wording("CL600", "too_many_points", most=_MAX_POINTS_OF_ONE, tolerance=tolerance)
    diagnostics.error(spline.line, fault)
    return None


def _fault(builder: OperationBuilder, spline: SplineStatement) -> Wording | None:
    """Why a spline cannot be evaluated; None if it can."""
    knots = spline.knots
    if not knots or not spline.points:
        return Wording("CL600", "no_knots")
    if not all(low < high for low, high in pairwise([0.0, *knots])):
        return Wording("CL600", "knots_not_increasing")
    if abs(knots[-1] - 1.0) > _AT_END:
        return Wording("CL600", "last_knot", knot=knots[-1])
    degree = spline.points - len(knots) + 1
    if degree != _DEGREE:
        return Wording("CL600", "other_degree", knots=len(knots), points=spline.points, degree=degree)
    within = range(spline.row + 1, spline.row + spline.points)
    if any(row in within for row in _rows_of(builder)):
        return Wording("CL600", "statement_within")
    return None


def _rows_of(builder: OperationBuilder) -> list[int]:
    """Rows before which something stands."""
    rows = [row for row, _ in builder.colours] + builder.rapids + [row for row, *_ in builder.upright]
    for each in (builder.events, builder.feeds, builder.circles, builder.starts, builder.axes):
        rows += [one.row for one in each]
    return rows


def _clamped(knots: Floats) -> Floats:
    """All knots: 0 and 1 as often as a curve that begins and ends in its control points has them."""
    return np.concatenate((np.zeros(_DEGREE + 1), knots[:-1], np.ones(_DEGREE + 1)))


def _counts(poles: Floats, knots: Floats, tolerance: float) -> Floats:
    """(s,) how many chords each span takes: its second derivative is linear, and greatest at one of its ends."""
    full = _clamped(knots)
    first = 3.0 * np.diff(poles, axis=0) / (full[4:-1] - full[1:-4])[:, None]
    second = 2.0 * np.diff(first, axis=0) / (full[4:-2] - full[2:-4])[:, None]
    bend = np.linalg.norm(second, axis=1)
    span = np.diff(np.concatenate(([0.0], knots[:-1], [1.0])))
    return np.asarray(np.maximum(np.ceil(span * np.sqrt(np.maximum(bend[:-1], bend[1:]) / (8.0 * tolerance))), 1.0))


def evaluate(poles: Floats, knots: Floats, counts: Ints) -> Floats:
    """Points of a cubic spline behind its start, (m, 3).

    poles   (n, 3) float64   the start and all control points
    knots   (n - 3,) float64  increasing up to 1; 0 is left out
    counts  (n - 3,) int64   points of each span, the last of which is its end
    """
    full, n = _clamped(knots), len(poles)
    ends = np.concatenate(([0.0], knots[:-1], [1.0]))
    spans = np.repeat(np.arange(len(counts)), counts)
    step = np.arange(len(spans)) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    at = ends[spans] + (ends[spans + 1] - ends[spans]) * step / counts[spans]
    base = spans + _DEGREE
    found = [poles[base - _DEGREE + j] for j in range(_DEGREE + 1)]
    for r in range(1, _DEGREE + 1):
        for j in range(_DEGREE, r - 1, -1):
            low, high = full[base - _DEGREE + j], full[base + 1 + j - r]
            share = ((at - low) / (high - low))[:, None]
            found[j] = (1.0 - share) * found[j - 1] + share * found[j]
    points = np.asarray(found[_DEGREE], np.float64)
    points[-1] = poles[n - 1]
    return points


def _insert(
    builders: Sequence[OperationBuilder],
    columns: MoveColumns,
    rows: int,
    blocks: Sequence[_Block],
) -> MoveColumns:
    """Return new columns with points in place of the control points, and the builders with their rows and curves."""
    counts = np.ones(rows, np.int64)
    for _, first, poles, _, points in blocks:
        last = first + len(poles) - 2
        counts[first:last] = 0
        counts[last] = len(points)
    moved = np.concatenate(([0], np.cumsum(counts)))
    source = np.repeat(np.arange(rows), counts)
    new = MoveColumns.allocate(len(source))
    new.tip[:], new.axis[:], new.line[:] = columns.tip[source], columns.axis[source], columns.line[source]
    for _, first, _, _, points in blocks:
        new.tip[moved[first] : moved[first] + len(points)] = points
    for builder in builders:
        _move_rows(builder, moved)
    for builder, first, poles, knots, points in blocks:
        begin = int(moved[first]) - builder.first
        curve = Spline(_DEGREE, _clamped(knots), poles, np.ones(len(poles)))
        builder.curves.append(SplineRows(begin, begin + len(points) - 1, curve))
    return new


def _move_rows(builder: OperationBuilder, moved: Ints) -> None:
    """Give an operation its new rows; ``moved`` (rows + 1,) is where each row of the file is now."""
    first, begin = builder.first, int(moved[builder.first])

    def now(row: int) -> int:
        return int(moved[min(first + row, len(moved) - 1)]) - begin

    builder.events = [replace(event, row=now(event.row)) for event in builder.events]
    builder.feeds = [feed._replace(row=now(feed.row)) for feed in builder.feeds]
    builder.colours = [(now(row), colour) for row, colour in builder.colours]
    builder.rapids = [now(row) for row in builder.rapids]
    builder.circles = [circle._replace(row=now(circle.row)) for circle in builder.circles]
    builder.starts = [start._replace(row=now(start.row)) for start in builder.starts]
    builder.axes = [axis._replace(row=now(axis.row)) for axis in builder.axes]
    builder.upright = [(now(row), line, word) for row, line, word in builder.upright]
    builder.first, builder.stop = begin, int(moved[builder.stop])
