"""Tools of APT dialects."""

from collections.abc import Callable

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Read
from trunnion.model.toolpath import (
    LoadTool,
    Message,
    Operation,
)


def test_a_tool_has_the_form_of_its_cutter(apt: Callable[..., Operation]) -> None:
    mill = apt("apt", "GOTO/0,0,0", "CUTTER/12,2,4,2,0,3,55", "GOTO/1,2,3").tool
    assert (mill.kind, mill.diameter, mill.corner_radius, mill.taper_angle, mill.length) == ("MILL", 12, 2, 3, 55)
    drill = apt("apt", "GOTO/0,0,0", "CUTTER/12.,0,6.,3.605164,31.,0,63.", "GOTO/1,2,3").tool
    assert (drill.kind, drill.diameter, drill.tip_angle, drill.length) == ("DRILL", 12, 118, 63)


def test_a_tool_that_is_loaded_is_not_loaded_again(read: Read) -> None:
    lines = ["LOADTL/5,1", "GOTO/1,0,0", "LOADTL/5,1", "LOADTL/5", "GOTO/2,0,0", "LOADTL/6", "GOTO/3,0,0"]
    toolpath = read("\n".join([*HEADS["catia"], *lines, "FINI"]))
    assert [len(operation.moves) for operation in toolpath.operations] == [2, 1]
    loads = [[e for e in operation.events if isinstance(e, LoadTool)] for operation in toolpath.operations]
    assert [[(load.row, load.number, load.adjust) for load in each] for each in loads] == [[(0, 5, 1)], [(0, 6, 0)]]
    assert [operation.tool.diameter for operation in toolpath.operations] == [10, 0]


def test_a_tool_of_the_same_form_keeps_it(read: Read) -> None:
    lines = ["GOTO/1,0,0", "CUTTER/10,1", "LOADTL/6", "GOTO/2,0,0", "LOADTL/7", "CUTTER/10,1", "GOTO/3,0,0"]
    toolpath = read("\n".join([*HEADS["apt"], *lines, "FINI"]))
    assert [operation.tool.diameter for operation in toolpath.operations] == [10, 10, 10]


def test_another_tool_has_not_the_name_of_the_one_before(read: Read) -> None:
    lines = [
        "GOTO/1,0,0",
        "CUTTER/10,1,4,1,0,0,50",
        "LOADTL/6",
        "GOTO/2,0,0",
        "TPRINT/THIRD",
        "LOADTL/7",
        "GOTO/3,0,0",
    ]
    toolpath = read("\n".join([*HEADS["catia"], *lines, "FINI"]))
    assert [operation.tool.name for operation in toolpath.operations] == ["T5 End Mill", "", "THIRD"]


@pytest.mark.parametrize(
    ("statement", "adjust"),
    [("LOADTL/7,LENGTH,150.5,OSETNO,12", 12), ("LOADTL/7, 0, 80.5, 3", 3), ("LOAD/7", 0), ("LOADTL/7,2", 2)],
)
def test_forms_of_loadtl(apt: Callable[..., Operation], statement: str, adjust: int) -> None:
    operation = apt("apt", "GOTO/0,0,0", statement, "GOTO/1,0,0")
    assert [(e.number, e.adjust) for e in operation.events if isinstance(e, LoadTool)][-1] == (7, adjust)


def test_notes_of_solidworks_never_go_into_the_program_as_they_are(apt: Callable[..., Operation]) -> None:
    operation = apt("solidworks", "GOTO/1,2,3")
    assert operation.tool.name == "MILL"
    assert [event.text for event in operation.events if isinstance(event, Message)] == ["MILL"]
