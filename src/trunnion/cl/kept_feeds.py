"""Warnings of tools that cut with the feed of the tool before, as where the line with their own is lost."""

from collections.abc import Sequence

from trunnion.cl.builder import OperationBuilder
from trunnion.cl.diagnostics import Diagnostics
from trunnion.model.toolpath import CycleOff, CycleOn, LoadTool


def report_kept_feeds(builders: Sequence[OperationBuilder], diagnostics: Diagnostics) -> None:
    """Warn of each operation that loads another tool, and cuts before any FEDRAT of its own."""
    tool = 0
    for builder in builders:
        loads = [event for event in builder.events if isinstance(event, LoadTool)]
        if loads and tool not in (0, loads[0].number) and _keeps_feed(builder, loads[0]):
            what = f"operation {builder.name} loads tool {loads[0].number}, and cuts with the feed of tool {tool}"
            diagnostics.remark(loads[0].line, what, "put FEDRAT behind the tool")
        tool = loads[-1].number if loads else tool


def _keeps_feed(builder: OperationBuilder, load: LoadTool) -> bool:
    """Whether the first cut of the operation behind the tool is at a feed that was there before it began."""
    own = min((feed.row for feed in builder.feeds if not feed.is_kept), default=builder.stop - builder.first)
    if load.row or not builder.feeds or not builder.feeds[0].is_kept:
        return False
    rapids = set(builder.rapids)
    return any(row not in rapids and not _has_cycle_feed(builder, row) for row in range(own))


def _has_cycle_feed(builder: OperationBuilder, row: int) -> bool:
    """Whether a row is a hole of a cycle with a feed of its own."""
    cycles = [event for event in builder.events if isinstance(event, CycleOn | CycleOff) and event.row <= row]
    last = cycles[-1] if cycles else None
    return isinstance(last, CycleOn) and not {"MMPM", "MMPR"}.isdisjoint(dict(last.values))
