"""Plans for every shipped machine: written, read back by the independent reader, and proven."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.jobs import post_job
from tests.support.path_strategies import short_paths, smooth_paths, winding
from tests.support.read_back import CONTROL, MACHINES, toolpath_of
from trunnion.errors import InputError, RefusedError, Severity
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.machines import Machine
from trunnion.model.toolpath import Moves, Toolpath
from trunnion.output.program_writer import write_program
from trunnion.planning import PlanOptions, plan
from trunnion.readers import run_program
from trunnion.verification import Verification, failures, verify

#: How far the rotary axes may be beyond a limit: half the last printed digit.
HALF_DIGIT = 0.5e-5 + 1e-9


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


@settings(max_examples=examples(80))
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


@settings(max_examples=examples(25))
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
