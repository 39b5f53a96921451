"""CL text that is not APT enters as a scan, a parse and a dialect: shown by a small format of pairs of lines.

The first line of a pair is the code of a record, the second has its numbers. Nothing but this module knows the format.
"""

import io
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from tests.support.apt_heads import HEADS
from trunnion.arrays import Ints2
from trunnion.cl import is_cl_file, read_cl, shop_statement, unknown_statements
from trunnion.cl.conventions import CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.dialects import DIALECTS, recognize_dialect
from trunnion.cl.read import ClReading, read_source
from trunnion.cl.scan import MAKES_ROW, UNFINISHED, Piece, PointColumns
from trunnion.cl.sources import cl_sources
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import apt_tools, events, motion, operations
from trunnion.cl.text_format import TextFormat
from trunnion.cl.word_events import can_be_unknown
from trunnion.cli import main
from trunnion.errors import InputError, Problem
from trunnion.messages import foreign
from trunnion.model.toolpath import Event, Toolpath


def scan_pairs(piece: Piece, row: int, columns: PointColumns, spans: Ints2) -> tuple[int, int, int, int]:
    data, at, stop, line, last = piece
    text, count = data[:stop].tobytes(), 0
    while at < stop and count < len(spans) and row < len(columns.line):
        middle = text.index(b"\n", at) + 1
        end, mark = text.find(b"\n", middle) + 1, 0
        if not end:
            if not last:
                break
            end, mark = middle, UNFINISHED
        if text[at:middle].strip() in (b"0", b"11"):
            mark |= MAKES_ROW
            columns.tip[row] = columns.axis[row] = np.nan
            columns.line[row] = line
        spans[count] = at, end - at, line, row, mark
        count, row = count + 1, row + (mark & MAKES_ROW)
        at, line = end, line + 2
    return at, line, row, count


def parse_pair(raw: bytes, encoding: str) -> Statement:
    code, _, rest = raw.decode(encoding, "replace").partition("\n")
    major, given = code.strip(), rest.split()
    if not major.isdigit():
        what = f"{major[:20]!r} stands where the code of a record belongs"
        raise StatementError(foreign(what, "write pairs of lines: a code, and its numbers", "CL160"))
    try:
        values = tuple(map(float, given))
    except ValueError:
        what = f"record {major} has {rest.strip()[:20]!r} where numbers belong"
        raise StatementError(foreign(what, "write decimal numbers between blanks", "CL310")) from None
    return Statement(major, values, "", f"{major}/{','.join(given)}")


@dataclass(slots=True)
class _Feed:
    """The feed of the line before."""

    value: float = 0.0


def _header(state: ReaderState, statement: Statement) -> None:
    operations.units(state, statement._replace(major="UNITS", values=("INCH" if statement.values[0] else "MM",)))


def _tool(state: ReaderState, statement: Statement) -> None:
    number, diameter, corner, speed = statement.numbers(4)
    apt_tools.cutter(state, statement._replace(major="CUTTER", values=(diameter, corner)))
    apt_tools.loadtl(state, statement._replace(major="LOADTL", values=(number,)))
    events.spindl(state, statement._replace(major="SPINDL", values=(speed, "RPM", "CLW")))


def _rapid(state: ReaderState, statement: Statement) -> None:
    motion.rapid(state, statement._replace(values=()))
    motion.write_row(state, statement.numbers(6))


def _line(state: ReaderState, statement: Statement) -> None:
    *point, value = statement.numbers(7)
    feed = state.own(_Feed)
    if value != feed.value:
        events.fedrat(state, statement._replace(major="FEDRAT", values=(value, "PERMIN")))
        feed.value = value
    motion.write_row(state, tuple(point))


PAIRS: Final = Dialect(
    name="pairs",
    title="pairs of lines",
    marks=marks(rb"1050[ \t]*\Z", rb"1002[ \t]*\Z"),
    handlers={"1050": _header, "1002": _tool, "0": _rapid, "11": _line, "1003": operations.end_of_file},
    text=TextFormat(scan_pairs, parse_pair, "the file ends after the code of a record"),
    cycles=CycleWords({}),
    end="record 1003",
)

#: One path in both formats.
PAIRED: Final = """1050
0
1002
5 10 1 900
0
10 0 50 0 0 1
11
10 0 5 0 0 1 300
11
0 10 5 0 0 1 300
0
0 10 50 0 0 1
1002
6 8 0 1200
0
30 0 60 0.6 0 0.8
11
20 0 10 0.6 0 0.8 250
11
20 8 10 0.6 0 0.8 150
0
30 8 60 0.6 0 0.8
1003
0
"""
IN_APT: Final = """UNITS/MM
CUTTER/10,1
LOADTL/5
SPINDL/900,RPM,CLW
RAPID
GOTO/10,0,50,0,0,1
FEDRAT/300,PERMIN
GOTO/10,0,5,0,0,1
GOTO/0,10,5,0,0,1
RAPID
GOTO/0,10,50,0,0,1
CUTTER/8,0
LOADTL/6
SPINDL/1200,RPM,CLW
RAPID
GOTO/30,0,60,0.6,0,0.8
FEDRAT/250,PERMIN
GOTO/20,0,10,0.6,0,0.8
FEDRAT/150,PERMIN
GOTO/20,8,10,0.6,0,0.8
RAPID
GOTO/30,8,60,0.6,0,0.8
FINI
"""


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(DIALECTS, PAIRS.name, PAIRS)


