"""Reads CL files of any dialect, packed or not, into ``Toolpath``.

The file is read twice, in pieces: first for its encoding and the length of its lines, from which the columns are
sized; then for its content. Points never become Python objects.
"""

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from pathlib import Path
from typing import BinaryIO, Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.cl.assemble import assemble_operation
from trunnion.cl.builder import MoveColumns
from trunnion.cl.diagnostics import Diagnostics
from trunnion.cl.dialects import DIALECTS, Recognition, recognize_dialect
from trunnion.cl.interpreter import ClInterpreter
from trunnion.cl.joining import join_cuts, join_first_tool
from trunnion.cl.kept_states import report_kept_states
from trunnion.cl.open_cycles import OpenCycle, settle_open_cycles
from trunnion.cl.other_files import other_binary, other_form
from trunnion.cl.scan import MAX_STATEMENT_BYTES, SPAN_COLUMNS, TOO_LONG, UNFINISHED, Piece
from trunnion.cl.sources import ClSource, cl_sources, not_one_file
from trunnion.cl.splines import with_spline_points
from trunnion.cl.text_format import TextFormat
from trunnion.cl.unknown import unknown_statement_remarks
from trunnion.encoding import EncodingDetector
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass

#: Bytes read at a time, with what is made of them no more than the processor keeps near.
CHUNK = 1 << 20
_SURVEY_CHUNK = CHUNK
#: Bytes by which the dialect is recognized.
_HEAD = 1 << 16
#: Statements that one call of the scan writes down at most.
_MAX_SPANS = 1 << 15
#: No statement of APT that makes a row is shorter; a file with more rows has its columns grow.
_MIN_ROW_BYTES = len("GOTO/\n")
_BOM = b"\xef\xbb\xbf"


@dataclass(frozen=True, slots=True)
class Survey:
    """What the first pass finds.

    bom_bytes  length of the byte order mark
    rows       estimated number of rows
    encoding   Python's name of it
    complete   whether the last line has a line end
    head       first bytes of the file, behind the byte order mark
    """

    bom_bytes: int
    rows: int
    encoding: str
    complete: bool
    head: bytes


@dataclass(frozen=True, slots=True)
class ClReading:
    """How a CL file is read.

    units             length unit of the file, ``"mm"`` or ``"inch"``; None: as the file says
    dialect           a key of ``trunnion.cl.dialects.DIALECTS``; None: the content of the file decides
    strict            make an unknown statement an error instead of a remark
    spline_tolerance  how far the points that splines become may leave them between each other, mm; None: as INTOL and
                      OUTTOL say
    cutcom            what points under CUTCOM are where the file does not say it, ``"centreline"`` or ``"contour"``;
                      None: those of the tool's centre
    open_cycles       what becomes of a cycle that is still on where another operation begins, by the name of that
                      operation; that of all others has no name
    """

    units: str | None = None
    dialect: str | None = None
    strict: bool = False
    spline_tolerance: float | None = None
    cutcom: str | None = None
    open_cycles: Mapping[str, OpenCycle] = field(default_factory=dict)


#: As the file itself says, with remarks about what is unknown.
AS_IT_SAYS: Final = ClReading()


def read_cl(path: Path | BinaryIO, how: ClReading = AS_IT_SAYS) -> Toolpath:
    """Read a CL file, as ``read_cl_files`` does.

    Raises ``InputError`` if it cannot be used, with every problem found, or is an archive of several.
    """
    sources = cl_sources(path)
    if len(sources) > 1:
        raise not_one_file(sources[0].name, len(sources))
    return read_source(sources[0], how)


def read_cl_files(
    path: Path | BinaryIO, how: ClReading = AS_IT_SAYS, progress: Callable[[int], None] | None = None
) -> list[Toolpath]:
    """Read a CL file, or all those of an archive in the order of their names.

    path      a plain file, one packed by gzip or bzip2, a ZIP archive, or a binary stream
    progress  called from time to time with the number of bytes read

    list of Toolpath  all lengths in mm, in the frame of each operation

    Raises ``InputError`` if a file cannot be used, with every problem found.
    """
    return [read_source(source, how, progress=progress) for source in cl_sources(path)]


