"""Every chain there and back: the two maps are derived apart, so that their agreement says something."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.machine_strategies import directions, joints, machines
from tests.support.machines import five_axis_machines
from tests.support.naive.chains import naive_forward, rotation
from trunnion.arrays import Floats
from trunnion.machines import (
    KinematicParameters,
    Machine,
    forward,
    inverse,
    kinematic_parameters,
    load_machine,
    shipped_machines,
)
from trunnion.machines.forward import kinematic_chain
from trunnion.machines.inverse import POLE, SLIDES_DEPENDENT, UNREACHABLE, solve_point, solve_slides
from trunnion.machines.machine import Vector

TIP_MM = 1e-9
AXIS = 1e-12
PARALLEL_WITHIN = 1e-7


def apart(a: Floats, b: Floats) -> Floats:
    """Difference of two angles in degrees, whole turns left out."""
    return np.abs((a - b + 180.0) % 360.0 - 180.0)


def solve(kinematics: KinematicParameters, tip: Floats, axis: Floats, out: Floats) -> int:
    """Call the kernel for one position."""
    return int(solve_point(kinematics, tip[0], tip[1], tip[2], axis[0], axis[1], axis[2], out))


def spread(machine: Machine, values: Floats) -> float:
    """Volume of the box that a millimetre of each slide spans: 1 where they stand square, 0 where they are flat."""
    if not np.isfinite(values).all():
        return 0.0
    moved = np.repeat(np.asarray(values, float)[None, :], 4, axis=0)
    for row, column in enumerate(machine.linear, 1):
        moved[row, column] += 1.0
    tip, _ = forward(machine, moved)
    x, y, z = tip[1:] - tip[0]
    return abs(float(np.dot(np.cross(x, y), z)))


@settings(deadline=None, max_examples=examples(100))
@given(machines(), joints, st.floats(0.0, 300.0))
def test_the_kernel_puts_the_tool_where_a_product_of_matrices_does(
    machine: Machine, values: list[float], length: float
) -> None:
    tip, axis = forward(machine, np.array([values]), length)
    expected_tip, expected_axis = naive_forward(machine, np.array(values), length)
    np.testing.assert_allclose(tip[0], expected_tip, rtol=0, atol=TIP_MM)
    np.testing.assert_allclose(axis[0], expected_axis, rtol=0, atol=AXIS)


@settings(deadline=None, max_examples=examples(150))
@given(machines(), joints, st.floats(0.0, 300.0))
def test_both_branches_of_any_chain_bring_the_tool_back_to_where_it_was(
    machine: Machine, values: list[float], length: float
) -> None:
    tip, axis = forward(machine, np.array([values]), length)
    found = inverse(machine, tip, axis, length)
    # Slides that have rotary axes between them may come to lie in one plane, or nearly.
    assume(found.reachable[0] and min(spread(machine, branch[0]) for branch in found.joints) > 1e-3)
    for branch in found.joints:
        again_tip, again_axis = forward(machine, branch, length)
        np.testing.assert_allclose(again_tip, tip, rtol=0, atol=TIP_MM)
        np.testing.assert_allclose(again_axis, axis, rtol=0, atol=PARALLEL_WITHIN if found.pole[0] else AXIS)


@settings(deadline=None, max_examples=examples(100))
@given(machines(), joints)
def test_one_of_the_branches_is_where_the_axes_were(machine: Machine, values: list[float]) -> None:
    tip, axis = forward(machine, np.array([values]))
    found = inverse(machine, tip, axis)
    rotary = list(machine.rotary)
    first = np.array(machine.axes[rotary[0]].direction)
    assume(found.reachable[0] and min(spread(machine, branch[0]) for branch in found.joints) > 1e-3)
    # Near a pole, and where the branches meet, angles are as good as the square root of the last digit.
    assume(np.linalg.norm(np.cross(first, axis[0])) > 1e-3)
    assume(apart(found.joints[0, 0, rotary[1]], found.joints[1, 0, rotary[1]]) > 0.1)
    off = np.abs(found.joints[:, 0] - np.array(values))
    off[:, rotary] = apart(found.joints[:, 0][:, rotary], np.array(values)[rotary])
    assert off.max(axis=1).min() < 1e-6


@settings(deadline=None, max_examples=examples(80))
@given(machines(), directions())
def test_a_tool_axis_is_out_of_reach_exactly_when_no_second_angle_leans_it_so_far(
    machine: Machine, direction: Vector
) -> None:
    first, second = (np.array(machine.axes[k].direction) for k in machine.rotary)
    spindle = np.array(machine.spindle_direction)
    turned = [rotation(second, angle)[:3, :3] @ spindle for angle in range(0, 361, 3)]
    heights = np.array([first @ vector for vector in turned])
    height = float(first @ np.array(direction))
    # Steps of three degrees miss an extreme by up to 1 - cos(1.5 degrees).
    assume(min(abs(height - heights.min()), abs(height - heights.max())) > 1e-3)
    out = np.empty((2, 5))
    status = solve(kinematic_parameters(machine), np.zeros(3), np.array(direction), out)
    assert bool(status & UNREACHABLE) == (not heights.min() < height < heights.max())
    assert bool(status & UNREACHABLE) == bool(np.isnan(out).all())


@settings(deadline=None, max_examples=examples(50))
@given(machines(), joints)
def test_displayed_angles_lie_within_half_a_turn_and_are_never_minus_180(machine: Machine, values: list[float]) -> None:
    found = inverse(machine, *forward(machine, np.array([values])))
    angles = found.joints[:, 0][:, list(machine.rotary)]
    assert ((angles > -180.0) & (angles <= 180.0) | np.isnan(angles)).all()


@settings(deadline=None, max_examples=examples(50))
@given(machines(), joints)
def test_slides_solved_for_given_angles_are_those_of_the_branch(machine: Machine, values: list[float]) -> None:
    tip, axis = forward(machine, np.array([values]), 50.0)
    kinematics = kinematic_parameters(machine, 50.0)
    out, again = np.empty((2, 5)), np.empty(5)
    status = solve(kinematics, tip[0], axis[0], out)
    assume(status == 0 and min(spread(machine, branch) for branch in out) > 1e-3)
    first, second = machine.rotary
    slides = list(machine.linear)
    for branch in out:
        wound = branch[first] + 360.0 * 7
        assert solve_slides(kinematics, wound, branch[second], tip[0, 0], tip[0, 1], tip[0, 2], again) == 0
        assert again[first] == wound
        # The turned columns differ in the last digit, which counts for more the flatter the slides lie.
        tolerance = 1e-12 * max(1000.0, float(np.abs(branch).max())) / spread(machine, branch)
        np.testing.assert_allclose(again[slides], branch[slides], rtol=0, atol=tolerance)


@pytest.mark.third
@pytest.mark.parametrize("key", five_axis_machines())
def test_a_tool_axis_along_the_table_axis_leaves_its_angle_free(key: str) -> None:
    machine = load_machine(key)
    kinematics = kinematic_parameters(machine, 80.0)
    tip = np.array([[30.0, -20.0, 10.0]])
    up = np.array([[0.0, 0.0, 1.0]])
    found = inverse(machine, tip, up, 80.0)
    first, second = machine.rotary
    assert found.pole[0]
    assert found.reachable[0]
    assert (found.joints[:, 0, [first, second]] == 0.0).all()
    out = np.empty(5)
    assert solve_slides(kinematics, 123.0, 0.0, tip[0, 0], tip[0, 1], tip[0, 2], out) == 0
    np.testing.assert_allclose(forward(machine, out[None], 80.0)[0], tip, rtol=0, atol=TIP_MM)


@pytest.mark.third
@pytest.mark.parametrize("key", five_axis_machines())
@pytest.mark.parametrize("tilt", [2e-7, 1e-6, 1e-5, 1e-3])
def test_a_tilt_far_too_small_for_an_arc_cosine_keeps_its_digits(key: str, tilt: float) -> None:
    machine = load_machine(key)
    turn = np.radians(np.arange(-170.0, 180.0, 35.0))
    axis = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.full(len(turn), np.cos(tilt))])
    found = inverse(machine, np.zeros_like(axis), axis)
    assert not found.pole.any()
    for branch in found.joints:
        np.testing.assert_allclose(forward(machine, branch)[1], axis, rtol=0, atol=1e-15)
    if machine.key != "generic_nutated_b45_c":
        seconds = np.radians(found.joints[:, :, machine.rotary[1]])
        np.testing.assert_allclose(np.abs(seconds), tilt, rtol=0, atol=1e-15)


@pytest.mark.third
@pytest.mark.parametrize("key", [key for key in five_axis_machines() if key != "generic_nutated_b45_c"])
def test_branch_0_is_the_positive_tilt_and_branch_1_the_negative_one(key: str) -> None:
    machine = load_machine(key)
    turn = np.radians(np.arange(-175.0, 180.0, 10.0))
    axis = np.column_stack([np.cos(turn), np.sin(turn), np.ones(len(turn))])
    tilt = inverse(machine, np.zeros_like(axis), axis).joints[:, :, machine.rotary[1]]
    np.testing.assert_allclose(tilt[0], 45.0)
    np.testing.assert_allclose(tilt[1], -45.0)


def test_the_nutated_head_reaches_the_horizontal_and_no_further() -> None:
    machine = load_machine("generic_nutated_b45_c")
    edge = 0.9e-7
    axis = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, -edge], [1.0, 0.0, -3e-7], [0.6, 0.0, -0.8], [0.0, 0.0, 1.0]])
    found = inverse(machine, np.zeros_like(axis), axis)
    assert found.reachable.tolist() == [True, True, False, False, True]
    np.testing.assert_allclose(found.joints[:, :2, machine.column("B")], 180.0, atol=1e-4)
    np.testing.assert_allclose(forward(machine, found.joints[0, :2])[1], axis[:2], rtol=0, atol=edge + 1e-12)
    assert np.isnan(found.joints[:, 2:4]).all()


def test_tool_axes_of_seven_decimals_need_not_be_unit_vectors() -> None:
    machine = load_machine("yl569")
    rounded = np.array([[0.7224431, 0.4579712, 0.5179023]])
    tip = np.array([[34.927, 5.552, -13.832]])
    unit = rounded / np.linalg.norm(rounded)
    np.testing.assert_allclose(
        inverse(machine, tip, rounded).joints, inverse(machine, tip, unit).joints, rtol=0, atol=1e-11
    )


@pytest.mark.parametrize("axis", [(0.0, 0.0, 0.0), (np.nan, 0.0, 1.0), (np.inf, 0.0, 0.0)])
def test_a_tool_axis_that_is_no_direction_is_out_of_reach(axis: Vector) -> None:
    found = inverse(load_machine("yl569"), np.zeros((1, 3)), np.array([axis]))
    assert not found.reachable[0]


def test_slides_that_a_rotary_axis_has_laid_in_one_plane_are_reported() -> None:
    # A quill W in the spindle of a tilting head, in place of Z: with the spindle horizontal nothing moves up and down.
    machine = load_machine("generic_head_table_bc")
    x, y, z, b = (machine.axis(name) for name in "XYZB")
    quill = Machine("quill", "Quill", (machine.axis("C"), x, y, b, z))
    found = inverse(quill, np.zeros((2, 3)), np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]))
    assert found.reachable.tolist() == [False, True]
    out = np.empty((2, 5))
    assert solve_point(kinematic_parameters(quill), 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, out) == SLIDES_DEPENDENT
    assert np.isnan(out).any(axis=1).all()


@pytest.mark.third
@pytest.mark.parametrize("key", shipped_machines())
def test_a_winding_of_a_hundred_turns_costs_no_digits(key: str) -> None:
    machine = load_machine(key)
    plain = np.array([[12.5, -33.25, 71.0, 0.5, 45.125]])
    wound = plain.copy()
    wound[0, machine.rotary[0]] += 36000.0
    for a, b in zip(forward(machine, plain, 60.0), forward(machine, wound, 60.0), strict=True):
        np.testing.assert_array_equal(a, b)


def test_arrays_of_the_wrong_shape_are_named() -> None:
    machine = load_machine("yl569")
    with pytest.raises(ValueError, match=r"joints must have shape \(n, 5\), not \(5,\)"):
        forward(machine, np.zeros(5))
    with pytest.raises(ValueError, match=r"shape \(n, 3\), not \(2, 3\) and \(1, 3\)"):
        inverse(machine, np.zeros((2, 3)), np.zeros((1, 3)))


def test_no_rows_in_give_no_rows_out() -> None:
    machine = load_machine("yl569")
    tip, axis = forward(machine, np.zeros((0, 5)))
    assert inverse(machine, tip, axis).joints.shape == (2, 0, 5)


def test_status_bits_are_apart() -> None:
    assert len({UNREACHABLE, POLE, SLIDES_DEPENDENT, UNREACHABLE | POLE, POLE | SLIDES_DEPENDENT}) == 5


def test_the_chain_of_a_machine_is_put_together_once_and_for_all() -> None:
    machine = load_machine("yl569")
    chain = kinematic_chain(machine)
    assert kinematic_chain(machine) is chain
    assert not any(array.flags.writeable for array in chain)
    assert (kinematic_chain(machine, 50.0).tip_at_zero != chain.tip_at_zero).any()
