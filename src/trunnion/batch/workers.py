"""What workers are, and what all of them tell of a file alike."""

import errno
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final, Protocol

from trunnion.batch.records import Record
from trunnion.batch.worker_task import DEFINITIONS, FILES, Outcome, Task
from trunnion.errors import Problem
from trunnion.wording import format_duration


@dataclass(frozen=True, slots=True)
class Assignment:
    """A file that is to be worked on: its number among all, and the record that it will have.

    is_share  only a share of it is made, which is kept under the place of the record
    """

    number: int
    record: Record
    is_share: bool = False


class Workers(Protocol):
    """What works on tasks, as ``LocalWorkers`` and ``DaskWorkers`` do."""

    def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        """Outcomes as they come, or records where the worker has written the results itself.

        Where ``tasks`` yields None, there is none before one that is asked for has come.
        """


def shown(name: str) -> str:
    """A logical name as messages have it."""
    return name.removeprefix(FILES).removeprefix(DEFINITIONS)


def died(file: str, why: str) -> Problem:
    """The problem of a file whose worker has died."""
    cure = "run the batch again with fewer workers, or this file alone"
    return Problem(shown(file), 0, why, cure, code="BAT310")


#: The code of shares that cannot be used.
DAMAGED: Final = "BAT395"


def damaged(file: str, why: str) -> Problem:
    """The problem of a file whose shares cannot be put together."""
    return Problem(shown(file), 0, f"what its tasks have left is damaged: {why}", "run the batch again", code=DAMAGED)


#: Errors of the system that say nothing about a file: no space, no memory, no rights, a disk that fails.
_HINDRANCES: Final = frozenset(
    code
    for code, name in errno.errorcode.items()
    if name in ("EACCES", "EAGAIN", "EDQUOT", "EIO", "EMFILE", "ENFILE", "ENODEV", "ENOMEM", "ENOSPC", "ENXIO", "EPERM")
    or name in ("EROFS", "ESTALE")
)


def hindrance(error: BaseException | None) -> str | None:
    """What of the computer is behind an error, which may be another one's consequence; None: it has to do with files.

    >>> hindrance(OSError(errno.ENOSPC, "No space left on device")), hindrance(ValueError("x"))
    ('No space left on device', None)
    """
    seen = set[int]()
    while error is not None and id(error) not in seen:
        if isinstance(error, MemoryError):
            return "the memory of the worker is full"
        if isinstance(error, OSError) and error.errno in _HINDRANCES:
            return error.strerror or str(error)
        seen.add(id(error))
        error = error.__cause__ or error.__context__
    return None


def hindered(file: str, why: str) -> Problem:
    """The problem of a file on which the computer did not let work be done."""
    what = f"the work could not be done on this computer: {why}"
    return Problem(shown(file), 0, what, "run the batch again once that is mended", code="BAT390")


def timed_out(file: str, seconds: float) -> Problem:
    """The problem of a file that took too long."""
    what = f"was not done within the {format_duration(seconds)} that each file has"
    return Problem(shown(file), 0, what, "give each file more time, or work on it alone", code="BAT350")
