"""The forward map: tool tip and tool axis for axis values.

In:     a ``Machine`` and displayed axis values, one column for each axis, in chain order.
Out:    tool tip and tool axis in workpiece coordinates.
Units:  mm and degrees.

The joints are applied one by one, from the tool back to the workpiece. ``trunnion.machines.inverse`` is derived in
another way, and neither imports the other, so that their agreement proves both.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, make_read_only
from trunnion.jit import inner, kernel
from trunnion.machines.machine import Machine


def forward(machine: Machine, joints: Floats, tool_length: float | None = None) -> tuple[Floats, Floats]:
    """Tool tip and tool axis for rows of axis values.

    Parameters
    ----------
    machine
        The chain, from the workpiece to the tool.
    joints : (n, 5) float64, mm or deg
        Displayed axis values in the order of ``machine.axes``. Rotary axes may be wound up by many turns.
    tool_length
        From the gauge point to the tip, mm; None: that of ``machine.tool_length``.

    Returns
    -------
    tip : (n, 3) float64, mm
        In workpiece coordinates, counted from ``machine.workpiece_zero``; from the machine's own zero if that is None.
    axis : (n, 3) float64
        Unit vectors from tip to holder, in workpiece coordinates.

    Raises
    ------
    ValueError
        If ``joints`` has another shape.

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
    forward_rows(kinematic_chain(machine, tool_length), rows, tip, axis)
    return tip, axis


def tool_axes(machine: Machine, joints: Floats) -> tuple[Floats, Floats]:
    """Tool axes of consecutive rows, and half-way between each two of them.

    machine  the chain, from the workpiece to the tool
    joints   (n, 5) float64, mm or deg: displayed axis values in the order of ``machine.axes``

    axis      (n, 3) float64: Unit vectors from tip to holder, in workpiece coordinates
    half_way  (n - 1, 3) float64: The same with every joint half-way from one row to the next; rotary axes turn as their
              values say
    """
    axis, half_way = np.empty((len(joints), 3)), np.empty((max(len(joints) - 1, 0), 3))
    tool_axis_rows(kinematic_chain(machine), machine.rotary, joints, axis, half_way)
    return axis, half_way


class KinematicChain(NamedTuple):
    """The axes of a machine with a tool, for kernels.

    rotary       (5,) bool      the joint turns
    direction    (5, 3) float64 in which growing values move the tool, machine frame, all axes at zero
    point        (5, 3) float64 a point on each rotary axis, mm
    tip_at_zero  (3,) float64   tool tip, mm, machine frame, all axes at zero
    spindle      (3,) float64   tool axis, machine frame, all axes at zero
    zero         (3,) float64   workpiece zero, mm, machine frame, all axes at zero
    """

    rotary: Flags
    direction: Floats2
    point: Floats2
    tip_at_zero: Floats
    spindle: Floats
    zero: Floats


@lru_cache(maxsize=16)  # the checks ask for single rows, and putting the chain together takes longer than these
def kinematic_chain(machine: Machine, tool_length: float | None = None) -> KinematicChain:
    """Return the chain of a machine; its arrays are read-only.

    tool_length  from the gauge point to the tip, mm; None: that of ``machine.tool_length``
    """
    spindle = np.array(machine.spindle_direction)
    length = (machine.tool_length or 0.0) if tool_length is None else tool_length
    chain = KinematicChain(
        rotary=np.array([axis.is_rotary for axis in machine.axes]),
        direction=np.array([[axis.sense * d for d in axis.direction] for axis in machine.axes]),
        point=np.array([axis.point for axis in machine.axes]),
        tip_at_zero=np.array(machine.spindle_point) - length * spindle,
        spindle=spindle,
        zero=np.array(machine.workpiece_zero or (0.0, 0.0, 0.0), np.float64),
    )
    make_read_only(*chain)
    return chain


@kernel(writes="tip axis")
def forward_rows(chain: KinematicChain, joints: Floats2, tip: Floats2, axis: Floats2) -> None:
    """Write tip and tool axis (n, 3) of each row of ``joints`` (n, 5)."""
    for row in range(joints.shape[0]):
        forward_row(chain, joints[row], tip[row], axis[row])


