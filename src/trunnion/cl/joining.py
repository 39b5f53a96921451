"""Operations of files without sections that are one path.

The second begins with a cut from where the first ends: between two operations the tool goes home, and where the file
has no rapid there, that way would take the place of a cut. Or the first goes to the point where the first tool is
loaded, and nothing else: it has no tool of its own.
"""

from collections.abc import Iterable
from dataclasses import replace

from trunnion.cl.builder import FromStatement, OperationBuilder
from trunnion.cl.diagnostics import Diagnostics
from trunnion.messages import Wording
from trunnion.model.toolpath import Coolant, CutterComp, CycleOff, CycleOn, Event, GoHome, LoadTool, Message


def join_cuts(
    builders: Iterable[OperationBuilder], diagnostics: Diagnostics, *, in_sections: bool
) -> list[OperationBuilder]:
    """Return the operations, those that begin with a cut joined to the one before, with a remark.

    An operation stays for itself if it has no operation before that it continues, another tool, comes from home or a
    FROM of its own, or begins with a rapid or a hole. Errors are a cut that begins with another register of the tool,
    and one that goes on with the radius compensation of the operation before; ``in_sections`` that ends with its own.
    """
    joined: list[OperationBuilder] = []
    number: int | None = None
    side: CutterComp | None = None
    register, is_home = 0, False
    for builder in builders:
        before = joined[-1] if joined and builder.continues else None
        loads = [event for event in builder.events if isinstance(event, LoadTool)]
        if (
            before is None
            or is_home
            or not _begins_with_cut(builder)
            or _has_other_tool(before, builder, loads, number)
        ):
            if not in_sections:
                side = _side_lost(joined[-1:], builder, side, loads, number, diagnostics)
                _report_lost_coolant(builder, joined[-1:], diagnostics)
            joined.append(builder)
        else:
            if first := next((load for load in loads if load.row == 0 and load.adjust != register), None):
                diagnostics.error(
                    first.line, Wording("CL780", "tool_called_another", number=first.number, before=before.name)
                )
            diagnostics.remark(
                builder.line, Wording("CL790", "operation_begins_cut", builder=builder.name, before=before.name)
            )
            if builder.named:
                before.joined.append(builder.name)
                before.events.append(Message(builder.first - before.first, builder.line, builder.name))
            _append(before, builder)
        number, register = (loads[-1].number, loads[-1].adjust) if loads else (number, register)
        is_home = _ends_at_home(builder) or (is_home and builder.stop == builder.first)
        side = None if in_sections else _last_side(builder, side)
    return joined


def join_first_tool(builders: Iterable[OperationBuilder], diagnostics: Diagnostics) -> list[OperationBuilder]:
    """Return the operations, a way to the point of the first tool change joined to the operation of that tool.

    Such a way stands before the first tool and has rapids only. It is done with that tool, as a remark says. Anything
    else before the first tool stays an operation without a tool.
    """
    found = list(builders)
    if len(found) < 2 or not _is_way(found[0]) or not found[1].continues:
        return found
    way, behind = found[:2]
    first = next((event for event in behind.events if isinstance(event, LoadTool) and event.row == 0), None)
    if first is None or any(event.row == 0 and event.line < first.line for event in behind.events):
        return found
    diagnostics.remark(way.line, Wording("CL790", "way_before_first", number=first.number))
    way.rapids = list(range(way.stop - way.first))
    _append(way, behind)
    way.events.append(first)
    way.name, way.line, way.tool = behind.name, behind.line, behind.tool
    return [way, *found[2:]]


def _is_way(builder: OperationBuilder) -> bool:
    """Whether an operation only goes somewhere: no tool, rapids alone, and nothing done on the way.

    Its first point needs no RAPID if there is no feed: a cut would have a point to begin from.
    """
    only_moves = not builder.circles and not builder.upright and all(event.row == 0 for event in builder.events)
    no_tool = not any(isinstance(event, LoadTool | CycleOn | GoHome) for event in builder.events)
    first = set() if builder.feeds else {0}
    return only_moves and no_tool and set(range(builder.stop - builder.first)) <= first | set(builder.rapids)


def _report_lost_coolant(builder: OperationBuilder, before: list[OperationBuilder], diagnostics: Diagnostics) -> None:
    """Warn of an operation that says nothing of coolant behind one that leaves it on: the way home switches it off."""
    coolants = [event for each in before for event in each.events if isinstance(event, Coolant)]
    own = any(isinstance(event, Coolant) and event.kind != "OFF" for event in builder.events)
    if coolants and coolants[-1].kind != "OFF" and not own:
        diagnostics.remark(
            builder.line, Wording("CL750", "operation_no_coolnt", builder=builder.name, kind=coolants[-1].kind)
        )


