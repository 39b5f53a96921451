"""What a machine shows, row after row, over breaks of the connection.

In:     how to connect, a ``NodeList``, the sampling interval.
Out:    lists of ``Row``s as they become complete, without end.
"""

import asyncio
import time
from collections.abc import AsyncGenerator, Callable
from typing import Final

from trunnion.errors import InputError, Problem, warning
from trunnion.messages import Wording
from trunnion.twin.recording.client import FAILURES, Access, Connection, connect
from trunnion.twin.recording.nodes import NodeList
from trunnion.twin.recording.rows import Row, RowMaker

#: Seconds without values after which the last ones are taken for all of their time.
_PATIENCE: Final = 0.5

#: Seconds between two tries to connect again, at first and at most.
_FIRST_TRY, _LAST_TRY = 0.25, 4.0


class ArrivalClock:
    """The time at which values arrive, microseconds since 1970; nobody who sets the clock of the computer moves it."""

    def __init__(self) -> None:
        self._offset = time.time_ns() - time.monotonic_ns()

    def now(self) -> int:
        """Return the time."""
        return (self._offset + time.monotonic_ns()) // 1000


class MachineFeed:
    """A machine that is listened to.

    Parameters
    ----------
    access
        How to connect.
    nodes
        What is listened to.
    sampling
        Milliseconds between two looks of the server at its variables.
    tell
        Is told when the connection breaks, and when it is there again.

    ``names`` are those of the columns, once it is open; a column that the machine lacks is left out.
    """

    def __init__(
        self, access: Access, nodes: NodeList, sampling: float, tell: Callable[[Problem], None] = lambda _: None
    ) -> None:
        self._access, self._nodes, self._sampling, self._tell = access, nodes, sampling, tell
        self._connection: Connection | None = None
        self._clock = ArrivalClock()
        self._maker = RowMaker(len(nodes.columns))
        self._kept: list[int] = []
        self.names: tuple[str, ...] = ()
        self.texts: frozenset[str] = frozenset()

    async def open(self) -> None:
        """Connect for the first time.

        Raises
        ------
        InputError
            If there is no server, it is not trusted or refuses the connection, or it lacks a variable.
        """
        try:
            self._connection = await connect(self._access, self._nodes, self._sampling)
        except FAILURES as error:
            raise InputError(
                Problem(self._access.address, 0, Wording("TWN220", "cannot_connected", reason=_reason(error)))
            ) from None
        columns = zip(self._connection.names, self._nodes.columns, strict=True)
        there = [(name, column) for name, column in columns if name]
        self.names = tuple(name for name, _ in there)
        self.texts = frozenset(name for name, column in there if column.is_text)
        twice = sorted({name for name in self.names if self.names.count(name) > 1})
        if twice or not there:
            await self.close()
            raise InputError(
                Problem(
                    self._access.address,
                    0,
                    Wording("TWN231", "two_columns_name", twice=twice[0])
                    if twice
                    else Wording("TWN231", "none_variables"),
                )
            )
        self._kept = [k for k, name in enumerate(self._connection.names) if name]

    async def rows(self) -> AsyncGenerator[list[Row], None]:
        """Yield rows as they become complete, and an empty list when nothing comes."""
        maker = self._maker
        while True:
            assert self._connection is not None
            try:
                message = await self._connection.message(_PATIENCE)
            except ConnectionError:
                yield self._only_kept(maker.broken(self._clock.now()))
                await self._connect_again()
                continue
            if message is None:
                yield self._only_kept(maker.flush())
            else:
                yield self._only_kept(maker.add(message.readings, self._clock.now(), more=message.more))

    def rest(self) -> list[Row]:
        """Return the rows of all that has arrived when nobody asks for more."""
        rows = []
        for message in () if self._connection is None else self._connection.waiting():
            rows += self._maker.add(message.readings, self._clock.now(), more=message.more)
        return self._only_kept([*rows, *self._maker.flush()])

    async def close(self) -> None:
        """End the connection."""
        if self._connection is not None:
            await self._connection.close()

    def _only_kept(self, rows: list[Row]) -> list[Row]:
        for row in rows:
            row.values = [row.values[k] for k in self._kept]
        return rows

    async def _connect_again(self) -> None:
        """Try until the machine is there again."""
        assert self._connection is not None
        await self._connection.close()
        self._warn(Wording("TWN240", "connection_broken_trying"))
        delay, told = _FIRST_TRY, ""
        while True:
            try:
                self._connection = await connect(self._access, self._nodes, self._sampling)
            except InputError as error:
                if str(error) != told:
                    told = str(error)
                    self._warn(error.problems[0].wording)
            except FAILURES:
                pass
            else:
                self._warn(Wording("TWN240", "connected_again_gap"))
                return
            await asyncio.sleep(delay)
            delay = min(2.0 * delay, _LAST_TRY)

    def _warn(self, wording: Wording) -> None:
        self._tell(warning(self._access.address, 0, wording))


def _reason(error: BaseException) -> str:
    return getattr(error, "strerror", None) or str(error) or type(error).__name__