def read_source(
    source: ClSource,
    how: ClReading = AS_IT_SAYS,
    *,
    chunk: int = CHUNK,
    progress: Callable[[int], None] | None = None,
) -> Toolpath:
    """Read one CL file, ``chunk`` bytes at a time; the result does not depend on ``chunk``."""
    units, dialect = how.units, how.dialect
    diagnostics = Diagnostics(source.name)
    try:
        survey = _survey(source, diagnostics)
        if dialect is None:
            recognized = recognize_dialect(survey.head)
        else:
            recognized = Recognition(DIALECTS[dialect], phrase("recognized_as_asked"))
        columns = MoveColumns.allocate(survey.rows)
        interpreter = ClInterpreter(columns, diagnostics, recognized.dialect, survey.encoding, strict=how.strict)
        interpreter.take_points_for(how.cutcom)
        scanner = _Scanner(recognized.dialect.text, columns, interpreter, diagnostics)
        with source.open() as file:
            file.read(survey.bom_bytes)
            scanner.read(file, chunk, survey.bom_bytes, progress)
    except OSError as error:
        raise diagnostics.fatal(0, Wording("FIL120", "file_unreadable", strerror=error.strerror or error)) from error
    interpreter.finish(scanner.rows, survey.complete, scanner.line - 1)
    unit = interpreter.unit(units)
    if unit != 1.0:
        columns.tip[: scanner.rows] *= unit
    builders = join_first_tool(interpreter.builders, diagnostics)
    settle_open_cycles(builders, how.open_cycles, diagnostics)
    report_kept_states(builders, diagnostics)
    builders = join_cuts(builders, diagnostics, in_sections=recognized.dialect.in_sections)
    columns = with_spline_points(builders, columns, scanner.rows, unit, how.spline_tolerance, diagnostics)
    modal_axis = np.array([0.0, 0.0, 1.0])
    operations = tuple(assemble_operation(builder, columns, unit, modal_axis, diagnostics) for builder in builders)
    diagnostics.raise_errors()
    toolpath = Toolpath(
        source.name, operations, interpreter.part, unit=unit, states_unit=interpreter.knows_unit(units),
        dialect=recognized.dialect.name,
        recognized_by=phrase("recognized_by", title=recognized.dialect.title, why=recognized.why),
        states_system=interpreter.states_system,
        clamping=interpreter.clamping(),
        stock=interpreter.stock(unit),
        reopen=source.open if source.packed else None,
        system=tuple(number * (unit if k % 4 == 3 else 1.0) for k, number in enumerate(interpreter.system)),
    )  # fmt: skip
    for problem in unknown_statement_remarks(toolpath):
        diagnostics.remark(problem.line, problem.wording)
    return replace(toolpath, remarks=(*source.remarks, *diagnostics.remarks))


def _survey(source: ClSource, diagnostics: Diagnostics) -> Survey:
    """Read the whole file once, and refuse what is no text."""
    with source.open() as file:
        return _surveyed(file, source, diagnostics)


def _surveyed(file: BinaryIO, source: ClSource, diagnostics: Diagnostics) -> Survey:
    detector = EncodingDetector()
    bom_bytes = size = 0
    per_byte = 1.0
    complete = lines = False
    head = b""
    while piece := file.read(_SURVEY_CHUNK):
        if size == 0:
            if piece.startswith((b"\xff\xfe", b"\xfe\xff")):
                raise diagnostics.fatal(1, Wording("CL150", "unknown_encoding_utf"))
            bom_bytes = len(_BOM) if piece.startswith(_BOM) else 0
            per_byte = (piece.count(b"\n") + 1) / len(piece)
            head = piece[bom_bytes:_HEAD]
            if form := other_form(head):
                raise diagnostics.fatal(0, form)
        if (nul := piece.find(0)) >= 0:
            if size == 0 and (binary := other_binary(source.name, piece)):
                raise diagnostics.fatal(0, binary)
            line = _line_at(source, size + nul)
            raise diagnostics.fatal(line, Wording("CL150", "unknown_encoding_nul"))
        detector.add(piece)
        size += len(piece)
        complete = piece.endswith(b"\n")
        lines = lines or b"\n" in piece
        if not lines and b"\r" in piece.rstrip():
            raise diagnostics.fatal(1, Wording("CL150", "lines_end_lone"))
    if size == bom_bytes:
        raise diagnostics.fatal(0, Wording("CL140", "file_empty"))
    rows = min(1.02 * per_byte * size, size / _MIN_ROW_BYTES)
    return Survey(bom_bytes, int(rows) + 16, detector.encoding(), complete, head)


