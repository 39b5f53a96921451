"""Our chains, and the joints that our plans come to, against LinuxCNC's own kinematics."""

import ctypes
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.convert.toolpaths import SAYABLE, operations
from tests.linuxcnc.kinematics import Kinematics, needs_compiler, needs_modules
from trunnion.arrays import Floats
from trunnion.errors import RefusedError
from trunnion.machines import Machine, forward, load_machine, slide_positions
from trunnion.model.toolpath import Toolpath
from trunnion.planning import PlanOptions, plan

pytestmark = [needs_modules, needs_compiler]

#: Of each machine its module, the pins with the numbers of its definition, and the joints in their order.
MODULES: dict[str, tuple[str, dict[str, float], str]] = {
    "xyzac_trt": ("xyzac-trt-kins", {"y-offset": 20.0, "z-offset": 10.0}, "XYZAC"),
    "xyzbc_trt": ("xyzbc-trt-kins", {"x-offset": -20.0, "z-offset": -15.0}, "XYZBC"),
    "linuxcnc_5axis": ("5axiskins", {"pivot-length": 250.0}, "XYZBC"),
}

#: The two ways to lengthen the tool: the tables' modules have a pin, the head's pivot gets longer.
TOOL_PINS = {"xyzac_trt": "tool-offset", "xyzbc_trt": "tool-offset", "linuxcnc_5axis": "pivot-length"}


@pytest.fixture(scope="module")
def kinematics(stub: ctypes.CDLL) -> dict[str, Kinematics]:
    return {name: Kinematics(stub, module, pins) for name, (module, pins, _) in MODULES.items()}


def theirs(kinematics: dict[str, Kinematics], machine: Machine, tip: Floats, rotary: Floats, length: float) -> Floats:
    """Joints in the order of our chain, of tips as programs have them."""
    _, pins, letters = MODULES[machine.key]
    tool = TOOL_PINS[machine.key]
    kinematics[machine.key].set(tool, pins.get(tool, 0.0) + length)
    poses = np.zeros((len(tip), 9))
    poses[:, :3] = tip + np.array(machine.workpiece_zero) + [0.0, 0.0, length]  # G54, and G43 along Z
    for k, column in enumerate(machine.rotary):
        poses[:, 3 + "ABC".index(machine.axes[column].name)] = rotary[:, k]
    joints = kinematics[machine.key].joints(poses, len(letters))
    return joints[:, [letters.index(axis.name) for axis in machine.axes]]


places = st.tuples(*[st.floats(-300, 300)] * 3)


@settings(max_examples=200)
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


@settings(max_examples=60)
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
