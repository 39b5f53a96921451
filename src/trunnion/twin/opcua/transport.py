"""Connections of clients, of whom nothing is expected: garbage, floods and clients that stop reading end their own.

asyncua reads on after what it cannot parse, keeps what a client sends until it is whole, and writes without looking
whether anybody reads. Here each of these ends the connection.
"""

import asyncio
import logging
import socket
from typing import Any, Final

from asyncua import ua
from asyncua.common.connection import TransportLimits
from asyncua.common.utils import Buffer, NotEnoughData
from asyncua.server.binary_server_asyncio import BinaryServer, OPCUAProtocol
from asyncua.server.internal_server import InternalServer
from asyncua.server.uaprocessor import UaProcessor
from asyncua.ua.ua_binary import header_from_binary

#: Bytes of a chunk, of a message, and of answers that a client has not fetched yet.
_CHUNK: Final = 65_536
_MESSAGE: Final = 4 * 1024 * 1024
_UNREAD: Final = 32 * 1024 * 1024

#: Seconds in which a client sends its first message, and the rest of one that it has begun.
_PATIENCE: Final = 10.0

LIMITS: Final = TransportLimits(
    max_recv_buffer=_CHUNK, max_send_buffer=_CHUNK, max_chunk_count=_UNREAD // _CHUNK, max_message_size=_MESSAGE
)

_KINDS: Final = (
    ua.MessageType.Hello,
    ua.MessageType.SecureOpen,
    ua.MessageType.SecureClose,
    ua.MessageType.SecureMessage,
)

#: Requests that a client makes before it has a session, also on a channel that is not secured.
_DISCOVERY: Final = frozenset(
    ua.NodeId(kind)
    for kind in (
        ua.ObjectIds.GetEndpointsRequest_Encoding_DefaultBinary,
        ua.ObjectIds.FindServersRequest_Encoding_DefaultBinary,
        ua.ObjectIds.CloseSecureChannelRequest_Encoding_DefaultBinary,
    )
)

_CLOSE_SESSION: Final = ua.NodeId(ua.ObjectIds.CloseSessionRequest_Encoding_DefaultBinary)
_DELETE_SUBSCRIPTIONS: Final = ua.NodeId(ua.ObjectIds.DeleteSubscriptionsRequest_Encoding_DefaultBinary)

_log = logging.getLogger("asyncua.twin")


class TwinProcessor(UaProcessor):
    """Answers the requests of one connection; on a channel that is not secured only where that is allowed."""

    def __init__(self, server: InternalServer, transport: asyncio.Transport, *, secured: bool) -> None:
        super().__init__(server, transport, LIMITS)
        self._secured_only = secured

    async def _process_message(self, typeid: ua.NodeId, requesthdr: Any, seqhdr: Any, body: Buffer) -> bool:
        mode = self._connection.security_policy.Mode
        if self._secured_only and mode != ua.MessageSecurityMode.SignAndEncrypt and typeid not in _DISCOVERY:
            raise ua.uaerrors.BadSecurityModeRejected
        answered: bool = await super()._process_message(typeid, requesthdr, seqhdr, body)
        if typeid == _CLOSE_SESSION:
            self._answer_publish_requests(ua.StatusCodes.BadSessionClosed)
        elif typeid == _DELETE_SUBSCRIPTIONS and not self._has_subscriptions():
            self._answer_publish_requests(ua.StatusCodes.BadNoSubscription)
        return answered

    def _has_subscriptions(self) -> bool:
        number = self.session.session_id if self.session else None
        return any(each.session_id == number for each in self.iserver.subscription_service.subscriptions.values())

    def _answer_publish_requests(self, status: int) -> None:
        """Answer the requests for notifications that will not come any more."""
        while self._publish_requests:
            asked = self._publish_requests.popleft()
            fault = ua.ServiceFault()
            fault.ResponseHeader.ServiceResult = ua.StatusCode(status)
            self.send_response(asked.requesthdr.RequestHandle, asked.seqhdr, fault)


