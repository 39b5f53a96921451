"""An agent of MTConnect: answers what the machine is and shows, from the observations that it keeps, by HTTP."""

import asyncio
import socket
from collections.abc import AsyncIterator, Callable, Container, Mapping
from datetime import UTC, datetime
from typing import Final

from trunnion.twin.mtconnect.buffer import KEPT, ObservationBuffer
from trunnion.twin.mtconnect.device import Item, device_model
from trunnion.twin.mtconnect.documents import Documents
from trunnion.twin.mtconnect.observations import UNAVAILABLE, Condition, Observations
from trunnion.twin.mtconnect.paths import selected
from trunnion.twin.mtconnect.request_errors import RequestError, out_of_range
from trunnion.twin.mtconnect.requests import Request, request_of
from trunnion.twin.mtconnect.web import WebServer
from trunnion.twin.snapshots import TwinProgram

#: Items that a device has for assets, of which there are none.
_ASSET_ITEMS: Final[tuple[Item, ...]] = (
    ("asset_changed", "EVENT", "ASSET_CHANGED", {"discrete": "true"}),
    ("asset_removed", "EVENT", "ASSET_REMOVED", {}),
)

#: Share of what is kept by which a reader may be behind before the program waits.
_BEHIND: Final = 0.5


class Stream:
    """Documents for a reader who takes one after the other; ``position``: the number of the next observation."""

    def __init__(self, agent: "MTConnectAgent", request: Request, keys: Container[str]) -> None:
        self._agent, self._request, self._keys = agent, request, keys
        self.position = request.start or agent.buffer.first

    async def documents(self) -> AsyncIterator[bytes]:
        """Yield documents until the reader is gone, or what it has not read is not kept any more."""
        agent, pause = self._agent, (self._request.interval or 0) / 1000.0
        if self._request.kind == "sample":
            agent.streams.add(self)
        try:
            while True:
                if self._request.kind == "current":
                    yield agent.current(self._keys)
                elif self.position < agent.buffer.first:
                    yield agent.error(out_of_range(f"{self.position} is not kept any more"))
                    return
                else:
                    yield await self._sample()
                await asyncio.sleep(pause)
        finally:
            agent.streams.discard(self)

    async def _sample(self) -> bytes:
        """Return the next observations, when there are some or the time of the heartbeat is over."""
        agent, beat = self._agent, asyncio.create_task(asyncio.sleep(self._request.heartbeat / 1000.0))
        try:
            while True:
                arrival, buffer, is_over = agent.arrival, agent.buffer, beat.done()
                start = max(self.position, buffer.first)
                found, self.position = buffer.forward(start, buffer.last, self._request.count, self._keys)
                if found or is_over:
                    return agent.documents.streams(agent.now(), found, self.position)
                await asyncio.wait((beat, arrival), return_when=asyncio.FIRST_COMPLETED)
        finally:
            beat.cancel()


class MTConnectAgent(Observations):
    """Keeps what the machine has shown, and answers requests.

    clock  the wall time, seconds since 1970
    """

    def __init__(
        self, program: TwinProgram, listening: socket.socket, clock: Callable[[], float], kept: int = KEPT
    ) -> None:
        super().__init__(program)
        self._clock, self._web = clock, WebServer(listening, self.respond, self.error)
        self.buffer, self.streams = ObservationBuffer(kept), set[Stream]()
        self.arrival: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._device = device_model(program, _ASSET_ITEMS)
        self._keys = {item.get("name", "") for item in self._device.iter("DataItem")}
        now = self.now()
        self.documents = Documents(self._device, self.buffer, f"http://{self.address}/", now)
        for key in [item.get("name", "") for item in self._device.iter("DataItem")]:
            self.buffer.add(now, key, self.conditions.get(key) or self.values.get(key, UNAVAILABLE))

    @property
    def address(self) -> str:
        """Host and port."""
        return self._web.address

    def now(self) -> datetime:
        """Return the time of a document."""
        return datetime.fromtimestamp(self._clock(), UTC)

    async def begin(self) -> None:
        """Take requests."""
        await self._web.begin()

    async def end(self) -> None:
        """Leave all who read."""
        await self._web.end()

    # What is kept

    def tell(self, stamp: datetime, changed: Mapping[str, str]) -> None:
        """Keep values that have changed."""
        for key, value in changed.items():
            self.buffer.add(stamp, key, value)
        self._arrived()

    def tell_condition(self, stamp: datetime, key: str, condition: Condition) -> None:
        """Keep a condition."""
        self.buffer.add(stamp, key, condition)
        self._arrived()

    def tell_message(self, stamp: datetime, text: str) -> None:
        """Keep a message of the program."""
        self.buffer.add(stamp, "message", text)
        self._arrived()

    def lagging(self) -> dict[object, int]:
        """Streams that are far behind, and how far each has come."""
        most = self.buffer.next - self.buffer.size * _BEHIND
        return {stream: stream.position for stream in self.streams if stream.position < most}

    def _arrived(self) -> None:
        arrival, self.arrival = self.arrival, asyncio.get_running_loop().create_future()
        arrival.set_result(None)

    # Answers

    def respond(self, target: str) -> bytes | AsyncIterator[bytes]:
        """Return the document that answers a request, or one after the other.

        Raises ``RequestError`` if there is none.
        """
        names = (self._device.get("name", ""), self._device.get("uuid", ""))
        request = request_of(target, names, self.buffer)
        if request.kind == "probe":
            return self.documents.devices(self.now())
        if request.kind == "assets":
            return self.documents.assets(self.now())
        keys = self._keys
        if request.path is not None:
            keys = {item.get("name", "") for item in selected(self._device, request.path)}
        if request.interval is not None:
            return Stream(self, request, keys).documents()
        if request.kind == "current":
            return self.current(keys, request.at)
        first, last = request.start, self.buffer.last
        if request.count < 0:
            found, following = self.buffer.backward(min(first or last, last), -request.count, keys)
        else:
            found, following = self.buffer.forward(first or self.buffer.first, request.to or last, request.count, keys)
        return self.documents.streams(self.now(), found, following)

    def current(self, keys: Container[str], at: int | None = None) -> bytes:
        """Return what items show, or showed when a number was that of the last observation."""
        found = sorted(each for each in self.buffer.latest(at) if each.key in keys)
        return self.documents.streams(self.now(), found, self.buffer.next)

    def error(self, refusal: RequestError) -> bytes:
        """Return the document of a refusal."""
        return self.documents.error(self.now(), refusal)
