"""The convex pieces of tools: against the volumes and the outlines of solids of revolution."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.tools import cutter_radius, cutter_sizes, piece_radius, pieces_volume
from trunnion.simulation.tools.pieces import RevolvedPieces, revolved_pieces
from trunnion.simulation.tools.shapes import BodyPiece, ToolKind, ball, bull, flat, tool_shape

SIZES = st.floats(0.5, 80.0)
SHARES = st.floats(0.05, 1.0)


def corner_volume(radius: float, corner: float) -> float:
    """Of the lowest ``corner`` mm of a bull nose mill, by the integral of its section."""
    core = radius - corner
    return math.pi * corner * (core**2 + 0.5 * math.pi * core * corner + 2.0 / 3.0 * corner**2)


@given(SIZES, SHARES)
def test_a_flat_mill_is_a_cylinder(diameter: float, share: float) -> None:
    pieces, error = revolved_pieces(flat(diameter, length=share * 100.0), 0.01)
    assert error == 0.0
    assert pieces_volume(pieces) == pytest.approx(math.pi * diameter**2 / 4 * share * 100.0)


@given(SIZES)
def test_a_ball_mill_is_half_a_sphere_and_a_cylinder(diameter: float) -> None:
    pieces, error = revolved_pieces(ball(diameter, length=100.0), 0.01)
    radius = diameter / 2
    assert error == 0.0
    assert len(pieces.elements) == 2
    assert pieces_volume(pieces) == pytest.approx(math.pi * radius**2 * (100.0 - radius / 3))


@given(SIZES, SHARES, st.sampled_from([1e-5, 1e-3, 0.1]))
def test_a_bull_nose_mill_keeps_within_the_tolerance(diameter: float, share: float, tolerance: float) -> None:
    radius, corner = diameter / 2, share * diameter / 2
    pieces, error = revolved_pieces(bull(diameter, corner, length=100.0), tolerance)
    whole = corner_volume(radius, corner) + math.pi * radius**2 * (100.0 - corner)
    surface = 2 * math.pi * radius * 0.5 * math.pi * corner
    assert error <= tolerance
    assert abs(pieces_volume(pieces) - whole) <= error * surface + 1e-9 * whole
    assert off_corner(pieces, corner, radius - corner) <= error + 1e-9


def off_corner(pieces: RevolvedPieces, corner: float, core: float) -> float:
    """How far points on the frusta of a bull nose mill are off its corner."""
    z = np.linspace(0.0, corner, 500)
    return float(np.abs(np.hypot(piece_radius(pieces, 0, z) - core, z - corner) - corner).max())


@pytest.mark.parametrize("kind", ToolKind)
@settings(max_examples=examples(12))
@given(st.data())
def test_a_cutter_has_the_volume_that_its_sizes_mean(kind: ToolKind, data: st.DataObject) -> None:
    sizes = data.draw(cutter_sizes(kind))
    shape = tool_shape(sizes)
    pieces, error = revolved_pieces(shape, 1e-4)
    cuts = pieces_volume(pieces)
    z = np.linspace(0.0, shape.flute_length, 8001)
    middles = 0.5 * (z[1:] + z[:-1])
    meant = float(np.sum(math.pi * cutter_radius(sizes, middles) ** 2)) * (z[1] - z[0])
    assert error <= 1e-4
    assert shape.sections[0].top == pytest.approx(shape.flute_length)
    assert cuts == pytest.approx(meant, rel=5e-4)


@pytest.mark.parametrize("kind", ToolKind)
@settings(max_examples=examples(12))
@given(st.data(), st.sampled_from([1e-4, 0.1]), st.lists(SIZES, min_size=2, max_size=6))
def test_every_piece_is_convex(kind: ToolKind, data: st.DataObject, tolerance: float, above: list[float]) -> None:
    sizes = data.draw(cutter_sizes(kind))
    cones = tuple(BodyPiece(low, high, 10.0) for low, high in pairwise(above))
    shape = tool_shape(
        replace(sizes, length=400.0, neck_length=390.0 * bool(sizes.neck_diameter), shank=cones[:2], holder=cones)
    )
    pieces, _ = revolved_pieces(shape, tolerance)
    assert len(pieces.elements) == pieces.first[-1]
    for piece in range(len(pieces.cuts)):
        low, high, widest = pieces.bounds[piece]
        z = np.linspace(low, high, 60)[1:-1]
        r = piece_radius(pieces, piece, z)
        assert r.max() <= widest + 1e-9
        assert np.all(r[1:-1] >= 0.5 * (r[:-2] + r[2:]) - 1e-6)
    # Without gaps, and without an overlap.
    assert pieces.bounds[1:, 0] == pytest.approx(pieces.bounds[:-1, 1], abs=1e-8)


def test_pieces_say_what_they_belong_to() -> None:
    shape = ball(
        10.0, length=60.0, flute_length=20.0, shank_diameter=12.0, neck_diameter=9.0, neck_length=40.0,
        holder=(BodyPiece(40.0, 40.0, 50.0), BodyPiece(30.0, 60.0, 30.0)),
    )  # fmt: skip
    pieces, _ = revolved_pieces(shape, 0.01)
    assert pieces.section.tolist() == [0, 1, 1, 2, 3]
    assert pieces.cuts.tolist() == [True, False, False, False, False]
    assert pieces.bounds.tolist() == [
        [0.0, 20.0, 5.0], [20.0, 40.0, 4.5], [40.0, 60.0, 6.0], [60.0, 110.0, 20.0], [110.0, 140.0, 30.0],
    ]  # fmt: skip
    assert shape.length == 140.0
    assert not any(array.flags.writeable for array in pieces)


def test_a_tolerance_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="tolerance"):
        revolved_pieces(flat(10.0), 0.0)
