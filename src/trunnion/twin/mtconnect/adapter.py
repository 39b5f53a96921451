"""The adapter that an MTConnect agent connects to: lines of SHDR text, one for each time at which something changed.

A line is ``TIME|KEY|VALUE|KEY|VALUE…``; conditions and messages have lines of their own. An agent that asks ``* PING``
is answered ``* PONG`` with the milliseconds within which the next one is expected, and one that connects is told all
values first.
"""

import asyncio
import math
import socket
from collections.abc import Mapping
from contextlib import suppress
from datetime import UTC, datetime
from typing import Final

from trunnion.twin.mtconnect.device import device_name
from trunnion.twin.mtconnect.shdr import shdr_line
from trunnion.twin.playback import Playback, PlayState
from trunnion.twin.snapshots import Snapshots, TwinProgram, displayed

#: Milliseconds between two questions of an agent.
HEARTBEAT: Final = 10_000

_MOST_AGENTS: Final = 16

#: Bytes of a line of an agent, and those that it has not read: of the first the program waits, with more it is dropped.
_LONGEST_LINE: Final = 1024
_WAITED_FOR: Final = 256 * 1024
_MOST_UNREAD: Final = 8 * 1024 * 1024

#: EXECUTION of MTConnect.
_EXECUTION: Final = {
    PlayState.READY: "READY",
    PlayState.RUNNING: "ACTIVE",
    PlayState.HELD: "FEED_HOLD",
    PlayState.STOPPED: "PROGRAM_STOPPED",
    PlayState.ENDED: "PROGRAM_COMPLETED",
}

#: Seconds in which agents take the last line.
_FAREWELL: Final = 1.0

UNAVAILABLE: Final = "UNAVAILABLE"

#: Level, code, severity, qualifier and text of a condition that is well.
_NORMAL: Final = ("NORMAL", "", "", "", "")


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


