"""Copies of the records that hooks get and return: what a hook keeps and changes later reaches no program.

In:     operations and events.
Out:    records of the same values that share no array and no record with them; their arrays are read-only.
"""

from dataclasses import fields, is_dataclass
from typing import TypeVar, cast

import numpy as np

_T = TypeVar("_T")


def detached(record: _T) -> _T:
    """Return a copy of a record, or of a value of one, with copies of all arrays and records in it."""
    return cast(_T, _copied(record))


def _copied(value: object) -> object:
    if isinstance(value, np.ndarray):
        column = np.array(value)
        column.setflags(write=False)
        return column
    if is_dataclass(value) and not isinstance(value, type):
        new = object.__new__(type(value))
        for each in fields(value):
            # Records are frozen, and a copy needs no check that the record has passed.
            object.__setattr__(new, each.name, _copied(getattr(value, each.name)))
        return new
    return tuple(map(_copied, value)) if type(value) is tuple else value
