"""Blocks that the operator may skip (``/``), where the CL file has no OPSKIP.

In:     the run, of which every such block is an event, and the CL file.
Out:    the blocks without which the program would do something else than the CL file says.
"""

from collections.abc import Iterator

from trunnion.messages import Wording
from trunnion.model.toolpath import BlockSkip
from trunnion.verification.context import ComparedContext
from trunnion.verification.expected.holes import Hole
from trunnion.verification.expected.skipped import skipped_stretches
from trunnion.verification.matching.hole_matching import MatchedHole, match_holes
from trunnion.verification.results import Place


def skip_faults(context: ComparedContext) -> Iterator[Place]:
    """Yield the blocks with ``/`` that stand neither at nor between points or holes of an OPSKIP."""
    events = [event for event in context.run.events if event.kind == "block_skip"]
    if not events:
        return
    regions, cl = list(_regions(context)), context.matching.cl
    holes = [(each, context.expected.holes[each.index]) for each in _holes(context)]
    for event in events:
        drilled = next((hole for rows, hole in holes if rows.first <= event.before_row < rows.end), None)
        if drilled is not None and _may_be_skipped(context, drilled):
            continue
        pair = context.matching.nc.count_before(event.before_row)
        first = int(cl[pair - 1]) if pair else 0
        last = int(cl[pair]) if pair < len(cl) else len(context.expected)
        moves = event.before_row < len(context.run) and int(context.run.lines[event.before_row]) == event.line
        if not any(begin <= last and first + moves < end for begin, end in regions):
            yield context.place_of_event(event, 0.0, Wording("stops", "skip_not_asked"))


def _holes(context: ComparedContext) -> Iterator[MatchedHole]:
    """Yield the rows of the holes that the CL file has."""
    return (each for each in match_holes(context.run, context.expected) if each.index < len(context.expected.holes))


def _may_be_skipped(context: ComparedContext, hole: Hole) -> bool:
    """Whether the statement of a hole stands behind an OPSKIP/ON, and before the next OPSKIP/OFF: holes are no rows."""
    behind = [
        (event.line, event.on)
        for section in context.expected.sections
        for event in section.operation.events
        if isinstance(event, BlockSkip) and section.file == hole.file and event.line < hole.line
    ]
    return bool(behind) and max(behind)[1]


def _regions(context: ComparedContext) -> Iterator[tuple[int, int]]:
    """Yield the points of the CL file that may be skipped: the first, and the one after the last."""
    for section in context.expected.sections:
        for begin, end in skipped_stretches(section.operation):
            yield section.first + begin, section.first + end
