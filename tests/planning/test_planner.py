"""Branch, turn, pole and limits."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.machines import five_axis_machines
from trunnion.arrays import Floats
from trunnion.errors import RefusedError, Severity
from trunnion.machines import Machine, forward, load_machine, slide_positions
from trunnion.model.frames import into_frame
from trunnion.model.motion import Plan
from trunnion.model.toolpath import Arcs, Frame, Moves, Operation, Tool, Toolpath
from trunnion.planning import plan


def operation(tip: Floats, axis: Floats, frame: Frame | None = None, rapid: bool = False) -> Operation:
    """Lines through the points; the line of row n is 10 + n."""
    n = len(tip)
    moves = Moves(
        np.array(tip, float),
        np.array(axis, float),
        np.full(n, 0 if rapid else 1, np.uint8),
        np.zeros(n, np.uint8),
        np.full(n, 100.0),
        np.zeros(n, bool),
        np.arange(10, 10 + n, dtype=np.int32),
    )
    return Operation("OP", Tool(), frame or Frame(), moves, Arcs.empty(), (), 1)


def planned(machine: Machine, *operations: Operation) -> Plan:
    return plan([Toolpath("part.cls", operations)], machine, 0.001)


def joints_of(machine: Machine, *operations: Operation) -> Floats:
    """(n, 5) axis positions of the first operation."""
    motion = planned(machine, *operations).motions[0]
    return slide_positions(machine, motion.operation.moves.tip, motion.rotary)


def direction(b: float, c: float) -> Floats:
    """Tool axis of the YL569 at B and C, degrees."""
    b, c = np.radians(b), np.radians(c)
    return np.array([np.sin(b) * np.cos(c), np.sin(b) * np.sin(c), np.cos(b)])


@pytest.mark.parametrize(
    ("b", "c", "axis"),
    [
        (58.8083, 32.3689, (0.7225, 0.4579, 0.5179)),
        (58.8069, 32.3731, (0.7224, 0.4580, 0.5179)),
        (58.8054, 32.3752, (0.7224, 0.4580, 0.5179)),
    ],
)
def test_the_published_angles_of_the_yl569_follow_from_its_tool_axes(
    b: float, c: float, axis: tuple[float, float, float]
) -> None:
    machine = load_machine("yl569")
    joints = joints_of(machine, operation(np.zeros((1, 3)), np.array([axis]) / np.linalg.norm(axis)))
    assert joints[0, machine.column("B")] == pytest.approx(b, abs=0.01)  # vectors are printed with four decimals
    assert joints[0, machine.column("C")] == pytest.approx(c, abs=0.01)


def test_the_branch_within_the_limits_is_taken_even_if_it_is_farther() -> None:
    machine = load_machine("yl569")
    joints = joints_of(machine, operation(np.zeros((1, 3)), np.array([direction(30, 200)])))[0]
    assert joints[machine.column("B")] == pytest.approx(30), "B -30 with C 20 is nearer, but B ends at -11"
    assert joints[machine.column("C")] == pytest.approx(200)


def test_of_two_possible_branches_the_nearer_one_is_taken() -> None:
    machine = load_machine("yl569")
    joints = joints_of(machine, operation(np.zeros((1, 3)), np.array([direction(5, 190)])))[0]
    assert joints[machine.column("B")] == pytest.approx(-5)
    assert joints[machine.column("C")] == pytest.approx(10)


def test_the_pole_keeps_the_last_angle() -> None:
    machine = load_machine("yl569")
    axes = np.array([direction(20, 123.0), [0.0, 0.0, 1.0], direction(20, 123.0)])
    joints = joints_of(machine, operation(np.zeros((3, 3)), axes))
    assert joints[:, machine.column("C")] == pytest.approx([123.0] * 3)
    assert joints[1, machine.column("B")] == 0.0


def test_an_endless_axis_is_displayed_from_0_to_360_and_never_as_360() -> None:
    machine = load_machine("yl569")
    turns = np.linspace(0, 1080, 400)
    joints = joints_of(machine, operation(np.zeros((400, 3)), np.array([direction(40, c) for c in turns])))
    c = joints[:, machine.column("C")]
    assert ((c >= 0) & (c < 360)).all()
    assert np.abs((c - turns + 180) % 360 - 180).max() < 1e-9


def test_over_travel_names_line_axis_value_and_limit() -> None:
    machine = load_machine("yl569")
    found = planned(machine, operation(np.zeros((2, 3)), np.array([direction(90, 0), direction(110, 0)]))).problems
    assert [(p.file, p.line, p.severity) for p in found] == [("part.cls", 11, Severity.ERROR)]
    assert "axis B would go to 110.00000, above its limit 100 degrees" in found[0].what


def test_many_rows_beyond_a_limit_are_counted_rather_than_listed() -> None:
    machine = load_machine("yl569")
    found = planned(machine, operation(np.zeros((50, 3)), np.tile(direction(110, 0), (50, 1)))).problems
    assert len(found) == 6
    assert found[-1].what == "the same at 45 further points, the last in line 59"


def test_a_value_that_prints_as_the_limit_becomes_the_limit() -> None:
    machine = load_machine("yl569")
    motion = planned(machine, operation(np.zeros((1, 3)), np.array([direction(100.000004, 0)])))
    assert motion.problems == ()
    assert motion.motions[0].rotary[0, machine.rotary.index(machine.column("B"))] == 100.0


def test_a_part_larger_than_the_travel_is_refused_wherever_it_sits() -> None:
    machine = load_machine("yl569")
    tips = np.array([[-260.0, 0, 0], [260.0, 0, 0]])
    found = planned(machine, operation(tips, np.tile([0, 0, 1.0], (2, 1)))).problems
    assert len(found) == 1
    assert "axis X would go from -260.000 to 260.000, 520.000 mm" in found[0].what
    assert "room for 500 mm" in found[0].what


def test_with_a_known_workpiece_zero_each_slide_keeps_its_limits() -> None:
    machine = load_machine("yl569", {"workpiece": {"zero_mm": [200, 0, 0]}})
    found = planned(machine, operation(np.array([[60.0, 0, 0]]), np.array([[0, 0, 1.0]]))).problems
    assert "axis X would go to 260.00000, above its limit 250 mm" in found[0].what


def test_a_tool_axis_beyond_a_nutated_head_can_never_be_written() -> None:
    machine = load_machine("generic_nutated_b45_c")
    with pytest.raises(
        RefusedError, match=r"part.cls:10: error: no rotary position .* 0\.000000, 0\.000000, -1\.000000"
    ):
        planned(machine, operation(np.zeros((1, 3)), np.array([[0, 0, -1.0]])))


def test_a_branch_change_in_a_cut_is_avoided_by_starting_in_the_other_branch() -> None:
    machine = load_machine("yl569")
    axes = np.array([direction(-8, 20), direction(-10, 20), direction(-14, 20)])
    found = planned(machine, operation(np.zeros((3, 3)), axes))
    assert found.problems == ()
    assert found.motions[0].rotary[:, 1] == pytest.approx([8, 10, 14])


def test_operations_in_other_coordinate_systems_are_carried_into_the_first_one() -> None:
    turned = Frame((10.0, 20.0, 30.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0))
    there = into_frame(operation(np.array([[1.0, 2, 3]]), np.array([[1.0, 0, 0]]), turned), Frame())
    assert there.moves.tip[0] == pytest.approx([10 - 2, 20 + 1, 33])
    assert there.moves.axis[0] == pytest.approx([0, 1, 0])
    back = into_frame(there, turned)
    assert back.moves.tip[0] == pytest.approx([1, 2, 3])


@settings(deadline=None, max_examples=examples(20))
@given(
    st.sampled_from(five_axis_machines()),
    st.lists(st.tuples(st.floats(0, 35), st.floats(-720, 720), *[st.floats(-60, 60)] * 3), min_size=1, max_size=20),
)
def test_on_every_shipped_machine_the_tool_is_where_the_toolpath_has_it(
    name: str, poses: list[tuple[float, float, float, float, float]]
) -> None:
    machine = load_machine(name)
    axes = np.array([direction(b, c) for b, c, *_ in poses])
    tips = np.array([p[2:] for p in poses])
    motion = planned(machine, operation(tips, axes)).motions[0]
    moves = motion.operation.moves
    tip, axis = forward(machine, slide_positions(machine, moves.tip, motion.rotary))
    near_pole = 1e-7  # a tool axis nearer to the pole than CL files resolve is taken to be on it
    assert np.abs(axis - moves.axis).max() < near_pole
    assert np.abs(tip - moves.tip).max() < 1e-9 + near_pole * 1000
    reached = 0
    for row in range(len(moves)):  # turns at the pole repeat a point, and long steps have points between
        if reached == len(tips):
            break
        at_tip = np.allclose(moves.tip[row], tips[reached], rtol=0, atol=1e-9)
        if at_tip and np.allclose(moves.axis[row], axes[reached], rtol=0, atol=near_pole):
            reached += 1
    assert reached == len(tips)
