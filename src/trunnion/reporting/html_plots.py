"""The plots of the HTML page: the section they are drawn in, their specification, and their columns.

In:     ``PlotSeries`` and its levels of detail.
Out:    HTML. page.js draws the plots from it.
"""

import json
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from trunnion.reporting.column_encoding import encode_column
from trunnion.reporting.detail_levels import BUCKETS_IN_VIEW, MAX_DIRECT_POINTS, DetailLevel
from trunnion.reporting.html_text import escape
from trunnion.reporting.plot_series import Curve, Plot, PlotSeries

#: Tool changes marked in the plots; more of them would be a grey wall.
MAX_TOOL_MARKS = 100

#: Explains the dotted lines, if there are any.
FLOATING_NOTE = """ Dotted ones are as far apart as the limits of the linear axis, but stand around the motion: where
the limits really are is not known: no workpiece zero is given, or for a linear axis along the tool no tool length."""


def plot_section(series: PlotSeries, levels: Sequence[DetailLevel]) -> str:
    """Return the section of the plots of a program, or of a recording; empty without motion."""
    if len(series) < 2:
        return ""
    own = element_prefix(series)
    curves = [curve for plot in series.plots for curve in plot.curves]
    floating = any(curve.floating for curve in curves)
    limits = " Red lines are limits." if any(curve.limits for curve in curves) else ""
    title = series.title or f"Axes, speeds and feed over {'time' if series.timed else 'motions: no times are known'}"
    whole = "whole recording" if series.name else "whole program"
    return f"""<section id="{own}plots" class="plots">
<h2>{escape(title)}</h2>
<p class="note">Drag over a stretch to zoom in, double-click for the {whole}; click a point to hold it, Escape
lets go.{limits}{FLOATING_NOTE if floating else ""} {escape(series.note)}</p>
<div id="{own}bar" class="bar">
<div id="{own}point" class="point"><span class="hint">Loading …</span></div>
<div class="buttons"><button type=button data-act="left" title="earlier">◀</button>
<button type=button data-act="out" title="zoom out">−</button>
<button type=button data-act="in" title="zoom in">+</button>
<button type=button data-act="right" title="later">▶</button>
<button type=button data-act="whole">{whole}</button>
<label><input type=checkbox id="{own}fit"> fit heights to the motion</label></div>
</div>
<div id="{own}strips"></div>
<p class="note" id="{own}status"></p>
<noscript><p class="note">The plots need JavaScript, which this browser has switched off.</p></noscript>
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
        "marks": [[float(time[row]), name] for row, name in series.tool_changes[:MAX_TOOL_MARKS]],
        "markWord": "" if series.name else "T",
        "first": "" if series.name else "before the first motion",
    }


def script_json(value: object) -> str:
    """Return JSON that is safe inside a script element, whatever text it holds."""
    plain = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return plain.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _plot(plot: Plot) -> dict[str, object]:
    lines = [_curve(curve) for curve in plot.curves]
    return {"title": plot.title, "unit": plot.unit, "step": plot.step, "note": plot.note, "lines": lines}


def _curve(curve: Curve) -> dict[str, object]:
    limits = {"limits": list(curve.limits), "limitName": curve.limit_name, "loose": curve.floating}
    return {"column": curve.column, "name": curve.name, **limits}


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
