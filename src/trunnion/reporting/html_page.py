"""A report as one HTML page that needs nothing else: no network, no other file.

In:     ``ReportContent`` and ``PlotSeries``.
Out:    UTF-8 HTML, piece by piece: words and tables, then scripts, then columns from coarse to fine.

Nothing that came from outside is ever part of a script or of an attribute without quotes: tables hold it escaped, the
scripts read it as JSON from an element of its own, and the page's own policy lets only our scripts run, by their hash.
"""

import base64
import hashlib
import html
import json
import math
from collections.abc import Iterator, Sequence
from importlib.resources import files

from trunnion.machines.motion_time import format_duration
from trunnion.reporting.column_encoding import encode_column
from trunnion.reporting.content import (
    AxisExtent,
    BlockReference,
    Extremes,
    OperationUsage,
    ReportContent,
    TipExtent,
    ToolUsage,
)
from trunnion.reporting.plot_series import (
    BUCKETS_IN_VIEW,
    MAX_DIRECT_POINTS,
    Curve,
    DetailLevel,
    Plot,
    PlotSeries,
    detail_levels,
    select_rows,
)
from trunnion.verification.results import Check, Place

#: Places that the page shows of each check; the JSON report has all of them.
MAX_PLACES = 12

#: Tool changes that the plots mark; more of them would be a grey wall.
MAX_TOOL_MARKS = 100

#: What the dotted lines are, where there are any.
FLOATING_NOTE = """ Dotted ones are as far apart as the limits of the slide, but stand around the motion: where the
limits really are is not known, because the machine's definition has no workpiece zero."""

_ASSETS = files("trunnion.reporting")


def render_page(content: ReportContent, series: PlotSeries) -> Iterator[bytes]:
    """Yield the page, piece by piece."""
    levels = list(detail_levels(series))
    scripts = (_read_vendored("uPlot.iife.min.js"), _read_asset("page.js"))
    yield _head(content, scripts).encode()
    yield _body(content).encode()
    yield _plots(content, series, levels).encode()
    if levels:
        yield from _columns("coarse", select_rows(series, levels[0].rows))
    for script in scripts:
        yield f"<script>{script}</script>\n".encode()
    for level in levels[1:]:
        yield _column(f"level-{level.buckets}", encode_column(level.rows.astype("int32")))
    yield from _columns("full", series)
    yield b"</body>\n</html>\n"


def escape(value: object) -> str:
    """Return text for HTML: escaped, also for attributes in double quotes."""
    return html.escape(str(value), quote=True)


def _read_asset(name: str) -> str:
    return "\n" + _ASSETS.joinpath(name).read_text(encoding="utf-8")


def _read_vendored(name: str) -> str:
    """Return a file of the plot library, with its licence before it."""
    vendor = _ASSETS.joinpath("vendor")
    licence = vendor.joinpath("LICENSE").read_text(encoding="utf-8").strip()
    return f"\n/*\n{licence}\n*/\n" + vendor.joinpath(name).read_text(encoding="utf-8")


def _head(content: ReportContent, scripts: Sequence[str]) -> str:
    style = _read_vendored("uPlot.min.css") + _read_asset("page.css")
    sources = " ".join(_hash(script) for script in scripts)
    policy = f"default-src 'none'; script-src {sources}; style-src {_hash(style)}; base-uri 'none'; form-action 'none'"
    verdict = "passed" if content.passed else "FAILED"
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{escape(content.program)}: {verdict}</title>
<style>{style}</style>
</head>
"""


def _hash(source: str) -> str:
    return "'sha256-" + base64.b64encode(hashlib.sha256(source.encode()).digest()).decode() + "'"


# ---------------------------------------------------------------------------------------------------------------------
# Words and tables


def _body(content: ReportContent) -> str:
    tables = (_operation_table(content), _tool_table(content), _decisions(content), _extents(content))
    parts = (_title(content), _checks(content.checks), _worst_places(content.checks), *tables)
    return "<body>\n<main>\n" + "".join(parts)


def _title(content: ReportContent) -> str:
    failed = sum(not check.passed for check in content.checks)
    count = len(content.checks)
    if not content.passed:
        mark, word, more = "✗", "Failed", f"{failed} of {_count(count, 'check')}; the program must not run as it is"
    elif count:
        mark, word, more = "✓", "Passed", f"{_count(count, 'check')}, all passed"
    else:
        mark, word, more = "–", "Nothing checked", ""
    state = "bad" if not content.passed else "good" if count else "none"
    items = [
        ("Machine", content.machine),
        ("Control", content.control),
        ("Motions", f"{content.motions:,}".replace(",", "\u202f")),
        ("Time", format_duration(content.seconds)),
        ("in cuts", format_duration(content.cutting_seconds)),
        ("in rapids", format_duration(content.rapid_seconds)),
        ("Made", content.made),
    ]
    entries = "".join(
        f"<div><dt>{name}</dt><dd><bdi>{escape(value)}</bdi></dd></div>" for name, value in items if value
    )
    untimed = (
        f'<p class="note">{_count(content.untimed, "motion")} without a known time.</p>' if content.untimed else ""
    )
    return f"""<header>
