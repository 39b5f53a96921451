"""The way to the point where the first tool is changed, as CATIA writes it before that tool."""

import pytest

import trunnion
from tests.support.cl_reading import Read
from trunnion.model.toolpath import Kind, LoadTool, Toolpath

HEAD = ["$$ CATIA APT VERSION 1.0", "COOLNT/ON", "$$ OPERATION NAME : Tool Change.1", "TLAXIS/0,0,1"]
WAY = ["RAPID", "GOTO/0,0,100"]
TOOL = ["$$ TOOLCHANGEBEGINNING", "CUTTER/16,0,8,4.618802,30,0,50", "TPRINT/T1 Drill D 10", "LOADTL/1"]
DRILL = [
    "$$ OPERATION NAME : Drill.1",
    "LOADTL/1,1",
    "SPINDL/70,RPM,CLW",
    "RAPID",
    "GOTO/0,0,1",
    "FEDRAT/10,MMPM",
    "GOTO/0,0,-2",
]


def written(*lines: str) -> str:
    return "\n".join([*lines, "END"]) + "\n"


def loads(toolpath: Toolpath) -> list[list[int]]:
    """The rows at which tools are loaded, by operation."""
    return [[event.row for event in o.events if isinstance(event, LoadTool)] for o in toolpath.operations]


def test_the_way_is_done_with_the_first_tool(read: Read) -> None:
    toolpath = read(written(*HEAD, *WAY, *TOOL, *DRILL))
    (operation,) = toolpath.operations
    assert (operation.name, operation.tool.name) == ("Drill.1", "T1 Drill D 10")
    assert operation.moves.tip[:, 2].tolist() == [100, 1, -2]
    assert operation.moves.kind.tolist() == [Kind.RAPID, Kind.RAPID, Kind.LINEAR]
    assert loads(toolpath) == [[0]]
    (remark,) = toolpath.remarks
    assert (remark.line, remark.what) == (3, "the way before the first tool is done with tool 1, at rapid")
    assert trunnion.post(toolpath, machine="yl569", columns=False).passed


def test_its_first_point_needs_no_rapid(read: Read) -> None:
    (operation,) = read(written(*HEAD, WAY[1], *TOOL, *DRILL)).operations
    assert operation.moves.kind.tolist() == [Kind.RAPID, Kind.RAPID, Kind.LINEAR]


@pytest.mark.parametrize(
    "before",
    [
        ["FEDRAT/100,MMPM", "GOTO/0,0,100"],
        [*WAY, "GOTO/0,0,90"],
        [*WAY, "PPRINT HERE"],
        [*WAY, "GOHOME"],
        ["CYCLE/DRILL,5,1,100,MMPM", *WAY, "CYCLE/OFF"],
    ],
)
def test_a_cut_or_an_event_before_the_first_tool_is_not(read: Read, before: list[str]) -> None:
    toolpath = read(written(*HEAD, *before, *TOOL, *DRILL))
    assert loads(toolpath) == [[], [0]]


def test_the_way_to_a_later_change_is_done_with_the_tool_before(read: Read) -> None:
    second = [
        line.replace("T1 ", "T2 ").replace("LOADTL/1", "LOADTL/2").replace("CUTTER/16", "CUTTER/12") for line in TOOL
    ]
    toolpath = read(
        written(*HEAD, *TOOL, *DRILL, "$$ OPERATION NAME : Tool Change.2", *WAY, *second, "RAPID", "GOTO/5,0,1")
    )
    assert [operation.name for operation in toolpath.operations] == ["Drill.1", "Tool Change.2", "OPERATION 3"]
    assert loads(toolpath) == [[0], [], [0]]
