"""What workers are, and what all of them tell of a file alike."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

from trunnion.batch.records import Record
from trunnion.batch.task import DEFINITIONS, FILES, Outcome, Task
from trunnion.errors import Problem
from trunnion.wording import format_duration


@dataclass(frozen=True, slots=True)
class Assignment:
    """A file that is to be worked on: its number among all, and the record that it will have."""

    number: int
    record: Record


class Workers(Protocol):
    """What works on tasks, as ``LocalWorkers`` and ``DaskWorkers`` do."""

    def run(self, tasks: Iterable[tuple[Assignment, Task]]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        """Outcomes as they come, or records where the worker has written the results itself."""


def shown(name: str) -> str:
    """A logical name as messages have it."""
    return name.removeprefix(FILES).removeprefix(DEFINITIONS)


def died(file: str, why: str) -> Problem:
    """The problem of a file whose worker has died."""
    cure = "run the batch again with fewer workers, or this file alone"
    return Problem(shown(file), 0, why, cure, code="BAT310")


def timed_out(file: str, seconds: float) -> Problem:
    """The problem of a file that took too long."""
    what = f"took longer than {format_duration(seconds)}"
    return Problem(shown(file), 0, what, "give it more time with --timeout, or work on it alone", code="BAT350")
