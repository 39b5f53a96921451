"""The viewer's page on this computer: one page, its columns, its texts and its stock, and nothing else.

In:     ``ViewContent``.
Out:    a Starlette application. Nothing is read from disk.
"""

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import cache
from typing import Any, Final

import numpy as np

from trunnion.extras import import_extra
from trunnion.messages import Words
from trunnion.viewer.bricks import NOTHING
from trunnion.viewer.content import ViewContent
from trunnion.viewer.language import OF_BROWSERS, Speech
from trunnion.viewer.live import LiveView
from trunnion.viewer.page import render_view
from trunnion.viewer.serving import HEADERS, Access, application_of

_BYTES: Final = "application/octet-stream"
_NEW_LINE: Final = 10

#: How long a machine that is listened to has to leave, seconds.
_PATIENCE: Final = 1.0

#: Rows, in an address.
_NUMBER: Final = re.compile(r"\d{1,9}", re.ASCII)


def view_application(
    content: ViewContent, access: Access, live: LiveView | None = None, speech: Speech = OF_BROWSERS
) -> Any:
    """Make the application.

    content  what its page shows
    access   who may see it
    live     the machine whose motion it follows; None: it follows none
    speech   the language of its page

    Raises ``InputError`` if Starlette is not installed.
    """
    responses, routing = (import_extra(f"starlette.{name}", "view") for name in ("responses", "routing"))
    if live is not None:
        content = replace(content, scene={**content.scene, "live": True})

    @cache
    def page(words: Words) -> bytes:
        return b"".join(render_view(content, words, embedded=False))

    def show_page(request: Any) -> Any:
        return access.page(page(speech.to(request)))

    def give_column(request: Any) -> Any:
        column = content.columns.get(request.path_params["name"])
        return None if column is None else responses.Response(column.tobytes(), 200, HEADERS, _BYTES)

    def give_text(request: Any) -> Any:
        number = request.path_params["number"]
        return responses.Response(content.texts[number], 200, HEADERS, _BYTES) if number < len(content.texts) else None

    @cache
    def line_starts(number: int) -> list[int]:
        text = content.texts[number]
        ends = np.flatnonzero(np.frombuffer(text, np.uint8) == _NEW_LINE) + 1
        return [0, *ends.tolist(), len(text)]

    def give_line(request: Any) -> Any:
        number, line = request.path_params["number"], request.path_params["line"]
        if number >= len(content.texts) or not 0 < line < len(line_starts(number)):
            return None
        first, end = line_starts(number)[line - 1 : line + 1]
        return responses.Response(content.texts[number][first:end], 200, HEADERS, _BYTES)

    async def give_stock(request: Any) -> Any:
        stock, rows = content.stock, request.path_params["rows"]
        if stock is None or rows > stock.rows:
            return None
        before = request.query_params.get("before", "")
        known = int(before) if _NUMBER.fullmatch(before) else NOTHING
        found = await asyncio.to_thread(stock.answer, rows, known)
        if found is None:
            return responses.PlainTextResponse("another state was asked for meanwhile", 409, HEADERS)
        return responses.Response(found, 200, HEADERS, _BYTES)

    def follow(_request: Any) -> Any:
        return None if live is None else responses.StreamingResponse(live.events(), 200, HEADERS, "text/event-stream")

    @asynccontextmanager
    async def until_the_end(_application: Any) -> AsyncIterator[None]:
        listening = None if live is None else asyncio.create_task(live.listen())
        yield
        if listening is not None:
            while not listening.done():  # a library on the way may lose a cancellation
                listening.cancel()
                await asyncio.wait((listening,), timeout=_PATIENCE)
        if content.stock is not None:
            content.stock.leave()

    return application_of(
        [
            routing.Route("/", access.guarded(show_page)),
            routing.Route("/data/column/{name}", access.guarded(give_column)),
            routing.Route("/data/text/{number:int}", access.guarded(give_text)),
            routing.Route("/data/text/{number:int}/{line:int}", access.guarded(give_line)),
            routing.Route("/data/stock/{rows:int}", access.guarded(give_stock)),
            routing.Route("/live", access.guarded(follow)),
        ],
        lifespan=until_the_end,
    )
