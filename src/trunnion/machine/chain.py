"""Where the tool is when the axes are somewhere: the forward map of a chain.

In:     a ``Machine`` and displayed axis values, one column an axis, in chain order.
Out:    tool tip and tool axis in workpiece coordinates.
Units:  mm and degrees.

The joints are applied one by one, from the tool back to the workpiece. ``trunnion.machine.inverse`` goes the other way
by another derivation, and neither imports the other: that they agree says something.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from trunnion.arrays import Flags, Floats
from trunnion.machine.model import Machine


def forward(machine: Machine, joints: Floats, tool_length: float | None = None) -> tuple[Floats, Floats]:
    """Tool tip and tool axis for rows of axis values.

    Parameters
    ----------
    machine
        The chain, from the workpiece to the tool.
    joints : (n, 5) float64, mm or deg
        Displayed axis values, one column an axis in the order of ``machine.axes``. Windings may be large.
    tool_length
        From the gauge point to the tip, mm; None: that of ``machine.tool_length``.

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
    tip = np.empty((len(rows), 3))
    axis = np.empty((len(rows), 3))
    chain_rows(pack_chain(machine, tool_length), rows, tip, axis)
    return tip, axis


class Chain(NamedTuple):
    """A chain as kernels take it.

    rotary       (5,) bool      the joint turns
    direction    (5, 3) float64 the way that growing values move the tool, machine frame, all axes at zero
    point        (5, 3) float64 a point on each rotary axis, mm
    tip_at_zero  (3,) float64   tool tip, mm, machine frame, all axes at zero
    spindle      (3,) float64   tool axis, machine frame, all axes at zero
    zero         (3,) float64   workpiece zero, mm, machine frame, all axes at zero
    """

    rotary: Flags
    direction: Floats
    point: Floats
    tip_at_zero: Floats
    spindle: Floats
    zero: Floats


def pack_chain(machine: Machine, tool_length: float | None = None) -> Chain:
    """A machine's chain for kernels; tool length from the gauge point to the tip, mm, None: the machine's."""
    spindle = np.array(machine.spindle_direction)
    length = (machine.tool_length or 0.0) if tool_length is None else tool_length
    return Chain(
        rotary=np.array([axis.is_rotary for axis in machine.axes]),
        direction=np.array([[axis.sense * d for d in axis.direction] for axis in machine.axes]),
        point=np.array([axis.point for axis in machine.axes]),
        tip_at_zero=np.array(machine.spindle_point) - length * spindle,
        spindle=spindle,
        zero=np.array(machine.workpiece_zero or (0.0, 0.0, 0.0)),
    )


@njit(cache=True)
def chain_rows(chain: Chain, joints: Floats, tip: Floats, axis: Floats) -> None:
    """Write tip and tool axis (n, 3) of each row of ``joints`` (n, 5)."""
    for row in range(joints.shape[0]):
        chain_row(chain, joints[row], tip[row], axis[row])


@njit(cache=True)
def chain_row(chain: Chain, joints: Floats, tip: Floats, axis: Floats) -> None:
    """Write tip and tool axis (3,) of displayed values (5,), mm or deg."""
    x, y, z = chain.tip_at_zero[0], chain.tip_at_zero[1], chain.tip_at_zero[2]
    i, j, k = chain.spindle[0], chain.spindle[1], chain.spindle[2]
    for joint in range(4, -1, -1):
        q = joints[joint]
        a, b, c = chain.direction[joint, 0], chain.direction[joint, 1], chain.direction[joint, 2]
        if not chain.rotary[joint]:
            x, y, z = x + a * q, y + b * q, z + c * q
            continue
        # Whole turns drop out exactly, so that a wound-up axis costs no digits.
        angle = math.radians(q - 360.0 * math.floor(q / 360.0 + 0.5))
        cos, sin = math.cos(angle), math.sin(angle)
        ox, oy, oz = chain.point[joint, 0], chain.point[joint, 1], chain.point[joint, 2]
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
    tip[0], tip[1], tip[2] = x - chain.zero[0], y - chain.zero[1], z - chain.zero[2]
    axis[0], axis[1], axis[2] = i, j, k
