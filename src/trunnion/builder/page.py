"""The page of the builder.

In:     what it begins with.
Out:    UTF-8 HTML.
"""

from collections.abc import Mapping
from importlib.resources import files
from typing import Any, Final

from trunnion.viewer.shell import PageShell, bundle

_WEB: Final = files("trunnion.builder") / "web"
_VIEWER: Final = files("trunnion.viewer") / "web"

#: In an order in which each needs only those before it.
MODULES: Final = ("texts", "stage", "form", "editor", "edits", "jog", "sample", "main")


def render_builder(start: Mapping[str, Any]) -> bytes:
    """Return the page; ``start`` is what ``BuilderSession.start`` gives."""
    kinematics = (_VIEWER / "kinematics.js").read_text(encoding="utf-8")
    modules = ((_WEB / f"{name}.js").read_text(encoding="utf-8") for name in MODULES)
    style, body = ((_WEB / name).read_text(encoding="utf-8") for name in ("style.css", "body.html"))
    shell = PageShell(str(start["title"]), "\n" + style, body, bundle((kinematics, *modules)))
    return shell.head(start, embedded=False) + shell.foot()
