"""Parts of messages about definitions: a value as it is written, and what to write instead."""

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Final

from trunnion.definitions.source_lines import LocatedValue
from trunnion.definitions.units import unit_of
from trunnion.wording import nearest_word

_MAX_SHOWN = 60
_NO_NAMES: Final[Mapping[str, str]] = MappingProxyType({})
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)")


def as_written(value: object) -> str:
    """Return a value as it would stand in the file, cut short."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        text = '"' + value + '"'
    elif isinstance(value, dict):
        return "a table"
    elif isinstance(value, list):
        is_tables = bool(value) and isinstance(value[0], LocatedValue)
        text = "an array of tables" if is_tables else str(value).replace("'", '"')
    else:
        text = str(value)
    return text if len(text) <= _MAX_SHOWN else text[: _MAX_SHOWN - 3] + "..."


def did_you_mean(word: str, known: Iterable[str], other_names: Mapping[str, str] = _NO_NAMES) -> str:
    """Return a question for the known word that resembles an unknown one, or has it as another name; empty if none
    does.

    ``other_names`` are in small letters, and in letters alone.
    """
    other = other_names.get("".join(filter(str.isalpha, word.lower())))
    near = other or nearest_word(word, known)
    return f'did you mean "{near}"?' if near else ""


def a_number(key: str) -> str:
    """Return the words "a number", with the unit of the key."""
    unit = unit_of(key)
    return f"a number in {unit}" if unit else "a number"


def in_unit(key: str, separator: str) -> str:
    """Return the words "in" and the unit of the key, after a separator; empty if it has none."""
    unit = unit_of(key)
    return f"{separator}in {unit}" if unit else ""


def bounds(above: float | None, at_least: float | None, at_most: float | None) -> str:
    """Return the bounds of a number in words, after a blank; empty if there are none."""
    parts = [
        f"above {above:g}" if above is not None else "",
        f"of at least {at_least:g}" if at_least is not None else "",
        f"of at most {at_most:g}" if at_most is not None else "",
    ]
    text = " and ".join(part for part in parts if part)
    return f" {text}" if text else ""


def unquoted(key: str, value: object) -> str:
    """Return a hint how to write a number that is in quotes, after a comma; empty if there is none in ``value``."""
    found = _NUMBER.match(value.strip()) if isinstance(value, str) else None
    return f", without quotes and unit: {key} = {found.group()}" if found else ""


def in_quotes(key: str, value: object) -> str:
    """Return a hint how to write as a text a number that is not in quotes, after a colon; empty if ``value``
    is none.
    """
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f': {key} = "{value}"' if is_number else ""
