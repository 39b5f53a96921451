"""CAMWorks's own CL data: operations in the system of their setup, which ROTABL turns in the model."""

from collections.abc import Callable, Sequence

import pytest

import trunnion
from tests.support.cl_reading import Fail, Read
from trunnion.cl.dialects import recognize_dialect
from trunnion.model.toolpath import CycleOn, Kind

UPRIGHT = ((1.570796, "AAXIS"), (-0.0, "BAXIS"), (0.0, "CAXIS"))
POINTS = [
    "RAPID/ ",
    "GOTO/ -30.0,-15.0,25.0 ",
    "FEDRAT/ MMPM,100.0",
    "GOTO/ -30.0,-15.0,-1.0 ",
    "GOTO/ -20.0,-15.0,-1.0 ",
]
CYCLE = "CYCLE/ DRILL,G98,6.00161,PECKING,5.0,2.0,MMPM,1101.5,3.0,25.0 25.0 DWELL,0.000000 "


def operation(
    name: str, *lines: str, turns: Sequence[tuple[float, str]] = UPRIGHT, axis: str = "0.0,-1.0,0.0", back: bool = True
) -> list[str]:
    """An operation; it turns its setup back at its end, which some operations do not."""
    there = [f"ROTABL/ {angle:.6f},{about},TABLE,CCLW " for angle, about in turns]
    again = [f"ROTABL/ {-angle:.6f},{about},TABLE,CCLW " for angle, about in reversed(turns)] if back else []
    cutter = "CUTTER/ 20.0,0.0,10.0,0.0,0.0,0.0,100.0,"
    return [cutter, f"TLAXIS/ {axis} ", f"OPFEATSTART/{name}", *there, *lines, *again, f"OPFEATEND/{name}"]


def written(*operations: list[str]) -> str:
    lines = [line for each in operations for line in each]
    return "\n".join(["UNITS/ MM ", "BOX/ 0.0,1.5,0.0,90.0,3.0,55.0 ", *lines, "FINI ", ""])


def test_points_are_in_the_system_of_the_setup(read: Read) -> None:
    text = written(operation("Rough Mill1-Hole [Sub2]", *POINTS, back=False), operation("B", *POINTS))
    assert recognize_dialect(text.encode()).dialect.name == "clt"
    toolpath = read(text, strict=True)
    assert [each.name for each in toolpath.operations] == ["Rough Mill1-Hole [Sub2]", "B"]
    assert [each.tool.diameter for each in toolpath.operations] == [20, 20]
    for each in toolpath.operations:
        assert each.moves.tip.tolist() == [[-30, -15, 25], [-30, -15, -1], [-20, -15, -1]]
        assert each.moves.axis.tolist() == [[0, 0, 1]] * 3
    # Z of the setup is -Y of the model.
    assert toolpath.system == (1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0)


@pytest.mark.parametrize(
    ("turns", "axis", "system"),
    [
        (((0.0, "AAXIS"), (1.570796, "BAXIS"), (0.0, "CAXIS")), "1.0,0.0,0.0", (0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0)),
        (((0.0, "AAXIS"), (0.0, "BAXIS"), (1.570796, "CAXIS")), "0.0,0.0,1.0", (0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0)),
    ],
)
def test_each_axis_turns_by_the_right_hand_rule(
    read: Read, turns: Sequence[tuple[float, str]], axis: str, system: tuple[float, ...]
) -> None:
    assert read(written(operation("A", *POINTS, turns=turns, axis=axis))).system == system


@pytest.mark.parametrize(("sense", "k"), [("CLOCKWISE", -1), ("COUNTERCLOCKWISE", 1)])
def test_a_word_gives_the_sense_of_an_arc(read: Read, sense: str, k: int) -> None:
    arc = f"CIRCLE/ -25.0,-15.0,-1.0,0.0,0.0,1.0,5.0,{sense} "
    (found,) = read(written(operation("A", *POINTS, arc, "GOTO/ -30.0,-15.0,-1.0 "))).operations
    assert found.moves.kind.tolist()[-1] == Kind.ARC
    assert found.arcs.normal.tolist() == [[0, 0, k]]


def test_a_cycle_gives_its_pecks_and_heights(read: Read) -> None:
    lines = [*POINTS[:2], "CYCLE/ ON ", CYCLE, "GOTO/ -30.0,-15.0,-0.0 ", "CYCLE/ OFF "]
    (found,) = read(written(operation("Drill1", *lines)), strict=True).operations
    (cycle,) = (event for event in found.events if isinstance(event, CycleOn))
    assert cycle.mode == ("DRILL", "DEEP")
    assert dict(cycle.values) == {
        "FEDTO": (6.00161,), "MMPM": (1101.5,), "RAPTO": (3.0,), "RTRCTO": (25.0,), "STEP": (5.0, 3.0, 2.0),
    }  # fmt: skip


SIDE = (((0.0, "AAXIS"), (1.570796, "BAXIS"), (0.0, "CAXIS")), "1.0,0.0,0.0")


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (written(operation("A", *POINTS), operation("B", *POINTS, turns=SIDE[0], axis=SIDE[1])), "changes within"),
        (written(operation("A", *POINTS, axis="0.0,1.0,0.0")), "does not turn Z into the tool axis"),
        (written(operation("A", *POINTS, turns=[(0.5, "AAXIS"), (0.5, "BAXIS"), (0.0, "CAXIS")])), "several axes"),
        (written(operation("A", *POINTS, turns=())), "without ROTABL"),
        (written(operation("A", "ROTABL/ 90.0", *POINTS)), "ROTABL/90 is not known"),
        (written(operation("A", *POINTS, turns=UPRIGHT[::-1])), "A, B and C, in this order"),
        (written(operation("A", *POINTS, "CIRCLE/ ")), "is not known"),
        (written(operation("A", *POINTS, "GOTO/ 1.0,2.0,3.0,0.0,1.0,0.0 ")), "a tilted tool axis"),
        (written(operation("A", *POINTS, "CIRCLE/ 0.0,0.0,0.0,0.0,0.0,1.0,5.0,LEFT ")), "is not known"),
        (written(operation("A", CYCLE.replace("25.0 25.0", "25.0 24.0"), *POINTS)), "two heights"),
        (written(operation("A", CYCLE.replace("PECKING", "BORING"), *POINTS)), "is not known"),
        (written(operation("A", CYCLE.replace("3.0,25", "3.-0,25"), *POINTS)), "no number"),
    ],
)  # fmt: skip
def test_what_cannot_be_told_is_refused(fails: Fail, text: str, what: str) -> None:
    assert what in "\n".join(problem.what for problem in fails(text))


@pytest.fixture
def refused_post(read: Read) -> Callable[[str], str]:
    """Return a function that posts a text and gives back why that is refused."""

    def reader(text: str) -> str:
        with pytest.raises(trunnion.InputError) as caught:
            trunnion.post(read(text), machine="yl569", settings={"standing_spindle": "allowed"}, columns=False)
        return "\n".join(problem.what for problem in caught.value.problems)

    return reader


def test_it_cannot_be_posted_without_tool_numbers(refused_post: Callable[[str], str]) -> None:
    assert "has no LOAD/TOOL" in refused_post(written(operation("A", *POINTS)))
