"""Tilted planes: how the tool's frame lies with the rotary axes somewhere, and where they must be for a plane."""

import math

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, inverse
from trunnion.machines.inverse import POLE_TOLERANCE
from trunnion.model.axis_positions import TRAVEL_TOLERANCE, nearest_turn
from trunnion.readers.control.affine_map import rotation_about


def tool_frame(machine: Machine, rotary: tuple[float, float]) -> Floats:
    """(3, 3): the tool's frame as seen from the workpiece, with the rotary axes at these values, degrees."""
    linear = np.eye(3)
    for column, value in sorted(zip(machine.rotary, rotary, strict=True)):
        axis = machine.axes[column]
        linear = linear @ rotation_about(np.array(axis.direction), axis.sense * value)
    return linear


def solutions(machine: Machine, normal: Floats, current_joints: Floats) -> list[tuple[float, float]]:
    """Both rotary positions whose tool axis is ``normal`` (3,), degrees; none if there is no such position.

    Where the first axis is free it stays as it is in ``held`` (5,).
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
    """Return the position with the first axis, which is free there, turned so that the tool's X looks ``along`` (3,).

    ``along`` is seen from the workpiece. Only turns about the first axis are looked at.
    """
    axis = machine.axes[machine.rotary[0]]
    about_first = np.array(axis.direction)
    x = tool_frame(machine, (0.0, rotary[1]))[:, 0]
    sine, cosine = float(np.cross(x, along) @ about_first), float(x @ along - (x @ about_first) * (along @ about_first))
    return axis.sense * math.degrees(math.atan2(sine, cosine)), rotary[1]


def first_axis_is_free(machine: Machine, rotary: tuple[float, float]) -> bool:
    """Whether the tool axis stands along the first rotary axis, so that this one does not tilt it."""
    tool = tool_frame(machine, rotary) @ np.array(machine.spindle_direction)
    return float(np.linalg.norm(np.cross(tool, np.array(machine.axes[machine.rotary[0]].direction)))) < POLE_TOLERANCE


def is_in_travel(machine: Machine, rotary: tuple[float, float]) -> bool:
    """Whether both rotary axes have the position in their travel, in some turn."""
    axes = (machine.axes[column] for column in machine.rotary)
    return all(
        axis.endless
        or any(
            axis.low - TRAVEL_TOLERANCE <= value + turn <= axis.high + TRAVEL_TOLERANCE for turn in (0.0, -360.0, 360.0)
        )
        for axis, value in zip(axes, rotary, strict=True)
    )


def nearest_in_travel(machine: Machine, rotary: tuple[float, float], current_joints: Floats) -> tuple[float, float]:
    """The turns of a rotary position that lie inside the travel, nearest to where the axes stand in ``held`` (5,)."""
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