class MTConnectAdapter:
    """Tells any number of agents what the machine shows."""

    def __init__(self, program: TwinProgram, listening: socket.socket) -> None:
        self._program, self._listening = program, listening
        self._agents: set[_Agent] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None
        self._values: dict[str, str] = {}
        self._last = datetime.fromtimestamp(0.0, UTC)
        self._conditions: dict[str, tuple[str, ...]] = {"system": _NORMAL}
        for axis in program.machine.axes:
            self._conditions[f"{axis.name}_travel"] = _NORMAL
        fixed = {"avail": "AVAILABLE", "estop": "ARMED", "mode": "AUTOMATIC", "main_program": program.name}
        self._values |= fixed

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
        self._send(_line(self._in_order(datetime.now(UTC)), {"avail": UNAVAILABLE}))
        for agent in list(self._agents):
            agent.writer.close()
        if self._tasks:
            await asyncio.wait(self._tasks, timeout=_FAREWELL)
        for agent in list(self._agents):  # they do not read
            agent.writer.transport.abort()
        if self._tasks:
            await asyncio.wait(self._tasks)

    # What the twin tells

    async def show(self, snapshots: Snapshots, stamps: list[datetime], microseconds: list[int]) -> None:
        """Send what has changed from each time to the next."""
        lines = []
        for k, stamp in enumerate(stamps):
            changed = self._changed(self._values_at(snapshots, k))
            if changed:
                lines.append(_line(self._in_order(stamp), changed))
        self._send("".join(lines))

    async def changed(self, playback: Playback, wall: float) -> None:
        """Send what the program does now."""
        now = {
            "exec": _EXECUTION[playback.state],
            "feed_override": f"{playback.override:g}",
            "part_count": str(playback.completed),
        }
        stamp = datetime.fromtimestamp(wall, UTC)
        if changed := self._changed(now):
            self._send(_line(self._in_order(stamp), changed))

    async def message(self, text: str, stamp: datetime) -> None:
        """Send a message of the program."""
        self._send(shdr_line(_stamp(self._in_order(stamp)), "message", "", text))

    async def alarm(self, identifier: str, text: str, stamp: datetime) -> None:
        """Send an alarm of the machine: a fault of the axis that it names, or of the system."""
        key = self._condition_of(identifier)
        self._condition(stamp, key, ("FAULT", identifier, "", "", text))

    async def alarm_over(self, identifier: str, text: str, stamp: datetime) -> None:
        """Send that a fault is over."""
        self._condition(stamp, self._condition_of(identifier), _NORMAL)

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
            asked = await asyncio.wait_for(agent.reader.readline(), patience)
            if not asked:
                return
            if asked.strip().upper() == b"* PING":
                agent.send(f"* PONG {HEARTBEAT}\n".encode())
                patience = 3.0 * HEARTBEAT / 1000.0

    def _everything(self) -> str:
        now = self._last if self._last.timestamp() else datetime.now(UTC)  # as old as what was told last
        head = f"* shdrVersion: 2.0\n* adapterVersion: 2.0\n* device: {device_name(self._program.machine)}\n"
        conditions = "".join(shdr_line(_stamp(now), key, *told) for key, told in self._conditions.items())
        return head + _line(now, self._values) + conditions

    def _in_order(self, stamp: datetime) -> datetime:
        """Return a time that is not before what was told last."""
        self._last = max(stamp, self._last)
        return self._last

    def _send(self, text: str) -> None:
        if text:
            data = text.encode()
            for agent in self._agents:
                agent.send(data)

    # Values

    def _changed(self, values: Mapping[str, str]) -> dict[str, str]:
        changed = {key: value for key, value in values.items() if self._values.get(key) != value}
        self._values |= changed
        return changed

    def _condition_of(self, identifier: str) -> str:
        """Return the condition of the axis that an alarm names, else that of the system."""
        kind, _, axis = identifier.partition(" ")
        return f"{axis}_{kind}" if f"{axis}_{kind}" in self._conditions else "system"

    def _condition(self, stamp: datetime, key: str, told: tuple[str, ...]) -> None:
        self._conditions[key] = told
        self._send(shdr_line(_stamp(self._in_order(stamp)), key, *told))

    def _values_at(self, snapshots: Snapshots, k: int) -> dict[str, str]:
        block, machine = snapshots.blocks[k], self._program.machine
        rpm = float(snapshots.rpm[k])
        values = {
            "program": block.file,
            "block": block.blocks[1],
            "line": str(block.line),
            "block_number": block.number or UNAVAILABLE,
            "tool": block.tool or UNAVAILABLE,
            "feed": _number(float(snapshots.feed[k])),
            "tip": " ".join(map(_number, snapshots.tip[k].tolist())),
            "S_actual": _number(abs(rpm)),
            "S_commanded": _number(abs(float(snapshots.told_rpm[k]))),
            "S_direction": "CLOCKWISE" if rpm > 0.0 else "COUNTER_CLOCKWISE" if rpm < 0.0 else "NONE",
        }
        if UNAVAILABLE in values["tip"]:
            values["tip"] = UNAVAILABLE
        for column, axis in enumerate(machine.axes):
            values[f"{axis.name}_actual"] = _number(
                float(displayed(machine, column, snapshots.joints[k : k + 1, column])[0])
            )
            values[f"{axis.name}_state"] = "TRAVEL" if snapshots.moving[k, column] else "STOPPED"
        return values


def _line(stamp: datetime, values: Mapping[str, str]) -> str:
    return shdr_line(_stamp(stamp), *(part for pair in values.items() for part in pair))


def _stamp(moment: datetime) -> str:
    return moment.strftime("%Y-%m-%dT%H:%M:%S.%fZ")


def _number(value: float) -> str:
    """Return a number from which the same one is read; what is not known is unavailable."""
    return repr(value + 0.0) if math.isfinite(value) else UNAVAILABLE
