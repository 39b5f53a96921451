"""Reads a recording: CSV or Parquet, of ``trunnion record`` or with the same columns.

In:     a file. It may be of any origin.
Out:    a ``Recording``, or an ``InputError`` with the mistakes.
"""

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.extras import import_extra
from trunnion.model.recording import NO_TIME, Mark, Recording, TextColumn
from trunnion.twin.recording.files import parse_stamp
from trunnion.twin.recording.nodes import TEXTS, TIMES

#: Rows and columns of a recording at most, and mistakes that are told.
_MOST_ROWS: Final = 10_000_000
_MOST_COLUMNS: Final = 300
_MOST_PROBLEMS: Final = 20

#: Rows that are read at a time.
_GROUP: Final = 65_536

_Cells = Sequence[Any]


def read_recording(path: Path) -> Recording:
    """Read a recording.

    Raises
    ------
    InputError
        If the file cannot be used, or with its mistakes.
    """
    if problem := unusable_file(path, "a recording"):
        raise InputError(problem)
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".parquet"):
        raise InputError(
            Problem(str(path), 0, "is no recording", "give one that ends in .csv or .parquet", code="TWN320")
        )
    try:
        return _Reader(str(path)).read(_csv_groups(path) if suffix == ".csv" else _parquet_groups(path))
    except (OSError, csv.Error) as error:
        raise InputError(
            Problem(str(path), 0, f"cannot be read: {error}", "give a recording of trunnion", code="TWN320")
        ) from None


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
                raise InputError(
                    Problem(self._file, 0, f"has more than {_MOST_ROWS} rows", "record it in parts", code="TWN320")
                )
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
        if name in ("source", "server", "received"):
            return self._times(name, cells)
        if name == "mark":
            self._add_marks(cells)
            return np.zeros(0)
        if name in TEXTS:
            codes = self._codes.setdefault(name, {"": 0})
            return np.array([codes.setdefault(str(cell or ""), len(codes)) for cell in cells], np.int64)
        return self._numbers(name, cells)

    def _times(self, name: str, cells: _Cells) -> Ints:
        found = np.full(len(cells), NO_TIME, np.int64)
        for k, cell in enumerate(cells):
            try:
                if cell is not None and cell != "":
                    found[k] = parse_stamp(cell.isoformat() if isinstance(cell, datetime) else cell)
            except (ValueError, OverflowError):
                self._wrong(k, name, cell, "is no time", "write it as 2026-05-04T08:30:00.020000Z")
        return found

    def _numbers(self, name: str, cells: _Cells) -> Floats:
        found = np.full(len(cells), math.nan)
        for k, cell in enumerate(cells):
            try:
                if cell is not None and cell != "":
                    found[k] = float(cell)
            except (TypeError, ValueError):
                self._wrong(k, name, cell, "is no number", "leave it empty where it is not known")
                if len(self._problems) >= _MOST_PROBLEMS:
                    break
        found[~np.isfinite(found)] = math.nan
        return found

    def _add_marks(self, cells: _Cells) -> None:
        for k, cell in enumerate(cells):
            if cell:
                try:
                    self._marks[self._rows + k] = tuple(map(Mark, str(cell).split()))
                except ValueError:
                    self._wrong(k, "mark", cell, "is no mark", f"known are {', '.join(Mark)}")

    def _wrong(self, k: int, name: str, cell: object, what: str, cure: str) -> None:
        self._problems.append(
            Problem(self._file, self._rows + k + 2, f"{name} {what}: {str(cell)[:40]!r}", cure, code="TWN321")
        )


def _csv_groups(path: Path) -> Iterator[dict[str, _Cells]]:
    is_whole = _ends_with_a_line(path)
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as source:
        lines = csv.reader(source)
        names = [name.strip() for name in next(lines, [])]
        if not names:
            raise InputError(Problem(str(path), 0, "is empty", "give a recording", code="TWN320"))
        _check_names(path, names)
        first = True
        while group := list(islice(lines, _GROUP)):
            if len(group) < _GROUP and not is_whole:
                group.pop()  # a line that was not finished when its process was killed
            for k, line in enumerate(group):
                if len(line) != len(names):
                    what, cure = f"has {len(line)} cells, not {len(names)}", "write one for each column"
                    raise InputError(Problem(str(path), lines.line_num - len(group) + k + 1, what, cure, code="TWN321"))
            if group or first:
                yield dict(zip(names, zip(*group, strict=True), strict=True)) if group else dict.fromkeys(names, ())
            first = False
        if first:
            yield dict.fromkeys(names, ())


def _check_names(path: Path, names: Sequence[str]) -> None:
    """Refuse columns that are not those of a recording."""
    what = ""
    if len(set(names)) < len(names):
        what = "has columns of the same name"
    elif len(names) > _MOST_COLUMNS:
        what = f"has more than {_MOST_COLUMNS} columns"
    elif "source" not in names:
        what = "has no column source"
    if what:
        cure = "the columns of a recording are source, received, mark, X, Y, …"
        raise InputError(Problem(str(path), 1, what, cure, code="TWN320"))


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
            if not file.metadata.num_rows:
                yield dict.fromkeys(names, ())
            for batch in file.iter_batches(_GROUP):
                yield {name: batch.column(k).to_pylist() for k, name in enumerate(names)}
    except arrow.ArrowException as error:
        raise InputError(
            Problem(str(path), 0, f"is no Parquet file: {error}", "give a recording", code="TWN320")
        ) from None
