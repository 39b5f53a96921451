"""Our chains, and the joints that our plans come to, against LinuxCNC's own kinematics."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.linuxcnc.joints import MODULES, theirs
from tests.support.linuxcnc.joints import kinematics as kinematics
from tests.support.linuxcnc.kinematics import Kinematics, needs_compiler, needs_modules
from tests.support.toolpath_strategies import SAYABLE, operations
from trunnion.errors import RefusedError
from trunnion.machines import forward, load_machine, slide_positions
from trunnion.model.toolpath import Toolpath
from trunnion.planning import PlanOptions, plan

pytestmark = [needs_modules, needs_compiler]


places = st.tuples(*[st.floats(-300, 300)] * 3)


@settings(max_examples=examples(80))
@given(
    st.sampled_from(sorted(MODULES)), places, places, st.floats(-100, 100), st.floats(-1000, 1000), st.floats(0, 200)
)
def test_our_chains_are_linuxcncs_kinematics(
    kinematics: dict[str, Kinematics],
    name: str,
    tip: tuple[float, float, float],
    zero: tuple[float, float, float],
    tilt: float,
    turn: float,
    length: float,
) -> None:
    machine = replace(load_machine(name), workpiece_zero=zero)
    tips, rotary = np.array([tip]), np.empty((1, 2))
    rotary[0] = [turn if machine.axes[column].name == "C" else tilt for column in machine.rotary]
    ours = slide_positions(machine, tips, rotary, length)
    wanted = theirs(kinematics, machine, tips, rotary, length)
    np.testing.assert_allclose(ours, wanted, atol=1e-9, rtol=0)
    back, _ = forward(machine, wanted, length)
    np.testing.assert_allclose(back, tips, atol=1e-9)


@settings(max_examples=examples(30))
@given(
    st.sampled_from(sorted(MODULES)),
    operations({"dwell": SAYABLE["dwell"]}, st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.3, 1))),
    st.floats(0, 200),
)
def test_the_joints_of_our_plans_are_those_that_linuxcnc_comes_to(
    kinematics: dict[str, Kinematics], name: str, operation: object, length: float
) -> None:
    """And the tool points where the CL file has it, by our forward chain from LinuxCNC's joints."""
    machine = replace(load_machine(name), workpiece_zero=(10.0, -20.0, 30.0))
    wide = tuple(replace(axis, low=-1e6, high=1e6) if not axis.is_rotary else axis for axis in machine.axes)
    machine = replace(machine, axes=wide)
    try:
        planned = plan([Toolpath("made.cls", (operation,))], machine, 0.001, PlanOptions())  # type: ignore[arg-type]
    except RefusedError:
        return
    for motion in planned.motions:
        tip = motion.operation.moves.tip
        ours = slide_positions(machine, tip, motion.rotary, length)
        wanted = theirs(kinematics, machine, tip, motion.rotary, length)
        np.testing.assert_allclose(ours, wanted, atol=1e-6, rtol=0)
        back, axis = forward(machine, wanted, length)
        np.testing.assert_allclose(back, tip, atol=1e-6)
        np.testing.assert_allclose(axis, motion.operation.moves.axis, atol=1e-6)


def test_a_wrong_pivot_is_found(kinematics: dict[str, Kinematics]) -> None:
    machine = replace(load_machine("linuxcnc_5axis"), workpiece_zero=(0.0, 0.0, 0.0))
    tip, rotary = np.zeros((1, 3)), np.array([[0.0, 30.0]])
    ours = slide_positions(machine, tip, rotary, 0.0)
    assert np.abs(ours - theirs(kinematics, machine, tip, rotary, 1.0)).max() > 0.1
