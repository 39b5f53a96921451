"""X, Y and Z as increments: how far each is from the position that was printed last.

In:     columns of absolute counts, what was printed last, and which blocks may have increments.
Out:    columns of what is printed, absolute or not, row by row.

Increments are differences of printed positions, not of the path's: whatever their number, no rounding adds up.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.controls.words import ABSENT, IncrementWords, Word

#: The words that can be increments.
AXES: Final = ("X", "Y", "Z")


#: What the key of a word has behind it where the word is an increment.
_INCREMENT: Final = "_increment"


class PositionTable(NamedTuple):
    """The words of a table, as ``BlockWriter.write_table`` takes them."""

    columns: Mapping[str, Ints]
    forced: Mapping[str, bool | Ints] | None
    lines: Mapping[int, str] | None


def words_with_increments(words: Sequence[Word], said: IncrementWords) -> Sequence[Word]:
    """Return words, with those of increments beside X, Y and Z where each word says that it is one."""
    found = list[Word]()
    for word in words:
        found.append(word)
        if said.prefix and word.key in AXES:
            own = said.prefix + word.letter
            found.append(replace(word, key=word.key + _INCREMENT, letter=own, modal=False))
    return found


def with_increments(
    table: PositionTable, last: Mapping[str, int], may: Flags | None, said: IncrementWords, *, on: bool
) -> tuple[PositionTable, Mapping[str, int], bool]:
    """Return a table with increments where a row may have them and the positions before it are known.

    table  with X, Y or Z, as absolute counts
    last   word -> the absolute count before the first row, ``ABSENT`` if it is not known
    may    (n,) bool: the row may have increments; None: none may
    said   how the family says them
    on     the block before the first row has increments

    table, last, on  the same after the last row; a row without a position counts as the one before it
    """
    own = {key: table.columns[key] for key in AXES if key in table.columns}
    forced, rows = table.forced or {}, len(next(iter(own.values())))
    printed, steps, ends = dict[str, Flags](), dict[str, Ints](), dict[str, int]()
    moved, unknown = np.zeros(rows, np.bool_), np.zeros(rows, np.bool_)
    for key, column in own.items():
        known = _filled(column, last[key])
        previous = np.concatenate(([last[key]], known[:-1]))
        has = (column != ABSENT) & ((column != previous) | (np.asarray(forced.get(key, 0)) != 0))
        unknown |= has & (previous == ABSENT)
        moved |= has
        printed[key], ends[key] = has, int(known[-1])
        steps[key] = np.where(has & (previous != ABSENT), column - previous, 0)
    may = np.zeros(rows, np.bool_) if may is None else may
    relative = _of_last_stated(may & ~unknown, moved, before=on)
    columns, lines = dict(table.columns), dict(table.lines or {})
    for key, column in own.items():
        counts = np.where(relative, steps[key], column)
        split = relative if said.prefix else np.zeros(rows, np.bool_)
        columns[key] = np.where(printed[key] & ~split, counts, ABSENT)
        columns[key + _INCREMENT] = np.where(printed[key] & split, counts, ABSENT)
    flags: dict[str, bool | Ints] = {**forced, **{key: has.astype(np.int64) for key, has in printed.items()}}
    if not said.prefix:
        changes = np.flatnonzero(relative != np.concatenate(([on], relative[:-1])))
        lines |= {row: said.on if relative[row] else said.off for row in changes.tolist()}
    return PositionTable(columns, flags, lines), ends, bool(relative[-1]) and not said.prefix


def _filled(column: Ints, before: int) -> Ints:
    """Return a column in which a row without a count has that of the row before it."""
    full = np.concatenate(([before], column))
    at = np.maximum.accumulate(np.where(full != ABSENT, np.arange(len(full)), 0))
    return np.asarray(full[at][1:])


def _of_last_stated(flags: Flags, stated: Flags, *, before: bool) -> Flags:
    """Return flags in which a row that states none has that of the row before it."""
    full = np.concatenate(([before], flags))
    at = np.maximum.accumulate(np.concatenate(([0], np.where(stated, np.arange(1, len(full)), 0))))
    return np.asarray(full[at][1:])
