"""The listing: fast rows against slow ones, and what it says of a program."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.posting import FOOT, HEAD
from trunnion.reporting.listing import Column, _slow_row_texts, listing, row_texts
from trunnion.verification.results import OperationRows

value = st.one_of(
    st.just(float("nan")),
    st.sampled_from([0.0, -0.0, -0.00004, -0.00006, 0.5, -1.0, 999999.4, -999999.9999, 99999.99995, 1e6, -1e6, 4.3e5]),
    st.floats(-2000, 2000),
)


@settings(deadline=None, max_examples=examples(40))
@given(st.lists(st.tuples(value, value, st.integers(0, 99999), st.integers(0, 1)), min_size=1, max_size=40))
def test_rows_are_written_as_one_by_one(rows: list[tuple[float, float, int, int]]) -> None:
    table = np.array(rows, np.float64)
    columns = [Column(table[:, 2], 0, 9), Column(table[:, 0], 4), Column(table[:, 1], 1)]
    text, ends = row_texts(columns, ("ab", "cd"), table[:, 3].astype(np.int64))
    slow, slow_ends = _slow_row_texts(columns, ("ab", "cd"), table[:, 3].astype(np.int64))
    assert text == slow
    assert ends.tolist() == slow_ends.tolist()
    for line, (first, second, number, of) in zip(text.decode().splitlines(), rows, strict=True):
        words = [str(number), *(f"{each:.9f}" for each in (first, second) if np.isfinite(each)), ("ab", "cd")[of]]
        assert len(line.split()) == len(words)


CL = HEAD.replace("GOTO/0.0,0.0,50.0", "GOTO/0.0,0.0,50.0,0.0,0.0,1.0\nRAPID\nGOTO/-1.5,2.25,50.0") + (
    "CIRCLE/0,0,5,0,0,1,10\nGOTO/-10.0,0.0,5.0\nFEDRAT/MMPR,0.125\nGOTO/-10.0,0.0,2.0\n" + FOOT
)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> trunnion.Run:
    source = tmp_path_factory.mktemp("listing") / "part.cls"
    source.write_text(CL, encoding="utf-8")
    found = trunnion.post(source, machine="yl569").run
    assert found is not None
    return found


def lines_of(run: trunnion.Run, *operations: OperationRows, slides: bool = False) -> list[str]:
    return b"".join(listing(run, "job.mpf", operations, slides=slides)).decode().splitlines()


def test_every_motion_has_a_line(run: trunnion.Run) -> None:
    lines = lines_of(run)
    head, body = [line for line in lines if line.startswith(";")], [line for line in lines if not line.startswith(";")]
    assert len(body) == len(run)
    assert "LISTING OF job.mpf" in head[0]
    assert any("B: primary rotary axis, C: secondary rotary axis" in line for line in head)
    names = next(line for line in head if " LINE " in line).split()
    assert names == [";", "LINE", "N", "X", "Y", "Z", "B", "C", "S", "F", "MOTION"]
    assert "; tool 1" in head


def test_the_lines_say_what_the_control_does(run: trunnion.Run) -> None:
    body = [line.split() for line in lines_of(run) if not line.startswith(";")]
    line, number = run.line, run.block_number
    for row, words in enumerate(body):
        assert [int(words[0]), int(words[1])] == [line[row], number[row]]
    assert body[0][-2:] == ["rapid", "machine"]
    assert len(body[0]) == 2 + 2 + 1 + 2, "no tip is known from positions of the machine"
    cut = next(words for words in body if "line" in words)
    assert cut[2:] == ["10.0000", "0.0000", "5.0000", "0.0000", "0.0000", "4000.0", "500.000", "mm/min", "line"]
    arc = next(words for words in body if "arc" in words)
    assert arc[2:5] == ["-10.0000", "0.0000", "5.0000"]
    assert [words[-3:] for words in body if "mm/rev" in words] == [["0.125", "mm/rev", "line"]]
    first = next(k for k, words in enumerate(body) if words[-1] == "rapid" and len(words) > 6)
    np.testing.assert_allclose([float(word) for word in body[first][2:5]], run.tip[first], atol=1e-4)


def test_slides_stand_beside_the_tip(run: trunnion.Run) -> None:
    lines = lines_of(run, slides=True)
    assert "; SX SY SZ: linear axes, mm, counted from the workpiece zero" in lines
    body = [line.split() for line in lines if not line.startswith(";")]
    row = next(k for k, words in enumerate(body) if words[-1] == "line")
    cut = body[row]
    expected = [run.joints[row, k] for k in run.machine.linear]
    np.testing.assert_allclose([float(word) for word in cut[7:10]], expected, atol=1e-4)


def test_operations_and_hostile_names_are_one_line(run: trunnion.Run) -> None:
    name = "x\nN1 G0\u2028\x1b[2J\u202e"
    lines = b"".join(listing(run, "a\nb", [OperationRows(name, "", "", 3, 5)])).decode().split("\n")
    mark = next(k for k, line in enumerate(lines) if line.startswith("; operation 1: x"))
    assert sum(not line.startswith(";") for line in lines[:mark]) == 3
    assert all(re.match(r"; |\s+\d+ |$", line) for line in lines)
    assert "\x1b" not in "".join(lines)
    assert "\u202e" not in "".join(lines)


def test_a_file_is_told_where_it_changes(tmp_path: Path) -> None:
    source = tmp_path / "part.cls"
    source.write_text(CL + CL.replace("OP1", "OP2"), encoding="utf-8")
    output = tmp_path / "job.mpf"
    result = trunnion.post(source, machine="yl569", output=output, settings={"programs": "operations"},
                           listing=tmp_path / "job.lpt")  # fmt: skip
    assert result.passed
    text = (tmp_path / "job.lpt").read_text(encoding="utf-8")
    marks = [line for line in text.split("\n") if re.match(r"; (file|operation|tool) ", line)]
    assert [each for each in marks if "file" in each] == ["; file OP1.spf", "; file OP2.spf"]
    assert [each for each in marks if "operation" in each] == ["; operation 1: OP1", "; operation 2: OP2"]
    assert str(tmp_path) not in text
