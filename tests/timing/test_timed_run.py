"""A run in time."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import TESTS
from trunnion.machines import load_machine
from trunnion.machines.machine import MachineFacts
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.timing import time_run

#: A machine of which nothing is stated but how it moves.
NOTHING = MachineFacts()

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


def stated(path: Path, text: str, facts: MachineFacts = NOTHING) -> Run:
    """A program on a machine that states facts about its spindle and its tool changes, and accelerations."""
    path.write_text(text, encoding="utf-8")
    machine = load_machine("generic_head_table_bc")
    return run_program(path, replace(machine, facts=facts))


def test_a_motion_at_feed_waits_for_the_spindle_and_a_rapid_does_not(tmp_path: Path) -> None:
    text = "G710 G90 G54\nS6000 M3\nG0 X30 Y0 Z10\nG1 X60 F600\nS3000\nX90\nM5\nM30\n"
    free = time_run(stated(tmp_path / "a.mpf", text))
    ramps = time_run(stated(tmp_path / "a.mpf", text, MachineFacts(spindle_acceleration_rpm_s=3000.0)))
    assert ramps.begins[0] == 0.0
    assert ramps.begins[1] == pytest.approx(2.0)  # 6000 rev/min at 3000 a second
    assert free.begins[1] == free.ends[0]
    # half the speed takes a second, in which the axes move; standing again takes one at the end
    assert ramps.begins[2] == ramps.ends[1]
    assert ramps.duration == pytest.approx(ramps.ends[-1] + 1.0)
    times = np.array([0.5, 1.0, 2.5, ramps.ends[1] + 0.5, ramps.ends[1] + 1.5, ramps.ends[-1] + 0.25])
    np.testing.assert_allclose(ramps.at(times).rpm, [1500.0, 3000.0, 6000.0, 4500.0, 3000.0, 2250.0])
    spindle = [each.takes for each in ramps.events if each.event.kind == "spindle"]
    assert spindle == pytest.approx([2.0, 1.0])


def test_a_tool_change_takes_what_the_machine_states(tmp_path: Path) -> None:
    text = "G710 G90 G54\nG0 X30\nT2 M6\nG0 X60\nM30\n"
    free, takes = (
        time_run(stated(tmp_path / "a.mpf", text, facts)) for facts in (NOTHING, MachineFacts(tool_change_s=4.5))
    )
    assert takes.duration - free.duration == pytest.approx(4.5)
    assert takes.begins[1] - takes.ends[0] == pytest.approx(4.5)
    changed = takes.at(takes.ends[:1] + 2.0)
    np.testing.assert_allclose(changed.joints, takes.run.joints[:1])
    assert not changed.velocity.any()


@pytest.mark.parametrize("jerk", [None, 2e4])
def test_velocities_are_those_of_the_positions_and_rows_end_in_their_places(tmp_path: Path, jerk: float | None) -> None:
    text = "G710 G90 G54\nTRAORI\nG0 X30 Y0 Z10 B0 C0\nG1 X60 B20 C30 F3000\nG3 X40 Y20 CR=20\nG1 X0 B-10 C50\nM30\n"
    path = tmp_path / "a.mpf"
    path.write_text(text, encoding="utf-8")
    machine = load_machine("generic_head_table_bc")
    machine = replace(machine, axes=tuple(replace(axis, jerk=jerk) for axis in machine.axes))
    timed = time_run(run_program(path, machine))
    np.testing.assert_allclose(timed.at(timed.ends).joints, timed.run.joints, atol=1e-9, rtol=0)
    times = np.arange(0.0, timed.duration, 1e-4)
    state = timed.at(times)
    mean = np.diff(state.joints, axis=0) / 1e-4
    middle = 0.5 * (state.velocity[1:] + state.velocity[:-1])
    smooth = np.abs(np.diff(state.velocity, axis=0)).max(axis=1) < 1.0
    assert smooth.mean() > 0.9
    np.testing.assert_allclose(mean[smooth], middle[smooth], atol=0.6)
    cuts = state.row >= 1
    assert state.tip_feed[cuts].max() <= 3000.0 * (1.0 + 1e-9)
    assert state.tip_feed[cuts].max() >= 2999.0


@pytest.mark.parametrize("jerk", [None, 2e4])
def test_accelerations_and_jerks_are_those_of_the_velocities(tmp_path: Path, jerk: float | None) -> None:
    """Within a line at even feed and on its ramps; between two of them they step."""
    path = tmp_path / "a.mpf"
    path.write_text("G710 G90 G54\nTRAFOOF\nG1 X60 Y30 F3000\nG1 X0\nM30\n", encoding="utf-8")
    machine = load_machine("generic_head_table_bc")
    axes = tuple(replace(axis, acceleration=500.0, jerk=jerk) for axis in machine.axes)
    timed = time_run(run_program(path, replace(machine, axes=axes)))
    times = np.arange(1e-3, timed.duration - 1e-3, 1e-4)
    state = timed.at(times)
    for lower, higher in ((state.velocity, state.acceleration), (state.acceleration, state.jerk)):
        mean = np.diff(lower, axis=0) / 1e-4
        steps = np.abs(np.diff(higher, axis=0)).max(axis=1) > 1e-6 * (1.0 + np.abs(higher[1:]).max(axis=1)) + 2.1
        steps |= np.diff(state.row) != 0  # the path turns there
        assert steps.mean() < 0.02
        np.testing.assert_allclose(mean[~steps], 0.5 * (higher[1:] + higher[:-1])[~steps], atol=2.0, rtol=1e-6)
        if jerk is None:
            assert not state.jerk.any()
            break
    assert np.abs(state.acceleration).max() == pytest.approx(500.0, rel=1e-6)
    assert np.abs(state.jerk).max() == pytest.approx(jerk or 0.0, rel=1e-6)
