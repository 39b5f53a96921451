"""What happens between the motions of a run, in time: dwells, tool changes, and the spindle, for which motions wait.

In:     a ``Run``, what its machine can do, and how long its rows move.
Out:    ``Scheduled``: how long the axes wait before each row, the events with their seconds, and the spindle.
Units:  seconds, rev/min; negative speeds are counter-clockwise (M4).

Between two rows things happen one after the other, in the order of the program. In one block the spindle stops before
the tool is changed, and starts after it. A tool is changed when the spindle stands: it is told to stop by M6 at the
latest. After the change it stands until the program starts it, or until a motion at feed needs it as it was. The end of
the program stops it. The first motion at feed after the spindle stood, or turned the other way, waits for its speed.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints, distinct
from trunnion.model.run import Run, RunEvent
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.spindle import SpindleRamps, SpindleSpeeds

#: Events for which the axes wait as long as they take.
PAUSES: Final = ("dwell", "tool_change")

#: Senses of the values of the event ``spindle``; of all others the spindle stands.
_SENSES: Final = {"clockwise": 1.0, "counter-clockwise": -1.0}


@dataclass(frozen=True, slots=True)
class TimedEvent:
    """An event of a run in time: the second at which it happens, and how many seconds it takes.

    The axes wait for dwells and tool changes, and for the spindle as ``schedule`` says. What comes after a stop for the
    operator happens after it, if only by the smallest step of a number.
    """

    seconds: float
    takes: float
    event: RunEvent


@dataclass(frozen=True, slots=True, eq=False)
class Scheduled:
    """What happens between n rows.

    waits     (n + 1,)  seconds that the axes wait before each row, and after the last one
    events    in order
    spindle
    duration  seconds of the whole program
    """

    waits: Floats
    events: tuple[TimedEvent, ...]
    spindle: SpindleSpeeds
    duration: float


@dataclass(frozen=True, slots=True)
class _Gap:
    """What happens before a row.

    events  in the order in which they happen, each with the speed that it tells the spindle; None: it tells nothing
    speed   that the spindle has been told at the end of the gap
    feed    row at feed that waits for the spindle; -1: none does
    """

    row: int
    events: tuple[tuple[RunEvent, float | None], ...]
    speed: float
    feed: int


class Schedule:
    """Puts the events of a run between its motions."""

    def __init__(self, run: Run, dynamics: AxisDynamics) -> None:
        self._run, self._dynamics = run, dynamics
        self._n = len(run)
        self._gaps = tuple(_gaps(run))

    @property
    def stops(self) -> Ints:
        """Rows after which the axes stop, as the next one may wait for the spindle."""
        if not math.isfinite(self._dynamics.spindle):
            return np.zeros(0, np.int64)
        return np.array([gap.feed - 1 for gap in self._gaps if gap.feed > 0], np.int64)

    def timed(self, moved: Floats) -> Scheduled:
        """Return everything in time; ``moved`` (n,) are the seconds of motion until the end of each row."""
        n = self._n
        waits, events = np.zeros(n + 1), []
        ramps = SpindleRamps(self._dynamics.spindle)
        shift, waiting = 0.0, -1
        for gap in self._gaps:
            if 0 <= waiting < gap.row:
                shift += self._wait_for_spindle(waiting, moved, shift, ramps, waits)
                waiting = -1
            now = begun = (float(moved[gap.row - 1]) if gap.row else 0.0) + shift
            for event, speed in gap.events:
                takes = self._takes(event, speed, now, ramps)
                events.append(TimedEvent(now, takes, event))
                if event.kind in PAUSES:
                    now += takes
                elif event.kind == "stop":
                    now = math.nextafter(now, math.inf)
            ramps.tell(now, gap.speed)
            waits[gap.row] += now - begun
            shift += now - begun
            if gap.feed >= 0 or gap.speed == 0.0:
                waiting = gap.feed
        if waiting >= 0:
            shift += self._wait_for_spindle(waiting, moved, shift, ramps, waits)
        end = (float(moved[-1]) if n else 0.0) + shift
        spindle = ramps.speeds()
        waits[n] += max(spindle.end() - end, 0.0)
        return Scheduled(waits, tuple(events), spindle, max(end, spindle.end()))

    def _takes(self, event: RunEvent, speed: float | None, now: float, ramps: SpindleRamps) -> float:
        """Seconds that an event takes; the spindle is told its speed."""
        if speed is not None:
            ramps.tell(now, speed)
        standing = max(ramps.ready() - now, 0.0)
        if event.kind == "tool_change":
            return standing + self._dynamics.tool_change
        if event.kind == "dwell":
            return self._dwell(event, abs(ramps.told))
        return standing if event.kind == "spindle" else 0.0

    def _dwell(self, event: RunEvent, rpm: float) -> float:
        """Seconds of a dwell; of revolutions at a speed, or that of the column where the spindle stands."""
        value, last = event.value, self._n - 1
        if not isinstance(value, float) or not math.isfinite(value):
            return 0.0
        if value >= 0.0:
            return value
        rpm = rpm or (float(self._run.state.rpm[min(event.before_row, last)]) if last >= 0 else 0.0)
        return -value * 60.0 / rpm if rpm > 0.0 else 0.0

    def _wait_for_spindle(self, row: int, moved: Floats, shift: float, ramps: SpindleRamps, waits: Floats) -> float:
        """Let a row wait until the spindle has its speed, and return how long."""
        wait = max(ramps.ready() - (float(moved[row - 1]) if row else 0.0) - shift, 0.0)
        waits[row] += wait
        return wait


def _gaps(run: Run) -> Iterator[_Gap]:
    """Yield what happens between rows, in order, and where the spindle gets another speed."""
    n = len(run)
    events: dict[int, list[RunEvent]] = {}
    for event in run.events:
        events.setdefault(min(event.before_row, n), []).append(event)
    told = np.array([row for row, of_row in events.items() if any(each.kind == "spindle" for each in of_row)], np.int64)
    rows, wanted, rpm = _wanted(run, np.array(list(events), np.int64))
    feed = np.append(np.flatnonzero(run.kind != Kind.RAPID), n)
    feed = feed[np.searchsorted(feed, rows)]
    # The spindle is needed as it was where a motion at feed comes before the program says anything about it.
    told = np.append(np.sort(told), n)
    needed = feed < told[np.minimum(np.searchsorted(told, rows, "right"), len(told) - 1)]
    before, held, ended = 0.0, False, False
    for k, row in enumerate(rows.tolist()):
        of_row, stood = [], False
        for event in _in_their_order(events.get(row, ())):
            speed = None
            if event.kind == "spindle":
                speed = _SENSES.get(str(event.value), 0.0) * float(rpm[k])
                held = False
            elif event.kind == "tool_change":
                speed, held = 0.0, True
            elif event.kind == "end":
                speed, ended = 0.0, True
            stood = stood or speed == 0.0
            of_row.append((event, speed))
        held = held and not bool(needed[k])
        speed = 0.0 if held or ended else float(wanted[k])
        starts = speed != 0.0 and (speed * before <= 0.0 or stood)
        yield _Gap(row, tuple(of_row), speed, int(feed[k]) if starts and feed[k] < n else -1)
        before = speed


def _wanted(run: Run, rows: Ints) -> tuple[Ints, Floats, Floats]:
    """Rows at which something may happen, ascending, and the spindle from there on: its speed with and without sense.

    They are ``rows``, and those at which the columns change.
    """
    state, n = run.state, len(run)
    columns = [(np.minimum(column.rows, n), column.values) for column in (state.rpm, state.spindle)]
    rows = distinct(np.concatenate([*(each for each, _ in columns), rows]))
    rpm, sense = (values[np.searchsorted(each, rows, "right") - 1] for each, values in columns)
    return rows, np.asarray(rpm * sense, np.float64), np.asarray(rpm, np.float64)


def _in_their_order(events: Sequence[RunEvent]) -> Iterator[RunEvent]:
    """Yield events as they happen: in one block the spindle stops first and starts last."""
    for _, block in groupby(events, key=lambda event: (event.file, event.line)):
        yield from sorted(block, key=_place_in_block)


def _place_in_block(event: RunEvent) -> int:
    return 0 if event.kind != "spindle" else 1 if str(event.value) in _SENSES else -1
