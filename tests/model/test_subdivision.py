"""What happens between the rows."""

import numpy as np
import pytest

from tests.support.reading import Runner, close
from trunnion.machines import forward
from trunnion.model.subdivision import subdivide


def test_with_tcp_the_tip_goes_straight_and_the_angles_linearly(run: Runner) -> None:
    result = run("TRAORI\nORIAXES\nX0 Y0 Z0 B10 C0\nX10 Y0 Z0 B50 C80")
    samples = subdivide(result, 4, slice(1, 2))
    close(samples.tip, [[2.5, 0, 0], [5, 0, 0], [7.5, 0, 0], [10, 0, 0]], atol=1e-12)
    close(samples.joints[:, :2], [[20, 20], [40, 30], [60, 40], [80, 50]], atol=1e-12)
    tip, axis = forward(result.machine, samples.joints)
    close(tip, samples.tip, atol=1e-9)
    close(axis, samples.axis, atol=1e-12)
    assert samples.fraction.tolist() == [0.25, 0.5, 0.75, 1.0]
    assert samples.row.tolist() == [1, 1, 1, 1]


def test_without_tcp_the_axes_go_linearly_and_the_tip_where_they_take_it(run: Runner) -> None:
    result = run("G0 X10 Y0 Z0\nB90")
    samples = subdivide(result, 2, slice(1, 2))
    half = np.sqrt(0.5)
    close(samples.joints[0], [0, 45, 10, 0, 0])
    close(samples.tip[0], [10 * half, 0, -10 * half], atol=1e-12)


def test_on_a_great_circle_the_axis_stays_in_one_plane(run: Runner) -> None:
    result = run("TRAORI\nORIVECT\nX0 Y0 Z0 A3=1 B3=0 C3=1\nX1 A3=0 B3=1 C3=1")
    samples = subdivide(result, 10)
    second = samples.axis[samples.row == 1]
    normal = np.cross(result.axis[0], result.axis[1])
    close(second @ normal, 0, atol=1e-9)
    between = np.degrees(np.arccos(np.clip((second[1:] * second[:-1]).sum(axis=1), -1, 1)))
    close(between, 6.0, atol=1e-6)
    linear = subdivide(run("TRAORI\nORIAXES\nX0 Y0 Z0 A3=1 B3=0 C3=1\nX1 A3=0 B3=1 C3=1"), 10)
    assert np.abs(linear.axis[linear.row == 1] @ normal).max() > 0.01


def test_circles_are_round(run: Runner) -> None:
    result = run("G1 X10 Y0 Z0\nG3 X-10 Y0 I-10 J0\nG3 I10 J0\nG2 X0 Y10 Z5 CR=10 TURN=1")
    samples = subdivide(result, np.array([1, 8, 8, 16]))
    close(np.linalg.norm(samples.tip[:, :2], axis=1), 10, atol=1e-9)
    close(samples.tip[4], [0, 10, 0], atol=1e-9)
    close(samples.tip[12], [10, 0, 0], atol=1e-9)
    close(samples.tip[-1], [0, 10, 5], atol=1e-9)
    assert len(samples.row) == 33


def test_circles_on_a_tilted_table_agree_with_the_axes(run: Runner) -> None:
    result = run("B30 C20\nG1 X10 Y0 Z0\nG3 X-10 Y0 I-10 J0")
    samples = subdivide(result, 6, slice(2, 3))
    close(np.linalg.norm(samples.joints[:, 2:4], axis=1), 10, atol=1e-9)
    close(samples.joints[:, 4], 0, atol=1e-9)


def test_the_last_piece_is_the_row(run: Runner) -> None:
    result = run("TRAORI\nX1 Y2 Z3 B4 C5\nSUPA Z100\nX3")
    samples = subdivide(result, 3)
    np.testing.assert_array_equal(samples.tip[2::3], result.tip)
    np.testing.assert_array_equal(samples.joints[2::3], result.joints)


def test_pieces_are_at_least_one_and_rows_consecutive(run: Runner) -> None:
    result = run("X1\nX2\nX3")
    with pytest.raises(ValueError, match="at least one"):
        subdivide(result, 0)
    with pytest.raises(ValueError, match="consecutive"):
        subdivide(result, 1, slice(0, 3, 2))
    assert len(subdivide(result, 5, slice(3, 3)).row) == 0
