"""Cycles 220 and 221: the cycle before at all positions of a pattern, as the manuals place them."""

import math

import numpy as np
import pytest

from tests.support.klartext_cycles import BEFORE, DRILL, define
from tests.support.reading import Runner, close
from trunnion.arrays import Floats
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

HEIGHTS = {"Q200": 2.0, "Q203": 10.0, "Q204": 50.0}
CIRCLE = {"Q216": 50.0, "Q217": 40.0, "Q244": 80.0, "Q245": 30.0, "Q246": 390.0, "Q247": 0.0, "Q241": 8.0, **HEIGHTS}
LINES = {
    "Q225": 15.0, "Q226": 25.0, "Q237": 10.0, "Q238": 8.0, "Q242": 3.0, "Q243": 3.0, "Q224": 90.0, **HEIGHTS
}  # fmt: skip


def program(number: int, values: dict[str, float], **others: float) -> str:
    return BEFORE + define(200, **DRILL) + define(number, **{**values, "Q301": 1.0, **others}) + "M30\n"


def holes(run: Run) -> Floats:
    """Where the tool is deepest, once for each hole."""
    deep = run.tip[np.abs(run.tip[:, 2] + 5.0) < 1e-6][:, :2]
    return np.asarray(deep[np.append(True, np.abs(np.diff(deep, axis=0)).max(axis=1) > 1e-6)])


def at(*angles: float) -> list[tuple[float, float]]:
    return [(50.0 + 40.0 * math.cos(math.radians(a)), 40.0 + 40.0 * math.sin(math.radians(a))) for a in angles]


@pytest.mark.parametrize(
    ("values", "angles"),
    [
        ({}, [30 + 45 * k for k in range(8)]),
        ({"Q245": 0, "Q246": 90, "Q241": 4}, [0, 30, 60, 90]),
        ({"Q245": 90, "Q246": 0, "Q241": 3}, [90, 45, 0]),
        ({"Q247": -20, "Q241": 3}, [30, 10, -10]),
        ({"Q241": 1, "Q246": 30}, [30]),
    ],
)
def test_a_circle(values: dict[str, float], angles: list[float], run: Runner) -> None:
    found = run(program(220, CIRCLE, **values))
    assert not found.errors
    close(holes(found), at(*angles), atol=1e-9)


def test_lines_there_and_back(run: Runner) -> None:
    found = run(program(221, LINES))
    assert not found.errors
    there = [(x, y) for x, line in ((15, (25, 35, 45)), (7, (45, 35, 25)), (-1, (25, 35, 45))) for y in line]
    close(holes(found), there, atol=1e-9)


def test_the_way_from_hole_to_hole(run: Runner) -> None:
    """At the second clearance, or at the first one; behind the last hole the cycle ends as ever."""
    for which, height in ((1.0, 60.0), (0.0, 12.0)):
        found = run(program(221, LINES, Q301=which))
        lateral = np.abs(np.diff(found.tip[:, :2], axis=0)).max(axis=1) > 1e-6
        assert set(found.tip[1:][lateral][1:, 2].tolist()) == {height}
        assert set(found.kind[1:][lateral].tolist()) == {Kind.RAPID}
        close(found.tip[-1], [-1, 45, 60], atol=1e-9)


def test_a_tool_below_the_second_clearance_goes_up_first(run: Runner) -> None:
    text = program(220, CIRCLE).replace("Z+100 R0 FMAX M3", "Z+20 R0 FMAX M3")
    close(run(text).tip[1], [3, 4, 60])


def test_its_clearances_and_surface_hold_for_the_cycle_from_then_on(run: Runner) -> None:
    found = run(program(220, CIRCLE, Q203=0.0, Q241=1).replace("M30", "L X+0 Y+0 FMAX M99\nM30"))
    close(found.tip[found.tip[:, 2].argmin()], [*at(30)[0], -15], atol=1e-9)
    close(found.tip[-1], [0, 0, 50])


@pytest.mark.parametrize(
    ("number", "values", "what"),
    [
        (220, {"Q365": 1}, "Q365"),
        (220, {"Q301": 2}, "Q301"),
        (220, {"Q241": 0}, "a number of positions"),
        (220, {"Q241": 2.5}, "a number of positions"),
        (220, {"Q246": 30}, "do not place"),
        (221, {"Q242": 200, "Q243": 200}, "a number of positions"),
        (221, {"Q200": -2}, "below the surface"),
    ],
)
def test_a_pattern_that_is_not_followed_drills_nothing(
    number: int, values: dict[str, float], what: str, run: Runner
) -> None:
    found = run(program(number, CIRCLE if number == 220 else LINES, **values))
    assert what in found.errors[0].text
    assert len(found) == 1


def test_straight_on_from_place_to_place_is_a_value_of_the_circle(run: Runner) -> None:
    assert run(program(220, CIRCLE, Q365=0)).diagnostics == ()


def test_it_needs_a_cycle_with_which_the_manuals_combine_it(run: Runner) -> None:
    pattern = define(220, **CIRCLE, Q301=1.0)
    assert "before any was defined" in run(f"{BEFORE}{pattern}M30\n").errors[0].text
    other = define(241, Q200=2, Q201=-9, Q206=99, Q211=0, Q203=10, Q204=50, Q379=0, Q253=700, Q208=900)
    assert "cycle 241 is not combined" in run(f"{BEFORE}{other}{pattern}M30\n").errors[0].text
    lacking = define(220, **{name: value for name, value in CIRCLE.items() if name != "Q204"}, Q301=1.0)
    assert "has no Q204" in run(f"{BEFORE}{define(200, **DRILL)}{lacking}M30\n").errors[0].text


@pytest.mark.parametrize(
    ("number", "values", "what"),
    [
        (220, {"Q244": 0.0}, "has a Q244 that is not above 0"),
        (220, {"Q244": -80.0}, "has a Q244 that is not above 0"),
        (220, {"Q204": -1.0}, "has Q204=-1, which is below 0"),
        (221, {"Q237": 0.0}, "has Q237=0: positions in one place"),
        (221, {"Q238": 0.0}, "has Q238=0: positions in one place"),
    ],
)
def test_values_that_place_no_pattern_are_refused(
    number: int, values: dict[str, float], what: str, run: Runner
) -> None:
    found = run(program(number, CIRCLE if number == 220 else LINES, **values))
    assert [what in each.text for each in found.errors] == [True]


def test_the_way_along_a_circle_of_holes_is_no_foreign_value(run: Runner) -> None:
    assert run(program(220, CIRCLE, Q365=0.0)).diagnostics == ()
