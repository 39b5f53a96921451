"""Files that cannot be used: each error names its line and what puts it right."""

import os
from pathlib import Path

import pytest

from tests.support.cl_reading import Fail
from trunnion.cl import read_cl
from trunnion.errors import InputError

GO = "GOTO/0,0,0"


@pytest.mark.parametrize(
    ("lines", "line", "what"),
    [
        (("GOTO/1,2",), 3, "GOTO has 2 numbers, expected 3 or 6"),
        (("GOTO/1,2,3,4",), 3, "4 numbers"),
        (("GOTO/1,2,3,0,0,1,0",), 3, "7 numbers"),
        (("GOTO/1,2,",), 3, "'nothing'"),
        (("GOTO",), 3, "GOTO has 0 numbers"),
        (("GOTO/1,2,NaN",), 3, "'NAN'"),
        (("GOTO/1,2,-NaN",), 3, "'-NAN'"),
        (("GOTO/1,2,1E999",), 3, "inf"),
        (("GOTO/1,2,3_0",), 3, "'3_0'"),
        (("GOTO/1,2 5,3",), 3, "'2 5'"),
        (("GOTO/1,2,3,0,0,0",), 3, "the tool-axis vector is zero"),
        (("GOTO/1,2,3,0,0,1.02",), 3, "length 1.02"),
        (("GOTO/1,2,3,0,0,-0.98",), 3, "length 0.98"),
        (("FROM/1,2,3,0,0,0", GO), 3, "the tool-axis vector is zero"),
        (("FROM/1,2", GO), 3, "FROM has 2 numbers"),
        (("GODLTA/1,2,3",), 3, "without a point to go from"),
        (("MSYS/0,0,0,1,0,0", GO), 3, "MSYS has 6 numbers"),
        (("MSYS/0,0,0,1,0,0,0,2,0", GO), 3, "Y vector of MSYS has the length 2"),
        (("MSYS/0,0,0,1,0,0,0.6,0.8,0", GO), 3, "not square"),
        ((GO, "MSYS/0,0,0,1,0,0,0,1,0"), 4, "MSYS after motion"),
        (("TLDATA/MILL,1,2", GO), 3, "TLDATA/MILL has 2 numbers, expected 5, 7 or 10"),
        (("SPINDL/SFM,100,DIAMTR,0", GO), 3, "no diameter"),
        (("SPINDL/ON", GO), 3, "before any speed"),
        (("SPINDL/RPM,-5", GO), 3, "negative speed"),
        (("SPINDL/RPM,0,CLW", GO), 3, "speed 0"),
        (("CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100,DWELL,-1", GO), 3, "dwell -1"),
        (("CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-500,STEP,.0001,MMPM,100", GO), 3, "more than 1000 times"),
        (("LOAD/TOOL,1.5", GO), 3, "1.5 where a whole number belongs"),
        (("LOAD/TOOL", GO), 3, "LOAD has 0 numbers"),
        (("FEDRAT/INVERS,AUTO", GO), 3, "FEDRAT/INVERS"),
        (("FEDRAT/MMPM", GO), 3, "FEDRAT has 0 numbers"),
        (("FEDRAT/MMPM,-1", GO), 3, "negative"),
        (("FEDRAT/MMPM,100,MMPR", GO), 3, "FEDRAT has MMPM and MMPR, which contradict each other"),
        (("FEDRAT/INVERS,2,MMPM", GO), 3, "INVERS and MMPM"),
        (("FEDRAT/PERMIN,2,PERREV", GO), 3, "PERMIN and PERREV"),
        (("SPINDL/RPM,500,CLW,CCLW", GO), 3, "SPINDL has CLW and CCLW"),
        (("SPINDL/RPM,500,SFM", GO), 3, "RPM and SFM"),
        (("SPINDL/RPM,500,CLW", "SPINDL/ON,OFF", GO), 4, "ON and OFF"),
        (("SPINDL/RPM,500,OFF", GO), 3, "RPM and OFF"),
        (("SPINDL/RPM,500,800", GO), 3, "two speeds, 500 and 800"),
        (("CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100,RAPTO,4", GO), 3, "CYCLE has RAPTO twice"),
        (("CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100,MMPR,.1", GO), 3, "CYCLE has a feed twice"),
        (("DELAY/-1", GO), 3, "negative"),
        (("CYCLE", GO), 3, "CYCLE without a word"),
        (("CYCLE/ON", GO), 3, "before any cycle"),
        (("CYCLE/DRILL,RAPTO", GO), 3, "RAPTO without a number"),
        (("UNITS/FEET", GO), 3, "UNITS/FEET"),
        (("UNITS/MM", "UNITS/INCHES", GO), 4, "after another unit in line 3"),
        (("FEDRAT/MMPM,1", "FEDRAT/IPM,1", GO), 4, "feeds in mm (line 3) and in inches (line 4)"),
        (("PAINT/COLOR,RED", GO), 3, "'RED'"),
        (("$$ contact contour data", GO), 3, "no CUTCOM makes the control add the radius"),
        (("$$ contact point data", GO), 3, "the points are those where the tool touches"),
        (("$$ centerline data", "CUTCOM/LEFT,CONTACT", GO), 4, "says that the points are those of the contour"),
        (("NURBS/", "KNOT/0,1", "CNTRL/1,2,3", GO), 3, "NURBS without a point to begin in"),
        (("CNTRL/1,2,3", GO), 3, "CNTRL that follows neither KNOT"),
        (("COOLNT/O$N", GO), 3, "dollar sign within the line"),
        (("COOLNT/\x01ON", GO), 3, "unknown encoding: byte 0x01"),
        (("COOLNT/ON\rGOTO/1,2,3", GO), 3, "carriage return"),
    ],
)
def test_a_bad_statement_is_refused_with_its_line(
    body_fails: Fail, lines: tuple[str, ...], line: int, what: str
) -> None:
    (problem,) = body_fails(*lines)
    assert problem.line == line
    assert what in problem.what
    assert problem.cure


