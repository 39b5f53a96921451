"""What a worker is given and gives back: bytes and plain values, so that it needs no disk that others see.

In:     ``Task``: one file with all that its work reads.
Out:    ``Outcome``: files, what is wrong, figures.

Names of files are logical: ``files/…`` lie as beside the jobs, ``definitions/…`` as beside a machine that lies
elsewhere. They are the same on every computer, so that messages and checksums are, too.
"""

from collections.abc import Mapping
from dataclasses import field
from enum import StrEnum
from pathlib import Path
from typing import Any, Final

from trunnion.batch.share_seals import Seal
from trunnion.batch.stores import Kept
from trunnion.errors import Problem
from trunnion.records import dataclass

#: Where files of the jobs' folder lie, and those of a machine's definition that lies elsewhere.
FILES: Final = "files/"
DEFINITIONS: Final = "definitions/"

#: The file of a share among those of its outcome.
SHARE_FILE: Final = "share"

#: Problems of one file that are kept.
MOST_PROBLEMS: Final = 20


class OtherVersionError(Exception):
    """The worker has another version of Trunnion than the one that asks."""


class Action(StrEnum):
    """What is done with each file."""

    POST = "post"
    CONVERT = "convert"
    VERIFY = "verify"
    SIMULATE = "simulate"


class Status(StrEnum):
    """What became of a file.

    PASSED     done, and what came of it may run
    FAILED     understood, and it must not run
    UNUSABLE   a file or an argument cannot be used
    HINDERED   the computer did not let the work be done: no space, no memory, no rights
    BROKEN     the work ended by an error of Trunnion
    DIED       the process that worked on it ended, again and again
    TIMED_OUT  it took longer than it may
    """

    PASSED = "passed"
    FAILED = "failed"
    UNUSABLE = "unusable"
    HINDERED = "hindered"
    BROKEN = "broken"
    DIED = "died"
    TIMED_OUT = "timed out"

    @property
    def is_final(self) -> bool:
        """Whether the same files give it again."""
        return self in (Status.PASSED, Status.FAILED, Status.UNUSABLE)


@dataclass(frozen=True, slots=True)
class Costs:
    """What the work took; differs from run to run.

    processor_s  seconds of processor time
    seconds      of waiting for it
    """

    processor_s: float = 0.0
    seconds: float = 0.0

    def __add__(self, other: "Costs") -> "Costs":
        """Both together."""
        return Costs(self.processor_s + other.processor_s, self.seconds + other.seconds)


#: Of work that was not done, or not to its end.
NO_COSTS: Final = Costs()


@dataclass(frozen=True, slots=True)
class Task:
    """The work on one file.

    program    version of Trunnion that must do it (``keys.program_version``)
    arguments  of the function of the library, by their names; files by their logical names
    file       logical name of the file
    files      content of it and of what goes with it alone, by logical names
    shared     the same of what many files have in common; a path where the worker sees it
    result     name of the file that comes of it; empty: nothing does
    report     name of its report; empty: there is none
    share      the number of a share, from 0, and of how many: only that is made, as the file ``SHARE_FILE``
    shares     all of them, sealed: the result is made from these
    seals      of the share that is made, or of all of them
    spent      what they took
    """

    program: str
    action: Action
    arguments: Mapping[str, Any]
    file: str
    files: Mapping[str, bytes]
    shared: Mapping[str, bytes | Path]
    result: str
    report: str
    share: tuple[int, int] | None = None
    shares: tuple[bytes | Kept, ...] = ()
    seals: tuple[Seal, ...] = ()
    spent: Costs = NO_COSTS


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a task.

    problems  what is wrong and what is warned of, errors first; at most ``MOST_PROBLEMS``
    warnings  how many there are
    files     content by name
    figures   of the program (``figures.py``), as JSON has them
    """

    status: Status
    problems: tuple[Problem, ...] = ()
    warnings: int = 0
    files: Mapping[str, bytes] = field(default_factory=dict)
    figures: Mapping[str, Any] = field(default_factory=dict)
    costs: Costs = NO_COSTS
