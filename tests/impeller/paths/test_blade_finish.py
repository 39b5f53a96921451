"""Passes of a blade finish against exact distances."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.impellers import mixed_flow_cases, nearest_on_path
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.impeller.definition import ImpellerDefinition, read_impeller
from trunnion.impeller.fillet import root_fillet
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.paths.around import stations_at
from trunnion.impeller.paths.blade_finish import BladeFinish, blade_finish, tip_heights
from trunnion.impeller.paths.passes import PassFamily, Stepover, Way
from trunnion.impeller.paths.root_blend import RootBlend, root_blend
from trunnion.impeller.steps import StepKind

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


def test_the_blade_is_on_the_right_of_the_way(finish: PassFamily, published: Impeller) -> None:
    for one in finish.passes[::10]:
        way = np.diff(one.centre, axis=0)
        w, v = published.blade.distances(one.centre[1:])[1].T
        up = published.blade.frames(w, v)[2]
        assert (np.einsum("ij,ij->i", np.cross(way, up), one.normal[1:]) < 0.0).all()


def test_no_point_of_the_blade_keeps_more_than_a_scallop(published: Impeller, finish: PassFamily) -> None:
    rng = np.random.default_rng(7)
    stations = stations_at(np.sort(rng.uniform(0.0, 3.0, 3000)), 1.0)
    low = root_fillet(published.blade, published.hub, 2.0, stations).v
    v = low + rng.uniform(0.0, 1.0, 3000) * (tip_heights(published, published.blade, stations) - low)
    points = stations.touching(published.blade, v, 0.0)[0]
    points = points[np.hypot(points[:, 0], points[:, 1]) < 45.0]
    left = nearest_on_path(finish, points) - 2.0
    assert left.max() < 2.0 - np.sqrt(2.0**2 - 0.3**2) + 0.01 + 0.001
    assert left.min() > -0.01


def test_rows_by_scallop_are_as_far_apart_as_it_lets_them(published: Impeller) -> None:
    rows = [
        len(blade_finish(published, published.blade, BladeFinish(2.0, Stepover(scallop=h), tolerance=0.05)).passes)
        for h in (0.04, 0.01)
    ]
    # The step goes with the root of the scallop.
    assert rows[1] - 1 == pytest.approx(2 * (rows[0] - 1), abs=2)


@settings(max_examples=examples(4))
@given(mixed_flow_cases(), st.sampled_from(list(Way)), st.floats(0.0, 0.5))
def test_balls_touch_blades_of_a_family_with_their_allowance(
    case: tuple[ImpellerDefinition, float], way: Way, allowance: float
) -> None:
    definition, radius = case
    impeller = build_impeller(definition)
    blade = impeller.splitter or impeller.blade
    family = blade_finish(impeller, blade, BladeFinish(radius, Stepover(distance=1.0), way, allowance, tolerance=0.02))
    centre = family.centres()
    np.testing.assert_allclose(blade.distances(centre)[0], radius + allowance, atol=1e-9)
    assert impeller.hub.distances(centre)[0].min() > radius + allowance - 1e-9
    for one in family.passes:
        assert np.linalg.norm(np.diff(one.centre, axis=0), axis=1).min() > 1e-6
        middle = middles(one.centre)
        assert np.abs(blade.distances(middle)[0] - radius - allowance).max() < 0.02
    if way is Way.SPIRAL:
        (one,) = family.passes
        assert (np.diff(one.place[:, 1]) >= 0.0).all()
        assert np.linalg.norm(one.centre[0] - one.centre[np.flatnonzero(one.place[:, 0] == 1.0)[0]]) < 1e-9


def middles(centre: Floats) -> Floats:
    """Middles of chords."""
    return (centre[1:] + centre[:-1]) / 2.0


@pytest.mark.parametrize(("name", "radius"), [("mixed_flow", 2.5), ("turbo3d", 1.0)])
def test_other_impellers_have_their_blade_finish_and_root_blend(name: str, radius: float) -> None:
    impeller = build_impeller(read_impeller(PUBLISHED.with_name(f"{name}.toml")))
    assert {step.kind for step in impeller.definition.steps} == set(StepKind) - {StepKind.FLANK_MILLING}
    limit = impeller.definition.stock.diameter / 2.0
    for blade in filter(None, (impeller.blade, impeller.splitter)):
        finish = blade_finish(impeller, blade, BladeFinish(radius, Stepover(distance=1.0), tolerance=0.02))
        step = RootBlend(radius, Stepover(distance=1.0), 1.2 * radius, radius, tolerance=0.02)
        for family in (finish, root_blend(impeller, blade, step)):
            centre = family.centres()
            touch = centre - radius * np.concatenate([one.normal for one in family.passes])
            gaps = np.minimum(blade.distances(centre)[0], impeller.hub.distances(centre)[0])
            assert gaps.min() > radius - 1e-9
            np.testing.assert_allclose(gaps[np.hypot(touch[:, 0], touch[:, 1]) < limit], radius, atol=1e-9)


def test_a_spiral_round_a_cut_trailing_edge_is_refused(published: Impeller) -> None:
    with pytest.raises(InputError, match="no way round it"):
        blade_finish(published, published.blade, BladeFinish(2.0, Stepover(distance=1.0), Way.SPIRAL))


def test_a_ball_too_large_for_the_channel_is_refused_with_one_that_fits(published: Impeller) -> None:
    with pytest.raises(InputError, match=r"there is room for a ball of radius \d") as refusal:
        blade_finish(published, published.blade, BladeFinish(9.0, Stepover(distance=3.0), tolerance=0.05))
    largest = float(str(refusal.value).split("radius ")[-1].split(" mm")[0])
    blade_finish(published, published.blade, BladeFinish(largest - 0.5, Stepover(distance=3.0), tolerance=0.05))
