"""What keeps most rays from the search: intervals of many rays in one pose, and outlines of a tool in motion."""

import math

import numpy as np
import pytest

from trunnion.arrays import Floats, Floats2
from trunnion.simulation.cutting.motion_bounds import EDGES, outline, within
from trunnion.simulation.cutting.pose_kernel import U, V, at_pose, found_at, new_work
from trunnion.simulation.cutting.ray_kernel import hits_between
from trunnion.simulation.cutting.tool_table import Motion, Piece, axis_between, element_table, piece_list
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import BodySizes, ball, bull, flat
from trunnion.simulation.tools.text import parse_tool

#: How far facets of round corners may be beside them, mm.
FACETS = 0.01

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


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize("axis", AXES, ids=["up", "leans", "nearly level", "level", "down"])
def test_many_rays_are_hit_as_each_alone(shape: ToolShape, axis: tuple[float, float, float]) -> None:
    piece, table = cutter(shape)
    motion, work = motion_from(axis), new_work()
    places = np.random.default_rng(1).uniform(-4.0, 4.0, (60, 2))
    for k, (u, v) in enumerate(places.tolist()):
        work[U + k], work[V + k] = u, v
    at_pose(work, len(places), motion, 1.0, piece, table)
    found = 0
    for k, (u, v) in enumerate(places.tolist()):
        one, other = found_at(work, k), hits_between(u, v, motion, 1.0, piece, table)
        assert one.hit == other.hit
        if not one.hit:
            continue
        assert (one.first, one.last) == pytest.approx((other.first, other.last), abs=1e-9)
        assert (one.on_first, one.on_last) == (other.on_first, other.on_last)
        before = hits_between(u, v, motion, 1.0 - 1e-6, piece, table)
        if (before.on_first, before.on_last) == (other.on_first, other.on_last):
            slopes = (other.first - before.first) / 1e-6, (other.last - before.last) / 1e-6
            assert (one.down, one.up) == pytest.approx(slopes, rel=2e-2, abs=2e-3)
            found += 1
    assert found > 5


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
