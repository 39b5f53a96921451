"""Where the tool is when the axes are somewhere: the forward map of a chain.

In:     a ``Machine`` and displayed axis values, one column an axis, in chain order.
Out:    tool tip and tool axis in workpiece coordinates.
Units:  mm and degrees.

The joints are applied one by one, from the tool back to the workpiece. ``trunnion.machine.inverse`` goes the other way
by another derivation, and neither imports the other: that they agree says something.
"""

import math

import numpy as np
from numba import njit

from trunnion.arrays import Flags, Floats
from trunnion.machine.model import Machine


def forward(machine: Machine, joints: Floats, tool_length: float = 0.0) -> tuple[Floats, Floats]:
    """Tool tip and tool axis for rows of axis values.

    Parameters
    ----------
    machine
        The chain, from the workpiece to the tool.
    joints : (n, 5) float64, mm or deg
        Displayed axis values, one column an axis in the order of ``machine.axes``. Windings may be large.
    tool_length
        From the gauge point to the tip, mm.

    Returns
    -------
    tip : (n, 3) float64, mm
        In workpiece coordinates, counted from ``machine.workpiece_zero``; from the machine's own zero if that is None.
    axis : (n, 3) float64
        Unit vectors from tip to holder, in workpiece coordinates.

    Notes
    -----
    Product of exponentials: with all axes at zero the workpiece frame lies on the machine frame, and each joint moves
    everything between it and the tool by +q along or about its line (Lynch and Park, Modern Robotics, 4.1, space form).
    """
    rows = np.ascontiguousarray(joints, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != 5:
        raise ValueError(f"joints must have shape (n, 5), not {rows.shape}")
    rotary = np.array([axis.is_rotary for axis in machine.axes])
    direction = np.array([[axis.sense * d for d in axis.direction] for axis in machine.axes])
    point = np.array([axis.point for axis in machine.axes])
    spindle = np.array(machine.spindle_direction)
    tip_at_zero = np.array(machine.spindle_point) - tool_length * spindle
    zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0))
    tip = np.empty((len(rows), 3))
    axis = np.empty((len(rows), 3))
    chain_rows(rotary, direction, point, tip_at_zero, spindle, zero, rows, tip, axis)
    return tip, axis


@njit(cache=True)
def chain_rows(
    rotary: Flags,
    direction: Floats,
    point: Floats,
    tip_at_zero: Floats,
    spindle: Floats,
    zero: Floats,
    joints: Floats,
    tip: Floats,
    axis: Floats,
) -> None:
    """Write tip and tool axis of each row of ``joints``.

    rotary       (5,) bool      the joint turns
    direction    (5, 3) float64 the way that growing values move the tool, machine frame, all axes at zero
    point        (5, 3) float64 a point on each rotary axis, mm
    tip_at_zero  (3,) float64   tool tip, mm, machine frame, all axes at zero
    spindle      (3,) float64   tool axis, machine frame, all axes at zero
    zero         (3,) float64   workpiece zero, mm, machine frame, all axes at zero
    joints       (n, 5) float64 displayed values, mm or deg
    tip, axis    (n, 3) float64 written
    """
    for row in range(joints.shape[0]):
        x, y, z = tip_at_zero[0], tip_at_zero[1], tip_at_zero[2]
        i, j, k = spindle[0], spindle[1], spindle[2]
        for joint in range(joints.shape[1] - 1, -1, -1):
            q = joints[row, joint]
            a, b, c = direction[joint, 0], direction[joint, 1], direction[joint, 2]
            if not rotary[joint]:
                x, y, z = x + a * q, y + b * q, z + c * q
                continue
            # Whole turns drop out exactly, so that a wound-up axis costs no digits.
            angle = math.radians(q - 360.0 * math.floor(q / 360.0 + 0.5))
            cos, sin = math.cos(angle), math.sin(angle)
            ox, oy, oz = point[joint, 0], point[joint, 1], point[joint, 2]
            x, y, z = x - ox, y - oy, z - oz
            # Rodrigues: v cos + (w x v) sin + w (w.v)(1 - cos)
            along = (a * x + b * y + c * z) * (1.0 - cos)
            x, y, z = (
                x * cos + (b * z - c * y) * sin + a * along + ox,
                y * cos + (c * x - a * z) * sin + b * along + oy,
                z * cos + (a * y - b * x) * sin + c * along + oz,
            )
            along = (a * i + b * j + c * k) * (1.0 - cos)
            i, j, k = (
                i * cos + (b * k - c * j) * sin + a * along,
                j * cos + (c * i - a * k) * sin + b * along,
                k * cos + (a * j - b * i) * sin + c * along,
            )
        tip[row, 0], tip[row, 1], tip[row, 2] = x - zero[0], y - zero[1], z - zero[2]
        axis[row, 0], axis[row, 1], axis[row, 2] = i, j, k
