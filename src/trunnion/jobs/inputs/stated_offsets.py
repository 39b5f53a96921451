"""Work offsets that operations of CL files state, as the setting ``work_offset`` of these operations.

In:     toolpaths, whose operations count the work offsets of the control from 1, and settings.
Out:    settings of single operations by their names; a setting that somebody gives takes precedence, and is told.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

from trunnion import readers
from trunnion.controls import Control
from trunnion.errors import InputError, Problem, warning
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import Operation, Toolpath

_SETTING: Final = "work_offset"

#: Settings of single operations, by their names.
OwnSettings = Mapping[str, Mapping[str, str]]


def with_stated_offsets(
    toolpaths: Sequence[Toolpath], on: tuple[Machine, Control | None], settings: Mapping[str, str], own: OwnSettings
) -> tuple[list[Toolpath], OwnSettings]:
    """Return the toolpaths, with a remark on each operation that is made in another work offset than it states, and
    the settings of operations with the work offsets that these state.

    on             the machine that runs the program, and its control; None: programs for it can be read alone
    settings, own  that somebody gives, for all operations and for single ones

    Raises ``InputError`` if the control has no such work offset or cannot differ by operation, or if operations of one
    name state different ones.
    """
    found, toolpaths, problems = {name: {**values} for name, values in own.items()}, list(toolpaths), list[Problem]()
    numbers = dict[str, int]()
    for k, toolpath in enumerate(toolpaths):
        for operation in toolpath.operations:
            if not operation.work_offset or not len(operation.moves):
                continue
            given = own.get(operation.name, {}).get(_SETTING) or settings.get(_SETTING)
            stated, fault = _setting(operation, *on)
            if given:
                if given != stated:
                    said = Wording(
                        "CL495", "setting_wins", operation=operation.name, number=operation.work_offset, taken=given
                    )
                    remarks, remark = toolpaths[k].remarks, warning(toolpath.file, operation.line, said)
                    toolpaths[k] = replace(toolpaths[k], remarks=tuple(dict.fromkeys((*remarks, remark))))
                continue
            before = numbers.setdefault(operation.name, operation.work_offset)
            if before != operation.work_offset:
                both = (str(before), str(operation.work_offset))
                fault = Wording("CL490", "two_of_one_name", operation=operation.name, numbers=both)
            if fault is not None:
                problems.append(Problem(toolpath.file, operation.line, fault))
            found.setdefault(operation.name, {})[_SETTING] = stated
    if problems:
        raise InputError(problems)
    return toolpaths, found


def _setting(operation: Operation, machine: Machine, control: Control | None) -> tuple[str, Wording | None]:
    """Return the setting of the work offset that an operation states, or why there is none."""
    name, number, called = operation.name, operation.work_offset, control.name if control else machine.control
    if (control and not control.differs_by_operation(_SETTING)) or not readers.can_read(machine):
        return "", Wording("CL490", "none_by_operation", operation=name, number=number, control=called)
    offsets = readers.reader_of(machine).work_offsets
    value = offsets.nth(number)
    if not value:
        form = offsets.form_said
        return "", Wording("CL490", "not_so_many", operation=name, number=number, control=called, form=form)
    return offsets.setting(value), None
