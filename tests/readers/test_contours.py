"""Corners and leads of contours, against what makes them: distances, directions and lengths."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.readers.control import arcs, contours
from trunnion.readers.control.contours import ContourError, Element

ANGLES = st.floats(0.0, 360.0)
CURVES = st.sampled_from([0, 1, -1])
PLANES = st.sampled_from([0, 1, 2])


def _point(u: float, v: float, plane: int, height: float = 3.0) -> Floats:
    point = np.zeros(3)
    point[(plane + 1) % 3], point[(plane + 2) % 3], point[plane] = u, v, height
    return point


def _way(degrees: float, plane: int) -> Floats:
    return _point(math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), plane, 0.0)


def _element(corner: Floats, degrees: float, curve: int, plane: int, *, ends: bool) -> Element:
    """A line of 40, or a quarter of a circle of radius 30, that begins or ends at a corner in a direction."""
    way = _way(degrees, plane)
    if not curve:
        return Element(corner - 40.0 * way, corner) if ends else Element(corner, corner + 40.0 * way)
    normal = arcs.normal_of(plane, curve < 0)
    centre = corner + 30.0 * np.cross(normal, way)
    other = centre + (30.0 if not ends else -30.0) * way
    start, end = (other, corner) if ends else (corner, other)
    return Element(start, end, arcs.Arc(end, centre, normal, 30.0))


@settings(max_examples=examples(150))
@given(ANGLES, ANGLES, CURVES, CURVES, st.floats(0.1, 3.0), PLANES)
def test_a_rounding_is_tangent_to_both_elements(
    first: float, second: float, before_curve: int, behind_curve: int, radius: float, plane: int
) -> None:
    corner = _point(10.0, -5.0, plane)
    before = _element(corner, first, before_curve, plane, ends=True)
    behind = _element(corner, second, behind_curve, plane, ends=False)
    angle = contours.corner_turn(before, behind, plane)
    turn = (second - first + 180.0) % 360.0 - 180.0
    assume(abs(angle) > 1e-3)
    assume(abs(angle) < 1.7)  # beyond that some circles are too near each other for an arc between them
    assert angle == pytest.approx(math.radians(turn))
    made = contours.rounding(before, behind, radius, plane)
    assert made.arc is not None
    arc = Element(made.first, made.last, made.arc)
    for element, point in ((before, made.first), (behind, made.last)):
        assert np.linalg.norm(point - made.arc.centre) == pytest.approx(radius)
        np.testing.assert_allclose(arc.direction(point), element.direction(point), atol=1e-7)
        if element.arc is None:
            np.testing.assert_allclose(np.cross(point - corner, element.direction(corner)), 0.0, atol=1e-9)
        else:
            assert np.linalg.norm(point - element.arc.centre) == pytest.approx(30.0)
        assert element.start[plane] == point[plane]
    assert 0.0 < before.length_between(made.first, corner) <= before.length
    assert 0.0 < behind.length_between(corner, made.last) <= behind.length
    assert float(made.arc.normal[plane]) == math.copysign(1.0, angle)
    # It turns less than half a turn, and stays on its side of the corner.
    assert 0.0 < arc.length_between(made.first, made.last) < math.pi * radius
    if not (before_curve or behind_curve):
        assert before.length_between(made.first, corner) == pytest.approx(radius * abs(math.tan(0.5 * angle)))


@settings(max_examples=examples(50))
@given(ANGLES, st.floats(-170.0, 170.0), st.floats(0.1, 10.0), PLANES)
def test_a_chamfer_cuts_the_same_off_both_lines(first: float, turn: float, side: float, plane: int) -> None:
    corner = _point(1.0, 2.0, plane)
    before = _element(corner, first, 0, plane, ends=True)
    behind = _element(corner, first + turn, 0, plane, ends=False)
    made = contours.chamfer(before, behind, side)
    np.testing.assert_allclose(made.first, corner - side * _way(first, plane), atol=1e-9)
    np.testing.assert_allclose(made.last, corner + side * _way(first + turn, plane), atol=1e-9)
    assert np.linalg.norm(made.last - made.first) == pytest.approx(2.0 * side * math.cos(math.radians(0.5 * turn)))


@pytest.mark.parametrize(
    ("turn", "curves", "radius", "variant"),
    [
        (90.0, (0, 0), 40.1, "too_short"),  # the lines are 40 mm long, and 40.1 would be cut off each
        (90.0, (1, 0), 30.5, "no_room"),  # inside a circle of radius 30
        (180.0, (0, 0), 1.0, "goes_back"),
    ],
)
def test_what_does_not_fit_is_refused(turn: float, curves: tuple[int, int], radius: float, variant: str) -> None:
    corner = _point(0.0, 0.0, 2)
    before, behind = (
        _element(corner, angle, curve, 2, ends=ends)
        for angle, curve, ends in ((0.0, curves[0], True), (turn, curves[1], False))
    )
    with pytest.raises(ContourError) as error:
        contours.rounding(before, behind, radius, 2)
    assert error.value.wording.variant == variant


def test_a_radius_that_uses_up_both_lines_fits() -> None:
    corner = _point(0.0, 0.0, 2)
    lines = _element(corner, 0.0, 0, 2, ends=True), _element(corner, 90.0, 0, 2, ends=False)
    made = contours.rounding(*lines, 40.0, 2)
    np.testing.assert_allclose(made.first, lines[0].start, atol=1e-9)
    np.testing.assert_allclose(made.last, lines[1].end, atol=1e-9)


@settings(max_examples=examples(50))
@given(ANGLES, st.floats(0.5, 9.0), st.floats(20.0, 60.0), st.floats(5.0, 175.0), st.sampled_from([1, -1]), PLANES)
def test_a_lead_to_a_point_is_tangent_to_the_contour_and_to_its_line(
    direction: float, radius: float, distance: float, aside: float, side: int, plane: int
) -> None:
    point, away = _point(4.0, 5.0, plane), _way(direction, plane)
    target = point + distance * _way(direction + side * aside, plane)
    made = contours.lead_to(point, away, radius, target.copy(), plane)
    assert made.arc is not None
    arc = Element(point, made.point, made.arc)
    np.testing.assert_allclose(arc.direction(point), away, atol=1e-9)
    np.testing.assert_allclose(arc.direction(made.point), Element(made.point, target).direction(target), atol=1e-7)
    assert np.linalg.norm(made.point - made.arc.centre) == pytest.approx(radius)
    assert float(made.arc.normal[plane]) == side
