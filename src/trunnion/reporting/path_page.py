"""The path of CL files in space, as one HTML page that needs nothing else: no network, no other file.

In:     ``PathSeries`` of the operations.
Out:    UTF-8 HTML, piece by piece. path_page.js draws it.

Text from outside is JSON in an element of its own, never part of a script (``reporting.html_page``).
"""

from collections.abc import Iterator, Sequence
from importlib.resources import files
from typing import Final

from trunnion.messages import LIBRARY, Words
from trunnion.reporting.html_plots import column_element, script_json
from trunnion.reporting.html_text import escape, page_head, source_hash
from trunnion.reporting.page_words import in_language, label
from trunnion.reporting.path_series import PathSeries

_ASSETS: Final = files("trunnion.reporting")


#: Texts of the page.
_TEXTS: Final = (
    "in_space", "from_top", "from_front", "from_right", "rapids_dashed", "loading", "of_first_operation", "how_to_turn",
    "path_needs_javascript",
)  # fmt: skip


def render_path_page(
    title: str, paths: Sequence[PathSeries], tolerance: float, words: Words = LIBRARY
) -> Iterator[bytes]:
    """Yield the page in the language of who asks, piece by piece.

    title      of the page
    tolerance  how far points that are left out lie off the lines, mm; 0 if none is
    """
    style, script = _asset("path_page.css"), _asset("unpack.js") + _asset("path_page.js")
    allowed = f"script-src {source_hash(script)}; style-src {source_hash(style)}"
    policy = f"default-src 'none'; {allowed}; base-uri 'none'; form-action 'none'"
    with in_language(words):
        head = page_head(title, style, policy, "info")
        said = {name: escape(label(name)) for name in _TEXTS}
        status = _status(sum(len(path.points) for path in paths), tolerance)
    data = {
        "title": title,
        "status": status,
        "operations": [{"name": path.name, "details": path.details, "points": len(path.points)} for path in paths],
    }
    yield f"""{head}<body>
<canvas id="space"></canvas>
<canvas id="marks"></canvas>
<aside>
<h1 id="title"></h1>
<div id="views"><button type=button data-view="space">{said["in_space"]}</button>
<button type=button data-view="top">{said["from_top"]}</button>
<button type=button data-view="front">{said["from_front"]}</button>
<button type=button data-view="right">{said["from_right"]}</button></div>
<label><input type=checkbox id="rapids" checked> <span id="rapid-line"></span> {said["rapids_dashed"]}</label>
<ol id="operations"></ol>
<p id="status">{said["loading"]}</p>
<p>{said["of_first_operation"]}</p>
<p class=hint>{said["how_to_turn"]}</p>
<noscript><p>{said["path_needs_javascript"]}</p></noscript>
</aside>
<script type="application/json" id="data">{script_json(data)}</script>
""".encode()
    for number, path in enumerate(paths):
        for letter, column in zip("xyz", path.points.T, strict=True):
            yield column_element(f"{number}-{letter}", column)
        yield column_element(f"{number}-rapid", path.rapid)
    yield f"<script>{script}</script>\n</body>\n</html>\n".encode()


def _status(points: int, tolerance: float) -> str:
    """Return how much is shown."""
    if not tolerance:
        return label("points_shown", count=points)
    return label("points_shown_within", count=points, tolerance=f"{tolerance:.2g}")


def _asset(name: str) -> str:
    return "\n" + _ASSETS.joinpath(name).read_text(encoding="utf-8")
