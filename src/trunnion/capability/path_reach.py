"""Which points of CL files the tip reaches."""

from collections.abc import Callable, Sequence
from typing import Annotated

import numpy as np

from trunnion.arrays import Flags, Floats, Lines
from trunnion.machines import Machine
from trunnion.machines.reach import reached_points
from trunnion.model.frames import into_frame
from trunnion.model.toolpath import Operation, Toolpath
from trunnion.records import dataclass
from trunnion.results import Figure


@dataclass(frozen=True, slots=True)
class PathReach:
    """What is reached of the points of a CL file.

    points       how many there are
    tilts        least and greatest tilt of the tool axis from the workpiece's Z, degrees
    no_axis      points whose tool axis the rotary axes do not give, and the line of the first; 0 for none
    no_travel    points beyond the travel of the linear axes with every rotary position, and the line of the first
    """

    file: str
    points: int
    tilts: Annotated[tuple[float, float], Figure("tilt_deg", decimals=6)]
    no_axis: Annotated[int, Figure("points", within="no_tool_axis")]
    no_axis_line: Annotated[int, Figure("first_line", none=0, within="no_tool_axis")]
    no_travel: Annotated[int, Figure("points", within="no_travel")]
    no_travel_line: Annotated[int, Figure("first_line", none=0, within="no_travel")]


def path_reach(
    machine_of: Callable[[Operation], Machine], toolpaths: Sequence[Toolpath], step: float
) -> tuple[PathReach, ...]:
    """Judge the points of CL files, in the coordinates of the first operation; each has a machine with its own tool."""
    operations = [operation for toolpath in toolpaths for operation in toolpath.operations if len(operation.moves)]
    if not operations:
        return ()
    frame = operations[0].frame
    return tuple(
        _of_file(
            each.file, [(machine_of(one), into_frame(one, frame)) for one in each.operations if len(one.moves)], step
        )
        for each in toolpaths
        if any(len(one.moves) for one in each.operations)
    )


def _of_file(file: str, operations: Sequence[tuple[Machine, Operation]], step: float) -> PathReach:
    tip = np.concatenate([one.moves.tip for _, one in operations])
    axis = np.concatenate([one.moves.axis for _, one in operations])
    line = np.concatenate([one.moves.line for _, one in operations])
    tilts, has_axis, has_travel = _tilts(axis), np.zeros(len(tip), np.bool_), np.zeros(len(tip), np.bool_)
    machines = {id(machine): machine for machine, _ in operations}
    whose = np.repeat([id(machine) for machine, _ in operations], [len(one.moves) for _, one in operations])
    for key, machine in machines.items():
        rows = np.flatnonzero(whose == key)
        found = reached_points(machine, tip[rows][:, None], axis[rows], step)
        has_axis[rows], has_travel[rows] = found.axis, found.travel
    return PathReach(
        file,
        len(tip),
        (float(tilts.min()), float(tilts.max())),
        *_first(~has_axis, line),
        *_first(has_axis & ~has_travel, line),
    )


def _first(flags: Flags, line: Lines) -> tuple[int, int]:
    """How many rows there are, and the line of the first."""
    rows = np.flatnonzero(flags)
    return len(rows), int(line[rows[0]]) if len(rows) else 0


def _tilts(axis: Floats) -> Floats:
    """Angles from Z, degrees, accurate near both ends as well."""
    return np.asarray(np.degrees(np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])))
