"""Which splines of a run go along which splines of the CL files.

A program may write each polynomial of a spline as one of its own, so several splines of a run in a row may be one of
the CL file. Splines that are found here are compared as curves; all others are the lines of their points.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.splines import Spline
from trunnion.model.toolpath import CutterComp, CycleOn
from trunnion.records import dataclass
from trunnion.verification.expected.path import ExpectedPath, WrittenSpline
from trunnion.verification.expected.splines import span_counts

#: The tool axis along Z, and how far it may be off: less than any rotary word shows.
_UP: Final = np.array([0.0, 0.0, 1.0])
_UPRIGHT: Final = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class _Wanted:
    """A spline of the CL files: its start and end (3,), and how far these may be off."""

    section: int
    number: int
    spline: Spline
    start: Floats
    end: Floats
    tip: float


def written_splines(run: Run, expected: ExpectedPath) -> tuple[WrittenSpline, ...]:
    """Return the splines of the CL files that a program writes, in order.

    A spline is found where those of the run start at its start, have its spans together, and end at its end.
    """
    wanted = list(_wanted(expected))
    if not len(run.splines) or not wanted:
        return ()
    starts, ends = (run.positions(rows).tip for rows in (run.splines.first - 1, run.splines.last))
    spans = span_counts(run.splines)
    follows = np.append(run.splines.first[1:] == run.splines.last[:-1] + 1, False)
    found: list[WrittenSpline] = []
    at = 0
    for each in wanted:
        here = at + np.flatnonzero((np.abs(starts[at:] - each.start) <= each.tip).all(axis=1))
        for k in here.tolist():
            count = _count(spans[k:], follows[k:], len(each.spline.spans))
            if count and (np.abs(ends[k + count - 1] - each.end) <= each.tip).all():
                first, last = int(run.splines.first[k]), int(run.splines.last[k + count - 1])
                found.append(WrittenSpline(each.section, each.number, k, count, first, last))
                at = k + count
                break
    return tuple(found)


def _count(spans: Ints, follows: Flags, wanted: int) -> int:
    """How many splines in a row have so many spans together; 0 if none do."""
    total = 0
    for k in range(len(spans)):
        total += int(spans[k])
        if total >= wanted or not follows[k]:
            return k + 1 if total == wanted else 0
    return 0


def _wanted(expected: ExpectedPath) -> list[_Wanted]:
    """Return the splines that a program may have: no radius compensation, no holes beside them, and the tool
    along Z.
    """
    found = []
    for index, section in enumerate(expected.sections):
        moves, events = section.operation.moves, section.operation.events
        compensated = any(isinstance(event, CutterComp) and event.side != "OFF" for event in events)
        if compensated or any(isinstance(event, CycleOn) for event in events):
            continue
        splines, tip = section.operation.splines, section.tolerances.tip * 1.001 + 1e-9
        for k in range(len(splines)):
            _, last, spline = splines[k]
            if not moves.per_rev[last] and float(np.abs(moves.axis[last] - _UP).max()) < _UPRIGHT:
                found.append(_Wanted(index, k, spline, spline.poles[0], moves.tip[last], tip))
    return found