def test_all_problems_come_at_once_in_the_order_of_lines(body_fails: Fail) -> None:
    problems = body_fails("GOTO/0,0,1,0,0,0", "GOTO/1", GO, "MSYS/1", "GOTO/0,0,0,0,0,5")
    assert [problem.line for problem in problems] == [3, 4, 6, 7]


def test_a_long_list_of_problems_ends_with_their_number(body_fails: Fail) -> None:
    problems = body_fails(*["GOTO/1"] * 250)
    assert len(problems) == 101
    assert problems[-1].what == "and 150 more"


def test_many_bad_vectors_are_listed_up_to_the_cap(body_fails: Fail) -> None:
    problems = body_fails(*["GOTO/1,1,1,0,0,0"] * 250)
    assert len(problems) == 101


def test_both_units_cure_names_the_setting(body_fails: Fail) -> None:
    (problem,) = body_fails("FEDRAT/MMPM,1", "FEDRAT/IPM,1", GO)
    assert "setting units=" in problem.cure


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("", 0, "the file is empty"),
        (b"\xef\xbb\xbf", 0, "the file is empty"),
        ("\n \n", 0, "not a CL file"),
        ("hello\nworld\n", 0, "not a CL file"),
        ("N10 G0 X1 Y2\n" * 5000, 0, "not a CL file"),
        ("TOOL PATH/A,TOOL,T\nEND-OF-PATH\n", 0, "no motion"),
        ("GOTO/1,2,3\n", 1, "motion outside any operation"),
        ("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH\nGOTO/1,2,3\n", 4, "motion outside any operation"),
        ("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH\nEND-OF-PATH\n", 4, "END-OF-PATH without TOOL PATH"),
        ("FROM/1,1,1\nGOTO/1,2,3\nFROM/2,2,2\nTOOL PATH/A,TOOL,T\nEND-OF-PATH\n", 2, "motion outside any operation"),
        ("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\n", 1, "operation A has no END-OF-PATH before the end of the file"),
        ("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nGOTO/1,2,4.1", 3, "ends in the middle of line 3"),
        (
            "TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nTOOL PATH/B,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH\n",
            1,
            "no END-OF-PATH before the next TOOL PATH in line 3",
        ),
        ("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH\nCOOLNT/$\n", 4, "ends after a continuation sign"),
        ("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH\nCOOLNT/$", 4, "ends after a continuation sign"),
        (b"\xff\xfeT\x00O\x00", 1, "UTF-16"),
        (b"\xfe\xff\x00T\x00O", 1, "UTF-16"),
        (b"TOOL PATH/A,TOOL,T\nGOTO/1\x00,2,3\n", 2, "NUL byte"),
        (b"TOOL PATH/A,TOOL,T\rGOTO/1,2,3\rEND-OF-PATH\r", 1, "lone carriage return"),
        ("TOOL PATH/A,TOOL,T\nGOTO/1" + "1" * 10_000_000 + ",2,3\nEND-OF-PATH\n", 2, "longer than 1048576 bytes"),
        ("TOOL PATH/A,TOOL,T\n$$" + "1" * 10_000_000 + "\nEND-OF-PATH\n", 2, "longer than 1048576 bytes"),
        ("TOOL PATH/A,TOOL,T\n" + "COOLNT/$\n" * 200_000, 2, "longer than 1048576 bytes"),
        ("TOOL PATH/A,TOOL,T\n" + "1" * 10_000_000, 2, "longer than 1048576 bytes"),
    ],
)
def test_a_bad_file_is_refused(fails: Fail, text: str | bytes, line: int, what: str) -> None:
    problems = fails(text)
    assert any(problem.line == line and what in problem.what for problem in problems)
    assert all(problem.cure for problem in problems)


