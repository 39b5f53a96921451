"""Tilted planes as they are for the digits that a program prints."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from trunnion.machines import Machine
from trunnion.model.motion import Motion
from trunnion.output.coordinates.plane_from_pose import with_plane_inside_limits, with_plane_of_pose
from trunnion.output.program import Program


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
    return replace(program, motions=motions)
