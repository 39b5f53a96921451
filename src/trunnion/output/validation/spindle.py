"""Spindle speeds of operations: one that cuts while the spindle stands, or with another tool at the speed of the last.

In:     motions of a program, in their order.
Out:    errors where no speed is stated; warnings where the CL file states that of another tool.
"""

from itertools import pairwise

import numpy as np

from trunnion.arrays import Flags
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, LoadTool, Operation, SpindleOff, SpindleOn
from trunnion.output.program import Program
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class ToolInSpindle:
    """A tool by the number that it is called by, 0 if that is not known, and by the name that the CL file has for it.

    line  that calls it
    """

    number: int = 0
    name: str = ""
    line: int = 0

    def then(self, operation: Operation) -> "ToolInSpindle":
        """Return the tool that is in the spindle when an operation ends."""
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        name = operation.tool.name
        if loads:
            return ToolInSpindle(loads[-1].number, name, loads[0].line)
        return self if name in ("", self.name) else ToolInSpindle(0, name, operation.line)

    def is_another(self, before: "ToolInSpindle") -> bool:
        """Whether it is another tool than the one before it, of which something is known."""
        if self.number and before.number:
            return self.number != before.number
        return bool(before.number or before.name) and self.name != before.name


class SpindleSpeeds:
    """The spindle from motion to motion: ``turns`` is whether it does, None until the first SPINDL."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self.turns: bool | None = None
        self._on: SpindleOn | None = None
        self._tool = ToolInSpindle()
        #: The operation whose speed is in force.
        self._before = ""
        #: Whether the speed in force is that of another tool, and no cut has been found with it.
        self._is_of_other_tool = False

    def problems_of(self, operation: Operation) -> list[Problem]:
        """Return what the speeds of the next motion lack."""
        before, self._tool = self._tool, self._tool.then(operation)
        self._is_of_other_tool |= bool(self.turns) and self._tool.is_another(before)
        found = [*spindle_problems(self._program, operation, self.turns), *self._other_speed_problems(operation)]
        for event in operation.events:
            if isinstance(event, SpindleOn):
                self.turns, self._on, self._before = True, event, operation.name
            elif isinstance(event, SpindleOff) and self.turns:
                self.turns = False
            self._is_of_other_tool &= not isinstance(event, SpindleOn | SpindleOff)
        return found

    def _other_speed_problems(self, operation: Operation) -> list[Problem]:
        """Return what to say of an operation that cuts with a tool of its own, at the speed of the one before it.

        A speed that a setting states for another operation is refused: it holds for that alone.
        """
        cuts = np.flatnonzero(_cuts(operation))
        switches = [each.row for each in operation.events if isinstance(each, SpindleOn | SpindleOff)]
        if not self._is_of_other_tool or not len(cuts) or (switches and switches[0] <= cuts[0]):
            return []
        self._is_of_other_tool = False
        file, tool = self._program.file_of(operation), self._tool
        named = {"operation": operation.name, "number": tool.number or tool.name, "before": self._before}
        if self._on is not None and self._on.stated:
            return [Problem(file, tool.line, Wording("CTL510", "speed_stated_for_another", **named))]
        return [warning(file, tool.line, Wording("CTL520", "operation_loads_tool", **named))]


def spindle_problems(program: Program, operation: Operation, turns: bool | None) -> list[Problem]:
    """Refuse the first cut of an operation for which the spindle stands: before the first SPINDL, or after SPINDL/OFF.

    A check of the program without its CL files would fail it as well. An operation without a speed is warned of.

    ``turns`` is whether the spindle turns when the operation begins, by the operations before; None: no SPINDL yet.
    """
    switches = [event for event in operation.events if isinstance(event, SpindleOn | SpindleOff)]
    for event, following in pairwise([None, *switches, None]):
        start = event.row if event else 0
        on = turns if event is None else isinstance(event, SpindleOn)
        cuts = _cuts(operation)[start : following.row if following else None]
        if on or not cuts.any():
            continue
        if program.effective_setting("standing_spindle") != "allowed":
            line = int(operation.moves.line[start + int(np.argmax(cuts))])
            return [
                Problem(
                    program.file_of(operation),
                    line,
                    Wording("CTL510", "operation_cuts_while", operation=operation.name)
                    if event is None and turns is None
                    else Wording("CTL510", "operation_cuts_while_spindle", operation=operation.name),
                )
            ]
        break
    if turns is None and not any(isinstance(event, SpindleOn) for event in switches):
        return [
            warning(
                program.file_of(operation),
                operation.line,
                Wording("CTL520", "operation_no_spindle", operation=operation.name),
            )
        ]
    return []


def _cuts(operation: Operation) -> Flags:
    """(n,) bool: a motion at a feed, or a hole of a cycle."""
    return np.asarray(cycle_rows(operation) | (operation.moves.kind != Kind.RAPID))


def cycle_rows(operation: Operation) -> Flags:
    """(n,) bool: rows of an operation that are within a cycle."""
    rows = np.zeros(len(operation.moves), np.bool_)
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff):
            rows[event.row :] = isinstance(event, CycleOn)
    return rows
