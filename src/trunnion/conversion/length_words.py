"""What positions without a tool length in force are, and what registers hold: a program does not say it.

In:     the run of a program and its toolpath; what somebody has stated.
Out:    what has to be stated, and the toolpath with registers as they were stated.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import CutterComp, Event, Kind, LoadTool, Operation, Toolpath

#: What stands for the tool's own register.
TOOL: Final = "tool"


def first_cut_without_length(run: Run) -> int:
    """Return the first row that cuts in the workpiece while no tool length is in force; -1 if there is none.

    Only where programs call lengths: by a number (H), or by an edge (D).
    """
    calls_length = run.uses_length_numbers or run.language.endswith("sinumerik.reader")
    if not calls_length:
        return -1
    n = len(run)
    bare = run.state.length_axis.part(0, n) < 0
    found = np.flatnonzero(bare & ~run.machine_frame & (run.kind != Kind.RAPID))
    return int(found[0]) if len(found) else -1


def unsaid_positions(run: Run, positions: str | None) -> list[Problem]:
    """Return what has to be stated of positions without a tool length.

    positions  ``tip`` or ``gauge_line``, as it was stated; None: it was not
    """
    row = first_cut_without_length(run)
    if row < 0 or positions == "tip":
        return []
    has_length = run.machine.tool_length is not None or bool(run.machine.tool_lengths)
    if run.state.xyz_is_tip[row]:
        variant = "no_length_under_tcp"
    elif positions is None:
        variant = "no_length_word"
    elif has_length or run.setups is not None:
        return []
    else:
        variant = "gauge_line_without_length"
    return [Problem(run.files[int(run.file[row])], int(run.line[row]), Wording("CNV145", variant))]


def unsaid_registers(toolpath: Toolpath, target: str) -> list[Problem]:
    """Return what has to be stated of registers of the radius that a control without them has to leave out.

    All of them stand in one message.
    """
    named: dict[str, int] = {}
    for operation in toolpath.operations:
        own = _own_registers(operation)
        for event in operation.events:
            if (
                isinstance(event, CutterComp)
                and event.side != "OFF"
                and event.register
                and str(event.register) not in own
            ):
                named.setdefault(f"D{event.register}", event.line)
    if not named:
        return []
    first = next(iter(named))
    wording = Wording("CNV146", "registers_not_said", registers=tuple(named), first=first, target=target)
    return [Problem(toolpath.file, named[first], wording)]


def _own_registers(operation: Operation) -> set[str]:
    """Return the registers that are those of the operation's tools by their numbers."""
    loads = (event for event in operation.events if isinstance(event, LoadTool))
    return {str(number) for load in loads for number in (load.number, load.adjust)}


def with_registers(toolpath: Toolpath, stated: Mapping[str, str]) -> Toolpath:
    """Return a toolpath whose registers are as they were stated: ``D21`` and ``H11`` by another number or ``tool``."""
    if not stated:
        return toolpath
    operations = tuple(
        replace(each, events=tuple(_with_register(event, stated) for event in each.events))
        for each in toolpath.operations
    )
    return replace(toolpath, operations=operations)


def _with_register(event: Event, stated: Mapping[str, str]) -> Event:
    if isinstance(event, CutterComp) and (value := stated.get(f"D{event.register}")):
        return replace(event, register=_number(value))
    if isinstance(event, LoadTool) and (value := stated.get(f"H{event.adjust}")):
        return replace(event, adjust=_number(value))
    return event


def _number(value: str) -> int:
    return 0 if value == TOOL else int(value[1:])