class TwinProtocol(OPCUAProtocol):
    """One connection."""

    def __init__(self, *, secured: bool, **named: Any) -> None:
        super().__init__(**named)
        self._secured_only = secured
        self._buffer: bytes = b""
        self._waiting: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Take a client, if there is room."""
        super().connection_made(transport)
        if self.transport is None:  # there is none
            return
        self.transport.set_write_buffer_limits(high=_UNREAD)
        self.processor = TwinProcessor(self.iserver, self.transport, secured=self._secured_only)
        self.processor.set_policies(self.policies)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Leave a client that is gone."""
        self._wait_no_more()
        super().connection_lost(exc)

    def pause_writing(self) -> None:
        """End a connection whose client does not read."""
        self._end("it does not read what it asks for")

    def data_received(self, data: bytes) -> None:
        """Take what a client sends, whole chunks of it; the rest of one must come soon."""
        self._buffer += data
        self._take_chunks()
        if not self._buffer:
            self._wait_no_more()
        elif self._waiting is None:
            self._wait()

    def _wait(self) -> None:
        """End the connection if nothing whole comes: half-open ones would take the room of others."""
        self._waiting = asyncio.get_running_loop().call_later(_PATIENCE, self._end, "it sends no whole message")

    def _wait_no_more(self) -> None:
        if self._waiting is not None:
            self._waiting.cancel()
            self._waiting = None

    def _take_chunks(self) -> None:
        while self._buffer:
            chunk = Buffer(self._buffer)
            try:
                header = header_from_binary(chunk)
            except NotEnoughData:
                return
            except Exception:  # whatever the parser raises: nobody knows what a client sends
                self._end("it does not speak OPC UA")
                return
            size = header.header_size + header.body_size
            if header.MessageType not in _KINDS or header.body_size <= 0 or size > _CHUNK:
                self._end("it sends what is no chunk of a message, or too large a one")
                return
            if len(chunk) < header.body_size:
                return
            try:
                self.messages.put_nowait((header, chunk))
            except asyncio.QueueFull:
                self._end("it sends faster than it is answered")
                return
            self._buffer = self._buffer[size:]
            self._wait_no_more()

    def _end(self, why: str) -> None:
        _log.info("connection of %s ended: %s", self.peer_name, why)
        self._buffer = b""
        if self.transport is not None:
            self.transport.abort()

    async def _process_received_message_loop(self) -> None:
        """Answer chunk by chunk; what cannot be understood ends the connection."""
        while True:
            header, chunk = await self.messages.get()
            if header is None:
                return
            try:
                if await self._process_one_msg(header, chunk):
                    continue
            except Exception as error:  # as above; one client's message must not end the server
                self._end(f"its message cannot be understood: {error!r}")
            return


class TwinBinaryServer(BinaryServer):
    """Listens on a socket that is there already."""

    def __init__(self, server: InternalServer, listening: socket.socket, *, secured: bool) -> None:
        host, port = listening.getsockname()[:2]
        super().__init__(server, host, port, LIMITS)
        self._listening, self._secured_only = listening, secured

    def _make_protocol(self) -> OPCUAProtocol:
        return TwinProtocol(
            secured=self._secured_only,
            iserver=self.iserver,
            policies=self._policies,
            clients=self.clients,
            closing_tasks=self.closing_tasks,
            limits=self.limits,
        )

    async def start(self) -> None:
        """Take connections."""
        loop = asyncio.get_running_loop()
        self._server = await loop.create_server(self._make_protocol, sock=self._listening)
        self.cleanup_task = asyncio.create_task(self._close_task_loop())

    async def stop(self) -> None:
        """End all connections at once; a client that still sends could keep the server from ending."""
        for transport in list(self.iserver.asyncio_transports):
            transport.abort()
        await super().stop()
