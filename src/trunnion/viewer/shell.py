"""What every page of ours has: one style, the library that draws, and one script, each named by its hash.

Text from outside is JSON in an element of its own, never part of a script; the content security policy lets only our
script and the vendored library run, by their hashes.
"""

import re
from collections.abc import Iterable, Mapping
from importlib.resources import files
from typing import Final

from trunnion.records import dataclass
from trunnion.reporting.html_plots import script_json
from trunnion.reporting.html_text import escape, made_by, source_hash
from trunnion.viewer.language import language_tag

_WEB: Final = files("trunnion.viewer") / "web"

_IMPORT: Final = re.compile(r"^import .*;\n", re.MULTILINE)
_EXPORT: Final = re.compile(r"^export ", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class PageShell:
    """A page around its data.

    title     of the browser's window
    style     CSS
    body      HTML of our own
    script    of ``bundle``
    language  that it speaks, of ``LANGUAGES``
    texts     what it says in that language, by the keys of its body and its script
    command   that makes it
    """

    title: str
    style: str
    body: str
    script: str
    language: str
    texts: Mapping[str, str]
    command: str

    def head(self, data: object, *, embedded: bool) -> bytes:
        """All up to the data, which is JSON in the element ``scene``; ``embedded``: more of it follows in the page."""
        sources = f"{source_hash(_library())} {source_hash(self.script)}"
        policy = (
            f"default-src 'none'; script-src {sources}; style-src {source_hash(self.style)}; img-src data: blob:; "
            f"connect-src 'self'; base-uri 'none'; form-action 'none'"
        )
        return f"""<!DOCTYPE html>
<html lang="{language_tag(self.language)}" data-embedded="{str(embedded).lower()}">
<head>
<meta charset="utf-8">
{made_by(self.command)}
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(self.title)}</title>
<style>{self.style}</style>
</head>
<body>
{self.body}
<script type="application/json" id="texts">{script_json(self.texts)}</script>
<script type="application/json" id="scene">{script_json(data)}</script>
""".encode()

    def foot(self) -> bytes:
        """All after the data."""
        return f"<script>{_library()}</script>\n<script>{self.script}</script>\n</body>\n</html>\n".encode()


def bundle(modules: Iterable[str], before: str = "") -> str:
    """Our modules as one script, each after those that it needs: their imports name only one another."""
    return (
        "\n" + before + "(() => {\n" + "".join(_EXPORT.sub("", _IMPORT.sub("", text)) for text in modules) + "})();\n"
    )


def _library() -> str:
    """Return the library that draws, preceded by its licence."""
    licence = (_WEB / "vendor" / "LICENSE-three").read_text(encoding="utf-8").strip()
    return f"\n/*\n{licence}\n*/\n" + (_WEB / "vendor" / "three.iife.min.js").read_text(encoding="utf-8")
