"""The machining axis systems of CATIA: $$*CATIA0, whose columns are X, Y, Z and origin in the model."""

import pytest

from tests.support.cl_reading import Read
from trunnion.errors import TrunnionError
from trunnion.model.frames import into_frame
from trunnion.model.toolpath import Frame, Toolpath

FIRST = ["1 0 0 0", "0 1 0 0", "0 0 1 0"]
HEAD = ["$$ CATIA APT VERSION 1.0", "LOADTL/1", "SPINDL/1000,RPM,CLW", "FEDRAT/100,MMPM"]
PATH = ["TLAXIS/0,0,1", "GOTO/-40,-30,20", "GOTO/-40,30,20"]
CHANGES = "the machining axis system changes"


def system(rows: list[str], name: str = "A") -> list[str]:
    return ["$$*CATIA0", f"$$ {name}", *(f"$$ {row}" for row in rows)]


def written(*lines: str) -> str:
    return "\n".join([*HEAD, *lines, "FINI"]) + "\n"


def in_first(toolpath: Toolpath) -> list[list[float]]:
    """Points of the second operation in the system of the first one, followed by its first tool axis."""
    first, second = toolpath.operations
    turned = into_frame(second, first.frame)
    return [*turned.moves.tip.round(9).tolist(), turned.moves.axis[0].round(9).tolist()]


def test_the_example_of_the_help_is_one_path(read: Read) -> None:
    """AXS2 lies 20 mm above AXS1, and its points are 20 mm lower: the tool goes the same way again."""
    raised = ["1 0 0 0", "0 1 0 0", "0 0 1 20"]
    path = ["TLAXIS/0,0,1", "RAPID", "GOTO/-40,-30,0", "GOTO/-40,30,0"]
    toolpath = read(written(*system(FIRST), *PATH, *system(raised), *path))
    assert in_first(toolpath) == [[-40, -30, 20], [-40, 30, 20], [0, 0, 1]]
    assert toolpath.operations[1].frame == Frame((0, 0, 20))
    (remark,) = toolpath.remarks
    assert remark.what.startswith(CHANGES)
    assert remark.line == 17


def test_columns_are_the_axes(read: Read) -> None:
    """X of the second system is Y of the model, its Y is Z, its Z is X."""
    turned = ["0 0 1 100", "1 0 0 5", "0 1 0 0"]
    toolpath = read(written(*system(FIRST), *PATH, *system(turned), "TLAXIS/0,0,1", "RAPID", "GOTO/1,2,30"))
    assert in_first(toolpath) == [[130, 6, 2], [1, 0, 0]]


def test_the_first_system_may_be_turned_itself(read: Read) -> None:
    turned, raised = ["0 0 1 100", "1 0 0 5", "0 1 0 0"], ["0 0 1 110", "1 0 0 5", "0 1 0 0"]
    toolpath = read(written(*system(turned), *PATH, *system(raised), "TLAXIS/0,0,1", "RAPID", "GOTO/1,2,3"))
    assert toolpath.operations[0].frame == Frame()
    assert in_first(toolpath) == [[1, 2, 13], [0, 0, 1]]


def test_going_back_to_the_first_system_is_exact(read: Read) -> None:
    back = [*system(["0 0 1 9", "1 0 0 5", "0 1 0 0"]), "TLAXIS/0,0,1", "RAPID", "GOTO/1,2,3", *system(FIRST)]
    toolpath = read(written(*system(FIRST), *PATH, *back, "TLAXIS/0,0,1", "RAPID", "GOTO/7,8,9"))
    assert [operation.frame == Frame() for operation in toolpath.operations] == [True, False, True]


def test_the_same_system_again_is_nothing(read: Read) -> None:
    toolpath = read(written(*system(FIRST), *PATH, *system(FIRST, "B"), "GOTO/1,2,3"))
    assert (len(toolpath.operations), toolpath.remarks) == (1, ())


