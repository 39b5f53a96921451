"""Reads an NX CLSF into a ``Toolpath``.

The file goes by twice, a piece at a time: once to see what it is written in and how long its lines are, which sizes the
columns; once to be read. Points never become Python objects.
"""

import stat
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from trunnion.cl.assemble import assemble_operation
from trunnion.cl.builder import MoveColumns
from trunnion.cl.diagnostics import Diagnostics
from trunnion.cl.encoding import EncodingDetector
from trunnion.cl.nx import ClsfInterpreter
from trunnion.cl.scan import MAX_STATEMENT_BYTES, SPAN_COLUMNS, TOO_LONG, UNFINISHED, scan
from trunnion.model.toolpath import Toolpath

#: Bytes read at a time.
CHUNK = 4 << 20
#: Statements that one walk of the scan writes down before it hands over.
_MAX_SPANS = 1 << 15
_SURVEY_CHUNK = CHUNK
#: No statement that makes a row is shorter.
_MIN_ROW_BYTES = len("GOTO/\n")
_BOM = b"\xef\xbb\xbf"

_PLAIN_TEXT = "save the file as plain text (ASCII, UTF-8, GBK or Latin-1)"


@dataclass(frozen=True, slots=True)
class Survey:
    """What the first pass found: bytes to skip, about how many rows, encoding, whether the last line ends."""

    bom_bytes: int
    rows: int
    encoding: str
    complete: bool


def read_cl(
    path: Path,
    *,
    units: str | None = None,
    strict: bool = False,
    progress: Callable[[int], None] | None = None,
) -> Toolpath:
    """Read an NX CLSF.

    Parameters
    ----------
    path
        The file.
    units
        Length unit of the file, ``"mm"`` or ``"inch"``; without it the file decides.
    strict
        Make a statement that is not known an error instead of a remark.
    progress
        Is told from time to time how many bytes are done.

    Returns
    -------
    Toolpath
        All lengths in mm, in the frame of each operation.

    Raises
    ------
    InputError
        With every problem found, if the file cannot be used.
    """
    return read_in_chunks(path, CHUNK, units=units, strict=strict, progress=progress)


def read_in_chunks(
    path: Path,
    chunk: int,
    *,
    units: str | None = None,
    strict: bool = False,
    progress: Callable[[int], None] | None = None,
) -> Toolpath:
    """Do what ``read_cl`` says, ``chunk`` bytes at a time; the result does not depend on ``chunk``."""
    diagnostics = Diagnostics(str(path))
    if units is not None and units.lower() not in ("mm", "inch"):
        raise diagnostics.fatal(0, f"units are {units!r}", "units are mm or inch")
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            what = "is a folder" if path.is_dir() else "is not a regular file"
            raise diagnostics.fatal(0, what, "give a CL file")
        with path.open("rb", buffering=0) as file:
            survey = _survey(file, diagnostics)
            columns = MoveColumns.allocate(survey.rows)
            interpreter = ClsfInterpreter(columns, diagnostics, survey.encoding, strict)
            file.seek(survey.bom_bytes)
            rows, line = _scan_file(file, survey, chunk, columns, interpreter, diagnostics, progress)
    except OSError as error:
        what = f"cannot be read: {error.strerror or error}"
        raise diagnostics.fatal(0, what, "give the name of a file that you may read") from error
    except ValueError as error:  # a NUL in the name
        raise diagnostics.fatal(0, f"cannot be read: {error}", "give the name of a CL file") from error
    interpreter.finish(rows, survey.complete, line)
    unit = interpreter.unit(units)
    if unit != 1.0:
        columns.tip[:rows] *= unit
    operations = tuple(assemble_operation(builder, columns, unit, diagnostics) for builder in interpreter.builders)
    diagnostics.raise_errors()
    return Toolpath(str(path), operations, interpreter.part, diagnostics.remarks, unit)


