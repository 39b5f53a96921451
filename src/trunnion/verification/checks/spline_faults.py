"""Splines of a program that go along splines of the CL files: whether they are the same curves all the way."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext
from trunnion.verification.expected.path import WrittenSpline
from trunnion.verification.expected.splines import dense_points, span_counts
from trunnion.verification.results import Place

#: What the digits of coefficients come to, mm.
_COEFFICIENTS: Final = 2e-5


@dataclass(frozen=True, slots=True, eq=False)
class SplineFaults:
    """What is wrong with the splines of a program, and how far one leaves that of the CL file at most, mm, before the
    end of which row; 0 and -1 for none.
    """

    places: tuple[Place, ...] = ()
    deviation: float = 0.0
    row: int = -1


def spline_faults(context: ComparedContext) -> SplineFaults:
    """Find splines that leave those of the CL files, or along which something changes."""
    written = context.expected.written_splines
    if not written:
        return SplineFaults()
    events = np.sort(np.array([event.before_row for event in context.run.events], np.int64))
    places: list[Place] = []
    deviation, row = 0.0, -1
    for spline in written:
        off = _deviations(context, spline)
        if float(off.max()) > deviation:
            deviation, row = float(off.max()), spline.last
        places += _too_far(context, spline, off)
        if changed := _change_inside(context.run, spline, events):
            places.append(context.place(spline.last, 0.0, f"{changed} along a spline of the CL file"))
    return SplineFaults(tuple(places), deviation, row)


def _too_far(context: ComparedContext, written: WrittenSpline, off: Floats) -> Iterator[Place]:
    """Yield the end of the spline of the program that is farthest from that of the CL file, if that is too far."""
    limit = context.expected.sections[written.section].tolerances.tip + _COEFFICIENTS
    worst = float(off.max())
    if not worst <= limit:
        splines, end = context.run.splines, written.begin + written.count
        ends = np.cumsum(span_counts(splines)[written.begin : end])
        own = written.begin + int(np.searchsorted(ends, int(np.argmax(off.max(axis=1))), "right"))
        text = f"the spline is {worst:.5f} mm off that of the CL file, {limit:.5f} is allowed"
        yield context.place(int(splines.last[own]), worst, text)


def _deviations(context: ComparedContext, written: WrittenSpline) -> Floats:
    """(s, 9): the greatest deviation of a coordinate at points of each span, mm."""
    wanted = context.expected.sections[written.section].operation.splines
    actual = dense_points(context.run.splines, written.begin, written.begin + written.count)
    return np.asarray(np.abs(actual - dense_points(wanted, written.number, written.number + 1)).max(axis=2))


def _change_inside(run: Run, written: WrittenSpline, events: Ints) -> str:
    """Return what changes between the rows of a spline, in words; empty for nothing.

    ``events`` are their rows, sorted.
    """
    first, last = written.first, written.last
    if (run.kind[first : last + 1] != Kind.LINEAR).any():
        return "the motion changes"
    for each in fields(run.state):
        column: StepColumn = getattr(run.state, each.name)
        if _is_one_inside(column.rows, first, last):
            return f"the state {each.name} changes"
    return "a command stands" if _is_one_inside(events, first, last) else ""


def _is_one_inside(rows: Ints, first: int, last: int) -> bool:
    """Whether one of sorted rows is behind ``first`` and up to ``last``."""
    return bool(np.searchsorted(rows, first, "right") < np.searchsorted(rows, last, "right"))
