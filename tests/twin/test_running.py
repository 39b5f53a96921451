"""A twin waits for clients who follow slowly, and not for those who are gone."""

import asyncio
from collections import deque
from datetime import datetime

import numpy as np
import pytest

from tests.support.twins import BLADE_FINISH
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin import running
from trunnion.twin.playback import Playback, PlayState
from trunnion.twin.running import Twin
from trunnion.twin.snapshots import Snapshots


class Subscriber:
    """A client with a queue of eight values, which it fetches now and then, or never."""

    def __init__(self, *, fetches: bool) -> None:
        self.queue: deque[tuple[int, float]] = deque()
        self.fetched: list[tuple[int, float]] = []
        self.fullest = 0
        self.states: list[PlayState] = []
        self.moving: list[bool] = []
        self.feeds: list[float] = []
        self.messages: list[str] = []
        self._fetches = fetches

    async def show(self, snapshots: Snapshots, stamps: list[datetime], microseconds: list[int]) -> None:
        self.moving += [bool(each.any()) for each in snapshots.moving]
        self.feeds += snapshots.feed.tolist()
        self.queue += zip(microseconds, snapshots.joints[:, 0].tolist(), strict=True)
        self.fullest = max(self.fullest, len(self.queue))

    async def changed(self, playback: Playback, wall: float) -> None:
        self.states.append(playback.state)

    async def message(self, text: str, stamp: datetime) -> None:
        self.messages.append(text)

    async def alarm(self, identifier: str, text: str, stamp: datetime) -> None:
        raise AssertionError(text)

    async def alarm_over(self, identifier: str, text: str, stamp: datetime) -> None:
        raise AssertionError(text)

    def lagging(self) -> dict[object, int]:
        return {self: len(self.fetched)} if len(self.queue) > 4 else {}

    async def fetch(self) -> None:
        while self._fetches:
            await asyncio.sleep(0.003)
            self.fetched += self.queue
            self.queue.clear()


def run(subscribers: list[Subscriber], speed: float | None) -> None:
    async def whole() -> None:
        program = twin_program(BLADE_FINISH, machine="yl569")
        playback = Playback(program.timed, speed=speed)
        twin = Twin(program, playback, 0.1)
        twin.outlets += subscribers
        tasks = [asyncio.create_task(each.fetch()) for each in subscribers]
        tasks.append(asyncio.create_task(twin.run()))
        while not subscribers[0].states or subscribers[0].states[-1] is not PlayState.ENDED:
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.01)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    asyncio.run(whole())


@pytest.mark.parametrize("speed", [None, 200.0])
def test_no_queue_of_a_client_who_follows_runs_over(speed: float | None) -> None:
    subscriber = Subscriber(fetches=True)
    run([subscriber], speed)
    assert subscriber.fullest <= 8
    told = [*subscriber.fetched, *subscriber.queue]
    stamps = [stamp for stamp, _ in told]
    assert stamps == sorted(set(stamps))
    wanted = twin_program(BLADE_FINISH, machine="yl569").run.joints[:, 0].tolist()
    place = 0
    for value in wanted:
        place = next(k for k in range(place, len(told)) if told[k][1] == value)
    assert subscriber.messages == ["METHOD"]
    assert subscriber.states[0] is PlayState.READY


def test_a_client_who_is_gone_stops_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "_PATIENCE", 1.0)  # longer than this process stands still
    gone, there = Subscriber(fetches=False), Subscriber(fetches=True)
    run([there, gone], None)
    assert there.fullest <= 8
    assert len(gone.queue) > 8


def test_axes_of_a_program_that_does_not_go_on_stand() -> None:
    """At its end, when it is held, and at an override of 0; a machine without accelerations stops at once."""

    async def whole() -> None:
        program = twin_program(BLADE_FINISH, machine="yl569")
        subscriber, now = Subscriber(fetches=False), 1000.0
        twin = Twin(program, Playback(program.timed, speed=1.0), 0.05, clock=lambda: now)
        subscriber.lagging = dict  # type: ignore[method-assign]
        twin.outlets.append(subscriber)

        def last() -> tuple[bool, float]:
            return subscriber.moving[-1], subscriber.feeds[-1]

        await twin.start()
        longest = int(np.argmax(program.timed.ends - program.timed.begins))
        now += float(program.timed.begins[longest] + program.timed.ends[longest]) / 2.0
        await twin.set_override(100.0)
        assert last()[0]
        assert last()[1] > 0.0
        now += 0.001
        await twin.hold()
        assert last() == (False, 0.0)
        await twin.start()
        now += 0.001
        await twin.set_override(0.0)
        assert last() == (False, 0.0)
        now += 1.0
        await twin.set_override(0.0)
        assert last() == (False, 0.0)
        await twin.set_override(100.0)
        assert last()[0]
        assert last()[1] > 0.0
        assert subscriber.moving.count(True) > 10
        while twin.playback.state is PlayState.RUNNING:
            now += 1.0
            await twin.set_override(100.0)
        assert last() == (False, 0.0)
        assert subscriber.queue[-1][1] == program.run.joints[-1, 0]

    asyncio.run(whole())