<div class="verdict {state}"><span class="mark" aria-hidden="true">{mark}</span><div><strong>{word}</strong>
<span>{more}</span></div></div>
<h1><bdi>{escape(content.program)}</bdi></h1>
<dl>{entries}</dl>
{untimed}</header>
"""


def _checks(checks: Sequence[Check]) -> str:
    if not checks:
        return ""
    rows = [
        f'<tr class="{"good" if check.passed else "bad"}">'
        f"<td>{_result(check)}</td><th scope=row>{_capitalised(check.title)}</th>"
        f"<td class=n>{_with_unit(check.worst, check.unit)}</td><td class=n>{_with_unit(check.limit, check.unit)}</td>"
        f"<td>{escape(check.summary)}</td></tr>"
        for check in checks
    ]
    return _section("Checks", _table(("Result", "Check", "#Worst", "#Limit", "Summary"), rows, "tight"))


def _result(check: Check) -> str:
    return '<span class="tag">✓ passed</span>' if check.passed else '<span class="tag">✗ failed</span>'


def _worst_places(checks: Sequence[Check]) -> str:
    """Worst places, failed checks first."""
    tables = [_check_places(check) for check in sorted(checks, key=lambda check: check.passed) if check.places]
    return _section("Worst places", "".join(tables)) if tables else ""


def _check_places(check: Check) -> str:
    rows = [
        f"<tr><td class=n>{format_number(place.value)}</td>"
        f"<td class=n>{_number(place.number)}</td><td class=n>{place.nc_line}</td><td class=n>{_cl_line(place)}</td>"
        f"<td>{escape(place.text)}</td>"
        f'<td class=go><button type=button data-line="{place.nc_line}" data-cl="{place.cl_line}">plot</button></td>'
        "</tr>"
        for place in check.places[:MAX_PLACES]
    ]
    more = len(check.places) - MAX_PLACES
    note = f'<p class="note">and {more} more, in the JSON report</p>' if more > 0 else ""
    headings = ("#Value", "#Block", "#NC line", "#CL line", "What", "-")
    state = "good" if check.passed else "bad"
    return (
        f'<h3 class="{state}">{_result(check)} {_capitalised(check.title)}</h3>{_table(headings, rows, "tight")}{note}'
    )


def _cl_line(place: Place) -> str:
    if not place.cl_line:
        return ""
    return f'<span title="{escape(place.cl_file)}">{place.cl_line}</span>' if place.cl_file else str(place.cl_line)


def _tool_table(content: ReportContent) -> str:
    rows = [_tool(tool) for tool in content.tools]
    headings = ("Tool", "#Motions", "#Time", "#in cuts", "#in rapids", "#S rev/min", "#F mm/min", "#From")
    return _section("Tools and times", _table(headings, rows)) if rows else ""


def _tool(tool: ToolUsage) -> str:
    name = f"<bdi>{escape(tool.name)}</bdi>" if tool.name else "<em>before the first tool</em>"
    return (
        f"<tr><th scope=row>{name}</th><td class=n>{tool.motions}</td><td class=n>{format_duration(tool.seconds)}</td>"
        f"<td class=n>{format_duration(tool.cutting_seconds)}</td>"
        f"<td class=n>{format_duration(tool.rapid_seconds)}</td>"
        f"<td class=n>{_range(tool.rpm)}</td><td class=n>{_range(tool.feed)}</td>"
        f"<td class=n>{_block(tool.first)}</td></tr>"
    )


def _operation_table(content: ReportContent) -> str:
    rows = [_operation(operation) for operation in content.operations]
    headings = ("Operation", "Tool", "#Motions", "#Time", "#in cuts", "#in rapids", "#From")
    return _section("Operations and times", _table(headings, rows)) if rows else ""


def _operation(operation: OperationUsage) -> str:
    first = _block(operation.first) if operation.first else ""
    return (
        f'<tr><th scope=row title="{escape(operation.cl_file)}"><bdi>{escape(operation.name)}</bdi></th>'
        f"<td><bdi>{escape(operation.tool)}</bdi></td><td class=n>{operation.motions}</td>"
        f"<td class=n>{format_duration(operation.seconds)}</td>"
        f"<td class=n>{format_duration(operation.cutting_seconds)}</td>"
        f"<td class=n>{format_duration(operation.rapid_seconds)}</td><td class=n>{first}</td></tr>"
    )


def _decisions(content: ReportContent) -> str:
    """Why it was planned so."""
    rows = [
        f"<tr><td><bdi>{escape(decision.operation)}</bdi></td>"
        f'<td class=n title="{escape(decision.cl_file)}">{decision.cl_line or ""}</td>'
        f"<td>{escape(decision.about)}</td><td>{escape(decision.text)}</td></tr>"
        for decision in content.decisions
    ]
    headings = ("Operation", "#CL line", "About", "Decision and why")
    return _section("Decisions", _table(headings, rows, "tight")) if rows else ""


def _extents(content: ReportContent) -> str:
    axes = [_axis(axis) for axis in content.axes]
    tips = [_tip(extent) for extent in content.tip]
    headings = ("Axis", "#From", "at", "#To", "at", "#Limits", "#Margin")
    tip_heads = ("Tip, mm", "#From", "at", "#To", "at", "#In cuts from", "#to")
    return _section("Extents", f'<div class="pair">{_table(headings, axes)}{_table(tip_heads, tips)}</div>')


def _axis(axis: AxisExtent) -> str:
    limits = "endless" if axis.endless else "not stated"
    if not axis.endless and (axis.low_limit is not None or axis.high_limit is not None):
        limits = f"{_limit(axis.low_limit)} … {_limit(axis.high_limit)}"
    if not axis.has_known_zero and axis.low_limit is not None and axis.high_limit is not None:
        limits = f"travel {format_number(axis.high_limit - axis.low_limit)}"
    state = "bad" if axis.margin is not None and axis.margin < 0.0 else ""
    margin = "" if axis.margin is None else f"{axis.margin:.3f}".replace("-", "−")
    name = f"{escape(axis.name)} <small>{axis.unit}</small>"
    return (
        f'<tr class="{state}"><th scope=row>{name}</th>{_extremes(axis.extremes)}'
        f"<td class=n>{limits}</td><td class=n><strong>{margin}</strong></td></tr>"
    )


def _tip(extent: TipExtent) -> str:
    cutting = extent.cutting
    cuts = (_format_fixed(cutting.low), _format_fixed(cutting.high)) if cutting else ("", "")
    return (
        f"<tr><th scope=row>{extent.name}</th>{_extremes(extent.whole)}"
        f"<td class=n>{cuts[0]}</td><td class=n>{cuts[1]}</td></tr>"
    )


def _extremes(extremes: Extremes | None) -> str:
    if extremes is None:
        return "<td></td>" * 4
    ends = ((extremes.low, extremes.low_at), (extremes.high, extremes.high_at))
    return "".join(f"<td class=n>{_format_fixed(value)}</td><td class=at>{_block(block)}</td>" for value, block in ends)


def _section(title: str, body: str) -> str:
    return f"<section>\n<h2>{title}</h2>\n{body}\n</section>\n"


def _table(headings: Sequence[str], rows: Sequence[str], kind: str = "") -> str:
    """Return a table; a head that begins with # is of a column of numbers, and - has none."""
    cells = "".join(
        f"<th scope=col class=n>{head[1:]}</th>" if head[0] == "#" else f"<th scope=col>{head.strip('-')}</th>"
        for head in headings
    )
    body = "\n".join(rows)
    head = f"<thead><tr>{cells}</tr></thead>"
    return f'<div class="wide {kind}"><table>\n{head}\n<tbody>\n{body}\n</tbody></table></div>\n'


