"""A twin's OPC UA server as one of those whom it tells what the machine shows."""

from datetime import UTC, datetime, timedelta
from typing import Final

from trunnion.twin.opcua.columns import columns_of
from trunnion.twin.opcua.publisher import Publisher
from trunnion.twin.opcua.server import TwinServer
from trunnion.twin.opcua.states import states_of
from trunnion.twin.playback import Playback
from trunnion.twin.snapshots import Snapshots, TwinProgram

#: A queue as full as this makes the program wait.
_FULL: Final = 0.5


class OpcUaOutlet:
    """Tells the clients of a server."""

    def __init__(self, program: TwinProgram, server: TwinServer, publisher: Publisher, begun: float) -> None:
        self._program, self._server, self._publisher = program, server, publisher
        self._begun = begun

    async def show(self, snapshots: Snapshots, stamps: list[datetime], microseconds: list[int]) -> None:
        """Publish what the machine shows at some times."""
        await self._publisher.show(columns_of(self._program, snapshots), stamps, microseconds)

    async def changed(self, playback: Playback, wall: float) -> None:
        """Publish what the program does now."""
        stamp = datetime.fromtimestamp(0, UTC) + timedelta(seconds=wall)
        for key, value in states_of(playback, self._server.space, wall, self._begun).items():
            await self._publisher.put(key, value, stamp)

    async def message(self, text: str, stamp: datetime) -> None:
        """Send a message of the program as an event."""
        await self._server.events.message(text, stamp)

    async def alarm(self, identifier: str, text: str, stamp: datetime) -> None:
        """Send an alarm of the machine as an event."""
        await self._server.events.alarm(identifier, text, stamp, active=True)

    async def alarm_over(self, identifier: str, text: str, stamp: datetime) -> None:
        """Send the end of an alarm as an event."""
        await self._server.events.alarm(identifier, text, stamp, active=False)

    def lagging(self) -> dict[object, int]:
        """Subscriptions whose queues are half full, and the messages that each has sent."""
        return self._server.subscriptions.lagging(_FULL)
