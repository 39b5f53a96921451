"""Passes of a root blend against exact distances."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.paths.passes import PassFamily, Stepover
from trunnion.impeller.paths.root_blend import RootBlend, root_blend

PUBLISHED = Path(__file__).resolve().parents[3] / "examples" / "impeller" / "impeller.toml"


@pytest.fixture(scope="module")
def published() -> Impeller:
    return build_impeller(read_impeller(PUBLISHED))


@pytest.fixture(scope="module", params=[2.0, 1.5])
def blend(published: Impeller, request: pytest.FixtureRequest) -> PassFamily:
    step = RootBlend(request.param, Stepover(distance=0.4), hub_radius=3.0, blade_radius=2.0, tolerance=0.01)
    return root_blend(published, published.blade, step)


def neighbour_distances(impeller: Impeller, points: Floats) -> Floats:
    found = []
    for angle in (np.pi / 3.0, -np.pi / 3.0):
        turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
        found.append(impeller.blade.distances(points @ turn)[0])
    return np.asarray(np.min(found, axis=0))


def test_each_row_touches_blade_fillet_or_hub_and_nothing_else(published: Impeller, blend: PassFamily) -> None:
    radius, kinds = blend.radius, []
    for one in blend.passes:
        touch = one.centre - radius * one.normal
        inside = np.hypot(*touch[:, :2].T) < 45.0
        ball = (touch + 2.0 * one.normal)[inside]  # as large as the fillet, at the same point
        own, hub = published.blade.distances(ball)[0], published.hub.distances(ball)[0]
        assert min(own.min(), hub.min(), neighbour_distances(published, ball).min()) > 2.0 - 1e-9
        kinds.append((bool(np.ptp(own) < 1e-9), bool(np.ptp(hub) < 1e-9)))
        np.testing.assert_allclose(np.minimum(own, hub), 2.0, atol=1e-9)
    assert kinds == sorted(kinds, key=[(True, False), (True, True), (False, True)].index)
    assert len(set(kinds)) == 3


def test_a_ball_larger_than_the_fillet_is_refused(published: Impeller) -> None:
    with pytest.raises(InputError, match="the largest that fits has a radius of 2 mm"):
        root_blend(published, published.blade, RootBlend(2.5, Stepover(distance=0.2), 3.0, 2.5))
