"""How far the work within a step has come, in the shape of ``jobs.observer.Observer.progress``."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import TypeAlias

#: Tells how much more is done.
Advance: TypeAlias = Callable[[int], None]

#: Accompanies a stage of the work: its name, how much there is to do, and in what unit that counts.
Progress: TypeAlias = Callable[[str, int, str], AbstractContextManager[Advance]]


def ignore(_more: int) -> None:
    """Receive progress and do nothing."""


def silent(_stage: str, _total: int, _unit: str) -> AbstractContextManager[Advance]:
    """Accompany a stage and do nothing."""
    return nullcontext(ignore)
