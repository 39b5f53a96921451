"""Records a machine into a file until it is ended.

In:     a ``MachineFeed`` and a place.
Out:    the file, whole however it ends.
"""

import asyncio
import time
from collections.abc import Callable

from trunnion.files import OutputPlace
from trunnion.model.recording import Mark
from trunnion.records import dataclass
from trunnion.twin.recording.feed import MachineFeed
from trunnion.twin.recording.files import RecordingWriter


@dataclass(frozen=True, slots=True)
class RecordingSummary:
    """What was recorded: rows, gaps among them, and the columns."""

    rows: int
    gaps: int
    names: tuple[str, ...]


def record(
    feed: MachineFeed, place: OutputPlace, seconds: float | None, ready: Callable[[tuple[str, ...]], None]
) -> RecordingSummary:
    """Record until the time is over, or until Ctrl-C, which is how a recording is meant to end.

    feed     the machine
    place    the file
    seconds  how long; None: until Ctrl-C
    ready    is called with the names of the columns when recording begins

    Raises ``InputError`` if the machine cannot be connected to, or the file cannot be written.
    """
    recording = _Recording(feed, place, seconds, ready)
    try:
        asyncio.run(recording.run())
    except KeyboardInterrupt as end:
        if type(end) is not KeyboardInterrupt or recording.writer is None:  # another signal, or nothing recorded yet
            raise
    finally:
        if recording.writer is not None:
            recording.writer.close()
    assert recording.writer is not None
    return RecordingSummary(recording.writer.rows, recording.gaps, feed.names)


class _Recording:
    def __init__(
        self, feed: MachineFeed, place: OutputPlace, seconds: float | None, ready: Callable[[tuple[str, ...]], None]
    ) -> None:
        self._feed, self._place, self._seconds, self._ready = feed, place, seconds, ready
        self.writer: RecordingWriter | None = None
        self.gaps = 0

    async def run(self) -> None:
        """Record."""
        await self._feed.open()
        try:
            self.writer = RecordingWriter(self._place, self._feed.names, self._feed.texts)
            self._ready(self._feed.names)
            await self._go_on(self.writer)
        finally:
            await self._feed.close()

    async def _go_on(self, writer: RecordingWriter) -> None:
        until = None if self._seconds is None else time.monotonic() + self._seconds
        rows = self._feed.rows()
        try:
            while until is None or time.monotonic() < until:
                left = None if until is None else until - time.monotonic()
                try:
                    async with asyncio.timeout(left):
                        found = await anext(rows)
                except TimeoutError:
                    break
                self.gaps += sum(Mark.GAP in row.marks for row in found)
                writer.add(found)
        finally:
            await rows.aclose()
            writer.add(self._feed.rest())
