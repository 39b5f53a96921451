"""Blades, fillets and profiles against arithmetic of their own."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.impellers import mixed_flow
from trunnion.arrays import Floats
from trunnion.geometry.interpolation import interpolate
from trunnion.geometry.parameters import parameters_of
from trunnion.geometry.surfaces import loft
from trunnion.impeller.blade import Blade
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.fillet import root_fillet, root_stations
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.profiles import Profile

PUBLISHED = Path(__file__).resolve().parents[2] / "examples" / "impeller" / "impeller.toml"


@pytest.fixture(scope="module")
def published() -> Impeller:
    return build_impeller(read_impeller(PUBLISHED))


def plane_blade(leading: float = 1.0, trailing: float = 1.0) -> Blade:
    """A blade on the plane y = 0: x from 0 to 40, z from 0 to 20."""
    x = np.linspace(0.0, 40.0, 5)
    low, high = (np.column_stack((x, np.zeros(5), np.full(5, z))) for z in (0.0, 20.0))
    curves = [interpolate(points, parameters_of(points)) for points in (low, high)]
    half = np.array([[leading, leading], [trailing, trailing]])
    return Blade(loft(curves), np.array([[0.0, 0.0], [1.0, 1.0]]), half, -0.2, 1.2)


def test_a_lofted_surface_goes_through_its_curves_and_is_ruled_between_two() -> None:
    rng = np.random.default_rng(3)
    tables = [np.cumsum(rng.normal(loc=(2, 0, 0), size=(8, 3)), axis=0) + np.array([0, 0, 10 * k]) for k in range(3)]
    curves = [interpolate(points, parameters_of(points)) for points in tables]
    u = rng.random(50)
    surface = loft(curves)
    for curve, place in ((curves[0], 0.0), (curves[2], 1.0)):
        np.testing.assert_allclose(surface.points(u, np.full(50, place)), curve.points(u), atol=1e-12)
    v = rng.random(50)
    ruled = loft(curves[:2]).points(u, v)
    straight = (1.0 - v)[:, None] * curves[0].points(u) + v[:, None] * curves[1].points(u)
    np.testing.assert_allclose(ruled, straight, atol=1e-12)


@settings(max_examples=examples(15))
@given(st.integers(0, 2**31), st.sampled_from([(0.5, 0.5), (-0.1, 0.5), (1.2, 0.4), (0.3, -0.2), (1.1, 1.3)]))
def test_derivatives_of_a_surface_are_those_of_its_points(seed: int, place: tuple[float, float]) -> None:
    rng = np.random.default_rng(seed)
    tables = [np.cumsum(rng.normal(loc=(2, 0, 0), size=(7, 3)), axis=0) + np.array([0, 0, 10 * k]) for k in range(4)]
    surface = loft([interpolate(points, parameters_of(points)) for points in tables])
    u, v = (at + 0.01 * rng.random() for at in place)
    h = 1e-4

    def at(du: float, dv: float) -> Floats:
        return np.asarray(surface.points(np.array([u + du * h]), np.array([v + dv * h]))[0])

    numeric = [
        (at(1, 0) - at(-1, 0)) / (2 * h),
        (at(0, 1) - at(0, -1)) / (2 * h),
        (at(1, 0) + at(-1, 0) - 2 * at(0, 0)) / h**2,
        (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * h**2),
        (at(0, 1) + at(0, -1) - 2 * at(0, 0)) / h**2,
    ]
    found = surface.derivatives(np.array([u]), np.array([v]))[1:, 0]
    scale = np.maximum(np.abs(found).max(axis=1, keepdims=True), 10.0)
    assert (np.abs(found - numeric) / scale).max() < 1e-3


def test_the_distance_to_a_plane_blade_is_that_of_arithmetic() -> None:
    blade = plane_blade()
    points = np.random.default_rng(4).uniform([-10, -15, -10], [50, 15, 30], (400, 3))
    x, y = np.clip(points[:, 0], 0.0, 40.0), points[:, 1]
    z = np.clip(points[:, 2], -4.0, 24.0)
    expected = np.sqrt((points[:, 0] - x) ** 2 + y**2 + (points[:, 2] - z) ** 2) - 1.0
    np.testing.assert_allclose(blade.distances(points)[0], expected, atol=1e-9)


def test_a_wedge_has_flat_flanks_that_touch_all_its_balls() -> None:
    blade = plane_blade(2.0, 1.0)
    centre, normal = blade.sides(np.array([0.0, 0.3, 0.9]), np.array([0.2, 0.5, 0.7]), 1.0)
    np.testing.assert_allclose(normal[0], normal[2], atol=1e-12)
    assert abs(normal[0, 0]) == pytest.approx(1.0 / 40.0)  # the radius falls by 1 mm over 40
    flank = centre + blade.halves(np.array([0.0, 0.3, 0.9]), np.array([0.2, 0.5, 0.7]))[:, None] * normal
    np.testing.assert_allclose((flank - flank[0]) @ normal[0], 0.0, atol=1e-12)


@pytest.mark.parametrize("away", [0.0, 0.3, 2.0])
def test_points_off_the_blade_along_its_normals_are_as_far_away(published: Impeller, away: float) -> None:
    blade, rng = published.blade, np.random.default_rng(5)
    w, v = rng.random(300), blade.low + rng.random(300) * (blade.high - blade.low)
    for side in (1.0, -1.0):
        centre, normal = blade.sides(w, v, side)
        found, _ = blade.distances(centre + (blade.halves(w, v) + away)[:, None] * normal)
        np.testing.assert_allclose(found, away, atol=1e-10)
    for end in (0.0, 1.0):
        centre, normal = blade.edge(end, rng.random(300), v)
        found, _ = blade.distances(centre + (blade.halves(np.full(300, end), v) + away)[:, None] * normal)
        np.testing.assert_allclose(found, away, atol=1e-10)


def test_the_nearest_ball_is_found_at_edges_where_parameters_are_skew() -> None:
    impeller = build_impeller(mixed_flow())
    for blade, _ in list(impeller.blades())[:2]:
        for end in (0.0, 1.0):
            turn, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 61)))
            centre, normal = blade.edge(end, turn, v)
            for away in (0.5, 2.0, 6.0):
                points = centre + (blade.halves(np.full(len(v), end), v) + away)[:, None] * normal
                found = blade.distances(points)[0]
                assert found.max() < away + 1e-10
                assert away > 0.5 or found.min() > away - 1e-10  # farther off, another part of the blade may be nearer


def test_no_ball_of_the_blade_is_nearer_than_its_distance(published: Impeller) -> None:
    blade = published.blade
    w, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 161), np.linspace(blade.low, blade.high, 81)))
    frames = blade.frames(w, v)
    points = np.random.default_rng(6).uniform([0, -20, 0], [48, 20, 40], (150, 3))
    dense = np.array([(np.linalg.norm(frames[0] - point, axis=1) - frames[3, :, 0]).min() for point in points])
    found = blade.distances(points)[0]
    assert (found <= dense + 1e-12).all()
    assert (dense - found)[dense > 1.0].max() < 0.02  # the grid is 0.4 mm wide


def test_the_blade_is_as_thick_as_the_definition_says_and_ends_where_the_points_end(published: Impeller) -> None:
    blade = published.blade
    for v, thickness, curve in ((0.0, 2.0, published.curves[0]), (1.0, 1.2, published.curves[-1])):
        at = np.array([v])
        assert 2.0 * blade.halves(np.array([0.5]), at)[0] == pytest.approx(thickness)
        lead = blade.frames(np.zeros(1), at)[0, 0]
        assert np.linalg.norm(lead - curve.points(np.zeros(1))[0]) == pytest.approx(thickness / 2.0, rel=1e-2)
        trail = blade.frames(np.ones(1), at)[0, 0]
        assert np.hypot(*trail[:2]) - thickness / 2.0 > 45.0


def test_a_ball_in_the_fillet_touches_blade_and_hub_and_rolls_perpendicular_to_both(published: Impeller) -> None:
    stations = root_stations(121, 20, round_trailing=False)
    fillet = root_fillet(published.blade, published.hub, 2.0, stations)
    np.testing.assert_allclose(published.blade.distances(fillet.centre)[0], 2.0, atol=1e-9)
    np.testing.assert_allclose(published.hub.distances(fillet.centre)[0], 2.0, atol=1e-9)
    steps = np.diff(fillet.centre, axis=0)
    for contact in (fillet.to_blade, fillet.to_hub):
        middle = (contact[1:] + contact[:-1]) / 2.0
        assert np.abs(np.einsum("ij,ij->i", steps, middle) / np.linalg.norm(steps, axis=1)).max() < 0.01
    np.testing.assert_allclose(published.blade.distances(fillet.centre + 2.0 * fillet.to_blade)[0], 0.0, atol=1e-9)
    np.testing.assert_allclose(published.hub.distances(fillet.centre + 2.0 * fillet.to_hub)[0], 0.0, atol=1e-9)


def test_a_profile_is_its_curve_turned_about_z_and_goes_on_straight() -> None:
    angle = np.linspace(0.0, 2.0, 600)
    spiral = np.column_stack(((10 + 5 * angle) * np.cos(angle), (10 + 5 * angle) * np.sin(angle), 30 - 10 * angle))
    profile = Profile.of_curve(interpolate(spiral, parameters_of(spiral)))
    points = np.array([[10.0, 0.0, 30.0], [0.0, 12.5, 25.0], [-5.0, 0.0, 40.0], [25.0, 0.0, 0.0], [12.0, 0.0, 31.0]])
    # The profile is the straight line from (10, 30) to (20, 10).
    normal = np.array([2.0, 1.0]) / np.sqrt(5.0)
    flat = np.column_stack((np.hypot(points[:, 0], points[:, 1]), points[:, 2])) - [10.0, 30.0]
    found, normals, _ = profile.distances(points)
    np.testing.assert_allclose(found, flat @ normal, atol=0.02)
    np.testing.assert_allclose(normals[1], [0.0, normal[0], normal[1]], atol=1e-5)


def test_a_known_distance_is_kept_where_it_is_less(published: Impeller) -> None:
    blade, rng = published.blade, np.random.default_rng(7)
    points = rng.uniform([-60, -60, -10], [60, 60, 60], (2000, 3))
    distance = blade.distances(points)[0]
    known = distance + rng.choice([-5.0, -1e-3, 0.0, 1e-3, 5.0, np.inf], len(points))
    np.testing.assert_array_equal(blade.nearer(points, known), np.minimum(distance, known))


def test_distances_do_not_depend_on_the_points_before(published: Impeller) -> None:
    points = np.random.default_rng(8).uniform([0, -20, 0], [48, 20, 40], (500, 3))
    together = published.blade.distances(points)
    alone = [published.blade.distances(point[None]) for point in points]
    np.testing.assert_array_equal(together[0], [distance[0] for distance, _ in alone])
    np.testing.assert_array_equal(together[1], [place[0] for _, place in alone])
