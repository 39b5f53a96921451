"""Settings that a CL file leaves to be stated, of all its operations at once.

In:     errors of a post, whose cures name settings (``OPERATION:RPM``).
Out:    one message with every setting that is missing, as it is written, to be copied and filled in.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Final

from trunnion.errors import Problem, Severity
from trunnion.messages import Wording, phrase, settings_in_cure
from trunnion.output.program import Program

#: What stands in cures for the name of the operation, before the value.
OPERATION: Final = "OPERATION:"

#: The code of the message that gathers them.
GATHERED: Final = "CTL570"

#: Signs by which the entries of a setting are told apart.
_PARTING: Final = frozenset(",:")


def operation_of(error: Problem, program: Program) -> str:
    """Return the name of the operation in which the line of an error stands; empty if it is unknown."""
    operations = [motion.operation for motion in program.motions if motion.starts_operation]
    begun = [each for each in operations if program.file_of(each) == error.file and each.line <= error.line]
    return max(begun, key=lambda each: each.line).name if begun else ""


def entries_to_fill(problem: Problem, operation: str) -> list[tuple[str, str]]:
    """Return the settings that a cure names, with the name of the operation where they are for one."""
    found = list[tuple[str, str]]()
    for name, value in settings_in_cure(problem.wording):
        if not value.startswith(OPERATION):
            found.append((name, value))
        elif operation and not _PARTING & set(operation):
            found.append((name, f"{operation}:{value.removeprefix(OPERATION)}"))
    return found


def unnamed_operations(problems: Iterable[Problem]) -> tuple[str, ...]:
    """Return the names of operations that settings are wanted for, and that none can name."""
    named = [
        str(each.wording.parameter("operation") or "")
        for each in problems
        if each.severity is Severity.ERROR
        and any(value.startswith(OPERATION) for _, value in settings_in_cure(each.wording))
    ]
    return tuple(dict.fromkeys(name for name in named if _PARTING & set(name)))


def with_operations(errors: Iterable[Problem], program: Program) -> list[Problem]:
    """Return errors that know the name of their operation, where their cures name settings of one."""
    return [
        replace(error, wording=error.wording.with_parameters(operation=name))
        if error.wording.parameter("operation") is None
        and any(value.startswith(OPERATION) for _, value in settings_in_cure(error.wording))
        and (name := operation_of(error, program))
        else error
        for error in errors
    ]


def settings_to_fill(errors: Sequence[Problem], file: str) -> list[Problem]:
    """Return a message with the settings of operations that are missing, where more than one is; and one with those
    operations that no setting can name.

    errors  that know their operations
    file    that the message is about
    """
    lacking: dict[str, list[str]] = {}
    for error in errors:
        for name, value in entries_to_fill(error, str(error.wording.parameter("operation") or "")):
            if ":" in value and value not in lacking.setdefault(name, []):
                lacking[name].append(value)
    unnamed = unnamed_operations(errors)
    found = [Problem(file, 0, Wording("CTL570", "operation_not_to_name", names=unnamed))] if unnamed else []
    if sum(map(len, lacking.values())) < 2:
        return found
    settings = _stated((name, ",".join(values)) for name, values in lacking.items() if values)
    gathered = Wording("CTL570", "settings_of_operations", count=len(settings), settings=settings)
    return [*found, Problem(file, 0, gathered)]


def _stated(settings: Iterable[tuple[str, str]]) -> tuple[Wording, ...]:
    return tuple(phrase("stated_setting", name=name, value=value) for name, value in settings)
