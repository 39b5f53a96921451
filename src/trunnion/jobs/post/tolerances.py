"""How far a program may be from its CL points when it is proven: half its last printed digit, and what follows from it.

In:     a program as it was planned.
Out:    tolerances of each operation, mm and degrees, for ``trunnion.verification``.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.controls.family_writer import MAX_CENTRE_ERROR_DIGITS
from trunnion.controls.vocabulary import SURFACE_NORMAL_WORDS
from trunnion.model.frames import TURNING_NOISE, into_plane
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CycleOn
from trunnion.output.coordinates.plane_from_pose import with_plane_inside_limits
from trunnion.output.program import Program
from trunnion.planning.linearization.arc_chords import flat_arcs, radius_change
from trunnion.verification import Tolerances

#: Near the pole a turn of a rotary axis still counts as this part of a turn of the tool axis.
_LEAST_POLE_SINE: Final = 1e-3

#: Added to half a digit, so that a value half-way between two digits is inside.
_SLACK: Final = 1e-9

#: Added to angles, for the arithmetic between vectors and rotary positions.
_ANGLE_SLACK: Final = 1e-8


def program_tolerances(program: Program) -> list[Tolerances]:
    """Tolerances of each operation; motions that belong to one operation have the largest of theirs."""
    tolerances: list[Tolerances] = []
    for motion in program.motions:
        own = _motion_tolerances(program, motion)
        if not motion.starts_operation:
            first = tolerances.pop()
            own = replace(
                own,
                tip=max(own.tip, first.tip),
                angle=max(own.angle, first.angle),
                normal=max(own.normal, first.normal),
                deviations=first.deviations,
            )
        tolerances.append(own)
    return tolerances


def _motion_tolerances(program: Program, motion: Motion) -> Tolerances:
    """Tolerances of one motion."""
    control = program.control
    half = _half_digits(program, motion)
    tip, angle, normal = _in_program_frame(program, motion, half)
    tip += _flattened_rise(motion) + _closing_shift(motion)
    if "arc_angle" in half:
        tip += _helix_angle_error(motion, half["X"], half["arc_angle"])
    if motion.mode is MachiningMode.TCP and any(isinstance(event, CycleOn) for event in motion.operation.events):
        # Heights of holes are printed along their axes from the zero, which rounded rotary positions turn.
        tip += math.radians(angle) * float(np.abs(motion.operation.moves.tip).max()) + TURNING_NOISE
    if motion.mode is MachiningMode.WITHOUT_TCP:
        tip *= math.sqrt(3.0)  # three slides are rounded, and turned parts look at them aslant
    return Tolerances(
        tip,
        angle,
        control.arcs.chord_tolerance,
        half["feed"],
        None if motion.deviations.is_empty else motion.deviations,
        centre=2.0 * MAX_CENTRE_ERROR_DIGITS * half["X"] if control.arcs.by_radius else 0.0,
        normal=normal,
        plane=motion.plane is not None,
    )


def _half_digits(program: Program, motion: Motion) -> dict[str, float]:
    """Half the last digit of every word of a motion's blocks, by the key of the word."""
    machine = program.machine
    primary, secondary = machine.axes[machine.primary].name, machine.axes[machine.secondary].name
    words = program.control.block_words(primary, secondary, motion.three_axis)
    return {word.key: 0.5 * word.format.digit + _SLACK for word in words}


