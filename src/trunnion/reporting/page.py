"""A report as one HTML page that needs nothing else: no network, no other file.

In:     ``Facts`` and ``Series``.
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

from trunnion.machines.motion_time import clock
from trunnion.reporting.facts import AxisExtent, Facts, OperationUse, Span, Spot, TipExtent, ToolUse
from trunnion.reporting.pack import pack
from trunnion.reporting.series import DIRECT, IN_VIEW, Level, Line, Plot, Series, levels, rows_of
from trunnion.verification.results import Check, Place

#: Places that the page shows of each check; the JSON report has all of them.
PLACES = 12

#: Tool changes that the plots mark; more of them would be a grey wall.
MARKS = 100

#: What the dotted lines are, where there are any.
LOOSE = """ Dotted ones are as far apart as the limits of the slide, but stand around the motion: where the limits
really are is not known, because the machine's definition has no workpiece zero."""

_HERE = files("trunnion.reporting")


def page(said: Facts, shown: Series) -> Iterator[bytes]:
    """Yield the page, piece by piece."""
    details = list(levels(shown))
    scripts = (_licensed("uPlot.iife.min.js"), _own("page.js"))
    yield _head(said, scripts).encode()
    yield _body(said).encode()
    yield _plots(said, shown, details).encode()
    if details:
        yield from _columns("coarse", rows_of(shown, details[0].rows))
    for script in scripts:
        yield f"<script>{script}</script>\n".encode()
    for level in details[1:]:
        yield _column(f"level-{level.buckets}", pack(level.rows.astype("int32")))
    yield from _columns("full", shown)
    yield b"</body>\n</html>\n"


def text(value: object) -> str:
    """Return text for HTML: escaped, also for attributes in double quotes."""
    return html.escape(str(value), quote=True)


def _own(name: str) -> str:
    return "\n" + _HERE.joinpath(name).read_text(encoding="utf-8")


def _licensed(name: str) -> str:
    """Return a file of the plot library, with its licence before it."""
    vendor = _HERE.joinpath("vendor")
    licence = vendor.joinpath("LICENSE").read_text(encoding="utf-8").strip()
    return f"\n/*\n{licence}\n*/\n" + vendor.joinpath(name).read_text(encoding="utf-8")


def _head(said: Facts, scripts: Sequence[str]) -> str:
    style = _licensed("uPlot.min.css") + _own("page.css")
    sources = " ".join(_hash(script) for script in scripts)
    policy = f"default-src 'none'; script-src {sources}; style-src {_hash(style)}; base-uri 'none'; form-action 'none'"
    verdict = "passed" if said.passed else "FAILED"
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{text(said.program)}: {verdict}</title>
<style>{style}</style>
</head>
"""


def _hash(source: str) -> str:
    return "'sha256-" + base64.b64encode(hashlib.sha256(source.encode()).digest()).decode() + "'"


# ---------------------------------------------------------------------------------------------------------------------
# Words and tables


def _body(said: Facts) -> str:
    tables = (_operation_table(said), _tool_table(said), _decisions(said), _extents(said))
    parts = (_title(said), _checks(said.checks), _worst(said.checks), *tables)
    return "<body>\n<main>\n" + "".join(parts)


def _title(said: Facts) -> str:
    failed = sum(not check.passed for check in said.checks)
    count = len(said.checks)
    if not said.passed:
        mark, word, more = "✗", "Failed", f"{failed} of {_count(count, 'check')}; the program must not run as it is"
    elif count:
        mark, word, more = "✓", "Passed", f"{_count(count, 'check')}, all passed"
    else:
        mark, word, more = "–", "Nothing checked", ""
    state = "bad" if not said.passed else "good" if count else "none"
    items = [
        ("Machine", said.machine),
        ("Control", said.control),
        ("Motions", f"{said.motions:,}".replace(",", "\u202f")),
        ("Time", clock(said.seconds)),
        ("in cuts", clock(said.cutting_seconds)),
        ("in rapids", clock(said.rapid_seconds)),
        ("Made", said.made),
    ]
    shown = "".join(f"<div><dt>{name}</dt><dd><bdi>{text(value)}</bdi></dd></div>" for name, value in items if value)
    untimed = f'<p class="note">{_count(said.untimed, "motion")} without a known time.</p>' if said.untimed else ""
    return f"""<header>
