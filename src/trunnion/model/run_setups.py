"""Which tool length and which workpiece zero are in force in the rows of a run.

Only where tools have lengths, or work offsets have zeros, of their own: most runs have one machine throughout.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from trunnion.arrays import Ints, distinct
from trunnion.machines import Machine
from trunnion.model.columns import StepColumn
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Setup:
    """A machine with the length of one tool and the zero of one work offset, as they are in force in some rows.

    tool           in the spindle, as the program calls it; empty: none has been called
    work_offset    as in ``Run.work_offset``
    length_source  a word of the program, a library or a CL file that gives the length; empty: it is stated
    is_elsewhere   nobody has stated where the work offset is in the frame of the run, which is that of another one
    """

    machine: Machine
    tool: str
    work_offset: int
    length_source: str = ""
    is_elsewhere: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class RunSetups:
    """The set-ups of n rows; ``number`` (n,) has the set-up of each."""

    each: tuple[Setup, ...]
    number: StepColumn

    def at(self, row: int) -> Setup:
        """Return that of a row; -1: that of the first."""
        return self.each[int(self.number[max(row, 0)])] if len(self.number) else self.each[0]

    def by_machine(self, rows: Ints) -> Iterator[tuple[Machine, Ints]]:
        """Yield the machines of rows, in any order, each with the indices of its rows."""
        numbers = self.number.at(np.maximum(rows, 0))
        for number in distinct(numbers).tolist():
            yield self.each[number].machine, np.flatnonzero(numbers == number)

    def length_of(self, tool: str) -> float | None:
        """Return the length of a tool, mm; None: it is not known. Of several that a program gives it, the first."""
        lengths = (setup.machine.tool_length for setup in self.each if setup.tool == tool)
        return next((length for length in lengths if length is not None), None)

    def divided(self, first: int, end: int) -> list[tuple[int, int]]:
        """Return the bounds of consecutive rows, divided where another machine comes into force."""
        changes = [row for row in self.number.rows.tolist() if first < row < end]
        changes = [row for row in changes if self.at(row - 1).machine is not self.at(row).machine]
        return list(pairwise([first, *changes, end]))


def known_values(setup: Setup) -> int:
    """How many of its values are stated."""
    return (setup.machine.workpiece_zero is not None) + (setup.machine.tool_length is not None)
