"""Trunnion's own APT profile: what it says, that it is read strictly, and that the whole tool comes back."""

import io
import re
from dataclasses import replace

import numpy as np
import pytest

from tests.support.cl_reading import Fail, Read
from tests.support.locations import DOCS
from trunnion.cl.dialects import DIALECTS, recognize_dialect
from trunnion.cl.write import write_cl
from trunnion.errors import InputError
from trunnion.model.toolpath import Frame, LoadTool, Tool

HEAD = "$$-> TRUNNION / 1\nUNITS/MM\n$$-> STOCK / BOX,60,50,40,-30,-25,-40\n"
BEGIN = "TOOL PATH/FINISH,TOOL,BALL 10\n"
TOOL = "$$-> TOOL / MILL,CORNER,5,DIAMETER,10,LENGTH,60,FLUTE,25,EXTENSION,42,GAUGE,121.5\n$$-> HOLDER / HSK 63/ER32\n"
BODY = "MSYS/1,2,3,0,1,0,0,0,1\n$$-> WORK-OFFSET / 2\n"
BODY += "LOADTL/7,ADJUST,9\nSELCTL/8\nFEDRAT/MMPM,500\nRAPID\nGOTO/0,0,9,0.6,0,0.8\nGOTO/0,0,0\n"
END = "END-OF-PATH\nFINI\n"
WHOLE = HEAD + BEGIN + TOOL + BODY + END


