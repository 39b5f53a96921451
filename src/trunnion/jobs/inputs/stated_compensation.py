"""The setting ``compensation``: operations of which CUTCOM is left out."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

from trunnion.errors import InputError, Problem, setting_problem, warning
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_by_operation
from trunnion.messages import Wording
from trunnion.model.toolpath import CutterComp, Operation, Toolpath

_KEY: Final = "compensation"

#: What it says of an operation, and whether CUTCOM stays.
_VALUES: Final = {"programmed": True, "left_out": False}


def with_stated_compensation(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> list[Toolpath]:
    """Leave out CUTCOM where the setting says so, with a remark on each operation.

    Raises ``InputError`` for an operation that is not there, or has no CUTCOM, or whose points are those of the
    contour: without CUTCOM the tool would cut into the part by its radius.
    """
    stays, found = stated_by_operation(_KEY, settings, _VALUES.get), [*toolpaths]
    if not stays:
        return found
    check_operations(_KEY, stays, found)
    compensated = {each.name for path in found for each in path.operations if _switches(each)}
    problems = [
        setting_problem(_KEY, Wording("ARG230", "no_cutcom_there", operation=name))
        for name in sorted({*stays} - {"", *compensated})
    ]
    paths = list[Toolpath]()
    for path in found:
        operations, remarks = list[Operation](), list(path.remarks)
        for operation in path.operations:
            switches = _switches(operation)
            if not switches or stays.get(operation.name, stays.get("", True)):
                operations.append(operation)
                continue
            if any(each.contour for each in switches):
                problems.append(_of_contour(path, operation, switches[0]))
            said = Wording("CTL220", "cutcom_left_out", operation=operation.name)
            remarks.append(warning(path.file, switches[0].line, said))
            events = tuple(each for each in operation.events if not isinstance(each, CutterComp))
            operations.append(replace(operation, events=events))
        paths.append(replace(path, operations=tuple(operations), remarks=tuple(remarks)))
    if problems:
        raise InputError(problems)
    return paths


def _switches(operation: Operation) -> list[CutterComp]:
    return [event for event in operation.events if isinstance(event, CutterComp)]


def _of_contour(path: Toolpath, operation: Operation, first: CutterComp) -> Problem:
    return Problem(path.file, first.line, Wording("CTL220", "contour_not_left_out", operation=operation.name))