@inner
def forward_row(chain: KinematicChain, joints: Floats, tip: Floats, axis: Floats) -> None:
    """Write tip and tool axis (3,) of displayed values (5,), mm or deg."""
    x, y, z = chain.tip_at_zero[0], chain.tip_at_zero[1], chain.tip_at_zero[2]
    i, j, k = chain.spindle[0], chain.spindle[1], chain.spindle[2]
    for joint in range(4, -1, -1):
        q = joints[joint]
        a, b, c = chain.direction[joint, 0], chain.direction[joint, 1], chain.direction[joint, 2]
        if not chain.rotary[joint]:
            x, y, z = x + a * q, y + b * q, z + c * q
            continue
        # Whole turns drop out exactly, so that a wound-up axis loses no digits.
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


@kernel(writes="axis half_way")
def tool_axis_rows(
    chain: KinematicChain, rotary_columns: tuple[int, int], joints: Floats2, axis: Floats2, half_way: Floats2
) -> None:
    """Write the tool axis of each row, and of the middle between each two rows.

    rotary_columns  columns of the two rotary axes
    joints          (n, 5) float64
    axis            (n, 3) float64, written
    half_way        (n - 1, 3) float64, written
    """
    one, two = rotary_columns
    cos_1, sin_1, cos_2, sin_2 = 1.0, 0.0, 1.0, 0.0
    for row in range(joints.shape[0]):
        previous = cos_1, sin_1, cos_2, sin_2
        cos_1, sin_1 = _cos_sin(joints[row, one])
        cos_2, sin_2 = _cos_sin(joints[row, two])
        i, j, k = _rotate_about_joint(chain, two, cos_2, sin_2, chain.spindle[0], chain.spindle[1], chain.spindle[2])
        axis[row, 0], axis[row, 1], axis[row, 2] = _rotate_about_joint(chain, one, cos_1, sin_1, i, j, k)
        if row == 0:
            continue
        cos, sin = _cos_sin_half_way(joints[row - 1, two], joints[row, two], previous[2], previous[3], cos_2, sin_2)
        i, j, k = _rotate_about_joint(chain, two, cos, sin, chain.spindle[0], chain.spindle[1], chain.spindle[2])
        cos, sin = _cos_sin_half_way(joints[row - 1, one], joints[row, one], previous[0], previous[1], cos_1, sin_1)
        i, j, k = _rotate_about_joint(chain, one, cos, sin, i, j, k)
        half_way[row - 1, 0], half_way[row - 1, 1], half_way[row - 1, 2] = i, j, k


@inner
def _cos_sin(q: float) -> tuple[float, float]:
    """Cosine and sine of an angle in degrees; whole turns drop out exactly."""
    angle = math.radians(q - 360.0 * math.floor(q / 360.0 + 0.5))
    return math.cos(angle), math.sin(angle)


@inner
def _cos_sin_half_way(
    a: float, b: float, cos_a: float, sin_a: float, cos_b: float, sin_b: float
) -> tuple[float, float]:
    """Cosine and sine of the mean of two angles in degrees, from theirs: the sum of both unit vectors points there."""
    if abs(b - a) > 90.0:
        return _cos_sin(0.5 * (a + b))
    cos, sin = cos_a + cos_b, sin_a + sin_b
    length = math.sqrt(cos * cos + sin * sin)
    return cos / length, sin / length


@inner
def _rotate_about_joint(
    chain: KinematicChain, joint: int, cos: float, sin: float, i: float, j: float, k: float
) -> tuple[float, float, float]:
    """Return a direction turned about a rotary joint, by Rodrigues: v cos + (w x v) sin + w (w.v)(1 - cos)."""
    a, b, c = chain.direction[joint, 0], chain.direction[joint, 1], chain.direction[joint, 2]
    along = (a * i + b * j + c * k) * (1.0 - cos)
    return (
        i * cos + (b * k - c * j) * sin + a * along,
        j * cos + (c * i - a * k) * sin + b * along,
        k * cos + (a * j - b * i) * sin + c * along,
    )
