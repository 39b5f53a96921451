"""Tool axes that hardly lean, on every machine with its own control: planes, or none where no digit would show them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.jobs import post_job
from tests.support.machines import five_axis_machines
from tests.support.operations import moves_of, operation_of, rapids_at
from trunnion.arrays import Floats
from trunnion.controls import load_control
from trunnion.errors import InputError, RefusedError
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import load_machine
from trunnion.model.motion import MachiningMode
from trunnion.model.toolpath import LoadTool, SpindleOn, Toolpath
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import Verification, verify

MACHINES = {name: load_machine(name) for name in five_axis_machines()}
CONTROLS = {name: load_control(machine.control) for name, machine in MACHINES.items()}
TIPS = np.array([[0.0, 0.0, 50.0], [10.0, 0.0, 5.0], [20.0, 3.0, 5.0], [60.0, -40.0, 2.0]])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


def leaning(tilt: float, azimuth: float) -> Floats:
    """A tool axis, by degrees from +Z, and where to."""
    t, a = np.radians((tilt, azimuth))
    return np.array([np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)])


def toolpath_of(axis: Floats) -> Toolpath:
    operation = operation_of(rapids_at(moves_of(TIPS, np.tile(axis, (len(TIPS), 1))), [0]))  # a Haas wants a rapid
    events = (LoadTool(0, 1, 1), SpindleOn(0, 2, 1000.0))
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))


def proof(
    name: str, axis: Floats, folder: Path, beside: Floats | None = None, plane: str = ""
) -> tuple[MachiningMode, Verification]:
    """How a program is made, and its proof, against another tool axis if there is one."""
    machine, control = MACHINES[name], CONTROLS[name]
    given = {"plane": plane} if plane else {}
    options, target = parse_plan_options(given, control), folder / "tilt.nc"
    program = plan_program([toolpath_of(axis)], post_job(machine, control, options, given))[0]
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program, options)
    wanted = toolpath_of(axis if beside is None else beside)
    found = verify(run_program(target, machine), [wanted], tolerances=expected.tolerances, settings=expected.settings)
    return program.motions[0].mode, found


def digit(name: str) -> float:
    """The last digit of a rotary word, degrees."""
    return 10.0 ** -CONTROLS[name].number_formats(three_axis=False)["angle"].decimals


@settings(max_examples=examples(50))
@given(
    name=st.sampled_from(sorted(MACHINES)),
    tilt=st.floats(-6.0, -1.5).map(lambda power: 10.0**power),
    azimuth=st.floats(-180.0, 180.0),
    way=st.integers(0, 2),
)
def test_a_tool_axis_that_hardly_leans_is_proven(
    name: str, tilt: float, azimuth: float, way: int, folder: Path
) -> None:
    planes = CONTROLS[name].family.PLANE_COMMANDS
    plane = planes[way % len(planes)] if len(planes) > 1 else ""
    try:
        mode, found = proof(name, leaning(tilt, azimuth), folder, plane=plane)
    except (RefusedError, InputError):
        assume(False)
    assert found.passed, [(check.key, check.summary) for check in found.checks if not check.passed]
    assert not found.run.errors
    event(f"{mode.value}")
    if tilt < 0.49 * digit(name):
        assert mode is MachiningMode.THREE_AXIS
    elif tilt > 0.51 * digit(name) and tilt > 1e-5:
        assert mode is not MachiningMode.THREE_AXIS


@pytest.mark.third
@pytest.mark.parametrize("name", sorted(MACHINES))
@pytest.mark.parametrize("tilt", [2e-5, 3e-3, 0.5])
def test_a_tilt_that_is_another_one_is_found(name: str, tilt: float, folder: Path) -> None:
    for azimuth in (20.0, 130.0, 250.0):
        more = leaning(tilt + 8.0 * max(digit(name), 1e-3), azimuth)
        mode, found = proof(name, leaning(tilt, azimuth), folder, more)
        assert "axis" in [check.key for check in found.checks if not check.passed], mode


def test_an_axis_off_by_less_than_a_digit_leaves_no_turn_of_the_table(folder: Path) -> None:
    """Where C is free, the way in which the tool axis hardly leans must not turn the part."""
    proof("dmu65", leaning(3e-5, 133.0), folder)
    text = (folder / "tilt.nc").read_text(encoding="utf-8")
    assert "C+0" in text
    assert "C+133" not in text
    assert "PLANE SPATIAL" not in text