def _in_program_frame(program: Program, motion: Motion, half: Mapping[str, float]) -> tuple[float, float, float]:
    """Tolerances of coordinates (mm), angles (degrees) and surface normals in the program's coordinate system.

    Coordinates in a tilted plane are rounded in the plane, and the plane itself is as its angles are printed.
    """
    control = program.control
    tip, angle = half["X"], max(half["primary"], half["secondary"])
    normal = half.get(SURFACE_NORMAL_WORDS[0], 0.0)
    # Near a pole angles are noisy, and the check takes the paths of the tool axis for straight.
    angle += _ANGLE_SLACK + angle * math.radians(angle) / _LEAST_POLE_SINE
    if motion.plane is None:
        return tip, angle, normal
    if program.planes_are_of_pose:
        # Coordinates are those of the plane as it is printed; circles that are not quite in it are put into it.
        widest = float(motion.operation.arcs.radius.max(initial=0.0))
        return _plane_error(motion, tip, 0.0) + 2.0 * widest * math.radians(2.0 * angle), angle, normal
    decimals = control.number_formats(three_axis=False)["plane_angle"].decimals
    tilt = max(angle, 1.5 * 10.0**-decimals)  # three angles of a plane, or a rotary position
    if with_plane_inside_limits(program.machine_of(motion), motion, decimals) is not motion:
        tilt += 1.5 * 10.0**-decimals
    tip, angle = _plane_error(motion, tip, tilt), math.sqrt(2.0) * tilt + _ANGLE_SLACK
    return tip, angle, math.sqrt(3.0) * (normal + math.radians(tilt))


def _flattened_rise(motion: Motion) -> float:
    """How much circles that are written as flat rise from start to end, mm: less than a printed digit.

    Such a circle lies across a tool axis that is off upright by less than rotary words show, or rises by as little.
    """
    operation = motion.as_written()
    arcs, tip = operation.arcs, operation.moves.tip
    if not len(arcs.row):
        return 0.0
    travel = np.abs(tip[arcs.row] - tip[arcs.row - 1])
    rise = travel[np.arange(len(travel)), np.abs(arcs.normal).argmax(axis=1)]
    return float(rise[flat_arcs(operation)].max(initial=0.0))


def _closing_shift(motion: Motion) -> float:
    """How far the ends of full turns are moved over their starts, mm: by last digits of the CL file."""
    if not len(motion.operation.arcs.row):
        return 0.0
    placed = motion.operation if motion.plane is None else into_plane(motion.operation, motion.plane)
    return float(np.linalg.norm(motion.as_written().moves.tip - placed.moves.tip, axis=1).max())


def _helix_angle_error(motion: Motion, half: float, angle: float) -> float:
    """How much farther the end of a helix may be off that is programmed by its centre and its angle, mm.

    Start and centre are rounded by ``half`` mm, the angle by ``angle`` degrees. The error of the centre counts twice at
    the end, once turned. Added to it is by how much the end in the CL file is off the circle. A helix that follows
    another one starts where that one has really ended, so their errors add up.
    """
    operation = motion.as_written()
    arcs, tip = operation.arcs, operation.moves.tip
    rises = (arcs.full_turns > 0) | (np.abs(tip[arcs.row, 2] - tip[arcs.row - 1, 2]) > 0.5 * half)
    if not rises.any():
        return 0.0
    rounded = half * (1.0 + math.sqrt(2.0)) + float(np.abs(radius_change(operation)[rises]).max())
    each = rounded + math.radians(angle) * float(arcs.radius[rises].max())
    row = arcs.row[rises]
    ends = np.flatnonzero(np.append(np.diff(row) != 1, True))
    return each * int(np.diff(ends, prepend=-1).max())


def _plane_error(motion: Motion, half: float, tilt: float) -> float:
    """How far a coordinate may be off, mm, in the program's coordinate system.

    Coordinates of the plane and of its origin are off by ``half`` mm each, those of the plane by the noise of turning
    as well, and the plane itself by ``tilt`` degrees.
    """
    assert motion.plane is not None
    reach = float(np.abs(motion.as_written().moves.tip).max())
    rounded = half * (1.0 + float(np.abs(motion.plane.matrix()).sum(axis=1).max()))
    rounded += TURNING_NOISE * float(np.abs(motion.plane.matrix()).sum(axis=1).max())
    return rounded + float(np.radians(tilt)) * reach * math.sqrt(3.0)
