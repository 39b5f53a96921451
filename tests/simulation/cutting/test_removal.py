"""Cutting: volumes against theory, five-axis motions against dense stamping, and what must not depend on chance."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.sweeps import block, bundle_volumes, cut_path, divided, path, ray_points, stamped_depth
from trunnion.arrays import Floats
from trunnion.simulation.cutting.removal import Cutter
from trunnion.simulation.stock.deviation import left_on, missing_from
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import BodySizes, ball, bull, flat

BODY: BodySizes = {"flute_length": 30.0, "length": 60.0}
CELLS = [1.0, 0.5, 0.3]


@pytest.mark.third
@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(
    ("shape", "section"),
    [
        (flat(10.0, **BODY), 50.0),
        (ball(10.0, **BODY), 12.5 * math.pi),
        (bull(10.0, 2.0, **BODY), 50.0 - 8.0 * (1.0 - math.pi / 4.0)),
    ],
    ids=["flat", "ball", "bull"],
)
def test_a_slot_has_the_volume_of_its_section(cell: float, shape: ToolShape, section: float) -> None:
    # The corner of the stock is the origin, and the slot's bottom and sides lie on cell planes for two of the cells.
    stock = block((0.0, -20.0, -10.0), (50.0, 20.0, 0.0), cell)
    before = bundle_volumes(stock)
    cut_path(stock, path([(-20.0, 0.0, -5.0), (70.0, 0.0, -5.0)]), shape, cell / 10)
    # A bundle sees the section as strips of one cell: what it may be wrong by is a cell at each edge that it sees.
    for was, now in zip(before, bundle_volumes(stock), strict=True):
        assert was - now == pytest.approx(50.0 * section, abs=50.0 * cell * 5.0)
    assert before[0] - stock.volume == pytest.approx(50.0 * section, abs=50.0 * 2.0 * cell)


@pytest.mark.parametrize("cell", CELLS)
def test_a_tilted_flat_stroke_leaves_planes(cell: float) -> None:
    # The tool leans by 30 degrees across its way: its bottom and its side leave a V of 90 degrees.
    lean = math.radians(30.0)
    axis = np.tile((0.0, math.sin(lean), math.cos(lean)), (2, 1))
    stock = block((-10.0, -20.0, -10.0), (10.0, 20.0, 0.0), cell)
    cut_path(stock, path([(-30.0, 0.0, -5.0), (30.0, 0.0, -5.0)], axis), flat(8.0, **BODY), cell / 10)
    points, material = ray_points(stock, 2, 7, 60)
    # In the section: below the bottom disc's plane, or outside the strip as wide as the tool, there is material.
    height = points[:, 1] * math.sin(lean) + (points[:, 2] + 5.0) * math.cos(lean)
    aside = np.abs(points[:, 1] * math.cos(lean) - (points[:, 2] + 5.0) * math.sin(lean))
    clear = (np.abs(height) > 0.05 * cell) & (np.abs(aside - 4.0) > 0.05 * cell)
    left = (height < 0.0) | (aside > 4.0)
    assert np.array_equal(np.array(material)[clear], left[clear])


@pytest.mark.parametrize("cell", CELLS)
def test_a_plunge_leaves_a_hole(cell: float) -> None:
    stock = block((-10.0, -10.0, -10.0), (10.0, 10.0, 0.0), cell)
    cut = cut_path(stock, path([(0.3, 0.2, 5.0), (0.3, 0.2, -7.0), (0.3, 0.2, 5.0)]), flat(8.0, **BODY), cell / 10)
    assert cut.removed[0] == pytest.approx(16.0 * math.pi * 7.0, abs=2.0 * math.pi * 8.0 * 7.0 * cell / 4.0)
    assert cut.removed[1] == 0.0


@st.composite
def leaning(draw: st.DrawFn) -> tuple[Floats, Floats]:
    """Tips and tool axes of a few motions that turn the tool by up to 3 degrees each."""
    values = st.floats(-1.0, 1.0)
    axis = np.array([draw(values), draw(values), draw(st.floats(0.8, 1.6))])
    tip = np.array([3.0 * draw(values), 3.0 * draw(values), -2.0 + 2.0 * draw(values)])
    tips, axes = [tip], [axis / np.linalg.norm(axis)]
    for _ in range(draw(st.integers(1, 3))):
        tip = tip + np.array([draw(values), draw(values), 0.4 * draw(values)]) * draw(st.sampled_from([0.2, 2.0, 8.0]))
        axis = axes[-1] + 0.03 * np.array([draw(values), draw(values), draw(values)])
        tips.append(tip)
        axes.append(axis / np.linalg.norm(axis))
    return np.array(tips), np.array(axes)


@settings(max_examples=examples(20))
@given(leaning(), st.sampled_from([flat(6.0, **BODY), ball(6.0, **BODY), bull(6.0, 1.0, **BODY)]))
def test_five_axis_strokes_are_as_dense_stamping_has_them(motions: tuple[Floats, Floats], shape: ToolShape) -> None:
    stock = block((-6.0, -6.0, -6.0), (6.0, 6.0, 0.0), 0.9)
    sweeps = path(*divided(*motions, 8))
    cut_path(stock, sweeps, shape, 0.002)
    for bundle in range(3):
        points, material = ray_points(stock, bundle, 5, 15)
        depth = stamped_depth(points, sweeps, shape, 25)
        left = np.array(material)
        assert not (left & (depth > 0.01)).any(), "material where the tool has been"
        assert not (~left & (depth < -0.15)).any(), "no material where the tool has not been"


def test_a_path_that_is_retraced_cuts_nothing_more() -> None:
    angle = np.linspace(0.0, 2.0, 30)
    tips = np.column_stack((12.0 * np.cos(angle), 12.0 * np.sin(angle), -3.0 - angle))
    axes = np.column_stack((0.3 * np.cos(3.0 * angle), 0.3 * np.sin(2.0 * angle), np.ones(30)))
    stock = block((-16.0, -16.0, -10.0), (16.0, 16.0, 0.0), 0.5)
    there, back = path(tips, axes), path(tips[::-1].copy(), axes[::-1].copy())
    shape = ball(6.0, **BODY)
    first = cut_path(stock, there, shape)
    again = cut_path(stock, back, shape)
    assert first.removed.sum() > 100.0
    assert again.removed.sum() < 1e-5 * first.removed.sum()


def test_the_result_does_not_depend_on_the_number_of_threads() -> None:
    angle = np.linspace(0.0, 9.0, 120)
    tips = np.column_stack((30.0 * np.cos(angle), 30.0 * np.sin(angle), -0.5 * angle))
    axes = np.column_stack((0.4 * np.cos(angle), 0.3 * np.sin(angle), np.ones(120)))
    stocks = [block((-40.0, -40.0, -10.0), (40.0, 40.0, 0.0), 0.5) for _ in range(2)]
    cuts = [cut_path(stock, path(tips, axes), bull(8.0, 1.0, **BODY), 0.05, k + 1) for k, stock in enumerate(stocks)]
    assert np.array_equal(cuts[0].removed, cuts[1].removed)
    for one, two in zip(stocks[0].tiles, stocks[1].tiles, strict=True):
        assert np.array_equal(one.count, two.count)
        assert np.array_equal(one.ends, two.ends)
        assert np.array_equal(one.rows, two.rows)


def test_the_part_that_is_done_is_told_tile_by_tile() -> None:
    stock, told = block((-40.0, -40.0, -10.0), (40.0, 40.0, 0.0), 0.5), list[float]()
    pieces, _ = revolved_pieces(ball(6.0, **BODY), 0.01)
    with ThreadPoolExecutor(2) as executor:
        sweeps = path([(-50.0, 0.0, -2.0), (50.0, 0.0, -2.0)])
        assert list(Cutter(stock, None, 0.05).measure(sweeps, pieces, executor, advance=told.append))
    assert told == sorted(told)
    assert len(told) > 4
    assert told[0] < 0.5
    assert told[-1] == 1.0


def test_a_comb_of_many_slots_needs_more_room_and_gets_it() -> None:
    stock = block((0.0, 0.0, -5.2), (40.0, 8.0, 0.0), 0.4)
    start, removed = stock.volume, 0.0
    for k in range(12):
        cut = cut_path(stock, path([(2.0 + 3.2 * k, -5.0, -3.2), (2.0 + 3.2 * k, 15.0, -3.2)]), flat(1.6, **BODY), 0.05)
        removed += float(cut.removed.sum())
    assert max(int(tile.count.max()) for tile in stock.tiles) == 13
    assert removed == pytest.approx(start - stock.volume, rel=1e-9)
    assert stock.volume == pytest.approx(40.0 * 8.0 * 5.2 - 12 * 1.6 * 3.2 * 8.0, rel=1e-6)


def test_the_shank_that_meets_stock_is_measured_and_cuts_nothing() -> None:
    stock = block((-20.0, 0.0, -20.0), (20.0, 20.0, 0.0), 0.5)
    shape = flat(6.0, flute_length=5.0, length=40.0, shank_diameter=10.0)
    cut = cut_path(stock, path([(-30.0, -2.0, -10.0), (30.0, -2.0, -10.0)]), shape)
    (met,) = cut.met.values()
    assert met.depth[0] == pytest.approx(3.0, abs=0.01)  # the shank's radius of 5, less 2 beside the stock
    assert cut.removed[0] == pytest.approx(40.0 * (3.0 - 2.0) * 5.0, rel=0.05)


def test_idle_motions_meet_what_was_there_before_the_first_of_them() -> None:
    tips = [(-30.0 + 0.05 * k, 0.0, -4.0) for k in range(1200)]
    whole, divided = path([tips[0], tips[-1]]), path(tips)
    for sweeps in (whole, divided):
        stock = block((-10.0, -10.0, -10.0), (10.0, 10.0, 0.0), 0.5)
        cut = cut_path(stock, sweeps, flat(6.0, **BODY), idle=True)
        assert cut.idle.depth.max() == pytest.approx(4.0)
        assert cut.removed.sum() == pytest.approx(20.0 * 6.0 * 4.0, rel=1e-3)
        assert cut_path(stock, sweeps, flat(6.0, **BODY), idle=True).idle.depth.max() < 1e-3


def test_what_is_missing_from_the_design_is_found_with_the_row_that_took_it() -> None:
    design = block((-10.0, -10.0, -10.0), (10.0, 10.0, 0.0), 0.5)
    cut_path(design, path([(-30.0, 0.0, -4.0), (30.0, 0.0, -4.0)]), flat(6.0, **BODY))
    wanted = design.spans(0), design.spans(1), design.spans(2)
    stock = block((-10.0, -10.0, -10.0), (10.0, 10.0, 0.0), 0.5)
    start = stock.spans(0), stock.spans(1), stock.spans(2)
    # The second of three motions is 0.3 mm too deep.
    tips = [
        (-30.0, 0.0, -4.0),
        (-3.0, 0.0, -4.0),
        (-3.0, 0.0, -4.3),
        (3.0, 0.0, -4.3),
        (3.0, 0.0, -4.0),
        (30.0, 0.0, -4.0),
    ]
    cut = cut_path(stock, path(tips), flat(6.0, **BODY), cutter=Cutter(stock, wanted, 0.01))
    gouge, rows = missing_from(stock, start, wanted, 0.05)
    assert gouge.largest == pytest.approx(0.3)
    assert set(rows.row.tolist()) == {1, 2}
    assert rows.thickness.max() == pytest.approx(0.3)
    # Thinner than a cell: rays along it count it as a whole one or not at all.
    assert cut.gouged.sum() == pytest.approx(0.3 * 6.0 * 9.0, abs=0.5 * 6.0 * 12.0)
    assert left_on(stock, wanted, 0.05).largest <= 0.01
