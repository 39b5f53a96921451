"""The words and tables of the HTML page: verdict, checks, worst places, operations, tools, decisions, extents.

In:     ``ReportContent``.
Out:    HTML, with all text from outside escaped.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from trunnion.messages import Wording, phrase
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
    said_table,
    verdict_banner,
    with_unit,
)
from trunnion.reporting.page_words import label, page_words, told, word
from trunnion.reporting.remarks import RemarkGroup
from trunnion.reporting.set_up_values import lengths_text, zeros_text
from trunnion.reporting.simulation_content import no_remarks
from trunnion.reporting.simulation_page import simulation_section
from trunnion.reporting.usage import OperationUsage, ToolUsage
from trunnion.verification import Verdict, stand_lines
from trunnion.verification.context import MAX_PLACES as KEPT_PLACES
from trunnion.verification.results import Check, Place, State
from trunnion.wording import format_duration

#: Places that the page shows for each check; the JSON report has all of them.
MAX_PLACES = 12

#: The class of what shows a check of each state, and the name of its word.
_STATES: Final = {
    State.OK: ("good", "state_passed"),
    State.FAIL: ("bad", "state_failed"),
    State.NOT_CHECKED: ("open", "state_not_checked"),
}

_AXIS_HEADINGS = ("axis", "#from", "at", "#to", "at", "#limits", "#margin")


def page_body(content: ReportContent) -> str:
    """Return the page from its body tag up to the plots."""
    tables = (_operation_table(content), _tool_table(content), _decisions(content), _extents(content), _used(content))
    simulated = (
        "" if content.simulation is None else simulation_section(replace(content.simulation, remarks=no_remarks))
    )
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
    verdict, said = content.verdict, content.standing.said(page_words())
    if content.simulation is not None and not content.simulation.passed:
        said += label("simulation_warns")
    if verdict is Verdict.FAILED:
        said += label("must_not_run")
    items = [
        ("machine", content.machine),
        ("control", content.control),
        ("workpiece_zero", zeros_text(content.zeros) if content.zeros else ""),
        ("tool_length", lengths_text(content.lengths)),
        ("motions", f"{content.motions:,}".replace(",", "\u202f") if content.motions else ""),
        ("time", format_duration(content.seconds) if content.motions else ""),
        ("in_cuts", format_duration(content.cutting_seconds) if content.motions else ""),
        ("in_rapids", _rapid_time(content.rapid_seconds, content.rapids)),
        ("waiting", format_duration(content.waiting_seconds) if content.waiting_seconds > 0.0 else ""),
        ("made", content.made),
        ("lengths", _units_text(content.units)),
        (
            "part",
            "" if content.clamping is None or content.clamping.is_as_drawn else told(content.clamping.said),
        ),
    ]
    entries = "".join(
        f"<div><dt>{escape(label(name))}</dt><dd><bdi>{escape(value)}</bdi></dd></div>"
        for name, value in items
        if value
    )
    untimed = f'<p class="note">{escape(label("untimed", count=content.untimed))}</p>' if content.untimed else ""
    return f"""<header>
{verdict_banner(verdict, said)}
<h1><bdi>{escape(content.program)}</bdi></h1>
<dl>{entries}</dl>
{untimed}</header>
"""


def _rapid_time(seconds: float, rapids: int) -> str:
    """Return the time in rapids; they take none where nobody states how fast they are, which is not known."""
    return label("not_known") if rapids and not seconds else format_duration(seconds) if rapids else ""


def _checks(checks: Sequence[Check]) -> str:
    if not checks:
        return ""
    rows = [
        f'<tr class="{_STATES[check.state][0]}">'
        f"<td>{_result(check)}</td><th scope=row>{_title_of(check)}</th>"
        f"<td class=n>{with_unit(check.worst, check.unit)}</td><td class=n>{with_unit(check.limit, check.unit)}</td>"
        f"<td>{prose(check.said(page_words()))}</td></tr>"
        for check in checks
    ]
    return _section(
        "checks",
        said_table(("result", "check", "#worst", "#limit", "summary"), rows, "tight")
        + note_lines(stand_lines(checks, page_words())),
    )


def _remarks(remarks: Sequence[RemarkGroup]) -> str:
    """Return the warnings, each thing once."""
    rows = [
        f"<tr><td>{escape(remark.severity_said(page_words()))}</td>"
        f"<td>{prose(remark.said('what', page_words()))}{_cure(remark.said('cure', page_words()))}</td>"
        f"<td><bdi>{escape(remark.file)}</bdi>{f':{remark.line}' if remark.line else ''}</td>"
        f"<td>{escape(remark.code)}</td><td class=n>{remark.count}</td></tr>"
        for remark in remarks
    ]
    headings = ("-", "what", "first_at", "code", "#times")
    return _section("warnings", said_table(headings, rows, "tight")) if rows else ""


def _cure(text: str) -> str:
    return f"<br><small>{prose(text)}</small>" if text else ""


def _result(check: Check) -> str:
    return f'<span class="tag">{escape(label(_STATES[check.state][1]))}</span>'


def _worst_places(checks: Sequence[Check]) -> str:
    """Return the worst places of each check, failed checks first."""
    tables = [_check_places(check) for check in sorted(checks, key=lambda check: check.passed) if check.places]
    return _section("worst_places", "".join(tables)) if tables else ""


def _check_places(check: Check) -> str:
    has_cl_lines = any(place.cl_line for place in check.places[:MAX_PLACES])
    rows = [
        f"<tr><td class=n>{_number(place.number)}</td><td class=n>{_nc_line(place)}</td>"
        + (f"<td class=n>{_cl_line(place)}</td>" if has_cl_lines else "")
        + f"<td>{prose(told(place.said))}</td>"
        f"<td class=go>{_plot_button(place)}</td></tr>"
        for place in check.places[:MAX_PLACES]
    ]
    more = len(check.places) - MAX_PLACES
    is_full = len(check.places) >= KEPT_PLACES
    note = label("worst_are_listed", count=KEPT_PLACES) if is_full else ""
    if more > 0:
        note = label("more_in_data", count=more)
    note = note and f'<p class="note">{escape(note)}</p>'
    headings = ("#block", "#nc_line", *(("#cl_line",) if has_cl_lines else ()), "what", "-")
    state = _STATES[check.state][0]
    return f'<h3 class="{state}">{_result(check)} {_title_of(check)}</h3>{said_table(headings, rows, "tight")}{note}'


def _plot_button(place: Place) -> str:
    """Return the button that zooms to a place, unless it has no block."""
    if not place.nc_line:
        return ""
    file = f' data-file="{escape(place.nc_file)}"' if place.nc_file else ""
    at = f'data-line="{place.nc_line}" data-cl="{place.cl_line}"{file}'
    return f"<button type=button {at}>{escape(label('plot'))}</button>"


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
    headings = ("tool", "#motions", "#time", "#in_cuts", "#in_rapids", "#speed", "#feed", "#from")
    return _section("tools_and_times", said_table(headings, rows)) if rows else ""


def _tool(tool: ToolUsage) -> str:
    name = f"<bdi>{escape(tool.name)}</bdi>" if tool.name else f"<em>{escape(label('before_first_tool'))}</em>"
    return (
        f"<tr><th scope=row>{name}</th><td class=n>{tool.motions}</td><td class=n>{format_duration(tool.seconds)}</td>"
        f"<td class=n>{format_duration(tool.cutting_seconds)}</td>"
        f"<td class=n>{format_duration(tool.rapid_seconds)}</td>"
        f"<td class=n>{format_range(tool.rpm)}</td><td class=n>{format_range(tool.feed)}</td>"
        f"<td class=n>{_from(tool.first)}</td></tr>"
    )


def _operation_table(content: ReportContent) -> str:
    rows = [_operation(operation) for operation in content.operations]
    headings = ("operation", "tool", "#motions", "#time", "#in_cuts", "#in_rapids", "#from")
    return _section("operations_and_times", said_table(headings, rows)) if rows else ""


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
        f"<td>{escape(word(decision.topic))}</td><td>{prose(told(decision.said))}</td></tr>"
        for decision in content.decisions
    ]
    headings = ("operation", "#cl_line", "about", "decision")
    return _section("decisions", said_table(headings, rows, "tight")) if rows else ""


def _extents(content: ReportContent) -> str:
    if not content.motions:
        return ""
    axes = [_axis(axis) for axis in content.axes]
    tips = [_tip(extent) for extent in content.tip]
    tip_heads = ("tip_mm", "#from", "at", "#to", "at", "#in_cuts_from", "#in_cuts_to")
    return _section(
        "extents", f'<div class="pair">{said_table(_AXIS_HEADINGS, axes)}{said_table(tip_heads, tips)}</div>'
    )


def _used(content: ReportContent) -> str:
    """Return what axes and spindle used of their travel in the recording."""
    if content.recorded is None or not content.recorded.extents:
        return ""
    rows = [_axis(axis) for axis in content.recorded.extents]
    return _section("extents_in", said_table(_AXIS_HEADINGS, rows), file=content.recorded.file)


def _axis(axis: AxisExtent) -> str:
    limits = escape(label("endless" if axis.endless else "not_stated"))
    if not axis.endless and (axis.low_limit is not None or axis.high_limit is not None):
        limits = f"{format_limit(axis.low_limit)} … {format_limit(axis.high_limit)}"
    if not axis.zero_known and axis.low_limit is not None and axis.high_limit is not None:
        limits = escape(label("travel", length=format_number(axis.high_limit - axis.low_limit)))
    state = "bad" if axis.margin is not None and axis.margin < 0.0 else ""
    margin = "" if axis.margin is None else f"{axis.margin:.3f}".replace("-", "−")
    name = f"{escape(word(axis.name))} <small>{axis.unit}</small>"
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


def _section(title: str, body: str, **parameters: object) -> str:
    return f"<section>\n<h2>{escape(label(title, **parameters))}</h2>\n{body}\n</section>\n"


def _title_of(check: Check) -> str:
    """Return the title of a check."""
    return capitalised(told(Wording(check.key, "title")))


def _block(block: BlockReference) -> str:
    """Return a block by its number, or by its line if it has none."""
    in_line = told(phrase("line_number", line=block.nc_line))
    place = _number(block.number) or escape(in_line)
    line = f"{block.file}:{block.nc_line}" if block.file else in_line
    return f'<span title="{escape(line)}">{place}</span>'


def _from(block: BlockReference) -> str:
    """Return a block with its file, unless that is the main program."""
    return (f"<bdi>{escape(block.file)}</bdi> " if block.file else "") + _block(block)


def _number(number: int) -> str:
    return f"N{number}" if number >= 0 else ""


def _units_text(units: Sequence[str]) -> str:
    """In what the report counts, where the program counts otherwise; empty elsewhere."""
    return label("units_of_program", units=tuple(units)) if "inch" in units else ""
