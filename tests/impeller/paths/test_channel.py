"""Steps between two blades, judged by exact distances of their ball centres."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.impellers import mixed_flow, mixed_flow_cases, nearest_on_path
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.impeller.definition import ImpellerDefinition, read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller, rotated
from trunnion.impeller.paths.channel import channels_of
from trunnion.impeller.paths.channel_families import channel_roughing, hub_finish
from trunnion.impeller.paths.channel_sheets import Ball
from trunnion.impeller.paths.passes import PassFamily, Stepover

PUBLISHED = Path(__file__).resolve().parents[3] / "examples" / "impeller" / "impeller.toml"

TOLERANCE = 0.01


@pytest.fixture(scope="module")
def published() -> Impeller:
    return build_impeller(read_impeller(PUBLISHED))


@pytest.fixture(scope="module")
def finish(published: Impeller) -> PassFamily:
    return hub_finish(channels_of(published)[0], Ball(3.0, TOLERANCE), Stepover(distance=0.5))


@pytest.fixture(scope="module")
def roughing(published: Impeller) -> PassFamily:
    (channel,) = channels_of(published)
    return channel_roughing(channel, Ball(3.0, TOLERANCE, 0.3, 0.4), Stepover(distance=1.5), 2.5)


def with_middles(family: PassFamily) -> Floats:
    """All centres, and the middles of the chords between them."""
    middles = [(one.centre[1:] + one.centre[:-1]) / 2.0 for one in family.passes]
    return np.concatenate((family.centres(), *middles))


def from_blades(impeller: Impeller, points: Floats) -> Floats:
    """Distance to the nearest of all blades."""
    return np.asarray(
        np.min([blade.distances(rotated(points, -angle))[0] for blade, angle in impeller.blades()], axis=0)
    )


def test_a_finishing_ball_touches_the_hub_and_the_blade_at_either_side(published: Impeller, finish: PassFamily) -> None:
    points = with_middles(finish)
    assert from_blades(published, points).min() >= 3.0 - TOLERANCE
    np.testing.assert_allclose(published.hub.distances(points)[0], 3.0, atol=TOLERANCE)
    first, last = (one for one in finish.passes if (one.place[:, 1] == one.place[0, 1]).all())
    for one, blade_angle in ((first, 0.0), (last, np.pi / 3.0)):
        along = one.place[:, 0]
        beside = one.centre[(along > 0.15) & (along < 0.9)]
        found = published.blade.distances(rotated(beside, -blade_angle))[0]
        np.testing.assert_allclose(found, 3.0, atol=1e-3)


def test_a_roughing_ball_leaves_the_allowances(published: Impeller, roughing: PassFamily) -> None:
    points = with_middles(roughing)
    assert from_blades(published, points).min() >= 3.3 - TOLERANCE
    height = published.hub.distances(points)[0]
    assert height.min() >= 3.4 - TOLERANCE
    lowest = np.concatenate([one.centre for one in roughing.passes if one.place[0, 2] == 0.0])
    np.testing.assert_allclose(published.hub.distances(lowest)[0], 3.4, atol=TOLERANCE)


@pytest.mark.parametrize("name", ["finish", "roughing"])
def test_passes_begin_and_end_off_the_stock(published: Impeller, name: str, request: pytest.FixtureRequest) -> None:
    family: PassFamily = request.getfixturevalue(name)
    ends = np.array([one.centre[k] for one in family.passes for k in (0, -1)])
    stock = published.definition.stock
    off = [np.hypot(ends[:, 0], ends[:, 1]) - stock.diameter / 2.0, ends[:, 2] - stock.top]
    assert np.maximum.reduce([*off, published.shroud.distances(ends)[0]]).min() >= 3.0


@pytest.mark.parametrize("name", ["finish", "roughing"])
def test_passes_are_dense_without_doubles_and_places_are_within_0_and_1(
    name: str, request: pytest.FixtureRequest
) -> None:
    family: PassFamily = request.getfixturevalue(name)
    for one in family.passes:
        steps = np.linalg.norm(np.diff(one.centre, axis=0), axis=1)
        assert steps.min() > 1e-3
        assert steps.max() <= 2.0
        np.testing.assert_allclose(np.linalg.norm(one.normal, axis=1), 1.0, atol=1e-12)
    places = family.places()
    np.testing.assert_allclose(places.min(axis=0)[:2], 0.0, atol=1e-12)
    np.testing.assert_allclose(places.max(axis=0)[:2], 1.0, atol=1e-12)
    layers = [one.layer for one in family.passes]
    assert layers == sorted(layers)


@pytest.mark.nightly
@settings(max_examples=examples(6), deadline=None)
@given(mixed_flow_cases(), st.sampled_from([0.8, 1.6]), st.booleans())
def test_nothing_is_cut_and_nothing_is_left(
    case: tuple[ImpellerDefinition, float], step: float, is_roughing: bool
) -> None:
    """Each ball that keeps the distances is near one of the path; all balls of the path keep them."""
    definition, _ = case
    try:
        impeller = build_impeller(definition)
    except InputError:
        assume(False)
    radius, allowance, down = 1.05 * definition.fillet, 0.3 * is_roughing, 2.5
    families = []
    for channel in channels_of(impeller):
        if is_roughing:
            ball = Ball(radius, 0.02, allowance, allowance)
            found = channel_roughing(channel, ball, Stepover(distance=step), down)
        else:
            found = hub_finish(channel, Ball(radius, 0.02), Stepover(distance=step))
        points = with_middles(found)
        assert from_blades(impeller, points).min() >= radius + allowance - 0.02
        assert impeller.hub.distances(points)[0].min() >= radius + allowance - 0.02
        families.append(found)
    balls = possible_balls(impeller, radius, allowance, on_hub=not is_roughing)
    pitch = 2.0 * np.pi / definition.number
    turned_back = [rotated(balls, turn * pitch) for turn in (-1, 0, 1)]
    off = np.min([nearest_on_path(one, balls, 0.2) for one in families for balls in turned_back], axis=0)
    # On the hub balls are farther apart than where they touch, and in front of an edge a little is left.
    size = np.hypot(balls[:, 0], balls[:, 1])
    apart = 0.5 * step * size / (size - radius - allowance)
    in_front = (radius + allowance + 0.5 * definition.hub_thickness) / 8.0
    assert (off <= np.hypot(apart, 0.5 * down * is_roughing) + in_front + 0.02).all()


def possible_balls(impeller: Impeller, radius: float, allowance: float, on_hub: bool) -> Floats:
    """Centres (k, 3) of balls in a channel and the stock that keep allowances; those on the hub touch it."""
    rng, count = np.random.default_rng(9), 20_000
    stock, reach = impeller.definition.stock, radius + allowance
    size = np.sqrt(rng.uniform(0.05, 1.0, count)) * stock.diameter / 2.0
    angle = rng.uniform(0.0, 2.0 * np.pi / impeller.definition.number, count)
    height = rng.uniform(stock.bottom, stock.top, count)
    points = np.column_stack((size * np.cos(angle), size * np.sin(angle), height))
    distance, normal, _ = impeller.hub.distances(points)
    if on_hub:
        points, distance, normal = (one[np.abs(distance - reach) < 4.0] for one in (points, distance, normal))
        for _ in range(20):
            points = points + (reach - distance)[:, None] * normal
            distance, normal, _ = impeller.hub.distances(points)
    touched = points - radius * normal
    inside = (np.hypot(touched[:, 0], touched[:, 1]) < stock.diameter / 2.0) & (touched[:, 2] < stock.top)
    inside &= (
        (impeller.shroud.distances(points)[0] < radius) & (distance >= reach - 1e-9) & (touched[:, 2] > stock.bottom)
    )
    if not on_hub:
        inside &= (np.hypot(points[:, 0], points[:, 1]) < stock.diameter / 2.0) & (points[:, 2] < stock.top)
    points = points[inside]
    return points[from_blades(impeller, points) >= reach]


def test_a_scallop_decides_how_far_passes_are_apart(published: Impeller) -> None:
    (channel,) = channels_of(published)
    coarse, fine = (hub_finish(channel, Ball(3.0, 0.05), Stepover(scallop=one)) for one in (0.04, 0.01))
    assert len(fine.passes) == pytest.approx(2 * len(coarse.passes), rel=0.15)


def test_with_splitters_there_are_two_channels_that_meet_at_the_splitter() -> None:
    impeller = build_impeller(mixed_flow(number=4))
    first, second = channels_of(impeller)
    assert [first.start, first.end, second.end] == pytest.approx([0.0, np.pi / 4.0, np.pi / 2.0])
    assert first.end == second.start
    splitter = impeller.splitter
    assert splitter is not None
    ball = np.array([[52.0, 18.0, 14.0]])
    expected = splitter.distances(rotated(ball, -np.pi / 4.0))[0]
    np.testing.assert_allclose(first.distance_behind(ball), expected)
    np.testing.assert_allclose(second.distance_before(ball), expected)


def test_a_channel_too_narrow_is_refused_with_the_place_and_the_largest_ball(published: Impeller) -> None:
    (channel,) = channels_of(published)
    text = r"a ball of 15 mm does not fit between two blades at w = 0\.\d+, .* mm; the largest that fits has 1\d\.\d"
    with pytest.raises(InputError, match=text):
        hub_finish(channel, Ball(7.5, TOLERANCE), Stepover(distance=0.5))


def test_a_ball_smaller_than_the_fillet_is_refused(published: Impeller) -> None:
    (channel,) = channels_of(published)
    with pytest.raises(InputError, match=r"a ball of 3\.8 mm is smaller than the fillet of 2 mm"):
        hub_finish(channel, Ball(1.9, TOLERANCE), Stepover(distance=0.5))
