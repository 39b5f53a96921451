"""Pages on this computer: who may see them, the port they are served on, and their end.

Requests are answered only for hosts that were asked for, so that no page of someone else can read a program through
the browser (DNS rebinding). Off this computer, a token in the address is asked for as well.
"""

import inspect
import secrets
import socket
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra

_LOOPBACK_NAMES: Final = ("127.0.0.1", "localhost", "[::1]")

_COOKIE: Final = "trunnion-view"

#: Headers of every answer.
HEADERS: Final = {
    "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Access:
    """Who may see a page.

    hosts   values of the header Host that are answered, without ports
    token   asked for in the address of the page, and by its cookie after that; empty: none is
    """

    hosts: tuple[str, ...]
    token: str = ""

    def allows(self, request: Any) -> bool:
        """Whether a Starlette request comes by a name of ours, from no page of another origin, with the token."""
        origin = request.headers.get("origin", "")
        if _host_of(request.headers.get("host", "")) not in self.hosts:
            return False
        if origin and _host_of(origin.partition("://")[2]) not in self.hosts:
            return False
        given = request.query_params.get("token") or request.cookies.get(_COOKIE, "")
        return not self.token or secrets.compare_digest(given.encode(), self.token.encode())

    def guarded(self, answer: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """An endpoint that answers those who are allowed; None becomes "not found"."""
        responses = import_extra("starlette.responses", "view")

        async def respond(request: Any) -> Any:
            if not self.allows(request):
                return responses.PlainTextResponse("this address is not served", 403, HEADERS)
            found = answer(request)
            found = await found if inspect.isawaitable(found) else found
            return found or responses.PlainTextResponse("there is no such thing", 404, HEADERS)

        return respond

    def page(self, page: bytes) -> Any:
        """The answer with the page, and with the token's cookie."""
        made = import_extra("starlette.responses", "view").Response(page, 200, HEADERS, "text/html")
        if self.token:
            made.set_cookie(_COOKIE, self.token, httponly=True, samesite="strict")
        return made


def _host_of(place: str) -> str:
    """The host of ``host:port``."""
    return place if place.endswith("]") else place.rsplit(":", 1)[0] if ":" in place else place


def listen(host: str, port: int) -> socket.socket:
    """Take a port of this computer, before any work; 0: a free one.

    Raises
    ------
    InputError
        If it is taken, or the address is none of this computer's.
    """
    try:
        return socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except (OSError, OverflowError) as error:
        what = f"cannot be served on {host}, port {port}: {getattr(error, 'strerror', None) or error}"
        raise InputError(Problem("the page", 0, what, "choose another port, or none")) from None


def serve(make: Callable[[Access], Any], listening: socket.socket, ready: Callable[[str], None]) -> None:
    """Serve an application until the process is ended by Ctrl-C.

    Parameters
    ----------
    make
        Makes the application for those who may see it.
    listening
        Of ``listen``. On another address than this computer's own, a token is part of the page's address.
    ready
        Is called with the page's address when it can be opened.

    Raises
    ------
    InputError
        If the extra ``view`` is not installed.
    """
    uvicorn = import_extra("uvicorn", "view")
    host, port = listening.getsockname()[:2]
    host = f"[{host}]" if ":" in host else host
    token = "" if host in _LOOPBACK_NAMES else secrets.token_urlsafe(16)
    hosts = _LOOPBACK_NAMES if not token else (*_LOOPBACK_NAMES, host)
    application = make(Access(hosts, token))
    config = uvicorn.Config(application, log_level="warning", access_log=False, timeout_graceful_shutdown=1)
    ready(f"http://{host}:{port}/" + (f"?token={token}" if token else ""))
    try:
        uvicorn.Server(config).run(sockets=[listening])
    except KeyboardInterrupt as end:
        if type(end) is not KeyboardInterrupt:  # another signal than Ctrl-C, which is how serving ends
            raise
