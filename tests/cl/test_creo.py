"""What Creo's files have of their own: arcs in the form of APT, with TLON on a line of its own."""

import pytest

from tests.support.cl_reading import Fail, Read

HEAD = [
    "$$*  Pro/CLfile  Version Wildfire 5.0",
    "UNITS / MM",
    "LOADTL / 1",
    "$$-> CUTTER / 8.0",
    "FEDRAT / 300.0,  MMPM",
]
#: A quarter about (40, 160), clockwise; the direction is as long as the arc.
ARC = [
    "INDIRV / 0.0, 15.7079632679, 0.0",
    "TLON",
    "GOFWD / ( CIRCLE / 40.0, 160.0, 0.0,$",
    "10.0 ), $",
    "    ON, ( LINE / 40.0, 160.0, 0.0,$",
    "                 40.0, 170.0, 0.0 )",
]


def test_tlon_may_stand_on_a_line_of_its_own(read: Read) -> None:
    (operation,) = read("\n".join([*HEAD, "GOTO / 30,160,0", *ARC, "GOTO / 80,170,0", "FINI"])).operations
    assert operation.moves.tip.tolist() == [[30, 160, 0], [40, 170, 0], [80, 170, 0]]
    assert (operation.arcs.row.tolist(), operation.arcs.normal.tolist()) == ([1], [[0, 0, -1]])


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        (ARC[:2], "INDIRV without its arc"),
        ([ARC[0], "TLON/L1", *ARC[2:]], "TLON is a statement of an APT part program"),
        ([ARC[0], "TLLFT", *ARC[2:]], "TLLFT is a statement of an APT part program"),
    ],
)
def test_the_tool_beside_the_circle_and_a_lost_arc_are_refused(fails: Fail, lines: list[str], what: str) -> None:
    problems = fails("\n".join([*HEAD, "GOTO / 30,160,0", *lines, "GOTO / 80,170,0", "FINI"]))
    assert [problem.what[: len(what)] for problem in problems] == [what]
