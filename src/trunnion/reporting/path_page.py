"""The path of CL files in space, as one HTML page that needs nothing else: no network, no other file.

In:     ``PathSeries`` of the operations.
Out:    UTF-8 HTML, piece by piece. path_page.js draws it.

Text from outside is JSON in an element of its own, never part of a script (``reporting.html_page``).
"""

from collections.abc import Iterator, Sequence
from importlib.resources import files
from typing import Final

from trunnion.reporting.html_plots import column_element, script_json
from trunnion.reporting.html_text import page_head, source_hash
from trunnion.reporting.path_series import PathSeries

_ASSETS: Final = files("trunnion.reporting")


def render_path_page(title: str, paths: Sequence[PathSeries], tolerance: float) -> Iterator[bytes]:
    """Yield the page, piece by piece.

    title      of the page
    tolerance  how far points that are left out lie off the lines, mm; 0 if none is
    """
    style, script = _asset("path_page.css"), _asset("unpack.js") + _asset("path_page.js")
    allowed = f"script-src {source_hash(script)}; style-src {source_hash(style)}"
    policy = f"default-src 'none'; {allowed}; base-uri 'none'; form-action 'none'"
    data = {
        "title": title,
        "tolerance": tolerance,
        "operations": [{"name": path.name, "details": path.details, "points": len(path.points)} for path in paths],
    }
    yield f"""{page_head(title, style, policy)}<body>
<canvas id="space"></canvas>
<canvas id="marks"></canvas>
<aside>
<h1 id="title"></h1>
<div id="views"><button type=button data-view="space">in space</button>
<button type=button data-view="top">from above</button>
<button type=button data-view="front">from the front</button>
<button type=button data-view="right">from the right</button></div>
<label><input type=checkbox id="rapids" checked> <span id="rapid-line"></span> rapids, dashed</label>
<ol id="operations"></ol>
<p id="status">Loading …</p>
<p>Coordinates of the first operation, mm.</p>
<p class=hint>Drag turns, drag with Shift or the right button moves, the wheel zooms.</p>
<noscript><p>The path needs JavaScript, which this browser has switched off.</p></noscript>
</aside>
<script type="application/json" id="data">{script_json(data)}</script>
""".encode()
    for number, path in enumerate(paths):
        for letter, column in zip("xyz", path.points.T, strict=True):
            yield column_element(f"{number}-{letter}", column)
        yield column_element(f"{number}-rapid", path.rapid)
    yield f"<script>{script}</script>\n</body>\n</html>\n".encode()


def _asset(name: str) -> str:
    return "\n" + _ASSETS.joinpath(name).read_text(encoding="utf-8")
