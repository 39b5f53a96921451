"""The plots of the HTML page: the section they are drawn in, their specification, and their columns.

In:     ``PlotSeries`` and its levels of detail.
Out:    HTML. page.js draws the plots from it.
"""

import json
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trunnion.reporting.column_encoding import encode_column
from trunnion.reporting.detail_levels import BUCKETS_IN_VIEW, MAX_DIRECT_POINTS, DetailLevel
from trunnion.reporting.html_text import escape
from trunnion.reporting.page_words import label, said_on_page, told
from trunnion.reporting.plot_series import Curve, Plot, PlotSeries

#: Tool changes marked in the plots; more of them would be a grey wall.
MAX_TOOL_MARKS = 100

#: Words that page.js says.
_PLOT_WORDS: Final = (
    "point_at", "held", "time", "motion", "block", "nc_line", "in_file", "cl_line", "travel", "moves_nothing",
    "old_browser", "not_drawn",
)  # fmt: skip


def plot_section(series: PlotSeries, levels: Sequence[DetailLevel]) -> str:
    """Return the section of the plots of a program, or of a recording; empty without motion."""
    if len(series) < 2:
        return ""
    own = element_prefix(series)
    curves = [curve for plot in series.plots for curve in plot.curves]
    floating = any(curve.floating for curve in curves)
    limits = label("red_lines") if any(curve.limits for curve in curves) else ""
    over = label("plots_over_time") if series.timed else label("plots_over_motions")
    title = said_on_page(series.title) if series.title else over
    whole = label("whole_recording") if series.name else label("whole_program")
    notes = " ".join(filter(None, (label("how_to_zoom", whole=whole), limits, label("dotted") if floating else "")))
    return f"""<section id="{own}plots" class="plots">
<h2>{escape(title)}</h2>
<p class="note">{escape(notes)} {escape(said_on_page(series.note)) if series.note else ""}</p>
<div id="{own}bar" class="bar">
<div id="{own}point" class="point"><span class="hint">{escape(label("loading"))}</span></div>
<div class="buttons"><button type=button data-act="left" title="{escape(label("earlier"))}">◀</button>
<button type=button data-act="out" title="{escape(label("zoom_out"))}">−</button>
<button type=button data-act="in" title="{escape(label("zoom_in"))}">+</button>
<button type=button data-act="right" title="{escape(label("later"))}">▶</button>
<button type=button data-act="whole">{escape(whole)}</button>
<label><input type=checkbox id="{own}fit"> {escape(label("fit_heights"))}</label></div>
</div>
<div id="{own}strips"></div>
<p class="note" id="{own}status"></p>
<noscript><p class="note">{escape(label("needs_javascript"))}</p></noscript>
</section>
<script type="application/json" id="{own}report">{script_json(_specification(series, levels))}</script>
"""


def element_prefix(series: PlotSeries) -> str:
    """Return what the ids of the elements of a section begin with."""
    return f"{series.name}-" if series.name else ""


def _specification(series: PlotSeries, levels: Sequence[DetailLevel]) -> dict[str, object]:
    """Return what page.js needs to know besides the columns."""
    time = series.time()
    return {
        "points": len(series),
        "total": float(time[-1]),
        "timed": series.timed,
        "direct": MAX_DIRECT_POINTS,
        "inView": BUCKETS_IN_VIEW,
        "levels": [level.buckets for level in levels],
        "values": list(series.values),
        "lines": list(series.lines),
        "files": list(series.files) if "file" in series.lines else [],
        "plots": [_plot(plot) for plot in series.plots],
        "marks": [
            [float(time[row]), name if isinstance(name, str) else told(name)]
            for row, name in series.tool_changes[:MAX_TOOL_MARKS]
        ],
        "markWord": "" if series.name else "T",
        "first": "" if series.name else label("before_first_motion"),
        "words": {name: label(f"plot_{name}") for name in _PLOT_WORDS},
    }


def script_json(value: object) -> str:
    """Return JSON that is safe inside a script element, whatever text it holds."""
    plain = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return plain.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _plot(plot: Plot) -> dict[str, object]:
    lines = [_curve(curve) for curve in plot.curves]
    note = said_on_page(plot.note) if plot.note else ""
    return {"title": said_on_page(plot.title), "unit": plot.unit, "step": plot.step, "note": note, "lines": lines}


def _curve(curve: Curve) -> dict[str, object]:
    name = said_on_page(curve.limit_name) if curve.limit_name else ""
    limits = {"limits": list(curve.limits), "limitName": name, "loose": curve.floating}
    return {"column": curve.column, "name": said_on_page(curve.name), **limits}


def column_elements(group: str, series: PlotSeries) -> Iterator[bytes]:
    """Yield the columns of a series as elements with ids that begin with ``group``."""
    if len(series) < 2:
        return
    for name, column in {"seconds": series.seconds, **series.values}.items():
        yield column_element(f"{element_prefix(series)}{group}-{name}", column)
    for name, numbers in series.lines.items():
        yield column_element(f"{element_prefix(series)}{group}-{name}", numbers)


def column_element(name: str, column: NDArray[np.float32] | NDArray[np.int32]) -> bytes:
    """Return a column as an element with an id, for page.js to decode."""
    return b'<script type="text/plain" id="' + name.encode() + b'">' + encode_column(column) + b"</script>\n"
