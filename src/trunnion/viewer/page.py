"""The page of the viewer, with its content in it or on the server.

In:     ``ViewContent``.
Out:    UTF-8 HTML, piece by piece.
"""

import base64
import re
import zlib
from collections.abc import Iterator
from importlib.resources import files
from typing import Final

import numpy as np

from trunnion.messages import LIBRARY, Words
from trunnion.reporting.column_encoding import COMPRESSION_LEVEL, encode_column
from trunnion.reporting.html_text import escape
from trunnion.viewer.content import ViewContent
from trunnion.viewer.language import page_texts
from trunnion.viewer.shell import PageShell, bundle

_WEB: Final = files("trunnion.viewer") / "web"

#: In an order in which each needs only those before it.
MODULES: Final = (
    "texts",
    "data",
    "kinematics",
    "program",
    "dashes",
    "space",
    "stock",
    "listing",
    "curves",
    "elements",
    "strips",
    "path_colours",
    "program_text",
    "controls",
    "twin",
    "live",
    "page",
    "main",
)


def render_view(content: ViewContent, words: Words = LIBRARY, *, embedded: bool) -> Iterator[bytes]:
    """Yield the page in the language of some words; ``embedded``: with columns and texts in it, so that it works
    offline.
    """
    title, texts = content.scene["title"], page_texts("viewer", words.language)
    shell = PageShell(title, "\n" + _read("style.css"), _body(title), _script(), words.language, texts, "view")
    types = {name: "f" if column.dtype == np.float32 else "i" for name, column in content.columns.items()}
    yield shell.head({**content.said(words), "columns": types}, embedded=embedded)
    if embedded:
        for name, column in content.columns.items():
            yield f'<script type="text/plain" id="column-{name}">'.encode() + encode_column(column) + b"</script>\n"
        for k, text in enumerate(content.texts):
            packed = base64.b64encode(zlib.compress(text, COMPRESSION_LEVEL))
            yield f'<script type="text/plain" id="text-{k}">'.encode() + packed + b"</script>\n"
        if content.stock is not None:
            packed = base64.b64encode(content.stock.packed())
            yield b'<script type="text/plain" id="stock-states">' + packed + b"</script>\n"
    yield shell.foot()


def _body(title: str) -> str:
    names = " | ".join(re.split(r"[\\/]", one)[-1] for one in title.split(" | "))  # ends, which long paths would hide
    return _read("body.html").replace('id="title"></h1>', f'id="title" title="{escape(title)}">{escape(names)}</h1>')


def _script() -> str:
    unpack = files("trunnion.reporting").joinpath("unpack.js").read_text(encoding="utf-8")
    return bundle((_read(f"{name}.js") for name in MODULES), unpack)


def _read(name: str) -> str:
    return (_WEB / name).read_text(encoding="utf-8")
