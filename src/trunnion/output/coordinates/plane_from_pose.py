"""Tilted planes as the rotary axes stand there, for the digits that are printed.

Some controls take a plane from where the rotary axes stand; no words say its angles. Its zero is the work offset's, its
axes are those of the machine turned with the tool. It is worked out for the rotary position as it is printed, so that
rounding an angle costs nothing at the tip. Others are told angles of the plane, and find the position themselves: it
must be within the limits for the angles as they are rounded.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.words import round_to_counts
from trunnion.machines import Machine, forward, inverse, slide_positions
from trunnion.model.frames import frame_from_vectors
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Frame
from trunnion.output.coordinates.euler_angles import euler_zxz_angles, tait_bryan_angles

#: Decimals of vectors that say a plane.
_VECTOR_DECIMALS: Final = 7

#: A position is surely within a limit up to this beyond it, degrees; and is the one that is meant up to this off it.
_LIMIT_TOLERANCE, _SOLUTION_TOLERANCE = 5e-7, 0.1


def with_plane_of_pose(machine: Machine, motion: Motion, decimals: int) -> Motion:
    """A motion in a tilted plane, in the plane of its rotary position printed with so many decimals."""
    rotary = round_to_counts(np.ascontiguousarray(motion.rotary[0]), decimals) / 10.0**decimals
    return replace(motion, plane=plane_of_pose(machine, rotary), rotary=np.tile(rotary, (len(motion.rotary), 1)))


def with_plane_inside_limits(machine: Machine, motion: Motion, decimals: int) -> Motion:
    """A motion whose tilted plane asks for no position beyond a limit when its angles are rounded; itself if it is one.

    Where it stands so near to a limit of a rotary axis, the axis keeps from it what rounding three angles comes to, and
    the plane turns along.
    """
    if motion.plane is None or not _exceeds_limits(machine, motion.plane, motion.rotary[0], decimals):
        return motion
    margin = 1.5 * 10.0**-decimals
    low, high = machine.limits[list(machine.rotary)].T
    rotary = np.clip(motion.rotary[0], low + margin, high - margin)
    turn = plane_of_pose(machine, rotary).matrix() @ plane_of_pose(machine, motion.rotary[0]).matrix().T
    matrix = turn @ motion.plane.matrix()
    plane = frame_from_vectors(np.array(motion.plane.origin), matrix[:, 0], matrix[:, 1])
    return replace(motion, plane=plane, rotary=np.tile(rotary, (len(motion.rotary), 1)))


def _exceeds_limits(machine: Machine, plane: Frame, rotary: Floats, decimals: int) -> bool:
    """Whether a plane asks for a position beyond a limit, said by any three angles or vectors of that many decimals."""
    matrix = plane.matrix()
    spatial, turns = (
        np.round(tait_bryan_angles(matrix, (2, 1, 0)), decimals),
        np.round(euler_zxz_angles(matrix), decimals),
    )
    normals = np.array([
        (_rotation(2, spatial[0]) @ _rotation(1, spatial[1]) @ _rotation(0, spatial[2]))[:, 2],
        (_rotation(2, turns[0]) @ _rotation(0, turns[1]))[:, 2],
        np.round(matrix[:, 2], _VECTOR_DECIMALS),
    ])  # fmt: skip
    asked = inverse(machine, np.zeros((3, 3)), normals).joints[..., list(machine.rotary)] - rotary
    asked -= 360.0 * np.rint(asked / 360.0)
    nearest = np.take_along_axis(asked, np.abs(asked).sum(axis=2, keepdims=True).argmin(axis=0)[None], axis=0)[0]
    low, high = machine.limits[list(machine.rotary)].T
    near_pole = np.abs(nearest) > _SOLUTION_TOLERANCE  # there one angle is free, and no rounding has turned it so far
    beyond = (rotary + nearest < low - _LIMIT_TOLERANCE) | (rotary + nearest > high + _LIMIT_TOLERANCE)
    return bool((beyond & ~near_pole).any())


def _rotation(axis: int, angle: float) -> Floats:
    """(3, 3): a turn about X, Y or Z (0, 1, 2) by degrees."""
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    one, two = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[[one, two], [one, two]] = cos
    matrix[one, two], matrix[two, one] = -sin, sin
    return matrix


def plane_of_pose(machine: Machine, rotary: Floats) -> Frame:
    """The plane on which the tool stands at a rotary position (2,), degrees, as seen from the workpiece."""
    joints = np.zeros((1, 5))
    joints[0, list(machine.rotary)] = rotary
    x, y = (
        forward(replace(machine, spindle_direction=direction), joints)[1][0]
        for direction in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    )
    return frame_from_vectors(np.zeros(3), x, y)


def tip_after_turn(machine: Machine, place: Floats, before: Motion, after: Motion) -> Floats:
    """Where a tool at ``place`` (3,) of one motion's plane is in that of the next, once the rotary axes have turned.

    The slides stand still meanwhile, mm.
    """
    assert before.plane is not None
    assert after.plane is not None
    tip = before.plane.matrix() @ place + np.array(before.plane.origin)
    joints = slide_positions(machine, tip[None], before.rotary[:1])
    joints[:, list(machine.rotary)] = after.rotary[:1]
    there = forward(machine, joints)[0][0]
    return np.asarray(after.plane.matrix().T @ (there - np.array(after.plane.origin)))
