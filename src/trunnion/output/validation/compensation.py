"""Radius compensation that the control would make in another plane than across the tool, at holes, or by what no
register can hold; and that blocks which the operator may skip would switch for those that he may not.
"""

from typing import Final

import numpy as np

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import BlockSkip, CutterComp, LoadTool
from trunnion.output.compensation_entries import entries_of
from trunnion.output.program import Program
from trunnion.planning.holes.operations import cycle_row_ranges

#: The axis perpendicular to each plane of CUTCOM; without one the control works in XY.
_NORMALS: Final = {"": 2, "XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}

#: How far the tool axis may be off that axis, as the sine of the angle.
_ASKEW: Final = 1e-4


def compensation_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse CUTCOM that would offset along the tool, not by the tool's radius, or the points of holes."""
    by_deltas = motion.mode is MachiningMode.TCP and not program.control.family.COMPENSATES_WITH_TCP
    if motion.mode.goes_straight:
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
            problems.append(
                Problem(
                    program.file,
                    event.line,
                    Wording("CTL220", "cutcom_where_cycle", side=event.side, holes_line=holes[0].line),
                )
            )
            continue
        in_plane = np.delete(axes, _NORMALS.get(event.plane, 2), axis=1)
        if float(np.abs(in_plane).max()) <= _ASKEW and not by_deltas:
            continue
        plane = event.plane or "XYPLAN"
        would_help = plane == "XYPLAN" and not float(np.ptp(axes, axis=0).max()) and _takes_tilted(program, motion)
        problems.append(
            Problem(
                program.file_of(operation),
                event.line,
                (
                    Wording("CTL220", "cutcom_where_control", mode=motion.mode)
                    if would_help
                    else Wording("CTL220", "cutcom_where_control_takes", mode=motion.mode)
                )
                if by_deltas
                else (
                    Wording("CTL220", "cutcom_where_tool", plane=plane, mode=motion.mode)
                    if would_help
                    else Wording("CTL220", "cutcom_where_tool_not", plane=plane, mode=motion.mode)
                ),
            )
        )
    return problems


def _takes_tilted(program: Program, motion: Motion) -> bool:
    return motion.mode is not MachiningMode.TILTED and MachiningMode.TILTED in program.control.modes({})


def register_problems(program: Program) -> list[Problem]:
    """Refuse one register for a contour and for the path of a tool's centre: it cannot hold radius and difference."""
    problems: list[Problem] = []
    known: dict[tuple[str, int], tuple[bool, str]] = {}
    tool = ""
    for motion in program.motions:
        operation = motion.operation
        tool = next((str(event.number) for event in operation.events if isinstance(event, LoadTool)), tool)
        for entry in entries_of(program, [motion], tool):
            contour, before = known.setdefault((tool, entry.register), (entry.contour, operation.name))
            if contour != entry.contour:
                names = (operation.name, before) if entry.contour else (before, operation.name)
                wording = Wording("CTL220", "contour_and_centre", where=entry.where, contour=names[0], centre=names[1])
                problems.append(Problem(program.file_of(operation), operation.line, wording))
    return problems


def skipped_side_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse CUTCOM within OPSKIP that waits for the motion behind it, where its words make no block alone; and before
    OPSKIP, if it waits for a motion within.

    Words and motion are one block, which is skipped or not.
    """
    control = program.control
    bare = {word.name for word in control.words if word.bare}
    problems: list[Problem] = []
    waiting: CutterComp | None = None
    skips = False
    for event in motion.operation.events:
        if isinstance(event, BlockSkip):
            if waiting is not None and skips and not event.on and waiting.row == event.row:
                wording = Wording("CTL460", "cutcom_waits", side=waiting.side, off=event.line)
                problems.append(Problem(program.file_of(motion.operation), waiting.line, wording))
            elif waiting is not None and not skips and event.on and waiting.row == event.row:
                wording = Wording("CTL460", "cutcom_skipped", side=waiting.side, on=event.line)
                problems.append(Problem(program.file_of(motion.operation), waiting.line, wording))
            skips, waiting = event.on, None
        elif isinstance(event, CutterComp):
            words = control.family.event_words(event, control.codes, control.coolant)
            waiting = event if bare.issuperset(words) else None
    return problems
