"""Words that a function of the user has changed, as events of the motion to which they belong."""

from collections.abc import Iterable

from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Coolant, CycleOn, Event
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class Changer:
    """The function that has changed words: what messages call it, its file and its line."""

    title: Wording
    file: str
    line: int


@dataclass(frozen=True, slots=True)
class ChangedWords(Event):
    """Words of the block of the row, as counts; ``ABSENT`` for those that are left out."""

    words: tuple[tuple[str, int], ...]
    by: Changer


@dataclass(frozen=True, slots=True)
class ChangedCoolant(Coolant):
    """A coolant that is switched by other words, as counts."""

    changed: tuple[tuple[str, int], ...]
    by: Changer


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangedCycle(CycleOn):
    """A cycle with other numbers."""

    by: Changer


def changers(motions: Iterable[Motion]) -> dict[tuple[str, int], Changer]:
    """Return what has changed words, by the file and the line of the CL statement whose words they are."""
    return {
        (motion.operation.file, event.line): event.by
        for motion in motions
        for event in motion.operation.events
        if isinstance(event, ChangedWords | ChangedCoolant | ChangedCycle)
    }
