"""A connection to the OPC UA server of a machine, and what it subscribes to.

In:     the address, how to connect, and a ``NodeList``.
Out:    messages of ``Reading``s, and when the connection breaks.
"""

import asyncio
import hashlib
import logging
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from asyncua import Client, ua
from asyncua.client.ua_client import UaClientState
from asyncua.crypto import security_policies
from asyncua.crypto.uacrypto import CertProperties

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.twin.opcua.certificates import client_certificate
from trunnion.twin.recording.nodes import Column, NodeList, VariableAddress
from trunnion.twin.recording.rows import Reading, Value

#: Milliseconds between two messages of the server, and messages without values in a row that it leaves out at most.
PUBLISHING: Final = 100.0
_KEEP_ALIVE: Final = 10

#: Seconds without any message after which the connection is taken for broken.
_SILENCE: Final = 5.0

#: Values of a variable that the server keeps until they are fetched.
_QUEUE: Final = 5000

#: Messages that wait until they are written.
_MOST_MESSAGES: Final = 64

#: Values come before this one no more (OPC 10000-4, 7.39).
_OVERFLOW: Final = 0x00000480

#: Policies that both sign and encrypt, the strongest first.
_POLICIES: Final = (
    security_policies.SecurityPolicyAes256Sha256RsaPss,
    security_policies.SecurityPolicyAes128Sha256RsaOaep,
    security_policies.SecurityPolicyBasic256Sha256,
)

#: What the library raises when a server is not there, or does not do what it is asked for.
FAILURES: Final = (OSError, TimeoutError, asyncio.TimeoutError, ua.UaError)

logging.getLogger("asyncua").addHandler(logging.NullHandler())

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)


@dataclass(frozen=True, slots=True)
class Access:
    """How to connect.

    address           opc.tcp://HOST:PORT/…
    folder            where the certificate of the client is kept; None: the channel is not encrypted
    fingerprint       SHA-1 of the certificate by which the server is trusted
    user, password    empty: anonymous
    """

    address: str
    folder: Path | None = None
    fingerprint: str = ""
    user: str = ""
    password: str = ""


@dataclass(frozen=True, slots=True)
class Message:
    """Values that have arrived together; ``more``: the server has not sent all of them up to now."""

    readings: tuple[Reading, ...]
    more: bool


