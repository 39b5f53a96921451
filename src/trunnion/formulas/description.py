"""All formulas of a machine, in one record."""

import math
from dataclasses import replace
from operator import attrgetter
from typing import Annotated, ClassVar

from trunnion.formulas.agreement import Agreement, MapFormulas, agreement
from trunnion.formulas.chain import Parameter, symbolic_chain
from trunnion.formulas.forward import FrameStep, forward_formulas, frame_steps, whole_matrix
from trunnion.formulas.linear import dependence, linear_formulas, words_without_tcp
from trunnion.formulas.notation import as_latex, as_text
from trunnion.formulas.poles import (
    Pole,
    ReachedCone,
    SolutionRange,
    one_axis_cone,
    poles_of,
    reached_cone,
    solution_range,
)
from trunnion.formulas.rotary import one_axis_formulas, rotary_formulas, tilt_of
from trunnion.formulas.steps import Formula, Steps, as_formula
from trunnion.machines import Axis, Machine
from trunnion.records import dataclass
from trunnion.results import EXACT, Figure


@dataclass(frozen=True, slots=True)
class FrameMatrix:
    """A homogeneous matrix: where a frame is in another one.

    frame   its name: that of its axis, or ``tool``
    within  the frame in which it is
    rows    (4, 4) as text
    latex   (4, 4) as LaTeX
    """

    frame: str
    within: str
    rows: tuple[tuple[str, ...], ...]
    latex: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class Solution:
    """The rotary angles for a tool axis.

    rotary  formulas of the rotary axes
    where   which angles of the second one it has; null where there is one alone
    """

    rotary: tuple[Formula, ...]
    where: SolutionRange | None


@dataclass(frozen=True, slots=True)
class AxisTravel:
    """The travel of an axis as displayed; null where it is not limited or not stated.

    name       of the axis
    variable   its name in formulas
    is_rotary  whether it turns: degrees, else mm
    carries    ``part`` or ``tool``
    endless    whether it has no ends
    low        end of its travel
    high       end of its travel
    """

    name: str
    variable: str
    is_rotary: bool
    carries: str
    endless: bool
    low: float | None
    high: float | None


@dataclass(frozen=True, slots=True)
class Kinematics:
    """The formulas of a machine.

    machine      as the definition has it, with the workpiece zero and the tool length that were given
    axes         from the workpiece to the tool, with their travel
    parameters   what symbols stand for; the value is null where it is not known
    matrices     from each frame to the next, from the workpiece to the tool, then over all of them
    parts        parts of the matrices that formulas have by their names, where a direction is no exact number
    forward      formulas of the tip ``x y z`` and the tool axis ``i j k``; intermediate ones stand before
    solutions    both inverse solutions; one with one rotary axis; none where the tool axis never changes
    linear       formulas of the linear axes for either solution
    without_tcp  words of the linear axes in a program without TCP; empty where it has none
    poles        tool axes at which a rotary axis is free
    reach        tool axes that the rotary axes reach, their limits apart
    dependent    what is zero where the linear axes cannot follow; null if that cannot be
    agreement    how far the formulas are from the maps that programs are made and proven with
    """

    SCHEMA: ClassVar[int] = 1
    DECIMALS: ClassVar[int] = EXACT

    machine: Annotated[Machine, Figure("key", take=attrgetter("key")), Figure("name", take=attrgetter("name"))]
    axes: tuple[AxisTravel, ...]
    parameters: tuple[Parameter, ...]
    matrices: tuple[FrameMatrix, ...]
    parts: tuple[Formula, ...]
    forward: tuple[Formula, ...]
    solutions: tuple[Solution, ...]
    linear: tuple[Formula, ...]
    without_tcp: tuple[Formula, ...]
    poles: tuple[Pole, ...]
    reach: ReachedCone
    dependent: Formula | None
    agreement: Agreement

    @property
    def passed(self) -> bool:
        """Whether the formulas agree with the maps that programs are made and proven with."""
        return self.agreement.passed


def kinematics_of(machine: Machine) -> Kinematics:
    """Return the formulas of a machine; one without workpiece zero or tool length has these as unknown symbols.

    Raises ``MissingExtraError`` if SymPy is not installed.
    """
    chain = symbolic_chain(machine)
    tilt = tilt_of(chain) if len(chain.rotary) == 2 else None
    rotary: tuple[Steps, ...] = ()
    if tilt is not None:
        chain = replace(chain, parameters=(*chain.parameters, *tilt.parameters))
        rotary = rotary_formulas(chain, tilt, 0), rotary_formulas(chain, tilt, 1)
    elif chain.is_tilting:
        rotary = (one_axis_formulas(chain),)
    words, flat = words_without_tcp(chain), dependence(chain)
    formulas = MapFormulas(forward_formulas(chain), rotary, linear_formulas(chain), words, flat)
    return Kinematics(
        machine,
        tuple(_travel(axis, str(joint.variable)) for axis, joint in zip(machine.own_axes, chain.joints, strict=True)),
        chain.parameters,
        tuple(map(_matrix, (*frame_steps(chain), whole_matrix(chain)))),
        Steps(found=list(chain.definitions)).formulas(),
        formulas.forward.formulas(),
        tuple(
            Solution(each.formulas(), None if tilt is None else solution_range(chain, tilt, branch))
            for branch, each in enumerate(rotary)
        ),
        formulas.linear.formulas(),
        () if words is None else words.formulas(),
        () if tilt is None else poles_of(chain, tilt),
        one_axis_cone(machine) if tilt is None else reached_cone(chain, tilt),
        None if flat is None else as_formula("det", flat),
        agreement(chain, tilt, formulas),
    )


def _matrix(step: FrameStep) -> FrameMatrix:
    rows, latex = (tuple(tuple(map(write, row)) for row in step.matrix) for write in (as_text, as_latex))
    return FrameMatrix(step.name, step.before, rows, latex)


def _travel(axis: Axis, variable: str) -> AxisTravel:
    low, high = (end if math.isfinite(end) and not axis.endless else None for end in (axis.low, axis.high))
    return AxisTravel(axis.name, variable, axis.is_rotary, str(axis.mount), axis.endless, low, high)
