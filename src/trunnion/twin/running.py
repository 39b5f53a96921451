"""Runs a twin: goes with the wall time through the program, and tells clients what the machine shows.

Every end of a block is told, however fast the program runs: where clients cannot follow, the program waits for them.
"""

import asyncio
import math
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import Final, Protocol

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.timing import TimedEvent
from trunnion.twin.playback import Playback, PlayState, Stretch
from trunnion.twin.snapshots import Snapshots, TwinProgram

#: Times that are told before it is looked whether clients follow; queues of twice as many values lose none.
_AT_A_TIME: Final = 4

#: Seconds that the program waits for a client that fetches nothing any more.
_PATIENCE: Final = 2.0

#: Seconds between two looks at clients that do not follow.
_LOOK: Final = 0.002

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)


class Outlet(Protocol):
    """Somebody who tells clients: OPC UA or MTConnect."""

    async def show(self, snapshots: Snapshots, stamps: list[datetime], microseconds: list[int]) -> None:
        """Tell what the machine shows at some times."""

    async def changed(self, playback: Playback, wall: float) -> None:
        """Tell what the program does now."""

    async def message(self, text: str, stamp: datetime) -> None:
        """Tell a message of the program."""

    async def alarm(self, identifier: str, text: str, stamp: datetime) -> None:
        """Tell an alarm of the machine."""

    async def alarm_over(self, identifier: str, text: str, stamp: datetime) -> None:
        """Tell that an alarm is over."""

    def lagging(self) -> dict[object, int]:
        """Clients that do not follow, and how much each has fetched so far."""


class WallClock:
    """The wall time, which goes on evenly even if somebody sets the clock of the computer."""

    def __init__(self) -> None:
        self._offset = time.time() - time.monotonic()

    def now(self) -> float:
        """Seconds since 1970."""
        return self._offset + time.monotonic()