class Connection:
    """A connection whose variables are subscribed to; ``names`` are those of its columns, empty where one is absent."""

    def __init__(self, client: Any, columns: Sequence[Column]) -> None:
        self._client, self._columns = client, columns
        self._messages: asyncio.Queue[Message] = asyncio.Queue(_MOST_MESSAGES)
        self._heard = time.monotonic()
        self._ended = False
        self.names: tuple[str, ...] = ()

    async def subscribe(self, sampling: float) -> None:
        """Find the variables and subscribe to them; ``sampling`` in milliseconds.

        Raises
        ------
        InputError
            With each variable that is not there.
        """
        found = [await self._found(column) for column in self._columns]
        problems = [each for each in found if isinstance(each, Problem)]
        if problems:
            raise InputError(problems)
        self.names = tuple([await self._name(column, node) for column, node in zip(self._columns, found, strict=True)])
        parameters = ua.CreateSubscriptionParameters()
        parameters.RequestedPublishingInterval = PUBLISHING
        parameters.RequestedLifetimeCount = 60 * _KEEP_ALIVE
        parameters.RequestedMaxKeepAliveCount = _KEEP_ALIVE
        parameters.MaxNotificationsPerPublish = 10_000
        parameters.PublishingEnabled = True
        session = self._client.uaclient.session
        made = await session.create_subscription(parameters, self._published)
        request = ua.CreateMonitoredItemsParameters()
        request.SubscriptionId = made.SubscriptionId
        request.TimestampsToReturn = ua.TimestampsToReturn.Both
        request.ItemsToCreate = [_item(k, node.nodeid, sampling) for k, node in enumerate(found) if node is not None]
        answers = await session.create_monitored_items(request)
        places = [column.place for column, node in zip(self._columns, found, strict=True) if node is not None]
        refused = [
            Problem(str(place), 0, Wording("TWN230", "cannot_subscribed", statuscode=answer.StatusCode.name))
            for place, answer in zip(places, answers, strict=True)
            if not answer.StatusCode.is_good()
        ]
        if refused:
            raise InputError(refused)

    async def message(self, patience: float) -> Message | None:
        """Return the next message; None if none comes within some seconds.

        Raises
        ------
        ConnectionError
            If the connection is broken.
        """
        with suppress(TimeoutError):
            async with asyncio.timeout(patience):  # Python 3.11: wait_for loses a cancellation that meets a message
                return await self._messages.get()
        silent = time.monotonic() - self._heard > _SILENCE
        if self._ended or silent or self._client.state is not UaClientState.CONNECTED:
            raise ConnectionError
        return None

    def waiting(self) -> Iterator[Message]:
        """Messages that have arrived and that nobody has asked for."""
        while not self._messages.empty():
            yield self._messages.get_nowait()

    async def close(self) -> None:
        """End the connection; one that is broken is dropped."""
        with suppress(Exception):
            if self._client.state is UaClientState.CONNECTED:
                async with asyncio.timeout(2.0):
                    await self._client.disconnect()
                return
        with suppress(Exception):
            async with asyncio.timeout(1.0):
                await self._client.close_session()
        with suppress(Exception):
            self._client.disconnect_socket()

    # Variables

    async def _found(self, column: Column) -> Any:
        """Return the node of a column; None if it may be absent; a ``Problem`` if it may not."""
        found = await self._node(column.place)
        if isinstance(found, str):
            missing = Problem(str(column.place), 0, Wording("TWN230", "not_there", found=found))
            return None if column.is_optional else missing
        return found

    async def _node(self, place: VariableAddress) -> Any:
        """Return a node; a text says what is there instead."""
        if not place.path:
            return await self._node_by_id(place)
        node, way = self._client.nodes.objects, list[str]()
        for name in place.path:
            children = await node.get_children_descriptions()
            names = [child.BrowseName.Name for child in children]
            if name not in names:
                there = ", ".join(sorted(names)[:20]) or "nothing"
                return f"in {'/'.join(way) or 'the objects'} there is {there}"
            node = self._client.get_node(children[names.index(name)].NodeId)
            way.append(name)
        return node

    async def _node_by_id(self, place: VariableAddress) -> Any:
        spaces = await self._client.get_namespace_array()
        if place.namespace not in spaces:
            return f"its namespaces are {', '.join(spaces[1:]) or 'none'}"
        try:
            node = self._client.get_node(
                ua.NodeId.from_string(f"ns={spaces.index(place.namespace)};{place.identifier}")
            )
            await node.read_node_class()
        except ua.UaError as error:
            return f"compare it with what an OPC UA browser shows ({error.__class__.__name__})"
        return node

    async def _name(self, column: Column, node: Any) -> str:
        if node is None:
            return ""
        if column.named_by is None:
            return column.name
        named = await self._node(column.named_by)
        told = None if isinstance(named, str) else _plain(await named.read_value())
        return told.strip() if isinstance(told, str) and told.strip().isidentifier() else column.name

    # Messages

    async def _published(self, result: Any) -> None:
        self._heard = time.monotonic()
        readings: list[Reading] = []
        for data in result.NotificationMessage.NotificationData or ():
            if isinstance(data, ua.DataChangeNotification):
                readings += self._readings(data.MonitoredItems)
            elif isinstance(data, ua.StatusChangeNotification):  # the subscription has ended
                self._ended = True
        if readings:
            await self._messages.put(Message(tuple(readings), bool(result.MoreNotifications)))

    def _readings(self, items: Sequence[Any]) -> Iterator[Reading]:
        for item in items:
            value, column = item.Value, self._columns[item.ClientHandle]
            status = value.StatusCode.value if value.StatusCode is not None else 0
            shown = None if status >> 30 == 0b10 or value.Value is None else _shown(value.Value.Value, column)
            overflow = status & _OVERFLOW == _OVERFLOW
            source, server = _microseconds(value.SourceTimestamp), _microseconds(value.ServerTimestamp)
            yield Reading(item.ClientHandle, shown, source, server, overflow)


