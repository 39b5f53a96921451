"""A report as one HTML page that needs nothing else: no network, no other file.

In:     ``ReportContent`` and ``PlotSeries``.
Out:    UTF-8 HTML, piece by piece: words and tables, then scripts, then columns from coarse to fine.

Text from outside never becomes part of a script or of an attribute without quotes. Tables hold it escaped, the scripts
read it as JSON from an element of its own, and the page's content security policy lets only our scripts run, by their
hash.
"""

from collections.abc import Iterator, Sequence
from importlib.resources import files

import numpy as np

from trunnion.messages import LIBRARY, Words
from trunnion.reporting.content import ReportContent
from trunnion.reporting.detail_levels import detail_levels, select_rows
from trunnion.reporting.html_plots import column_element, column_elements, element_prefix, plot_section
from trunnion.reporting.html_tables import page_body
from trunnion.reporting.html_text import page_head, source_hash
from trunnion.reporting.page_words import in_language, verdict_word
from trunnion.reporting.plot_series import PlotSeries

_ASSETS = files("trunnion.reporting")


def render_page(content: ReportContent, series: PlotSeries, words: Words = LIBRARY) -> Iterator[bytes]:
    """Yield the page in the language of who asks, piece by piece."""
    parts = [series] if content.recorded is None else [content.recorded.series, series]
    with in_language(words):
        title = f"{content.program}: {verdict_word(content.verdict).lower()}"
        body = page_body(content)
    yield from plot_page(title, body, parts, words, command=content.command, pictures=content.simulation is not None)


def plot_page(
    title: str, body: str, parts: Sequence[PlotSeries], words: Words = LIBRARY, *, command: str, pictures: bool = False
) -> Iterator[bytes]:
    """Yield a page with plots, piece by piece.

    title     of the window
    body      HTML from the body tag, with ``main`` open, up to the plots
    parts     what is plotted, each in a section of its own
    words     of who asks
    command   that makes it
    pictures  the body has pictures
    """
    levels = [list(detail_levels(part)) for part in parts]
    scripts = (_read_vendored("uPlot.iife.min.js"), _read_asset("unpack.js") + _read_asset("page.js"))
    with in_language(words):
        head = _head(title, scripts, pictures, command)
        sections = [plot_section(part, own) for part, own in zip(parts, levels, strict=True)]
    yield head.encode()
    yield body.encode()
    for section in sections:
        yield section.encode()
    yield b"</main>\n"
    for part, own in zip(parts, levels, strict=True):
        if own:
            yield from column_elements("coarse", select_rows(part, own[0].rows))
    for script in scripts:
        yield f"<script>{script}</script>\n".encode()
    for part, own in zip(parts, levels, strict=True):
        for level in own[1:]:
            name = f"{element_prefix(part)}level-{level.buckets}"
            yield column_element(name, level.rows.astype(np.int32))
        yield from column_elements("full", part)
    yield b"</body>\n</html>\n"


def _read_asset(name: str) -> str:
    """Return a file of our own."""
    return "\n" + _ASSETS.joinpath(name).read_text(encoding="utf-8")


def _read_vendored(name: str) -> str:
    """Return a file of the plot library, preceded by its licence."""
    vendor = _ASSETS.joinpath("vendor")
    licence = vendor.joinpath("LICENSE").read_text(encoding="utf-8").strip()
    return f"\n/*\n{licence}\n*/\n" + vendor.joinpath(name).read_text(encoding="utf-8")


def _head(title: str, scripts: Sequence[str], pictures: bool, command: str) -> str:
    """Return the head of the page, with its style and a policy that allows only ``scripts``."""
    style = _read_vendored("uPlot.min.css") + _read_asset("page.css")
    sources = " ".join(source_hash(script) for script in scripts)
    images = "img-src data:; " if pictures else ""
    allowed = f"script-src {sources}; style-src {source_hash(style)}; {images}"
    policy = f"default-src 'none'; {allowed}base-uri 'none'; form-action 'none'"
    return page_head(title, style, policy, command)