<div class="verdict {state}"><span class="mark" aria-hidden="true">{mark}</span><div><strong>{word}</strong>
<span>{more}</span></div></div>
<h1><bdi>{text(said.program)}</bdi></h1>
<dl>{shown}</dl>
{untimed}</header>
"""


def _checks(checks: Sequence[Check]) -> str:
    if not checks:
        return ""
    rows = [
        f'<tr class="{"good" if check.passed else "bad"}">'
        f"<td>{_result(check)}</td><th scope=row>{_sentence(check.title)}</th>"
        f"<td class=n>{_measure(check.worst, check.unit)}</td><td class=n>{_measure(check.limit, check.unit)}</td>"
        f"<td>{text(check.summary)}</td></tr>"
        for check in checks
    ]
    return _section("Checks", _table(("Result", "Check", "#Worst", "#Limit", "Summary"), rows, "tight"))


def _result(check: Check) -> str:
    return '<span class="tag">✓ passed</span>' if check.passed else '<span class="tag">✗ failed</span>'


def _worst(checks: Sequence[Check]) -> str:
    """Worst places, failed checks first."""
    tables = [_places(check) for check in sorted(checks, key=lambda check: check.passed) if check.places]
    return _section("Worst places", "".join(tables)) if tables else ""


def _places(check: Check) -> str:
    rows = [
        f"<tr><td class=n>{short(place.value)}</td>"
        f"<td class=n>{_number(place.number)}</td><td class=n>{place.nc_line}</td><td class=n>{_cl(place)}</td>"
        f"<td>{text(place.text)}</td>"
        f'<td class=go><button type=button data-line="{place.nc_line}" data-cl="{place.cl_line}">plot</button></td>'
        "</tr>"
        for place in check.places[:PLACES]
    ]
    more = len(check.places) - PLACES
    note = f'<p class="note">and {more} more, in the JSON report</p>' if more > 0 else ""
    heads = ("#Value", "#Block", "#NC line", "#CL line", "What", "-")
    state = "good" if check.passed else "bad"
    return f'<h3 class="{state}">{_result(check)} {_sentence(check.title)}</h3>{_table(heads, rows, "tight")}{note}'


def _cl(place: Place) -> str:
    if not place.cl_line:
        return ""
    return f'<span title="{text(place.cl_file)}">{place.cl_line}</span>' if place.cl_file else str(place.cl_line)


def _tool_table(said: Facts) -> str:
    rows = [_tool(tool) for tool in said.tools]
    heads = ("Tool", "#Motions", "#Time", "#in cuts", "#in rapids", "#S rev/min", "#F mm/min", "#From")
    return _section("Tools and times", _table(heads, rows)) if rows else ""


def _tool(tool: ToolUse) -> str:
    name = f"<bdi>{text(tool.name)}</bdi>" if tool.name else "<em>before the first tool</em>"
    return (
        f"<tr><th scope=row>{name}</th><td class=n>{tool.motions}</td><td class=n>{clock(tool.seconds)}</td>"
        f"<td class=n>{clock(tool.cutting_seconds)}</td><td class=n>{clock(tool.rapid_seconds)}</td>"
        f"<td class=n>{_range(tool.rpm)}</td><td class=n>{_range(tool.feed)}</td>"
        f"<td class=n>{_spot(tool.first)}</td></tr>"
    )


def _operation_table(said: Facts) -> str:
    rows = [_operation(operation) for operation in said.operations]
    heads = ("Operation", "Tool", "#Motions", "#Time", "#in cuts", "#in rapids", "#From")
    return _section("Operations and times", _table(heads, rows)) if rows else ""


def _operation(operation: OperationUse) -> str:
    first = _spot(operation.first) if operation.first else ""
    return (
        f'<tr><th scope=row title="{text(operation.cl_file)}"><bdi>{text(operation.name)}</bdi></th>'
        f"<td><bdi>{text(operation.tool)}</bdi></td><td class=n>{operation.motions}</td>"
        f"<td class=n>{clock(operation.seconds)}</td><td class=n>{clock(operation.cutting_seconds)}</td>"
        f"<td class=n>{clock(operation.rapid_seconds)}</td><td class=n>{first}</td></tr>"
    )


def _decisions(said: Facts) -> str:
    """Why it was planned so."""
    rows = [
        f"<tr><td><bdi>{text(decided.operation)}</bdi></td>"
        f'<td class=n title="{text(decided.cl_file)}">{decided.cl_line or ""}</td>'
        f"<td>{text(decided.about)}</td><td>{text(decided.text)}</td></tr>"
        for decided in said.decisions
    ]
    heads = ("Operation", "#CL line", "About", "Decision and why")
    return _section("Decisions", _table(heads, rows, "tight")) if rows else ""


def _extents(said: Facts) -> str:
    axes = [_axis(axis) for axis in said.axes]
    tips = [_tip(extent) for extent in said.tip]
    heads = ("Axis", "#From", "at", "#To", "at", "#Limits", "#Margin")
    tip_heads = ("Tip, mm", "#From", "at", "#To", "at", "#In cuts from", "#to")
    return _section("Extents", f'<div class="pair">{_table(heads, axes)}{_table(tip_heads, tips)}</div>')


def _axis(axis: AxisExtent) -> str:
    limits = "endless" if axis.endless else "not stated"
    if not axis.endless and (axis.low_limit is not None or axis.high_limit is not None):
        limits = f"{_limit(axis.low_limit)} … {_limit(axis.high_limit)}"
    if not axis.placed and axis.low_limit is not None and axis.high_limit is not None:
        limits = f"travel {short(axis.high_limit - axis.low_limit)}"
    state = "bad" if axis.margin is not None and axis.margin < 0.0 else ""
    margin = "" if axis.margin is None else f"{axis.margin:.3f}".replace("-", "−")
    name = f"{text(axis.name)} <small>{axis.unit}</small>"
    return (
        f'<tr class="{state}"><th scope=row>{name}</th>{_span(axis.span)}'
        f"<td class=n>{limits}</td><td class=n><strong>{margin}</strong></td></tr>"
    )


def _tip(extent: TipExtent) -> str:
    cutting = extent.cutting
    cuts = (_fixed(cutting.low), _fixed(cutting.high)) if cutting else ("", "")
    return (
        f"<tr><th scope=row>{extent.name}</th>{_span(extent.whole)}"
        f"<td class=n>{cuts[0]}</td><td class=n>{cuts[1]}</td></tr>"
    )


def _span(span: Span | None) -> str:
    if span is None:
        return "<td></td>" * 4
    ends = ((span.low, span.low_at), (span.high, span.high_at))
    return "".join(f"<td class=n>{_fixed(value)}</td><td class=at>{_spot(spot)}</td>" for value, spot in ends)


def _section(title: str, inside: str) -> str:
    return f"<section>\n<h2>{title}</h2>\n{inside}\n</section>\n"


def _table(heads: Sequence[str], rows: Sequence[str], kind: str = "") -> str:
    """Return a table; a head that begins with # is of a column of numbers, and - has none."""
    cells = "".join(
        f"<th scope=col class=n>{head[1:]}</th>" if head[0] == "#" else f"<th scope=col>{head.strip('-')}</th>"
        for head in heads
    )
    inside = "\n".join(rows)
    head = f"<thead><tr>{cells}</tr></thead>"
    return f'<div class="wide {kind}"><table>\n{head}\n<tbody>\n{inside}\n</tbody></table></div>\n'


