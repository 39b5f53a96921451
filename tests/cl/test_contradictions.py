"""What is true of a whole operation is stated once: another statement of it is refused, the same one is not."""

import pytest

from tests.support.cl_reading import Body, Fail, Read
from trunnion.model.toolpath import LoadTool

APT = ["PARTNO A", "UNITS/MM", "CUTTER/10,1", "LOADTL/5,2", "INTOL/0.01"]
CATIA = ["$$ CATIA APT VERSION 1.0", "CUTTER/10", "TOOLNO/5,10", "TPRINT/T5", "LOADTL/5", "LOADTL/5,1"]
NCL = ["$$* Pro/CLfile Version 8.0", "UNITS / MM", "LOADTL / 5", "$$-> CUTTER / 10.0"]
SOLIDWORKS = ["PARTNO/1", "INSERT/MILL", "CUTTER/10.,0,5.,0,0,0,60.", "CSI_SET_FLUTE_LENGTH/30", "LOAD/TOOL,5"]
CSYS = "CSYS/1,0,0,0,0,1,0,0,0,0,1,0"


@pytest.mark.parametrize(
    ("one", "other", "what"),
    [
        ("TLDATA/MILL,10,1,50,0,0", "TLDATA/MILL,8,1,50,0,0", "another tool than in line 2"),
        ("TLDATA/MILL,10,1,50,0,0", "CUTTER/8", "another diameter of the tool than in line 2"),
        ("MSYS/0,0,0,1,0,0,0,1,0", "MSYS/0,0,50,1,0,0,0,1,0", "another coordinate system than in line 3"),
        ("LOAD/TOOL,3", "LOAD/TOOL,4", "another number of the tool than in line 3"),
        ("LOAD/TOOL,3,ADJUST,5", "LOAD/TOOL,3,ADJUST,6", "another length register than in line 3"),
        ("INTOL/0.01", "INTOL/0.02", "another inner tolerance than in line 3"),
        ("OUTTOL/0.01", "OUTTOL/0.02", "another outer tolerance than in line 3"),
        ("FROM/0,0,50", "FROM/0,0,80", "FROM is another point than in line 3"),
    ],
)
def test_an_nx_operation_states_its_data_once(body: Body, body_fails: Fail, one: str, other: str, what: str) -> None:
    body(one, one, "GOTO/0,0,0")
    (problem,) = body_fails(one, other, "GOTO/0,0,0")
    assert problem.line == 4
    assert what in problem.what


def test_a_tool_is_not_stated_otherwise_behind_the_motion(body: Body, body_fails: Fail) -> None:
    same = "TLDATA/MILL,10.0,1.0,50.0,0.0,0.0"
    assert len(body("GOTO/0,0,0", same, "GOTO/1,0,0").moves) == 2
    (problem,) = body_fails("SPINDL/SMM,100", "GOTO/0,0,0", "TLDATA/MILL,8,1,50,0,0", "GOTO/1,0,0")
    assert (problem.line, problem.what) == (5, "another tool than in line 2: an operation has one")


@pytest.mark.parametrize(
    ("head", "other", "what"),
    [
        (APT, "CUTTER/8,1", "another tool than in line 3"),
        (APT, "LOADTL/6", "another number of the tool than in line 4"),
        (APT, "LOADTL/5,3", "another length register than in line 4"),
        (APT, "INTOL/0.1", "another inner tolerance than in line 5"),
        ([*APT, "LOADTL/5,LENGTH,80"], "LOADTL/5,LENGTH,90", "another length of the tool in the spindle"),
        (CATIA, "TPRINT/T6", "another name of the tool than in line 4"),
        (CATIA, "TOOLNO/6,10", "another number of the tool than in line 3"),
        (CATIA, "LOADTL/6", "another number of the tool than in line 3"),
        (NCL, "$$-> CUTTER / 12.0", "another tool than in line 4"),
        (SOLIDWORKS, "CSI_SET_FLUTE_LENGTH/20", "another flute length than in line 4"),
        ([*SOLIDWORKS, CSYS], "CSYS/1,0,0,0,0,0,-1,0,0,1,0,0", "another coordinate system than in line 6"),
    ],
)
def test_an_operation_of_apt_states_its_data_once(
    read: Read, fails: Fail, head: list[str], other: str, what: str
) -> None:
    cut = ["RAPID", "GOTO/0,0,50", "GOTO/0,0,0", "FINI"]
    assert len(read("\n".join([*head, *head[2:], *cut])).operations) == 1
    (problem,) = fails("\n".join([*head, other, *cut]))
    assert problem.line == len(head) + 1
    assert what in problem.what


def test_another_tolerance_begins_an_operation_in_apt(read: Read) -> None:
    cuts = ["RAPID", "GOTO/0,0,50", "GOTO/0,0,0"]
    first, second = read("\n".join([*APT, *cuts, "INTOL/0.1", "OUTTOL/0.1", *cuts, "FINI"])).operations
    assert (first.intol, first.outtol, second.intol, second.outtol) == (0.01, None, 0.1, 0.1)
    (joined,) = read("\n".join([*APT, *cuts, "INTOL/0.1", "GOTO/9,0,0", "FINI"])).operations
    assert (joined.intol, len(joined.moves)) == (0.01, 3)


def test_a_tool_number_that_nothing_loads_is_refused(fails: Fail) -> None:
    lines = [*CATIA, "RAPID", "GOTO/0,0,9", "TOOLNO/6,8", "RAPID", "GOTO/0,0,9", "FINI"]
    (problem,) = fails("\n".join(lines))
    assert (problem.line, problem.what) == (9, "tool 6 is stated and not loaded: tool 5 is in the spindle")


def test_a_tool_change_without_motion_is_left_out(read: Read) -> None:
    lines = ["$$ OPERATION NAME : B", "CUTTER/8", "TPRINT/T6", "LOADTL/6", "RAPID", "GOTO/0,0,9", "FINI"]
    toolpath = read("\n".join([*CATIA, *lines]))
    (operation,) = toolpath.operations
    assert [event.number for event in operation.events if isinstance(event, LoadTool)] == [6]
    assert (operation.tool.name, operation.tool.diameter) == ("T6", 8)
    assert "tool 5 is loaded and does nothing before tool 6" in toolpath.remarks[0].what


def test_a_tool_before_an_nx_operation_is_left_out_if_that_loads_another(read: Read) -> None:
    toolpath = read("LOAD/TOOL,9\nTOOL PATH/A,TOOL,T\nLOAD/TOOL,1\nGOTO/0,0,9\nEND-OF-PATH\n")
    assert [event.number for event in toolpath.operations[0].events if isinstance(event, LoadTool)] == [1]
    assert "tool 9 is loaded and does nothing before tool 1" in toolpath.remarks[0].what


def test_a_tool_that_is_named_anew_keeps_its_number(read: Read) -> None:
    lines = ["RAPID", "GOTO/0,0,9", "$$ OPERATION NAME : B", "TPRINT/T5 SHARP", "LOADTL/5", "RAPID", "GOTO/1,0,9"]
    first, second = read("\n".join([*CATIA, *lines, "FINI"])).operations
    loads = [event for operation in (first, second) for event in operation.events if isinstance(event, LoadTool)]
    assert [(load.row, load.number, load.adjust) for load in loads] == [(0, 5, 1), (0, 5, 1)]
    assert (first.tool.name, second.tool.name) == ("T5", "T5 SHARP")