def file_of(folder: Path, text: str, name: str = "part.txt") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def said(toolpath: Toolpath) -> Iterator[object]:
    """All that a toolpath says but for its lines of text and the names of file and dialect."""
    yield toolpath.unit, toolpath.states_unit, toolpath.part, toolpath.remarks, toolpath.system
    for operation in toolpath.operations:
        yield operation.name, operation.tool, operation.frame, operation.intol, operation.outtol, operation.joined
        yield [_unplaced(event) for event in operation.events]
        for part in (operation.moves, operation.arcs):
            columns = {field.name: getattr(part, field.name) for field in fields(part) if field.name != "line"}
            yield {name: column.tolist() for name, column in columns.items() if column is not None}


def _unplaced(event: Event) -> Event:
    return replace(event, line=0)


def refused(folder: Path, text: str, **options: object) -> tuple[Problem, ...]:
    with pytest.raises(InputError) as caught:
        read_cl(file_of(folder, text), ClReading(**options))  # type: ignore[arg-type]
    return caught.value.problems


def test_both_texts_of_a_path_are_one_toolpath(tmp_path: Path) -> None:
    paired = read_cl(file_of(tmp_path, PAIRED), ClReading(strict=True))
    in_apt = read_cl(file_of(tmp_path, IN_APT), ClReading(strict=True))
    assert (paired.dialect, in_apt.dialect) == ("pairs", "apt")
    assert repr(list(said(paired))) == repr(list(said(in_apt)))
    assert paired.operations[1].moves.line.tolist() == [15, 17, 19, 21]


@pytest.mark.parametrize("chunk", [1, 7, 64])
def test_the_pieces_in_which_a_file_is_read_change_nothing(tmp_path: Path, chunk: int) -> None:
    (source,) = cl_sources(file_of(tmp_path, PAIRED.replace("\n", "\r\n").removesuffix("\r\n")))
    found, whole = read_source(source, chunk=chunk), read_source(source)
    assert repr(list(said(found))) == repr(list(said(whole)))


def test_it_is_recognized_beside_the_others(tmp_path: Path) -> None:
    found = recognize_dialect(PAIRED.encode())
    assert (found.dialect.name, str(found.why)) == ("pairs", "1050 in line 1")
    for dialect, head in HEADS.items():
        assert recognize_dialect("\n".join(head).encode()).dialect.name == dialect
    assert is_cl_file(file_of(tmp_path, PAIRED))
    assert read_cl(io.BytesIO(PAIRED.encode())).recognized == "pairs of lines: 1050 in line 1"


@pytest.mark.parametrize("machine", ["yl569", "dmu65"])
def test_the_program_is_that_of_the_other_text(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], machine: str
) -> None:
    programs = []
    for text in (PAIRED, IN_APT):
        program = tmp_path / "part.nc"
        assert main(["post", str(file_of(tmp_path, text)), "--machine", machine, "--output", str(program)]) == 0
        programs.append(program.read_text(encoding="utf-8"))
    assert "read as pairs of lines: 1050 in line 1" in capsys.readouterr().err
    assert programs[0] == programs[1]


@pytest.mark.parametrize(
    ("before", "after", "line", "what"),
    [
        ("10 0 5 0 0 1 300", "10 0 x 0 0 1 300", 7, "record 11 has '10 0 x 0 0 1 300' where numbers belong"),
        ("10 0 5 0 0 1 300", "10 0 5 0 0 1", 7, "11 has 6 numbers, expected 7"),
        ("10 0 5 0 0 1 300\n", "", 7, "11 has 1 number, expected 7"),
        ("5 10 1 900", "5.5 10 1 900", 3, "LOADTL has 5.5 where a whole number belongs"),
        ("1003\n0\n", "", 22, "the file has no record 1003 behind its last motion"),
        ("1003\n0\n", "11\n", 23, "the file ends after the code of a record"),
    ],
)
def test_what_is_malformed_is_refused_with_its_line_and_a_cure(
    tmp_path: Path, before: str, after: str, line: int, what: str
) -> None:
    problems = refused(tmp_path, PAIRED.replace(before, after, 1))
    assert all(problem.file.endswith("part.txt") and problem.cure for problem in problems)
    assert (line, what) in [(problem.line, problem.what) for problem in problems]


def test_an_unknown_record_is_kept_and_no_program_is_made_without_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = PAIRED.replace("1003\n", "1018\n7 2.5\n1003\n")
    file = file_of(tmp_path, text)
    ((event,),) = unknown_statements(read_cl(file))
    assert (event.line, str(event.what), event.acts) == (23, "1018 is not known", True)
    statement = shop_statement(event)
    assert (statement.word, statement.numbers) == ("1018", (7.0, 2.5))
    assert can_be_unknown("1018")
    assert main(["post", str(file), "--machine", "yl569", "--output", str(tmp_path / "part.nc")]) == 2
    assert f"{file}:23: error: 1018 is not known" in capsys.readouterr().err
    assert [problem.line for problem in refused(tmp_path, text, strict=True)] == [23]
