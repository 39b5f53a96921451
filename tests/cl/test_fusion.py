"""APT exports of Autodesk Fusion and HSMWorks: what they can say, and what their posts are known to say wrongly."""

import pytest

from tests.support.cl_reading import Fail, Read
from trunnion.model.toolpath import LoadTool, Message

HEAD = ["MODE/MILL", "PARTNO/'1001'", "PPRINT/'1001'", "UNITS/MM"]
SECTION = ["PPRINT/'Contour (2)'", "CUTTER/10.0, 1.0, 0.0, 1.0, 0.0, 0.0, 30.0", "LOADTL/5, 0, 60.0, 5"]
SPINDLE = "SPINDL/9000.0, RPM, CLW"


def test_upright_operations_are_read(read: Read) -> None:
    motion = ["RAPID", "GOTO/5.0, 0.0, 9.0", "FEDRAT/800.0, MMPM", "GOTO/5.0, 0.0, 0.0"]
    arc = ["MOVARC/0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 5.0, ANGLE, 90.0", "GOTO/0.0, -5.0, 0.0"]
    text = "\n".join([*HEAD, "MULTAX/OFF", *SECTION, SPINDLE, *motion, *arc, *SECTION, SPINDLE, *motion, "END", "FINI"])
    toolpath = read(text)
    assert (toolpath.dialect, toolpath.part) == ("fusion", "1001")
    assert [len(operation.moves) for operation in toolpath.operations] == [3, 2]
    assert toolpath.operations[0].arcs.normal.tolist() == [[0, 0, -1]]
    events = [event for operation in toolpath.operations for event in operation.events]
    assert [(event.number, event.adjust) for event in events if isinstance(event, LoadTool)] == [(5, 5), (5, 5)]
    assert [event.text for event in events if isinstance(event, Message)] == ["1001", "Contour (2)", "Contour (2)"]
    assert ["tilted planes" in problem.what for problem in toolpath.remarks] == [True]


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        (["MULTAX/ON", *SECTION, "GOTO/1.0, 2.0, 3.0, 0.0, 0.6, 0.8"], "in the coordinates of a plane"),
        ([*SECTION, "SPINDL/OFF", "GOTO/1,2,3"], "ON to stop the spindle"),
        (["UNITS/MM", *SECTION, "GOTO/1,2,3", "UNITS/MM", *SECTION], "an old revision"),
        (["LOADTL/5, IN, 0, LENGTH, 60, OSETNO, 5", "GOTO/1,2,3"], "LOADTL with IN"),
        ([*SECTION, "CYCLE/DRILL, 12.0, MMPM, 80.0, 5.0", "GOTO/1,2,3"], "numbers without words"),
        (["MODE/TURN", *SECTION, "GOTO/1,2,3"], "turning is not read"),
    ],
)
def test_what_these_posts_leave_out_or_turn_round_is_refused(fails: Fail, lines: list[str], what: str) -> None:
    (problem,) = fails("\n".join([*HEAD[:3], *lines, "END", "FINI"]))
    assert what in problem.what


def test_an_arc_turns_by_its_angle(fails: Fail, read: Read) -> None:
    """Some revisions write the same normal for both senses: the angle tells."""
    arc = ["GOTO/5,0,0", "MOVARC/0,0,0,0,0,1,5,ANGLE,{}", "GOTO/0,-5,0", "FINI"]
    text = "\n".join(["PARTNO A", "UNITS/MM", "LOADTL/1", *arc])
    assert len(read(text.format("270")).operations[0].arcs.row) == 1
    (problem,) = fails(text.format("90"))
    assert (problem.line, problem.what) == (5, "the arc turns by 270.000 degrees about its normal, and not by 90.000")
