"""The text of a setting that is stated as a number or as a switch: one rule for definitions, projects and Python."""

import datetime
from collections.abc import Sequence
from typing import Final

import numpy as np

#: What True and False mean, as far as a setting has such a word.
_SWITCHES: Final = {True: ("on", "yes"), False: ("off", "no")}


def setting_text(value: object, words: Sequence[str] = ()) -> str | None:
    """Return a setting as text; None if it is of a type that settings do not have.

    words  of a setting that is one of them
    """
    if isinstance(value, bool | np.bool_):
        return next((word for word in _SWITCHES[bool(value)] if word in words), None)
    if isinstance(value, str | int | np.integer | datetime.date):
        return str(value)
    if isinstance(value, float | np.floating):
        return np.format_float_positional(value, trim="-") if np.isfinite(value) else None
    return None
