"""The published impeller on the machine that cut it: the region of all its programs, held against what they do."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import ROOT
from trunnion.arrays import Floats
from trunnion.placing.region import TOLERANCE

EXAMPLE = ROOT / "examples" / "impeller"
LENGTH = 160.0

#: A coarse step between the blades.
STEPS = """
[[tool]]
number = 2
kind = "ball"
diameter_mm = 6
flute_length_mm = 40
length_mm = 60

[[operation]]
kind = "hub finish"
tool = 2
stepover_mm = 5.0
rpm = 5000
feed_mm_min = 400
lead_mm = 0.5
"""


def slides_with(zero: Floats, program: Path, subprograms: list[Path]) -> Floats:
    """(3, 2): least and greatest values of X, Y and Z in all rows under TCP, with the zero there."""
    x, y, z = zero.tolist()
    machine = replace(trunnion.load_machine("yl569"), workpiece_zero=(x, y, z), tool_length=LENGTH)
    run = trunnion.read_program(program, machine=machine, subprograms=subprograms)
    joints = run.joints[run.tcp]
    return np.array([(joints[:, k].min(), joints[:, k].max()) for k in map(machine.column, "XYZ")])


def test_the_region_of_the_impeller_ends_where_a_slide_of_its_programs_ends(tmp_path: Path) -> None:
    """At each corner some slide of the program that was read back is at its limit, within the stated tolerance."""
    text = (EXAMPLE / "impeller.toml").read_text(encoding="utf-8").split("[[tool]]")[0]
    (tmp_path / "blade_points.csv").write_bytes((EXAMPLE / "blade_points.csv").read_bytes())
    (tmp_path / "impeller.toml").write_text(text + STEPS, encoding="utf-8")
    folder = tmp_path / "nc"
    settings = {"tool_length": LENGTH}
    trunnion.cut_impeller(tmp_path / "impeller.toml", machine="yl569", output=folder, settings=settings)
    program, subprograms = folder / "IMPELLER.mpf", sorted(folder.glob("*.spf"))
    assert subprograms

    found = trunnion.place(sorted(folder.glob("*.cls")), machine="yl569", turns=[0.0], tool_length=LENGTH)
    assert found.fits
    assert found.region is not None
    limits = np.array([(-250.0, 250.0), (-150.0, 150.0), (-250.0, 250.0)])
    corners = found.region.corners
    for corner in (*corners[:: max(len(corners) // 6, 1)], corners[0], corners[-1]):
        left = (slides_with(corner, program, subprograms) - limits) * [1.0, -1.0]
        assert left.min() == pytest.approx(0.0, abs=TOLERANCE + 1e-3)
    assert found.best is not None
    best = slides_with(np.array(found.best.zero_mm), program, subprograms)
    told = np.array([(axis.least_mm, axis.greatest_mm) for axis in found.best.axes])
    assert told == pytest.approx(best, abs=0.02)  # between its rows a slide may swing a little farther
    # Round the table: as C turns, the region reaches as far in -X as in X, and nearly so in Y.
    assert found.region.low[0] == pytest.approx(-found.region.high[0], abs=2.0)
    # The part is small beside the table of 700 by 420 mm, on which it may stand anywhere that the travel allows.
    assert np.abs(found.region.low[:2]).max() < 210.0
    assert np.abs(found.region.high[:2]).max() < 210.0