def _survey(file: BinaryIO, diagnostics: Diagnostics) -> Survey:
    """Look through the whole file, and refuse what is no text."""
    detector = EncodingDetector()
    bom_bytes = size = 0
    per_byte = 1.0
    complete = lines = False
    while piece := file.read(_SURVEY_CHUNK):
        if size == 0:
            if piece.startswith((b"\xff\xfe", b"\xfe\xff")):
                raise diagnostics.fatal(1, "unknown encoding: this is UTF-16", _PLAIN_TEXT)
            bom_bytes = len(_BOM) if piece.startswith(_BOM) else 0
            per_byte = (piece.count(b"\n") + 1) / len(piece)
        if (nul := piece.find(0)) >= 0:
            line = _line_at(file, size + nul)
            raise diagnostics.fatal(line, "unknown encoding: there is a NUL byte in the line", _PLAIN_TEXT)
        detector.add(piece)
        size += len(piece)
        complete = piece.endswith(b"\n")
        lines = lines or b"\n" in piece
        if not lines and b"\r" in piece.rstrip():
            raise diagnostics.fatal(
                1, "the lines end with a lone carriage return", "save the file with LF or CRLF line ends"
            )
    if size == bom_bytes:
        raise diagnostics.fatal(0, "the file is empty", "write the tool path out of the CAM system again")
    rows = min(1.02 * per_byte * size, size / _MIN_ROW_BYTES)
    return Survey(bom_bytes, int(rows) + 16, detector.encoding(), complete)


def _line_at(file: BinaryIO, offset: int) -> int:
    """Line, from 1, in which a byte of the file lies."""
    file.seek(0)
    line, left = 1, offset
    while left and (piece := file.read(min(left, _SURVEY_CHUNK))):
        line += piece.count(b"\n")
        left -= len(piece)
    return line


def _scan_file(
    file: BinaryIO,
    survey: Survey,
    chunk: int,
    columns: MoveColumns,
    interpreter: ClsfInterpreter,
    diagnostics: Diagnostics,
    progress: Callable[[int], None] | None,
) -> tuple[int, int]:
    """Read the file to its end; return the number of rows and of the last line.

    What is not yet a whole statement at the end of a piece is carried over to the next. It is never longer than
    ``MAX_STATEMENT_BYTES``, and that bounds the buffer.
    """
    data = bytearray(MAX_STATEMENT_BYTES + chunk + 2)
    view = memoryview(data)
    array = np.frombuffer(data, np.uint8)
    spans = np.empty((_MAX_SPANS, SPAN_COLUMNS), np.int64)
    filled = rows = 0
    line = 1
    done = survey.bom_bytes
    last = False
    while not last:
        got = file.readinto(view[filled : filled + chunk]) or 0  # type: ignore[attr-defined]
        last = got == 0
        done += got
        filled += got
        if last and filled and data[filled - 1] != ord("\n"):
            data[filled] = ord("\n")
            filled += 1
        stop = data.rfind(b"\n", 0, filled) + 1
        at = 0
        while at < stop:
            before = at
            at, line, rows, count = scan(
                array, at, stop, last, line, rows, columns.tip, columns.axis, columns.line, spans
            )
            for begin, length, number, row, mark in zip(*spans[:count].T.tolist(), strict=True):
                if mark & TOO_LONG:
                    raise _too_long(number, diagnostics)
                if mark & UNFINISHED:
                    diagnostics.error(number, "the file ends after a continuation sign $", "write the rest of it")
                interpreter.interpret(bytes(view[begin : begin + length]), number, row, mark)
            if rows == len(columns.line):
                columns.grow()
            elif at == before:
                break
        if filled - at > MAX_STATEMENT_BYTES:
            raise _too_long(line, diagnostics)
        data[: filled - at] = view[at:filled]
        filled -= at
        if progress:
            progress(done)
    return rows, line - 1


def _too_long(line: int, diagnostics: Diagnostics) -> Exception:
    what = f"a statement longer than {MAX_STATEMENT_BYTES} bytes"
    return diagnostics.fatal(line, what, "no CL statement is that long: look whether line ends are missing")
