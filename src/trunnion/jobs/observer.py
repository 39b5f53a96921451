"""What is reported while work is under way: to a terminal, a notebook or a window."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext

from trunnion.errors import Problem
from trunnion.messages import LIBRARY, Words
from trunnion.model.motion import Plan
from trunnion.model.toolpath import Toolpath
from trunnion.verification.results import Verification


class Observer:
    """Receives progress and warnings while a program is made. Every method does nothing; override those that you need.

    Methods are called in the thread that called the library, but for the progress of reading, which may come from
    another one.

    ``words`` are the language of who asks, which pages for people are in, and what it calls settings.
    """

    words: Words = LIBRARY

    def setup(self, name: str) -> None:
        """Hear that a set-up of a project is posted next; its name is empty if there are no others."""

    def read(self, toolpaths: Sequence[Toolpath]) -> None:
        """Hear as what a CL file, or an archive of several, has been read, and in which unit."""

    def problems(self, problems: Sequence[Problem]) -> None:
        """Warnings about an input file, the plan or the program, as they are found."""

    def planned(self, plan: Plan) -> None:
        """Hear that the program is planned, and not yet written."""

    def verified(self, verification: Verification) -> None:
        """Hear that the program is written and verified; it is refused next if a check has failed."""

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """Accompany one stage of the work.

        Parameters
        ----------
        stage
            The name of the file that is read, ``writing``, or what else is done; it may be within another one.
        total
            How much there is to do.
        unit
            What ``total`` counts: ``B``, ``points``, ``steps`` ...

        Returns
        -------
        context manager
            Entered when the stage begins; gives a function that is called now and then with how much more is done.
        """
        return nullcontext(_ignore)


class Untold(Observer):
    """Passes on progress, and nothing else."""

    def __init__(self, observer: Observer) -> None:
        self._observer = observer

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """As ``Observer`` has it."""
        return self._observer.progress(stage, total, unit)


class Remembering(Observer):
    """Hands on what it hears to another one, and keeps the problems."""

    def __init__(self, other: Observer) -> None:
        self._other = other
        self.found: list[Problem] = []

    def setup(self, name: str) -> None:
        """Hand on whose set-up comes next."""
        self._other.setup(name)

    def read(self, toolpaths: Sequence[Toolpath]) -> None:
        """Hand on what has been read."""
        self._other.read(toolpaths)

    def problems(self, problems: Sequence[Problem]) -> None:
        """Keep problems, and hand them on."""
        self.found += problems
        self._other.problems(problems)

    def planned(self, plan: Plan) -> None:
        """Hand on a plan."""
        self._other.planned(plan)

    def verified(self, verification: Verification) -> None:
        """Hand on a verification."""
        self._other.verified(verification)

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """Hand on progress."""
        return self._other.progress(stage, total, unit)


def _ignore(more: int) -> None:
    """Receive progress and do nothing."""


#: Receives everything and does nothing.
SILENT = Observer()
