"""Distances between tools and an impeller against dense samples of both, and against arithmetic."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.extras import import_extra
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller, rotated
from trunnion.impeller.paths.cell_trees import STEPS, cell_tree, joined
from trunnion.impeller.paths.clearance import (
    SLACK,
    Margins,
    Obstacles,
    distances_of,
    margins_of,
    obstacles_of,
    tool_body,
)
from trunnion.impeller.paths.clearance_kernel import BodyData
from trunnion.simulation.tools.profile import Role, ToolShape
from trunnion.simulation.tools.shapes import BodyPiece, ball, flat

PUBLISHED = Path(__file__).resolve().parents[3] / "examples" / "impeller" / "impeller.toml"

TOOL = ball(
    4.0,
    flute_length=12.0,
    length=45.0,
    neck_diameter=3.6,
    neck_length=22.0,
    shank_diameter=6.0,
    holder=(BodyPiece(20, 24, 30), BodyPiece(40, 40, 20)),
)

NOTHING = Margins(0.0, 0.0, 0.0, 1.0)


@pytest.fixture(scope="module")
def impeller() -> Impeller:
    return build_impeller(read_impeller(PUBLISHED))


@pytest.fixture(scope="module")
def obstacles(impeller: Impeller) -> Obstacles:
    return obstacles_of(impeller)


def to_section(section: list[tuple[float, float]], r: Floats, z: Floats) -> Floats:
    """Distance of points to a revolved polygon: that to dense points of its outline."""
    corners = np.array([(0.0, section[0][1]), *section, (0.0, section[-1][1])])
    share = np.linspace(0.0, 1.0, 500)[:, None]
    outline = np.vstack([a + share * (b - a) for a, b in pairwise(corners)])
    tree = import_extra("scipy.spatial", "impeller").cKDTree(outline)
    return np.asarray(tree.query(np.column_stack((r, z)))[0])


def height_and_radius(points: Floats, centre: Floats, axis: Floats) -> tuple[Floats, Floats]:
    away = points - centre
    z = away @ axis
    return z, np.linalg.norm(away - z[:, None] * axis, axis=1)


def parts(shape: ToolShape, radius: float) -> dict[Role, list[tuple[float, float]]]:
    """Half sections of cutter, shank and holder above the ball's centre, of a tool of lines."""
    found: dict[Role, list[tuple[float, float]]] = {}
    for section in shape.sections:
        for element in section.outline:
            for r, z in (element.start, element.end):
                if z >= radius - 1e-9 and element.start[1] < element.end[1]:
                    found.setdefault(section.role, []).append((r, z - radius))
    return found


@settings(max_examples=examples(12))
@given(st.integers(0, 2**31))
def test_distances_are_those_of_dense_samples(impeller: Impeller, obstacles: Obstacles, seed: int) -> None:
    """Balls of blade 2 and points of the hub, half a mm apart, against the tool's outline; less is never told."""
    rng = np.random.default_rng(seed)
    w, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0.0, 1.0, 181), np.linspace(0.0, 1.0, 61)))
    frames = impeller.blade.frames(w, v)
    inside = (impeller.shroud.distances(frames[0])[0] <= 0.0) & (np.hypot(frames[0][:, 0], frames[0][:, 1]) <= 45.0)
    inside &= impeller.hub.distances(frames[0])[0] >= 0.0
    blade, half = rotated(frames[0][inside], np.pi / 3.0), frames[3, inside, 0]
    curve = impeller.hub.curve.points(np.linspace(0.001, 0.999, 101))[:, [0, 2]]
    outline = np.vstack(([[0.0, 35.0]], curve, [[45.0, 0.0], [0.0, 0.0]]))
    steps = np.linspace(0.0, 1.0, 60)[:, None]
    profile = np.vstack([curve, *(a + steps * (b - a) for a, b in (outline[:2], outline[-3:-1], outline[-2:]))])
    profile = np.column_stack((profile[:, 0], np.zeros(len(profile)), profile[:, 1]))
    hub = np.vstack([rotated(profile, angle) for angle in np.linspace(0.0, 2.0 * np.pi, 600)])
    body = tool_body(TOOL, 2.0, NOTHING)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    k = int(rng.integers(len(blade)))
    centre = blade[k] + rng.uniform(4.0, 20.0) * np.array([np.cos(2.0), np.sin(2.0), 1.0]) + rng.normal(size=3)
    told = distances_of(obstacles, body.real, centre[None], axis[None], 100.0)[0]
    number = {role: [k for k, one in enumerate(body.roles) if one is role] for role in Role}
    for role, section in parts(TOOL, 2.0).items():
        if role is Role.CUTTER:
            section = [(2.0, 2.0), (2.0, 10.0)]  # from one radius above the ball's centre
        for points, sizes, name in ((blade, half, "blade 2"), (hub, np.zeros(len(hub)), "the hub")):
            z, r = height_and_radius(points, centre, axis)
            sampled = float((to_section(section, r, z) - sizes).min())
            bodies = [j for j, one in enumerate(obstacles.names) if one == name]
            found = float(told[np.ix_(number[role], bodies)].min())
            if sampled < 0.3:
                continue  # within each other: samples of outlines do not tell how deep
            assert found <= sampled + 1e-3
            # The kernel takes whole cells where shroud and stock cut the blade, and balls that only stick into them.
            assert found >= sampled - (2.5 if name == "blade 2" else 0.1)


