"""Alarms and messages of the machine as events of OPC 40502."""

from datetime import datetime
from typing import Any, Final

from asyncua import ua

from trunnion.twin.nodesets import CNC
from trunnion.twin.opcua.cnc import event_sources
from trunnion.twin.opcua.space import MESSAGE_TYPE, Space

_ALARM_TYPE: Final = 1006

#: Severities of 1 to 1000 (OPC 10000-5, 6.4.2).
_ALARM_SEVERITY: Final = 800
_MESSAGE_SEVERITY: Final = 100


class Events:
    """Tells alarms and messages at the server, the interface and the channel."""

    def __init__(self, space: Space) -> None:
        self._space = space
        self._alarms: list[Any] = []
        self._messages: list[Any] = []

    async def prepare(self) -> None:
        """Make the events of the types, which are then filled in and sent."""
        index = self._space.index(CNC)
        for node in event_sources(self._space):
            for number, into in ((_ALARM_TYPE, self._alarms), (MESSAGE_TYPE, self._messages)):
                kind = self._space.server.get_node(ua.NodeId(number, index))
                into.append(await self._space.server.get_event_generator(kind, node))

    async def message(self, text: str, stamp: datetime) -> None:
        """Tell a message of the program."""
        for generator in self._messages:
            generator.event.Severity = _MESSAGE_SEVERITY
            await generator.trigger(stamp, text)

    async def alarm(self, identifier: str, text: str, stamp: datetime, *, active: bool) -> None:
        """Tell an alarm of the machine, or that it is over."""
        for generator in self._alarms:
            generator.event.Severity = _ALARM_SEVERITY
            generator.event.AlarmIdentifier = identifier
            generator.event.Retain = active
            generator.event.ActiveState = ua.LocalizedText("Active" if active else "Inactive", "en")
            setattr(generator.event, "ActiveState/Id", active)
            await generator.trigger(stamp, text)
