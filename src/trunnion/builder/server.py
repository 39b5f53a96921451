"""The builder's page on this computer, and the requests that it makes.

In:     a ``BuilderSession``.
Out:    a Starlette application. Requests are JSON of bounded size, from this page alone.
"""

import json
from collections.abc import Mapping
from importlib.resources import files
from typing import Any, Final

from trunnion.builder.session import MOST_CL_BYTES, BuilderSession, RequestError
from trunnion.errors import InputError
from trunnion.extras import import_extra
from trunnion.messages import Words
from trunnion.viewer.language import OF_BROWSERS, Speech, page_texts
from trunnion.viewer.serving import HEADERS, Access, application_of
from trunnion.viewer.shell import PageShell, bundle

#: A CL file in base64, a definition and an earlier program.
_MOST_BYTES: Final = MOST_CL_BYTES * 4 // 3 + 4_000_000

_WEB: Final = files("trunnion.builder") / "web"
_VIEWER: Final = files("trunnion.viewer") / "web"

#: Modules of the viewer's page that this one has, too.
_SHARED: Final = ("texts", "kinematics")

#: In an order in which each needs only those before it.
_MODULES: Final = ("stage", "form", "editor", "edits", "jog", "sample", "main")


def builder_application(session: BuilderSession, access: Access, speech: Speech = OF_BROWSERS) -> Any:
    """Make the application.

    session  what its page may ask for
    access   who may see it
    speech   the language of its page

    Raises ``InputError`` if Starlette is not installed, or the definition cannot be read.
    """
    responses, routing = (import_extra(f"starlette.{name}", "view") for name in ("responses", "routing"))
    run_in_threadpool = import_extra("starlette.concurrency", "view").run_in_threadpool
    session.start()

    def plain(text: str, status: int) -> Any:
        return responses.PlainTextResponse(text, status, HEADERS)

    def show_page(request: Any) -> Any:
        words = speech.to(request)
        try:
            return access.page(_render_builder(session.start(request.query_params.get("file", ""), words), words))
        except RequestError:
            return plain("this is no file of a definition", 404)
        except InputError as error:
            return plain("\n".join(problem.line_of_text(words) for problem in error.problems), 404)

    async def answer(request: Any) -> Any:
        # A form of another page cannot send JSON without being asked first.
        if request.headers.get("content-type", "").partition(";")[0].strip().casefold() != "application/json":
            return plain("send JSON", 415)
        body = bytearray()
        async for piece in request.stream():
            body += piece
            if len(body) > _MOST_BYTES:
                return plain("the request is too large", 413)
        try:
            given = json.loads(bytes(body))
            if not isinstance(given, dict):
                raise RequestError
            words = speech.known(given.get("language"))
            found = await run_in_threadpool(session.answer, request.path_params["what"], given, words)
            return None if found is None else responses.JSONResponse(found, headers=HEADERS)
        except (RequestError, ValueError, RecursionError):
            return plain("the page makes no such request", 400)

    return application_of(
        [
            routing.Route("/", access.guarded(show_page)),
            routing.Route("/{what}", access.guarded(answer), methods=["POST"]),
        ]
    )


def _render_builder(start: Mapping[str, Any], words: Words) -> bytes:
    """Return the page; ``start`` is what ``BuilderSession.start`` gives."""
    shared = ((_VIEWER / f"{name}.js").read_text(encoding="utf-8") for name in _SHARED)
    modules = ((_WEB / f"{name}.js").read_text(encoding="utf-8") for name in _MODULES)
    style, body = ((_WEB / name).read_text(encoding="utf-8") for name in ("style.css", "body.html"))
    script, texts = bundle((*shared, *modules)), page_texts("builder", words.language)
    shell = PageShell(str(start["title"]), "\n" + style, body, script, words.language, texts, "build")
    return shell.head(start, embedded=False) + shell.foot()
