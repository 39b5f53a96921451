"""Units of definition keys: the end of a key names its unit."""

from collections.abc import Mapping
from typing import Final

#: End of a key -> its unit. The first one that fits counts: ``_mm_s`` stands before ``_s``.
UNITS: Final[Mapping[str, str]] = {
    "_mm_min": "millimetres per minute",
    "_deg_min": "degrees per minute",
    "_mm_s2": "millimetres per second squared",
    "_deg_s2": "degrees per second squared",
    "_mm_s": "millimetres per second",
    "_deg_s": "degrees per second",
    "_mm": "millimetres",
    "_deg": "degrees",
    "_s": "seconds",
    "_rpm": "revolutions per minute",
    "_kw": "kilowatts",
    "_nm": "newton metres",
    "_kg": "kilograms",
}


def unit_of(key: str) -> str:
    """Return unit that the end of a key names, in words; empty if it names none.

    >>> unit_of("rapid_deg_min")
    'degrees per minute'
    """
    return next((unit for end, unit in UNITS.items() if key.endswith(end)), "")


def without_unit(key: str) -> str:
    """Return a key without the end that names its unit.

    >>> without_unit("rapid_deg_min")
    'rapid'
    """
    return next((key.removesuffix(end) for end in UNITS if key.endswith(end)), key)
