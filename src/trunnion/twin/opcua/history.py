"""The history of some values, for clients that read what was: the last hundred thousand changes of each."""

from datetime import UTC, datetime, timedelta
from typing import Any, Final

import numpy as np
from asyncua import ua
from asyncua.server.history import HistoryStorageInterface
from numpy.typing import NDArray

from trunnion.arrays import Ints
from trunnion.twin.opcua.values import PublishedValue, published

#: Values that are kept of a node, and values in one answer.
KEPT: Final = 100_000
_MOST_IN_ANSWER: Final = 10_000

#: Characters of texts in one answer: with all of them Chinese it is still one message.
_MOST_CHARACTERS: Final = 1_000_000

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)

#: What values of a type are kept as; of others they are kept as they are.
_KEPT_AS: Final = {ua.VariantType.Double: np.float64, ua.VariantType.Int32: np.int64, ua.VariantType.UInt32: np.int64}


class ValueHistory:
    """The last values of a node; older ones are forgotten. Times are microseconds since 1970, ascending."""

    def __init__(self, kept: int = KEPT, kind: ua.VariantType = ua.VariantType.Double) -> None:
        self._kind = kind
        self._times, self._values = np.zeros(kept, np.int64), np.zeros(kept, _KEPT_AS.get(kind, np.object_))
        self._kept, self._count = kept, 0

    def add(self, time: int, value: Any) -> None:
        """Keep a value, which is later than all others, and which nobody changes any more."""
        place = self._count % self._kept
        self._times[place], self._values[place] = time, value
        self._count += 1

    def told(self, value: Any, moment: datetime) -> PublishedValue:
        """Return a value of it as clients get it: of its own type."""
        return published(value, self._kind, moment)

    def in_one_answer(self, values: NDArray[Any]) -> int:
        """How many of some values of it go into one answer, from the first on."""
        most = values[:_MOST_IN_ANSWER]
        if most.dtype != np.object_:
            return len(most)
        sizes = np.cumsum([sum(map(len, texts)) for texts in most.tolist()])
        return max(int(np.searchsorted(sizes, _MOST_CHARACTERS, "right")), 1)

    def between(self, first: int, last: int) -> tuple[Ints, NDArray[Any]]:
        """Return times and values from ``first`` to ``last``, both of them included, in order."""
        if self._count <= self._kept:
            times, values = self._times[: self._count], self._values[: self._count]
        else:
            at = self._count % self._kept
            times, values = np.roll(self._times, -at), np.roll(self._values, -at)
        begin, end = np.searchsorted(times, first, "left"), np.searchsorted(times, last, "right")
        return times[begin:end], values[begin:end]


class TwinHistory(HistoryStorageInterface):
    """The histories of nodes, as asyncua asks for them."""

    def __init__(self) -> None:
        super().__init__(_MOST_IN_ANSWER)
        self.of_node: dict[ua.NodeId, ValueHistory] = {}

    async def init(self) -> None:
        """Nothing is to be opened."""

    async def stop(self) -> None:
        """Nothing is to be closed."""

    async def read_node_history(
        self, node_id: ua.NodeId, start: datetime | None, end: datetime | None, nb_values: int
    ) -> tuple[list[ua.DataValue], datetime | None]:
        """Values between two times; without one of them from the other on, backwards where the start is missing.

        The second result is the time at which the next answer goes on; None: these are all.
        """
        history = self.of_node.get(node_id)
        if history is None:
            raise ua.uaerrors.BadHistoryOperationUnsupported
        first, last = _microseconds(start), _microseconds(end)
        backwards = first is None or (last is not None and first > last)
        low, high = sorted((first or 0, last if last is not None else 2**62)) if last or first else (0, 2**62)
        times, values = history.between(low, high)
        if backwards:
            times, values = times[::-1], values[::-1]
        most = history.in_one_answer(values[:nb_values] if nb_values > 0 else values)
        more = _moment(int(times[most])) if len(times) > most and most != nb_values else None
        found = zip(times[:most].tolist(), values[:most].tolist(), strict=True)
        return [history.told(value, _moment(time)) for time, value in found], more

    async def new_historized_node(self, node_id: ua.NodeId, period: timedelta | None, count: int = 0) -> None:
        """Histories are made with the address space, not while it is served."""
        raise ua.uaerrors.BadHistoryOperationUnsupported

    async def save_node_value(self, node_id: ua.NodeId, datavalue: ua.DataValue) -> None:
        """Values come from the publisher."""
        raise ua.uaerrors.BadHistoryOperationUnsupported

    async def new_historized_event(
        self, source_id: ua.NodeId, evtypes: list[Any], period: timedelta | None, count: int = 0
    ) -> None:
        """Events have no history."""
        raise ua.uaerrors.BadHistoryOperationUnsupported

    async def save_event(self, event: Any) -> None:
        """Events have no history."""
        raise ua.uaerrors.BadHistoryOperationUnsupported

    async def read_event_history(
        self, source_id: ua.NodeId, start: datetime | None, end: datetime | None, nb_values: int, evfilter: Any
    ) -> tuple[list[Any], datetime | None]:
        """Events have no history."""
        raise ua.uaerrors.BadHistoryOperationUnsupported


def _microseconds(moment: datetime | None) -> int | None:
    """Microseconds since 1970; None where a client leaves the time open, which it does with the year 1601."""
    if moment is None:
        return None
    aware = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    return None if aware.year <= 1601 else (aware - _EPOCH) // timedelta(microseconds=1)


def _moment(microseconds: int) -> datetime:
    return _EPOCH + timedelta(microseconds=microseconds)
