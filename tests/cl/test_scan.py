"""The compiled walk agrees with its reference implementation, bit for bit, however the file is cut into pieces."""

import math
import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.naive import cl_scan as naive
from trunnion.arrays import Floats, Lines
from trunnion.cl.read import read_cl, read_source
from trunnion.cl.scan import COMMENT, MAKES_ROW, SPAN_COLUMNS, UNFINISHED, Piece, PointColumns, fill_modal_axes, scan
from trunnion.cl.sources import cl_sources
from trunnion.errors import InputError
from trunnion.model.toolpath import Toolpath

QUICK = settings(max_examples=examples(100), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def scan_all(
    data: bytes, spans: int = 64, *, apt: bool = False, text_width: int = 0
) -> tuple[Floats, Floats, Lines, list[tuple[str, int, int, int]]]:
    """Scan whole bytes; return tip, axis, line, and the statements as (text, line, row, marks)."""
    data += b"" if data.endswith(b"\n") else b"\n"
    n = data.count(b"\n") + 1
    tip, axis, line = np.full((n, 3), np.inf), np.full((n, 3), np.inf), np.zeros(n, np.int32)
    room = np.zeros((spans, SPAN_COLUMNS), np.int64)
    array = np.frombuffer(bytearray(data), np.uint8)
    at, number, rows = 0, 1, 0
    found = []
    while at < len(data):
        at, number, rows, count = scan(
            apt, text_width, Piece(array, at, len(data), number, True), rows, PointColumns(tip, axis, line), room
        )
        for begin, length, where, row, mark in room[:count].tolist():
            found.append((naive.blank(data[begin : begin + length].decode("latin-1")), where, row, mark))
    return tip[:rows], axis[:rows], line[:rows], found


def bits(number: float) -> bytes:
    return struct.pack("d", number)


digits = st.text("0123456789", max_size=20)
spelled = st.builds(
    lambda sign, whole, point, part: sign + whole + point + part,
    st.sampled_from(["", "-", "+"]),
    digits,
    st.sampled_from(["", "."]),
    digits,
).filter(lambda text: any(letter.isdigit() for letter in text))
printed = st.builds(
    lambda number, decimals: f"{number:.{decimals}f}",
    st.floats(-1e6, 1e6, allow_nan=False),
    st.integers(0, 16),
)


@QUICK
@given(st.lists(spelled | printed, min_size=6, max_size=6), st.sampled_from(["", " "]), st.sampled_from(["", "\r"]))
@example(["-0.0", "0", "9007199254740992", "9007199254740993", "0.9007199254740993", ".1"], "", "")
def test_a_point_is_read_to_the_last_bit_or_left_to_python(fields: list[str], blank: str, end: str) -> None:
    text = f"GOTO/{(',' + blank).join(fields)}{end}\n"
    tip, axis, line, found = scan_all(text.encode())
    assert line.tolist() == [1]
    if found:
        assert found == [(text.strip(), 1, 0, MAKES_ROW)]
        exact = [field.strip("+-").replace(".", "") for field in fields]
        assert any(len(field) > 18 or int(field) > 2**53 for field in exact)
    else:
        assert [bits(number) for number in [*tip[0], *axis[0]]] == [bits(float(field)) for field in fields]


@pytest.mark.filterwarnings("error")
@QUICK
@given(
    st.lists(spelled, min_size=3, max_size=3).filter(lambda fields: all(abs(float(field)) <= 1e6 for field in fields))
)
def test_what_the_reader_gives_is_what_python_reads(tmp_path: Path, fields: list[str]) -> None:
    path = tmp_path / "a.cls"
    path.write_text(f"TOOL PATH/A,TOOL,T\nGOTO/{','.join(fields)}\nEND-OF-PATH\n")
    (operation,) = read_source(cl_sources(path)[0], chunk=1 << 16).operations
    assert [bits(number) for number in operation.moves.tip[0]] == [bits(float(field)) for field in fields]


PIECES = st.sampled_from(
    [
        *(
            "GOTO/1,2,3",
            "GOTO/1.5,-2.25,3.125,0,0,1",
            "GOTO / 1 , 2 , 3",
            "goto/1,2,3",
            "GOTO/1,2",
            "GOTO/1,2,3,4,5,6,7",
        ),
        *(
            "GOTO/1,2,3 $$ 4,5,6",
            "GOTO/1,2,3 $$ 4,5,6GOTO/7,8,9",
            "GOTO/1,2,3 $$ 4\f5",
            "GOTO/1,2,3 $",
            "GOTO/1,$",
            "GOTO/1,$ $$ X",
            "GOTO/1E3,2,3",
            "GODLTA/1,2,3",
            "GOHOME",
            "GOHOME/1,2,3",
        ),
        *(
            "GOHOME/AUTO",
            "G O T O/1,2,3",
            "GOTO",
            "RAPID",
            "$$ comment",
            "$$ comment $",
            "$",
            "  ",
            "",
            "PAINT/COLOR,31",
        ),
        *(
            "PPRINT/ab $$ cd $",
            "PPRINT $",
            "TOOL PATH/A$,TOOL,B$",
            "COOLNT/O$N",
            "COOLNT/ON $$ on",
            "2,3",
            "$ $",
            "INSERT$$",
        ),
    ]
)
FILES = st.lists(st.tuples(PIECES, st.sampled_from(["\n", "\r\n", " \n", "\n\n"])), max_size=30).map(
    lambda parts: "".join(piece + end for piece, end in parts)
)


@QUICK
@given(FILES, st.integers(1, 5), st.sampled_from([0, 8]))
@example("GOTO/1,$\r\n2,3\r\n", 1, 0)
@example("COOLNT/$\n$$ c\n", 1, 0)
@example("PPRINT $ \r\n PPRIN $\n1234567$\nGOTO/1,2,3\n", 1, 8)
@example("PPRINT/$\n", 1, 8)
def test_the_walk_finds_the_statements_of_its_twin(text: str, spans: int, text_width: int) -> None:
    tip, axis, line, found = scan_all(text.encode(), spans, text_width=text_width)
    expected = list(naive.statements(text.encode(), text_width))
    rows = [(statement, number) for statement, number, _ in expected if naive.is_row(statement)]
    assert line.tolist() == [number for _, number in rows]
    left = {number: (statement, row, mark) for statement, number, row, mark in found if mark != COMMENT}
    row = 0
    for statement, number, unfinished in expected:
        is_row = naive.is_row(statement)
        if number in left:
            assert left.pop(number) == (statement, row, MAKES_ROW * is_row | UNFINISHED * unfinished)
        else:
            assert [*tip[row].tolist(), *axis[row].tolist()][: len(naive.numbers(statement))] == naive.numbers(
                statement
            )
        row += is_row
    assert not left


vectors = st.none() | st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: sum(x * x for x in v) > 0.01).map(
    lambda v: [x / math.hypot(*v) * 1.004 for x in v]
)


