"""Poles, the tool axes that rotary axes reach, and where each solution is within travel."""

import math
from typing import Annotated, Final

import numpy as np

from trunnion.formulas.chain import Chain
from trunnion.formulas.rotary import Tilt
from trunnion.formulas.symbols import float_of
from trunnion.machines import Axis, Machine
from trunnion.machines.machine import Vector
from trunnion.records import dataclass
from trunnion.results import Figure

#: Angles closer than this are equal, deg.
_SAME: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Pole:
    """A tool axis at which one rotary axis is free: it is parallel to that.

    tool_axis  unit vector from tip to holder, in workpiece coordinates
    free       the axis whose angle is free
    other      the other rotary axis
    angle      where that stands, degrees
    in_travel  whether that is within its travel
    """

    tool_axis: Vector
    free: str
    other: str
    angle: float
    in_travel: bool


@dataclass(frozen=True, slots=True)
class SolutionRange:
    """Where one solution has the second rotary axis.

    axis    the second rotary axis
    low     degrees
    high    degrees
    travel  those stretches of its travel that the solution has, degrees; empty: none
    """

    axis: str
    low: float
    high: float
    travel: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class ReachedCone:
    """Tool axes that the rotary axes reach, their limits apart: a zone about a direction.

    about    unit vector in workpiece coordinates, along the first rotary axis; along the spindle if there is none
    nearest  least angle to it, degrees
    farthest greatest angle to it, degrees
    """

    about: Vector
    nearest: Annotated[float, Figure(unit="deg")]
    farthest: Annotated[float, Figure(unit="deg")]


def poles_of(chain: Chain, tilt: Tilt) -> tuple[Pole, ...]:
    """Return the poles of a machine: none, one or two."""
    first, second = chain.rotary
    found = []
    for sign, phi in ((1, 0.0), (-1, 180.0)):
        gap = tilt.between - tilt.of_spindle if sign > 0 else 180.0 - tilt.between - tilt.of_spindle
        if abs(gap) > _SAME:
            continue
        angle = within_a_turn(phi - tilt.delta)
        along = _first_direction(chain, sign * tilt.sense)
        axis = second.axis
        found.append(Pole(along, first.axis.name, axis.name, angle, bool(_stretches(axis, angle, angle))))
    return tuple(found)


def solution_range(chain: Chain, tilt: Tilt, branch: int) -> SolutionRange:
    """Return where a solution, 0 or 1, has the second rotary axis."""
    low, high = (-tilt.delta, 180.0 - tilt.delta) if branch == 0 else (-180.0 - tilt.delta, -tilt.delta)
    axis = chain.rotary[1].axis
    return SolutionRange(axis.name, low, high, _stretches(axis, low, high))


def reached_cone(chain: Chain, tilt: Tilt) -> ReachedCone:
    """Return the tool axes that the rotary axes reach, their limits apart."""
    together = tilt.between + tilt.of_spindle
    farthest = min(together, 360.0 - together)
    return ReachedCone(_first_direction(chain, tilt.sense), abs(tilt.between - tilt.of_spindle), farthest)


def one_axis_cone(machine: Machine) -> ReachedCone:
    """Return the tool axes that one rotary axis reaches, or none: all have one angle to it."""
    own, spindle = machine.own_rotary, np.array(machine.spindle_direction)
    about = np.array(machine.axes[own[0]].direction) if own else spindle
    angle = math.degrees(math.atan2(float(np.linalg.norm(np.cross(about, spindle))), float(about @ spindle)))
    i, j, k = about.tolist()
    return ReachedCone((i, j, k), angle, angle)


def within_a_turn(angle: float) -> float:
    """Return an angle in (-180, 180]."""
    return angle - 360.0 * math.ceil((angle - 180.0) / 360.0) + 0.0


def _first_direction(chain: Chain, sign: int) -> Vector:
    i, j, k = (sign * float_of(part, chain.values) + 0.0 for part in chain.rotary[0].direction)
    return i, j, k


def _stretches(axis: Axis, low: float, high: float) -> tuple[tuple[float, float], ...]:
    """Return where an axis within its travel has angles from ``low`` to ``high``, or the same some turns on."""
    if axis.endless:
        return ((low, high),)
    first = math.ceil((axis.low - high) / 360.0 - _SAME)
    last = math.floor((axis.high - low) / 360.0 + _SAME)
    turns = range(first, last + 1) if math.isfinite(axis.high - axis.low) else range(1)
    found = ((max(low + 360.0 * k, axis.low), min(high + 360.0 * k, axis.high)) for k in turns)
    return tuple((one + 0.0, other + 0.0) for one, other in found if one <= other + _SAME)
