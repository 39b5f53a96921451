"""Subscriptions that lose nothing which their queues hold, and that many clients can have at once.

asyncua notifies one item at a time and encodes each value for each client. Here a value is queued as it is, and a
notification is put together from bytes that all clients share. What a client asks for is bounded: how often, how many
items, how much waits for it.
"""

import secrets
import struct
from collections import deque
from collections.abc import Callable
from math import ceil, isfinite
from typing import Any, Final

from asyncua import ua
from asyncua.common.utils import ServiceError
from asyncua.server.address_space import AddressSpace
from asyncua.server.internal_server import InternalServer
from asyncua.server.internal_subscription import InternalSubscription
from asyncua.server.monitored_item_service import MonitoredItemData, MonitoredItemService
from asyncua.server.subscription_service import SubscriptionService

from trunnion.twin.opcua.values import encoded, overflowed

#: Shortest and longest publishing interval, ms, and how long a subscription lives without its client, ms.
SHORTEST_INTERVAL: Final = 10.0
_LONGEST_INTERVAL: Final = 3_600_000.0
_LONGEST_LIFE: Final = 600_000.0

#: Monitored items of one subscription and of all, and notifications that wait in one subscription.
_MOST_ITEMS: Final = 5_000
_MOST_ITEMS_OF_ALL: Final = 20_000
_MOST_WAITING: Final = 200_000

#: Notifications in one message; the next ones follow in the next interval.
_MOST_IN_MESSAGE: Final = 10_000

_UINT32: Final = struct.Struct("<I")
_INT32: Final = struct.Struct("<i")
_NO_DIAGNOSTICS: Final = _INT32.pack(-1)
_ANY_CHANGE: Final = ua.DataChangeTrigger.StatusValue

#: A value that waits, the client's handle of its item, and whether values before it were lost.
_Waiting = tuple[int, ua.DataValue, bool]


class PublishedItems(MonitoredItemService):
    """The monitored items of a subscription."""

    def __init__(self, subscription: "PublishedSubscription", space: AddressSpace) -> None:
        super().__init__(subscription, space)
        self._space = space

    def __len__(self) -> int:
        return len(self._monitored_items)

    async def _create_data_change_monitored_item(
        self, params: ua.MonitoredItemCreateRequest
    ) -> ua.MonitoredItemCreateResult:
        refused = ua.MonitoredItemCreateResult()
        if _is_empty(params.RequestedParameters.Filter):
            params.RequestedParameters.Filter = None
        asked = params.RequestedParameters.Filter
        if len(self) >= _MOST_ITEMS or self.isub.items_of_all() >= _MOST_ITEMS_OF_ALL:
            refused.StatusCode = ua.StatusCode(ua.StatusCodes.BadTooManyMonitoredItems)
            return refused
        if asked is not None and not isinstance(asked, ua.DataChangeFilter):
            refused.StatusCode = ua.StatusCode(ua.StatusCodes.BadMonitoredItemFilterUnsupported)
            return refused
        return await super()._create_data_change_monitored_item(params)

    async def datachange_callback(self, handle: int, value: ua.DataValue, error: ua.StatusCode | None = None) -> None:
        """Queue a value that was written."""
        if error:
            await self.trigger_statuschange(error)
            return
        item = self._monitored_items[self._monitored_datachange[handle]]
        if item.mode != ua.MonitoringMode.Disabled and _has_changed(item, value):
            self.isub.queue_value(item, value)


def _is_empty(filter_asked: Any) -> bool:
    """Whether a client asks for no filter by an empty one."""
    return isinstance(filter_asked, ua.ExtensionObject) and filter_asked.TypeId == ua.NodeId()


def _has_changed(item: MonitoredItemData, value: ua.DataValue) -> bool:
    """Whether a value differs from the one before as the filter of its item wants; it is the one before from now on."""
    before, asked = item.mvalue.current_dvalue, item.filter
    item.mvalue.current_dvalue = value
    if before is None or before is value:
        return before is None
    trigger = _ANY_CHANGE if asked is None else asked.Trigger
    if before.StatusCode != value.StatusCode:
        return True
    if trigger == ua.DataChangeTrigger.Status:
        return False
    if before.Value == value.Value:
        stamps_count = trigger == ua.DataChangeTrigger.StatusValueTimestamp
        return bool(stamps_count and before.SourceTimestamp != value.SourceTimestamp)
    if asked is None or asked.DeadbandType != ua.DeadbandType.Absolute:
        return True
    new, old = value.Value.Value if value.Value else None, before.Value.Value if before.Value else None
    if isinstance(new, float) and isinstance(old, float) and abs(new - old) <= asked.DeadbandValue:
        item.mvalue.current_dvalue = before  # the band is about the value that was told last
        return False
    return True


