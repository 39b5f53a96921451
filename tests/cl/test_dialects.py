"""Dialects of CL files: how they are told apart, and what is refused by name."""

import re
from collections.abc import Callable

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Fail, Read
from trunnion.cl.dialects import DIALECTS, recognize_dialect
from trunnion.cl.writers import WRITERS
from trunnion.dialect_names import READ_DIALECTS, WRITTEN_DIALECTS
from trunnion.model.toolpath import (
    Operation,
    UnknownStatement,
)


@pytest.mark.parametrize("dialect", HEADS)
def test_a_dialect_is_told_by_its_lines(dialect: str) -> None:
    found = recognize_dialect("\n".join(HEADS[dialect]).encode())
    assert found.dialect.name == dialect
    assert re.search(r" in line \d+$", str(found.why))


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("TOOL PATH/A,TOOL,B\n$$-> CSYS\nMSYS/0\n", "clsf"),
        ("GOTO/1,2,3\n", "clsf"),
        ("", "clsf"),
        ("PPRINT $$*CATIA0\nPPRINT/TOOL PATH/\nLOADTL/1\n", "apt"),
        ("REMARK -> MFGNO / A\nLOADTL/1\n", "ncl"),
        ("  $$*catia0\nLOADTL/1\n", "catia"),
        ("PARTNO A\r\nCYCLE / INIT\r\n", "solidworks"),
    ],
)
def test_marks_count_where_they_begin_a_line_that_is_no_text(text: str, dialect: str) -> None:
    assert recognize_dialect(text.encode()).dialect.name == dialect


def test_a_toolpath_says_what_it_was_read_as_and_why(read: Read) -> None:
    toolpath = read("$$-> MFGNO / A\nLOADTL / 1\nGOTO / 1, 2, 3\nFINI\n")
    assert (toolpath.dialect, toolpath.recognized) == ("ncl", "Creo NCL: $$-> in line 1")


def test_the_dialect_can_be_given(read: Read) -> None:
    text = "TLAXIS/0,1,0\nGOTO/1,2,3\nGOTO/1,2,3,1,0,0\nGOTO/1,2,4\nFINI\n"
    assert read(text, dialect="apt").operations[0].moves.axis[2].tolist() == [1, 0, 0]


def test_the_names_that_need_no_reader_are_those_of_the_registries() -> None:
    assert tuple(DIALECTS) == READ_DIALECTS
    assert tuple(WRITERS) == tuple(WRITTEN_DIALECTS)


@pytest.mark.parametrize("count", [9, 12])
def test_more_numbers_are_never_taken_for_tip_and_axis(refused: Callable[..., str], count: int) -> None:
    numbers = ",".join(["0"] * (count - 1) + ["1"])
    assert "compensation vector, or a contact point" in refused("catia", f"GOTO/{numbers}")
    assert f"GOTO has {count} numbers" in refused("apt", f"GOTO/{numbers}")


@pytest.mark.parametrize(("dialect", "mode"), [("catia", "NORMDS"), ("catia", "NORMPS"), ("apt", "ENDPT")])
def test_compensation_in_space_is_refused(refused: Callable[..., str], dialect: str, mode: str) -> None:
    assert "compensation in space" in refused(dialect, f"CUTCOM/{mode}", "GOTO/1,2,3,0,0,1")


def test_the_system_of_a_file_may_not_change(refused: Callable[..., str], read: Read) -> None:
    csys = "$$-> CSYS / 1,0,0,{},  $\n  0,1,0,0,  $\n 0,0,1,0"
    assert "coordinate system of the points changes" in refused("ncl", csys.format(0), csys.format(5))
    text = "\n".join([*HEADS["ncl"], csys.format(5), "GOTO / 1,2,3", csys.format(5), "GOTO / 1,2,4", "FINI"])
    assert read(text).system[3] == 5


def test_the_matrix_of_catia_is_read_in_its_lines(read: Read, refused: Callable[..., str]) -> None:
    matrix = ["$$*CATIA0", "$$ A", "$$ 1.0 0.0 0.0 -220.0", "$$ 0.0 1.0 0.0 0.0", "$$ 0.0 0.0 1.0 20.0"]
    text = "\n".join([*matrix, "LOADTL/1", "GOTO/1,2,3", "FINI"])
    assert read(text).system == (1, 0, 0, -220, 0, 1, 0, 0, 0, 0, 1, 20)
    assert "three lines of four numbers" in refused("catia", *matrix[:4], "$$ 0.0 0.0")


