"""The summary of a batch as a table, a row for each file: SQLite or Parquet.

Rows come in the order of files and jobs, so that the same results give the same table however they were reached. What
the work cost differs from run to run: it stands in a table of its own (``costs``), in Parquet in a file of its own.
"""

import json
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from itertools import islice
from pathlib import Path
from typing import Any, Final

from trunnion.batch.records import Record
from trunnion.batch.running import BatchResult
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.files import OutputPlace, output_group, resolve_output
from trunnion.jobs.result_output import declared_output
from trunnion.messages import Wording

#: Column -> type in SQLite. Of a file one row each; values are NULL where there is none.
COLUMNS: Final = {
    "file": "TEXT", "job": "TEXT", "action": "TEXT", "place": "TEXT", "status": "TEXT",
    "code": "TEXT", "told_file": "TEXT", "line": "INTEGER", "message": "TEXT", "warnings": "INTEGER",
    "warning_codes": "TEXT",
    "blocks": "INTEGER", "points": "INTEGER", "motions": "INTEGER", "seconds": "REAL", "tools": "TEXT",
    "axes": "TEXT", "margin_mm": "REAL", "margin_deg": "REAL",
    "tip_deviation_mm": "REAL", "axis_deviation_deg": "REAL",
    "failed_checks": "TEXT", "removed_mm3": "REAL", "findings": "INTEGER", "gouge_mm": "REAL",
    "outputs": "TEXT", "bytes": "INTEGER", "sha256": "TEXT", "key": "TEXT",
}  # fmt: skip

#: The same of what the work cost.
COSTS: Final = {"file": "TEXT", "job": "TEXT", "place": "TEXT", "processor_s": "REAL", "wall_s": "REAL"}

#: Rows that are written at once.
_ROWS: Final = 1000

#: By these a summary is known: SQLite's ``application_id``, and a key of Parquet's metadata.
_APPLICATION: Final = int.from_bytes(b"TrBa")
_MARK: Final = b"trunnion.batch"


def check_summary(file: object) -> OutputPlace:
    """Return the place of a summary, before any work.

    Raises ``InputError`` if its name ends otherwise, it cannot be written, a file stands there that is no summary, or
    the package that writes it is not installed.
    """
    place = declared_output("batch", "summary", file)
    if place.path.suffix.lower() == ".parquet":
        import_extra("pyarrow", "twin")
        _refuse_other(place.path, _is_parquet)
        _refuse_other(_costs_path(place.path), _is_parquet)
    else:
        _refuse_other(place.path, _is_database)
    return place


def _refuse_other(path: Path, is_own: Callable[[Path], bool]) -> None:
    """Refuse to replace what is no summary; an empty file is nobody's loss."""
    if path.exists() and path.stat().st_size and not is_own(path):
        raise InputError(Problem(str(path), 0, Wording("FIL250", "already_no_summary")))


def _is_database(path: Path) -> bool:
    """Whether a file is a summary, with nothing in it that somebody else has added."""
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)) as database:
            (mark,) = database.execute("PRAGMA application_id").fetchone()
            names = {name for (name,) in database.execute("SELECT name FROM sqlite_master")}
    except sqlite3.Error:
        return False
    return mark == _APPLICATION and names == {"files", "costs"}


def _is_parquet(path: Path) -> bool:
    pyarrow, parquet = import_extra("pyarrow", "twin"), import_extra("pyarrow.parquet", "twin")
    try:
        return _MARK in (parquet.read_schema(path).metadata or {})
    except (OSError, pyarrow.ArrowException):
        return False


def _costs_path(path: Path) -> Path:
    return path.with_suffix(".costs.parquet")


def write_summary(result: BatchResult, file: object) -> None:
    """Write the summary of a batch; it appears whole.

    Raises ``InputError`` as ``check_summary``.
    """
    place = check_summary(file)
    if place.path.suffix.lower() == ".parquet":
        costs = resolve_output(_costs_path(place.path))
        with output_group(remembers=False) as group:
            with group.open(place) as files:
                _write_parquet(_rows(result), COLUMNS, files.path)
            with group.open(costs) as files:
                _write_parquet(_costs(result), COSTS, files.path)
        return
    with output_group(remembers=False) as group, group.open(place) as files:
        _write_sqlite(result, files.path)