class Twin:
    """A program that runs on a machine, and is operated by clients.

    program   what runs
    playback  its clock
    period    seconds of the wall between two samples; of the program, where it runs as fast as it can
    clock     the wall time, seconds since 1970
    """

    def __init__(
        self, program: TwinProgram, playback: Playback, period: float, clock: Callable[[], float] | None = None
    ) -> None:
        self.program, self.playback, self.period = program, playback, period
        self.clock = clock or WallClock().now
        self.outlets: list[Outlet] = []
        self._last_stamp = 0
        self._beyond = np.zeros(5, np.bool_)
        self._watched = 0.0
        self._lost: dict[object, int] = {}
        self._told = -1.0
        self._turn = asyncio.Lock()  # what is told is told in the order of its time, whoever asks

    # What clients operate

    async def start(self) -> bool:
        """Start the program, or go on with it; whether it did not run."""
        async with self._turn:
            before = self.playback.state
            if not self.playback.start(self.clock()):
                return False
            if before is PlayState.ENDED:
                await self._show_start()
            elif before is not PlayState.READY:
                await self._show_now()
            await self._tell_state()
            return True

    async def hold(self) -> bool:
        """Hold all axes; whether the program was running."""
        async with self._turn:
            await self._advance()
            if not self.playback.hold():
                return False
            await self._show_now()
            await self._tell_state()
            return True

    async def reset(self) -> bool:
        """Go back to the start of the program."""
        async with self._turn:
            self.playback.reset()
            await self._show_start()
            await self._tell_state()
            return True

    async def set_override(self, percent: float) -> bool:
        """Set the feed override; whether it is between 0 and 100."""
        if not 0.0 <= percent <= 100.0:
            return False
        async with self._turn:
            await self._advance()  # what has passed until now went as it was before
            self.playback.override = percent
            if self.playback.state is PlayState.RUNNING:
                await self._show_now()
            await self._tell_state()
            return True

    # The run

    async def run(self, *, started: bool = True) -> None:
        """Go on until cancelled; ``started``: without waiting for a client to start the program."""
        async with self._turn:
            await self._show_start()
            await self._tell_state()
        if started:
            await self.start()
        while True:
            await self._sleep()
            async with self._turn:
                await self._advance()

    async def _advance(self) -> None:
        """Tell what has run since the last time."""
        state, completed = self.playback.state, self.playback.completed
        if await self._wait_for_clients():
            self.playback.skip(self.clock())  # the program has waited as well
        wall = None
        for stretch in self.playback.advance(self.clock()):
            await self._tell(stretch)
            wall = stretch.wall_end
        if self.playback.state is PlayState.RUNNING and self.playback.completed != completed:
            await self._begin_again(wall)
        elif self.playback.state is not state:
            await self._wait_for_clients()
            await self._show_now(wall)
            await self._tell_state(wall)
        elif self.clock() - self._told >= 1.0:
            await self._tell_state()

    async def _begin_again(self, wall: float | None) -> None:
        """Tell the end of a program that runs in a loop, and its start."""
        self.playback.state, self.playback.seconds = PlayState.ENDED, self.playback.duration
        await self._wait_for_clients()
        await self._show_now(wall)
        await self._tell_state(wall)
        self.playback.state, self.playback.seconds = PlayState.RUNNING, 0.0
        await self._wait_for_clients()
        await self._show_start(wall)
        await self._tell_state(wall)

    async def _sleep(self) -> None:
        runs_free = self.playback.speed is None and self.playback.state is PlayState.RUNNING
        left = self.period - math.fmod(self.clock(), self.period)
        await asyncio.sleep(0.0 if runs_free else left)

    async def _wait_for_clients(self) -> bool:
        """Wait until all clients that still fetch have room; whether that took any time."""
        waiting: dict[object, tuple[int, float]] = {}
        while True:
            behind = {client: fetched for outlet in self.outlets for client, fetched in outlet.lagging().items()}
            # Who is given up counts again as soon as he fetches.
            self._lost = {client: fetched for client, fetched in self._lost.items() if behind.get(client) == fetched}
            now, missing = time.monotonic(), behind.keys() - self._lost.keys()
            if not missing:
                return bool(waiting)
            for client in missing:
                before, since = waiting.get(client, (-1, now))
                waiting[client] = behind[client], since if before == behind[client] else now
                if now - waiting[client][1] > _PATIENCE:
                    self._lost[client] = behind[client]
            await asyncio.sleep(_LOOK)

    async def _tell(self, stretch: Stretch) -> None:
        """Tell all ends of blocks in a stretch, and samples between them."""
        rows, ends = self.playback.ends_within(stretch)
        samples = self._samples(stretch)
        seconds = np.concatenate((ends, samples))
        ended = np.concatenate((rows, np.full(len(samples), -1)))
        order = np.argsort(seconds, kind="stable")
        seconds, ended = seconds[order], ended[order]
        wall = stretch.wall(seconds)
        messages = [each for each in self.program.events_within(stretch.begin, stretch.end) if _is_message(each)]
        places = np.searchsorted(seconds, [each.seconds for each in messages], "right").tolist()
        cuts = sorted({0, *range(0, len(seconds), _AT_A_TIME), *places, len(seconds)})
        for first, end in pairwise([0, *cuts]):
            part = slice(first, end)
            await self._wait_for_clients()
            if end > first:
                await self._show(seconds[part], ended[part], wall[part], self.playback.override / 100.0)
            for message, place in zip(messages, places, strict=True):
                if place == end:  # with what the machine shows then: times go on in order
                    await self._tell_message(message, float(stretch.wall(np.array([message.seconds]))[0]))
            await asyncio.sleep(0.0)

    def _samples(self, stretch: Stretch) -> Floats:
        """Return times between the ends of blocks at which the machine is looked at."""
        period = self.period
        if self.playback.speed is None:
            grid = np.arange(math.floor(stretch.begin / period) + 1, math.floor(stretch.end / period) + 1) * period
        else:
            first, last = math.floor(stretch.wall_begin / period) + 1, math.floor(stretch.wall_end / period)
            grid = stretch.program(np.arange(first, last + 1, dtype=np.float64) * period)
        return np.asarray(grid, np.float64)

    async def _show(self, seconds: Floats, ended: Ints, wall: Floats, share: float) -> None:
        await self._publish(self.program.at(seconds, ended, share), wall)

    async def _show_now(self, wall: float | None = None) -> None:
        """Tell what the machine shows as the program goes on, or where it stands: at its end, at a stop, held."""
        now, wall = np.full(1, self.playback.seconds), self.clock() if wall is None else wall
        await self._show(now, np.full(1, -1), np.array([wall]), self.playback.share)

    async def _publish(self, snapshots: Snapshots, wall: Floats) -> None:
        microseconds = [self._next_stamp(each) for each in wall.tolist()]
        stamps = [_EPOCH + timedelta(microseconds=each) for each in microseconds]
        for outlet in self.outlets:
            await outlet.show(snapshots, stamps, microseconds)
        await self._watch_travel(snapshots, stamps)

    async def _watch_travel(self, snapshots: Snapshots, stamps: list[datetime]) -> None:
        """Tell when an axis leaves its travel, and when it is back."""
        machine = self.program.machine
        since, self._watched = self._watched, float(snapshots.seconds[-1])
        for k, beyond in enumerate(self.program.beyond_travel(snapshots, since)):
            for column in np.flatnonzero(beyond != self._beyond).tolist():
                axis, block = machine.axes[column], snapshots.blocks[k]
                place = block.number or f"line {block.line}"
                range_text = f"its travel of {axis.low:g} to {axis.high:g} in {place}"
                for outlet in self.outlets:
                    if beyond[column]:
                        text = f"axis {axis.name} is beyond {range_text}"
                        await outlet.alarm(f"travel {axis.name}", text, stamps[k])
                    else:
                        text = f"axis {axis.name} is back within {range_text}"
                        await outlet.alarm_over(f"travel {axis.name}", text, stamps[k])
            self._beyond = beyond

    async def _tell_message(self, message: TimedEvent, wall: float) -> None:
        stamp = _EPOCH + timedelta(microseconds=self._next_stamp(wall))
        for outlet in self.outlets:
            await outlet.message(str(message.event.value or ""), stamp)

    def _next_stamp(self, wall: float) -> int:
        """Return the microseconds of a time; each has its own, so that what is told twice can be told apart."""
        self._last_stamp = max(round(wall * 1e6), self._last_stamp + 1)
        return self._last_stamp

    async def _show_start(self, wall: float | None = None) -> None:
        self._watched = 0.0
        await self._publish(self.program.before_start(), np.array([self.clock() if wall is None else wall]))

    async def _tell_state(self, wall: float | None = None) -> None:
        self._told = self.clock()
        stamp = self._next_stamp(self._told if wall is None else wall) / 1e6
        for outlet in self.outlets:
            await outlet.changed(self.playback, stamp)


def _is_message(timed: TimedEvent) -> bool:
    return timed.event.kind == "message"
