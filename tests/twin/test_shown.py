"""What a twin shows between motions and while it is operated: blocks, spindle, feed, alarms, states."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from asyncua import ua

from trunnion import load_machine
from trunnion.jobs.twin.serving import twin_program
from trunnion.machines import Machine
from trunnion.machines.machine import MachineFacts
from trunnion.twin.mtconnect.observations import _EXECUTION
from trunnion.twin.opcua.columns import columns_of
from trunnion.twin.opcua.states import _predicted
from trunnion.twin.playback import Playback, PlayState
from trunnion.twin.running import Twin
from trunnion.twin.snapshots import Snapshots, TwinProgram, display_range, displayed


@pytest.fixture(autouse=True)
def position_type(monkeypatch: pytest.MonkeyPatch) -> None:
    """The structure that a server has once its NodeSets are loaded."""
    monkeypatch.setattr(ua, "CncPositionDataType", dict, raising=False)


HEAD = "N1 G40 G17 G710 G94 G90 G60\nN3 G54 D1\n"


def machine() -> Machine:
    """A machine whose axes and spindle need their time."""
    yl569 = load_machine("yl569")
    axes = tuple(replace(axis, acceleration=120.0 if axis.is_rotary else 1000.0) for axis in yl569.axes)
    return replace(yl569, axes=axes, facts=MachineFacts(tool_change_s=8.0, spindle_acceleration_rpm_s=1000.0))


def program_of(tmp_path: Path, text: str, *, placed: bool = False) -> TwinProgram:
    file = tmp_path / "a.mpf"
    file.write_text(HEAD + text, encoding="utf-8")
    zero = {"zero": (0.0, 0.0, 0.0), "tool_length": 0.0} if placed else {}
    return twin_program(file, machine=machine(), **zero)  # type: ignore[arg-type]


@dataclass
class Watcher:
    """Keeps what a twin tells."""

    shown: list[tuple[Snapshots, int]] = field(default_factory=list)
    stamps: list[datetime] = field(default_factory=list)
    states: list[tuple[PlayState, int, float]] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    alarms: list[tuple[bool, str]] = field(default_factory=list)

    async def show(self, snapshots: Snapshots, stamps: list[datetime], microseconds: list[int]) -> None:
        self.shown += [(snapshots, k) for k in range(len(snapshots))]
        self.stamps += stamps

    async def changed(self, playback: Playback, wall: float) -> None:
        self.states.append((playback.state, playback.completed, wall))

    async def message(self, text: str, stamp: datetime) -> None:
        self.messages.append(text)

    async def alarm(self, identifier: str, text: str, stamp: datetime) -> None:
        self.alarms.append((True, identifier))

    async def alarm_over(self, identifier: str, text: str, stamp: datetime) -> None:
        self.alarms.append((False, identifier))

    def lagging(self) -> dict[object, int]:
        return {}

    def last(self) -> tuple[Snapshots, int]:
        return self.shown[-1]


class Clock:
    """Wall time that goes on as a test has it."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


def operated(
    program: TwinProgram, steps: Callable[[Twin, Watcher, Clock], Awaitable[None]], *, loop: bool = False
) -> Watcher:
    """Start a twin and do some steps with it."""
    watcher, clock = Watcher(), Clock()
    twin = Twin(program, Playback(program.timed, speed=1.0, loop=loop), 0.05, clock)
    twin.outlets.append(watcher)

    async def whole() -> None:
        await twin._show_start()
        await twin._tell_state()
        await twin.start()
        await steps(twin, watcher, clock)

    asyncio.run(whole())
    return watcher


async def go(twin: Twin, clock: Clock, seconds: float) -> None:
    end = clock.now + seconds
    while clock.now < end - 1e-9:
        clock.now = min(clock.now + 0.25, end)
        await twin._advance()


def at(program: TwinProgram, seconds: float) -> Snapshots:
    return program.at(np.array([seconds]), np.array([-1]))