class PublishedSubscription(InternalSubscription):
    """A subscription whose values wait as they are, each item's in its own queue.

    fullness   how full its fullest queue is, 0 to 1; queues of one value are always written over, and do not count
    published  messages that it has sent
    """

    def __init__(self, *args: Any, items_of_all: Callable[[], int], **named: Any) -> None:
        super().__init__(*args, **named)
        self.monitored_item_srv: PublishedItems = PublishedItems(self, args[1])
        self.items_of_all = items_of_all
        self.most_in_message = _MOST_IN_MESSAGE
        self._waiting = 0
        self.fullness = 0.0
        self.published = 0

    def queue_value(self, item: MonitoredItemData, value: ua.DataValue) -> None:
        """Let a value wait for the next message; where its queue is full, the oldest is lost, as the next one tells."""
        key = item.monitored_item_id
        queues: dict[int | None, deque[_Waiting]] = self._triggered_datachanges
        queue = queues.get(key)
        if queue is None:
            queue = queues[key] = deque()
        if len(queue) >= max(item.queue_size, 1) or self._waiting >= _MOST_WAITING:
            if queue:
                queue.popleft()
                self._waiting -= 1
            if item.queue_size > 1 and queue:
                handle, oldest, _ = queue[0]
                queue[0] = handle, oldest, True
        queue.append((item.client_handle or 0, value, False))
        self._waiting += 1
        if item.queue_size > 1:
            self.fullness = max(self.fullness, len(queue) / item.queue_size, self._waiting / _MOST_WAITING)

    def _pop_triggered_datachanges(self, result: ua.PublishResult) -> None:
        """Put what waits into a message, the oldest of each item first, as far as it fits."""
        queues: dict[int | None, deque[_Waiting]] = self._triggered_datachanges
        if not queues:
            return
        pieces: list[bytes] = []
        room = self.most_in_message
        for key in list(queues):
            queue = queues[key]
            while queue and room:
                handle, value, lost = queue.popleft()
                pieces += (_UINT32.pack(handle), overflowed(value) if lost else encoded(value))
                room -= 1
            if not queue:
                del queues[key]
            if not room:
                break
        count = self.most_in_message - room
        self._waiting -= count
        self.fullness = self._waiting / _MOST_WAITING if queues else 0.0
        self.published += 1
        body = b"".join((_INT32.pack(count), *pieces, _NO_DIAGNOSTICS))
        kind = ua.NodeId(ua.ObjectIds.DataChangeNotification_Encoding_DefaultBinary)
        result.NotificationMessage.NotificationData.append(ua.ExtensionObject(kind, body))

    async def stop(self) -> None:
        """End it, and forget what waits."""
        await super().stop()
        self._triggered_datachanges.clear()
        self._waiting = 0


class TwinSubscriptions(SubscriptionService):
    """All subscriptions of a twin's server."""

    def __init__(self, space: AddressSpace, server: InternalServer) -> None:
        super().__init__(space, iserver=server)
        self._server = server

    async def create_subscription(
        self,
        params: ua.CreateSubscriptionParameters,
        callback: Callable[..., Any],
        session_id: ua.NodeId,
        request_callback: Callable[..., Any] | None = None,
    ) -> ua.CreateSubscriptionResult:
        """Make a subscription, with what was asked for brought within bounds; its number cannot be guessed."""
        if len(self.subscriptions) >= self._server.max_subscriptions:
            raise ServiceError(ua.StatusCodes.BadTooManySubscriptions)
        asked = params.RequestedPublishingInterval
        interval = min(max(asked, SHORTEST_INTERVAL), _LONGEST_INTERVAL) if isfinite(asked) else SHORTEST_INTERVAL
        result = ua.CreateSubscriptionResult()
        result.RevisedPublishingInterval = interval
        most = max(ceil(_LONGEST_LIFE / interval), 3)
        result.RevisedMaxKeepAliveCount = min(max(params.RequestedMaxKeepAliveCount, 1), max(most // 3, 1))
        # The client has at least three of its keep-alives to come back.
        lifetime = min(params.RequestedLifetimeCount or most, most)
        result.RevisedLifetimeCount = max(lifetime, 3 * result.RevisedMaxKeepAliveCount)
        result.SubscriptionId = secrets.randbelow(2**31 - 1) + 1
        subscription = PublishedSubscription(
            result,
            self.aspace,
            callback,
            session_id,
            items_of_all=self._items,
            request_callback=request_callback,
            delete_callback=lambda: self.subscriptions.pop(result.SubscriptionId, None),
            no_acks_limit=self._server.max_unacked_messages_per_subscription,
            max_queue_size=self._server.max_monitored_item_queue_size,
            publishing_enabled=params.PublishingEnabled,
        )
        if params.MaxNotificationsPerPublish:
            subscription.most_in_message = min(params.MaxNotificationsPerPublish, _MOST_IN_MESSAGE)
        await subscription.start()
        self.subscriptions[result.SubscriptionId] = subscription
        return result

    def _items(self) -> int:
        return sum(len(each.monitored_item_srv) for each in self.subscriptions.values())

    def lagging(self, fullness: float) -> dict[object, int]:
        """Subscriptions whose queues are fuller than that, and how many messages each has sent."""
        found: dict[object, int] = {}
        for number, each in self.subscriptions.items():
            if isinstance(each, PublishedSubscription) and each.fullness > fullness:
                found[number] = each.published
        return found