def _write_sqlite(result: BatchResult, path: Path) -> None:
    with closing(sqlite3.connect(path)) as database:
        database.execute("PRAGMA journal_mode = OFF")  # it appears whole, or not at all
        database.execute(f"PRAGMA application_id = {_APPLICATION}")
        for table, columns, rows in (("files", COLUMNS, _rows(result)), ("costs", COSTS, _costs(result))):
            database.execute(f"CREATE TABLE {table} ({', '.join(f'{name} {kind}' for name, kind in columns.items())})")
            marks = ", ".join("?" * len(columns))
            database.executemany(f"INSERT INTO {table} VALUES ({marks})", rows)
        database.commit()


def _write_parquet(rows: Iterator[tuple[Any, ...]], columns: dict[str, str], path: Path) -> None:
    pyarrow, parquet = import_extra("pyarrow", "twin"), import_extra("pyarrow.parquet", "twin")
    kinds = {"TEXT": pyarrow.string(), "INTEGER": pyarrow.int64(), "REAL": pyarrow.float64()}
    schema = pyarrow.schema([(name, kinds[kind]) for name, kind in columns.items()], {_MARK: b"1"})
    with path.open("wb") as stream, parquet.ParquetWriter(stream, schema) as writer:
        while some := list(islice(rows, _ROWS)):
            arrays = [
                pyarrow.array(column, kinds[kind])
                for column, kind in zip(zip(*some, strict=True), columns.values(), strict=True)
            ]
            writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))


def _rows(result: BatchResult) -> Iterator[tuple[Any, ...]]:
    return (tuple(_values(record)[name] for name in COLUMNS) for record in _by_file(result))


def _costs(result: BatchResult) -> Iterator[tuple[Any, ...]]:
    for record in _by_file(result):
        yield *map(_text, (record.file, record.job, record.place)), record.costs.processor_s, record.costs.seconds


def _by_file(result: BatchResult) -> Iterable[Record]:
    units = sorted(result.units, key=lambda unit: (unit.file, unit.job))
    return BatchResult(units, result.store, result.counts, result.done, ()).records()


def _values(record: Record) -> dict[str, Any]:
    """Return a record by the names of columns."""
    name = record.place.rpartition("/")[2]
    main = next((each for output, each in record.outputs.items() if output.rpartition("/")[2] == name), None)
    found: dict[str, Any] = dict.fromkeys(COLUMNS)
    found |= {key: _plain(value) for key, value in record.figures.items() if key in COLUMNS}
    found |= _error(record.error)
    found |= {
        "file": record.file, "job": record.job, "action": record.action, "place": record.place,
        "status": str(record.status), "warnings": record.warnings, "key": record.key,
        "outputs": _plain(sorted(record.outputs)),
        "bytes": sum(each.bytes for each in record.outputs.values()) if record.outputs else None,
        "sha256": None if main is None else main.sha256,
    }  # fmt: skip
    return {key: _text(value) if isinstance(value, str) else value for key, value in found.items()}


def _error(error: Problem | None) -> dict[str, Any]:
    """Return the first error by the names of columns."""
    if error is None:
        return {}
    message = f"{error.what}; {error.cure}".removesuffix("; ")
    return {"code": error.code, "told_file": error.file, "line": error.line, "message": message}


def _plain(value: object) -> object:
    """Return a list or a table as JSON; anything else as it is."""
    if isinstance(value, Sequence) and not isinstance(value, str):
        return json.dumps(list(value), ensure_ascii=False)
    return json.dumps(value, ensure_ascii=False, sort_keys=True) if isinstance(value, dict) else value


def _text(text: str) -> str:
    """Return a text that every database takes, whatever is in a name."""
    return text.encode("utf-8", "backslashreplace").decode()