async def connect(access: Access, nodes: NodeList, sampling: float) -> Connection:
    """Connect and subscribe; ``sampling`` is in milliseconds.

    Raises
    ------
    InputError
        If the server is not trusted, or lacks a variable.
    OSError, TimeoutError, asyncua.ua.UaError
        If it is not there, or refuses the connection.
    """
    client = Client(access.address, timeout=4, watchdog_intervall=1.0)
    client.name = client.description = "Trunnion recorder"
    client.product_uri = "urn:trunnion"
    if access.folder is not None:
        await _secure(client, access)
    if access.user:
        client.set_user(access.user)
        client.set_password(access.password)
    await client.connect()
    made = Connection(client, nodes.columns)
    try:
        await made.subscribe(sampling)
    except BaseException:
        await made.close()
        raise
    return made


async def _secure(client: Any, access: Access) -> None:
    """Have the channel encrypted, to a server whose certificate has the fingerprint that is trusted."""
    assert access.folder is not None
    offered = {
        endpoint.SecurityPolicyUri: endpoint.ServerCertificate
        for endpoint in await client.connect_and_get_server_endpoints()
        if endpoint.SecurityMode == ua.MessageSecurityMode.SignAndEncrypt
    }
    policy = next((each for each in _POLICIES if each.URI in offered), None)
    if policy is None:
        raise InputError(Problem(access.address, 0, Wording("TWN221", "offers_no_channel")))
    certificate: bytes = offered[policy.URI]
    fingerprint = hashlib.sha1(certificate, usedforsecurity=False).hexdigest().upper()
    if fingerprint != access.fingerprint.replace(":", "").replace(" ", "").upper():
        raise InputError(
            Problem(access.address, 0, Wording("TWN222", "certificate_fingerprint_not", fingerprint=fingerprint))
        )
    own = client_certificate(access.folder)
    client.application_uri = own.application
    await client.set_security(
        policy, str(own.certificate), str(own.key), server_certificate=CertProperties(certificate, "der"),
        mode=ua.MessageSecurityMode.SignAndEncrypt,
    )  # fmt: skip


def _item(handle: int, node: Any, sampling: float) -> Any:
    made = ua.MonitoredItemCreateRequest()
    made.ItemToMonitor.NodeId = node
    made.ItemToMonitor.AttributeId = ua.AttributeIds.Value
    made.MonitoringMode = ua.MonitoringMode.Reporting
    made.RequestedParameters.ClientHandle = handle
    made.RequestedParameters.SamplingInterval = sampling
    made.RequestedParameters.QueueSize = _QUEUE
    made.RequestedParameters.DiscardOldest = True
    return made


def _shown(value: Any, column: Column) -> Value:
    """Return what a column shows of a value; None if it cannot."""
    if isinstance(value, list):
        value = value[column.element - 1] if 0 < column.element <= len(value) else None
    plain = _plain(value)
    if column.is_text:
        return plain if plain is None or isinstance(plain, str) else f"{plain:g}"
    return plain if isinstance(plain, float) else None


def _plain(value: Any) -> Value:
    """Return a value as a number or a text; None if it is neither."""
    if isinstance(value, bool | int | float):
        try:
            return float(value)
        except OverflowError:
            return None
    text = getattr(value, "Text", value)
    return text if isinstance(text, str) else None


def _microseconds(stamp: datetime | None) -> int | None:
    """Since 1970; None for none."""
    if stamp is None:
        return None
    since = (stamp if stamp.tzinfo is not None else stamp.replace(tzinfo=UTC)) - _EPOCH
    return (since.days * 86_400 + since.seconds) * 1_000_000 + since.microseconds
