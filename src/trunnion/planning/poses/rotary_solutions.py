"""Rotary solutions of one tool axis, inside kernels; angles in degrees.

A tilt is what ``trunnion.machines.inverse.solve_tilt`` returns: it depends on the tool axis alone. A solution is a tilt
in one of the two branches: both angles, and their cosines and sines as the slides need them.
"""

import math
from typing import TypeAlias

import numpy as np

from trunnion.jit import inner
from trunnion.machines import KinematicParameters
from trunnion.machines.inverse import branch_angles, solve_tilt
from trunnion.planning.poses.states import LIMIT_TOLERANCE

#: Status bits, and four numbers.
Tilt: TypeAlias = tuple[int, float, float, float, float]

#: First and second angle, cosine and sine of the first, cosine and sine of the second.
RotarySolution: TypeAlias = tuple[float, float, float, float, float, float]


@inner
def branch_solution(kinematics: KinematicParameters, tilt: Tilt, branch: int) -> RotarySolution:
    """Return the solution of a tilt in a branch."""
    status, u0, u1, cos, sin = tilt
    return branch_angles(kinematics, u0, u1, cos, sin if branch == 0 else -sin, status)


@inner
def with_first_angle(kinematics: KinematicParameters, solution: RotarySolution, first: float) -> RotarySolution:
    """Return a solution in the pole, where the first angle is free, with that angle."""
    _, second, _, _, cos_2, sin_2 = solution
    angle = math.radians(first)
    return first, second, math.cos(angle), kinematics.sense_1 * math.sin(angle), cos_2, sin_2


@inner
def first_angle(kinematics: KinematicParameters, i: float, j: float, k: float, branch: int) -> float:
    """Return the first angle under a tool axis off the pole, in a branch."""
    return branch_solution(kinematics, solve_tilt(kinematics, i, j, k), branch)[0]


@inner
def is_beyond(value: float, low: float, high: float) -> bool:
    """Whether a value is beyond its limits by more than what prints as the limit."""
    return value < low - LIMIT_TOLERANCE or value > high + LIMIT_TOLERANCE


@inner
def principal_angle(value: float) -> float:
    """Return a value without its whole turns, in [-180, 180]."""
    turns: float = np.rint(value / 360.0)
    return value - 360.0 * turns


@inner
def with_turns(angle: float, turn: int, endless: bool, last: float) -> float:
    """Return an angle with the whole turns of its state, or for an endless axis with those nearest to the last
    value.
    """
    turns: float = np.rint((last - angle) / 360.0) if endless else turn
    return angle + 360.0 * turns