# ---------------------------------------------------------------------------------------------------------------------
# Numbers for people


def format_number(value: float | None) -> str:
    """Return a number with four digits that count, never as a power of ten where it can be helped.

    >>> format_number(0.00123456), format_number(12345.6), format_number(-0.5), format_number(None), format_number(3e-9)
    ('0.001235', '12346', '−0.5', '', '3e−09')
    """
    if value is None or math.isnan(value):
        return ""
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    size = abs(value)
    if size == 0.0 or 1e-5 <= size < 1e9:
        decimals = max(0, 3 - math.floor(math.log10(size))) if size else 0
        digits = f"{value:.{decimals}f}"
        digits = digits.rstrip("0").rstrip(".") if "." in digits else digits
    else:
        digits = f"{value:.3g}"
    return digits.replace("-", "−")


def _format_fixed(value: float) -> str:
    return f"{value:.3f}".replace("-0.000", "0.000").replace("-", "−")


def _limit(value: float | None) -> str:
    return "no limit" if value is None else format_number(value)


def _with_unit(value: float | None, unit: str) -> str:
    digits = format_number(value)
    return f"{digits} <small>{escape('°' if unit == 'deg' else unit)}</small>" if digits and unit else digits


def _capitalised(title: str) -> str:
    return escape(title[:1].upper() + title[1:])


