"""Pages on this computer: who may see them, the port they are served on, and their end.

On this computer's own address, requests are answered only by its own names, so that no page of someone else can read a
program through the browser (DNS rebinding). On any other address, a token that is part of the page's address is asked
for instead: a page of someone else does not have it, under whatever name it reaches the server.
"""

import errno
import inspect
import ipaddress
import re
import secrets
import socket
from collections.abc import Callable
from typing import Any, Final

from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.messages import Wording
from trunnion.ports import bound_socket, open_port
from trunnion.records import dataclass

_LOOPBACK_NAMES: Final = ("127.0.0.1", "localhost", "[::1]")

#: ``host`` or ``host:port``, as a browser sends it; an address of IPv6 stands in brackets.
_HOST: Final = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(?::\d{1,5})?", re.ASCII | re.IGNORECASE)

#: Why a port cannot be had, as people say it.
_REASONS: Final = {
    errno.EADDRINUSE: "the port is taken", errno.EACCES: "the system does not allow it",
    errno.EADDRNOTAVAIL: "it is no address of this computer",
}  # fmt: skip

#: Seconds in which the head of a request is whole, and its body after that.
_PATIENCE: Final = 10.0
_PATIENCE_WITH_BODY: Final = 60.0

#: Headers of every answer.
HEADERS: Final = {
    "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin", "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Access:
    """Who may see a page.

    hosts   values of the header Host that are answered without a token, in lower case and without ports
    token   asked for in the address of the page, and by its cookie after that; empty: none is
    port    of the server: browsers send the cookies of a host to all its ports, so that each has a name of its own
    """

    hosts: tuple[str, ...]
    token: str = ""
    port: int = 0

    @property
    def cookie(self) -> str:
        """The name of the cookie."""
        return f"trunnion-{self.port}"

    def allows(self, request: Any) -> bool:
        """Whether a Starlette request comes by a name of ours, from no page of another origin, with the token."""
        host, origin = request.headers.get("host", ""), request.headers.get("origin", "")
        named = _HOST.fullmatch(host)
        if named is None or (origin and origin.lower() != f"http://{host}".lower()):
            return False
        if not self.token:
            return named[1].lower() in self.hosts
        given = request.query_params.get("token") or request.cookies.get(self.cookie, "")
        return secrets.compare_digest(given.encode(), self.token.encode())

    def guarded(self, answer: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """Return an endpoint that answers those who are allowed; None becomes "not found"."""
        responses = import_extra("starlette.responses", "view")

        async def respond(request: Any) -> Any:
            if not self.allows(request):
                return responses.PlainTextResponse("this address is not served", 403, HEADERS)
            found = answer(request)
            found = await found if inspect.isawaitable(found) else found
            return found or responses.PlainTextResponse("there is no such thing", 404, HEADERS)

        return respond

    def page(self, page: bytes) -> Any:
        """Return the answer with the page, and with the token's cookie."""
        made = import_extra("starlette.responses", "view").Response(page, 200, HEADERS, "text/html")
        if self.token:
            made.set_cookie(self.cookie, self.token, httponly=True, samesite="strict")
        return made


def application_of(routes: list[Any], **more: Any) -> Any:
    """Return a Starlette application of routes; what is at none of them is answered with our headers as well."""
    responses = import_extra("starlette.responses", "view")

    def refuse(_request: Any, error: Any) -> Any:
        text = "there is no such thing" if error.status_code == 404 else "the page makes no such request"
        return responses.PlainTextResponse(text, error.status_code, {**HEADERS, **(error.headers or {})})

    application = import_extra("starlette.applications", "view").Starlette(
        routes=routes, exception_handlers={404: refuse, 405: refuse}, **more
    )
    application.router.redirect_slashes = False
    return application


def take_port(host: str, port: int) -> socket.socket:
    """Take a port of this computer, before any work; 0: a free one. ``serve`` opens it.

    Raises ``InputError`` if it is taken, or the address is none of this computer's.
    """
    try:
        if host:
            socket.getaddrinfo(host, None)  # ``bind`` gives its errors no class of their own
        return bound_socket(host, port)
    except OverflowError:
        raise InputError(Problem("the page", 0, Wording("PAG120", "no_port", port=port))) from None
    except socket.gaierror:
        raise InputError(Problem("the page", 0, Wording("PAG120", "no_such_host", host=host))) from None
    except OSError as error:
        raise _not_served(host, port, error) from None


def _not_served(host: str, port: int, error: OSError) -> InputError:
    why = _REASONS.get(error.errno or 0, str(error))
    return InputError(Problem("the page", 0, Wording("PAG120", "not_served", host=host, port=port, reason=why)))


def impatient_protocol() -> type:
    """Return HTTP that ends a connection whose request is not whole in time: half-open ones stay for ever otherwise."""
    h11 = import_extra("h11", "view")
    base: Any = import_extra("uvicorn.protocols.http.h11_impl", "view").H11Protocol

    class ImpatientProtocol(base):  # type: ignore[misc]
        """Waits for the head of a request and for its body, but not longer than for each it has patience."""

        _waiting: Any = None
        _waits_for_body = False

        def connection_made(self, transport: Any) -> None:
            super().connection_made(transport)
            self._wait(_PATIENCE)

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            state = self.conn.their_state
            if state is h11.SEND_BODY:
                if not self._waits_for_body:
                    self._wait_no_more()
                    self._wait(_PATIENCE_WITH_BODY)
                    self._waits_for_body = True
            elif state is not h11.IDLE:
                self._wait_no_more()
            elif self._waiting is None:
                self._wait(_PATIENCE)

        def on_response_complete(self) -> None:
            """Leave the next request to ``timeout_keep_alive``."""
            super().on_response_complete()
            self._wait_no_more()

        def connection_lost(self, exc: Exception | None) -> None:
            self._wait_no_more()
            super().connection_lost(exc)

        def _wait(self, patience: float) -> None:
            self._waiting = self.loop.call_later(patience, self.transport.abort)

        def _wait_no_more(self) -> None:
            self._waits_for_body = False
            if self._waiting is not None:
                self._waiting.cancel()
                self._waiting = None

    return ImpatientProtocol


def serve(make: Callable[[Access], Any], listening: socket.socket, ready: Callable[[str], None]) -> None:
    """Serve an application until the process is ended by Ctrl-C.

    make       makes the application for those who may see it
    listening  of ``take_port``. On another address than this computer's own, a token is part of the page's address
    ready      is called with the page's address when it can be opened

    Raises ``InputError`` if the extra ``view`` is not installed, or another program has opened the port meanwhile.
    """
    uvicorn = import_extra("uvicorn", "view")
    host, port = listening.getsockname()[:2]
    address = ipaddress.ip_address(host.partition("%")[0])
    token = "" if address.is_loopback else secrets.token_urlsafe(16)
    own = f"[{host}]" if ":" in host else host
    application = make(Access((*_LOOPBACK_NAMES, own), token, port))
    config = uvicorn.Config(
        application, http=impatient_protocol(), log_level="warning", access_log=False, timeout_graceful_shutdown=1
    )
    try:
        open_port(listening)
    except OSError as error:
        raise _not_served(host, port, error) from None
    reached = socket.gethostname() if address.is_unspecified else own
    ready(f"http://{reached}:{port}/" + (f"?token={token}" if token else ""))
    try:
        uvicorn.Server(config).run(sockets=[listening])
    except KeyboardInterrupt as end:
        if type(end) is not KeyboardInterrupt:  # another signal than Ctrl-C, which is how serving ends
            raise
