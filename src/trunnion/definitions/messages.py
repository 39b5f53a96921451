"""Parts of messages about definitions: a value as it is written, and what to write instead."""

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Final

from trunnion.definitions.source_lines import LocatedValue
from trunnion.messages import Wording, phrase
from trunnion.wording import nearest_word

_MAX_SHOWN = 60
_NO_NAMES: Final[Mapping[str, str]] = MappingProxyType({})
#: A number and its unit. Three digits behind a comma may be thousands: then nobody knows the number.
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+|\d*,(?!\d{3}(?!\d))\d+))\s*[^\d.,]*")


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


def meant_word(word: str, known: Iterable[str], other_names: Mapping[str, str] = _NO_NAMES) -> str:
    """Return the known word that resembles an unknown one, or has it as another name; empty if none does.

    ``other_names`` are in small letters, and in letters alone.
    """
    return other_names.get("".join(filter(str.isalpha, word.lower()))) or nearest_word(word, known)


def a_number(
    unit: str = "", above: float | None = None, at_least: float | None = None, at_most: float | None = None
) -> Wording:
    """Return what to write where a number is wanted: a phrase."""
    bounds = _bounds(above, at_least, at_most)
    if unit and bounds:
        return phrase("number_in_unit_within", unit=unit, bounds=bounds)
    if unit:
        return phrase("number_in_unit", unit=unit)
    return phrase("number_within", bounds=bounds) if bounds else phrase("number")


def a_whole_number(
    unit: str = "", above: float | None = None, at_least: float | None = None, at_most: float | None = None
) -> Wording:
    """Return what to write where a whole number is wanted: a phrase."""
    if at_least is not None and at_least == at_most:
        return phrase("this_number", number=at_least)
    bounds = _bounds(above, at_least, at_most)
    if unit and bounds:
        return phrase("whole_number_in_unit_within", unit=unit, bounds=bounds)
    if unit:
        return phrase("whole_number_in_unit", unit=unit)
    return phrase("whole_number_within", bounds=bounds) if bounds else phrase("whole_number")


def _bounds(above: float | None, at_least: float | None, at_most: float | None) -> tuple[Wording, ...]:
    return (
        *(() if above is None else (phrase("bound_above", bound=above),)),
        *(() if at_least is None else (phrase("bound_at_least", bound=at_least),)),
        *(() if at_most is None else (phrase("bound_at_most", bound=at_most),)),
    )


def unquoted(key: str, value: object) -> str:
    """Return the line in which a number that is in quotes has none; empty if ``value`` is none."""
    found = _NUMBER.fullmatch(value.strip()) if isinstance(value, str) else None
    return f"{key} = {float(found[1].replace(',', '.')):.12g}" if found else ""


def in_quotes(key: str, value: object) -> str:
    """Return the line in which a number that is not in quotes is a text; empty if ``value`` is none."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f'{key} = "{value}"' if is_number else ""
