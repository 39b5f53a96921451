"""The clock of a twin: every end of a block is met once, in order, at its time, however the wall time goes on."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.twins import BLADE_FINISH, HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.model.run import RunEvent
from trunnion.timing import TimedEvent, TimedRun
from trunnion.twin.playback import MOST_ENDS, Playback, PlayState


@cache
def timed() -> TimedRun:
    return twin_program(BLADE_FINISH, machine="yl569").timed


def with_events(*events: tuple[float, float, str]) -> TimedRun:
    """The golden program with events at other times."""
    run = timed()
    made = tuple(TimedEvent(at, takes, RunEvent(1, 0, kind)) for at, takes, kind in events)
    waits = np.array([(at, at + takes) for at, takes, _ in events if takes > 0.0]).reshape(-1, 2)
    fields = {name: getattr(run, name) for name in TimedRun.__dataclass_fields__}
    fields |= {"events": made, "waits": waits}
    return TimedRun(**fields)


@given(
    steps=st.lists(st.floats(1e-4, 2.0), min_size=1, max_size=60),
    speed=st.one_of(st.none(), st.floats(0.1, 1000.0)),
    overrides=st.lists(st.floats(1.0, 100.0), min_size=1, max_size=5),
)
def test_every_end_is_met_once_in_order_and_at_its_time(
    steps: list[float], speed: float | None, overrides: list[float]
) -> None:
    playback = Playback(timed(), speed=speed)
    playback.start(1000.0)
    wall, rows, seconds, walls = 1000.0, [], [], []
    for k in range(100_000):
        if playback.state is not PlayState.RUNNING:
            break
        wall += steps[k % len(steps)] if k < len(steps) else 1.0
        playback.override = overrides[k % len(overrides)]
        for stretch in playback.advance(wall):
            met, at = playback.ends_within(stretch)
            rows += met.tolist()
            seconds += at.tolist()
            walls += stretch.wall(at).tolist()
            assert stretch.wall_end <= wall
    assert playback.state is PlayState.ENDED
    assert rows == list(range(len(timed().run)))
    assert np.array_equal(seconds, timed().ends)
    assert bool((np.diff(walls) >= 0.0).all())


def test_ends_are_stamped_with_their_time_at_any_speed() -> None:
    playback = Playback(timed(), speed=50.0)
    playback.start(1000.0)
    wall, found = 1000.0, []
    while playback.state is PlayState.RUNNING:
        wall += 0.013
        for stretch in playback.advance(wall):
            found += stretch.wall(playback.ends_within(stretch)[1]).tolist()
    assert found == pytest.approx(1000.0 + timed().ends / 50.0, abs=1e-6)


def test_a_hold_stands_and_goes_on_where_it_stood() -> None:
    playback = Playback(timed())
    playback.start(0.0)
    playback.advance(5.0)
    assert playback.hold()
    assert not playback.hold()
    assert playback.advance(50.0) == ()
    assert playback.seconds == pytest.approx(5.0)
    assert playback.start(100.0)
    playback.advance(101.0)
    assert playback.seconds == pytest.approx(6.0)
    playback.reset()
    assert (playback.seconds, playback.state) == (0.0, PlayState.READY)


def test_the_override_slows_motion_and_no_waits() -> None:
    playback = Playback(with_events((2.0, 3.0, "dwell")))
    playback.start(0.0)
    playback.override = 50.0
    playback.advance(4.0)  # 2 s of motion at half speed
    assert playback.seconds == pytest.approx(2.0)
    playback.advance(7.0)  # the dwell as it is
    assert playback.seconds == pytest.approx(5.0)
    assert playback.remaining() == pytest.approx(2.0 * (playback.duration - 5.0))
    playback.override = 0.0
    playback.advance(17.0)
    assert playback.seconds == pytest.approx(5.0)
    assert playback.remaining() == np.inf


def test_a_stop_of_the_program_holds_it_once() -> None:
    playback = Playback(with_events((2.0, 0.0, "stop")), loop=True)
    for begin in (0.0, 100.0):
        playback.start(begin)
        playback.advance(begin + 10.0)
        assert (playback.state, playback.seconds) == (PlayState.STOPPED, 2.0)
        playback.start(begin + 10.0)
        playback.advance(begin + 11.0)
        assert playback.seconds == pytest.approx(3.0)
        playback.advance(begin + 11.5 + playback.duration - 3.0)
        assert playback.state is PlayState.RUNNING
        playback.reset()
    assert playback.completed == 2


def test_a_program_that_is_too_fast_goes_slower_and_skips_nothing() -> None:
    short = twin_program(HUB_ROUGH, machine="yl569").timed
    many = TimedRun(**{name: getattr(short, name) for name in TimedRun.__dataclass_fields__})
    ends = np.linspace(0.001, short.duration, 3 * MOST_ENDS)
    object.__setattr__(many, "ends", ends)
    playback = Playback(many, speed=1000.0)
    playback.start(0.0)
    met = []
    for k in range(1, 6):
        for stretch in playback.advance(float(k)):
            rows, _ = playback.ends_within(stretch)
            assert len(rows) <= MOST_ENDS
            met += rows.tolist()
    assert met == list(range(3 * MOST_ENDS))
