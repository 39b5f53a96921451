"""The words and tables of the HTML page: verdict, checks, worst places, operations, tools, decisions, extents.

In:     ``ReportContent``.
Out:    HTML, with all text from outside escaped.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from trunnion.reporting.content import ReportContent
from trunnion.reporting.extents import AxisExtent, BlockReference, Extremes, TipExtent
from trunnion.reporting.html_text import (
    capitalised,
    escape,
    format_fixed,
    format_limit,
    format_number,
    format_range,
    note_lines,
    prose,
    table,
    verdict_banner,
    with_unit,
)
from trunnion.reporting.remarks import RemarkGroup
from trunnion.reporting.set_up_values import lengths_text, zeros_text
from trunnion.reporting.simulation_page import simulation_section
from trunnion.reporting.usage import OperationUsage, ToolUsage
from trunnion.verification import Verdict, stand_lines
from trunnion.verification.context import MAX_PLACES as KEPT_PLACES
from trunnion.verification.results import Check, Place, State
from trunnion.wording import counted, format_duration

#: Places that the page shows for each check; the JSON report has all of them.
MAX_PLACES = 12

#: The class of what shows a check of each state, and its word.
_STATES: Final = {
    State.OK: ("good", "✓ passed"),
    State.FAIL: ("bad", "✗ failed"),
    State.NOT_CHECKED: ("open", "– not checked"),
}

_AXIS_HEADINGS = ("Axis", "#From", "at", "#To", "at", "#Limits", "#Margin")


def page_body(content: ReportContent) -> str:
    """Return the page from its body tag up to the plots."""
    tables = (_operation_table(content), _tool_table(content), _decisions(content), _extents(content), _used(content))
    simulated = "" if content.simulation is None else simulation_section(replace(content.simulation, remarks=()))
    parts = (
        _title(content),
        _checks(content.checks),
        _remarks(content.remarks),
        _worst_places(content.checks),
        simulated,
        *tables,
    )
    return "<body>\n<main>\n" + "".join(parts)


def _title(content: ReportContent) -> str:
    verdict, said = content.verdict, content.standing.said()
    if content.simulation is not None and not content.simulation.passed:
        said += "; the simulation warns, see below"
    if verdict is Verdict.FAILED:
        said += "; the program must not run as it is"
    items = [
        ("Machine", content.machine),
        ("Control", content.control),
        ("Workpiece zero, mm", zeros_text(content.zeros) if content.zeros else ""),
        ("Tool length, mm", lengths_text(content.lengths)),
        ("Motions", f"{content.motions:,}".replace(",", "\u202f") if content.motions else ""),
        ("Time", format_duration(content.seconds) if content.motions else ""),
        ("in cuts", format_duration(content.cutting_seconds) if content.motions else ""),
        ("in rapids", _rapid_time(content.rapid_seconds, content.rapids)),
        ("waiting", format_duration(content.waiting_seconds) if content.waiting_seconds > 0.0 else ""),
        ("Made", content.made),
        ("Lengths", _units_text(content.units)),
        ("Part", "" if content.clamping is None or content.clamping.is_as_drawn else str(content.clamping)),
    ]
    entries = "".join(
        f"<div><dt>{name}</dt><dd><bdi>{escape(value)}</bdi></dd></div>" for name, value in items if value
    )
    untimed = (
        f'<p class="note">{counted(content.untimed, "motion")} without a known time.</p>' if content.untimed else ""
    )
    return f"""<header>
{verdict_banner(verdict, said)}
<h1><bdi>{escape(content.program)}</bdi></h1>
<dl>{entries}</dl>
{untimed}</header>
"""


def _rapid_time(seconds: float, rapids: int) -> str:
    """Return the time in rapids; they take none where nobody states how fast they are, which is not known."""
    return "not known" if rapids and not seconds else format_duration(seconds) if rapids else ""


def _checks(checks: Sequence[Check]) -> str:
    if not checks:
        return ""
    rows = [
        f'<tr class="{_STATES[check.state][0]}">'
        f"<td>{_result(check)}</td><th scope=row>{capitalised(check.title)}</th>"
        f"<td class=n>{with_unit(check.worst, check.unit)}</td><td class=n>{with_unit(check.limit, check.unit)}</td>"
        f"<td>{prose(check.told)}</td></tr>"
        for check in checks
    ]
    return _section(
        "Checks",
        table(("Result", "Check", "#Worst", "#Limit", "Summary"), rows, "tight") + note_lines(stand_lines(checks)),
    )


def _remarks(remarks: Sequence[RemarkGroup]) -> str:
    """Return the warnings, each thing once."""
    rows = [
        f"<tr><td>{remark.severity}</td><td>{prose(remark.text)}{_cure(remark.cure)}</td>"
        f"<td><bdi>{escape(remark.file)}</bdi>{f':{remark.line}' if remark.line else ''}</td>"
        f"<td>{escape(remark.code)}</td><td class=n>{remark.count}</td></tr>"
        for remark in remarks
    ]
    headings = ("", "What", "First at", "Code", "#Times")
    return _section("Warnings", table(tuple(head or "-" for head in headings), rows, "tight")) if rows else ""


def _cure(text: str) -> str:
    return f"<br><small>{prose(text)}</small>" if text else ""


def _result(check: Check) -> str:
    return f'<span class="tag">{_STATES[check.state][1]}</span>'


def _worst_places(checks: Sequence[Check]) -> str:
    """Return the worst places of each check, failed checks first."""
    tables = [_check_places(check) for check in sorted(checks, key=lambda check: check.passed) if check.places]
    return _section("Worst places", "".join(tables)) if tables else ""


def _check_places(check: Check) -> str:
    has_cl_lines = any(place.cl_line for place in check.places[:MAX_PLACES])
    rows = [
        f"<tr><td class=n>{_number(place.number)}</td><td class=n>{_nc_line(place)}</td>"
        + (f"<td class=n>{_cl_line(place)}</td>" if has_cl_lines else "")
        + f"<td>{prose(place.told)}</td>"
        f"<td class=go>{_plot_button(place)}</td></tr>"
        for place in check.places[:MAX_PLACES]
    ]
    more = len(check.places) - MAX_PLACES
    is_full = len(check.places) >= KEPT_PLACES
    note = f"The {KEPT_PLACES} worst are listed; the line of the check counts the others." if is_full else ""
    if more > 0:
        note = f"and {more} more, in the JSON report"
    note = note and f'<p class="note">{note}</p>'
    headings = ("#Block", "#NC line", *(("#CL line",) if has_cl_lines else ()), "What", "-")
    state = _STATES[check.state][0]
    return f'<h3 class="{state}">{_result(check)} {capitalised(check.title)}</h3>{table(headings, rows, "tight")}{note}'


def _plot_button(place: Place) -> str:
    """Return the button that zooms to a place, unless it has no block."""
    if not place.nc_line:
        return ""
    file = f' data-file="{escape(place.nc_file)}"' if place.nc_file else ""
    return f'<button type=button data-line="{place.nc_line}" data-cl="{place.cl_line}"{file}>plot</button>'


def _nc_line(place: Place) -> str:
    """Return the line of a block, with the subprogram in which it is."""
    if not place.nc_file:
        return str(place.nc_line or "")
    return f"{escape(place.nc_file)}:{place.nc_line}"


def _cl_line(place: Place) -> str:
    if not place.cl_line:
        return ""
    return f'<span title="{escape(place.cl_file)}">{place.cl_line}</span>' if place.cl_file else str(place.cl_line)


def _tool_table(content: ReportContent) -> str:
    rows = [_tool(tool) for tool in content.tools]
    headings = ("Tool", "#Motions", "#Time", "#in cuts", "#in rapids", "#S rev/min", "#F mm/min", "#From")
    return _section("Tools and times", table(headings, rows)) if rows else ""


def _tool(tool: ToolUsage) -> str:
    name = f"<bdi>{escape(tool.name)}</bdi>" if tool.name else "<em>before the first tool</em>"
    return (
        f"<tr><th scope=row>{name}</th><td class=n>{tool.motions}</td><td class=n>{format_duration(tool.seconds)}</td>"
        f"<td class=n>{format_duration(tool.cutting_seconds)}</td>"
        f"<td class=n>{format_duration(tool.rapid_seconds)}</td>"
        f"<td class=n>{format_range(tool.rpm)}</td><td class=n>{format_range(tool.feed)}</td>"
        f"<td class=n>{_from(tool.first)}</td></tr>"
    )


def _operation_table(content: ReportContent) -> str:
    rows = [_operation(operation) for operation in content.operations]
    headings = ("Operation", "Tool", "#Motions", "#Time", "#in cuts", "#in rapids", "#From")
    return _section("Operations and times", table(headings, rows)) if rows else ""


def _operation(operation: OperationUsage) -> str:
    first = _from(operation.first) if operation.first else ""
    return (
        f'<tr><th scope=row title="{escape(operation.cl_file)}"><bdi>{escape(operation.name)}</bdi></th>'
        f"<td><bdi>{escape(operation.tool)}</bdi></td><td class=n>{operation.motions}</td>"
        f"<td class=n>{format_duration(operation.seconds)}</td>"
        f"<td class=n>{format_duration(operation.cutting_seconds)}</td>"
        f"<td class=n>{format_duration(operation.rapid_seconds)}</td><td class=n>{first}</td></tr>"
    )


def _decisions(content: ReportContent) -> str:
    """Return the decisions of the planner and their reasons."""
    rows = [
        f"<tr><td><bdi>{escape(decision.operation)}</bdi></td>"
        f'<td class=n title="{escape(decision.file)}">{decision.line or ""}</td>'
        f"<td>{escape(decision.topic)}</td><td>{prose(decision.text)}</td></tr>"
        for decision in content.decisions
    ]
    headings = ("Operation", "#CL line", "About", "Decision and why")
    return _section("Decisions", table(headings, rows, "tight")) if rows else ""


def _extents(content: ReportContent) -> str:
    if not content.motions:
        return ""
    axes = [_axis(axis) for axis in content.axes]
    tips = [_tip(extent) for extent in content.tip]
    tip_heads = ("Tip, mm", "#From", "at", "#To", "at", "#In cuts from", "#to")
    return _section("Extents", f'<div class="pair">{table(_AXIS_HEADINGS, axes)}{table(tip_heads, tips)}</div>')


def _used(content: ReportContent) -> str:
    """Return what axes and spindle used of their travel in the recording."""
    if content.recorded is None or not content.recorded.extents:
        return ""
    rows = [_axis(axis) for axis in content.recorded.extents]
    return _section(f"Extents in {escape(content.recorded.file)}", table(_AXIS_HEADINGS, rows))


def _axis(axis: AxisExtent) -> str:
    limits = "endless" if axis.endless else "not stated"
    if not axis.endless and (axis.low_limit is not None or axis.high_limit is not None):
        limits = f"{format_limit(axis.low_limit)} … {format_limit(axis.high_limit)}"
    if not axis.zero_known and axis.low_limit is not None and axis.high_limit is not None:
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
    cuts = (format_fixed(cutting.low), format_fixed(cutting.high)) if cutting else ("", "")
    return (
        f"<tr><th scope=row>{extent.name}</th>{_extremes(extent.whole)}"
        f"<td class=n>{cuts[0]}</td><td class=n>{cuts[1]}</td></tr>"
    )


def _extremes(extremes: Extremes | None) -> str:
    if extremes is None:
        return "<td></td>" * 4
    ends = ((extremes.low, extremes.low_at), (extremes.high, extremes.high_at))
    return "".join(f"<td class=n>{format_fixed(value)}</td><td class=at>{_block(block)}</td>" for value, block in ends)


def _section(title: str, body: str) -> str:
    return f"<section>\n<h2>{title}</h2>\n{body}\n</section>\n"


def _block(block: BlockReference) -> str:
    """Return a block by its number, or by its line if it has none."""
    place = _number(block.number) or f"line {block.nc_line}"
    line = f"{block.file}:{block.nc_line}" if block.file else f"line {block.nc_line}"
    return f'<span title="{escape(line)}">{place}</span>'


def _from(block: BlockReference) -> str:
    """Return a block with its file, unless that is the main program."""
    return (f"<bdi>{escape(block.file)}</bdi> " if block.file else "") + _block(block)


def _number(number: int) -> str:
    return f"N{number}" if number >= 0 else ""


def _units_text(units: Sequence[str]) -> str:
    """In what the report counts, where the program counts otherwise; empty elsewhere."""
    return f"mm; the program counts in {' and '.join(units)}" if "inch" in units else ""
