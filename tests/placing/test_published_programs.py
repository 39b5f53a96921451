"""The programs that ran on the YL569: where their part may sit, with numbers read from the files by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.yl569_curves import curves, tips_and_angles
from trunnion.model.clamped_toolpaths import turned_toolpaths

FOLDER = Path("tests/golden/yl569")
CONTOUR, HUB, BLADE = (FOLDER / f"{name}.cls" for name in ("1_contour_rough", "2_hub_rough", "3_blade_finish"))

#: Extents of the tip in the contouring file, whose tool axis is Z: lines 132 and 142, and the full circle of line 141
#: with a radius of 51.648 mm about the zero.
X, Y, Z = (-60.941, 51.648), (-51.648, 51.648), (-21.781, 10.0)


def test_a_path_in_three_axes_may_sit_in_the_box_that_its_extents_leave() -> None:
    """Travel is 250, 150 and 250 mm to each side; the table stands, so slides go where tip and zero add up to."""
    found = trunnion.place(CONTOUR, machine="yl569", turns=[0.0], tool_length=0.0)
    assert found.region is not None
    assert found.region.low.tolist() == pytest.approx([-250.0 - X[0], -150.0 - Y[0], -250.0 - Z[0]], abs=1e-6)
    assert found.region.high.tolist() == pytest.approx([250.0 - X[1], 150.0 - Y[1], 250.0 - Z[1]], abs=1e-6)
    sides = (500.0 - (X[1] - X[0])) * (300.0 - (Y[1] - Y[0])) * (500.0 - (Z[1] - Z[0]))
    assert found.region.volume == pytest.approx(sides, rel=1e-9)
    assert found.margin_mm == pytest.approx(150.0 - 51.648, abs=1e-6)
    # The other slides are in the middle of their travel.
    assert found.zero_mm == pytest.approx((-(X[0] + X[1]) / 2.0, 0.0, -(Z[0] + Z[1]) / 2.0), abs=2e-3)
    assert {(limit.axis, limit.limit_mm, limit.line) for limit in found.limits} == {
        ("Y", -150.0, 142),
        ("Y", 150.0, 142),
    }


def test_a_longer_tool_lowers_the_region_by_its_length() -> None:
    found = trunnion.place(CONTOUR, machine="yl569", turns=[0.0], tool_length=120.5)
    assert found.region is not None
    assert found.region.low[2] == pytest.approx(-250.0 - Z[0] - 120.5, abs=1e-6)
    assert found.region.high[2] == pytest.approx(250.0 - Z[1] - 120.5, abs=1e-6)


def test_turned_by_a_quarter_the_box_is_turned_too() -> None:
    """The table stands at C 0 with the tool along Z: the part alone turns, and its X is Y of the machine."""
    found = trunnion.place(CONTOUR, machine="yl569", turns=[90.0], tool_length=0.0)
    assert found.region is not None
    assert found.region.low[:2].tolist() == pytest.approx([-250.0 + Y[1], -150.0 - X[0]], abs=1e-6)
    assert found.region.high[:2].tolist() == pytest.approx([250.0 + Y[0], 150.0 - X[1]], abs=1e-6)
    assert found.turn_deg == 90.0


@pytest.mark.parametrize("zero", [(0.0, 0.0, 0.0), (31.5, -20.25, 90.0), (-60.0, 44.0, -130.0)])
def test_margins_of_five_axis_programs_are_those_that_the_proof_finds(zero: tuple[float, float, float]) -> None:
    """The travel check knows nothing of placing: it runs the program, with the rotary axes out of the way."""
    machine = trunnion.load_machine("yl569")
    axes = tuple(replace(a, low=-1e4, high=1e4) if a.is_rotary and not a.endless else a for a in machine.axes)
    machine = replace(machine, axes=axes, tool_length=100.0)
    for file in (HUB, BLADE):
        program = file.with_suffix(".expected.mpf")
        placed = trunnion.place([program], machine=machine, turns=[0.0], zero=zero)
        assert placed.present is not None
        ends = {axis.axis: (axis.least_mm, axis.greatest_mm) for axis in placed.present.axes}
        proof = trunnion.verify(program, machine=machine, zero=zero, tool_length=100.0)
        travel = next(check for check in proof.checks if check.key == "travel")
        judged = {place.text.split()[0]: place.value for place in travel.places if place.text[0] in "XYZ"}
        assert judged  # of slides within their limits the nearest end, of others those beyond
        for axis, value in judged.items():
            assert min(abs(value - end) for end in ends[axis]) < 1e-6
        assert travel.passed == placed.present.fits
        assert placed.margin_at(zero, 0.0) == pytest.approx(placed.present.margin_mm, abs=1e-9)


def test_all_programs_of_the_impeller_fit_at_the_places_where_each_fits() -> None:
    """At the turn 0 the region of all is what the regions of each have in common."""
    one = [trunnion.place(file, machine="yl569", turns=[0.0], tool_length=100.0) for file in (CONTOUR, HUB, BLADE)]
    every = trunnion.place([CONTOUR, HUB, BLADE], machine="yl569", turns=[0.0], tool_length=100.0)
    assert every.fits
    random = np.random.default_rng(1)
    inside = 0
    for zero in random.uniform((-250.0, -150.0, -350.0), (250.0, 150.0, 200.0), (300, 3)):
        point = (float(zero[0]), float(zero[1]), float(zero[2]))
        margin = min(found.margin_at(point, 0.0) for found in one)
        assert every.margin_at(point, 0.0) == pytest.approx(margin, abs=1e-9)
        inside += margin >= 0.0
    assert 20 < inside < 280
    # The table is 700 by 420 mm: it has room for every zero that the travel allows.
    assert every.region is not None
    assert np.abs(every.region.low[:2]).max() < 350.0
    assert np.abs(every.region.high[:2]).max() < 350.0
    assert max(-every.region.low[1], every.region.high[1]) < 210.0


#: Least and greatest positions of the axes over the three programs, as their words have them, with the zero at
#: (0, 0, -200) and a tool of 150 mm; docs/twin.md shows the curves.
CURVES = {
    "X": (-60.941, 213.198),
    "Y": (-51.648, 51.648),
    "Z": (-71.781, 85.430),
    "B": (0.0, 59.18624),
    "C": (-40.64457, 36.2651),
}


@pytest.mark.parametrize("suffix", [".cls", ".expected.mpf"])
def test_the_curves_of_all_published_programs_are_reproduced(suffix: str) -> None:
    """By their text alone, from the programs and from the CL files: within the digits that are printed."""
    zero, files = (0.0, 0.0, -200.0), [file.with_suffix(suffix) for file in (CONTOUR, HUB, BLADE)]
    found = trunnion.place(files, machine="yl569", turns=[0.0], zero=zero, tool_length=150.0)
    assert found.fits
    assert found.present is not None
    told = {axis.axis: (axis.least_mm, axis.greatest_mm) for axis in found.present.axes}
    assert found.present.margin_mm == pytest.approx(250.0 - 213.198, abs=1e-3)
    told |= {axis.axis: (axis.least_deg, axis.greatest_deg) for axis in found.present.rotary}
    programs = [file.with_suffix(".expected.mpf") for file in (CONTOUR, HUB, BLADE)]
    drawn = curves(tips_and_angles(programs), zero, 150.0)
    for axis, ends in CURVES.items():
        values = (drawn[axis] + 180.0) % 360.0 - 180.0 if axis == "C" else drawn[axis]
        digit = 1e-5 if axis in "BC" else 1e-3
        assert (values.min(), values.max()) == pytest.approx(ends, abs=digit)
        assert told[axis] == pytest.approx(ends, abs=digit)


def test_cl_file_and_program_give_the_same_places() -> None:
    for file in (CONTOUR, BLADE):
        cl = trunnion.place(file, machine="yl569", turns=[0.0], tool_length=100.0)
        program = trunnion.place(file.with_suffix(".expected.mpf"), machine="yl569", turns=[0.0], tool_length=100.0)
        assert program.margin_mm == pytest.approx(cl.margin_mm, abs=1e-4)
        assert program.region is not None
        assert cl.region is not None
        assert program.region.low.tolist() == pytest.approx(cl.region.low.tolist(), abs=1e-3)


def test_the_part_is_posted_where_it_was_placed_and_no_farther() -> None:
    """What the proof finds at the best place, turned, is the margin; beyond the region it refuses the program."""
    found = trunnion.place(BLADE, machine="yl569", turns=[33.0], tool_length=100.0)
    posted = trunnion.post_placed(found, machine="yl569", settings={"tool_length": 100.0})
    assert posted.passed
    assert posted.run is not None
    assert found.best is not None
    extremes = posted.run.joints[posted.run.tcp]
    for axis in found.best.axes:
        column = posted.run.machine.column(axis.axis)
        assert extremes[:, column].min() == pytest.approx(axis.least_mm, abs=1e-4)
        assert extremes[:, column].max() == pytest.approx(axis.greatest_mm, abs=1e-4)


def test_a_post_is_refused_outside_of_the_region_and_proven_inside() -> None:
    """From the best place towards a corner, a twentieth of a millimetre before and behind the border."""
    found = trunnion.place(BLADE, machine="yl569", turns=[33.0], tool_length=100.0)
    assert found.region is not None
    assert found.zero_mm is not None
    toolpaths = turned_toolpaths(found.toolpaths, 33.0)
    best = np.array(found.zero_mm)
    for corner in (found.region.corners[0], found.region.corners[-1]):
        share = np.array([0.0, 2.0])
        for _ in range(60):  # bisection for the border
            middle = best + share.mean() * (corner - best)
            share[0 if found.region.margin(middle) >= 0.0 else 1] = share.mean()
        step = 0.05 / -found.region.margin(best + (share[0] + 1e-3) * (corner - best)) * 1e-3
        for side, fits in ((-1.0, True), (1.0, False)):
            zero = best + (share[0] + side * step) * (corner - best)
            assert 0.01 < -side * found.region.margin(zero) < 0.1
            settings: dict[str, str | float] = {"tool_length": 100.0, "zero": ",".join(map(str, zero.tolist()))}
            if fits:
                assert trunnion.post(toolpaths, machine="yl569", settings=settings).passed
            else:
                with pytest.raises(trunnion.RefusedError):
                    trunnion.post(toolpaths, machine="yl569", settings=settings)
