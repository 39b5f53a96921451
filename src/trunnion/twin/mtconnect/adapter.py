"""The adapter that an MTConnect agent connects to: lines of SHDR text, one for each time at which something changed.

A line is ``TIME|KEY|VALUE|KEY|VALUE…``; conditions and messages have lines of their own. An agent that asks ``* PING``
is answered ``* PONG`` with the milliseconds within which the next one is expected, and one that connects is told all
values first.
"""

import asyncio
import socket
from collections.abc import Mapping
from contextlib import suppress
from datetime import UTC, datetime
from typing import Final

from trunnion.twin.mtconnect.device import device_name
from trunnion.twin.mtconnect.observations import UNAVAILABLE, Condition, Observations, stamp_text
from trunnion.twin.mtconnect.shdr import shdr_line
from trunnion.twin.snapshots import TwinProgram

#: Milliseconds between two questions of an agent.
HEARTBEAT: Final = 10_000

_MOST_AGENTS: Final = 16

#: Bytes of a line of an agent, and those that it has not read: of the first the program waits, with more it is dropped.
_LONGEST_LINE: Final = 1024
_WAITED_FOR: Final = 256 * 1024
_MOST_UNREAD: Final = 8 * 1024 * 1024

#: Seconds in which agents take the last line.
_FAREWELL: Final = 1.0


class _Agent:
    """One agent that is connected."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader, self.writer = reader, writer
        self.written = 0

    @property
    def unread(self) -> int:
        """Bytes that it has not taken yet."""
        return self.writer.transport.get_write_buffer_size()

    def send(self, text: bytes) -> None:
        """Send lines; an agent that reads nothing any more is dropped."""
        if self.unread > _MOST_UNREAD:
            self.writer.transport.abort()
        elif not self.writer.is_closing():
            self.writer.write(text)
            self.written += len(text)


class MTConnectAdapter(Observations):
    """Tells any number of agents what the machine shows."""

    def __init__(self, program: TwinProgram, listening: socket.socket) -> None:
        super().__init__(program)
        self._listening = listening
        self._agents: set[_Agent] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None

    @property
    def address(self) -> str:
        """Host and port."""
        host, port = self._listening.getsockname()[:2]
        return f"{host}:{port}"

    async def begin(self) -> None:
        """Take agents."""
        self._server = await asyncio.start_server(self._serve, sock=self._listening, limit=_LONGEST_LINE)

    async def end(self) -> None:
        """Tell agents that the machine is not there any more, and leave them."""
        if self._server is not None:
            self._server.close()
        self.tell(self.in_order(datetime.now(UTC)), {"avail": UNAVAILABLE})
        for agent in list(self._agents):
            agent.writer.close()
        if self._tasks:
            await asyncio.wait(self._tasks, timeout=_FAREWELL)
        for agent in list(self._agents):  # they do not read
            agent.writer.transport.abort()
        if self._tasks:
            await asyncio.wait(self._tasks)

    # What agents are told

    def tell(self, stamp: datetime, changed: Mapping[str, str]) -> None:
        """Send values that have changed."""
        self._send(_line(stamp, changed))

    def tell_condition(self, stamp: datetime, key: str, condition: Condition) -> None:
        """Send a condition."""
        self._send(shdr_line(stamp_text(stamp), key, *condition))

    def tell_message(self, stamp: datetime, text: str) -> None:
        """Send a message of the program."""
        self._send(shdr_line(stamp_text(stamp), "message", "", text))

    def lagging(self) -> dict[object, int]:
        """Agents that have not taken what was sent, and how much they have taken so far."""
        return {agent: agent.written - agent.unread for agent in self._agents if agent.unread > _WAITED_FOR}

    # Agents

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Take an agent, tell it all values, and answer it until it goes."""
        if len(self._agents) >= _MOST_AGENTS:
            writer.close()
            return
        agent = _Agent(reader, writer)
        task = asyncio.current_task()
        assert task is not None
        self._tasks.add(task)
        self._agents.add(agent)
        try:
            agent.send(self._everything().encode())
            await self._answer(agent)
        except (OSError, ValueError, TimeoutError):  # gone, silent, or a line without end
            pass
        finally:
            self._agents.discard(agent)
            self._tasks.discard(task)
            writer.close()
            with suppress(OSError):
                await writer.wait_closed()

    async def _answer(self, agent: _Agent) -> None:
        """Answer questions; an agent that has asked once must go on asking."""
        patience = None
        while True:
            async with asyncio.timeout(patience):
                asked = await agent.reader.readline()
            if not asked:
                return
            if asked.strip().upper() == b"* PING":
                agent.send(f"* PONG {HEARTBEAT}\n".encode())
                patience = 3.0 * HEARTBEAT / 1000.0

    def _everything(self) -> str:
        now = self.last if self.last.timestamp() else datetime.now(UTC)  # as old as what was told last
        head = f"* shdrVersion: 2.0\n* adapterVersion: 2.0\n* device: {device_name(self.program.machine)}\n"
        conditions = "".join(shdr_line(stamp_text(now), key, *told) for key, told in self.conditions.items())
        return head + _line(now, self.values) + conditions

    def _send(self, text: str) -> None:
        data = text.encode()
        for agent in self._agents:
            agent.send(data)


def _line(stamp: datetime, values: Mapping[str, str]) -> str:
    return shdr_line(stamp_text(stamp), *(part for pair in values.items() for part in pair))