@settings(max_examples=examples(15))
@given(st.integers(0, 2**31))
def test_a_curved_body_is_as_far_as_its_samples(seed: int) -> None:
    rng = np.random.default_rng(seed)
    counts = (64, 32)
    s, t = np.meshgrid(*(np.linspace(0.0, 1.0, STEPS * n + 1) for n in counts), indexing="ij")
    bend = rng.uniform(-8.0, 8.0, 3)

    def surface(s: Floats, t: Floats) -> Floats:
        z = bend[0] * s * s + bend[1] * s * t + bend[2] * t * t
        return np.stack((30.0 * s, 15.0 * t, z, 1.0 - 0.4 * t), axis=-1)

    tree = joined([cell_tree(surface(s, t), np.ones(counts, np.bool_))])
    obstacles = Obstacles(BodyData(tree[0], tree[1], tree[2], np.array([[1.0, 0.0]])), ("body",))
    body = tool_body(TOOL, 2.0, NOTHING)
    axis = rng.normal(size=3) * np.array([1.0, 1.0, 0.3]) + np.array([0.0, 0.0, 1.5])
    axis /= np.linalg.norm(axis)
    centre = np.array([rng.uniform(0, 30), rng.uniform(0, 15), rng.uniform(6, 25)])
    told = distances_of(obstacles, body.real, centre[None], axis[None], 100.0)[0, :, 0]
    dense = surface(*np.meshgrid(np.linspace(0.0, 1.0, 81), np.linspace(0.0, 1.0, 41), indexing="ij")).reshape(-1, 4)
    z, r = height_and_radius(dense[:, :3], centre, axis)
    sections = parts(TOOL, 2.0)
    cylinder = [(2.0, 2.0), (2.0, 10.0)]
    sampled = float((to_section(cylinder, r, z) - dense[:, 3]).min())
    if sampled > 0.2:
        assert sampled - 0.03 <= told[0] <= sampled + 1e-3
    sampled = float((to_section(sections[Role.HOLDER], r, z) - dense[:, 3]).min())
    if sampled > 0.2:
        assert sampled - 0.03 <= told[-2:].min() <= sampled + 1e-3


def test_the_margin_beside_the_ball_grows_with_the_height() -> None:
    """A plane that the ball touches: an axis in it is not clear, one that leans by the angle asked for is."""
    x, y = np.meshgrid(np.linspace(-40.0, 40.0, 4 * STEPS + 1), np.linspace(-40.0, 40.0, 4 * STEPS + 1), indexing="ij")
    tree = joined([cell_tree(np.stack((x, y, -2.0 + 0 * x, 0 * x), axis=-1), np.ones((4, 4), np.bool_))])
    obstacles = Obstacles(BodyData(tree[0], tree[1], tree[2], np.array([[1.0, 0.0]])), ("plane",))
    body = tool_body(ball(4.0, flute_length=12.0, length=12.0), 2.0, Margins(0.2, 0.5, 2.0, 3.0))
    lean = np.radians([0.0, 2.5, 3.5, 60.0])
    axes = np.column_stack((np.cos(lean), np.zeros(4), np.sin(lean)))
    margin = margins_of(obstacles, body.wide, np.zeros((4, 3)), axes, -1.0, 1.0)
    assert (margin[:2] < 0.0).all()
    assert (margin[2:] >= 0.0).all()
    # One radius above its centre, the cutter's side is at 2 mm · sin, less the radius that cos takes from its rim.
    distance = distances_of(obstacles, body.real, np.zeros((4, 3)), axes, 9.0)[:, 0, 0]
    np.testing.assert_allclose(distance, 2.0 + 2.0 * np.sin(lean) - 2.0 * np.cos(lean), atol=2e-3)
    assert margin[2] <= SLACK + 0.01


def test_what_is_beyond_shroud_and_stock_is_no_obstacle(impeller: Impeller, obstacles: Obstacles) -> None:
    body = tool_body(TOOL, 2.0, NOTHING)
    upright = np.array([[0.0, 0.0, 1.0]])
    above = np.array([[0.0, 0.0, 40.0]])
    assert distances_of(obstacles, body.real, above, upright, 50.0).min() == pytest.approx(7.0, abs=0.01)
    radius = impeller.definition.stock.diameter / 2.0
    beside = np.array([[radius + 20.0, 0.0, 3.0]])
    # The hub's rim ends below the cutter's lower end; the stock's edge is 20 mm from the axis.
    told = distances_of(obstacles, body.real, beside, upright, 50.0)
    assert told[0, 0].min() == pytest.approx(18.0, abs=0.02)


def test_a_tool_without_this_ball_is_refused() -> None:
    for tool in (flat(4.0), ball(6.0)):
        with pytest.raises(InputError, match="no ball of radius 2 mm"):
            tool_body(tool, 2.0, NOTHING)
