"""Problems, and the exceptions that carry them.

    TrunnionError            carries every Problem found, never only the first
    ├── InputError           a file, a definition or a command cannot be used           (exit 2)
    └── RefusedError         the input is understood, but its program must not run      (exit 1)

A Problem prints as ``file:line: error: what is wrong; how to correct it [CODE]``, from which editors and
CI systems jump to the line. ``trunnion.explanations`` knows what each code means.
"""

import stat
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path

from trunnion.wording import one_line


class Severity(StrEnum):
    """Whether a problem stops the work."""

    WARNING = "warning"
    ERROR = "error"


class ArgumentName(str):
    """The name of an argument of the library, as the place of a problem; the command line names its option instead."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong, its location, and how to correct it.

    line  counts from 1; 0 if the problem concerns the file as a whole
    what  the fault
    cure  how to correct it; may be empty
    key   of a definition, from its root, such as ``axis[1].limits_deg``; empty elsewhere
    code  of what kind it is, such as ``CL110``: stays the same while messages change
    """

    file: str
    line: int
    what: str
    cure: str = ""
    severity: Severity = Severity.ERROR
    key: str = ""
    code: str = ""

    def __str__(self) -> str:
        """Return ``file:line: severity: what; cure [code]``."""
        place = f"{self.file}:{self.line}" if self.line else self.file
        cure = f"; {self.cure}" if self.cure else ""
        code = f" [{self.code}]" if self.code else ""
        return one_line(f"{place}: {self.severity}: {self.what}{cure}{code}")


def merge_repeated(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Problems that differ only in their lines become one: at the first line, with their number."""
    alike: dict[tuple[object, ...], list[Problem]] = {}
    for problem in problems:
        alike.setdefault((problem.file, problem.what, problem.cure, problem.severity), []).append(problem)
    return tuple(
        same[0] if len(same) == 1 else replace(same[0], what=f"{same[0].what} ({len(same)} times, first here)")
        for same in alike.values()
    )


def argument_problem(
    name: str, what: str, cure: str = "", severity: Severity = Severity.ERROR, *, code: str = ""
) -> Problem:
    """Return a problem with an argument of a function of the library."""
    return Problem(ArgumentName(name), 0, what, cure, severity, code=code)


def unusable_file(path: Path, what: str) -> Problem | None:
    """Return why a path is no file that can be read; None if it may be one. ``what`` is meant: ``an NC program``."""
    cure = f"give the path of {what}"
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:  # also names that no system allows
        is_missing = isinstance(error, FileNotFoundError | NotADirectoryError)
        reason = getattr(error, "strerror", None) or error
        if is_missing:
            return Problem(str(path), 0, "file not found", cure, code="FIL110")
        return Problem(str(path), 0, f"cannot be read: {reason}", cure, code="FIL120")
    if stat.S_ISDIR(mode):
        return Problem(str(path), 0, f"is a folder, not {what}", cure, code="FIL130")
    return (
        None
        if stat.S_ISREG(mode)
        else Problem(str(path), 0, f"is not a regular file, but {what} is one", cure, code="FIL130")
    )


class TrunnionError(Exception):
    """Base of all errors that Trunnion raises on purpose.

    problems  everything that is wrong
    """

    def __init__(self, problems: Problem | Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))


class InputError(TrunnionError):
    """A file, a definition or a command cannot be used."""


class RefusedError(TrunnionError):
    """The input is understood, but the program that it asks for must not run."""