def _last_side(builder: OperationBuilder, side: CutterComp | None) -> CutterComp | None:
    """Return the CUTCOM in force at the end of an operation; None if there is none, or it is OFF."""
    last = next((event for event in reversed(builder.events) if isinstance(event, CutterComp)), side)
    return None if last is None or last.side == "OFF" else last


def _cuts_before_side(builder: OperationBuilder) -> bool:
    """Whether an operation cuts before a CUTCOM of its own."""
    own = next((event.row for event in builder.events if isinstance(event, CutterComp)), builder.stop - builder.first)
    return bool(set(range(own)) - set(builder.rapids))


def _side_lost(
    before: list[OperationBuilder],
    builder: OperationBuilder,
    side: CutterComp | None,
    loads: list[LoadTool],
    number: int | None,
    diagnostics: Diagnostics,
) -> CutterComp | None:
    """Report an operation that cuts on with the radius compensation of the one before: the way home ends that.

    With the same tool its path would be off by the radius, which is an error. Another tool begins without, as a remark
    says. Return what is still to report at the operations that follow.
    """
    if side is None:
        return None
    changes = any(_has_other_tool(each, builder, loads, number) for each in before)
    if not _cuts_before_side(builder):
        return None if changes else side
    if changes:
        diagnostics.remark(
            builder.line,
            Wording("CL760", "operation_cuts_without", builder=builder.name, side_line=side.line, side=side.side),
        )
    else:
        diagnostics.error(
            builder.line,
            Wording(
                "CL760", "operation_cuts_without_cutcom", builder=builder.name, side_line=side.line, side=side.side
            ),
        )
    return None


def _ends_at_home(builder: OperationBuilder) -> bool:
    """Whether an operation goes home behind its last row."""
    end = builder.stop - builder.first
    return any(isinstance(event, GoHome) and event.row == end for event in builder.events)


def _begins_with_cut(builder: OperationBuilder) -> bool:
    """Whether the first motion of an operation is a line or an arc at feed from the last point of the one before."""
    if any(circle.row == 0 for circle in builder.circles):
        is_cut = True
    else:
        is_cut = 0 not in builder.rapids and not _is_hole(builder)
    goes_home = any(isinstance(event, GoHome) and event.row == 0 for event in builder.events)
    starts = any(start.row == 0 for start in _stated_starts(builder))
    return is_cut and not goes_home and not starts


def _is_hole(builder: OperationBuilder) -> bool:
    """Whether the first row is a hole: a cycle that is on in the operation before is stated again."""
    switches = [event for event in builder.events if isinstance(event, CycleOn | CycleOff) and event.row == 0]
    return bool(switches) and isinstance(switches[-1], CycleOn)


def _has_other_tool(
    before: OperationBuilder, builder: OperationBuilder, loads: list[LoadTool], number: int | None
) -> bool:
    """Whether an operation begins with another tool than ``number``, the last one called, or one of another form."""
    return before.tool != builder.tool or any(load.row == 0 and load.number != number for load in loads)


def _stated_starts(builder: OperationBuilder) -> list[FromStatement]:
    """Return the FROM statements: not the starts that stand for the last point before an arc."""
    arcs = {circle.line for circle in builder.circles}
    return [start for start in builder.starts if start.line not in arcs]


def _append(before: OperationBuilder, builder: OperationBuilder) -> None:
    """Put an operation behind the one before; the smaller tolerances count."""
    shift = builder.first - before.first
    repeated = [e for e in builder.events if e.row == 0 and _is_repeated(e, builder.line)]
    before.events += [replace(e, row=e.row + shift) for e in builder.events if e not in repeated]
    before.feeds += [feed._replace(row=feed.row + shift) for feed in builder.feeds]
    before.rapids += [row + shift for row in builder.rapids]
    before.colours += [(row + shift, colour) for row, colour in builder.colours]
    before.circles += [circle._replace(row=circle.row + shift) for circle in builder.circles]
    before.starts += [start._replace(row=start.row + shift) for start in _stated_starts(builder)]
    before.axes += [axis._replace(row=axis.row + shift) for axis in builder.axes]
    before.planes += [plane._replace(row=plane.row + shift) for plane in builder.planes]
    before.upright += builder.upright
    before.intol = _smaller(before.intol, builder.intol)
    before.outtol = _smaller(before.outtol, builder.outtol)
    before.stop = builder.stop


def _is_repeated(event: Event, line: int) -> bool:
    """Whether an event at the beginning of an operation only says again what is so: its cycle, its tool."""
    return isinstance(event, LoadTool) or (isinstance(event, CycleOn) and event.line < line)


def _smaller(one: float | None, other: float | None) -> float | None:
    return min((value for value in (one, other) if value is not None), default=None)
