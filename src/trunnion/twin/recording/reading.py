"""Reads a recording: CSV or Parquet, of ``trunnion record`` or with the same columns.

In:     a file. It may be of any origin.
Out:    a ``Recording``, or an ``InputError`` with the mistakes.
"""

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.extras import import_extra
from trunnion.messages import Wording, phrase
from trunnion.model.recording import NO_TIME, Mark, Recording, TextColumn
from trunnion.twin.recording.files import LONGEST_TEXT, parse_stamp, unguarded
from trunnion.twin.recording.nodes import STAMPS, TEXTS, TIMES

#: Rows and columns of a recording at most, and mistakes that are told.
_MOST_ROWS: Final = 10_000_000
_MOST_COLUMNS: Final = 300
_MOST_PROBLEMS: Final = 20

#: Rows that are read at a time, and bytes of the cells of a group at most.
_GROUP: Final = 65_536
_MOST_BYTES: Final = 256 * 1024 * 1024

#: Kinds of numbers in Parquet.
_NUMBERS: Final = ("double", "float", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))

#: Greater numbers are none of a machine.
_GREATEST: Final = 1e12

_Cells = Sequence[Any]


def read_recording(path: Path) -> Recording:
    """Read a recording.

    Raises
    ------
    InputError
        If the file cannot be used, or with its mistakes.
    """
    if problem := unusable_file(path, phrase("file_of_recording")):
        raise InputError(problem)
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".parquet"):
        raise InputError(Problem(str(path), 0, Wording("TWN320", "no_recording")))
    try:
        return _Reader(str(path)).read(_csv_groups(path) if suffix == ".csv" else _parquet_groups(path))
    except (OSError, csv.Error) as error:
        raise InputError(Problem(str(path), 0, Wording("TWN320", "cannot_read", error=error))) from None


class _Reader:
    """Puts groups of rows together."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._problems: list[Problem] = []
        self._rows = 0
        self._codes: dict[str, dict[str, int]] = {}
        self._marks: dict[int, tuple[Mark, ...]] = {}

    def read(self, groups: Iterator[Mapping[str, _Cells]]) -> Recording:
        parts: dict[str, list[Any]] = {}
        names: list[str] = []
        for group in groups:
            names = names or list(group)
            for name in names:
                parts.setdefault(name, []).append(self._column(name, group[name]))
            self._rows += len(group[names[0]])
            if self._rows > _MOST_ROWS:
                raise InputError(Problem(self._file, 0, Wording("TWN320", "more_rows", most_rows=_MOST_ROWS)))
            if len(self._problems) >= _MOST_PROBLEMS:
                break
        if self._problems:
            raise InputError(self._problems[:_MOST_PROBLEMS])
        whole = {name: np.concatenate(part) for name, part in parts.items()}
        none = np.full(self._rows, NO_TIME, np.int64)
        return Recording(
            self._file,
            whole.get("source", none),
            whole.get("received", whole.get("source", none)),
            self._marks,
            {name: column for name, column in whole.items() if name not in TIMES and name not in TEXTS},
            {name: TextColumn(whole[name], tuple(self._codes[name])) for name in TEXTS if name in whole},
        )

    def _column(self, name: str, cells: _Cells) -> Any:
        if name in STAMPS:
            return self._times(name, cells)
        if name == "mark":
            self._add_marks(cells)
            return np.zeros(0)
        if name in TEXTS:
            codes = self._codes.setdefault(name, {"": 0})
            return np.array([codes.setdefault(unguarded(str(cell or "")), len(codes)) for cell in cells], np.int64)
        return self._numbers(name, cells)

    def _times(self, name: str, cells: _Cells) -> Ints:
        found = np.full(len(cells), NO_TIME, np.int64)
        for k, cell in enumerate(cells):
            try:
                if cell is not None and cell != "":
                    found[k] = cell if isinstance(cell, int) else parse_stamp(cell)
            except (ValueError, OverflowError):
                self._wrong(k, name, cell, Wording("TWN321", "no_time"))
        return found

    def _numbers(self, name: str, cells: _Cells) -> Floats:
        found = np.full(len(cells), math.nan)
        for k, cell in enumerate(cells):
            try:
                if cell is not None and cell != "":
                    found[k] = _number(cell)
            except (TypeError, ValueError):
                self._wrong(k, name, cell, Wording("TWN321", "no_number"))
                if len(self._problems) >= _MOST_PROBLEMS:
                    break
        return found

    def _add_marks(self, cells: _Cells) -> None:
        for k, cell in enumerate(cells):
            if cell:
                try:
                    self._marks[self._rows + k] = tuple(map(Mark, str(cell).split()))
                except ValueError:
                    self._wrong(k, "mark", cell, Wording("TWN321", "no_mark", mark=tuple(Mark)))

    def _wrong(self, k: int, name: str, cell: object, wording: Wording) -> None:
        self._problems.append(
            Problem(self._file, self._rows + k + 2, wording.within("of_cell", name=name, cell=repr(str(cell)[:40])))
        )


def _number(cell: object) -> float:
    """Return a number that a machine can show.

    Raises
    ------
    ValueError, TypeError
        If it is none.
    """
    if isinstance(cell, bool) or not isinstance(cell, str | int | float):
        raise TypeError
    value = float(cell)
    if not abs(value) <= _GREATEST:
        raise ValueError
    return value


def _csv_groups(path: Path) -> Iterator[dict[str, _Cells]]:
    is_whole = _ends_with_a_line(path)
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as source:
        lines = csv.reader(source)
        names = [name.strip() for name in next(lines, [])]
        if not names:
            raise InputError(Problem(str(path), 0, Wording("TWN320", "empty")))
        _check_names(path, names)
        first = True
        while group := list(islice(lines, _GROUP)):
            if len(group) < _GROUP and not is_whole:
                group.pop()  # a line that was not finished when its process was killed
            group = [line for line in group if line]
            for k, line in enumerate(group):
                if len(line) != len(names):
                    raise InputError(
                        Problem(
                            str(path),
                            lines.line_num - len(group) + k + 1,
                            Wording("TWN321", "cells_not", count=len(line), wanted=len(names)),
                        )
                    )
            if group or first:
                yield dict(zip(names, zip(*group, strict=True), strict=True)) if group else dict.fromkeys(names, ())
            first = False
        if first:
            yield dict.fromkeys(names, ())


def _check_names(path: Path, names: Sequence[str]) -> None:
    """Refuse columns that are not those of a recording."""
    wording = None
    if len({name.casefold() for name in names}) < len(names):
        wording = Wording("TWN320", "same_names")
    elif len(names) > _MOST_COLUMNS:
        wording = Wording("TWN320", "too_many", most=_MOST_COLUMNS)
    elif "source" not in names:
        wording = Wording("TWN320", "no_source")
    if wording is not None:
        raise InputError(Problem(str(path), 1, wording))


def _ends_with_a_line(path: Path) -> bool:
    with path.open("rb") as source:
        source.seek(max(path.stat().st_size - 1, 0))
        return source.read() in (b"\n", b"\r", b"")


def _parquet_groups(path: Path) -> Iterator[dict[str, _Cells]]:
    parquet, arrow = (import_extra(name, "twin") for name in ("pyarrow.parquet", "pyarrow"))
    try:
        with parquet.ParquetFile(path) as file:
            names = list(file.schema_arrow.names)
            _check_names(path, names)
            _check_kinds(path, file.schema_arrow)
            if not file.metadata.num_rows:
                yield dict.fromkeys(names, ())
            # Texts stay dictionaries: a long one that comes again and again is there once.
            texts = [field.name for field in file.schema_arrow if str(field.type) in ("string", "large_string")]
            with parquet.ParquetFile(path, read_dictionary=texts) as whole:
                for batch in whole.iter_batches(_batch_rows(path, file)):
                    yield {name: _cells(batch.column(k), arrow, path, name) for k, name in enumerate(names)}
    except arrow.ArrowException as error:
        raise InputError(Problem(str(path), 0, Wording("TWN320", "no_parquet_file", error=error))) from None


def _check_kinds(path: Path, schema: Any) -> None:
    """Refuse columns of kinds that are none of a recording's."""
    for field in schema:
        kind = str(field.type)
        if kind.startswith("dictionary<values="):
            kind = kind.removeprefix("dictionary<values=").partition(",")[0]
        is_time = kind.startswith("timestamp")
        is_text = kind in ("string", "large_string", "null")
        if field.name in STAMPS:
            good = is_time or is_text
        elif field.name in TEXTS or field.name == "mark":
            good = is_text
        else:
            good = is_text or kind in _NUMBERS
        if not good:
            raise InputError(
                Problem(
                    str(path),
                    1,
                    Wording("TWN320", "column_holds_no", field=field.name, kind=kind)
                    if field.name in STAMPS
                    else (
                        Wording("TWN320", "column_holds_no_texts", field=field.name, kind=kind)
                        if field.name in TEXTS or field.name == "mark"
                        else Wording("TWN320", "column_holds_no_numbers", field=field.name, kind=kind)
                    ),
                )
            )


