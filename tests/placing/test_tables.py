"""Stock on the table: numbers by hand on the table of the YL569, 700 by 420 mm around its zero."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import trunnion
from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.model.rotations import about_z
from trunnion.placing.region import TOLERANCE
from trunnion.placing.table_limits import KEPT, ClampingArea, Standing, TableLimits
from trunnion.placing.turns import has_room

#: Its tool axis is Z, and its tips go from X -60.941 to 51.648 and 51.648 to both sides in Y.
CONTOUR = "tests/golden/yl569/1_contour_rough.cls"

#: 200 mm along X and 100 mm along Y, from the zero on.
STOCK = "box:200,100,40"


def round_table(diameter: float, size: tuple[float, float] | None = None) -> Machine:
    """A YL569 with a round table."""
    machine = trunnion.load_machine("yl569")
    return replace(machine, facts=replace(machine.facts, table_size_mm=size, table_diameter_mm=diameter))


@pytest.mark.parametrize(
    ("turn", "low", "high"),
    [
        # The table leaves X -350 to 350 - 200 and Y -210 to 210 - 100, the travel X -189.059 to 198.352 and Y +-98.352.
        (0.0, (-189.059, -98.352), (150.0, 98.352)),
        # Corners at (0, 0), (-100, 0), (-100, 200), (0, 200): X -250 to 350, Y -210 to 10; the travel turns along.
        (90.0, (-198.352, -89.059), (198.352, 10.0)),
        # Backwards: (0, 0), (100, 0), (100, -200), (0, -200).
        (-90.0, (-198.352, -10.0), (198.352, 89.059)),
        (180.0, (-150.0, -98.352), (189.059, 98.352)),
    ],
)
def test_the_region_ends_at_the_edges_of_the_table(
    turn: float, low: tuple[float, float], high: tuple[float, float]
) -> None:
    found = trunnion.place(CONTOUR, machine="yl569", turns=[turn], tool_length=100.0, stock=STOCK)
    assert found.region is not None
    assert found.region.low[:2].tolist() == pytest.approx(low, abs=1e-5)
    assert found.region.high[:2].tolist() == pytest.approx(high, abs=1e-5)
    free = trunnion.place(CONTOUR, machine="yl569", turns=[turn], tool_length=100.0)
    assert free.region is not None
    assert free.region.low[2] == pytest.approx(found.region.low[2], abs=1e-6)
    assert free.region.volume > found.region.volume * 1.05
    assert free.best is not None
    assert free.best.table_mm is None


def test_turned_by_45_degrees_the_edge_holds_the_part() -> None:
    """Corners at (0, 0), (141.421, 141.421), (-70.711, 70.711), (70.711, 212.132): Y of the zero is -2.132 at most."""
    found = trunnion.place(CONTOUR, machine="yl569", turns=[45.0], tool_length=100.0, stock=STOCK)
    assert found.region is not None
    assert found.region.high[1] == pytest.approx(210.0 - 212.132, abs=1e-3)
    for zero, left in (
        ((0.0, -50.0, 0.0), 210.0 + 50.0 - 212.132),
        ((208.579 - 7.0, -190.0, 0.0), 7.0),  # 350 - 141.421
        ((-279.289 + 6.0, -60.0, 0.0), 6.0),  # 70.711 - 350
    ):
        limits = Standing(ClampingArea((0.0, 0.0), (700.0, 420.0)), corners_of_stock()).turned(about_z(45.0)).limits()
        assert limits.left(np.array(zero)) == pytest.approx(left, abs=1e-3)
    assert found.margin_at((0.0, 0.0, 0.0), 45.0) == pytest.approx(-2.132, abs=1e-3)  # beyond the table by that
    assert found.margin_at((0.0, -3.0, 0.0), 45.0) > 60.0


def corners_of_stock() -> Floats:
    return np.array([(x, y, z) for x in (0.0, 200.0) for y in (0.0, 100.0) for z in (0.0, 40.0)])


def test_a_long_stock_is_held_by_the_edge_which_is_named() -> None:
    """300 mm along X at 45 degrees: its far corner is 282.843 mm above the zero, so Y is -72.843 at most."""
    stock = "box:300,100,40"
    found = trunnion.place(CONTOUR, machine="yl569", turns=[45.0], tool_length=100.0, stock=stock)
    assert found.best is not None
    assert found.best.zero_mm[1] == pytest.approx(-72.843, abs=1e-3)
    assert found.best.table_mm == pytest.approx(0.0, abs=KEPT)
    assert [(limit.axis, limit.end, limit.limit_mm, limit.file, limit.line) for limit in found.limits][:1] == [
        ("table", "high Y", 210.0, "", 0)
    ]
    assert found.limits[1].axis == "Y"
    assert found.region is not None
    assert found.region.margin(np.array(found.zero_mm)) == pytest.approx(found.margin_mm, abs=1e-9)
    across = trunnion.place(CONTOUR, machine="yl569", turns=[90.0], tool_length=100.0, stock=stock)
    assert not across.fits  # Y would have to be -90 at most, and the travel ends at -89.059
    assert across.margin_mm == pytest.approx(89.059 - 90.0, abs=1e-3)
    both = trunnion.place(CONTOUR, machine="yl569", turns=[45.0, 90.0], tool_length=100.0, stock=stock)
    assert both.turn_deg == 45.0


def test_a_stock_that_is_larger_than_the_table_has_no_place() -> None:
    small = trunnion.place(CONTOUR, machine="yl569", turns=[0.0, 90.0], tool_length=100.0, stock="box:500,100,40")
    assert [(turn.margin_mm is None, turn.table_is_too_small) for turn in small.turns] == [(False, False), (True, True)]
    assert small.turns[1].obstacle == "seen from above it is 100.0 x 500.0 mm, and the table is 700 x 420 mm"
    none = trunnion.place(CONTOUR, machine="yl569", turns=[0.0, 90.0], tool_length=100.0, stock="box:701,100,40")
    assert not none.fits
    assert none.best is None
    assert none.region is None
    assert none.margin_at((0.0, 0.0, 0.0), 0.0) == -np.inf


def test_a_stock_as_large_as_the_table_has_one_place() -> None:
    stock = "box:700,420,40,-350,-210,0"
    found = trunnion.place(CONTOUR, machine="yl569", turns=[0.0], tool_length=100.0, stock=stock)
    assert found.best is not None
    assert found.best.zero_mm[:2] == pytest.approx((0.0, 0.0), abs=1e-6)
    assert found.margin_mm == pytest.approx(98.352, abs=1e-6)
    assert found.region is not None  # a line up Z, of which that place is told


def test_a_round_table_leaves_a_round_region() -> None:
    """Of a table of 300 mm a box of 200 by 100 about the zero is off where a corner is, (100, 50) from the zero."""
    stock = "box:200,100,40,-100,-50,0"
    found = trunnion.place(CONTOUR, machine=round_table(300.0), turns=[0.0], tool_length=100.0, stock=stock)
    assert found.region is not None
    x, y = np.sqrt(150.0**2 - 50.0**2) - 100.0, np.sqrt(150.0**2 - 100.0**2) - 50.0
    assert found.region.low[:2].tolist() == pytest.approx([-x, -y], abs=2.0 * TOLERANCE)
    assert found.region.high[:2].tolist() == pytest.approx([x, y], abs=2.0 * TOLERANCE)
    assert found.margin_at((x - 0.01, 0.0, 0.0), 0.0) > 0.0
    assert found.margin_at((x + 0.01, 0.0, 0.0), 0.0) < 0.0
    flat = round_table(300.0, (300.0, 110.0))  # flattened: 5 mm are left in Y
    found = trunnion.place(CONTOUR, machine=flat, turns=[0.0], tool_length=100.0, stock=stock)
    assert found.region is not None
    assert found.region.high[1] == pytest.approx(5.0, abs=1e-5)


def test_a_round_stock_counts_as_round_at_any_turn() -> None:
    for turn in (0.0, 17.0):
        found = trunnion.place(
            CONTOUR, machine=round_table(100.0), turns=[turn], tool_length=100.0, stock="cylinder:90,35"
        )
        assert found.region is not None
        assert found.region.high[0] == pytest.approx(5.0, abs=2.0 * TOLERANCE)


def test_the_table_is_where_its_definition_says() -> None:
    machine = trunnion.load_machine("yl569")
    facts = replace(machine.facts, table_centre_mm=(30.0, -20.0))
    moved = replace(machine, facts=facts)
    found = trunnion.place(CONTOUR, machine=moved, turns=[0.0], tool_length=100.0, stock=STOCK)
    assert found.region is not None
    assert found.region.high[:2].tolist() == pytest.approx([180.0, 90.0], abs=1e-5)
    shifted = replace(machine.axes[0], point=(30.0, -20.0, 0.0))  # without: it is about C
    under = replace(machine, axes=(shifted, *machine.axes[1:]))
    assert ClampingArea.of(under) == ClampingArea((30.0, -20.0), (700.0, 420.0), axis="C")
    head = trunnion.load_machine("generic_head_head_ca")
    assert ClampingArea.of(head) is None
    assert ClampingArea.of(replace(head, facts=facts)) == ClampingArea((30.0, -20.0), (700.0, 420.0))


def test_stock_without_a_stated_table_is_a_warning() -> None:
    found = trunnion.place(CONTOUR, machine="dmu65", turns=[0.0], tool_length=100.0, stock=STOCK)
    assert [problem.code for problem in found.remarks] == ["PLC260"]
    assert found.fits


@pytest.mark.parametrize("goal", ["slides", "time", "rotary"])
def test_other_goals_keep_the_table_too(goal: str) -> None:
    stock = "box:300,100,40"
    found = trunnion.place(CONTOUR, machine="yl569", turns=[45.0], tool_length=100.0, stock=stock, goal=goal)
    assert found.best is not None
    assert found.best.zero_mm[1] <= -72.843 + 2.0 * KEPT
    assert found.best.table_mm is not None
    assert found.best.table_mm >= -KEPT
    whole = "box:700,420,40,-350,-210,0"
    found = trunnion.place(CONTOUR, machine="yl569", turns=[0.0], tool_length=100.0, stock=whole, goal=goal)
    assert found.fits


def test_a_tilted_stock_stands_as_it_is_tilted() -> None:
    """A plate of 100 by 400 by 40 mm that stands on its edge covers 40 mm of Y, and is turned under the table's 420."""
    stock, blade = "box:100,430,40", "tests/golden/yl569/3_blade_finish.cls"
    flat = trunnion.place(blade, machine="yl569", turns=[0.0], tool_length=100.0, stock=stock)
    tilted = trunnion.place(blade, machine="yl569", turns=[0.0], tilts=[40.0], tool_length=100.0, stock=stock)
    assert flat.turns[0].table_is_too_small
    assert not tilted.turns[0].table_is_too_small  # 430 cos 40 + 40 sin 40 = 355.1