def test_a_problem_names_the_file_first(tmp_path: Path) -> None:
    path = tmp_path / "bad.cls"
    path.write_text("GOTO/1,2,3\n")
    with pytest.raises(InputError, match=rf"^{path}:1: error: motion outside any operation; "):
        read_cl(path)


def test_a_folder_is_no_cl_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder"):
        read_cl(tmp_path)


def test_a_file_that_is_not_there_is_said_so(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.cls: error: file not found"):
        read_cl(tmp_path / "none.cls")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read_is_said_so(tmp_path: Path) -> None:
    path = tmp_path / "a.cls"
    path.write_text("GOTO/1,2,3\n")
    path.chmod(0)
    with pytest.raises(InputError, match="Permission denied"):
        read_cl(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes on this system")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="not a regular file"):
        read_cl(tmp_path / "pipe")


@pytest.mark.parametrize(
    ("statement", "what"),
    [
        ("TRANS/1,2,3", "TRANS/1,2,3 shifts or turns the points"),
        ("COPY/1,TRANSL,1,0,0,2", "COPY repeats, shifts or turns motion"),
        ("TRACUT/1,0,0,5,0,1,0,0,0,0,1,0", "TRACUT repeats, shifts or turns motion"),
        ("TLON", "TLON is motion that cannot be read; output arcs"),
        ("INDIRV/1,0,0", "INDIRV is motion that cannot be read; output arcs"),
    ],
)
def test_a_shift_or_geometry_gets_its_own_cure(statement: str, what: str, body_fails: Fail) -> None:
    told = str(body_fails(GO, statement)[0])
    assert what in told
    assert "turn off spline output" not in told


def test_a_knot_behind_a_copy_is_named_too(body_fails: Fail) -> None:
    assert [problem.line for problem in body_fails(GO, "COPY/1", "KNOT/0.5")] == [4, 5]