CHANGES = "N5 T1 M6\nN6 S1000 M3\nN10 G1 X50 F3000\nN11 M5\nN12 T2\nN13 M6\nN14 S3000 M3\nN15 G1 X0\nN16 M5\nN17 M30\n"


def test_the_spindle_stands_while_a_tool_is_changed_and_after_the_end(tmp_path: Path) -> None:
    program = program_of(tmp_path, CHANGES)
    # 8 s change, 1 s spindle, 1.05 s cut, 1 s until the spindle stands, 8 s change, 3 s spindle, 1.05 s cut, 3 s
    assert program.timed.duration == pytest.approx(26.1, abs=1e-6)
    during = at(program, 15.0)
    assert (during.rpm[0], during.told_rpm[0]) == (0.0, 0.0)
    assert during.blocks[0].number == "N13"
    assert 5 in during.blocks[0].m
    assert during.blocks[0].tool == "1"
    assert at(program, 19.1).blocks[0].tool == "2"
    end = at(program, program.timed.duration)
    assert (end.rpm[0], end.told_rpm[0], end.feed[0]) == (0.0, 0.0, 0.0)
    assert (end.blocks[0].number, end.blocks[0].m) == ("N17", (5,))
    assert not end.moving.any()


def test_the_status_of_the_spindle_tells_where_it_goes(tmp_path: Path) -> None:
    program = program_of(tmp_path, CHANGES)
    shown = {seconds: columns_of(program, at(program, seconds)) for seconds in (8.5, 9.5, 10.5, 15.0, 20.0, 24.0)}
    status = {seconds: columns["spindle.status"][0] for seconds, columns in shown.items()}
    assert status == {8.5: 2, 9.5: 1, 10.5: 3, 15.0: 0, 20.0: 2, 24.0: 3}  # OPC 40502: stopped, target, up, down
    assert shown[8.5]["spindle.commanded"] == [1000.0]


