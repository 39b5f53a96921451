"""Whether the tool is far enough from the part for a turn from plane to plane.

In:     a program's motions, and the place of the tool before the turn.
Out:    yes or no. The check `turns` derives its number from the finished program instead.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import (
    SAFE_DISTANCE,
    Machine,
    SweptPart,
    slide_positions,
    turn_clearance,
    turns_part_alone,
)
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Operation
from trunnion.output.coordinates.extents import cut_extents
from trunnion.output.program import Program
from trunnion.planning.holes.cycles import cycle_from_event
from trunnion.planning.holes.operations import cycle_row_ranges

#: Smaller rotary motion, degrees, keeps the tilt: it is less than any control prints.
_STILL = 1e-6


def part_of(program: Program) -> SweptPart:
    """Return the part around everything that a program cuts, its zero, and its block form."""
    points = [np.zeros(3)]
    points += cut_extents(program.motions) or ()
    if len(corners := program.effective_setting("blank").split(",")) == 6:  # a block form that the program states
        points += list(np.array(list(map(float, corners))).reshape(2, 3))
    for motion in program.motions:
        points += _feed_starts(motion.operation)
    return SweptPart.around(program.machine, np.array(points).reshape(-1, 3))


def _feed_starts(operation: Operation) -> list[Floats]:
    """Where the tool begins to feed into each hole, (3,) each."""
    tip, axis = operation.moves.tip, operation.moves.axis
    return [
        tip[row] + cycle_from_event(event).rapid_height * axis[row]
        for event, end in cycle_row_ranges(operation)
        for row in range(event.row, end)
    ]


def is_clear_of_turn(machine: Machine, part: SweptPart, tip: Floats, before: Motion, after: Motion) -> bool:
    """Whether the rotary axes may turn from one plane to the next where the tool is.

    Only the rotary axis next to the part may, for a table, and only if the part that it turns stays away from the tool.

    part  in the program's coordinate system
    tip   (3,) float64: in the plane of ``before``, mm
    """
    assert before.plane is not None
    in_workpiece = before.plane.matrix() @ tip + np.array(before.plane.origin)
    joints = slide_positions(machine, in_workpiece[None], before.rotary[:1])[0]
    turned = joints.copy()
    turned[list(machine.rotary)] = after.rotary[0]
    if not turns_part_alone(machine, joints, turned, _STILL):
        return False
    return turn_clearance(machine, joints, turned, part) >= SAFE_DISTANCE
