"""Tilted planes as they are for the digits that a program prints."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Frame
from trunnion.output.coordinates.plane_from_pose import plane_of_pose, with_plane_inside_limits, with_plane_of_pose
from trunnion.output.program import Program

#: A plane whose axes are off those of the program by less has no tilt; CL files print seven decimals.
_LEVEL: Final = 1e-6


def with_printed_planes(program: Program) -> Program:
    """Return the program with its tilted planes as they are for the digits that are printed."""
    if all(motion.plane is None for motion in program.motions):
        return program
    adapt: Callable[[Machine, Motion, int], Motion]
    if program.planes_are_of_pose:
        keeps_origin = not program.control.plane_from_pose
        adapt, number_format = partial(with_plane_of_pose, keeps_origin=keeps_origin), "angle"
    else:
        adapt, number_format = with_plane_inside_limits, "plane_angle"
    decimals = program.control.number_formats(three_axis=False)[number_format].decimals
    motions = [m if m.plane is None else adapt(program.machine_of(m), m, decimals) for m in program.motions]
    return replace(program, motions=[out_of_level_plane(program, motion) for motion in motions])


def needs_plane(program: Program, motion: Motion) -> bool:
    """Whether a motion with a tilted plane is written in one: behind others of its operation a level one is not."""
    if motion.plane is None:
        return False
    return not (_may_be_level(program, motion) and motion.plane == Frame() and _stands_level(program, motion))


def out_of_level_plane(program: Program, motion: Motion) -> Motion:
    """Return a motion that goes on in a plane without a tilt or turn in coordinates of the program.

    The axes of the machine must be along those of the program there. If only the axis that the plane leaves free is
    elsewhere, it turns to 0, unless the zero is known and with it what that takes of the travel.
    """
    if not _may_be_level(program, motion):
        return motion
    level = replace(motion, plane=Frame())
    if _stands_level(program, level):
        return level
    machine = program.machine_of(motion)
    at_zero = replace(level, rotary=np.zeros_like(motion.rotary))
    inside = all(machine.axes[axis].low <= 0.0 <= machine.axes[axis].high for axis in machine.rotary)
    free = inside and machine.workpiece_zero is None and _stands_level(program, at_zero)
    return at_zero if free else motion


def _may_be_level(program: Program, motion: Motion) -> bool:
    """Whether a motion goes on behind others of its operation in a plane without a tilt or turn."""
    if motion.plane is None or motion.starts_operation or program.control.plane_from_pose:
        return False
    return _is_identity(motion.plane.matrix())


def _stands_level(program: Program, motion: Motion) -> bool:
    return _is_identity(plane_of_pose(program.machine_of(motion), motion.rotary[0]).matrix())


def _is_identity(matrix: Floats) -> bool:
    return bool(np.abs(matrix - np.eye(3)).max() < _LEVEL)
