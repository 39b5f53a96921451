"""Joints of our machines by LinuxCNC's own kinematics."""

import ctypes

import numpy as np
import pytest

from tests.support.linuxcnc.kinematics import Kinematics
from trunnion.arrays import Floats
from trunnion.machines import Machine

#: For each machine its module, the pins with the numbers of its definition, and the order of its joints.
MODULES: dict[str, tuple[str, dict[str, float], str]] = {
    "xyzac_trt": ("xyzac-trt-kins", {"y-offset": 20.0, "z-offset": 10.0}, "XYZAC"),
    "xyzbc_trt": ("xyzbc-trt-kins", {"x-offset": -20.0, "z-offset": -15.0}, "XYZBC"),
    "linuxcnc_5axis": ("5axiskins", {"pivot-length": 250.0}, "XYZBC"),
}

#: How the tool length is set: the modules for tables have a pin for it, that for a head has a longer pivot.
TOOL_PINS = {"xyzac_trt": "tool-offset", "xyzbc_trt": "tool-offset", "linuxcnc_5axis": "pivot-length"}


@pytest.fixture(scope="module")
def kinematics(stub: ctypes.CDLL) -> dict[str, Kinematics]:
    return {name: Kinematics(stub, module, pins) for name, (module, pins, _) in MODULES.items()}


def theirs(kinematics: dict[str, Kinematics], machine: Machine, tip: Floats, rotary: Floats, length: float) -> Floats:
    """Joints in the order of our chain, for tips in the program's coordinates."""
    _, pins, letters = MODULES[machine.key]
    tool = TOOL_PINS[machine.key]
    kinematics[machine.key].set(tool, pins.get(tool, 0.0) + length)
    poses = np.zeros((len(tip), 9))
    poses[:, :3] = tip + np.array(machine.workpiece_zero) + [0.0, 0.0, length]  # G54, and G43 along Z
    for k, column in enumerate(machine.rotary):
        poses[:, 3 + "ABC".index(machine.axes[column].name)] = rotary[:, k]
    joints = kinematics[machine.key].joints(poses, len(letters))
    return joints[:, [letters.index(axis.name) for axis in machine.axes]]
