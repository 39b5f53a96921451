"""Slides as linear functions of the workpiece zero, one for each sample of a path.

In:     tips and rotary positions.
Out:    for each sample and slide k a normal a and an offset o, so that the slide stands at a . z + o when the workpiece
        zero is at z, mm.
"""

import math
from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3, Ints, distinct
from trunnion.jit import kernel
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.machines.inverse import solve_slides_cos_sin
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class AxisEquations:
    """m samples of a path: rows, points of arcs, and points between rows where rotary axes turn.

    normals  (m, 3, 3)  by slide, in the order of ``Machine.linear``
    offsets  (m, 3)     mm
    row      (m,)       the row that each belongs to
    """

    normals: Floats
    offsets: Floats
    row: Ints

    def __len__(self) -> int:
        return len(self.offsets)

    def slides(self, zero: Floats) -> Floats:
        """(m, 3): where the slides stand with the workpiece zero there, mm."""
        return np.asarray(self.normals @ zero + self.offsets)


def axis_equations(
    machine: Machine, tip: Floats, angles: Floats, length: Floats | None = None
) -> tuple[Floats, Floats, int]:
    """Return normals (m, 3, 3), offsets (m, 3), and the first sample whose slides cannot follow, or -1.

    ``length`` (m,) has those of the tools, gauge point to tip, mm; where it is NaN, or missing, the machine's counts.
    """
    normals, offsets = np.empty((len(tip), 3, 3)), np.empty((len(tip), 3))
    if length is None or not len(length):
        return normals, offsets, _fill_forms(kinematic_parameters(machine), tip, angles, normals, offsets)
    first = len(tip)
    for own in distinct(length).tolist():
        there = machine if math.isnan(own) else replace(machine, tool_length=own)
        which = np.flatnonzero(np.isnan(length) if math.isnan(own) else length == own)
        normal, offset = np.empty((len(which), 3, 3)), np.empty((len(which), 3))
        failed = _fill_forms(kinematic_parameters(there), tip[which], angles[which], normal, offset)
        normals[which], offsets[which] = normal, offset
        first = first if failed < 0 else min(first, int(which[failed]))
    return normals, offsets, first if first < len(tip) else -1


@kernel(writes="normals offsets")
def _fill_forms(
    kinematics: KinematicParameters, tip: Floats2, angles: Floats2, normals: Floats3, offsets: Floats2
) -> int:
    """Write the forms of samples up to the first whose slides are dependent; returns it, or -1.

    ``kinematics`` are those of a workpiece zero at the machine's.
    """
    here, ahead = np.empty((4, 5)), np.empty(3)
    p, columns = kinematics.first_point, kinematics.columns
    for m in range(tip.shape[0]):
        if m > 0 and angles[m, 0] == angles[m - 1, 0] and angles[m, 1] == angles[m - 1, 1]:
            normals[m] = normals[m - 1]
        else:
            angle = kinematics.sense_1 * math.radians(angles[m, 0] - 360.0 * math.floor(angles[m, 0] / 360.0 + 0.5))
            cos_1, sin_1 = math.cos(angle), math.sin(angle)
            angle = math.radians(angles[m, 1] - 360.0 * math.floor(angles[m, 1] / 360.0 + 0.5))
            cos_2, sin_2 = math.cos(angle), math.sin(angle)
            for k in range(4):
                for j in range(3):
                    ahead[j] = p[j] + (1.0 if j == k else 0.0)
                x, y, z = ahead[0], ahead[1], ahead[2]
                if solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z, here[k]):
                    return m
            for slide in range(3):
                column = columns[2 + slide]
                for k in range(3):
                    normals[m, slide, k] = here[k, column] - here[3, column]
        x, y, z = tip[m, 0] - p[0], tip[m, 1] - p[1], tip[m, 2] - p[2]
        for slide in range(3):
            a = normals[m, slide]
            offsets[m, slide] = here[3, columns[2 + slide]] + a[0] * x + a[1] * y + a[2] * z
    return -1
