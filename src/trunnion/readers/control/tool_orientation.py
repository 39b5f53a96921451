"""Tool orientation and rotary positions: the tool's frame at a position, and the positions for a tilted plane."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, inverse
from trunnion.machines.inverse import POLE_TOLERANCE
from trunnion.model.axis_positions import TRAVEL_TOLERANCE, nearest_turn
from trunnion.readers.control.affine_map import rotation_about

#: The tool stands along a direction within this difference of unit vectors; axes turn if by more, degrees.
_STANDS: Final = 2e-4
_TURNED: Final = 0.5


def tool_frame(machine: Machine, rotary: tuple[float, float]) -> Floats:
    """Return the tool's frame in the workpiece frame, (3, 3), with the rotary axes at ``rotary``, degrees."""
    linear = np.eye(3)
    for column, value in sorted(zip(machine.rotary, rotary, strict=True)):
        axis = machine.axes[column]
        linear = linear @ rotation_about(np.array(axis.direction), axis.sense * value)
    return linear


def solutions(machine: Machine, normal: Floats, current_joints: Floats) -> list[tuple[float, float]]:
    """Return both rotary positions whose tool axis is ``normal`` (3,), degrees; an empty list if there are none.

    At the pole, where the first axis is free, it keeps its value in ``current_joints`` (5,).
    """
    solved = inverse(machine, np.zeros((1, 3)), normal[None])
    columns = list(machine.rotary)
    pairs = [(float(first), float(second)) for first, second in solved.joints[:, 0, columns]]
    if not all(math.isfinite(value) for value in pairs[0]):
        return []
    if solved.pole[0]:
        return [(float(current_joints[columns[0]]), second) for _, second in pairs]
    return pairs


def align_first_axis(machine: Machine, rotary: tuple[float, float], along: Floats) -> tuple[float, float]:
    """Return a position at the pole with its free first axis turned so that the tool's X points ``along`` (3,).

    ``along`` is in the workpiece frame; only its part normal to the first axis counts.
    """
    axis = machine.axes[machine.rotary[0]]
    about_first = np.array(axis.direction)
    x = tool_frame(machine, (0.0, rotary[1]))[:, 0]
    sine, cosine = float(np.cross(x, along) @ about_first), float(x @ along - (x @ about_first) * (along @ about_first))
    return axis.sense * math.degrees(math.atan2(sine, cosine)), rotary[1]


def first_axis_is_free(machine: Machine, rotary: tuple[float, float]) -> bool:
    """Whether the tool axis is parallel to the first rotary axis, so that this one does not tilt it."""
    tool = tool_frame(machine, rotary) @ np.array(machine.spindle_direction)
    return float(np.linalg.norm(np.cross(tool, np.array(machine.axes[machine.rotary[0]].direction)))) < POLE_TOLERANCE


def is_other_solution(machine: Machine, target: tuple[float, float], current_joints: Floats, normal: Floats) -> bool:
    """Whether the tool stands along ``normal`` (3,) already, and ``target`` is the other position with that tool axis.

    A program that has positioned the axes and then asks for the other position contradicts itself.
    """
    columns = list(machine.rotary)
    now = float(current_joints[columns[0]]), float(current_joints[columns[1]])
    if first_axis_is_free(machine, target) or first_axis_is_free(machine, now):
        return False
    stands = tool_frame(machine, now) @ np.array(machine.spindle_direction)
    turned = [(goal - at + 180.0) % 360.0 - 180.0 for goal, at in zip(target, now, strict=True)]
    return float(np.linalg.norm(stands - normal)) < _STANDS and max(map(abs, turned)) > _TURNED


def is_in_travel(machine: Machine, rotary: tuple[float, float]) -> bool:
    """Whether a position is in the travel of both rotary axes, in some turn."""
    axes = (machine.axes[column] for column in machine.rotary)
    return all(
        axis.endless
        or any(
            axis.low - TRAVEL_TOLERANCE <= value + turn <= axis.high + TRAVEL_TOLERANCE for turn in (0.0, -360.0, 360.0)
        )
        for axis, value in zip(axes, rotary, strict=True)
    )


def nearest_in_travel(machine: Machine, rotary: tuple[float, float], current_joints: Floats) -> tuple[float, float]:
    """Return a position in the turns within the travel that are nearest to ``current_joints`` (5,)."""
    first, second = (
        float(
            nearest_turn(
                float(current_joints[column]),
                value,
                axis.endless,
                axis.low - TRAVEL_TOLERANCE,
                axis.high + TRAVEL_TOLERANCE,
            )
        )
        for column, value in zip(machine.rotary, rotary, strict=True)
        for axis in (machine.axes[column],)
    )
    return first, second