# ---------------------------------------------------------------------------------------------------------------------
# Numbers for people


def short(value: float | None) -> str:
    """Return a number with four digits that count, never as a power of ten where it can be helped.

    >>> short(0.00123456), short(12345.6), short(-0.5), short(None), short(3e-9)
    ('0.001235', '12346', '−0.5', '', '3e−09')
    """
    if value is None or math.isnan(value):
        return ""
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    size = abs(value)
    if size == 0.0 or 1e-5 <= size < 1e9:
        decimals = max(0, 3 - math.floor(math.log10(size))) if size else 0
        shown = f"{value:.{decimals}f}"
        shown = shown.rstrip("0").rstrip(".") if "." in shown else shown
    else:
        shown = f"{value:.3g}"
    return shown.replace("-", "−")


def _fixed(value: float) -> str:
    return f"{value:.3f}".replace("-0.000", "0.000").replace("-", "−")


def _limit(value: float | None) -> str:
    return "no limit" if value is None else short(value)


def _measure(value: float | None, unit: str) -> str:
    shown = short(value)
    return f"{shown} <small>{text('°' if unit == 'deg' else unit)}</small>" if shown and unit else shown


def _sentence(title: str) -> str:
    return text(title[:1].upper() + title[1:])


def _range(values: tuple[float, float] | None) -> str:
    if values is None:
        return ""
    low, high = map(short, values)
    return low if low == high else f"{low} … {high}"


