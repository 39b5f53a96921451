"""Where the tool goes when a geometry number of the machine is not what its definition says.

In:     a ``Machine`` and displayed axis values.
Out:    for each number of the definition, how fast tip and tool axis move with it, in workpiece coordinates.
Units:  mm; mm per mm for lengths, mm and radians per radian for angles.

The control turns tips into axis values with the numbers of the definition; the iron has the true ones. For the same
axis values the tip is then off by the derivative of the forward map with respect to the number, times its error.

Notation. The forward map is a product of joints, p' = T1 T2 ... T5 p. For joint k let P be the turn of all joints
before it, towards the workpiece, R its own, w its direction, o its point and q its value, y the tip from o before the
joint has moved it, and e the axis about which the number turns.

    point             P (I - R) do              what the turn leaves of a shift
    direction         P (e x R y - R (e x y))   the line turned by a small angle about e, at the point of the definition
    displayed angle   P (w x R y)               the iron stands a small angle further than the display
    slide direction   P (e x d) q
"""

import math
from collections.abc import Iterator
from enum import StrEnum
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines.forward import KinematicChain, kinematic_chain
from trunnion.machines.machine import Machine
from trunnion.messages import Wording, phrase, word_said
from trunnion.records import dataclass

#: A component along a direction is left out if less than this of it lies across, where it could matter.
_ALONG: Final = 1e-9

_LETTERS: Final = "XYZ"


class NumberKind(StrEnum):
    """Which number of a definition is off."""

    POINT = "point"
    DIRECTION = "direction"
    READING = "displayed angle"
    GAUGE_POINT = "gauge point"
    SPINDLE = "spindle direction"
    TOOL_LENGTH = "tool length"
    WORKPIECE_ZERO = "workpiece zero"


#: Numbers that are angles; all others are lengths.
_ANGLES: Final = (NumberKind.DIRECTION, NumberKind.READING, NumberKind.SPINDLE)


@dataclass(frozen=True, slots=True)
class GeometryNumber:
    """One number of a machine's geometry.

    axis       name of the axis; empty for numbers of the spindle, the tool and the workpiece
    component  X, Y or Z: along it for a point, about it for a direction; empty where the number has none
    """

    kind: NumberKind
    axis: str = ""
    component: str = ""

    @property
    def is_angle(self) -> bool:
        """Whether it is an angle."""
        return self.kind in _ANGLES

    @property
    def name(self) -> str:
        """As a shop calls it, such as ``C point X`` or ``B direction about Z``."""
        return str(self.said)

    @property
    def said(self) -> Wording:
        """The same in the language of who asks."""
        kind = word_said(self.kind)
        about = {"kind": kind, "letter": self.component}
        if not self.component:
            return phrase("number_of_axis", axis=self.axis, kind=kind) if self.axis else kind
        if self.is_angle:
            return (
                phrase("number_about_of_axis", axis=self.axis, **about)
                if self.axis
                else phrase("number_about", **about)
            )
        return phrase("number_along_of_axis", axis=self.axis, **about) if self.axis else phrase("number_along", **about)

    @property
    def key(self) -> str:
        """The key of the definition that holds it; empty where it has none."""
        return {
            NumberKind.POINT: "axis.point_mm",
            NumberKind.DIRECTION: "axis.direction",
            NumberKind.GAUGE_POINT: "spindle.gauge_point_mm",
            NumberKind.SPINDLE: "spindle.direction",
            NumberKind.WORKPIECE_ZERO: "workpiece.zero_mm",
        }.get(self.kind, "")


@dataclass(frozen=True, slots=True, eq=False)
class NumberDerivative:
    """How tip and tool axis move with one number.

    tip   (n, 3) float64  mm per mm, or mm per radian; workpiece frame
    axis  (n, 3) float64  of the unit vector from tip to holder, per mm or radian; zero for lengths
    """

    number: GeometryNumber
    tip: Floats
    axis: Floats


def idle_numbers(machine: Machine) -> tuple[GeometryNumber, ...]:
    """Return the numbers that move nothing: a point along its own axis, a direction turned about itself."""
    found = []
    for axis in machine.own_axes:
        for component, letter in enumerate(_LETTERS):
            if not _matters(np.array(axis.direction), component):
                kinds = [NumberKind.POINT, NumberKind.DIRECTION] if axis.is_rotary else [NumberKind.DIRECTION]
                found += [GeometryNumber(kind, axis.name, letter) for kind in kinds]
    for component, letter in enumerate(_LETTERS):
        if not _matters(np.array(machine.spindle_direction), component):
            found.append(GeometryNumber(NumberKind.SPINDLE, "", letter))
    return tuple(found)


def derivatives(machine: Machine, joints: Floats, tool_length: float | None = None) -> Iterator[NumberDerivative]:
    """Yield the derivative of the forward map with respect to each number that can move the tool.

    machine      the chain, from the workpiece to the tool
    joints       (n, 5) float64, mm or deg: displayed axis values in the order of ``machine.axes``
    tool_length  from the gauge point to the tip, mm; None: that of ``machine.tool_length``
    """
    chain = kinematic_chain(machine, tool_length)
    length = (machine.tool_length or 0.0) if tool_length is None else tool_length
    frames = _Frames(chain, joints)
    for joint, axis in machine.own_columns:
        if axis.is_rotary:
            yield from _of_rotary(axis.name, joint, frames)
        else:
            yield from _of_slide(axis.name, joint, frames)
    yield from _of_tool(chain, length, frames)
    still = np.zeros((len(joints), 3))
    for component, letter in enumerate(_LETTERS):
        shift = np.tile(-_unit(component), (len(joints), 1))
        yield NumberDerivative(GeometryNumber(NumberKind.WORKPIECE_ZERO, "", letter), shift, still)


