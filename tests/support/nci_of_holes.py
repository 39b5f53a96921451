"""A job of holes as Mastercam writes it: rapids with tool axes (record 11), and each run of holes as a cycle."""

from tests.support import nci
from trunnion.model.toolpath import CycleOn, LoadTool, Operation, SpindleOn
from trunnion.planning.holes.cycles import cycle_from_event

#: Heights count from here: only their differences matter.
_SURFACE = 2.5


def write(operation: Operation, name: str) -> str:
    """The NCI of an operation with one tool that consists of rapids and holes in pecks, in mm."""
    moves = operation.moves
    spindle = next(event for event in operation.events if isinstance(event, SpindleOn))
    number = next(event.number for event in operation.events if isinstance(event, LoadTool))
    tool = operation.tool
    lines = nci.tool(int(number), tool.diameter, tool.corner_radius, spindle.rpm, name=tool.name)
    cycles = {event.row: event for event in operation.events if isinstance(event, CycleOn)}
    for row, (tip, axis) in enumerate(zip(moves.tip.tolist(), moves.axis.tolist(), strict=True)):
        if row in cycles:
            made = cycle_from_event(cycles[row])
            assert made.rapid_height is not None
            assert made.retract_height is not None
            hole = nci.Hole(tip, axis, made.depth, made.rapid_height, made.retract_height, _SURFACE)
            lines += nci.cycle(1, [hole], made.feed or 0.0, made.pecks[0])
        else:
            lines += nci.five_axis(tip, axis, -2, 42)
    return "\n".join([*nci.header(name), *lines, "1003", "0. 0. 0."]) + "\n"
