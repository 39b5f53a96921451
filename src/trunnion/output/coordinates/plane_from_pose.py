"""Tilted planes for the digits that are printed.

Some controls take a tilted plane from the rotary position, without angles: its origin is that of the work offset, its
axes are those of the machine turned with the tool. Such a plane is computed for the rotary position as printed, so that
rounding an angle does not move the tip. Other controls compute the rotary position from the angles of the plane: it
must be within the limits for the angles as printed.
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

#: Decimals of vectors that describe a plane.
_VECTOR_DECIMALS: Final = 7

#: A control accepts a position up to this far beyond a limit, degrees.
_LIMIT_TOLERANCE: Final = 5e-7

#: A solution within this of the planned position is that position, degrees.
_SOLUTION_TOLERANCE: Final = 0.1


def with_plane_of_pose(machine: Machine, motion: Motion, decimals: int, *, keeps_origin: bool = False) -> Motion:
    """Return a motion in the tilted plane of its rotary position, as printed with ``decimals``.

    ``keeps_origin``: the program states the origin of the plane; else it is that of the work offset.
    """
    rotary = round_to_counts(np.ascontiguousarray(motion.rotary[0]), decimals) / 10.0**decimals
    plane = plane_of_pose(machine, rotary)
    if keeps_origin and motion.plane is not None:
        plane = replace(plane, origin=motion.plane.origin)
    return replace(motion, plane=plane, rotary=np.tile(rotary, (len(motion.rotary), 1)))


def with_plane_inside_limits(machine: Machine, motion: Motion, decimals: int) -> Motion:
    """Return a motion in a tilted plane whose rounded angles lead to no position beyond a limit.

    Where the rotary axes are too near to a limit, they keep a distance from it that covers the rounding of three
    angles, and the plane turns with them. Elsewhere it is the given motion.

    machine, motion  the motion, and its machine
    decimals         of the plane's angles
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
    """Whether a plane leads beyond a limit, in any of the angles or vectors that controls accept, as printed."""
    matrix = plane.matrix()
    spatial = np.round(tait_bryan_angles(matrix, (2, 1, 0)), decimals)
    euler = np.round(euler_zxz_angles(matrix), decimals)
    normals = np.array([
        (_rotation(2, spatial[0]) @ _rotation(1, spatial[1]) @ _rotation(0, spatial[2]))[:, 2],
        (_rotation(2, euler[0]) @ _rotation(0, euler[1]))[:, 2],
        np.round(matrix[:, 2], _VECTOR_DECIMALS),
    ])  # fmt: skip
    offsets = inverse(machine, np.zeros((3, 3)), normals).joints[..., list(machine.rotary)] - rotary
    offsets -= 360.0 * np.rint(offsets / 360.0)
    solution = np.abs(offsets).sum(axis=2, keepdims=True).argmin(axis=0)[None]
    nearest = np.take_along_axis(offsets, solution, axis=0)[0]
    low, high = machine.limits[list(machine.rotary)].T
    free = np.abs(nearest) > _SOLUTION_TOLERANCE  # at the pole: no rounding turns an axis so far
    beyond = (rotary + nearest < low - _LIMIT_TOLERANCE) | (rotary + nearest > high + _LIMIT_TOLERANCE)
    return bool((beyond & ~free).any())


def _rotation(axis: int, angle: float) -> Floats:
    """(3, 3): a rotation about X, Y or Z (0, 1, 2) by an angle, degrees."""
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    one, two = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[[one, two], [one, two]] = cos
    matrix[one, two], matrix[two, one] = -sin, sin
    return matrix


def plane_of_pose(machine: Machine, rotary: Floats) -> Frame:
    """Return the plane square to the tool at a rotary position (2,), degrees, in the workpiece frame."""
    joints = np.zeros((1, 5))
    joints[0, list(machine.rotary)] = rotary
    x, y = (
        forward(replace(machine, spindle_direction=direction), joints)[1][0]
        for direction in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    )
    return frame_from_vectors(np.zeros(3), x, y)


def tip_after_turn(machine: Machine, tip: Floats, before: Motion, after: Motion) -> Floats:
    """Return where the tip is in the next motion's plane once the rotary axes have turned to it.

    tip            (3,) float64: in the plane of ``before``, mm. The linear axes rest while the rotary axes turn
    before, after  two motions in tilted planes

    (3,) float64  in the plane of ``after``, mm
    """
    assert before.plane is not None
    assert after.plane is not None
    in_workpiece = before.plane.matrix() @ tip + np.array(before.plane.origin)
    joints = slide_positions(machine, in_workpiece[None], before.rotary[:1])
    joints[:, list(machine.rotary)] = after.rotary[:1]
    turned = forward(machine, joints)[0][0]
    return np.asarray(after.plane.matrix().T @ (turned - np.array(after.plane.origin)))