def _range(values: tuple[float, float] | None) -> str:
    if values is None:
        return ""
    low, high = map(format_number, values)
    return low if low == high else f"{low} … {high}"


def _number(number: int) -> str:
    return f"N{number}" if number >= 0 else ""


def _block(block: BlockReference) -> str:
    """Return a block by its number, else by its line."""
    place = _number(block.number) or f"line {block.nc_line}"
    line = f"{block.file}:{block.nc_line}" if block.file else f"line {block.nc_line}"
    return f'<span title="{escape(line)}">{place}</span>'


def _count(count: int, thing: str) -> str:
    return f"{count} {thing}" + ("" if count == 1 else "s")


# ---------------------------------------------------------------------------------------------------------------------
# Plots


def _plots(content: ReportContent, series: PlotSeries, levels: Sequence[DetailLevel]) -> str:
    if not content.motions:
        return "</main>\n"
    time = series.time()
    marks = [[float(time[row]), name] for row, name in series.tool_changes[:MAX_TOOL_MARKS]]
    spec = {
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
        "marks": marks,
    }
    floating = any(line.floating for plot in series.plots for line in plot.lines)
    return f"""<section id="plots">
<h2>Axes, speeds and feed over {"time" if series.timed else "motions: no times are known"}</h2>
<p class="note">Drag over a stretch to zoom in, double-click for the whole program; click a point to hold it, Escape
lets go. Red lines are limits.{FLOATING_NOTE if floating else ""}</p>
<div id="bar">
<div id="point"><span class="hint">Loading …</span></div>
<div id="buttons"><button type=button data-act="left" title="earlier">◀</button>
<button type=button data-act="out" title="zoom out">−</button>
<button type=button data-act="in" title="zoom in">+</button>
<button type=button data-act="right" title="later">▶</button>
<button type=button data-act="whole">whole program</button>
<label><input type=checkbox id="fit"> fit heights to the motion</label></div>
</div>
<div id="strips"></div>
<p class="note" id="status"></p>
<noscript><p class="note">The plots need JavaScript, which this browser has switched off.</p></noscript>
</section>
</main>
<script type="application/json" id="report">{script_json(spec)}</script>
"""


def script_json(value: object) -> str:
    """Return JSON that may stand inside a script element whatever its texts say."""
    plain = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return plain.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _plot(plot: Plot) -> dict[str, object]:
    lines = [_line(line) for line in plot.lines]
    return {"title": plot.title, "unit": plot.unit, "step": plot.step, "note": plot.note, "lines": lines}


def _line(line: Curve) -> dict[str, object]:
    limits = {"limits": list(line.limits), "limitName": line.limit_name, "loose": line.floating}
    return {"column": line.column, "name": line.name, **limits}


def _columns(group: str, series: PlotSeries) -> Iterator[bytes]:
    """Yield the columns of a series as elements that the script finds by id."""
    if len(series) < 2:
        return
    for name, column in {"seconds": series.seconds, **series.values}.items():
        yield _column(f"{group}-{name}", encode_column(column))
    for name, numbers in series.lines.items():
        yield _column(f"{group}-{name}", encode_column(numbers))


def _column(name: str, packed: bytes) -> bytes:
    return b'<script type="text/plain" id="' + name.encode() + b'">' + packed + b"</script>\n"
