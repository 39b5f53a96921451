"""Puts values into the variables that show them, and so to everybody who has subscribed to these."""

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from typing import Any, Final

from asyncua import ua
from asyncua.server.address_space import AttributeValue

from trunnion.records import dataclass
from trunnion.twin.opcua.columns import Columns
from trunnion.twin.opcua.history import TwinHistory, ValueHistory
from trunnion.twin.opcua.space import Space
from trunnion.twin.opcua.values import PublishedValue, published

#: A position of an axis that is not known before the program has stated it.
_UNKNOWN: Final = ua.StatusCode(ua.StatusCodes.BadWaitingForInitialData)

_NOTHING: Final = object()

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)


@dataclass(slots=True)
class _Target:
    """The variables of a name and a type, and what they showed last."""

    kind: ua.VariantType
    variables: list[AttributeValue]
    histories: list[ValueHistory]
    last: Any = _NOTHING

    def is_watched(self) -> bool:
        """Whether anybody needs each of its values."""
        return bool(self.histories) or any(variable.datachange_callbacks for variable in self.variables)

    async def show(self, value: Any, stamp: datetime, microseconds: int) -> None:
        made: PublishedValue = published(value, self.kind, stamp, _UNKNOWN if value is None else None)
        self.last = value
        for variable in self.variables:
            variable.value = made
            for handle, notify in variable.datachange_callbacks.items():
                await notify(handle, made)
        if value is not None:
            for history in self.histories:
                history.add(microseconds, value)


class Publisher:
    """Publishes the values of a space; a value that is what it was before is not published again."""

    def __init__(self, space: Space, history: TwinHistory) -> None:
        nodes = space.server.iserver.aspace
        self._targets: dict[str, list[_Target]] = {}
        for (key, kind), shown in space.shown.items():
            variables = [nodes[node].attributes[ua.AttributeIds.Value] for node in shown.nodes]
            histories = [history.of_node.setdefault(node, ValueHistory(kind=kind)) for node in shown.historized]
            self._targets.setdefault(key, []).append(_Target(kind, variables, histories))

    async def show(self, columns: Columns, stamps: Sequence[datetime], microseconds: Sequence[int]) -> None:
        """Publish the values of consecutive times; of variables that nobody watches only the last ones."""
        last = len(stamps) - 1
        targets = [
            (column, target, target.is_watched())
            for key, column in columns.items()
            for target in self._targets.get(key, ())
        ]
        for k, stamp in enumerate(stamps):
            for column, target, watched in targets:
                value = column[k]
                if value != target.last and (watched or k == last):
                    await target.show(value, stamp, microseconds[k])

    async def put(self, key: str, value: Any, stamp: datetime) -> None:
        """Publish one value."""
        for target in self._targets.get(key, ()):
            if value != target.last:
                await target.show(value, stamp, (stamp - _EPOCH) // timedelta(microseconds=1))
