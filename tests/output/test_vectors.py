"""Tool vectors: the machine goes where it would go with rotary words."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import settings as sized
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.jobs import post_job
from tests.support.locations import YL569
from tests.support.path_strategies import short_paths, smooth_paths, winding
from tests.support.read_back import CONTROL, MACHINES, toolpath_of
from trunnion.arrays import Floats
from trunnion.cli import main
from trunnion.errors import InputError, RefusedError
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.machines import AngleOutput, Machine
from trunnion.model.run import Orientation, ProgrammedWord, Run
from trunnion.model.toolpath import Moves, Toolpath
from trunnion.output.program_writer import write_program
from trunnion.planning import PlanOptions
from trunnion.readers import run_program
from trunnion.verification import failures, verify

#: A rotary word is half of this off, and so is what the vector comes to.
DIGIT = 1e-5


PATHS = st.one_of(
    short_paths(12),
    smooth_paths(25.0),
    smooth_paths(100.0),
    st.builds(winding, st.floats(3.0, 29.0), st.floats(-180.0, 180.0), st.floats(400.0, 900.0), st.just(120)),
)


def posted(machine: Machine, toolpath: Toolpath, folder: Path, orientation: str) -> Run:
    """The program as it runs, proven."""
    program = plan_program([toolpath], post_job(machine, CONTROL, PlanOptions(), {"orientation": orientation}))[0]
    target = folder / f"{orientation}.mpf"
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    run = run_program(target, machine)
    found = verify(run, [toolpath], tolerances=expected.tolerances, settings=expected.settings)
    assert [(check.key, check.summary) for check in failures(found)] == []
    return run


def wound(machine: Machine, rotary: Floats) -> Floats:
    """Rotary positions with those of one turn in that turn."""
    found = rotary.copy()
    for k, column in enumerate(machine.rotary):
        if machine.axes[column].endless and machine.axes[column].output is not AngleOutput.NONE:
            found[:, k] -= 360.0 * np.floor(found[:, k] / 360.0)
    return found


@sized(max_examples=examples(25))
@given(name=st.sampled_from(sorted(MACHINES)), moves=PATHS)
def test_axes_stand_where_rotary_words_would_have_them(
    tmp_path_factory: pytest.TempPathFactory, name: str, moves: Moves
) -> None:
    machine, folder = MACHINES[name], tmp_path_factory.getbasetemp()
    try:
        words = posted(machine, toolpath_of(moves), folder, "angles")
    except (RefusedError, InputError):
        assume(False)
    vectors = posted(machine, toolpath_of(moves), folder, "vector")
    assume(words.tcp.any())
    assert len(words) == len(vectors)
    apart = np.abs(wound(machine, words.rotary) - wound(machine, vectors.rotary))
    assert np.minimum(apart, np.abs(apart - 360.0)).max() <= DIGIT + 1e-9
    by_vector = (vectors.programmed & int(ProgrammedWord.VECTOR)) != 0
    by_words = (vectors.programmed & int(ProgrammedWord.FIRST | ProgrammedWord.SECOND)) != 0
    assert (vectors.orientation[by_vector & vectors.tcp] == Orientation.GREAT_CIRCLE).all()
    assert (vectors.orientation[by_words & vectors.tcp & ~vectors.machine_frame] == Orientation.ANGLES).all()


def test_a_vector_has_all_its_components_and_stands_where_the_orientation_changes(tmp_path: Path) -> None:
    target = tmp_path / "v.mpf"
    command = ["post", str(YL569 / "3_blade_finish.cls"), "--machine", "yl569", "--output", str(target)]
    assert main([*command, "--set", "orientation=vector", "--set", "axis_tolerance=0.01"]) == 0
    text = target.read_text(encoding="utf-8")
    blocks = re.findall(r"(?m)^N\d+ .*[ABC]3=.*$", text)
    assert len(blocks) > 100
    number = r"-?\d*\.\d{1,9}"
    assert all(re.search(rf" A3={number} B3={number} C3={number}( |$)", block) for block in blocks)
    assert not re.search(r"(?m)^N\d+ .*A3=.* [BC]-?[\d.]+( |$)", text)
    said = [re.search(r"A3=.*?C3=\S+", block) for block in blocks]
    assert all(one and two and one[0] != two[0] for one, two in pairwise(said))
    assert "ORIVECT\n" in text
    assert "ORIAXES" not in text
