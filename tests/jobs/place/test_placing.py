"""``trunnion.place``: its arguments, and what it answers to odd ones."""

from dataclasses import replace

import pytest

import trunnion

BLADE = "tests/golden/yl569/3_blade_finish.cls"


@pytest.mark.parametrize("turns", [0.0, float("nan"), -5.0, True, [], ["x"], [float("inf")], [[0.0]], b""])
def test_turns_that_are_none_are_refused(turns: object) -> None:
    with pytest.raises(trunnion.InputError) as told:
        trunnion.place(BLADE, machine="yl569", turns=turns)  # type: ignore[arg-type]
    assert [problem.code for problem in told.value.problems] == ["ARG140"]


@pytest.mark.parametrize("files", [[], b"x", 3, None])
def test_files_that_are_none_are_refused(files: object) -> None:
    with pytest.raises(trunnion.InputError):
        trunnion.place(files, machine="yl569")  # type: ignore[arg-type]


def test_goals_are_words() -> None:
    with pytest.raises(trunnion.InputError) as told:
        trunnion.place(BLADE, machine="yl569", goal="beauty")
    assert told.value.problems[0].code == "ARG140"


def test_a_tool_without_a_length_is_told_and_counts_as_nothing() -> None:
    unknown = trunnion.place(BLADE, machine="yl569", turns=[0.0])
    known = trunnion.place(BLADE, machine="yl569", turns=[0.0], tool_length=0.0)
    assert [problem.code for problem in unknown.problems] == ["PLC210"]
    assert known.problems == ()
    assert unknown.margin_mm == known.margin_mm


def test_a_slide_with_one_limit_or_none_leaves_the_region_open() -> None:
    machine = trunnion.load_machine("yl569")
    axes = tuple(
        replace(axis, low=float("-inf"), high={"X": float("inf"), "Z": 100.0}[axis.name]) if axis.name in "XZ" else axis
        for axis in machine.axes
    )
    contour = "tests/golden/yl569/1_contour_rough.cls"
    found = trunnion.place(contour, machine=replace(machine, axes=axes), turns=[0.0], tool_length=0.0)
    assert found.region is not None
    assert found.region.low.tolist() == [float("-inf"), pytest.approx(-98.352), float("-inf")]
    assert found.region.high.tolist() == [float("inf"), pytest.approx(98.352), pytest.approx(90.0)]
    assert found.region.volume == float("inf")
    assert found.margin_mm == pytest.approx(98.352)
    assert found.best is not None
    assert abs(found.best.zero_mm[0]) < 1.0  # nothing asks it to go anywhere


def test_the_present_place_is_that_of_the_definition_or_of_the_argument() -> None:
    machine = replace(trunnion.load_machine("yl569"), workpiece_zero=(5.0, 6.0, 7.0), tool_length=90.0)
    stated = trunnion.place(BLADE, machine=machine, turns=[10.0])
    given = trunnion.place(BLADE, machine=machine, turns=[10.0], zero=(1.0, 2.0, 3.0))
    assert stated.present is not None
    assert given.present is not None
    assert stated.present.zero_mm == (5.0, 6.0, 7.0)
    assert given.present.zero_mm == (1.0, 2.0, 3.0)
    assert stated.present.turn_deg == 0.0
    assert stated.margin_at((5.0, 6.0, 7.0), 0.0) == stated.present.margin_mm


def test_goals_have_values_that_are_no_worse_than_those_of_the_present_place() -> None:
    machine = replace(trunnion.load_machine("yl569"), workpiece_zero=(40.0, -30.0, 20.0), tool_length=90.0)
    for goal in ("slides", "time", "rotary", "overspeed"):
        found = trunnion.place(BLADE, machine=machine, goal=goal, turns=[0.0])
        assert found.best is not None
        assert found.present is not None
        assert found.best.value is not None
        assert found.present.value is not None
        assert found.best.value <= found.present.value * 1.001
        assert found.best.margin_mm >= 0.99
    assert found.seconds is None
    assert trunnion.place(BLADE, machine=machine, goal="time", turns=[0.0]).seconds == pytest.approx(16.2, abs=0.1)
