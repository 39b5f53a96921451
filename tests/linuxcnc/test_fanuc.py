"""What a Fanuc program does is what LinuxCNC does with it: read, posted for LinuxCNC on the same chain, and run there.

LinuxCNC's interpreter takes the program that the Fanuc one is converted to, and its kinematics give the joints of each
motion that holds the tip. They are those that our reader of Fanuc programs brings the machine to, in a plane of G68.2
as with G43.4.
"""

import ctypes
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings

from tests.convert.test_pairs import Site, converted, paths, posted, roomy
from tests.linuxcnc.interpreter import LENGTH, interpret, needs_linuxcnc
from tests.linuxcnc.kinematics import Kinematics, needs_compiler, needs_modules
from tests.linuxcnc.test_kinematics import MODULES, TOOL_PINS
from trunnion.arrays import Floats
from trunnion.control import load_control
from trunnion.machine import load_machine
from trunnion.reader import Run
from trunnion.toolpath import Operation, Toolpath
from trunnion.verify.rapids import PLACES, levels

pytestmark = [needs_linuxcnc, needs_modules, needs_compiler]

ZERO = (10.0, -20.0, 30.0)

#: What three decimals of angles come to at the ends of the table, and four of LinuxCNC's text, mm and degrees.
NEAR = 5e-3


@pytest.fixture(scope="module")
def kinematics(stub: ctypes.CDLL) -> dict[str, Kinematics]:
    return {name: Kinematics(stub, module, pins) for name, (module, pins, _) in MODULES.items() if "trt" in name}


def site(name: str, control: str, folder: Path) -> Site:
    """A machine of LinuxCNC's with another control, by a definition that extends its own."""
    file = folder / f"{name}_{control}.toml"
    file.write_text(f'extends = "{name}"\nname = "{name}"\n[control]\nextends = "{control}"\n', encoding="utf-8")
    machine = replace(roomy(load_machine(str(file))), workpiece_zero=ZERO, tool_length=LENGTH)
    said = load_control(machine.control.fresh())
    digits = (0.5 * 10.0 ** -said.number_formats(three_axis=False)[key].decimals for key in ("coordinate", "angle"))
    return Site(machine, said, *digits)


def ours(run: Run) -> Floats:
    """Joints of a run at the end of each motion of the tip, (n, 5), each place once; not of the first leg from home."""
    rows = np.flatnonzero(
        run.state.by_tip.part(0, len(run)) & ~run.machine_frame & ((run.programmed & int(PLACES)) != 0)
    )
    return once(run.poses(np.setdiff1d(rows, levels(run))).joints)


def theirs(text: str, name: str, kinematics: dict[str, Kinematics], site: Site, folder: Path) -> Floats:
    """Joints that LinuxCNC comes to at the end of each motion of the tip, in the order of our chain."""
    _, pins, letters = MODULES[name]
    tool = TOOL_PINS[name]
    kinematics[name].set(tool, pins.get(tool, 0.0) + LENGTH)
    moves = [move for move in interpret(text, folder, "XYZABC").moves if move.tcp]
    poses = np.zeros((len(moves), 9))
    poses[:, :6] = [move.end for move in moves]
    poses[:, :3] += np.add(ZERO, (0.0, 0.0, LENGTH))
    joints = kinematics[name].joints(poses, len(letters))
    return once(joints[:, [letters.index(axis.name) for axis in site.machine.axes]])


def once(joints: Floats) -> Floats:
    """Without the places that are the one before."""
    moved = np.abs(np.diff(joints, axis=0)).max(axis=1) > 2.0 * NEAR
    return joints[np.concatenate(([True], moved))]


def still(operation: Operation) -> Operation:
    """The operation with the tool axis of its first point throughout."""
    moves = operation.moves
    return replace(operation, moves=replace(moves, axis=np.repeat(moves.axis[:1], len(moves), axis=0)))


@pytest.mark.parametrize("name", ["xyzac_trt", "xyzbc_trt"])
@pytest.mark.parametrize("tilted", [False, True])
@settings(max_examples=6, suppress_health_check=list(HealthCheck), phases=[Phase.generate])
@given(path=paths())
def test_linuxcnc_brings_its_joints_where_the_fanuc_program_brings_them(
    kinematics: dict[str, Kinematics], name: str, tilted: bool, path: Toolpath, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.getbasetemp()
    if tilted:
        path = replace(path, operations=tuple(still(operation) for operation in path.operations))
    one, two = site(name, "fanuc_31i", folder), site(name, "linuxcnc", folder)
    program, again = folder / "part.nc", folder / "part.ngc"
    run = posted(path, one, {}, program)
    text = program.read_text(encoding="ascii")
    assert ("G68.2" in text) == tilted
    assert ("G43.4" in text) != tilted
    converted(run, one, two, again)
    mine = ours(run)
    found = theirs(again.read_text(encoding="utf-8"), name, kinematics, two, folder)
    assert mine.shape == found.shape
    np.testing.assert_allclose(mine, found, atol=NEAR, rtol=0)
