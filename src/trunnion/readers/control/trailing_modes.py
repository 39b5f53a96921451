"""Modes that a program sets behind its last motion: they have no use in it, the next one may begin with them."""

from collections.abc import Hashable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Place:
    """Where a word stands: the row of the motion that follows it, its line, and its file as in ``Run.file``."""

    row: int
    line: int
    file: int


@dataclass(frozen=True, slots=True)
class TrailingMode:
    """A mode that was set: its name, the word that set it last, where, and what was in force at the motion before."""

    name: str
    word: str
    place: Place
    before: Hashable
    after: Hashable


class TrailingModes:
    """The modes that were set since the last motion."""

    def __init__(self) -> None:
        self._modes: dict[str, TrailingMode] = {}

    def set(self, name: str, word: str, place: Place, before: Hashable, after: Hashable) -> None:
        """Remember that a word has set a mode: what was in force until then, and what is from now on."""
        known = self._modes.get(name)
        if known is not None and known.place.row == place.row:
            before = known.before
        self._modes[name] = TrailingMode(name, word, place, before, after)

    def changed(self, row: int) -> Iterator[TrailingMode]:
        """Yield the modes that are now others than at the last motion, which is the one before a row."""
        return (mode for mode in self._modes.values() if mode.place.row == row and mode.before != mode.after)
