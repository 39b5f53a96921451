"""The chain of a machine as symbols: what stands between the workpiece and the tool, in order."""

from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.formulas.symbols import Expression, Rows, Triple, exact_direction, number, rotation, symbol
from trunnion.machines import Axis, Machine
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Figure

#: Parts of an offset that are smaller are zero, mm.
_NO_OFFSET: Final = 1e-12

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
    def rotary(self) -> tuple[Joint, Joint]:
        """Both rotary axes; the first is the one next to the workpiece."""
        first, second = (self.joints[k] for k in self.machine.rotary)
        return first, second

    @property
    def linear(self) -> tuple[Joint, Joint, Joint]:
        """The linear axes in chain order."""
        first, second, third = (self.joints[k] for k in self.machine.linear)
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
    first, second = (machine.axes[k] for k in machine.rotary)
    offsets = {
        first.name: _first_offset(machine, first, parameters),
        second.name: _offset(
            parameters,
            "e",
            np.subtract(second.point, first.point),
            Wording("kinematics", "between_axes", axis=first.name, other=second.name),
        ),
    }
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
        for axis in machine.axes
    )
    gauge_point = "to_gauge_point" if machine.spindle_point_is_stated else "to_assumed_gauge_point"
    gauge = _offset(
        parameters,
        "g",
        np.subtract(machine.spindle_point, second.point),
        Wording("kinematics", gauge_point, axis=second.name),
    )
    spindle = _direction(parameters, "s", Wording("kinematics", "of_spindle"), machine.spindle_direction)
    length = symbol(LENGTH)
    parameters.append(Parameter(LENGTH, Wording("kinematics", "length"), machine.tool_length, "mm"))
    tool = tuple(part - length * along for part, along in zip(gauge, spindle, strict=True))
    return Chain(machine, joints, (tool[0], tool[1], tool[2]), spindle, tuple(parameters))


def axis_symbol(name: str) -> str:
    """Return the name of an axis in formulas; one that is taken gets a ``q_`` before it."""
    return f"q_{name}" if name in _TAKEN or "_" in name else name


def _first_offset(machine: Machine, first: Axis, parameters: list[Parameter]) -> Triple:
    about = Wording("kinematics", "from_zero", axis=first.name)
    if machine.workpiece_zero is not None:
        return _offset(parameters, "a", np.subtract(first.point, machine.workpiece_zero), about)
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