def test_an_operation_after_the_change_keeps_the_system(read: Read) -> None:
    raised = ["1 0 0 0", "0 1 0 0", "0 0 1 20"]
    cut = ["TLAXIS/0,0,1", "RAPID", "GOTO/1,2,3"]
    named = ["$$ OPERATION NAME : B", "RAPID", "GOTO/4,5,6"]
    toolpath = read(written(*system(FIRST), *PATH, *system(raised), *cut, *named))
    assert [operation.frame.origin[2] for operation in toolpath.operations] == [0, 20, 20]


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        (["GOTO/1,2,3"], "a point without a tool axis"),
        (["GODLTA/1,2,3"], "GODLTA without a point to go from"),
        (["TLAXIS/0,0,1", "RETRCT"], "RETRCT"),
    ],
)
def test_nothing_said_in_the_coordinates_before_holds_on(read: Read, lines: list[str], what: str) -> None:
    raised = ["1 0 0 0", "0 1 0 0", "0 0 1 20"]
    with pytest.raises(TrunnionError, match=what):
        read(written(*system(FIRST), "CLEARP/XYPLAN,50", *PATH, *system(raised), *lines))


@pytest.mark.parametrize(
    "rows",
    [
        ["0 1 0 0", "1 0 0 0", "0 0 1 0"],
        ["1 0 0 0", "0 2 0 0", "0 0 1 0"],
        ["1 0.1 0 0", "0 1 0 0", "0 0 1 0"],
        ["1 0 0 nan", "0 1 0 0", "0 0 1 0"],
        ["1 0 0 inf", "0 1 0 0", "0 0 1 0"],
        ["1 0 0 1e200", "0 1 0 0", "0 0 1 0"],
        ["1e200 0 0 0", "0 1 0 0", "0 0 1 0"],
    ],
)
def test_what_is_no_system_is_refused(read: Read, rows: list[str]) -> None:
    with pytest.raises(TrunnionError, match="not square, is left-handed or nowhere near"):
        read(written(*system(FIRST), *PATH, *system(rows), *PATH))


def test_a_system_within_a_cycle_is_refused(read: Read) -> None:
    raised = ["1 0 0 0", "0 1 0 0", "0 0 1 20"]
    hole = ["CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2", "GOTO/1,2,3"]
    with pytest.raises(TrunnionError, match="within a cycle or an arc"):
        read(written(*system(FIRST), *PATH, *hole, *system(raised), "GOTO/4,5,6", "CYCLE/OFF"))


TABLE = ["$$*CATIA0", "$$ PPTABLE / STD-MM.pptable", "$$ Company Name"]


def test_a_table_of_words_may_leave_the_matrix_out(read: Read) -> None:
    toolpath = read(written(*TABLE, "$$ 1 0 0", *PATH))
    assert toolpath.system == ()
    assert toolpath.operations[0].moves.tip.tolist() == [[-40, -30, 20], [-40, 30, 20]]


@pytest.mark.parametrize("before", [system(FIRST), PATH])
def test_a_system_behind_points_needs_its_matrix(read: Read, before: list[str]) -> None:
    with pytest.raises(TrunnionError, match="without its matrix"):
        read(written(*before, *TABLE, *PATH))


@pytest.mark.parametrize("lost", [2, 3, 4])
@pytest.mark.parametrize("following", ["MULTAX", "$$ OPERATION NAME : B", "GOTO/1,2,3", "$$ NOTE"])
def test_a_system_that_has_lost_a_line_is_refused(read: Read, lost: int, following: str) -> None:
    for before in ([*system(FIRST), *PATH], []):
        lines = system(FIRST)
        del lines[lost]
        with pytest.raises(TrunnionError, match="not followed by an identifier and three lines of four numbers"):
            read(written(*before, *lines, following, *PATH))


def test_a_system_without_its_identifier_or_at_the_end_is_refused(read: Read) -> None:
    for lines in (
        ["$$*CATIA0", *system(FIRST)[2:], *PATH],
        [*PATH, "GOTO/1,2,3", "FINI", "$$*CATIA0", "$$ A", "$$ 1 0 0 0"],
    ):
        with pytest.raises(TrunnionError, match="not followed by an identifier and three lines of four numbers"):
            read(written(*lines))
    with pytest.raises(TrunnionError, match=r"only \$\$\*CATIA0 is known"):
        read(written("$$*CATIA1", *system(FIRST)[1:], *PATH))


def test_a_system_behind_points_without_one_is_refused(read: Read) -> None:
    for before in (PATH, [*TABLE, *PATH]):
        with pytest.raises(TrunnionError, match="behind points whose machining axis system nothing states"):
            read(written(*before, *system(FIRST), *PATH))


def test_a_row_of_a_system_has_four_numbers(read: Read) -> None:
    with pytest.raises(TrunnionError, match="three lines of four numbers"):
        read(written(*system(["1 0 0", "0 0 1 0", "0 0 0 1 0"]), *PATH))
