"""The inverse map for rows of tool positions."""

import math

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Floats3
from trunnion.jit import inner, kernel
from trunnion.machines.inverse.parameters import KinematicParameters, kinematic_parameters
from trunnion.machines.inverse.rotary import POLE, UNREACHABLE, branch_angles, solve_tilt
from trunnion.machines.inverse.slides import SLIDES_DEPENDENT, solve_slides, solve_slides_cos_sin
from trunnion.machines.machine import Machine
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class InverseSolutions:
    """Axis values for rows of tool positions.

    joints     (2, n, 5) float64  displayed values, mm or deg; NaN where not reachable; branches as in ``branch_angles``
    reachable  (n,) bool          the rotary axes reach the tool axis and the slides can follow; limits are ignored
    pole       (n,) bool          the angle of the first rotary axis is free and carries 0
    """

    joints: Floats
    reachable: Flags
    pole: Flags


def inverse(machine: Machine, tip: Floats, axis: Floats, tool_length: float | None = None) -> InverseSolutions:
    """Both sets of axis values for rows of tool tips and tool axes.

    Parameters
    ----------
    machine
        The chain, from the workpiece to the tool.
    tip : (n, 3) float64, mm
        In workpiece coordinates, counted from ``machine.workpiece_zero``; from the machine's own zero if that is None.
    axis : (n, 3) float64
        From tip to holder, in workpiece coordinates; any length but zero.
    tool_length
        From the gauge point to the tip, mm; None: that of ``machine.tool_length``.

    Raises
    ------
    ValueError
        If ``tip`` and ``axis`` have other shapes.

    Notes
    -----
    The formula is in the docstring of ``trunnion.machines.inverse``.
    """
    tips = np.ascontiguousarray(tip, dtype=np.float64)
    axes = np.ascontiguousarray(axis, dtype=np.float64)
    if tips.ndim != 2 or tips.shape[1] != 3 or axes.shape != tips.shape:
        raise ValueError(f"tip and axis must both have shape (n, 3), not {tips.shape} and {axes.shape}")
    joints = np.empty((2, len(tips), 5))
    status = np.empty(len(tips), np.uint8)
    solve_rows(kinematic_parameters(machine, tool_length), tips, axes, joints, status)
    return InverseSolutions(joints, (status & (UNREACHABLE | SLIDES_DEPENDENT)) == 0, (status & POLE) != 0)


def slide_positions(machine: Machine, tip: Floats, rotary: Floats, tool_length: float | None = None) -> Floats:
    """All five axis values for rows of tool tips with known rotary values.

    tip : (n, 3) float64, mm      in workpiece coordinates, as for ``inverse``
    rotary : (n, 2) float64, deg  displayed values in the order of ``machine.rotary``

    (n, 5) float64  mm or deg, in the order of ``machine.axes``; slides are NaN where they are linearly dependent
    """
    joints = np.empty((len(tip), 5))
    slide_rows(
        kinematic_parameters(machine, tool_length), np.ascontiguousarray(tip), np.ascontiguousarray(rotary), joints
    )
    return joints


@kernel(writes="joints")
def slide_rows(kinematics: KinematicParameters, tip: Floats2, rotary: Floats2, joints: Floats2) -> None:
    """Call ``solve_slides`` for each row; joints (n, 5) is written."""
    for row in range(tip.shape[0]):
        solve_slides(kinematics, rotary[row, 0], rotary[row, 1], tip[row, 0], tip[row, 1], tip[row, 2], joints[row])


@kernel(writes="joints status")
def solve_rows(kinematics: KinematicParameters, tip: Floats2, axis: Floats2, joints: Floats3, status: Codes) -> None:
    """Call ``solve_point`` for each row; joints (2, n, 5) and status (n,) uint8 are written."""
    for row in range(tip.shape[0]):
        status[row] = solve_point(
            kinematics,
            tip[row, 0],
            tip[row, 1],
            tip[row, 2],
            axis[row, 0],
            axis[row, 1],
            axis[row, 2],
            joints[:, row, :],
        )


@inner
def solve_point(
    kinematics: KinematicParameters, x: float, y: float, z: float, i: float, j: float, k: float, out: Floats
) -> int:
    """Write both branches of one tool position into ``out`` (2, 5), mm and deg; return the status bits."""
    status, u0, u1, cos, sin = solve_tilt(kinematics, i, j, k)
    if status == UNREACHABLE:
        out[:, :] = math.nan
        return UNREACHABLE
    both = status
    for branch in range(2):
        first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(
            kinematics, u0, u1, cos, sin if branch == 0 else -sin, status
        )
        out[branch, kinematics.columns[0]] = first
        out[branch, kinematics.columns[1]] = second
        both |= solve_slides_cos_sin(kinematics, cos_1, sin_1, cos_2, sin_2, x, y, z, out[branch])
    return both
