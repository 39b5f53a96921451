"""Serves documents by HTTP on this computer; of clients nothing is expected.

Half a request, or an answer that is not taken, ends its connection, which has one request. Only the names of this
computer are answered, so that no page of someone else reads the machine through a browser (DNS rebinding).
"""

import asyncio
import re
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import suppress
from http import HTTPStatus
from typing import Final

from trunnion.twin.mtconnect.request_errors import RequestError, invalid

_MOST_CONNECTIONS: Final = 32

#: Bytes of the head of a request.
_LONGEST_HEAD: Final = 8192

#: Seconds in which the head of a request is whole, and in which an answer is taken.
_PATIENCE: Final = 10.0

_HOST: Final = re.compile(r"(127\.0\.0\.1|localhost|\[::1\])(:\d{1,5})?", re.IGNORECASE | re.ASCII)

#: What a client that takes XML accepts.
_ACCEPTED: Final = re.compile(r"(\*/\*|text/\*|application/\*|(text|application)/xml)\s*(;|,|$)", re.IGNORECASE)

_BOUNDARY: Final = "trunnion-next-document"


class WebServer:
    """Answers requests on a port.

    listening  the port
    respond    returns the document for a target, or documents one after the other; raises ``RequestError``
    refused    returns the document that says why there is none
    """

    def __init__(
        self, listening: socket.socket, respond: Callable[[str], bytes | AsyncIterator[bytes]],
        refused: Callable[[RequestError], bytes],
    ) -> None:  # fmt: skip
        self._listening, self._respond, self._refused = listening, respond, refused
        self._tasks: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None

    @property
    def address(self) -> str:
        """Host and port."""
        host, port = self._listening.getsockname()[:2]
        return f"{host}:{port}"

    async def begin(self) -> None:
        """Take connections."""
        self._server = await asyncio.start_server(self._serve, sock=self._listening, limit=_LONGEST_HEAD)

    async def end(self) -> None:
        """End all connections."""
        if self._server is not None:
            self._server.close()
        for task in self._tasks:
            task.cancel()
        if self._tasks:
            await asyncio.wait(self._tasks)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        if len(self._tasks) >= _MOST_CONNECTIONS:
            writer.transport.abort()
            return
        self._tasks.add(task)
        try:
            await self._answer(reader, writer)
            writer.close()
            async with asyncio.timeout(_PATIENCE):
                await writer.wait_closed()
        except (OSError, TimeoutError, asyncio.IncompleteReadError, asyncio.CancelledError):  # gone, silent, or ended
            pass
        finally:
            self._tasks.discard(task)
            writer.transport.abort()

    async def _answer(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Take the request of a connection, and answer it."""
        only_head = False
        try:
            method, target = await _request(reader)
            only_head = method == "HEAD"
            document = self._respond(target)
        except RequestError as refusal:
            await _send(writer, refusal.status, self._refused(refusal), only_head=only_head)
            return
        if isinstance(document, bytes):
            await _send(writer, HTTPStatus.OK, document, only_head=only_head)
            return
        _begin(writer, HTTPStatus.OK, f"multipart/x-mixed-replace;boundary={_BOUNDARY}", "Transfer-Encoding: chunked")
        if only_head:
            return
        sending, gone = asyncio.create_task(_send_all(writer, document)), asyncio.create_task(_read_out(reader))
        try:
            await asyncio.wait((sending, gone), return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in (sending, gone):
                task.cancel()
            await asyncio.gather(sending, gone, return_exceptions=True)


async def _request(reader: asyncio.StreamReader) -> tuple[str, str]:
    """Return the method and the target of a request.

    Raises ``RequestError`` if it is none that is answered.
    """
    try:
        async with asyncio.timeout(_PATIENCE):
            head = await reader.readuntil(b"\r\n\r\n")
    except asyncio.LimitOverrunError:
        text = f"the head of a request has at most {_LONGEST_HEAD} bytes"
        raise RequestError("INVALID_REQUEST", text, HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE) from None
    first, *lines = head.decode("latin-1").split("\r\n")[:-2]
    words = first.split(" ")
    if len(words) != 3 or not words[2].startswith("HTTP/1."):
        raise invalid("this is no request of HTTP 1")
    fields = _fields(lines)
    host = fields.get("host", "localhost" if words[2] == "HTTP/1.0" else "")
    if not _HOST.fullmatch(host):
        raise RequestError("UNAUTHORIZED", "only names of this computer are answered", HTTPStatus.FORBIDDEN)
    if fields.get("origin", f"http://{host}").lower() != f"http://{host}".lower():
        raise RequestError("UNAUTHORIZED", "no page of somebody else is answered", HTTPStatus.FORBIDDEN)
    if words[0] not in ("GET", "HEAD"):
        text = f"{words[0]} is not supported by this agent: it is read with GET"
        raise RequestError("UNSUPPORTED", text, HTTPStatus.METHOD_NOT_ALLOWED)
    if not _ACCEPTED.search(fields.get("accept", "*/*")):
        raise RequestError("UNSUPPORTED", "documents are XML", HTTPStatus.NOT_ACCEPTABLE)
    return words[0], words[1]


def _fields(lines: list[str]) -> dict[str, str]:
    """Return the fields of a head by their names in lower case.

    Raises ``RequestError`` if a line is none, or the host is named twice: who reads the other one is somebody else.
    """
    fields: dict[str, str] = {}
    for line in lines:
        name, colon, value = line.partition(":")
        key = name.lower()
        if not colon or not key or key != key.strip() or (key == "host" and key in fields):
            raise invalid("this is no head of a request of HTTP 1")
        fields[key] = value.strip()
    return fields


async def _read_out(reader: asyncio.StreamReader) -> None:
    """Return when a client is gone."""
    with suppress(OSError):
        while await reader.read(_LONGEST_HEAD):
            pass


async def _drain(writer: asyncio.StreamWriter) -> None:
    async with asyncio.timeout(_PATIENCE):
        await writer.drain()


async def _send_all(writer: asyncio.StreamWriter, documents: AsyncIterator[bytes]) -> None:
    """Send documents one after the other, each as a chunk."""
    async for part in documents:
        head = f"--{_BOUNDARY}\r\nContent-type: text/xml\r\nContent-length: {len(part)}\r\n\r\n"
        data = head.encode() + part + b"\r\n"
        writer.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")
        await _drain(writer)
    end = f"--{_BOUNDARY}--\r\n".encode()
    writer.write(f"{len(end):x}\r\n".encode() + end + b"\r\n0\r\n\r\n")
    await _drain(writer)


async def _send(writer: asyncio.StreamWriter, status: HTTPStatus, document: bytes, *, only_head: bool) -> None:
    further = ["Allow: GET, HEAD"] if status is HTTPStatus.METHOD_NOT_ALLOWED else []
    _begin(writer, status, "text/xml", f"Content-Length: {len(document)}", *further)
    if not only_head:
        writer.write(document)
    await _drain(writer)


def _begin(writer: asyncio.StreamWriter, status: HTTPStatus, kind: str, *further: str) -> None:
    lines = [
        f"HTTP/1.1 {status.value} {status.phrase}", f"Content-Type: {kind}", "Connection: close",
        "Cache-Control: no-store", "X-Content-Type-Options: nosniff", *further,
    ]  # fmt: skip
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode())