def test_blocks_without_motion_are_shown_while_they_take_their_time(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N5 T1 M6\nN10 G1 X50 F3000\nN11 G4 F2\nN12 X0\nN99 M30\n")
    assert at(program, 4.0).blocks[0].blocks == ("N3 G54 D1", "N5 T1 M6", "N10 G1 X50 F3000")
    assert at(program, 4.0).blocks[0].line == 3
    assert at(program, 10.0).blocks[0].number == "N11"
    assert at(program, 11.5).blocks[0].number == "N12"


@pytest.mark.parametrize(
    ("text", "programmed"),
    [
        ("G95 F0.5 G1 X50", 500.0),
        ("G93 F2 G1 X50", 100.0),
        ("G700 G95 F0.01 G1 X2", 254.0),
        ("F1200 G1 X50 C30", 1200.0),
        # Degrees a minute were told as mm a minute: the tip is 20 mm from the axis that turns.
        ("G0 X20\nN11 F360 G1 C180", 360.0 * 20.0 * np.pi / 180.0),
    ],
)
def test_programmed_and_actual_feed_are_path_feed_in_mm_a_minute(tmp_path: Path, text: str, programmed: float) -> None:
    program = program_of(tmp_path, f"N6 S1000 M3\nN10 {text}\nN99 M30\n")
    middle = 0.5 * float(program.timed.begins[-1] + program.timed.ends[-1])
    shown = at(program, middle)
    assert columns_of(program, shown)["block.feed"][0] == pytest.approx(programmed, rel=2e-4)
    assert shown.feed[0] == pytest.approx(programmed, rel=2e-4)


def test_override_and_hold_are_in_the_feed(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N10 G1 X100 F600\nN99 M30\n")

    async def steps(twin: Twin, watcher: Watcher, clock: Clock) -> None:
        for percent, feed in ((100.0, 600.0), (50.0, 300.0), (0.0, 0.0)):
            await go(twin, clock, 1.0)
            await twin.set_override(percent)
            snapshots, k = watcher.last()
            assert snapshots.feed[k] == pytest.approx(feed)
            await go(twin, clock, 0.5)
            snapshots, k = watcher.last()
            assert snapshots.feed[k] == pytest.approx(feed)
            assert bool(snapshots.moving[k].any()) is (feed > 0.0)
        await twin.set_override(100.0)
        clock.now += 0.3333
        await twin.hold()
        snapshots, k = watcher.last()
        assert (snapshots.feed[k], snapshots.moving[k].any()) == (0.0, False)
        assert snapshots.seconds[k] == twin.playback.seconds
        assert watcher.stamps[-1].timestamp() == pytest.approx(clock.now)

    operated(program, steps)


def test_at_a_stop_of_the_program_the_axes_stand_and_no_feed_hold_is_told(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N10 G1 X50 F3000\nN11 M0\nN12 M0\nN13 T2 M6\nN14 X0\nN99 M30\n")

    async def steps(twin: Twin, watcher: Watcher, clock: Clock) -> None:
        for number in ("N11", "N12"):
            await go(twin, clock, 3.0)
            assert twin.playback.state is PlayState.STOPPED
            snapshots, k = watcher.last()
            assert snapshots.blocks[k].number == number
            assert (snapshots.feed[k], snapshots.moving[k].any()) == (0.0, False)
            await twin.start()
        await go(twin, clock, 20.0)
        assert twin.playback.state is PlayState.ENDED

    watcher = operated(program, steps)
    assert _EXECUTION[PlayState.STOPPED] == "PROGRAM_STOPPED"
    assert PlayState.HELD not in [state for state, _, _ in watcher.states]


def test_an_alarm_is_over_when_the_axis_is_back(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N10 G1 X260 F6000\nN11 X200\nN99 M30\n", placed=True)

    async def steps(twin: Twin, watcher: Watcher, clock: Clock) -> None:
        await go(twin, clock, 10.0)

    assert operated(program, steps).alarms == [(True, "travel X"), (False, "travel X")]


def test_each_cycle_of_a_loop_is_completed_at_its_end(tmp_path: Path) -> None:
    program = program_of(tmp_path, 'N9 MSG("A")\nN10 G1 X50 F2900\nN11 X0\nN12 MSG("")\nN99 M30\n')

    async def steps(twin: Twin, watcher: Watcher, clock: Clock) -> None:
        await go(twin, clock, 2.0 * program.timed.duration + 0.5)

    watcher = operated(program, steps, loop=True)
    ended = [(completed, wall) for state, completed, wall in watcher.states if state is PlayState.ENDED]
    assert [completed for completed, _ in ended] == [1, 2]
    assert ended[0][1] == pytest.approx(1000.0 + program.timed.duration)
    duration = program.timed.duration
    at_end = [(s, k) for s, k in watcher.shown if s.seconds[k] == duration and not s.is_end[k]]
    assert [(s.blocks[k].line, s.feed[k], s.moving[k].any()) for s, k in at_end] == [(7, 0.0, False)] * 2
    assert watcher.messages[:2] == ["A", ""]


def test_nothing_of_the_program_is_shown_before_it_runs(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N5 T2 M6\nN6 G0 X0\nN7 G0 Y0\nN10 G1 X50 F3000\nN99 M30\n")
    snapshots = program.before_start()
    assert (snapshots.row[0], snapshots.blocks[0].tool, snapshots.blocks[0].line) == (-1, "", 0)


def test_axes_that_go_on_move_at_the_ends_of_blocks(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N10 G64 G1 X50 F3000\nN11 X100\nN12 Y50\nN99 M30\n")
    ends = program.at(program.timed.ends, np.arange(3))
    column = program.machine.column("X")
    assert ends.moving[:, column].tolist() == [True, False, False]


def test_an_endless_axis_is_shown_within_its_turn(tmp_path: Path) -> None:
    program = program_of(tmp_path, "N10 G1 C=IC(-730) F5000\nN99 M30\n")
    column = program.machine.column("C")
    assert displayed(program.machine, column, np.array([-360.0, -357.2, 0.0, 725.0, -1e-16])).tolist() == pytest.approx(
        [0.0, 2.8, 0.0, 5.0, 0.0]
    )
    low, high = display_range(program.machine, column)
    assert (low, high) == (0.0, 360.0)
    shown = columns_of(program, program.at(np.linspace(0.0, program.timed.duration, 200), np.full(200, -1)))
    assert all(low <= value <= high for value in shown["axis.C.actual"])


def test_ranges_of_slides_without_a_zero_are_not_those_of_the_machine(tmp_path: Path) -> None:
    text = "N10 G1 X50 F3000\nN99 M30\n"
    free, placed = (program_of(tmp_path, text, placed=each).machine for each in (False, True))
    column = placed.column("X")
    assert display_range(placed, column) == (-250.0, 250.0)
    assert display_range(free, column) != (-250.0, 250.0)
    assert np.isfinite(display_range(free, column)).all()


def test_nobody_predicts_the_end_of_a_program_that_stands(tmp_path: Path) -> None:
    playback = Playback(program_of(tmp_path, "N10 G1 X50 F3000\nN99 M30\n").timed)
    assert _predicted(playback, 0.0) is not None
    playback.override = 0.0
    assert _predicted(playback, 0.0) is None


def test_a_tool_with_a_name_has_one_number_everywhere(tmp_path: Path) -> None:
    program = program_of(tmp_path, 'N5 T="MILL_10" M6\nN10 G1 X50 F3000\nN99 M30\n')
    assert program.tool_number("MILL_10") == 1
    assert columns_of(program, at(program, 8.5))["block.tool_number"] == [1]


def test_a_twin_says_what_its_positions_and_times_stand_on(tmp_path: Path) -> None:
    file = tmp_path / "part.mpf"
    file.write_text(HEAD + "G0 X0 Y0 Z50 B0 C0\nG1 X10 F500\nM30\n")
    assert twin_program(file, machine="yl569").grounds.not_measured == ()
    file.write_text(HEAD + "G0 X0 Y0 Z50 B0 C0\nG1 X10 C30 F500\nM30\n")
    found = twin_program(file, machine="yl569").grounds.not_measured
    assert [value.partition(" (")[0] for value in found] == ["C point_mm", "spindle gauge_point_mm"]


def test_axes_show_how_they_move_and_when_they_stand_at_an_end_of_their_travel(tmp_path: Path) -> None:
    text = "TRAFOOF\nT=1\nM6\nG1 X250 F3000\nG4 F1\nG1 X0\nM30\n"
    program = program_of(tmp_path, text, placed=True)
    shown = program.at(np.linspace(0.0, program.timed.duration, 2001), np.full(2001, -1))
    columns = columns_of(program, shown)
    speed = np.array(columns["axis.X.velocity"])
    assert speed.max() == pytest.approx(50.0, rel=1e-6)
    assert np.abs(columns["axis.X.acceleration"]).max() == pytest.approx(1000.0, rel=1e-6)
    assert not np.any(columns["axis.X.jerk"])
    at_plus = np.array(columns["axis.X.at_plus"])
    assert at_plus.any()
    assert (np.array(columns["axis.X.actual"])[at_plus] > 250.0 - 1e-3).all()
    assert not np.any(columns["axis.X.at_minus"])
    assert "axis.C.at_plus" not in columns  # turns without end
    assert columns["block.has_tool"][-1]
    slow = program.at(shown.seconds, np.full(2001, -1), 0.5)
    np.testing.assert_allclose(slow.rates[:, 0], 0.5 * shown.rates[:, 0])
    np.testing.assert_allclose(slow.rates[:, 1], 0.25 * shown.rates[:, 1])


def test_nobody_knows_ends_of_travel_without_a_workpiece_zero(tmp_path: Path) -> None:
    program = program_of(tmp_path, "TRAFOOF\nG1 X250 F3000\nM30\n")
    columns = columns_of(program, program.at(np.zeros(1), np.full(1, -1)))
    assert not [name for name in columns if name.endswith(("at_plus", "at_minus")) and name.startswith("axis.X")]
