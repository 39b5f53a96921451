"""What a file of others says of a machine: values under the keys of a definition, and what no definition takes.

Units:  mm and degrees, as definitions have them.
"""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import field
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, TypeAlias

from trunnion.encoding import decode
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass

#: A place in a definition: ``("axis", "B", "limits_deg")``, ``("control", "block_numbers", "step")``.
Key: TypeAlias = tuple[str, ...]

#: Larger files are no posts and no machine data.
MOST_BYTES: Final = 64_000_000

#: Greater numbers are no sizes of a machine, mm, degrees or mm/min.
LARGEST: Final = 1e6
_NUMBER: Final = re.compile(r"[-+]?(?:\d{1,40}\.?\d{0,40}|\.\d{1,40})(?:[eE][-+]?\d{1,3})?", re.ASCII)


def place_in(file: Path, line: int) -> str:
    """Return the name of a file and a line, on one line whatever its name is."""
    return f"{''.join(letter if letter.isprintable() else '?' for letter in file.name)}:{line}"


@dataclass(frozen=True, slots=True)
class Stated:
    """A value, and the name, file and line under which it is stated."""

    value: Any
    name: str
    file: str
    line: int

    @property
    def source(self) -> str:
        """Name, file and line, as remarks and reports have them."""
        return f"{self.name}, {self.place}"

    @property
    def place(self) -> str:
        """File and line."""
        return place_in(Path(self.file), self.line)

    def as_value(self, value: Any) -> "Stated":
        """Return another value from the same place."""
        return Stated(value, self.name, self.file, self.line)


@dataclass(frozen=True, slots=True)
class Left:
    """What no definition takes.

    said    what it is: a wording, or the text of the file itself
    where   file and line
    reason  why it is not taken
    """

    said: str | Wording
    where: str
    reason: Wording

    @property
    def what(self) -> str:
        """What it is, in English."""
        return str(self.said)

    @property
    def why(self) -> str:
        """Why it is not taken, in English."""
        return self.reason.what


def because(variant: str, /, **parameters: object) -> Wording:
    """Return a text of the catalogue ``foreign``: what is not taken, or why."""
    return Wording("foreign", variant, **parameters)


def not_taken(value: Stated, reason: Wording) -> Left:
    """Return a value that no definition takes, as its file has it."""
    return Left(f"{value.name} = {value.value}", value.place, reason)


@dataclass(frozen=True, slots=True)
class ForeignMachine:
    """A machine as files of others describe it.

    rotary   the rotary axes from the workpiece to the tool, each with what it carries: ``("C", "part")``
    values   what is stated, under the keys of a definition
    left     what is not taken
    control  the shipped control whose words the files use; empty: nothing says
    """

    rotary: tuple[tuple[str, str], ...]
    values: Mapping[Key, Stated]
    left: tuple[Left, ...]
    control: str = ""


def number(text: Any) -> float | None:
    """Return a number as files of others write it; None where it is none, or none of a machine."""
    if not _NUMBER.fullmatch(str(text).strip()):
        return None
    value = float(text)
    return value if abs(value) <= LARGEST else None


def index(text: Any) -> int | None:
    """Return a whole number from 0 to 999999; None where it is none."""
    return int(text) if re.fullmatch(r"\d{1,6}", str(text), re.ASCII) else None


@cache
def marks_of_controls() -> dict[str, Any]:
    """Return by what files of others show the control that they are for."""
    data: dict[str, Any] = tomllib.loads(files(__package__).joinpath("controls.toml").read_text(encoding="utf-8"))
    return data


@dataclass(slots=True)
class WordCounts:
    """In how many lines the words of each control stand."""

    counts: dict[str, int] = field(default_factory=dict)

    def count(self, line: str) -> None:
        """Look for the words of each control in a line."""
        for control, words in marks_of_controls()["words"].items():
            if any(word in line for word in words):
                self.counts[control] = self.counts.get(control, 0) + 1

    @property
    def control(self) -> str:
        """The control whose words stand in most lines; empty where none is clearly ahead."""
        ranked = [*sorted(((count, name) for name, count in self.counts.items()), reverse=True), (0, ""), (0, "")]
        return ranked[0][1] if ranked[0][0] > 2 * ranked[1][0] else ""


def read_text(file: Path) -> str:
    """Return the text of a file, in whatever encoding it is.

    Raises ``InputError`` if it cannot be read, is too large, or is no text.
    """
    try:
        size = file.stat().st_size
        data = file.read_bytes() if size <= MOST_BYTES else b""
    except OSError:
        raise InputError(Problem(str(file), 0, Wording("DEF610", "unreadable"))) from None
    if size > MOST_BYTES:
        raise InputError(Problem(str(file), 0, Wording("DEF610", "too_large", most=MOST_BYTES // 1_000_000)))
    if b"\0" in data:
        raise InputError(Problem(str(file), 0, Wording("DEF610", "no_text")))
    return decode(data)
