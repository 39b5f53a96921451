"""What happens between motions takes its time in all times alike: those of reports, and those of a run in time."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import YL569
from trunnion.machines import Machine, load_machine
from trunnion.machines.machine import MachineFacts
from trunnion.model.run import CHUNK_ROWS, Run
from trunnion.readers import run_program
from trunnion.timing import RowFeeds, RowTimes, RunTimer, run_timer, time_run

HEAD = "G40 G17 G710 G94 G90 G64\nG54 D1\n"
CIRCLES = "S5000 M3\nG0 X20\nG1 Z0 F5000\n" + "G3 X20 Y0 I-20 J0\n" * 20 + "M5\nM30\n"
HELIX = "S1000 M3\nG1 X20 F6000\nG3 X20 Y0 Z-20 I-20 J0 TURN=1\nM30\n"
CHANGES = "T1 M6\nS1000 M3\nG1 X50 F3000\nG4 F2.5\nX60\nM4\nX80\nG4 S5\nM5\nT2\nM6\nS3000 M3\nG1 X0\nM30\n"
TIP = "TRAORI\nS3000 M3\nG1 X0 Y0 Z0 B0 C0 F3000\nX40 B20 C90\nG3 X0 Y40 CR=40 B40 C200 F6000\nG1 X-20 Z5 B0 C0\nM30\n"


def machine(jerk: float | None = None) -> Machine:
    yl569 = load_machine("yl569")
    axes = tuple(
        replace(axis, acceleration=150.0 if axis.is_rotary else 1000.0, rapid=6000.0, jerk=jerk) for axis in yl569.axes
    )
    return replace(yl569, axes=axes, facts=MachineFacts(tool_change_s=8.0, spindle_acceleration_rpm_s=1000.0))


def row_times(run: Run) -> RowTimes:
    timer, feeds = RunTimer(run), RowFeeds(run)
    for first in range(0, len(run), CHUNK_ROWS):
        end = min(first + CHUNK_ROWS, len(run))
        chunk = run.chunk(first, end)
        timer.add(first, chunk, feeds.part(first, end, chunk))
    return timer.result()


def run_of(tmp_path: Path, text: str, jerk: float | None = None) -> Run:
    (tmp_path / "a.mpf").write_text(HEAD + text, encoding="utf-8")
    return run_program(tmp_path / "a.mpf", machine(jerk))


@pytest.mark.parametrize("jerk", [None, 2e4])
@pytest.mark.parametrize("text", [CIRCLES, HELIX, CHANGES, TIP, "blade"])
def test_all_times_are_those_of_one_planner(tmp_path: Path, text: str, jerk: float | None) -> None:
    blade = text == "blade"
    run = run_program(YL569 / "3_blade_finish.expected.mpf", machine(jerk)) if blade else run_of(tmp_path, text, jerk)
    times, timed = row_times(run), time_run(run)
    whole = float((times.moving + times.waiting).sum())
    assert whole == pytest.approx(timed.duration, rel=0.01)
    moving = float((timed.ends - timed.begins).sum())
    assert float(times.moving.sum()) == pytest.approx(moving, rel=0.01)


def test_a_circle_takes_what_its_way_takes(tmp_path: Path) -> None:
    times = row_times(run_of(tmp_path, CIRCLES))
    # v²/R = 347 mm/s² is within what the axes can do: only the first and the last circle have ramps
    assert times.moving[3:-1] == pytest.approx(2.0 * np.pi * 20.0 / (5000.0 / 60.0), rel=0.01)


def test_circles_beyond_the_acceleration_are_as_slow_as_that_makes_them(tmp_path: Path) -> None:
    small = CIRCLES.replace("20", "5").replace("G3 X5 Y0 I-5 J0\n", "G3 X5 Y0 I-5 J0\n" * 3)
    times = row_times(run_of(tmp_path, small))
    assert times.moving[6:-3] == pytest.approx(2.0 * np.pi * 5.0 / np.sqrt(1000.0 * 5.0), rel=0.03)


def test_pieces_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = run_of(tmp_path, CIRCLES)
    monkeypatch.setattr(run_timer, "_SPARE_PIECES", 0)
    timer, feeds, chunk = RunTimer(run), RowFeeds(run), run.chunk(0, len(run))
    timer.add(0, chunk, feeds.part(0, len(run), chunk))
    assert timer._path._used <= 17 * len(run)
    fewer = float(timer.result().moving.sum())
    monkeypatch.undo()
    assert fewer == pytest.approx(float(row_times(run).moving.sum()), rel=0.05)


def test_what_happens_between_motions_comes_in_the_order_of_the_program(tmp_path: Path) -> None:
    timed = time_run(run_of(tmp_path, CHANGES))
    found = [(each.event.kind, each.seconds, each.takes) for each in timed.events if each.takes > 0.0]
    cut = 1.05  # 50 mm at F3000 with two ramps
    assert found[0] == ("tool_change", 0.0, 8.0)
    assert found[1][1:] == pytest.approx((8.0, 1.0))
    assert found[2][1:] == pytest.approx((9.0 + cut, 2.5))
    kinds = [kind for kind, _, _ in found]
    assert kinds == ["tool_change", "spindle", "dwell", "spindle", "dwell", "spindle", "tool_change", "spindle"]
    reversal, stop, change, start = found[3], found[5], found[6], found[7]
    assert reversal[2] == pytest.approx(2.0)  # from 1000 to the other 1000
    assert found[4][2] == pytest.approx(5 * 60.0 / 1000.0)
    assert change[1] == pytest.approx(stop[1])
    assert change[2] == pytest.approx(9.0)  # the spindle stands after a second
    assert start[1:] == pytest.approx((change[1] + 9.0, 3.0))
    during = timed.at(np.array([change[1] + 5.0]))
    assert (during.rpm[0], during.told_rpm[0]) == (0.0, 0.0)


def test_a_spindle_that_nobody_starts_after_a_change_turns_again_where_it_is_needed(tmp_path: Path) -> None:
    timed = time_run(run_of(tmp_path, "T1 M6\nS1000 M3\nG1 X50 F3000\nT2 M6\nG1 X0\nM30\n"))
    change = [each for each in timed.events if each.event.kind == "tool_change"][1]
    assert timed.begins[1] == pytest.approx(change.seconds + change.takes + 1.0)
    assert timed.at(timed.begins[1:2]).rpm[0] == pytest.approx(1000.0)
    # with a rapid and a start before the cut it stands until then
    late = time_run(run_of(tmp_path, "T1 M6\nS1000 M3\nG1 X50 F3000\nT2 M6\nG0 X40\nS2000 M3\nG1 X0\nM30\n"))
    assert late.at(late.ends[1:2]).rpm[0] == 0.0


def test_the_first_cut_waits_for_a_spindle_that_gets_another_speed_meanwhile(tmp_path: Path) -> None:
    timed = time_run(run_of(tmp_path, "S1000 M3\nG0 X10\nS3000\nG1 X50 F3000\nM30\n"))
    assert timed.begins[1] == pytest.approx(3.0)


def test_the_end_stops_the_spindle_and_the_program_ends_then(tmp_path: Path) -> None:
    for end in ("M5\nM30\n", "M30\n"):
        timed = time_run(run_of(tmp_path, "S2000 M3\nG1 X50 F3000\n" + end))
        assert timed.duration == pytest.approx(float(timed.ends[-1]) + 2.0)
        assert timed.at(np.array([timed.duration])).rpm[0] == pytest.approx(0.0, abs=1e-9)
