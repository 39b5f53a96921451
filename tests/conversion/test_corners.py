"""Corners, approaches and departures that a control makes by itself are lines and arcs on any other."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.model.toolpath import Kind

KLARTEXT = """0 BEGIN PGM PART MM
1 TOOL CALL 1 Z S2000
2 L X-20 Y-20 Z+100 R0 FMAX M3
3 L Z-5 F1000
4 APPR LCT X+0 Y+10 R8 F400
5 L Y+60
6 RND R6 F200
7 L X+60
8 CHF 5
9 L Y+0
10 RND R10
11 L X+0
12 L Y+12
13 DEP LCT X-20 Y+30 R5 F800
14 L Z+100 FMAX M5
15 M30
16 END PGM PART MM
"""


@pytest.mark.parametrize("target", ["yl569", "matsuura_mx330"])
def test_what_a_tnc_makes_of_corners_is_the_path_of_another_control(target: str, tmp_path: Path) -> None:
    source, converted = tmp_path / "part.h", tmp_path / "part.nc"
    source.write_text(KLARTEXT, encoding="utf-8")
    trunnion.convert(source, machine="dmu65", to_machine=target, output=converted)
    before, after = trunnion.read_program(source, machine="dmu65"), trunnion.read_program(converted, machine=target)
    assert not before.errors
    assert not after.errors
    assert np.count_nonzero(before.kind == Kind.ARC) == 4
    ends = [run.tip[run.kind == Kind.ARC] for run in (before, after)]
    np.testing.assert_allclose(ends[1], ends[0], atol=5e-4)
    np.testing.assert_allclose(after.arcs.radius, [8, 6, 10, 5], atol=2e-3)
    np.testing.assert_allclose(after.feed[after.kind == Kind.ARC], [400, 200, 400, 800])