@QUICK
@given(st.lists(vectors, max_size=20))
def test_axes_are_settled_as_by_the_twin(given_vectors: list[list[float] | None]) -> None:
    axis = np.array([vector or [np.nan] * 3 for vector in given_vectors]).reshape(-1, 3)
    bad = np.zeros(4, np.int64)
    assert fill_modal_axes(axis, 0, len(axis), np.array([0.0, 0.0, 1.0]), bad) == 0
    assert np.allclose(axis, np.reshape(naive.settle(given_vectors, [0, 0, 1]), (-1, 3)), rtol=0, atol=3e-16)


def _bytes(column: Floats | None) -> bytes | None:
    return None if column is None else column.tobytes()


def fingerprint(toolpath: Toolpath) -> object:
    """Everything in a toolpath, as comparable values."""
    return [
        toolpath.part,
        toolpath.remarks,
        [
            (
                *(operation.name, operation.tool, operation.frame, operation.events, operation.line),
                *(_bytes(getattr(operation.moves, name)) for name in operation.moves.__slots__),
                *(getattr(operation.arcs, name).tobytes() for name in operation.arcs.__slots__),
            )
            for operation in toolpath.operations
        ],
    ]


def outcome(path: Path, chunk: int) -> object:
    try:
        return fingerprint(read_source(cl_sources(path)[0], chunk=chunk))
    except InputError as error:
        return error.problems


