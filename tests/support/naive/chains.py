"""The forward map by the textbook: a product of 4x4 matrices, in plain NumPy."""

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine


def translation(offset: Floats) -> Floats:
    """The 4x4 matrix of a shift."""
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def rotation(direction: Floats, degrees: float) -> Floats:
    """The 4x4 matrix of a right-handed rotation about a line through the origin."""
    x, y, z = direction
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return matrix


def naive_forward(machine: Machine, joints: Floats, tool_length: float) -> tuple[Floats, Floats]:
    """Tool tip and tool axis of one row of axis values."""
    pose = np.eye(4)
    for axis, value in zip(machine.axes, joints, strict=True):
        direction, point = np.array(axis.direction), np.array(axis.point)
        signed = value if axis.positive == "standard" else -value
        if axis.kind == "linear":
            pose = pose @ translation(direction * signed)
        else:
            pose = pose @ translation(point) @ rotation(direction, signed) @ translation(-point)
    spindle = np.array(machine.spindle_direction)
    tip = np.append(np.array(machine.spindle_point) - tool_length * spindle, 1.0)
    zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0))
    return (pose @ tip)[:3] - zero, pose[:3, :3] @ spindle


def turned(axis: int, angle: float) -> Floats:
    """The matrix of a right-handed rotation about X, Y or Z, degrees."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    if axis == 0:
        return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    if axis == 1:
        return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
