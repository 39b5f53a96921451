"""What must be known before slide positions can be written, for programs without TCP."""

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from trunnion.errors import InputError, Problem
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import LoadTool, Operation

#: Directions are parallel within this sine.
_PARALLEL_SINE: Final = 1e-6


def check_slides_are_known(file: str, operations: Sequence[Operation], machine: Machine) -> None:
    """Check that everything is known that slide positions depend on.

    Raises ``InputError`` if something is missing. Not even ``--force`` writes such positions, for they would be
    arbitrary.
    """
    problems = []
    line = operations[0].line
    if machine.workpiece_zero is None:
        problems.append(Problem(file, line, Wording("PLN510", "without_tcp_program")))
    if {machine.axes[column].name for column in machine.linear} != set("XYZ"):
        problems.append(Problem(file, line, Wording("PLN540", "without_tcp_words", machine=machine.key)))
    elif machine.has_rotary_head:
        problems += _tool_length_problems(file, operations, machine)
    if problems:
        raise InputError(problems)


def _tool_length_problems(file: str, operations: Sequence[Operation], machine: Machine) -> Iterable[Problem]:
    """Where a head turns the tool, slide positions depend on the tool's length."""
    line, z = operations[0].line, machine.axis("Z")
    if machine.tool_length is None:
        yield Problem(file, line, Wording("PLN520", "without_tcp_slides"))
    if z.sense * float(np.dot(z.direction, machine.spindle_direction)) < 1.0 - _PARALLEL_SINE:
        yield Problem(file, line, Wording("PLN540", "without_tcp_control"))
    tools: dict[tuple[int | None, str], int] = {}
    number = None
    for operation in operations:
        loads = [event.number for event in operation.events if isinstance(event, LoadTool)]
        number = loads[-1] if loads else number
        tools.setdefault((number, operation.tool.name), operation.line)
    if len(tools) > 1:
        yield Problem(file, list(tools.values())[1], Wording("PLN530", "tools_program_without", count=len(tools)))
