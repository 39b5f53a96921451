"""LinuxCNC as the judge of other controls, which have none of their own.

A CL file is posted for another control on the chain of a machine that LinuxCNC has: a definition extends that machine
and names the control. Our reader reads the program, which becomes a toolpath and is posted for LinuxCNC; LinuxCNC's own
interpreter runs that one, and its own kinematics make joints of its motions. They are those that our chain has for the
points of the CL file. A control, and a way to write its programs, is a line in ``WRITTEN``.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.conversion import Site, converted, paths, posted, roomy
from tests.support.examples import examples
from tests.support.linuxcnc.interpreter import interpret, needs_linuxcnc
from tests.support.linuxcnc.joints import MODULES, theirs
from tests.support.linuxcnc.joints import kinematics as kinematics
from tests.support.linuxcnc.kinematics import Kinematics, needs_compiler, needs_modules
from trunnion.arrays import Floats
from trunnion.controls import load_control
from trunnion.machines import Machine, load_machine, slide_positions
from trunnion.model.toolpath import (
    Arcs,
    Frame,
    Kind,
    LoadTool,
    Moves,
    Operation,
    Phase,
    Sense,
    SpindleOn,
    Tool,
    Toolpath,
)
from trunnion.planning import plan
from trunnion.readers import run_program

pytestmark = [needs_linuxcnc, needs_modules, needs_compiler]

#: The controls that are judged, and the settings of their programs.
WRITTEN: tuple[tuple[str, dict[str, str]], ...] = (
    ("sinumerik_840d", {}),
    ("heidenhain_itnc530", {}),
    ("heidenhain_tnc640", {}),
    ("fanuc_31i", {}),
    ("fanuc_31i", {"orientation": "vector"}),
    ("fidia_nc15", {}),
)

#: No joint is farther than this from the centres of its rotary axes, mm.
_REACH = 500.0

#: Half of the last digit that LinuxCNC's interpreter prints, mm and degrees; and of our LinuxCNC programs.
_PRINTED = 5e-5 + 5e-6

_DEFINITION = """schema = 1
extends = "{machine}"
name = "{machine} with another control"
[control]
extends = "{family}"
"""

#: A Fidia has other words for TCP where the head turns the tool.
_OF_HEADS = '[control.settings]\ntcp_on = "G96"\ntcp_off = "G97"\n'


def site_of(machine: Machine) -> Site:
    """A machine with its control, and room for everything."""
    control = load_control(machine.control)
    formats = control.number_formats(three_axis=False)
    half = [0.5 * 10.0 ** -formats[key].decimals for key in ("coordinate", "angle")]
    return Site(roomy(machine), control, half[0], half[1])


def joints_of(path: Toolpath, machine: Machine) -> Floats:
    """Slides and rotary axes of all points of a CL file by our own chain, in its order, (n, 5)."""
    motions = plan([path], machine, 0.001).motions
    tip = np.concatenate([motion.operation.moves.tip for motion in motions])
    rotary = np.concatenate([motion.rotary for motion in motions])
    return slide_positions(machine, tip, rotary, 0.0)


def judged(text: str, machine: Machine, kinematics: dict[str, Kinematics], folder: Path) -> Floats:
    """The joints to which LinuxCNC comes with a program, under TCP, (n, 5)."""
    ends = [move.end for move in interpret(text, folder).moves if move.offset and move.tcp]
    kept = [end for k, end in enumerate(ends) if k == 0 or end != ends[k - 1]]
    places = np.array(kept)
    letters = [machine.axes[column].name for column in machine.rotary]
    rotary = places[:, [3 + "ABC".index(letter) for letter in letters]]
    return theirs(kinematics, machine, places[:, :3], rotary, 0.0)


def still(path: Toolpath) -> Toolpath:
    """The path with the tool axis of its operations' first points throughout, so that it is made in planes."""
    axes = [np.repeat(each.moves.axis[:1], len(each.moves), axis=0) for each in path.operations]
    operations = zip(path.operations, axes, strict=True)
    return replace(
        path, operations=tuple(replace(each, moves=replace(each.moves, axis=axis)) for each, axis in operations)
    )


