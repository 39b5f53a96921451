"""Values that a server notifies become rows: one for each time of the machine, in the order of these times.

In:     values as they arrive, batch after batch, and breaks of the connection.
Out:    ``Row``s: what all columns show at a time.
Units:  microseconds since 1970.

A server sends what has changed: a row takes all other columns from the row before. It may send the values of one
variable after those of another, and those of one time in several messages. So rows are made from all values up to the
last time of the message before, but for the newest time of all; those of later times wait for the next message.
"""

from collections.abc import Iterable
from dataclasses import field
from typing import Final

from trunnion.model.recording import Mark
from trunnion.records import dataclass

Value = float | str | None

#: A clock that gains more than this on the one of the computer that records has jumped, microseconds.
_JUMP: Final = 1_000_000

#: Values that wait for the rest of theirs at most.
_MOST_WAITING: Final = 1_000_000

#: How much faster one clock may go than the other.
_DRIFT: Final = 1e-3


@dataclass(frozen=True, slots=True)
class Reading:
    """One value of a column as a server notified it.

    value           None: the machine does not know it
    source, server  when the machine had it, and when the server did; None: not stated
    overflow        values before it were lost
    """

    column: int
    value: Value
    source: int | None
    server: int | None = None
    overflow: bool = False


@dataclass(slots=True)
class Row:
    """What all columns show at a time; in a gap no values, and no times but that at which it was noticed."""

    values: list[Value]
    source: int | None
    server: int | None
    received: int
    marks: list[Mark] = field(default_factory=list)


#: Orders readings: how often the clock had gone backwards, and the time.
_Key = tuple[int, int]


class RowMaker:
    """Makes rows of the values of some columns."""

    def __init__(self, columns: int) -> None:
        self._columns = columns
        self._begin()

    def _begin(self) -> None:
        self._shown: list[Value] = [None] * self._columns
        self._waiting: list[tuple[_Key, Reading, int]] = []
        self._tails: dict[int, _Key] = {}
        self._limit: _Key | None = None
        self._highest: _Key | None = None
        self._last: _Key | None = None
        self._ahead: float | None = None  # least delay of arrivals, microseconds
        self._seen_at = 0
        self._is_settled = False

    def add(self, batch: Iterable[Reading], received: int, *, more: bool = False) -> list[Row]:
        """Take a message that has arrived, and return the rows that are complete.

        more   the server has not sent everything up to now: the rest follows in the next message
        """
        for reading in batch:
            key = self._key(reading, received)
            self._tails[reading.column] = key
            self._waiting.append((key, reading, received))
            self._highest = key if self._highest is None else max(self._highest, key)
        if more and len(self._waiting) < _MOST_WAITING:
            return []
        rows = self._made(self._limit, flushed=False) if self._limit is not None else []
        self._limit = self._highest
        return rows

    def flush(self) -> list[Row]:
        """Return the rows of everything that has arrived: nothing more is coming."""
        return self._made(self._highest, flushed=True) if self._highest is not None else []

    def broken(self, received: int) -> list[Row]:
        """Return the connection is broken: return what has arrived, and the row of the gap.

        Nothing is known any more.
        """
        rows = self.flush()
        self._begin()
        return [*rows, Row([None] * self._columns, None, None, received, [Mark.GAP])]

    def _key(self, reading: Reading, received: int) -> _Key:
        stamp = _stamp(reading, received)
        before = self._tails.get(reading.column)
        if self._last is not None and (before is None or before <= self._last):
            before = self._last
        if before is None:
            return 0, stamp
        return before[0] + (stamp < before[1]), stamp

    def _made(self, limit: _Key, *, flushed: bool) -> list[Row]:
        ready: list[tuple[_Key, Reading, int]] = []
        later: list[tuple[_Key, Reading, int]] = []
        for each in self._waiting:
            is_ready = each[0] <= limit and (flushed or each[0] != self._highest)
            (ready if is_ready else later).append(each)
        self._waiting = later
        ready.sort(key=lambda each: each[0])
        rows: list[Row] = []
        filled: set[int] = set()
        before: _Key | None = None
        for key, reading, received in ready:
            if key != before or reading.column in filled:
                rows.append(self._row(key, reading, received))
                filled, before = set(), key
            self._shown[reading.column] = rows[-1].values[reading.column] = reading.value
            filled.add(reading.column)
            if reading.overflow and Mark.LOST not in rows[-1].marks:
                rows[-1].marks.append(Mark.LOST)
        self._is_settled = self._is_settled or bool(rows)
        return rows

    def _row(self, key: _Key, reading: Reading, received: int) -> Row:
        row = Row(list(self._shown), reading.source, reading.server, received)
        if self._last is not None and key[1] < self._last[1]:
            row.marks.append(Mark.BACK)
            self._ahead = None
        delay = float(received - key[1])
        if self._is_settled:  # values of before the connection are as old as they are
            least = delay if self._ahead is None else self._ahead + _DRIFT * (received - self._seen_at)
            if delay < least - _JUMP:
                row.marks.append(Mark.JUMP)
            self._ahead, self._seen_at = min(delay, least), received
        self._last = key
        return row


def _stamp(reading: Reading, received: int) -> int:
    return next(stamp for stamp in (reading.source, reading.server, received) if stamp is not None)