@pytest.mark.parametrize(
    ("statement", "what"),
    [
        ("ROTABL/ATANGL,90", "turns a rotary axis"),
        ("ROTATE/CAXIS,90", "turns a rotary axis"),
        ("TRANS/1,2,3", "TRANS/1,2,3 shifts or turns"),
        ("ORIGIN/0,0,5", "ORIGIN/0,0,5 shifts or turns"),
        ("COPY/1,TRANSL,1,2,3,4", "repeats, shifts or turns"),
        ("INDEX/1", "repeats, shifts or turns"),
        ("MACRO/A", "statement of an APT part program"),
        ("CALL/M1,A=5", "statement of an APT part program"),
        ("M1 = MACRO/A", "M1 is defined here"),
        ("P1 = POINT/1,2,3", "P1 is defined here"),
        ("LOOPST", "statement of an APT part program"),
        ("GORGT/L1,PAST,L2", "statement of an APT part program"),
        ("1009/ 73, 12", "the word is the number 1009"),
        ("5.0, 6.0, 7.0", "numbers without a word"),
        ("MODE/INCR,ON", "would count from each other"),
        ("MOVE/1,2,3", "MOVE is motion"),
        ("HELICAL/CENTER,0,0,0,INDIRV,0,1,0,AXIS,0,0,1,PITCH,1,RADIUS,5,ANGLE,90,END,0,5,1", "HELICAL is motion"),
        ("SCALE/2", "SCALE repeats, shifts or turns"),
        ("RETRCT", "without a clearance plane"),
        ("CLRSRF/YZPLAN,5", "not a plane of constant Z"),
    ],
)
def test_what_moves_and_is_not_understood_is_refused_by_name(
    refused: Callable[..., str], statement: str, what: str
) -> None:
    found = refused("apt", statement)
    assert what in found
    assert found.startswith("6: ")


@pytest.mark.parametrize("statement", ["TRANS/0,0,0", "ORIGIN/0,0", "TRANS/1,0,0,0,0,1,0,0,0,0,1,0"])
def test_a_shift_by_nothing_is_nothing(apt: Callable[..., Operation], statement: str) -> None:
    assert len(apt("apt", statement, "GOTO/1,2,3").moves) == 1


def test_an_unknown_statement_is_kept_with_its_line(apt: Callable[..., Operation], refused: Callable[..., str]) -> None:
    operation = apt("apt", "GOTO/1,2,3", "SHOPWD/4", "GOTO/1,2,4")
    (found,) = (event for event in operation.events if isinstance(event, UnknownStatement))
    assert (found.text, found.line, found.row) == ("SHOPWD/4", 6, 1)


def test_other_commands_of_creo_are_comments(read: Read, fails: Fail, refused: Callable[..., str]) -> None:
    text = "\n".join([*HEADS["ncl"], "$$-> SETSTART / 1", "GOTO / 1,2,3", "$$-> SETSTART / 2", "FINI"])
    toolpath = read(text)
    assert [(problem.line, "(2 times" in problem.what) for problem in toolpath.remarks] == [(5, True)]
    assert not any(isinstance(event, UnknownStatement) for event in toolpath.operations[0].events)
    assert len(fails(text, strict=True)) == 2
    assert "TRACUT repeats" in refused("ncl", "$$-> TRACUT / 1")


def test_an_alias_of_creo_may_put_commands_into_remarks(apt: Callable[..., Operation]) -> None:
    operation = apt("ncl", "REMARK -> FEATNO / 9", "REMARK -> CUTTER / 6.5", "REMARK any $ text", "GOTO / 1,2,3")
    assert (operation.name, operation.tool.diameter) == ("FEATNO 9", 6.5)


@pytest.mark.parametrize("dialect", [name for name in HEADS if name != "clsf"])
def test_no_beginning_of_a_file_is_taken_for_the_whole(read: Read, fails: Fail, dialect: str) -> None:
    lines = [*HEADS[dialect], "GOTO/1,2,3", "GOTO/1,2,35", "COOLNT/OFF"]
    text = "\n".join([*lines, "FINI"])
    assert len(read(text).operations[0].moves) == 2
    behind_last_motion = text.index("COOLNT/OFF")
    for length in range(text.index("GOTO") + 6, len(text)):
        assert fails(text[:length]), text[:length]
    (problem,) = fails(text[:behind_last_motion])
    assert "no FINI" in problem.what
    (problem,) = fails(text[: behind_last_motion - 2], dialect=dialect)
    assert f"in the middle of line {len(lines) - 1}" in problem.what


def test_motion_behind_the_end_needs_an_end_of_its_own(read: Read, fails: Fail) -> None:
    text = "\n".join([*HEADS["apt"], "GOTO/1,2,3", "FINI", "GOTO/1,2,4", ""])
    (problem,) = fails(text)
    assert "no FINI" in problem.what
    assert sum(len(operation.moves) for operation in read(text + "END\n").operations) == 2


def test_a_unit_other_than_that_of_the_file_is_warned_of(read: Read) -> None:
    text = "\n".join([*HEADS["apt"], "GOTO/1,2,3", "FINI", ""])
    (remark,) = read(text, units="inch").remarks
    assert remark.line == 2
    assert "states another length unit than inch" in remark.what
    assert read(text, units="mm").remarks == ()
