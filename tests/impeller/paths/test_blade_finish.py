"""Passes of a blade finish against exact distances."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.paths.blade_finish import BladeFinish, blade_finish
from trunnion.impeller.paths.passes import PassFamily, Stepover, Way

PUBLISHED = Path(__file__).resolve().parents[3] / "examples" / "impeller" / "impeller.toml"


@pytest.fixture(scope="module")
def published() -> Impeller:
    return build_impeller(read_impeller(PUBLISHED))


@pytest.fixture(scope="module")
def finish(published: Impeller) -> PassFamily:
    return blade_finish(published, published.blade, BladeFinish(2.0, Stepover(distance=0.6), tolerance=0.01))


def test_the_ball_touches_the_blade_and_keeps_off_hub_and_neighbours(published: Impeller, finish: PassFamily) -> None:
    centre = finish.centres()
    normal = np.concatenate([one.normal for one in finish.passes])
    own = published.blade.distances(centre)[0]
    inside = np.hypot(*(centre - 2.0 * normal)[:, :2].T) < 45.0
    np.testing.assert_allclose(own[inside], 2.0, atol=1e-9)
    assert own.min() > 2.0 - 1e-9
    assert published.hub.distances(centre)[0].min() > 2.0 - 1e-9
    pitch = np.pi / 3.0
    for angle in (pitch, -pitch):
        turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
        assert published.blade.distances(centre @ turn)[0].min() > 2.0


def test_rows_go_from_the_shroud_to_the_hub_and_out_of_the_stock(published: Impeller, finish: PassFamily) -> None:
    first, last = finish.passes[0], finish.passes[-1]
    np.testing.assert_allclose(published.shroud.distances(first.centre - 2.0 * first.normal)[0], 0.0, atol=1e-9)
    np.testing.assert_allclose(published.hub.distances(last.centre)[0], 2.0, atol=1e-9)
    for one in finish.passes:
        assert np.hypot(*one.centre[[0, -1], :2].T).min() > 47.0
        assert (np.diff(one.place[:, 0]) > 0.0).all()
    assert [one.place[0, 1] for one in finish.passes] == sorted({one.place[0, 1] for one in finish.passes})


def test_a_spiral_round_a_cut_trailing_edge_is_refused(published: Impeller) -> None:
    with pytest.raises(InputError, match="no way round it"):
        blade_finish(published, published.blade, BladeFinish(2.0, Stepover(distance=1.0), Way.SPIRAL))


def test_a_ball_too_large_for_the_channel_is_refused_with_one_that_fits(published: Impeller) -> None:
    with pytest.raises(InputError, match=r"there is room for a ball of radius \d") as refusal:
        blade_finish(published, published.blade, BladeFinish(9.0, Stepover(distance=3.0), tolerance=0.05))
    largest = float(str(refusal.value).split("radius ")[-1].split(" mm")[0])
    blade_finish(published, published.blade, BladeFinish(largest - 0.5, Stepover(distance=3.0), tolerance=0.05))
