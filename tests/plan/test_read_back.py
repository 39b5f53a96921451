"""Plans for every shipped machine: written, read back by the independent reader, and proven."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.jobs import post_job
from tests.machines import at_zero
from tests.plan.naive import operation_of
from tests.plan.test_optimum import short_paths, smooth_paths, winding
from trunnion.api.expectation import expectation
from trunnion.api.planning import plan_program
from trunnion.controls import load_control
from trunnion.errors import InputError, RefusedError, Severity
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.model.toolpath import LoadTool, Moves, SpindleOn, Toolpath
from trunnion.output.program_writer import write_program
from trunnion.planning import PlanOptions, plan
from trunnion.readers import run_program
from trunnion.verification import Verification, failures, verify

SINUMERIK = load_machine("yl569").control
CONTROL = load_control(SINUMERIK.unread_copy())

#: Every shipped machine with a control whose programs can be written.
MACHINES = {name: replace(at_zero(name), control=SINUMERIK.unread_copy()) for name in shipped_machines()}

#: How far the rotary axes may be beyond a limit: half the last printed digit.
HALF_DIGIT = 0.5e-5 + 1e-9


def toolpath_of(moves: Moves) -> Toolpath:
    """A toolpath of one operation, with the events that a program needs."""
    moves = replace(moves, tip=moves.tip + 20.0 * np.sin(np.arange(len(moves)))[:, None] * [1.0, 0.5, 0.2])
    operation = operation_of(moves)
    events = (LoadTool(0, 1, 1), SpindleOn(0, 2, 1000.0))
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))


def proven(machine: Machine, toolpath: Toolpath, folder: Path) -> Verification:
    """Post a toolpath and return the proof.

    Raises
    ------
    RefusedError, InputError
        When there is no program, as over-travel and tool axes out of reach leave none.
    """
    program = plan_program([toolpath], post_job(machine, CONTROL, PlanOptions(), {}))[0]
    target = folder / "part.mpf"
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    return verify(run_program(target, machine), [toolpath], tolerances=expected.tolerances, settings=expected.settings)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


paths = smooth_paths(25.0) | smooth_paths(100.0) | smooth_paths(3.0) | short_paths(12)


@settings(max_examples=250)
@given(name=st.sampled_from(sorted(MACHINES)), moves=paths)
def test_plans_are_proven(name: str, moves: Moves, folder: Path) -> None:
    machine, toolpath = MACHINES[name], toolpath_of(moves)
    try:
        found = proven(machine, toolpath, folder)
    except (RefusedError, InputError):
        assume(False)
        return
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    rotary = found.run.rotary
    low, high = np.array([[a.low, a.high] for a in (machine.axes[k] for k in machine.rotary)]).T
    assert (rotary >= low - HALF_DIGIT).all()
    assert (rotary <= high + HALF_DIGIT).all()


@settings(max_examples=60)
@given(
    name=st.sampled_from(sorted(MACHINES)),
    tilt=st.floats(3.0, 29.0),
    start=st.floats(-180.0, 180.0),
    turns=st.floats(1.2, 3.6),
    sense=st.sampled_from([-1.0, 1.0]),
)
def test_winding_by_several_turns_is_proven(
    name: str, tilt: float, start: float, turns: float, sense: float, folder: Path
) -> None:
    machine = MACHINES[name]
    moves = winding(tilt, start, start + sense * 360.0 * turns, 300)
    toolpath = toolpath_of(replace(moves, tip=30.0 * moves.axis))
    needs_none = machine.axes[machine.rotary[0]].endless
    found = proven(machine, toolpath, folder)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    rewinds = [p for p in plan([toolpath], machine, 0.001).problems if "to rewind" in p.what]
    assert all(problem.severity is Severity.WARNING for problem in rewinds)
    if needs_none:
        assert not rewinds