def _batch_rows(path: Path, file: Any) -> int:
    """Rows that are read at a time: so many that their cells, as the file states them, take no more than is allowed."""
    metadata = file.metadata
    most = 1
    for k in range(metadata.num_row_groups):
        group = metadata.row_group(k)
        if group.total_byte_size > _MOST_BYTES:
            raise InputError(
                Problem(
                    str(path),
                    0,
                    Wording("TWN320", "row_group_bytes", total_byte_size=group.total_byte_size, most_bytes=_MOST_BYTES),
                )
            )
        most = max(most, group.num_rows)
    return min(_GROUP, most)


def _cells(column: Any, arrow: Any, path: Path, name: str) -> list[Any]:
    """Return the values of a column of a batch; times as microseconds since 1970."""
    if arrow.types.is_timestamp(column.type):
        unit = {"s": 1_000_000.0, "ms": 1000.0, "us": 1.0, "ns": 1e-3}[column.type.unit]
        found = column.cast(arrow.int64()).to_pylist()
        return [None if each is None else round(each * unit) if unit != 1e-3 else each // 1000 for each in found]
    if arrow.types.is_dictionary(column.type):
        texts = column.dictionary.to_pylist()
        _check_texts(path, name, texts)
        return [None if k is None else texts[k] for k in column.indices.to_pylist()]
    if column.nbytes > _MOST_BYTES:
        raise InputError(
            Problem(str(path), 0, Wording("TWN320", "holds_more_bytes", most_bytes=_MOST_BYTES, name=name))
        )
    cells: list[Any] = column.to_pylist()
    _check_texts(path, name, [cell for cell in cells if isinstance(cell, str)])
    return cells


def _check_texts(path: Path, name: str, texts: Sequence[str | None]) -> None:
    if any(text is not None and len(text) > LONGEST_TEXT for text in texts):
        raise InputError(
            Problem(str(path), 0, Wording("TWN320", "text_more_characters", longest_text=LONGEST_TEXT, name=name))
        )
