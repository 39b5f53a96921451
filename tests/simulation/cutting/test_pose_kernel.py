"""What keeps most rays from the search: intervals of many rays in one pose, and outlines of a tool in motion."""

import math

import numpy as np
import pytest

from trunnion.arrays import Floats, Floats2
from trunnion.simulation.cutting.motion_bounds import EDGES, outline, within
from trunnion.simulation.cutting.pose_kernel import U, V, at_part, at_pose, found_at, new_work
from trunnion.simulation.cutting.tool_table import Motion, Piece, axis_between, element_table, piece_list
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import BodySizes, ball, bull, flat
from trunnion.simulation.tools.text import parse_tool

#: How far facets of round corners may be beside them, mm.
FACETS = 0.01

#: How many heights along a ray are looked at, and how far they are apart, mm.
HEIGHTS = (2000, 0.02)

BODY: BodySizes = {"flute_length": 12.0, "length": 60.0}
SHAPES = {
    "ball": ball(6.0, **BODY),
    "flat": flat(6.0, **BODY),
    "bull": bull(8.0, 1.5, **BODY),
    "taper": parse_tool("1=taper:3,8,length=60,flutes=12", {}),
}
AXES = [(0.0, 0.0, 1.0), (0.3, -0.2, 0.9), (0.9, 0.1, 0.02), (1.0, 0.0, 0.0), (-0.2, 0.3, -0.8)]


def cutter(shape: ToolShape) -> tuple[Piece, Floats2]:
    pieces, _ = revolved_pieces(shape, FACETS)
    table = element_table(pieces)
    first, end, *rest = piece_list(pieces, table)[0].tolist()
    return Piece(int(first), int(end), *rest), table


def motion_from(axis: tuple[float, float, float]) -> Motion:
    start = np.array(axis) / np.linalg.norm(axis)
    end = start + np.array((0.02, -0.01, 0.005))
    end /= np.linalg.norm(end)
    values = np.concatenate(((0.2, -0.3, 0.1), start, (0.5, 0.7, -0.2), end))
    return Motion(*values.tolist())


@pytest.mark.third
@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize("axis", AXES, ids=["up", "leans", "nearly level", "level", "down"])
def test_rays_are_hit_where_the_tool_is(shape: ToolShape, axis: tuple[float, float, float]) -> None:
    piece, table = cutter(shape)
    motion, work = motion_from(axis), new_work()
    places = np.random.default_rng(1).uniform(-4.0, 4.0, (60, 2)).tolist()
    for k, (u, v) in enumerate(places):
        work[U + k], work[V + k] = u, v
    at_pose(work, 0, len(places), motion, 1.0, piece, table)
    found = 0
    for k, (u, v) in enumerate(places):
        ray, inside = found_at(work, k), _inside(shape, motion, 1.0, u, v)
        assert ray.hit == bool(len(inside)) or len(inside) < 5
        if not ray.hit or not len(inside):
            continue
        assert (ray.first, ray.last) == pytest.approx((inside[0], inside[-1]), abs=5.0 * HEIGHTS[1] + 10.0 * FACETS)
        before = at_part(u, v, work, motion, 1.0 - 1e-6, piece, table)
        if (before.on_first, before.on_last) == (ray.on_first, ray.on_last):
            slopes = (ray.first - before.first) / 1e-6, (ray.last - before.last) / 1e-6
            assert (ray.down, ray.up) == pytest.approx(slopes, rel=2e-2, abs=2e-3)
            found += 1
    assert found > 5


def _inside(shape: ToolShape, motion: Motion, s: float, u: float, v: float) -> Floats:
    """The heights along a ray at which it is within the cutter, of many."""
    axis = np.array(axis_between(motion, s))
    tip = np.array([motion.tu + s * motion.du, motion.tv + s * motion.dv, motion.tw + s * motion.dw])
    heights = -20.0 + np.arange(HEIGHTS[0]) * HEIGHTS[1]
    way = np.column_stack((np.full(len(heights), u), np.full(len(heights), v), heights)) - tip
    z = way @ axis
    away = np.linalg.norm(way - z[:, None] * axis, axis=1)
    within = np.zeros(len(heights), np.bool_)
    for element in shape.sections[0].outline:
        low, high = element.start[1], element.end[1]
        for n in np.flatnonzero((z >= low) & (z <= high) & (low < high)).tolist():
            within[n] |= bool(away[n] <= element.radius_at(float(z[n])))
    return np.asarray(heights[within])


@pytest.mark.third
@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize("axis", AXES, ids=["up", "leans", "nearly level", "level", "down"])
def test_an_outline_holds_the_tool_and_little_more(shape: ToolShape, axis: tuple[float, float, float]) -> None:
    piece, table = cutter(shape)
    motion, edges = motion_from(axis), np.empty(3 * EDGES)
    outline(edges, motion, piece, table, piece.low, piece.high)
    seen = np.array([point for s in (0.0, 0.6, 1.0) for point in _silhouette(shape, motion, s)])
    for u, v in seen[::50].tolist():
        lowest, highest = within(edges, u, v - 0.1, v + 0.1)
        assert lowest - 0.05 <= v <= highest + 0.05
    normals = edges.reshape(-1, 3)
    beyond = normals[:, 2] - (seen @ normals[:, :2].T).max(axis=0)
    assert beyond.min() > -FACETS
    assert beyond.max() < 0.05  # how coarse the points are


def _silhouette(shape: ToolShape, motion: Motion, s: float) -> Floats:
    """Points of the cutter's surface, seen along the rays, (n, 2)."""
    axis = np.array(axis_between(motion, s))
    across = np.cross(axis, (0.3, 0.9, 0.1))
    across /= np.linalg.norm(across)
    other = np.cross(axis, across)
    tip = np.array([motion.tu + s * motion.du, motion.tv + s * motion.dv])
    points = []
    for element in shape.sections[0].outline:
        for z in np.linspace(element.start[1], element.end[1], 8).tolist():
            for radius in (
                {element.start[0], element.end[0]} if element.start[1] == element.end[1] else {element.radius_at(z)}
            ):
                for turn in np.linspace(0.0, 2.0 * math.pi, 60).tolist():
                    place = z * axis + radius * (math.cos(turn) * across + math.sin(turn) * other)
                    points.append(tip + place[:2])
    return np.array(points)
