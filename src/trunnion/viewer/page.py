"""The page of the viewer, with its content in it or on the server.

In:     ``ViewContent``.
Out:    UTF-8 HTML, piece by piece.

Text from outside is JSON in an element of its own, never part of a script; the content security policy lets only our
script and the vendored library run, by their hashes.
"""

import base64
import re
import zlib
from collections.abc import Iterator
from importlib.resources import files
from typing import Final

import numpy as np

from trunnion.reporting.column_encoding import COMPRESSION_LEVEL, encode_column
from trunnion.reporting.html_plots import script_json
from trunnion.reporting.html_text import escape, source_hash
from trunnion.viewer.content import ViewContent

_WEB: Final = files("trunnion.viewer") / "web"

#: In an order in which each needs only those before it.
MODULES: Final = ("texts", "data", "kinematics", "program", "space", "listing", "curves", "main")

_IMPORT: Final = re.compile(r"^import .*;\n", re.MULTILINE)
_EXPORT: Final = re.compile(r"^export ", re.MULTILINE)


def render_view(content: ViewContent, *, embedded: bool) -> Iterator[bytes]:
    """Yield the page; ``embedded``: with columns and texts in it, so that it works offline."""
    style, library, script = _style(), _library(), _script()
    sources = f"{source_hash(library)} {source_hash(script)}"
    policy = (
        f"default-src 'none'; script-src {sources}; style-src {source_hash(style)}; img-src data: blob:; "
        f"connect-src 'self'; base-uri 'none'; form-action 'none'"
    )
    types = {name: "f" if column.dtype == np.float32 else "i" for name, column in content.columns.items()}
    body = (_WEB / "body.html").read_text(encoding="utf-8").replace(
        'id="title"></h1>', f'id="title">{escape(content.scene["title"])}</h1>'
    )  # fmt: skip
    yield f"""<!DOCTYPE html>
<html lang="en" data-embedded="{str(embedded).lower()}">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(content.scene["title"])}</title>
<style>{style}</style>
</head>
<body>
{body}
<script type="application/json" id="scene">{script_json({**content.scene, "columns": types})}</script>
""".encode()
    if embedded:
        for name, column in content.columns.items():
            yield f'<script type="text/plain" id="column-{name}">'.encode() + encode_column(column) + b"</script>\n"
        for k, text in enumerate(content.texts):
            packed = base64.b64encode(zlib.compress(text, COMPRESSION_LEVEL))
            yield f'<script type="text/plain" id="text-{k}">'.encode() + packed + b"</script>\n"
    yield f"<script>{library}</script>\n<script>{script}</script>\n</body>\n</html>\n".encode()


def _style() -> str:
    return "\n" + (_WEB / "style.css").read_text(encoding="utf-8")


def _library() -> str:
    """The library that draws, preceded by its licence."""
    licence = (_WEB / "vendor" / "LICENSE-three").read_text(encoding="utf-8").strip()
    return f"\n/*\n{licence}\n*/\n" + (_WEB / "vendor" / "three.iife.min.js").read_text(encoding="utf-8")


def _script() -> str:
    """The modules as one script: their imports name only one another."""
    unpack = files("trunnion.reporting").joinpath("unpack.js").read_text(encoding="utf-8")
    modules = (_WEB.joinpath(f"{name}.js").read_text(encoding="utf-8") for name in MODULES)
    return (
        "\n" + unpack + "(() => {\n" + "".join(_EXPORT.sub("", _IMPORT.sub("", text)) for text in modules) + "})();\n"
    )
