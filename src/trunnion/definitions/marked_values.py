"""Values that count in a merged definition and have a mark behind them (``trunnion.definitions.value_marks``)."""

import re
from collections.abc import Iterator
from pathlib import Path

from trunnion.definitions.source_lines import LocatedValue
from trunnion.definitions.value_marks import marked_values
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class MarkedValue:
    """A value with a mark.

    name        its key with the name of its table, such as ``C point_mm``
    file, line  where it stands; no file: it is not stated, and a default counts
    mark        the comment, without its sign
    table       the key of that table at the top of the definition, such as ``axis``; empty: it is there itself
    """

    name: str
    file: str
    line: int
    mark: str
    table: str = ""

    @property
    def key(self) -> str:
        """Its key in its own table."""
        return self.name.rpartition(" ")[2]

    @property
    def of(self) -> str:
        """The name of its own table."""
        return self.name.rpartition(" ")[0]

    @property
    def said(self) -> Wording:
        """Return it with its place."""
        if not self.file:
            return phrase("value_not_stated", name=self.name)
        return phrase("value_at", name=self.name, file=Path(self.file).name, line=self.line)

    def __str__(self) -> str:
        return self.said.what


def marked_in(content: LocatedValue, mark: re.Pattern[str]) -> Iterator[MarkedValue]:
    """Yield the marked values of a definition, in its order; values that another file replaces are none of them."""
    marks: dict[str, dict[int, str]] = {}
    for name, value, table in _leaves_of_tables(content):
        if value.file not in marks:
            text = _text_of(value.file)  # finding the places of all its values takes a while
            found = marked_values(text, mark) if mark.search(text) else []
            marks[value.file] = {line: said for _, line, said in found}
        if (said := marks[value.file].get(value.line)) is not None:
            yield MarkedValue(name, value.file, value.line, said, table)


def _leaves_of_tables(content: LocatedValue) -> Iterator[tuple[str, LocatedValue, str]]:
    """Values that are no tables, each with its name and the key of its table at the top."""
    inner = content.value
    for key, item in inner.items() if isinstance(inner, dict) else ():
        below = isinstance(item.value, dict | list) and not _is_plain(item)
        yield from ((name, value, key if below else "") for name, value in _leaves(item, key))


def _leaves(value: LocatedValue, name: str) -> Iterator[tuple[str, LocatedValue]]:
    """Values that are no tables, each with its key and the name of its table."""
    inner = value.value
    if isinstance(inner, dict):
        own = inner.get("name")
        table = str(own.value) if isinstance(own, LocatedValue) and name else name
        for key, item in inner.items():
            below = isinstance(item.value, dict | list) and not _is_plain(item)
            yield from _leaves(item, key if below else f"{table} {key}".strip())
    elif not _is_plain(value) and isinstance(inner, list):
        for item in inner:
            yield from _leaves(item, name)
    else:
        yield name, value


def _is_plain(value: LocatedValue) -> bool:
    """Whether a value is none with values in it that have places of their own."""
    inner = value.value
    return not isinstance(inner, dict) and not (
        isinstance(inner, list) and inner and isinstance(inner[0], LocatedValue)
    )


def _text_of(file: str) -> str:
    """Return the text of a definition; empty for what is in no file."""
    try:
        return Path(file).read_text(encoding="utf-8-sig").replace("\r\n", "\n")
    except (OSError, ValueError):
        return ""