POINTS = st.lists(st.tuples(st.floats(-200, 200), st.floats(-200, 200)), min_size=1, max_size=9)
LENGTHS = st.one_of(st.none(), st.floats(50, 900))


@given(points=POINTS, width=LENGTHS, diameter=LENGTHS, zero=st.tuples(st.floats(-300, 300), st.floats(-300, 300)))
def test_half_spaces_say_the_same_as_the_points(
    points: list[tuple[float, float]], width: float | None, diameter: float | None, zero: tuple[float, float]
) -> None:
    """With the zero at a place every point is on the table, or an edge or the tangent there is violated."""
    centre = (20.0, -30.0)
    size = None if width is None else (width, 0.6 * width)
    area = ClampingArea(centre, size, diameter)
    limits = Standing(area, np.column_stack((points, np.zeros(len(points))))).limits()
    left = np.inf
    for x, y in points:
        across, up = x + zero[0] - centre[0], y + zero[1] - centre[1]
        left = min(left, np.inf if size is None else min(size[0] / 2.0 - abs(across), size[1] / 2.0 - abs(up)))
        left = min(left, np.inf if diameter is None else diameter / 2.0 - float(np.hypot(across, up)))
    place = np.array([*zero, 0.0])
    assert limits.left(place) == pytest.approx(left, abs=1e-9)
    rim = limits.rim_at(place)
    edges = [*limits.straight_edges(), *limits.rim_around(), *([] if rim is None else [rim])]
    spare = min((edge.bound - float(np.dot(edge.normal, zero)) for edge in edges), default=np.inf)
    assert spare == pytest.approx(left, abs=1e-9)
    if left >= 0.0:
        assert (size is None and diameter is None) or has_room(limits)


@given(
    points=st.lists(st.tuples(st.floats(-200, 200), st.floats(-200, 200)), min_size=1, max_size=6),
    share=st.floats(-1.0, 1.0),
)
def test_room_on_a_disc_is_that_of_the_least_circle_around_the_outline(
    points: list[tuple[float, float]], share: float
) -> None:
    """That circle is about the middle of two points or the centre through three: all of them are tried."""
    flat = np.array(points)
    least = min(float(np.hypot(*(flat - centre).T).max()) for centre in centres(flat))
    radius = least * (1.0 + share / 50.0)
    assume(abs(least - radius) > 1e-6)
    assert has_room(TableLimits(ClampingArea((7.0, 0.0), None, 2.0 * radius), flat)) == (least < radius)


def centres(points: Floats) -> list[Floats]:
    """The points, the middles of two, and the centres of circles through three."""
    found = [*points, *((a + b) / 2.0 for a in points for b in points)]
    for a in points:
        for b in points:
            for c in points:
                sides = np.array([b - a, c - a])
                if abs(np.linalg.det(sides)) > 1e-9:
                    found.append(a + np.linalg.solve(sides, 0.5 * (sides**2).sum(axis=1)))
    return found
