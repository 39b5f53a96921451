"""The clock of a twin: which part of a program runs while which wall time passes.

In:     what a client or the user asks for (start, hold, reset, feed override), and the wall time now and then.
Out:    stretches of the program, each with the wall time in which it ran.
Units:  seconds; of the program from its start, of the wall since the epoch.

Nothing here looks at a clock: the caller says what time it is.
"""

from collections.abc import Iterator
from enum import StrEnum
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass
from trunnion.timing import TimedRun

#: Ends of blocks in one call of ``advance``: where more would come, the program goes slower than was asked for.
MOST_ENDS: Final = 400

#: Seconds of the program in one call of ``advance`` when it runs as fast as it can.
_LONGEST_STEP: Final = 10.0


class PlayState(StrEnum):
    """What the program does; it is held by a client, and stopped by itself (M0, M1)."""

    READY = "ready"
    RUNNING = "running"
    HELD = "held"
    STOPPED = "stopped"
    ENDED = "ended"


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of the program that has run: after ``begin``, up to and including ``end``, evenly within the wall time."""

    begin: float
    end: float
    wall_begin: float
    wall_end: float

    def wall(self, seconds: Floats) -> Floats:
        """Return the wall time of times of the program in the stretch, (k,)."""
        if self.end <= self.begin:
            return np.full(len(seconds), self.wall_end)
        done = (seconds - self.begin) / (self.end - self.begin)
        return np.asarray(self.wall_begin + done * (self.wall_end - self.wall_begin))

    def program(self, wall: Floats) -> Floats:
        """Return the time of the program at wall times in the stretch, (k,)."""
        done = (wall - self.wall_begin) / max(self.wall_end - self.wall_begin, 1e-12)
        return np.asarray(self.begin + done * (self.end - self.begin))


class Playback:
    """A program that is started, held and reset, at ``speed`` times real time; None: as fast as it can.

    The feed override slows all motion down along the same path, as far as 0; dwells, tool changes and other waits take
    their time. More than 100 % is not taken: the axes would exceed what the times of the program are planned for. A
    stop of the program (M0) holds it until it is started again.
    """

    def __init__(self, timed: TimedRun, *, speed: float | None = 1.0, loop: bool = False) -> None:
        self._ends = np.maximum.accumulate(timed.ends) if len(timed.ends) else timed.ends
        self.duration = float(timed.duration)
        self.speed, self.loop = speed, loop
        self._waits = timed.waits
        self._stops = np.array(sorted(event.seconds for event in timed.events if event.event.kind == "stop"))
        self._stopped = -1.0
        self.state = PlayState.READY
        self.seconds = 0.0
        self.override = 100.0
        self.completed = 0
        self._wall = 0.0

    def start(self, wall: float) -> bool:
        """Start the program, or go on with it; whether it did not run yet."""
        if self.state is PlayState.RUNNING:
            return False
        if self.state is PlayState.ENDED:
            self.reset()
        self.state, self._wall = PlayState.RUNNING, wall
        return True

    def hold(self) -> bool:
        """Hold all axes where they are; whether the program was running."""
        was_running = self.state is PlayState.RUNNING
        if was_running:
            self.state = PlayState.HELD
        return was_running

    def reset(self) -> None:
        """Go back to the start of the program."""
        self.state, self.seconds, self._stopped = PlayState.READY, 0.0, -1.0

    def skip(self, wall: float) -> None:
        """Let the wall time pass without the program."""
        self._wall = wall

    @property
    def share(self) -> float:
        """Share of its programmed speed at which the program moves now, as a control shows it; 0 while it stands."""
        return self.override / 100.0 if self.state is PlayState.RUNNING else 0.0

    def remaining(self) -> float:
        """Wall seconds until the end of the program at the present speed; infinite where it stands."""
        rate = self._rate(moving=True)
        left = self.duration - self.seconds
        waits = np.clip(self._waits, self.seconds, None)
        waiting = float((waits[:, 1] - waits[:, 0]).sum())
        if self.speed is None:
            return 0.0
        return waiting / self.speed + (left - waiting) / rate if rate > 0.0 else np.inf

    def advance(self, wall: float) -> tuple[Stretch, ...]:
        """Return what has run since the last call, in order; at most ``MOST_ENDS`` ends of blocks."""
        if self.state is not PlayState.RUNNING or wall <= self._wall:
            return ()
        limit = self._limit()
        if self.speed is None:
            return (self._gone(limit, wall),)
        return tuple(self._pieces(limit, wall))

    def ends_within(self, stretch: Stretch) -> tuple[Ints, Floats]:
        """Rows that end in a stretch, in order, and when (program seconds)."""
        first, last = np.searchsorted(self._ends, (stretch.begin, stretch.end), "right").tolist()
        if stretch.begin <= 0.0:
            first = 0  # rows that take no time at the very start
        return np.arange(first, last), self._ends[first:last]

    def _limit(self) -> float:
        """How far the program may go in one step."""
        next_row = int(np.searchsorted(self._ends, self.seconds, "right")) + MOST_ENDS - 1
        limit = float(self._ends[next_row]) if next_row < len(self._ends) else self.duration
        stops: list[float] = self._stops[self._stops > self._stopped][:1].tolist()
        limit = min(limit, *stops, self.duration)
        return min(limit, self.seconds + _LONGEST_STEP) if self.speed is None else limit

    def _rate(self, *, moving: bool) -> float:
        """Seconds of the program in a second of the wall."""
        speed = 1.0 if self.speed is None else self.speed
        return speed * self.override / 100.0 if moving else speed

    def _pieces(self, limit: float, wall: float) -> Iterator[Stretch]:
        while self._wall < wall and self.state is PlayState.RUNNING:
            bound, waiting = self._next_bound(limit)
            rate = self._rate(moving=not waiting)
            reach = self.seconds + rate * (wall - self._wall)
            if reach < bound:
                yield self._gone(reach, wall)
                return
            at_limit = bound >= limit
            # Where the limit cuts the step short, the wall time that is left over passes without the program.
            late = at_limit and limit < self.duration and limit not in self._stops
            yield self._gone(bound, wall if late else self._wall + (bound - self.seconds) / max(rate, 1e-12))
            if at_limit:
                return

    def _next_bound(self, limit: float) -> tuple[float, bool]:
        """Return the time up to which the program moves or waits evenly, and whether it waits."""
        for begin, end in self._waits[np.searchsorted(self._waits[:, 1], self.seconds, "right") :].tolist():
            if begin > self.seconds:
                return min(begin, limit), False
            return min(end, limit), True
        return limit, False

    def _gone(self, seconds: float, wall: float) -> Stretch:
        """Go to a time of the program, which is reached at a wall time."""
        stretch = Stretch(self.seconds, seconds, self._wall, wall)
        self.seconds, self._wall = seconds, wall
        if seconds in self._stops and seconds > self._stopped:
            self._stopped, self.state = seconds, PlayState.STOPPED
        elif seconds >= self.duration:
            self.completed += 1
            self.seconds, self._stopped = (0.0, -1.0) if self.loop else (self.duration, self._stopped)
            self.state = PlayState.RUNNING if self.loop else PlayState.ENDED
        return stretch
