"""The form of the shroud: what a helix leaves of the stock is what it should."""

import numpy as np
import pytest

from tests.support.locations import ROOT
from trunnion import load_impeller
from trunnion.errors import InputError
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.passes import Stepover
from trunnion.impeller.paths.shroud import shroud_finish, stock_roughing


@pytest.fixture(scope="module")
def impeller() -> Impeller:
    return load_impeller(ROOT / "examples" / "impeller" / "impeller.toml")


@pytest.mark.parametrize(("radius", "widest"), [(10.0, 15.0), (10.0, 5.0), (4.0, 3.0)])
def test_roughing_never_cuts_into_the_form(impeller: Impeller, radius: float, widest: float) -> None:
    found = stock_roughing(impeller, radius, 1.5, widest, 0.3, 0.005)
    for one in found.passes:
        inner = np.hypot(one.centre[:, 0], one.centre[:, 1]) - radius
        for up in (0.0, 1.0, 5.0, 20.0):
            edge = np.column_stack((inner, np.zeros(len(inner)), np.minimum(one.centre[:, 2] + up, 35.0)))
            assert impeller.shroud.distances(edge)[0].min() > 0.3 - 0.01


def test_roughing_goes_down_to_where_the_form_meets_the_stock(impeller: Impeller) -> None:
    found = stock_roughing(impeller, 10.0, 1.5, 15.0, 0.3, 0.005)
    lowest = min(float(one.centre[:, 2].min()) for one in found.passes)
    assert lowest == pytest.approx(11.2, abs=0.4)
    (one,) = found.passes
    angle = np.unwrap(np.arctan2(one.centre[:, 1], one.centre[:, 0]))
    turns = (angle[0] - angle[-1]) / (2.0 * np.pi)  # clockwise
    assert turns >= (35.0 - lowest) / 1.5 + 1.0 - 1e-9
    assert (np.diff(one.centre[:, 2]) <= 1e-9).all()


def test_narrow_turns_follow_each_other_from_outside(impeller: Impeller) -> None:
    found = stock_roughing(impeller, 10.0, 1.5, 5.0, 0.3, 0.005)
    inner = [float((np.hypot(one.centre[:, 0], one.centre[:, 1]) - 10.0).min()) for one in found.passes]
    assert len(inner) == 3
    assert all(outer - inside <= 5.0 + 1e-6 for outer, inside in zip([45.0, *inner], inner, strict=False))


def test_countless_turns_are_refused_before_they_are_made(impeller: Impeller) -> None:
    with pytest.raises(
        InputError, match="million points, and 5 million are the most; let stepover_mm, step_down_mm or"
    ):
        stock_roughing(impeller, 10.0, 1e-7, 15.0, 0.3, 0.005)
    with pytest.raises(InputError, match="million points"):
        stock_roughing(impeller, 10.0, 1.5, 1e-9, 0.3, 0.005)
    with pytest.raises(InputError, match="million points"):
        shroud_finish(impeller, 5.0, Stepover(distance=1e-4), 0.0, 0.0, 0.005)


@pytest.mark.parametrize("tilt", [5.0, 10.0, 45.0])
def test_a_tilted_ball_touches_the_form_everywhere(impeller: Impeller, tilt: float) -> None:
    found = shroud_finish(impeller, 5.0, Stepover(distance=0.5), tilt, 0.0, 0.005)
    (one,), (axis,) = found.passes, found.axes
    beside = one.centre[:, 2] <= impeller.definition.stock.top - 1.0
    assert np.abs(impeller.shroud.distances(one.centre[beside])[0] - 5.0).max() < 0.002
    assert found.left < 1e-3
    np.testing.assert_allclose(np.degrees(np.arccos(axis[:, 2])), tilt)
    np.testing.assert_allclose(axis[:, 0] * one.centre[:, 1], axis[:, 1] * one.centre[:, 0], atol=1e-6)
    assert (np.einsum("ij,ij->i", axis[:, :2], one.centre[:, :2]) > 0.0).all()  # outward


def test_an_upright_ball_keeps_off_an_undercut_form_and_says_how_far(impeller: Impeller) -> None:
    found = shroud_finish(impeller, 5.0, Stepover(distance=0.5), 0.0, 0.0, 0.005)
    (one,) = found.passes
    beside = one.centre[:, 2] <= impeller.definition.stock.top - 1.0
    assert impeller.shroud.distances(one.centre[beside])[0].min() > 5.0 - 0.002
    assert 0.01 < found.left < 0.2
    inner = np.hypot(one.centre[:, 0], one.centre[:, 1]) - 5.0
    for z in np.linspace(13.0, 35.0, 23):
        above = one.centre[:, 2] <= z  # the side of the tool stands in this height, too
        if not above.any():
            continue
        edge = np.column_stack((inner[above], np.zeros(above.sum()), np.full(above.sum(), z)))
        assert impeller.shroud.distances(edge)[0].min() > -0.002


def test_turns_are_as_near_to_each_other_as_is_asked(impeller: Impeller) -> None:
    found = shroud_finish(impeller, 5.0, Stepover(scallop=0.01), 10.0, 0.0, 0.005)
    (one,) = found.passes
    angle = -np.unwrap(np.arctan2(one.centre[:, 1], one.centre[:, 0]))
    turn = angle - angle[0]
    touch = one.centre - 5.0 * one.normal
    profile = np.column_stack((np.hypot(touch[:, 0], touch[:, 1]), touch[:, 2]))
    for start in np.linspace(0.0, turn[-1] - 2.0 * np.pi, 40):
        first, second = (
            np.array([np.interp(at, turn, profile[:, k]) for k in (0, 1)]) for at in (start, start + 2.0 * np.pi)
        )
        apart = float(np.linalg.norm(second - first))
        assert 5.0 - np.sqrt(max(25.0 - apart**2 / 4.0, 0.0)) <= 0.0105
