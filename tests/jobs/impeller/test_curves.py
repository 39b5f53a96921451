"""``trunnion.read_points``, ``fit_curve`` and ``write_curve_picture``."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trunnion

BLADE = Path(__file__).resolve().parents[3] / "examples" / "impeller" / "blade_points.csv"
POINTS = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.0], [2.0, 0.1, 0.3], [3.0, -0.1, 0.4], [4.0, 0.0, 0.2]]


def test_a_table_scaled_and_an_array_give_the_same_curve() -> None:
    tip, _ = trunnion.read_points(BLADE, scale=0.75)
    fitted = trunnion.fit_curve(tip, start="tangent:0,1,-0.5", parameterization="centripetal")
    other = trunnion.fit_curve(np.array(tip.points), start="tangent:0,1,-0.5", parameterization="centripetal")
    np.testing.assert_array_equal(fitted.curve.control_points, other.curve.control_points)
    assert fitted.length == pytest.approx(39.10058, abs=1e-4)
    assert (len(fitted.spans), fitted.parameters.shape, fitted.offsets.shape) == (19, (20,), (20,))


def test_moved_points_and_a_tolerance_add_up() -> None:
    _, hub = trunnion.read_points(BLADE)
    fitted = trunnion.fit_curve(hub, tolerance=0.1, fair=0.05)
    assert len(fitted.curve.control_points) < 22
    assert 0.02 < fitted.offsets.max() <= 0.15


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"points": "blade.csv"}, "points: error: is 'blade.csv'; give numbers"),
        ({"points": [[1.0, 2.0], [3.0, 4.0]]}, r"points: error: is \(2, 2\); give an array of the shape \(n, 3\)"),
        ({"points": [[1.0, 2.0, np.inf]]}, "points: error: is a list; give finite numbers"),
        ({"start": "up"}, "start: error: is 'up'; write natural"),
        (
            {"parameterization": "uniform"},
            "parameterization: error: 'uniform' is unknown; write chord-length or",
        ),
        ({"tolerance": -1.0}, "tolerance: error: -1.0 is not a tolerance; write a number above 0"),
        ({"fair": True}, "fair: error: True is not a tolerance; write a number above 0"),
        ({"weights": [1.0, "a"]}, "weights: error: is a list; give numbers"),
    ],
)
def test_wrong_arguments_are_named(given: dict[str, Any], what: str) -> None:
    with pytest.raises(trunnion.InputError, match=what):
        trunnion.fit_curve(**{"points": POINTS, **given})


def test_a_picture_has_each_curve_and_no_markup_from_the_names(tmp_path: Path) -> None:
    table = tmp_path / "points.csv"
    table.write_text("<b>&_x,<b>&_y,<b>&_z\n" + "\n".join(",".join(map(str, row)) for row in POINTS))
    fits = [trunnion.fit_curve(one) for one in (*trunnion.read_points(BLADE), *trunnion.read_points(table))]
    trunnion.write_curve_picture(fits, tmp_path / "curves.svg")
    picture = (tmp_path / "curves.svg").read_text("utf-8")
    assert picture.count('class="point"') == 45
    assert "&lt;b&gt;&amp;: 5 points, 7 control points" in picture
    assert "<b>" not in picture
    assert not re.search(r"\b(nan|inf)\b", picture)
    with pytest.raises(trunnion.InputError, match=r"let its name end in \.svg"):
        trunnion.write_curve_picture(fits, tmp_path / "curves.png")
