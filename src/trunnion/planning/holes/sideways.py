"""Tools that cut along their axis alone, such as drills, and where a CL file moves them sideways at a feed."""

import re
from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOn, Kind, LoadTool, Operation, Toolpath
from trunnion.planning.holes.operations import hole_rows

#: Points beside each other by no more than this, across the tool axis, are one above the other, mm.
_BESIDE: Final = 0.01

#: Points this far below the highest one of their operation may be in the part, mm.
_BELOW: Final = 1e-3

#: Drills with a smaller tip angle also cut chamfers, degrees; they count as drills where they drill.
_LEAST_DRILL_ANGLE: Final = 91.0

#: Words in the name of a tool that cuts along its axis alone.
_NAMES: Final = re.compile(r"(?<![A-Z])(?:TAP|REAMER|BORING[ _-]?BAR)(?![A-Z])", re.IGNORECASE)


def sideways_problems(toolpaths: Sequence[Toolpath]) -> list[Problem]:
    """Return an error for each operation that moves a drill, tap, reamer or boring bar sideways at a feed: not at the
    height of its highest point, where nothing is to cut.
    """
    operations = [operation for toolpath in toolpaths for operation in toolpath.operations if len(operation.moves)]
    tools = _tools_of(operations)
    used = dict[int | str, set[str]]()
    for tool, operation in zip(tools, operations, strict=True):
        words = (word for event in operation.events if isinstance(event, CycleOn) for word in event.mode)
        used.setdefault(tool, set()).update(words)
    problems = []
    for tool, operation in zip(tools, operations, strict=True):
        row = _first_sideways(operation) if _cuts_along_its_axis(operation, used[tool]) else None
        if row is not None:
            wording = Wording(
                "PLN350", "tool_sideways", operation=operation.name, tool=operation.tool.name or f"T{tool or 0}"
            )
            problems.append(Problem(operation.file, int(operation.moves.line[row]), wording))
    return problems


def _tools_of(operations: Sequence[Operation]) -> list[int | str]:
    """Return the tool of each operation: its number, also where it is that of the operation before; else its name."""
    tools: list[int | str] = []
    names = [operation.tool.name for operation in operations]
    for k, operation in enumerate(operations):
        numbers = [event.number for event in operation.events if isinstance(event, LoadTool)]
        if numbers:
            tools.append(numbers[-1])
        else:
            tools.append(tools[-1] if k and names[k] == names[k - 1] else names[k])
    return tools


def _cuts_along_its_axis(operation: Operation, cycles: set[str]) -> bool:
    """Whether the tool of an operation cannot cut sideways; ``cycles`` are the words of all cycles that it makes."""
    tool = operation.tool
    if tool.kind == "DRILL":
        return bool(cycles) or tool.tip_angle >= _LEAST_DRILL_ANGLE
    return "TAP" in cycles or {"BORE", "NODRAG"} <= cycles or _NAMES.search(tool.name) is not None


def _first_sideways(operation: Operation) -> int | None:
    """Return the first row that leads sideways at a feed, below the highest point of its operation."""
    moves = operation.moves
    before = moves.tip[1:] - moves.tip[:-1]
    axis = moves.axis[1:]
    across = before - np.einsum("ij,ij->i", before, axis)[:, None] * axis
    top = (moves.tip @ axis[0]).max() if len(axis) else 0.0
    below = np.einsum("ij,ij->i", moves.tip[1:], axis) < top - _BELOW
    cuts = (moves.kind[1:] != Kind.RAPID) & ~hole_rows(operation)[1:]
    found = np.flatnonzero(cuts & below & (np.linalg.norm(across, axis=1) > _BESIDE))
    return int(found[0]) + 1 if len(found) else None
