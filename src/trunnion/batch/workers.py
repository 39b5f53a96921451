"""What workers are, and what all of them tell of a file alike."""

import errno
from collections.abc import Iterable, Iterator
from typing import Final, Protocol

from trunnion.batch.records import Record
from trunnion.batch.worker_task import DEFINITIONS, FILES, Outcome, Task
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.records import dataclass
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
    """Return a logical name as messages have it."""
    return name.removeprefix(FILES).removeprefix(DEFINITIONS)


def died(file: str, wording: Wording) -> Problem:
    """Return the problem of a file whose worker has died."""
    return Problem(shown(file), 0, wording)


#: The code of shares that cannot be used.
DAMAGED: Final = "BAT395"


def damaged(file: str, why: str) -> Problem:
    """Return the problem of a file whose shares cannot be put together."""
    return Problem(shown(file), 0, Wording("BAT395", "damaged", reason=why))


#: Errors of the system that say nothing about a file: no space, no memory, no rights, a disk that fails.
_HINDRANCES: Final = frozenset(
    code
    for code, name in errno.errorcode.items()
    if name in ("EACCES", "EAGAIN", "EDQUOT", "EIO", "EMFILE", "ENFILE", "ENODEV", "ENOMEM", "ENOSPC", "ENXIO", "EPERM")
    or name in ("EROFS", "ESTALE")
)


def hindrance(error: BaseException | None) -> str | None:
    """Return what of the computer is behind an error, which may be another one's consequence; None: it has to do with
    files.

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
    """Return the problem of a file on which the computer did not let work be done."""
    return Problem(shown(file), 0, Wording("BAT390", "work_could_not", why=why))


def timed_out(file: str, seconds: float) -> Problem:
    """Return the problem of a file that took too long."""
    return Problem(shown(file), 0, Wording("BAT350", "was_not_done", format_duration=format_duration(seconds)))
