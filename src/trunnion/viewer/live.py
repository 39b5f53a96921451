"""A machine that moves, for the page that shows it: its newest pose to everybody who looks, as a stream of events.

In:     a ``LiveSource``, which tells poses as they come.
Out:    server-sent events; each is a pose as JSON.
Units:  mm and degrees as the machine shows them.
"""

import asyncio
import json
from collections.abc import AsyncGenerator, AsyncIterator, Sequence
from typing import Final, Protocol

from trunnion.records import dataclass

#: Seconds between two poses that a page is sent, and between two signs of life where nothing moves.
_PERIOD: Final = 0.04
_SIGN_OF_LIFE: Final = 10.0


@dataclass(frozen=True, slots=True)
class LivePose:
    """Where a machine is.

    values  of the five axes, machine order
    line    of the program that runs; 0: not told
    file    which of the program's files that is in
    """

    values: tuple[float, ...]
    line: int = 0
    file: int = 0


class LiveSource(Protocol):
    """A machine that is listened to."""

    def poses(self) -> AsyncIterator[LivePose | None]:
        """Its poses without end; None: the connection is broken."""


class LiveView:
    """The newest pose of a machine, for all pages that show it."""

    def __init__(self, source: LiveSource) -> None:
        self._source = source
        self._newest = _event(None)
        self._changed = asyncio.Condition()
        self._count = 0

    async def listen(self) -> None:
        """Follow the machine until cancelled."""
        async for pose in self._source.poses():
            async with self._changed:
                self._newest = _event(pose)
                self._count += 1
                self._changed.notify_all()

    async def events(self) -> AsyncGenerator[bytes, None]:
        """Yield the newest pose, and each time that it has changed; those that come too quickly are left out."""
        sent = -1
        while True:
            if sent == self._count:
                try:
                    async with asyncio.timeout(_SIGN_OF_LIFE), self._changed:
                        await self._changed.wait()
                except TimeoutError:
                    yield b": nothing has changed\n\n"
                    continue
            sent = self._count
            yield self._newest
            await asyncio.sleep(_PERIOD)


def _event(pose: LivePose | None) -> bytes:
    told: dict[str, object] = {"values": None}
    if pose is not None:
        told = {"values": _plain(pose.values), "line": pose.line, "file": pose.file}
    return f"data: {json.dumps(told, allow_nan=False)}\n\n".encode()


def _plain(values: Sequence[float]) -> list[float]:
    return [float(value) for value in values]
