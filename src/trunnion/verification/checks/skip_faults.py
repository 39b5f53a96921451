"""Blocks that the operator may skip (``/``), where the CL file has no OPSKIP.

In:     the run, of which every such block is an event, and the CL file.
Out:    the blocks without which the program would do something else than the CL file says.
"""

from collections.abc import Iterator

from trunnion.verification.context import ComparedContext
from trunnion.verification.expected.skipped import skipped_stretches
from trunnion.verification.results import Place


def skip_faults(context: ComparedContext) -> Iterator[Place]:
    """Yield the blocks with ``/`` that stand neither at nor between points of an OPSKIP."""
    events = [event for event in context.run.events if event.kind == "block_skip"]
    if not events:
        return
    regions, cl = list(_regions(context)), context.matching.cl
    for event in events:
        pair = context.matching.nc.count_before(event.before_row)
        first = int(cl[pair - 1]) if pair else 0
        last = int(cl[pair]) if pair < len(cl) else len(context.expected)
        moves = event.before_row < len(context.run) and int(context.run.lines[event.before_row]) == event.line
        if not any(begin <= last and first + moves < end for begin, end in regions):
            yield context.place_of_event(event, 0.0, "may be skipped (/), and the CL file has no OPSKIP there")


def _regions(context: ComparedContext) -> Iterator[tuple[int, int]]:
    """Yield the points of the CL file that may be skipped: the first, and the one after the last."""
    for section in context.expected.sections:
        for begin, end in skipped_stretches(section.operation):
            yield section.first + begin, section.first + end
