"""Files of recordings: CSV, to which rows are added as they come, and Parquet, which is made of it in the end.

A recording that is Parquet is written as CSV beside it until it has ended; a process that is killed leaves that.
Times are ISO 8601 in UTC, numbers have all their digits, what is not known is empty.
"""

import contextlib
import csv
import io
import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Final

from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.files import OutputPlace, atomic_file
from trunnion.messages import Wording
from trunnion.twin.recording.nodes import TIMES
from trunnion.twin.recording.rows import Row, Value
from trunnion.wording import one_line

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)

#: Characters of a text at most; blocks and names of programs are far shorter.
LONGEST_TEXT: Final = 32_000

#: What a spreadsheet takes for the beginning of a formula.
_FORMULAS: Final = ("=", "+", "-", "@")

#: Rows of a piece of a Parquet file.
_GROUP: Final = 65_536


def journal_of(path: Path) -> Path:
    """Return the file that a recording is written to while it goes on."""
    return path if path.suffix.lower() == ".csv" else path.with_name(path.name + ".csv")


def check_is_new(place: OutputPlace) -> None:
    """Refuse a place where a recording, or the beginning of one, is: it cannot be made again.

    Raises
    ------
    InputError
        If something is there.
    """
    if place.is_stream:
        raise InputError(Problem(place.name, 0, Wording("TWN310", "no_file_recording")))
    for path in dict.fromkeys((place.path, journal_of(place.path))):
        if path.exists():
            raise InputError(
                Problem(
                    str(path),
                    0,
                    Wording(
                        "TWN310", "exists_recording_never" if path == place.path else "exists_recording_never_written"
                    ),
                )
            )


class RecordingWriter:
    """Adds rows to a recording; everything that has been added is in the file, also if the process is killed then.

    place         the file: ``.csv`` or ``.parquet``
    names, texts  its columns, and which of them hold texts

    Raises ``InputError`` if it cannot be written.
    """

    def __init__(self, place: OutputPlace, names: Sequence[str], texts: frozenset[str]) -> None:
        self._place, self._names, self._texts = place, names, texts
        self._journal = journal_of(place.path)
        self.rows = 0
        try:
            self._sink = io.TextIOWrapper(self._journal.open("xb"), encoding="utf-8", newline="", write_through=False)
        except OSError as error:
            raise self._failed(error) from None
        self._writer = csv.writer(self._sink, lineterminator="\n")
        self._writer.writerow(_all(names))
        self._sink.flush()

    def add(self, rows: Iterable[Row]) -> None:
        """Add rows.

        Raises
        ------
        InputError
            If the disk takes no more.
        """
        before = self.rows
        try:
            for row in rows:
                times = (_stamp(row.source), _stamp(row.server), _stamp(row.received), " ".join(row.marks))
                self._writer.writerow([*times, *map(_cell, row.values)])
                self.rows += 1
            if self.rows > before:
                self._sink.flush()
        except OSError as error:
            raise self._failed(error) from None

    def close(self) -> None:
        """End the recording; a Parquet file appears, and the CSV file beside it goes.

        Raises
        ------
        InputError
            If it cannot be written; the CSV file stays then.
        """
        try:
            self._sink.flush()
            with contextlib.suppress(OSError):
                os.fsync(self._sink.fileno())
            self._sink.close()
        except OSError as error:
            raise self._failed(error) from None
        if self._journal != self._place.path:
            self._convert()
            self._journal.unlink()

    def _convert(self) -> None:
        arrow, parquet = (import_extra(name, "twin") for name in ("pyarrow", "pyarrow.parquet"))
        time, number, text = arrow.timestamp("us", tz="UTC"), arrow.float64(), arrow.string()
        kinds: list[tuple[Any, Callable[[str], Any]]] = [(time, parse_stamp)] * 3 + [(text, str)]
        kinds += [(text, unguarded) if name in self._texts else (number, float) for name in self._names]
        schema = arrow.schema([(name, kind) for name, (kind, _) in zip(_all(self._names), kinds, strict=True)])
        with (
            self._journal.open(encoding="utf-8", newline="") as journal,
            atomic_file(self._place) as sink,
            parquet.ParquetWriter(sink, schema) as writer,
        ):
            lines = csv.reader(journal)
            next(lines)
            for group in _groups(lines):
                columns = zip(*group, strict=True)
                made = [
                    arrow.array([parse(cell) if cell else None for cell in column], kind)
                    for (kind, parse), column in zip(kinds, columns, strict=True)
                ]
                writer.write_table(arrow.table(made, schema=schema))

    def _failed(self, error: OSError) -> InputError:
        return InputError(
            Problem(str(self._journal), 0, Wording("TWN311", "cannot_written", strerror=error.strerror or error))
        )


def _groups(lines: Iterator[list[str]]) -> Iterator[list[list[str]]]:
    group: list[list[str]] = []
    for line in lines:
        group.append(line)
        if len(group) == _GROUP:
            yield group
            group = []
    if group:
        yield group


def parse_stamp(text: str) -> int:
    """Return the time of a text, microseconds since 1970.

    Raises
    ------
    ValueError
        If it is none.
    """
    stamp = datetime.fromisoformat(text)
    since = (stamp if stamp.tzinfo is not None else stamp.replace(tzinfo=UTC)) - _EPOCH
    return (since.days * 86_400 + since.seconds) * 1_000_000 + since.microseconds


def _all(names: Sequence[str]) -> list[str]:
    return [*TIMES, *names]


def _stamp(microseconds: int | None) -> str:
    """Return a time as text; empty for none."""
    if microseconds is None:
        return ""
    return (_EPOCH + timedelta(microseconds=microseconds)).replace(tzinfo=None).isoformat(timespec="microseconds") + "Z"


def unguarded(text: str) -> str:
    """Return a text as the machine told it: without the apostrophe that keeps a spreadsheet from running it."""
    return text[1:] if text.startswith("'") and text[1:].startswith(_FORMULAS) else text


def _cell(value: Value) -> str:
    """Return a cell; a text as it is but for its length, and for what a spreadsheet would take for a formula."""
    if value is None:
        return ""
    if isinstance(value, str):
        text = one_line(value[:LONGEST_TEXT])[:LONGEST_TEXT]
        return f"'{text}" if text.startswith(_FORMULAS) else text
    return repr(value) if math.isfinite(value) else ""
