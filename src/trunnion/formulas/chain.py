"""The chain of a machine as symbols: what stands between the workpiece and the tool, in order."""

from itertools import pairwise
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.formulas.symbols import Expression, Rows, Triple, exact_direction, number, rotation, symbol
from trunnion.machines import Axis, Machine
from trunnion.machines.machine import Vector
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Figure

#: Parts of an offset that are smaller are zero, mm.
_NO_OFFSET: Final = 1e-12

#: Sine of the angle below which an axis is along the spindle.
_ALONG: Final = 1e-3

#: Names of tip and tool axis, which an axis cannot have.
TIP: Final = ("x", "y", "z")
TOOL_AXIS: Final = ("i", "j", "k")
LENGTH: Final = "L"

#: Names that mean something else in formulas.
_TAKEN: Final = {*TIP, *TOOL_AXIS, LENGTH, "sqrt", "cos", "sin", "acos", "asin", "atan2", "delta", "det"}


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that formulas have as a symbol.

    name     as formulas have it
    meant    what it is; ``meaning`` in English
    value    mm, degrees or without a unit; None if it is not known
    unit     ``mm``, ``deg`` or empty
    """

    name: str
    meant: Annotated[Wording, Figure("meaning", take=str)]
    value: float | None
    unit: str

    @property
    def meaning(self) -> str:
        """What it is, in words."""
        return str(self.meant)


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """One axis in the chain.

    axis       as the definition has it
    variable   its displayed value
    direction  in which growing values move the tool, or about which they turn it
    offset     from the origin of the frame before it to its own; zero for a linear axis
    """

    axis: Axis
    variable: Expression
    direction: Triple
    offset: Triple

    @property
    def matrix(self) -> Rows:
        """The matrix (3, 3) by which a rotary axis turns."""
        return rotation(self.direction, self.variable)

    @property
    def is_exact(self) -> bool:
        """Whether the direction is in exact numbers."""
        return not any(part.free_symbols for part in self.direction)

    @property
    def turn(self) -> Rows:
        """The same matrix as formulas have it: its parts by their names if the direction is measured."""
        if self.is_exact:
            return self.matrix
        first, second, third = (tuple(symbol(f"R_{self.axis.name}_{row}{column}") for column in TIP) for row in TIP)
        return first, second, third

    @property
    def definitions(self) -> list[tuple[str, Expression]]:
        """What the names in ``turn`` mean."""
        if self.is_exact or not self.axis.is_rotary:
            return []
        rows = zip(self.turn, self.matrix, strict=True)
        return [(str(name), part) for names, parts in rows for name, part in zip(names, parts, strict=True)]


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """A machine as symbols.

    joints      from the workpiece to the tool
    tool        from the origin of the last frame to the tip, all axes at zero
    spindle     from the tip to the holder, all axes at zero
    parameters  of the formulas
    """

    machine: Machine
    joints: tuple[Joint, ...]
    tool: Triple
    spindle: Triple
    parameters: tuple[Parameter, ...]

    @property
    def rotary(self) -> tuple[Joint, ...]:
        """The rotary axes, two at most; the first is the one next to the workpiece."""
        return tuple(joint for joint in self.joints if joint.axis.is_rotary)

    @property
    def is_tilting(self) -> bool:
        """Whether the tool axis follows from the rotary axes: with two, and with one that is not along the spindle."""
        alone = self.rotary[0].axis.direction if len(self.rotary) == 1 else self.machine.spindle_direction
        along = bool(np.linalg.norm(np.cross(alone, self.machine.spindle_direction)) < _ALONG)
        return len(self.rotary) == 2 or not along

    @property
    def linear(self) -> tuple[Joint, Joint, Joint]:
        """The linear axes in chain order."""
        first, second, third = (joint for joint in self.joints if not joint.axis.is_rotary)
        return first, second, third

    @property
    def definitions(self) -> tuple[tuple[str, Expression], ...]:
        """Names of parts of the matrices, which formulas use, and what they are."""
        return tuple(each for joint in self.joints for each in joint.definitions)

    @property
    def values(self) -> dict[str, float]:
        """The parameters that are known, by their names."""
        return {each.name: each.value for each in self.parameters if each.value is not None}


def symbolic_chain(machine: Machine) -> Chain:
    """Return a machine as symbols: directions are exact where they can be, offsets that are zero are left out."""
    parameters = list[Parameter]()
    rotary = [machine.axes[k] for k in machine.own_rotary]
    offsets = {axis.name: _first_offset(machine, axis, parameters) for axis in rotary[:1]}
    for first, second in pairwise(rotary):
        between = Wording("kinematics", "between_axes", axis=first.name, other=second.name)
        offsets[second.name] = _offset(parameters, "e", np.subtract(second.point, first.point), between)
    zero = number(0)
    joints = tuple(
        Joint(
            axis,
            symbol(axis_symbol(axis.name)),
            _direction(
                parameters,
                f"n_{axis.name}",
                Wording("kinematics", "of_axis", axis=axis.name),
                [axis.sense * part + 0.0 for part in axis.direction],
            ),
            offsets.get(axis.name, (zero, zero, zero)),
        )
        for axis in machine.own_axes
    )
    gauge = _gauge_offset(machine, rotary[-1] if rotary else None, parameters)
    spindle = _direction(parameters, "s", Wording("kinematics", "of_spindle"), machine.spindle_direction)
    length = symbol(LENGTH)
    parameters.append(Parameter(LENGTH, Wording("kinematics", "length"), machine.tool_length, "mm"))
    tool = tuple(part - length * along for part, along in zip(gauge, spindle, strict=True))
    return Chain(machine, joints, (tool[0], tool[1], tool[2]), spindle, tuple(parameters))


def axis_symbol(name: str) -> str:
    """Return the name of an axis in formulas; one that is taken gets a ``q_`` before it."""
    return f"q_{name}" if name in _TAKEN or "_" in name else name


def _gauge_offset(machine: Machine, last: Axis | None, parameters: list[Parameter]) -> Triple:
    """Return the gauge point from the last rotary axis; from the workpiece zero if there is none."""
    if last is None:
        return _from_zero(machine, machine.spindle_point, Wording("kinematics", "zero_to_gauge_point"), parameters)
    gauge_point = "to_gauge_point" if machine.spindle_point_is_stated else "to_assumed_gauge_point"
    way = np.subtract(machine.spindle_point, last.point)
    return _offset(parameters, "g", way, Wording("kinematics", gauge_point, axis=last.name))


def _first_offset(machine: Machine, first: Axis, parameters: list[Parameter]) -> Triple:
    return _from_zero(machine, first.point, Wording("kinematics", "from_zero", axis=first.name), parameters)


def _from_zero(machine: Machine, point: Vector, about: Wording, parameters: list[Parameter]) -> Triple:
    if machine.workpiece_zero is not None:
        return _offset(parameters, "a", np.subtract(point, machine.workpiece_zero), about)
    parameters += [Parameter(f"a_{letter}", _along(about, letter), None, "mm") for letter in TIP]
    x, y, z = (symbol(f"a_{letter}") for letter in TIP)
    return x, y, z


def _offset(parameters: list[Parameter], name: str, values: Floats, about: Wording) -> Triple:
    """Return an offset as symbols, those parts left out that are zero, and note what they are."""
    found = []
    for letter, value in zip(TIP, values.tolist(), strict=True):
        if abs(value) <= _NO_OFFSET:
            found.append(number(0))
            continue
        found.append(symbol(f"{name}_{letter}"))
        parameters.append(Parameter(f"{name}_{letter}", _along(about, letter), value, "mm"))
    return found[0], found[1], found[2]


def _direction(
    parameters: list[Parameter], name: str, about: Wording, direction: tuple[float, ...] | list[float]
) -> Triple:
    """Return a unit vector in exact numbers, or as symbols if it is measured."""
    exact = exact_direction(direction)
    if exact is not None:
        return exact
    found = []
    for letter, value in zip(TIP, direction, strict=True):
        if value == 0.0:
            found.append(number(0))
            continue
        found.append(symbol(f"{name}_{letter}"))
        parameters.append(
            Parameter(f"{name}_{letter}", _along(Wording("kinematics", "direction", of=about), letter), value, "")
        )
    return found[0], found[1], found[2]


def _along(about: Wording, letter: str) -> Wording:
    """Return what the part of something along one axis is."""
    return Wording("kinematics", "along", about=about, letter=letter.upper())