def _line_at(source: ClSource, offset: int) -> int:
    """Return the line, from 1, that a byte of the file belongs to."""
    line, left = 1, offset
    with source.open() as file:
        while left and (piece := file.read(min(left, _SURVEY_CHUNK))):
            line += piece.count(b"\n")
            left -= len(piece)
    return line


class _Scanner:
    """Reads a file to its end: points into the columns, all other statements to the interpreter.

    rows   rows written so far
    line   line that comes next
    """

    def __init__(
        self, text: TextFormat, columns: MoveColumns, interpreter: ClInterpreter, diagnostics: Diagnostics
    ) -> None:
        self.rows = 0
        self.line = 1
        self._columns = columns
        self._interpreter = interpreter
        self._diagnostics = diagnostics
        self._text = text
        self._spans = np.empty((_MAX_SPANS, SPAN_COLUMNS), np.int64)

    def read(self, file: BinaryIO, chunk: int, done: int, progress: Callable[[int], None] | None) -> None:
        """Read the rest of a file, of which ``done`` bytes are read.

        An unfinished statement at the end of a piece is carried over to the next piece. It is never longer than
        ``MAX_STATEMENT_BYTES``, which bounds the buffer.
        """
        data = bytearray(MAX_STATEMENT_BYTES + chunk + 2)
        view = memoryview(data)
        filled = 0
        last = False
        while not last:
            count = file.readinto(view[filled : filled + chunk]) or 0  # type: ignore[attr-defined]
            last = count == 0
            done += count
            filled += count
            if last and filled and data[filled - 1] != ord("\n"):
                data[filled] = ord("\n")
                filled += 1
            at = self._scan_lines(data, data.rfind(b"\n", 0, filled) + 1, last)
            if filled - at > MAX_STATEMENT_BYTES:
                raise self._too_long(self.line)
            data[: filled - at] = view[at:filled]
            filled -= at
            if progress:
                progress(done)

    def _scan_lines(self, data: bytearray, stop: int, last: bool) -> int:
        """Read the whole lines before ``stop``; return where an unfinished statement begins, else ``stop``."""
        array = np.frombuffer(data, np.uint8)
        at = 0
        while at < stop:
            before = at
            piece = Piece(array, at, stop, self.line, last)
            at, self.line, self.rows, count = self._text.scan(piece, self.rows, self._columns.points(), self._spans)
            self._interpret(data, self._spans[:count])
            if self.rows == len(self._columns.line):
                self._columns.grow()
            elif at == before:
                break
        return at

    def _interpret(self, data: bytearray, spans: Ints) -> None:
        for begin, length, line, row, mark in zip(*spans.T.tolist(), strict=True):
            if mark & TOO_LONG:
                raise self._too_long(line)
            if mark & UNFINISHED:
                self._diagnostics.error(line, Wording("CL130", "ends_within", unfinished=self._text.unfinished))
            self._interpreter.interpret(bytes(data[begin : begin + length]), line, row, mark)

    def _too_long(self, line: int) -> Exception:
        return self._diagnostics.fatal(
            line, Wording("CL160", "statement_longer_bytes", max_statement_bytes=MAX_STATEMENT_BYTES)
        )
