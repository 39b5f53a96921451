"""What must be known before slide positions can be written, for programs without TCP."""

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from trunnion.errors import InputError, Problem
from trunnion.machines import Machine
from trunnion.model.toolpath import LoadTool, Operation

#: Directions are parallel within this sine.
_PARALLEL_SINE: Final = 1e-6


def check_slides_are_known(file: str, operations: Sequence[Operation], machine: Machine) -> None:
    """Check that everything is known that slide positions depend on.

    Raises
    ------
    InputError
        If something is missing. Not even ``--force`` writes such positions, for they would be arbitrary.
    """
    problems = []
    line = operations[0].line
    if machine.workpiece_zero is None:
        what = (
            "without TCP the program holds positions of the slides, and the workpiece zero on the machine is not known"
        )
        problems.append(
            Problem(file, line, what, "write setting zero=X,Y,Z, or zero_mm under [workpiece]", code="PLN510")
        )
    if {machine.axes[column].name for column in machine.linear} != set("XYZ"):
        what = f"without TCP the words X, Y and Z are slides, and those of {machine.key} have other names"
        problems.append(Problem(file, line, what, "name the slides X, Y and Z in the definition", code="PLN540"))
    elif machine.has_rotary_head:
        problems += _tool_length_problems(file, operations, machine)
    if problems:
        raise InputError(problems)


def _tool_length_problems(file: str, operations: Sequence[Operation], machine: Machine) -> Iterable[Problem]:
    """Where a head turns the tool, slide positions depend on the tool's length."""
    line, z = operations[0].line, machine.axis("Z")
    if machine.tool_length is None:
        what = "without TCP the slides follow the tool's length where the head turns it, and it is not known"
        yield Problem(file, line, what, "write setting tool_length=MM, as in the control's tool offset", code="PLN520")
    if z.sense * float(np.dot(z.direction, machine.spindle_direction)) < 1.0 - _PARALLEL_SINE:
        what = "without TCP the control adds the tool's length along Z, and the spindle does not point there at zero"
        yield Problem(file, line, what, "post with TCP (setting tcp=on)", code="PLN540")
    tools: dict[tuple[int | None, str], int] = {}
    number = None
    for operation in operations:
        loads = [event.number for event in operation.events if isinstance(event, LoadTool)]
        number = loads[-1] if loads else number
        tools.setdefault((number, operation.tool.name), operation.line)
    if len(tools) > 1:
        what = f"{len(tools)} tools in a program without TCP, and one tool length for all"
        yield Problem(file, list(tools.values())[1], what, "post one program for each tool", code="PLN530")
