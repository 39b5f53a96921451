"""How far a program may be from its CL points when it is proven: what its own printed digits come to.

In:     a program as it was planned.
Out:    limits for each operation, mm and degrees, for ``trunnion.verification``.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from trunnion.controls.family_writer import MAX_CENTRE_ERROR_DIGITS
from trunnion.controls.vocabulary import SURFACE_NORMAL_WORDS
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CycleOn
from trunnion.output.coordinates.plane_from_pose import with_plane_inside_limits
from trunnion.output.program import Program
from trunnion.planning.linearization.arc_chords import flat_arcs, radius_change

if TYPE_CHECKING:
    from trunnion.verification import Tolerances

#: A turn of the rotary axes turns the tool axis by no less than this part of it, however near the pole.
_LEAST_POLE_SINE = 1e-3


def program_tolerances(program: Program) -> "list[Tolerances]":
    """Half the last digit that each operation prints; in a tilted plane, what that comes to in the program's frame."""
    from trunnion.verification import Tolerances

    control, machine = program.control, program.machine
    primary, secondary = machine.axes[machine.primary].name, machine.axes[machine.secondary].name
    allowed: list[Tolerances] = []
    for motion in program.motions:
        words = control.block_words(primary, secondary, motion.three_axis)
        half = {word.key: 0.5 * 10.0**-word.format.decimals + 1e-9 for word in words}
        tip, angle = half["X"], max(half["primary"], half["secondary"])
        normal = half.get(SURFACE_NORMAL_WORDS[0], 0.0)
        # Near a pole angles are noisy, and the check takes the ways of the tool axis for straight.
        angle += 1e-8 + angle * math.radians(angle) / _LEAST_POLE_SINE
        if motion.plane is not None and control.plane_from_pose:
            # Places are worked out for the plane as it is printed; only circles stay in it that are not quite in it.
            widest = float(motion.operation.arcs.radius.max(initial=0.0))
            tip = _plane_error(motion, tip, 0.0) + 2.0 * widest * math.radians(2.0 * angle)
        elif motion.plane is not None:
            turning = control.number_formats(three_axis=False)["plane_angle"].decimals
            tilt = max(angle, 1.5 * 10.0**-turning)  # three angles of a plane, or a rotary position
            if with_plane_inside_limits(machine, motion, turning) is not motion:
                tilt += 1.5 * 10.0**-turning
            tip, angle = _plane_error(motion, tip, tilt), math.sqrt(2.0) * tilt + 1e-8
            normal = math.sqrt(3.0) * (normal + math.radians(tilt))
        tip += _flattened_rise(motion)
        if "arc_angle" in half:
            tip += _helix_angle_error(motion, half["X"], half["arc_angle"])
        if motion.mode is MachiningMode.TCP and any(isinstance(event, CycleOn) for event in motion.operation.events):
            # Heights of holes are printed along their axes from the zero, which rounded rotary positions turn.
            tip += math.radians(angle) * float(np.abs(motion.operation.moves.tip).max())
        if motion.mode is MachiningMode.WITHOUT_TCP:
            tip *= math.sqrt(3.0)  # three slides are rounded, and turned parts look at them aslant
        deviations = None if motion.deviations.is_empty else motion.deviations
        if not motion.starts_operation:
            before = allowed.pop()
            tip, angle, normal = max(tip, before.tip), max(angle, before.angle), max(normal, before.normal)
            deviations = before.deviations
        found = 2.0 * MAX_CENTRE_ERROR_DIGITS * half["X"] if control.arcs.by_radius else 0.0
        allowed.append(
            Tolerances(
                tip,
                angle,
                control.arcs.chord_tolerance,
                half["feed"],
                deviations,
                centre=found,
                normal=normal,
                plane=motion.plane is not None,
            )
        )
    return allowed


def _flattened_rise(motion: Motion) -> float:
    """How much higher circles end than they begin that are written as flat ones, mm: less than anybody prints.

    Such a circle stands across a tool axis that is off upright by what rotary words do not show, or rises by as little.
    """
    operation = motion.as_written()
    arcs, tip = operation.arcs, operation.moves.tip
    if not len(arcs.row):
        return 0.0
    way = np.abs(tip[arcs.row] - tip[arcs.row - 1])
    rise = way[np.arange(len(way)), np.abs(arcs.normal).argmax(axis=1)]
    return float(rise[flat_arcs(operation)].max(initial=0.0))


def _helix_angle_error(motion: Motion, half: float, angle: float) -> float:
    """How much farther the ends of helices may be off that are said by a centre and an angle, mm.

    Start and centre are rounded by ``half`` mm, of which the end has that of the centre twice, once turned; the angle
    by ``angle`` degrees. What the CL file's own end is off the circle comes on top. A helix right behind another begins
    where that one has really ended.
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
    """How far a coordinate may be off where ``half`` is, in each coordinate of the plane and of its origin, mm, and
    the plane itself by ``tilt`` degrees."""
    assert motion.plane is not None
    reach = float(np.abs(motion.as_written().moves.tip).max())
    rounded = half * (1.0 + float(np.abs(motion.plane.matrix()).sum(axis=1).max()))
    return rounded + float(np.radians(tilt)) * reach * math.sqrt(3.0)
