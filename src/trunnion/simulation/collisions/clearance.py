"""How far a body can have moved against another while the axes go from one position to the next.

A ball around the body is carried through the joints between the two links. A slide moves every point by its own way, a
rotary axis by its angle times the distance of the farthest point from its line; the ball grows by what it sweeps. Two
bodies whose surfaces are d apart cannot touch before that sum has reached d: so far a check may skip.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.machines import Machine
from trunnion.machines.links import LinkChain, axes_between, is_nearer_the_tool

#: Lines nearer to each other than this are one, mm, and directions as well.
_SAME: Final = 1e-6


@kernel(writes="bounds")
def motion_bounds(
    chain: LinkChain, columns: Ints, senses: Floats, centre: Floats, radius: float, joints: Floats2, bounds: Floats
) -> None:
    """Write how far any point of a ball can move from each row of ``joints`` (k + 1, 5) to the next, (k,) mm.

    columns, senses   the joints from the link of the ball to that of the other body, and the sign of their motion
    centre, radius    of the ball in the machine frame with all axes at zero, mm
    """
    for piece in range(joints.shape[0] - 1):
        x, y, z, r = centre[0], centre[1], centre[2], radius
        bound = 0.0
        for k in range(columns.shape[0]):
            joint = columns[k]
            a, b, c = chain.direction[joint, 0], chain.direction[joint, 1], chain.direction[joint, 2]
            change = abs(joints[piece + 1, joint] - joints[piece, joint])
            middle = senses[k] * 0.5 * (joints[piece + 1, joint] + joints[piece, joint])
            if not chain.rotary[joint]:
                bound += change
                x, y, z, r = x + a * middle, y + b * middle, z + c * middle, r + 0.5 * change
                continue
            turn = math.radians(change)
            ox, oy, oz = chain.point[joint, 0], chain.point[joint, 1], chain.point[joint, 2]
            x, y, z = x - ox, y - oy, z - oz
            along = a * x + b * y + c * z
            across = math.sqrt(max(x * x + y * y + z * z - along * along, 0.0))
            bound += turn * (across + r)
            r += 2.0 * across * math.sin(min(turn / 4.0, math.pi / 2.0))
            angle = math.radians(middle - 360.0 * math.floor(middle / 360.0 + 0.5))
            cos, sin = math.cos(angle), math.sin(angle)
            along *= 1.0 - cos
            x, y, z = (
                x * cos + (b * z - c * y) * sin + a * along + ox,
                y * cos + (c * x - a * z) * sin + b * along + oy,
                z * cos + (a * y - b * x) * sin + c * along + oz,
            )
        bounds[piece] = bound


@kernel(writes="pose")
def relative_pose(chain: LinkChain, columns: Ints, senses: Floats, joints: Floats, pose: Floats2) -> None:
    """Write the map (4, 4) from the frame of one link to that of another, for axis values (5,).

    Both frames are the machine frame with all axes at zero, carried along; columns and senses as in ``motion_bounds``.
    """
    write_relative_pose(chain, columns, senses, joints, pose)


@inner
def write_relative_pose(chain: LinkChain, columns: Ints, senses: Floats, joints: Floats, pose: Floats2) -> None:
    """Do what ``relative_pose`` does, for kernels."""
    for i in range(4):
        for j in range(4):
            pose[i, j] = 1.0 if i == j else 0.0
    for k in range(columns.shape[0]):
        joint = columns[k]
        a, b, c = chain.direction[joint, 0], chain.direction[joint, 1], chain.direction[joint, 2]
        q = senses[k] * joints[joint]
        if not chain.rotary[joint]:
            pose[0, 3], pose[1, 3], pose[2, 3] = pose[0, 3] + a * q, pose[1, 3] + b * q, pose[2, 3] + c * q
            continue
        angle = math.radians(q - 360.0 * math.floor(q / 360.0 + 0.5))
        cos, sin = math.cos(angle), math.sin(angle)
        for column in range(4):
            x, y, z = pose[0, column], pose[1, column], pose[2, column]
            if column == 3:
                x, y, z = x - chain.point[joint, 0], y - chain.point[joint, 1], z - chain.point[joint, 2]
            along = (a * x + b * y + c * z) * (1.0 - cos)
            pose[0, column] = x * cos + (b * z - c * y) * sin + a * along
            pose[1, column] = y * cos + (c * x - a * z) * sin + b * along
            pose[2, column] = z * cos + (a * y - b * x) * sin + c * along
        for i in range(3):
            pose[i, 3] += chain.point[joint, i]


def turns_about_itself(machine: Machine, column: int, line: Floats | None) -> bool:
    """Whether a joint only turns a body of revolution about its own axis, ``line`` (2, 3): nothing moves then."""
    axis = machine.axes[column]
    if line is None or not axis.is_rotary:
        return False
    away = line[0] - np.array(axis.point)
    straight = np.linalg.norm(np.cross(line[1], axis.direction)) < _SAME
    return bool(straight and np.linalg.norm(np.cross(away, axis.direction)) < _SAME)


def joint_senses(machine: Machine, one: str, other: str) -> tuple[Ints, Floats]:
    """Return the joints from one link to another, and the sense in which each moves the first against the second.

    From the tool towards the workpiece joints move as their values say; the other way they move back.
    """
    columns = axes_between(machine, one, other)
    sense = 1.0 if is_nearer_the_tool(machine, one, other) else -1.0
    return np.array(columns, np.int64), np.full(len(columns), sense)
