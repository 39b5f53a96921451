"""Points that are left out come back when a control moves from one that stays to the next."""

import math
from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from trunnion.impeller.paths.thinning import thinned


def moved(centre: np.ndarray, axis: np.ndarray, keep: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """How far ball centres are off what a control makes of the points that stay, mm, and tool axes, degrees."""
    rows = np.flatnonzero(keep)
    tips = centre - radius * axis
    off, turned = np.zeros(len(centre)), np.zeros(len(centre))
    for first, last in pairwise(rows):
        share = np.linspace(0.0, 1.0, 2001)[:, None]
        between = axis[first] + share * (axis[last] - axis[first])
        between /= np.linalg.norm(between, axis=1)[:, None]
        balls = tips[first] + share * (tips[last] - tips[first]) + radius * between
        along = np.diff(balls, axis=0)
        for row in range(first + 1, last):
            away = centre[row] - balls[:-1]
            part = np.clip((away * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-30), 0.0, 1.0)
            apart = np.linalg.norm(away - part[:, None] * along, axis=1)
            k = int(apart.argmin())
            off[row], turned[row] = apart[k], math.degrees(math.acos(min(between[k] @ axis[row], 1.0)))
    return off, turned


@given(
    bend=st.floats(0.0, 0.2), twist=st.floats(0.0, 0.05), radius=st.sampled_from([0.0, 2.0, 5.0]),
    tolerance=st.sampled_from([0.002, 0.01, 0.1]),
)  # fmt: skip
def test_what_is_left_out_is_within_the_tolerances(bend: float, twist: float, radius: float, tolerance: float) -> None:
    s = np.linspace(0.0, 20.0, 101)
    centre = np.column_stack((s, bend * np.sin(s), 0.3 * bend * s**2 / 20.0))
    axis = np.column_stack((np.sin(twist * s), np.zeros(len(s)), np.cos(twist * s)))
    keep = thinned(centre, axis, radius, tolerance, 0.05)
    assert keep[0]
    assert keep[-1]
    off, turned = moved(centre, axis, keep, radius)
    assert off.max() <= tolerance + 1e-6
    assert turned.max() <= 0.05 + math.degrees(twist * (tolerance + 0.02))  # the nearest ball is elsewhere in time


def test_a_straight_path_keeps_its_ends_only() -> None:
    centre = np.column_stack((np.linspace(0.0, 10.0, 150), np.zeros(150), np.zeros(150)))
    keep = thinned(centre, np.tile([0.0, 0.0, 1.0], (150, 1)), 3.0, 0.001, 0.05)
    assert np.flatnonzero(keep).tolist() == [0, 149]


def test_a_turn_of_the_axis_alone_keeps_points() -> None:
    angle = np.linspace(0.0, 0.5, 101)
    axis = np.column_stack((np.sin(angle), np.zeros(101), np.cos(angle)))
    keep = thinned(np.column_stack((angle, angle, angle)), axis, 2.0, 0.005, 0.05)
    assert 3 <= keep.sum() < 101


def test_no_point_and_one_point_stay() -> None:
    assert thinned(np.zeros((0, 3)), np.zeros((0, 3)), 1.0, 0.01, 0.1).tolist() == []
    assert thinned(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), 1.0, 0.01, 0.1).tolist() == [True]
