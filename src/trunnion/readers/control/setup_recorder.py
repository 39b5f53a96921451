"""The set-ups of a program: the length of the tool in the spindle, and the zero of the work offset in force.

In:     a machine whose tools have lengths, or whose work offsets have zeros, of their own; changes of both.
Out:    the machine from each change on, and the run with its set-ups.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import distinct
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.machines.machine import Vector, tool_key
from trunnion.messages import Wording
from trunnion.model.run import Diagnostic, Run
from trunnion.model.run_setups import RunSetups, Setup, known_values
from trunnion.readers.control.row_buffer import StepColumnBuilder

#: Lengths that differ by less are the same, mm.
_SAME: Final = 1e-6


class SetupRecorder:
    """Knows which length and which zero are in force in each row."""

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._work_offset = 0
        self._length: tuple[float, str] | None = None
        self._machines: dict[tuple[float | None, Vector | None], Machine] = {}
        self._numbers: dict[tuple[str, int, tuple[float, str] | None], int] = {}
        self._setups: list[Setup] = []
        self._column: StepColumnBuilder[int] | None = None
        if machine.has_single_values:
            self._column = StepColumnBuilder(self._number("", 0))

    def length_of(self, tool: str) -> float | None:
        """Return the length that is stated for a tool, mm."""
        return self._machine.set_up_for(tool, 0).tool_length

    def take_length(self, length: float | None, word: str = "") -> None:
        """Take a length of the program, whatever tool is in the spindle; None: that of the tool again."""
        self._length = None if length is None else (length, word)

    def machine_of(self, row: int, tool: str, work_offset: int | None) -> Machine | None:
        """Return the machine from a row on; None: it is the same throughout.

        work_offset  None: none counts, and the part stays where the one before has it
        """
        if work_offset is not None:
            self._work_offset = work_offset
        if self._column is None and self._length is None:
            return None
        if self._column is None:
            self._column = StepColumnBuilder(self._number("", 0))
        number = self._number(tool, self._work_offset)
        self._column.set(row, number)
        return self._setups[number].machine

    def _number(self, tool: str, work_offset: int) -> int:
        length = self._length if self._setups else None
        found = self._numbers.setdefault((tool, work_offset, length), len(self._setups))
        if found == len(self._setups):
            machine = self._machine.set_up_for(tool, work_offset)
            if length is not None:
                machine = replace(machine, tool_length=length[0])
            machine = self._machines.setdefault((machine.tool_length, machine.workpiece_zero), machine)
            source = length[1] if length else self._machine.length_sources.get(tool_key(tool), "")
            self._setups.append(Setup(machine, tool, work_offset, source))
        return found

    def of_run(self, run: Run) -> Run:
        """Return a run with its set-ups; its machine is that of the one of which the most is known."""
        if self._column is None:
            return run
        number = self._column.steps(len(run), np.uint16)
        setups = RunSetups(tuple(self._setups), number)
        at_part = ~run.state.machine_frame.column()
        used = [self._setups[k] for k in distinct(number.column()[at_part]).tolist()] or self._setups
        return replace(run, machine=max(used, key=known_values).machine, setups=setups)


def lengths_of_other_tools(run: Run, machine: Machine) -> Iterator[Diagnostic]:
    """Yield where a program that calls lengths by numbers works with one that is stated for another tool.

    machine  with the lengths of single tools
    """
    if not machine.tool_lengths:
        return
    pairs: set[tuple[int, int]] = set()
    changes = np.union1d(run.state.edge.rows, run.state.tool.rows)
    ends = [*changes[1:].tolist(), len(run)]
    for first, end in zip(changes.tolist(), ends, strict=True):
        rows = np.flatnonzero(~run.state.machine_frame.part(first, end)) if first < end else changes[:0]
        if not len(rows):
            continue
        row = first + int(rows[0])
        number, tool = int(run.state.edge[row]), int(run.state.tool[row])
        counted, length = (machine.tool_lengths.get(tool_key(name)) for name in (str(number), run.tools[tool]))
        if counted is None or length is None or abs(counted - length) < _SAME or (number, tool) in pairs:
            continue
        pairs.add((number, tool))
        wording = Wording(
            "NC361", "length_of_other_tool", word=f"H{number}", counted=counted, tool=run.tools[tool], length=length
        )
        yield Diagnostic(int(run.lines[row]), wording, Severity.ERROR, run.files[int(run.state.file[row])])
