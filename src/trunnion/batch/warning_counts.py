"""What a batch warns of: how many files have each code, and the first of them."""

from collections.abc import Iterator

from trunnion.batch.records import Record
from trunnion.errors import Problem, Severity
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class CountedWarning:
    """Warnings of one code.

    files    how many files have one
    file     the first of them, in the order of the places of results
    problem  its first warning of this code
    """

    code: str
    files: int
    file: str
    problem: Problem


class WarningCounter:
    """Counts warnings of files, in whatever order their work ends."""

    def __init__(self) -> None:
        self._files: dict[str, int] = {}
        self._first: dict[str, tuple[int, str, Problem]] = {}

    def add(self, number: int, record: Record) -> None:
        """Count those of a file by its number."""
        for problem in _first_of_codes(record):
            code = problem.code
            self._files[code] = self._files.get(code, 0) + 1
            if code not in self._first or number < self._first[code][0]:
                self._first[code] = number, record.file, problem

    def found(self) -> tuple[CountedWarning, ...]:
        """Return all codes, those of the most files first."""
        found = [CountedWarning(code, count, *self._first[code][1:]) for code, count in self._files.items()]
        return tuple(sorted(found, key=lambda each: (-each.files, each.code)))


def _first_of_codes(record: Record) -> Iterator[Problem]:
    seen = set[str]()
    for problem in record.problems:
        if problem.severity is Severity.WARNING and problem.code not in seen:
            seen.add(problem.code)
            yield problem
