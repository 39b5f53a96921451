"""Passes of a root blend against exact distances."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.impellers import mixed_flow_cases, nearest_on_path
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.impeller.definition import ImpellerDefinition, read_impeller
from trunnion.impeller.fillet import root_fillet
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.paths.around import stations_at
from trunnion.impeller.paths.passes import PassFamily, Stepover, Way
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


def test_fillet_and_what_the_ball_of_the_hub_left_keep_no_more_than_a_scallop(
    published: Impeller, blend: PassFamily
) -> None:
    rng, count = np.random.default_rng(8), 1500
    fillet = root_fillet(published.blade, published.hub, 2.0, stations_at(np.sort(rng.uniform(0.0, 3.0, count)), 1.0))
    cosine = np.einsum("ij,ij->i", fillet.to_blade, fillet.to_hub)
    away = cosine[:, None] * fillet.to_hub - fillet.to_blade
    away /= np.linalg.norm(away, axis=1)[:, None]
    turn = rng.uniform(0.0, 1.0, count) * np.arccos(cosine)
    arc = fillet.centre + 2.0 * (np.cos(turn)[:, None] * fillet.to_hub - np.sin(turn)[:, None] * away)
    hub = fillet.centre + 2.0 * fillet.to_hub + rng.uniform(0.0, 6.0, count)[:, None] * away
    distance, normal, _ = published.hub.distances(hub)
    hub = hub - distance[:, None] * normal
    not_reached = published.blade.distances(hub + 3.0 * normal)[0] < 3.0
    not_reached &= neighbour_distances(published, hub + 3.0 * normal) > 3.0
    not_reached &= published.blade.distances(hub + 2.0 * normal)[0] > 2.0
    assert not_reached.sum() > 100
    ridge = blend.radius - np.sqrt(blend.radius**2 - 0.2**2)
    for points in (arc, hub[not_reached]):
        left = nearest_on_path(blend, points[np.hypot(points[:, 0], points[:, 1]) < 45.0]) - blend.radius
        assert left.max() < ridge + 0.01 + 0.001
        assert left.min() > -0.01


@pytest.mark.nightly
@settings(max_examples=examples(4))
@given(mixed_flow_cases(), st.sampled_from(list(Way)))
def test_balls_as_large_as_the_fillet_stay_clear_in_a_family(case: tuple[ImpellerDefinition, float], way: Way) -> None:
    definition, radius = case
    impeller = build_impeller(definition)
    blade = impeller.splitter or impeller.blade
    step = RootBlend(radius, Stepover(distance=1.0), 3.0, radius, way, tolerance=0.02)
    try:
        family = root_blend(impeller, blade, step)
    except InputError as refused:
        if "there is room for a ball of radius" not in str(refused):
            raise
        reject()  # a large fillet meets itself round the trailing edge of a thin blade
    normal = np.concatenate([one.normal for one in family.passes])
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-12)
    ball = family.centres() + (definition.fillet - radius) * normal
    gaps = np.stack((blade.distances(ball)[0], impeller.hub.distances(ball)[0]))
    np.testing.assert_allclose(gaps.min(axis=0), definition.fillet, atol=step.tolerance)
    assert np.isclose(gaps.min(axis=0), definition.fillet, atol=1e-9).mean() > 0.98
    assert all(np.linalg.norm(np.diff(one.centre, axis=0), axis=1).min() > 1e-6 for one in family.passes)


def test_a_ball_larger_than_the_fillet_is_refused(published: Impeller) -> None:
    with pytest.raises(InputError, match="the largest that fits has a radius of 2 mm"):
        root_blend(published, published.blade, RootBlend(2.5, Stepover(distance=0.2), 3.0, 2.5))