def both(
    path: Toolpath,
    name: str,
    family: str,
    kinematics: dict[str, Kinematics],
    folder: Path,
    fault: tuple[str, str] = ("", ""),
    asked: dict[str, str] | None = None,
) -> tuple[Floats, Floats, float]:
    """LinuxCNC's joints, those of the CL points, and how far they may be apart; ``fault``: to put into the program."""
    definition = folder / "other.toml"
    of_heads = _OF_HEADS if (name, family) == ("linuxcnc_5axis", "fidia_nc15") else ""
    definition.write_text(_DEFINITION.format(machine=name, family=family) + of_heads, encoding="utf-8")
    # Where the workpiece sits is not in the program; both sides are told zero.
    other, own = site_of(load_machine(definition)), site_of(load_machine(name))
    source, program = folder / f"other{other.control.extension}", folder / "judged.ngc"
    run = posted(path, other, asked or {}, source)
    if fault[0]:
        source.write_text(source.read_text(encoding="utf-8").replace(*fault), encoding="utf-8")
        run = run_program(source, other.machine)
    converted(run, other, own, program)
    at = replace(load_machine(name), workpiece_zero=(0.0, 0.0, 0.0))
    turned = 2.0 * float(np.radians(other.angle + _PRINTED)) * _REACH
    got = judged(program.read_text(encoding="utf-8"), at, kinematics, folder)
    return got, joints_of(path, roomy(at)), 2.0 * (other.tip + _PRINTED) + turned


@pytest.mark.third
@pytest.mark.parametrize(("family", "asked"), WRITTEN, ids=[" ".join((name, *words)) for name, words in WRITTEN])
@settings(max_examples=examples(8))
@given(name=st.sampled_from(sorted(MODULES)), path=st.one_of(paths(), paths().map(still)))
def test_programs_of_other_controls_bring_linuxcncs_joints_to_the_cl_points(
    kinematics: dict[str, Kinematics],
    tmp_path_factory: pytest.TempPathFactory,
    family: str,
    asked: dict[str, str],
    name: str,
    path: Toolpath,
) -> None:
    got, wanted, allowed = both(path, name, family, kinematics, tmp_path_factory.getbasetemp(), asked=asked)
    assert len(got) == len(wanted)
    np.testing.assert_allclose(got, wanted, atol=allowed, rtol=0)
    assert allowed < 0.02


def test_a_rotary_axis_that_turns_the_other_way_is_found(kinematics: dict[str, Kinematics], tmp_path: Path) -> None:
    axis = np.array([[0.0, 0.6, 0.8], [0.0, 0.28, 0.96]])
    moves = Moves(
        tip=np.array([[10.0, 20.0, 30.0], [40.0, 20.0, 5.0]]),
        axis=axis,
        kind=np.array([Kind.RAPID, Kind.LINEAR], np.uint8),
        phase=np.array([Phase.RAPID, Phase.CUT], np.uint8),
        feed=np.array([np.nan, 500.0]),
        per_rev=np.zeros(2, bool),
        line=np.array([1, 2], np.int32),
    )
    events = LoadTool(0, 1, 3), SpindleOn(0, 1, 1000.0, Sense.CLW)
    operation = Operation(
        "OP", Tool("MILL", "D10", 10.0, 5.0, 80.0), Frame(), moves, Arcs.empty(), events, 1, 0.01, 0.01
    )
    path = Toolpath("made.cls", (operation,))
    right, wanted, allowed = both(path, "xyzac_trt", "heidenhain_tnc640", kinematics, tmp_path)
    np.testing.assert_allclose(right, wanted, atol=allowed, rtol=0)
    wrong, _, _ = both(path, "xyzac_trt", "heidenhain_tnc640", kinematics, tmp_path, (" A+", " A-"))
    assert np.abs(wrong - wanted).max() > 1.0