class _Frames:
    """What each joint finds before it and after it.

    before  six (n, 3, 3): the turn of all joints between the workpiece and joint k; the last one is that of all joints
    turn    five (n, 3, 3): the turn of joint k itself
    tip     five (n, 3): the tip as the joints after k have moved it, machine frame
    axis    five (n, 3): the tool axis, likewise
    """

    def __init__(self, chain: KinematicChain, joints: Floats) -> None:
        n = len(joints)
        self.chain, self.joints = chain, joints
        self.turn = [_turns(chain, k, joints[:, k]) for k in range(5)]
        self.before = [np.tile(np.eye(3), (n, 1, 1))]
        for turn in self.turn:
            self.before.append(self.before[-1] @ turn)
        self.tip, self.axis = [np.empty(0)] * 5, [np.empty(0)] * 5
        tip, axis = np.tile(chain.tip_at_zero, (n, 1)), np.tile(chain.spindle, (n, 1))
        for k in range(4, -1, -1):
            self.tip[k], self.axis[k] = tip, axis
            if chain.rotary[k]:
                tip = _apply(self.turn[k], tip - chain.point[k]) + chain.point[k]
                axis = _apply(self.turn[k], axis)
            else:
                tip = tip + joints[:, k, None] * chain.direction[k]


def _of_rotary(name: str, joint: int, frames: _Frames) -> Iterator[NumberDerivative]:
    chain, before, after = frames.chain, frames.before[joint], frames.before[joint + 1]
    still = np.zeros((len(frames.joints), 3))
    arm = frames.tip[joint] - chain.point[joint]
    turned, turned_axis = _apply(frames.turn[joint], arm), _apply(frames.turn[joint], frames.axis[joint])
    for component, letter in enumerate(_LETTERS):
        if not _matters(chain.direction[joint], component):
            continue
        unit = _unit(component)
        yield NumberDerivative(GeometryNumber(NumberKind.POINT, name, letter), (before - after) @ unit, still)
        tip = _apply(before, _cross(unit, turned)) - _apply(after, _cross(unit, arm))
        axis = _apply(before, _cross(unit, turned_axis)) - _apply(after, _cross(unit, frames.axis[joint]))
        yield NumberDerivative(GeometryNumber(NumberKind.DIRECTION, name, letter), tip, axis)
    # The chain's direction is that in which displayed values grow, whatever the sense of the definition's.
    line = chain.direction[joint]
    yield NumberDerivative(
        GeometryNumber(NumberKind.READING, name),
        _apply(before, _cross(line, turned)),
        _apply(before, _cross(line, turned_axis)),
    )


def _of_slide(name: str, joint: int, frames: _Frames) -> Iterator[NumberDerivative]:
    way = frames.chain.direction[joint]
    still = np.zeros((len(frames.joints), 3))
    for component, letter in enumerate(_LETTERS):
        if _matters(way, component):
            tip = frames.before[joint] @ _cross(_unit(component), way) * frames.joints[:, joint, None]
            yield NumberDerivative(GeometryNumber(NumberKind.DIRECTION, name, letter), tip, still)


def _of_tool(chain: KinematicChain, length: float, frames: _Frames) -> Iterator[NumberDerivative]:
    turn = frames.before[5]
    still = np.zeros((len(frames.joints), 3))
    for component, letter in enumerate(_LETTERS):
        yield NumberDerivative(
            GeometryNumber(NumberKind.GAUGE_POINT, "", letter), np.ascontiguousarray(turn[:, :, component]), still
        )
        if _matters(chain.spindle, component):
            axis = turn @ _cross(_unit(component), chain.spindle)
            yield NumberDerivative(GeometryNumber(NumberKind.SPINDLE, "", letter), -length * axis, axis)
    yield NumberDerivative(GeometryNumber(NumberKind.TOOL_LENGTH), -(turn @ chain.spindle), still)


def _matters(direction: Floats, component: int) -> bool:
    """Whether a component of a point, or a turn about it, changes a line of this direction."""
    return math.hypot(*np.delete(direction, component)) > _ALONG


def _unit(component: int) -> Floats:
    return np.asarray(np.eye(3)[component])


def _cross(vector: Floats, others: Floats) -> Floats:
    """Return cross products of a vector and others (n, 3) or (3,); of so few ``np.cross`` takes ten times as long."""
    a, b, c = vector.tolist()
    return np.asarray(others @ np.array([[0.0, c, -b], [-c, 0.0, a], [b, -a, 0.0]]))


def _apply(turns: Floats, vectors: Floats) -> Floats:
    """Turn vectors (n, 3) by matrices (n, 3, 3)."""
    return np.asarray(np.einsum("nij,nj->ni", turns, vectors))


def _turns(chain: KinematicChain, joint: int, values: Floats) -> Floats:
    """Return the turn of a joint, (n, 3, 3); that of a slide is none."""
    n = len(values)
    if not chain.rotary[joint]:
        return np.tile(np.eye(3), (n, 1, 1))
    # Whole turns drop out exactly, so that a wound-up axis loses no digits.
    angle = np.radians(values - 360.0 * np.floor(values / 360.0 + 0.5))
    a, b, c = chain.direction[joint].tolist()
    cross = np.array([[0.0, -c, b], [c, 0.0, -a], [-b, a, 0.0]])
    # Rodrigues' formula as a matrix: I + sin K + (1 - cos) K^2
    return np.asarray(
        np.eye(3) + np.sin(angle)[:, None, None] * cross + (1.0 - np.cos(angle))[:, None, None] * (cross @ cross)
    )
