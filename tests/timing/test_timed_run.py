"""A run in time."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import TESTS
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.timing import time_run

PROGRAM = "G710 G90 G54\nT1 M6\nS3000 M3\nG0 X30 Y0 Z10\nG4 F2\nG1 X60 F600\nY20\nM5\nM30\n"


@pytest.fixture(scope="module", params=["blade", "lines"])
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    machine = replace(load_machine("yl569"), workpiece_zero=(10.0, 20.0, 30.0), tool_length=120.0)
    if request.param == "blade":
        return run_program(TESTS / "golden" / "yl569" / "3_blade_finish.expected.mpf", machine)
    program = tmp_path_factory.mktemp("lines") / "lines.mpf"
    program.write_text(PROGRAM, encoding="utf-8")
    return run_program(program, machine)


def test_each_row_ends_where_the_run_has_it(run: Run) -> None:
    timed = time_run(run)
    state = timed.at(timed.ends)
    moves = timed.ends > timed.begins
    np.testing.assert_allclose(state.joints[moves], run.joints[moves], atol=1e-9, rtol=0)
    np.testing.assert_array_equal(state.row[moves], np.flatnonzero(moves))


def test_rows_follow_each_other_and_events_take_their_time(run: Run) -> None:
    timed = time_run(run)
    assert (timed.begins[1:] >= timed.ends[:-1] - 1e-9).all()
    waits = sum(each.takes for each in timed.events)
    assert timed.duration == pytest.approx(float((timed.ends - timed.begins).sum()) + waits)
    seconds = [each.seconds for each in timed.events]
    assert seconds == sorted(seconds)
    assert [each.event for each in timed.events] == run.events


def test_before_the_start_and_after_the_end_the_machine_stands(run: Run) -> None:
    timed = time_run(run)
    state = timed.at(np.array([-1.0, timed.duration + 1.0]))
    np.testing.assert_allclose(state.joints, [run.start, run.joints[-1]], atol=1e-9)
    np.testing.assert_array_equal(state.velocity, np.zeros((2, 5)))
    assert state.row.tolist() == [-1, len(run) - 1]


def test_the_spindle_turns_with_its_rows(tmp_path: Path) -> None:
    (tmp_path / "a.mpf").write_text(PROGRAM.replace("M3\n", "M4\n"), encoding="utf-8")
    timed = time_run(run_program(tmp_path / "a.mpf", load_machine("yl569")))
    state = timed.at(timed.ends)
    assert state.rpm.tolist() == [-3000.0, -3000.0, -3000.0]
