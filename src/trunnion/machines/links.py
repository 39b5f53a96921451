"""Where each part of a machine stands: the links of its chain, for axis values.

In:     a ``Machine`` and displayed axis values, one column for each axis, in chain order.
Out:    for each link the map from the machine frame with all axes at zero to where it is.
Units:  mm and degrees.

A link is what moves with an axis, and has its name. Besides there are ``bed``, which never moves, ``workpiece``, which
carries the part, and ``spindle``, which carries the tool. Here the iron moves in the machine frame, while
``trunnion.machines.forward`` moves the tool past a part that stands: a test compares both.
"""

import math
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, make_read_only
from trunnion.jit import inner, kernel
from trunnion.machines.machine import Machine, Mount

BED: Final = "bed"
WORKPIECE: Final = "workpiece"
SPINDLE: Final = "spindle"

#: Links that every machine has besides its axes.
FIXED_LINKS: Final = (BED, WORKPIECE, SPINDLE)


class LinkChain(NamedTuple):
    """A machine as arrays: five joints from the workpiece to the tool, read-only.

    rotary      (5,) bool       turns, or slides
    direction   (5, 3) float64  unit vectors, reversed where values count against ISO 841
    point       (5, 3) float64  points on the lines of rotary joints, mm
    part_axes                   how many of them carry the part
    """

    rotary: Flags
    direction: Floats2
    point: Floats2
    part_axes: int


def link_transforms(machine: Machine, joints: Floats) -> dict[str, Floats]:
    """Return where each link stands.

    machine  the chain, from the workpiece to the tool
    joints   (n, 5) float64, mm or deg: displayed axis values in the order of ``machine.axes``

    dict  by name of link (n, 4, 4) float64: maps from the machine frame with all axes at zero to the machine frame

    Raises ``ValueError`` if ``joints`` has another shape.
    """
    rows = np.ascontiguousarray(joints, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != 5:
        raise ValueError(f"joints must have shape (n, 5), not {rows.shape}")
    poses = np.zeros((5, len(rows), 16))
    link_rows(link_chain(machine), rows, poses.reshape(5 * len(rows), 16))
    maps = poses.reshape(5, len(rows), 4, 4)
    found = {axis.name: maps[k] for k, axis in enumerate(machine.axes)}
    found[BED] = np.broadcast_to(np.eye(4), (len(rows), 4, 4))
    found[WORKPIECE] = found[carrier(machine, WORKPIECE)]
    found[SPINDLE] = found[carrier(machine, SPINDLE)]
    return found


def carrier(machine: Machine, link: str) -> str:
    """Return the axis, or the bed, that a link is: workpiece and spindle are the last links of their side.

    Raises ``KeyError`` if the machine has no such link.
    """
    if link == WORKPIECE:
        return machine.axes[0].name if machine.axes[0].mount is Mount.PART else BED
    if link == SPINDLE:
        return machine.axes[-1].name if machine.axes[-1].mount is Mount.TOOL else BED
    if link != BED:
        machine.column(link)
    return link


def axes_between(machine: Machine, one: str, other: str) -> tuple[int, ...]:
    """Return the columns of the axes that move two links against each other, from the first link to the second."""
    first, second = _place(machine, one), _place(machine, other)
    if first <= second:
        return tuple(range(first, second))
    return tuple(reversed(range(second, first)))


def is_nearer_the_tool(machine: Machine, one: str, other: str) -> bool:
    """Whether the first of two links is nearer to the tool along the chain."""
    return _place(machine, one) > _place(machine, other)


def _place(machine: Machine, link: str) -> int:
    """How many axes are between the workpiece and a link."""
    name = carrier(machine, link)
    part_axes = link_chain(machine).part_axes
    if name == BED:
        return part_axes
    column = machine.column(name)
    return column if column < part_axes else column + 1


@lru_cache(maxsize=16)
def link_chain(machine: Machine) -> LinkChain:
    """Return the machine as arrays."""
    chain = LinkChain(
        rotary=np.array([axis.is_rotary for axis in machine.axes]),
        direction=np.array([[axis.sense * part for part in axis.direction] for axis in machine.axes]),
        point=np.array([axis.point for axis in machine.axes]),
        part_axes=sum(axis.mount is Mount.PART for axis in machine.axes),
    )
    make_read_only(*chain[:3])
    return chain


@kernel(writes="poses")
def link_rows(chain: LinkChain, joints: Floats2, poses: Floats2) -> None:
    """Write ``poses`` (5 n, 16), joint after joint: of each row the map (4, 4) of what moves with the joint."""
    n = joints.shape[0]
    step = np.zeros((4, 4))
    step[3, 3] = 1.0
    for turn in range(5):
        # The part's side goes from the bed to the workpiece, then the tool's side from the bed to the tool.
        joint = chain.part_axes - 1 - turn if turn < chain.part_axes else turn
        before = joint + 1 if joint < chain.part_axes else joint - 1
        on_bed = joint in (chain.part_axes - 1, chain.part_axes)
        # Displayed values move the tool against the part: a table goes the other way.
        sense = -1.0 if joint < chain.part_axes else 1.0
        for row in range(n):
            pose = poses[joint * n + row]
            _joint_step(chain, joint, sense * joints[row, joint], step)
            if on_bed:
                for k in range(16):
                    pose[k] = step[k // 4, k % 4]
                continue
            base = poses[before * n + row]
            for i in range(4):
                for j in range(4):
                    pose[4 * i + j] = (
                        base[4 * i] * step[0, j]
                        + base[4 * i + 1] * step[1, j]
                        + base[4 * i + 2] * step[2, j]
                        + base[4 * i + 3] * step[3, j]
                    )


@inner
def _joint_step(chain: LinkChain, joint: int, q: float, step: Floats) -> None:
    """Write the first three rows of the map (4, 4) by which one joint moves."""
    a, b, c = chain.direction[joint, 0], chain.direction[joint, 1], chain.direction[joint, 2]
    for i in range(3):
        for j in range(3):
            step[i, j] = 1.0 if i == j else 0.0
    if not chain.rotary[joint]:
        step[0, 3], step[1, 3], step[2, 3] = a * q, b * q, c * q
        return
    # Whole turns drop out exactly, so that a wound-up axis loses no digits.
    angle = math.radians(q - 360.0 * math.floor(q / 360.0 + 0.5))
    cos, sin = math.cos(angle), math.sin(angle)
    rest = 1.0 - cos
    step[0, 0], step[0, 1], step[0, 2] = cos + a * a * rest, a * b * rest - c * sin, a * c * rest + b * sin
    step[1, 0], step[1, 1], step[1, 2] = b * a * rest + c * sin, cos + b * b * rest, b * c * rest - a * sin
    step[2, 0], step[2, 1], step[2, 2] = c * a * rest - b * sin, c * b * rest + a * sin, cos + c * c * rest
    x, y, z = chain.point[joint, 0], chain.point[joint, 1], chain.point[joint, 2]
    for i in range(3):
        turned = step[i, 0] * x + step[i, 1] * y + step[i, 2] * z
        step[i, 3] = chain.point[joint, i] - turned