SAMPLE = """TOOL PATH/Fräsen $ 1,TOOL,Kugel Ø10
TLDATA/MILL,10.0,5.0,$
  75.0,0.0,$
0.0
MSYS/0,0,0,1,0,0,0,1,0
$$ centerline data
LOAD/TOOL,2,ADJUST,2
PAINT/COLOR,186
RAPID
GOTO/1.5,2,3,0,0.6,0.8
PAINT/COLOR,31
FEDRAT/MMPM,100
GOTO/5,0,0 $$ 1,2,3
CIRCLE/0,0,0,$
0,0,1,5
GOTO/0,5,0
GODLTA/1,1,$
1
WOBBLE/1
PPRINT/costs 5$
SPINDL/OFF
END-OF-PATH
TOOL PATH/B,TOOL,C
GOTO/1,2,3
END-OF-PATH
"""


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_file_reads_the_same_in_pieces_of_any_size(tmp_path: Path, end: str) -> None:
    path = tmp_path / "a.cls"
    path.write_bytes(SAMPLE.replace("\n", end).encode("latin-1"))
    whole = outcome(path, 1 << 20)
    assert not isinstance(whole, tuple)
    for chunk in [*range(1, 40), 64, 100, 333]:
        assert outcome(path, chunk) == whole


@QUICK
@given(FILES, st.integers(1, 50))
def test_any_file_reads_the_same_in_pieces_of_any_size(tmp_path: Path, text: str, chunk: int) -> None:
    path = tmp_path / "a.cls"
    path.write_text("TOOL PATH/A,TOOL,B\n" + text + "END-OF-PATH\n", newline="")
    assert outcome(path, chunk) == outcome(path, 1 << 16)


@pytest.mark.filterwarnings("error")
@settings(QUICK, max_examples=examples(200))
@given(
    st.lists(
        st.tuples(st.integers(0, len(SAMPLE)), st.integers(0, 8), st.binary(max_size=6) | PIECES.map(str.encode)),
        min_size=1,
        max_size=6,
    )
)
def test_whatever_happens_to_the_bytes_the_end_is_a_toolpath_or_an_input_error(
    tmp_path: Path, changes: list[tuple[int, int, bytes]]
) -> None:
    data = bytearray(SAMPLE.encode("latin-1"))
    for at, length, new in changes:
        data[at : at + length] = new
    path = tmp_path / "a.cls"
    path.write_bytes(bytes(data))
    outcome(path, 1 << 16)


def test_a_file_whose_lines_get_shorter_has_room_for_all_its_points(tmp_path: Path) -> None:
    talk = "PPRINT/" + "x" * 5000 + "\n"
    points = "".join(f"GOTO/{n},0,1\n" for n in range(40_000))
    file = tmp_path / "late.cls"
    file.write_text(f"TOOL PATH/OP,TOOL,T\n{talk * 300}FEDRAT/MMPM,100\n{points}END-OF-PATH\n", encoding="utf-8")
    moves = read_cl(file).operations[0].moves
    assert len(moves) == 40_000
    assert (moves.tip[:, 0] == np.arange(40_000)).all()
    assert (moves.axis == [0.0, 0.0, 1.0]).all()
    assert (moves.line == np.arange(303, 40_303)).all()
    assert (moves.feed == 100.0).all()


def test_a_point_may_go_on_in_the_next_line() -> None:
    tip, axis, line, found = scan_all(
        b"GOTO / 1.5, 2, 3,  $\n 0.0, 0.6,$\r\n0.8\nGOTO/4,5,$ $$ more\n6\nGOTO/7,8,9,$\n"
    )
    assert tip[0].tolist() == [1.5, 2, 3]
    assert axis[0].tolist() == [0, 0.6, 0.8]
    assert line.tolist() == [1, 4, 6]
    assert found == [("GOTO/4,5,$ $$ more\n6", 4, 1, MAKES_ROW), ("GOTO/7,8,9,$", 6, 2, MAKES_ROW | UNFINISHED)]


def test_comments_are_spans_and_those_with_an_arrow_statements_in_apt() -> None:
    data = b"$$-> CSYS / 1, $\n 2\n $$ TEXT $\nGOTO/1,2,3 $$ 7\nTLON, GOFWD/(CIRCLE)\nRETRCT\nRETRCTS\nGO FWD/1\n"
    *_, found = scan_all(data, apt=True)
    assert found == [
        ("-> CSYS / 1, $\n 2", 1, 0, 0),
        ("$$ TEXT $", 3, 0, COMMENT),
        ("TLON, GOFWD/(CIRCLE)", 5, 1, MAKES_ROW),
        ("RETRCT", 6, 2, MAKES_ROW),
        ("RETRCTS", 7, 3, 0),
        ("GO FWD/1", 8, 3, MAKES_ROW),
    ]
    *_, found = scan_all(data)
    comments = ["$$-> CSYS / 1, $", "2", "$$ TEXT $"]
    assert [text for text, *_ in found] == [*comments, "TLON, GOFWD/(CIRCLE)", "RETRCT", "RETRCTS", "GO FWD/1"]