def _number(number: int) -> str:
    return f"N{number}" if number >= 0 else ""


def _spot(spot: Spot) -> str:
    """Return a block by its number, else by its line."""
    place = _number(spot.number) or f"line {spot.nc_line}"
    line = f"{spot.file}:{spot.nc_line}" if spot.file else f"line {spot.nc_line}"
    return f'<span title="{text(line)}">{place}</span>'


def _count(count: int, thing: str) -> str:
    return f"{count} {thing}" + ("" if count == 1 else "s")


# ---------------------------------------------------------------------------------------------------------------------
# Plots


def _plots(said: Facts, shown: Series, details: Sequence[Level]) -> str:
    if not said.motions:
        return "</main>\n"
    time = shown.time()
    marks = [[float(time[row]), name] for row, name in shown.changes[:MARKS]]
    spec = {
        "points": len(shown),
        "total": float(time[-1]),
        "timed": shown.timed,
        "direct": DIRECT,
        "inView": IN_VIEW,
        "levels": [level.buckets for level in details],
        "values": list(shown.values),
        "lines": list(shown.lines),
        "files": list(shown.files) if "file" in shown.lines else [],
        "plots": [_plot(plot) for plot in shown.plots],
        "marks": marks,
    }
    loose = any(line.loose for plot in shown.plots for line in plot.lines)
    return f"""<section id="plots">
<h2>Axes, speeds and feed over {"time" if shown.timed else "motions: no times are known"}</h2>
<p class="note">Drag over a stretch to zoom in, double-click for the whole program; click a point to hold it, Escape
lets go. Red lines are limits.{LOOSE if loose else ""}</p>
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


def _line(line: Line) -> dict[str, object]:
    limits = {"limits": list(line.limits), "limitName": line.limit_name, "loose": line.loose}
    return {"column": line.column, "name": line.name, **limits}


def _columns(group: str, shown: Series) -> Iterator[bytes]:
    """Yield the columns of a series as elements that the script finds by id."""
    if len(shown) < 2:
        return
    for name, column in {"seconds": shown.seconds, **shown.values}.items():
        yield _column(f"{group}-{name}", pack(column))
    for name, numbers in shown.lines.items():
        yield _column(f"{group}-{name}", pack(numbers))


def _column(name: str, packed: bytes) -> bytes:
    return b'<script type="text/plain" id="' + name.encode() + b'">' + packed + b"</script>\n"