def test_the_whole_tool_plane_and_stock_are_read(read: Read) -> None:
    toolpath = read(WHOLE)
    assert (toolpath.dialect, toolpath.stock, toolpath.unit) == ("trunnion", "box:60,50,40,-30,-25,-40", 1.0)
    (operation,) = toolpath.operations
    assert operation.tool == Tool(
        kind="MILL", name="BALL 10", diameter=10.0, corner_radius=5.0, length=60.0, flute_length=25.0, extension=42.0,
        set_length=121.5, holder="HSK 63/ER32",
    )  # fmt: skip
    assert operation.work_offset == 2
    assert operation.frame == Frame((1.0, 2.0, 3.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    assert next(event.adjust for event in operation.events if isinstance(event, LoadTool)) == 9


def test_inches_are_those_of_the_stock_and_the_tool_too(read: Read) -> None:
    toolpath = read(WHOLE.replace("/MM\n", "/INCHES\n"))
    assert toolpath.stock == "box:1524,1270,1016,-762,-635,-1016"
    assert toolpath.operations[0].tool.set_length == pytest.approx(121.5 * 25.4)
    assert read(WHOLE.replace("BOX,60,50,40,-30,-25,-40", "CYLINDER,60,40,-40")).stock == "cylinder:60,40,-40"


@pytest.mark.parametrize("inch", [False, True])
def test_what_is_written_is_what_was_read(inch: bool, read: Read) -> None:
    forms = (
        Tool("DRILL", "D", 8.0, 0.0, 90.0, tip_angle=140.0, flute_length=60.0),
        Tool("BARREL", "B", 12.0, 60.0, 70.0, upper_radius=2.0, corner_centre=(-54.0, 3.0), upper_centre=(4.0, 8.0)),
        Tool("UNKNOWN", "U", 6.0),
        Tool(),
    )
    (first,) = read(WHOLE).operations
    toolpath = replace(read(WHOLE), operations=(first, *(replace(first, tool=tool, events=()) for tool in forms)))
    sink = io.BytesIO()
    assert write_cl(toolpath, sink, dialect="trunnion", inch=inch) == ()
    back = read(sink.getvalue().decode())
    assert (back.dialect, back.stock) == ("trunnion", toolpath.stock)
    for one, other in zip(toolpath.operations, back.operations, strict=True):
        for field in Tool.__dataclass_fields__:
            value, again = getattr(one.tool, field), getattr(other.tool, field)
            assert again == (value if isinstance(value, str | None) else pytest.approx(value)), field
        assert other.work_offset == one.work_offset == 2
        np.testing.assert_allclose(other.frame.origin, one.frame.origin, atol=1e-7)
        assert (other.frame.x, other.frame.y) == (one.frame.x, one.frame.y)
        np.testing.assert_allclose(other.moves.tip, one.moves.tip, atol=1e-9)


def test_a_probing_cycle_is_written_in_the_unit_of_its_file(read: Read) -> None:
    toolpath = read(WHOLE.replace("RAPID\n", "PROBE/X,10,5.0\nRAPID\n"))
    sink = io.BytesIO()
    write_cl(toolpath, sink, dialect="trunnion")
    assert b"\nPROBE/X,10,5.0\n" in sink.getvalue()
    with pytest.raises(InputError, match=r"PROBE/X,10,5\.0 is not known"):
        write_cl(toolpath, io.BytesIO(), dialect="trunnion", inch=True)


def test_the_first_line_settles_the_dialect_and_only_there() -> None:
    assert recognize_dialect((WHOLE + "$$*CATIA0\n$$ CATIA APT VERSION 1.0\n").encode()).dialect.name == "trunnion"
    assert recognize_dialect(("PARTNO/A\n" + WHOLE).encode()).dialect.name == "clsf"


@pytest.mark.parametrize(
    ("out", "instead", "line", "why"),
    [
        ("$$-> TRUNNION / 1", "$$-> TRUNNION / 2", 1, "$$-> TRUNNION / 2 is not known"),
        ("$$-> TRUNNION / 1\n", "", 2, "its name is not the first line"),
        ("UNITS/MM\n", "", 3, "no UNITS before the first TOOL PATH"),
        (BEGIN, BEGIN + "UNITS/MM\n", 5, "UNITS behind the first TOOL PATH"),
        (BEGIN, BEGIN + "$$-> STOCK / CYLINDER,60,40,-40\n", 5, "STOCK behind the first TOOL PATH"),
        (BEGIN, "$$-> STOCK / CYLINDER,60,40,-40\n" + BEGIN, 4, "another STOCK"),
        ("BOX,60", "BLOCK,60", 3, "STOCK / BLOCK,60,50,40,-30,-25,-40 is not known"),
        ("BOX,60", "BOX,-60", 3, "is not known"),
        ("BOX,60,", "BOX,", 3, "STOCK has 5 numbers"),
        (BEGIN + TOOL, TOOL + BEGIN, 4, "$$-> TOOL outside any operation"),
        ("MILL,", "MIL,", 5, "$$-> TOOL has MIL where"),
        ("DIAMETER", "DIAMTER", 5, "$$-> TOOL has DIAMTER where"),
        ("DIAMETER,10", "DIAMETER", 5, "where a number belongs"),
        ("LENGTH,60", "CORNER,60", 5, "TOOL has CORNER twice"),
        ("HOLDER", "HOLDR", 6, "HOLDR"),
        ("$$-> HOLDER", "$$ -> HOLDER", 6, "a comment begins with -> HOLDER"),
        ("OFFSET / 2", "OFFSET / 0", 8, "WORK-OFFSET / 0 is not known"),
        ("OFFSET / 2", "OFFSET / 2.5", 8, "WORK-OFFSET"),
        ("OFFSET / 2", "OFFSET / G55", 8, "WORK-OFFSET"),
        ("OFFSET / 2", "OFFSET / 2,3", 8, "WORK-OFFSET"),
        ("OFFSET / 2", "OFFSET / 2\n$$-> WORK-OFFSET / 3", 9, "work offset"),
        (BEGIN, "$$-> WORK-OFFSET / 2\n" + BEGIN, 4, "WORK-OFFSET outside any operation"),
        ("RAPID\nGOTO/0,0,9,0.6,0,0.8\n", "GOTO/0,0,9\n$$-> WORK-OFFSET / 2\n", 13, "WORK-OFFSET behind motion"),
        (END, "END-OF-PATH\nTOOL PATH/B,TOOL,C\nFEDRAT/MMPM,9\nGOTO/0,0,9\n" + END, 16, "B states no work offset"),
        ("SELCTL/8", "CLAMP/ON", 10, "CLAMP"),
        ("SELCTL/8", "LOAD/TOOL,8", 10, "LOAD"),
        ("SELCTL/8", "SEQNO/ON", 10, "SEQNO"),
        ("SELCTL/8", "COOLNT/FLOD", 10, "FLOD"),
        ("SELCTL/8", "PAINT/PATH", 10, "PAINT/PATH is not known"),
        ("SELCTL/8", "GODLTA/1,2,3", 10, "GODLTA"),
        ("SELCTL/8", "NURBS/", 10, "NURBS"),
        ("FINI\n", "", 15, "FINI"),
        ("END-OF-PATH\nFINI\n", "", 4, "END-OF-PATH"),
    ],
)
def test_anything_else_is_an_error_with_its_line(out: str, instead: str, line: int, why: str, fails: Fail) -> None:
    assert out in WHOLE
    problems = fails(WHOLE.replace(out, instead, 1))
    assert any(why in problem.what for problem in problems), problems
    assert line in {problem.line for problem in problems}


def test_a_word_with_a_letter_lost_or_a_line_that_is_joined_is_never_silent(fails: Fail) -> None:
    lines = WHOLE.splitlines()
    for k, line in enumerate(lines):
        word = re.match(r"(?:\$\$-> )?[A-Z-]+", line)
        assert word
        shorter = line.replace(word[0], word[0][:-1], 1)
        fails("\n".join([*lines[:k], shorter, *lines[k + 1 :]]) + "\n")
        if k + 1 < len(lines):
            fails("\n".join([*lines[:k], line + lines[k + 1], *lines[k + 2 :]]) + "\n")


def test_every_statement_is_in_the_page_and_no_other() -> None:
    page = (DOCS / "write-cl.md").read_text(encoding="utf-8")
    table = page.partition("## Statements")[2].partition("\n## ")[0]
    named = {
        each for row in re.findall(r"^\| (`.+?) \|", table, re.MULTILINE) for each in re.findall(r"`([^`]+)`", row)
    }
    majors = {re.split(r"[ ]*/", each.removeprefix("$$"))[0].replace(" ", "") for each in named}
    assert set(DIALECTS["trunnion"].handlers) <= majors
    minor = {"CCLW", "MIST", "THRU", "AIR", "TAP", "ON", "OFF", "MMPR", "IPM", "IPR", "TIMES,n", "RIGHT"}
    assert majors - minor == set(DIALECTS["trunnion"].handlers)
