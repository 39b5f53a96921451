"""Modes that a program sets behind its last motion: they have no use in it, the next one may begin with them."""

from collections.abc import Callable, Hashable, Iterator, Mapping
from typing import Final

from trunnion.records import dataclass

#: With which modes any program may end.
USUAL_MODES: Final[Mapping[str, Hashable]] = {
    "distances": True, "plane": 2, "feed": 94, "offset": 54, "centres": True,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class WordPlace:
    """Where a word stands: the row of the motion that follows it, its line, and its file as in ``Run.file``."""

    row: int
    line: int
    file: int


@dataclass(frozen=True, slots=True)
class TrailingMode:
    """A mode that was set: its name, the word that set it last, where, and what was in force when it was last used."""

    name: str
    word: str
    place: WordPlace
    before: Hashable
    after: Hashable


class TrailingModes:
    """The modes that were set; ``used`` tells the row behind the last one that uses a mode of a name."""

    def __init__(self, used: Callable[[str], int]) -> None:
        self._modes: dict[str, TrailingMode] = {}
        self._used = used

    def set(self, name: str, word: str, place: WordPlace, before: Hashable, after: Hashable) -> None:
        """Remember that a word has set a mode: what was in force until then, and what is from now on."""
        known = self._modes.get(name)
        if known is not None and known.place.row >= self._used(name):
            before = known.before
        self._modes[name] = TrailingMode(name, word, place, before, after)

    def changed(self) -> Iterator[TrailingMode]:
        """Yield the modes that are now others than at the last motion that used them."""
        for name, mode in self._modes.items():
            if mode.place.row >= self._used(name) and mode.before != mode.after:
                yield mode
