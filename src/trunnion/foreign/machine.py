"""What a file of others says of a machine: values under the keys of a definition, and what no definition takes.

Units:  mm and degrees, as definitions have them.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, TypeAlias

from trunnion.encoding import decode
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording

#: A place in a definition: ``("axis", "B", "limits_deg")``, ``("control", "block_numbers", "step")``.
Key: TypeAlias = tuple[str, ...]

#: Larger files are no posts and no machine data.
MOST_BYTES: Final = 64_000_000


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
        return f"{Path(self.file).name}:{self.line}"

    def as_value(self, value: Any) -> "Stated":
        """Return another value from the same place."""
        return Stated(value, self.name, self.file, self.line)


@dataclass(frozen=True, slots=True)
class Left:
    """What no definition takes: what it is, where it stands, and why."""

    what: str
    where: str
    why: str


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


@cache
def marks_of_controls() -> dict[str, Any]:
    """Return by what files of others show the control that they are for."""
    data: dict[str, Any] = tomllib.loads(files(__package__).joinpath("controls.toml").read_text(encoding="utf-8"))
    return data


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
