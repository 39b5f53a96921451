"""The path of the tool's centre: figures by hand, and what holds for every path."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.plane_figures import figure, line, pieces, spaced, turning_paths
from trunnion.compensation.offsets import Fault, centre_path
from trunnion.compensation.styles import CIRCLES, MEETINGS, OWN_ENTRY, STYLES, TYPE_A

#: Clockwise around a square, from outside and back.
SQUARE = figure(-10 - 10j, 0j, 20j, 20 + 20j, 20, 0j, -10 - 10j)


def test_outer_corners_get_circles_and_bounds_are_square() -> None:
    found = centre_path(SQUARE, 2.0, STYLES[CIRCLES], leaves=True)
    assert pieces(found.path) == [
        line(-2), line(-2 + 20j), (22j, 20j, -1), line(20 + 22j), (22 + 20j, 20 + 20j, -1), line(22), (20 - 2j, 20, -1),
        line(-2j), line(-10 - 10j),
    ]  # fmt: skip
    assert found.of.tolist() == [0, 1, 2, 2, 3, 3, 4, 4, 5]
    assert found.faults == ()


def test_inner_corners_meet() -> None:
    found = centre_path(SQUARE, -2.0, STYLES[CIRCLES], leaves=True)
    assert pieces(found.path) == [line(each) for each in (2, 2 + 18j, 18 + 18j, 18 + 2j, 2j, -10 - 10j)]
    assert found.own.all()


@pytest.mark.parametrize("style", [MEETINGS, TYPE_A])
def test_right_angles_meet_where_a_control_makes_no_circles(style: int) -> None:
    found = centre_path(SQUARE, 2.0, STYLES[style], leaves=True)
    assert {-2 + 22j, 22 + 22j, 22 - 2j} <= {end for end, _, _ in pieces(found.path)}
    assert not found.path.sense.any()


def test_sharp_corners_are_cut_off_square_by_fanuc_and_rounded_by_sinumerik() -> None:
    path = figure(-10j, 0j, 20, 10 + 1j, 10 + 20j)
    cut = centre_path(path, -1.0, STYLES[TYPE_A], leaves=True)
    assert not cut.path.sense.any()
    assert pieces(cut.path)[2] == line(21 - 1j)
    assert STYLES[MEETINGS].sharpest < abs(np.angle((10 + 1j - 20) / 20))
    rounded = centre_path(path, -1.0, STYLES[MEETINGS], leaves=True)
    assert (rounded.path.sense == 1).sum() == 1


def test_linuxcnc_begins_beside_its_first_line() -> None:
    found = centre_path(SQUARE, -2.0, STYLES[OWN_ENTRY], leaves=True)
    root = math.sqrt(2.0)
    assert pieces(found.path)[0] == line(complex(*np.round((root, -root), 6)))
    assert pieces(found.path)[1] == (2, 0j, 1)


def test_a_circle_keeps_its_centre() -> None:
    found = centre_path(
        figure(-5 - 5j, 0j, 10, (20 + 10j, 10 + 10j, 1), 20 + 30j, 40 + 30j), 3.0, STYLES[CIRCLES], leaves=True
    )
    assert pieces(found.path)[:4] == [line(3j), line(10 + 3j), (17 + 10j, 10 + 10j, 1), line(17 + 30j)]


def test_where_no_tool_fits() -> None:
    style = STYLES[CIRCLES]
    circle = figure(-5 - 5j, 0j, 10, (20 + 10j, 10 + 10j, 1), 20 + 30j, 40 + 30j)
    assert centre_path(circle, 11.0, style, leaves=True).faults == ((2, Fault.TIGHT),)
    slot = figure(-10j, 0j, 10, 10 + 3j, 0 + 3j, 0 + 20j)
    assert centre_path(slot, 2.0, style, leaves=True).faults == ((2, Fault.TIGHT),)
    on_circle = figure(0j, (10 + 10j, 10j, 1), 10 + 20j, 30 + 20j)
    assert centre_path(on_circle, 1.0, style, leaves=True).faults == ((0, Fault.ON_CIRCLE),)
    assert centre_path(SQUARE, 15.0, STYLES[OWN_ENTRY], leaves=True).faults[0] == (0, Fault.SHORT_ENTRY)
    assert centre_path(figure(0j, 10, 10 + 10j), 1.0, style, leaves=True).faults == ((0, Fault.NO_CONTOUR),)


def test_no_offset_is_the_path_itself() -> None:
    for style in STYLES.values():
        found = centre_path(SQUARE, 0.0, style, leaves=True)
        assert pieces(found.path) == pieces(SQUARE)
        assert found.faults == ()


@settings(max_examples=examples(60))
@given(turning_paths(), st.sampled_from([-1.0, 1.0]), st.sampled_from(list(STYLES)))
def test_the_centre_keeps_its_distance(contour: list[tuple[complex, complex, int]], left: float, key: int) -> None:
    """Beside each element exactly the radius; at its outer corners no less."""
    first, style = contour[1], STYLES[key]
    ahead = figure(0j, *contour[1:]).directions()[0][0]
    path = figure(-20.0 * ahead, *contour)
    found = centre_path(path, left, style, leaves=False)
    if found.faults:
        return
    assert first
    points = spaced(found.path, 20)
    for k, (of, own) in enumerate(zip(found.of, found.own, strict=True)):
        if not of:
            continue
        near = {int(of), int(of) - 1} - {0} if not own else {int(of)}
        distance = min(_distance(path, element, point) for element in near for point in points[k])
        assert distance >= abs(left) * np.cos(style.smooth) - 1e-6
        if own and style.smooth < 1e-3:
            assert max(_distance(path, int(of), point) for point in points[k]) == pytest.approx(abs(left), abs=1e-6)


def _distance(path, element: int, point: complex) -> float:  # type: ignore[no-untyped-def]
    """From a point to an element, whose ends count as points."""
    start, end, centre = complex(path.start[element]), complex(path.end[element]), complex(path.centre[element])
    ends = min(abs(point - start), abs(point - end))
    if not path.sense[element]:
        part = ((point - start) * (end - start).conjugate()).real / abs(end - start) ** 2
        return abs(point - start - part * (end - start)) if 0.0 <= part <= 1.0 else ends
    angle = np.mod(path.sense[element] * np.angle((point - centre) / (start - centre)), 2.0 * np.pi)
    swept = path.swept()[element]
    return abs(abs(point - centre) - abs(start - centre)) if angle <= swept else ends
