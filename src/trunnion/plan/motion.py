"""What the planner hands on."""

from dataclasses import dataclass

from trunnion.arrays import Floats
from trunnion.errors import Problem
from trunnion.toolpath import Operation


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """One operation on the machine.

    operation    the operation in the program's coordinate system (workpiece frame), with arcs that the control is not
                 to be given as arcs turned into lines
    rotary       (n, 2) float64   positions of the rotary axes, degrees, in the order of ``machine.rotary`` and in the
                 range that each displays. The slides follow from them and the tip: ``trunnion.machine.slide_positions``
    three_axis   the tool axis is +Z of the program's coordinate system throughout
    """

    operation: Operation
    rotary: Floats
    three_axis: bool

    def __post_init__(self) -> None:
        self.rotary.setflags(write=False)


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """All operations of one program, and what speaks against running them.

    ``problems`` with severity error mean that the program must not run as it is.
    """

    motions: tuple[Motion, ...]
    problems: tuple[Problem, ...]
