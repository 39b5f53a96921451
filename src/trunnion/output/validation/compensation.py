"""Radius compensation that the control would make in another plane than across the tool, or at holes."""

from typing import Final

import numpy as np

from trunnion.errors import Problem
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CutterComp
from trunnion.output.program import Program
from trunnion.planning.holes.operations import cycle_row_ranges

#: The axis perpendicular to each plane of CUTCOM; without one the control works in XY.
_NORMALS: Final = {"": 2, "XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}

#: How far the tool axis may be off that axis, as the sine of the angle.
_ASKEW: Final = 1e-4


def compensation_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse CUTCOM that would offset along the tool, not by the tool's radius, or the points of holes."""
    by_deltas = motion.mode is MachiningMode.TCP and not program.control.family.COMPENSATES_WITH_TCP
    if motion.mode is MachiningMode.WITHOUT_TCP:
        return []  # refused altogether
    operation = motion.as_written()
    events = [event for event in operation.events if isinstance(event, CutterComp)]
    ends = [*(event.row for event in events[1:]), len(operation.moves)] if events else []
    problems = []
    for event, end in zip(events, ends, strict=True):
        axes = operation.moves.axis[event.row : end]
        if event.side == "OFF" or not len(axes):
            continue
        if holes := [cycle for cycle, stop in cycle_row_ranges(operation) if cycle.row < end and event.row < stop]:
            what = f"CUTCOM/{event.side} where the cycle of line {holes[0].line} makes holes: they have no side"
            problems.append(
                Problem(
                    program.file,
                    event.line,
                    what,
                    "write CUTCOM/OFF before the cycle, and LEFT behind it",
                    code="CTL220",
                )
            )
            continue
        in_plane = np.delete(axes, _NORMALS.get(event.plane, 2), axis=1)
        if float(np.abs(in_plane).max()) <= _ASKEW and not by_deltas:
            continue
        plane = event.plane or "XYPLAN"
        what = f"CUTCOM in {plane} with {motion.mode}, where the tool is not perpendicular to that plane"
        why = "it would offset along the tool"
        if by_deltas:
            what = (
                f"CUTCOM with {motion.mode}, where this control takes the delta values of the tool and not its radius"
            )
            why = "the tool would cut into the part by its radius"
        in_tilted_plane = "setting mode=tilted makes the operation in a tilted plane, or "
        has_planes = MachiningMode.TILTED in program.control.modes({})
        cure = (in_tilted_plane if has_planes else "") + "output the path without CUTCOM"
        problems.append(Problem(program.file_of(operation), event.line, f"{what}: {why}", cure, code="CTL220"))
    return problems
