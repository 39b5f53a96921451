"""What a tool keeps of the one before, as where a line is lost: its feed, and a cycle that nothing has ended."""

from collections.abc import Sequence

from trunnion.cl.builder import OperationBuilder
from trunnion.cl.diagnostics import Diagnostics
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOff, CycleOn, LoadTool


def report_kept_states(builders: Sequence[OperationBuilder], diagnostics: Diagnostics) -> None:
    """Warn of another tool that cuts before any FEDRAT of its own; refuse one that drills on in the cycle before it."""
    tool = 0
    for builder in builders:
        _refuse_kept_cycle(builder, tool, diagnostics)
        loads = [event for event in builder.events if isinstance(event, LoadTool)]
        if loads and tool not in (0, loads[0].number) and _keeps_feed(builder, loads[0]):
            diagnostics.remark(
                loads[0].line,
                Wording("CL720", "operation_loads_tool", builder=builder.name, number=loads[0].number, tool=tool),
            )
        tool = loads[-1].number if loads else tool


def _refuse_kept_cycle(builder: OperationBuilder, tool: int, diagnostics: Diagnostics) -> None:
    """Refuse holes of a cycle that was on when the operation loaded another tool than ``tool``."""
    cycle: CycleOn | None = None
    rapids = set(builder.rapids)
    for at, event in enumerate(builder.events):
        if isinstance(event, CycleOn | CycleOff):
            cycle = event if isinstance(event, CycleOn) else None
        elif isinstance(event, LoadTool):
            following = (e.row for e in builder.events[at:] if isinstance(e, CycleOn | CycleOff))
            rows = range(event.row, next(following, builder.stop - builder.first))
            if cycle and tool not in (0, event.number) and not rapids.issuperset(rows):
                diagnostics.error(
                    event.line, Wording("CL840", "cycle_line_still", cycle_line=cycle.line, number=event.number)
                )
            tool = event.number


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
