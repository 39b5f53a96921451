"""The viewer's page on this computer: one page, its columns and its texts, and nothing else.

In:     ``ViewContent``.
Out:    a Starlette application; ``serve`` runs it until it is ended.

Requests are answered only for hosts that were asked for, so that no page of someone else can read a program through
the browser (DNS rebinding). Off this computer, a token in the address is asked for as well. Nothing is read from disk.
"""

import secrets
import socket
from collections.abc import Callable
from typing import Any, Final

from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.viewer.content import ViewContent
from trunnion.viewer.page import render_view

_LOOPBACK_NAMES: Final = ("127.0.0.1", "localhost", "[::1]")

_COOKIE: Final = "trunnion-view"

_BYTES: Final = "application/octet-stream"

_HEADERS: Final = {
    "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}  # fmt: skip


def view_application(content: ViewContent, hosts: tuple[str, ...], token: str = "") -> Any:
    """Make the application.

    Parameters
    ----------
    content
        What its page shows.
    hosts
        Values of the header Host that it answers to, without ports.
    token
        Asked for in the address of the page, and by its cookie after that; empty: none is.

    Raises
    ------
    InputError
        If Starlette is not installed.
    """
    responses, routing = (import_extra(f"starlette.{name}", "view") for name in ("responses", "routing"))
    applications = import_extra("starlette.applications", "view")
    page = b"".join(render_view(content, embedded=False))

    def is_allowed(request: Any) -> bool:
        origin = request.headers.get("origin", "")
        if _host_of(request.headers.get("host", "")) not in hosts:
            return False
        if origin and _host_of(origin.partition("://")[2]) not in hosts:
            return False
        given = request.query_params.get("token") or request.cookies.get(_COOKIE, "")
        return not token or secrets.compare_digest(given.encode(), token.encode())

    def guarded(answer: Callable[[Any], Any]) -> Callable[[Any], Any]:
        async def respond(request: Any) -> Any:
            if not is_allowed(request):
                return responses.PlainTextResponse("this address is not served", 403, _HEADERS)
            found = answer(request)
            return found or responses.PlainTextResponse("there is no such thing", 404, _HEADERS)

        return respond

    def show_page(_request: Any) -> Any:
        made = responses.Response(page, 200, _HEADERS, "text/html")
        if token:
            made.set_cookie(_COOKIE, token, httponly=True, samesite="strict")
        return made

    def give_column(request: Any) -> Any:
        column = content.columns.get(request.path_params["name"])
        return None if column is None else responses.Response(column.tobytes(), 200, _HEADERS, _BYTES)

    def give_text(request: Any) -> Any:
        number = request.path_params["number"]
        return responses.Response(content.texts[number], 200, _HEADERS, _BYTES) if number < len(content.texts) else None

    return applications.Starlette(
        routes=[
            routing.Route("/", guarded(show_page)),
            routing.Route("/data/column/{name}", guarded(give_column)),
            routing.Route("/data/text/{number:int}", guarded(give_text)),
        ]
    )


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
        raise InputError(Problem("the view", 0, what, "choose another port, or none")) from None


def serve(content: ViewContent, listening: socket.socket, ready: Callable[[str], None]) -> None:
    """Serve the page until the process is ended by Ctrl-C.

    Parameters
    ----------
    content
        What its page shows.
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
    application = view_application(content, hosts, token)
    config = uvicorn.Config(application, log_level="warning", access_log=False, timeout_graceful_shutdown=1)
    ready(f"http://{host}:{port}/" + (f"?token={token}" if token else ""))
    uvicorn.Server(config).run(sockets=[listening])
