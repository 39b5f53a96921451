"""What can be wrong, as values first and as text last.

    TrunnionError            carries every Problem found, never only the first
    ├── InputError           a file, a definition or a command that cannot be used      (exit 2)
    └── RefusedError         understood, but the program must not run as it is           (exit 1)

A Problem prints as ``file:line: error: what is wrong; what puts it right``, the form that
editors and CI systems know how to jump to.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """How much a problem weighs."""

    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong, where it is, and what would put it right.

    ``line`` counts from 1; 0 means that the problem belongs to the file as a whole.
    """

    file: str
    line: int
    what: str
    cure: str = ""
    severity: Severity = Severity.ERROR

    def __str__(self) -> str:
        """Return ``file:line: severity: what; cure``."""
        place = f"{self.file}:{self.line}" if self.line else self.file
        cure = f"; {self.cure}" if self.cure else ""
        return f"{place}: {self.severity}: {self.what}{cure}"


class TrunnionError(Exception):
    """Base of every error that Trunnion raises on purpose."""

    def __init__(self, problems: Problem | Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))


class InputError(TrunnionError):
    """A file, a definition or a command that cannot be used."""


class RefusedError(TrunnionError):
    """The input was understood, but the program that it asks for must not run."""
