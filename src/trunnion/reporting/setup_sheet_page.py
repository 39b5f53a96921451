"""A setup sheet as one HTML page that prints on A4, and as JSON.

In:     ``SetupSheet``.
Out:    UTF-8. The page needs nothing else and runs no script; all text from outside is escaped.
"""

from collections.abc import Iterable, Sequence
from importlib.resources import files
from typing import Final

from trunnion.messages import Wording, phrase
from trunnion.reporting.extents import BlockReference
from trunnion.reporting.html_text import (
    capitalised,
    escape,
    format_fixed,
    format_limit,
    format_number,
    format_range,
    made_by,
    note_lines,
    prose,
    source_hash,
)
from trunnion.reporting.page_words import label, language_tag, on_sheet, page_words, told, verdict_word, word
from trunnion.reporting.set_up_values import lengths_text, zeros_text
from trunnion.reporting.setup_sheet import Range, SetupSheet, SheetOperation, SheetTool
from trunnion.results import as_json, to_data
from trunnion.verification import Verdict, stand_lines
from trunnion.verification.results import Check, State
from trunnion.wording import format_duration

#: What stands before a check of each state.
_MARKS: Final = {State.OK: "mark_ok", State.FAIL: "mark_failed", State.NOT_CHECKED: "mark_not_checked"}

#: Who signs.
_SIGNATURES: Final = ("programmed_by", "set_up_by", "released_by")


def sheet_page(sheet: SetupSheet) -> bytes:
    """Return the page."""
    style = "\n" + files("trunnion.reporting").joinpath("setup_sheet.css").read_text(encoding="utf-8")
    policy = f"default-src 'none'; style-src {source_hash(style)}; base-uri 'none'; form-action 'none'"
    parts = (_title(sheet), _picture(sheet), _tools(sheet), _operations(sheet), _axes(sheet), _start(sheet),
             _to_check(sheet), _checks(sheet.content.checks), _files(sheet), _signatures(sheet))  # fmt: skip
    return f"""<!DOCTYPE html>
<html lang="{language_tag()}">
<head>
<meta charset="utf-8">
{made_by("post")}
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(on_sheet("title_of", program=sheet.content.program))}</title>
<style>{style}</style>
</head>
<body>
{"".join(parts)}</body>
</html>
""".encode()


def sheet_json(sheet: SetupSheet) -> bytes:
    """Return the data: everything on the page but the picture."""
    return (as_json(to_data(sheet)) + "\n").encode()


# The page


def _title(sheet: SetupSheet) -> str:
    content = sheet.content
    standing = content.standing
    if sheet.may_run:
        warns = sheet.simulated is False
        warning = f"<br>{escape(on_sheet('simulation_warns'))}" if warns else ""
        found = Verdict.IN_PART if warns and standing.verdict is Verdict.PASSED else standing.verdict
        state = "" if found is Verdict.PASSED else " open"
        said = escape(standing.said(page_words()))
        verdict = f'<div class="verdict{state}">{escape(verdict_word(found))}<small>{said}{warning}</small></div>'
    else:
        said = escape(standing.line(page_words()))
        verdict = f'<div class="verdict bad">{escape(on_sheet("must_not_run"))}<small>{said}</small></div>'
    items = [
        ("machine", content.machine),
        ("control", content.control),
        ("title", sheet.title),
        ("part", sheet.part),
        ("work_offset", ", ".join(sheet.offsets) or on_sheet("none")),
        ("zero", zeros_text(content.zeros)),
        ("counts_from", sheet.system),
        ("time", format_duration(content.seconds)),
        ("in_cuts", format_duration(content.cutting_seconds)),
        ("not_in_times", sheet.untimed),
        ("lengths", on_sheet("units", units=tuple(content.units))),
    ]
    items.append(("tool_length", lengths_text(content.lengths)))
    shown = ((name, escape(value)) for name, value in items if value)
    entries = "".join(
        f"<div><dt>{escape(on_sheet(name))}</dt><dd><bdi>{value}</bdi></dd></div>" for name, value in shown
    )
    return (
        f"<header><div><h1><bdi>{escape(content.program)}</bdi></h1>{escape(on_sheet('name'))}</div>{verdict}</header>\n"
        f"<dl>{entries}</dl>\n"
    )


def _picture(sheet: SetupSheet) -> str:
    if not sheet.picture:
        return ""
    return f"<figure>{sheet.picture}<figcaption>{escape(on_sheet('caption'))}</figcaption></figure>\n"


def _tools(sheet: SetupSheet) -> str:
    rows = [_tool(tool) for tool in sheet.tools]
    heads = ("call", "tool", "#diameter", "#corner_radius", "#length", "#sticks_out", "#in_spindle", "holder",
             "of_operations", "#seconds", "measured_length")  # fmt: skip
    return _section("tools", _table(heads, rows))


def _tool(tool: SheetTool) -> str:
    kind = f"<br><small>{escape(tool.kind)}</small>" if tool.kind else ""
    call = escape(tool.call) + (f"<br>H{tool.register}" if tool.register else "")
    sizes = (tool.diameter, tool.corner_radius, tool.length, tool.stick_out, tool.set_length)
    known = tool.kind != ""
    cells = "".join(
        f"<td class=n>{format_number(size) if size or (k == 1 and known) else ''}</td>" for k, size in enumerate(sizes)
    )
    numbers = ", ".join(map(str, tool.operations))
    return (
        f"<tr><th scope=row><bdi>{call}</bdi></th><td><bdi>{_name(tool.name)}</bdi>{kind}</td>{cells}"
        f"<td><bdi>{escape(tool.holder)}</bdi></td><td>{numbers}</td>"
        f"<td class=n>{format_duration(tool.seconds)}</td><td></td></tr>"
    )


def _operations(sheet: SetupSheet) -> str:
    rows = [_operation(each, sheet.rotary) for each in sheet.operations]
    heads = ("number", "operation", "tool", "#begins_at", "#operation_time", "#seconds", "box",
             "#feed", "#speed", "coolant")  # fmt: skip
    return _section("operations", _table(heads, rows))


def _operation(each: SheetOperation, names: Sequence[str]) -> str:
    facts = ", ".join(escape(text) for text in (each.mode, word(each.method), *each.notes) if text)
    box = (
        []
        if each.box is None
        else [
            f"{name} {format_fixed(low)} … {format_fixed(high)}"
            for name, low, high in zip("XYZ", *each.box, strict=True)
        ]
    )
    turns = zip(names, each.cuts.rotary, each.cuts.stands, strict=True)
    box += [f"{escape(name)} {_degrees(turn, stands)}" for name, turn, stands in turns if turn]
    feeds = [format_range(each.cuts.feed)] if each.cuts.feed else []
    feeds += [on_sheet("per_rev", feed=format_range(each.cuts.feed_per_rev))] if each.cuts.feed_per_rev else []
    sense = "" if each.cuts.sense in ("", "clockwise") else f"<br><small>{escape(_senses(each.cuts.sense))}</small>"
    return (
        f"<tr><td>{each.number}</td><th scope=row><bdi>{_name(each.name)}</bdi><br><small>{facts}</small></th>"
        f"<td><bdi>{escape(each.tool)}</bdi></td><td class=n>{_block(each.cuts.start)}</td>"
        f"<td class=n>{format_duration(each.seconds)}</td><td class=n>{format_duration(each.cutting_seconds)}</td>"
        f"<td class=cuts>{'<br>'.join(box)}</td><td class=n>{'<br>'.join(feeds)}</td>"
        f"<td class=n>{format_range(each.cuts.rpm)}{sense}</td><td>{escape(each.cuts.coolant)}</td></tr>"
    )


def _senses(text: str) -> str:
    """Return senses of the spindle as they are read."""
    return ", ".join(map(word, text.split(", ")))


def _name(text: str) -> str:
    """Return a name that breaks behind its underscores, where it must."""
    return escape(text).replace("_", "_<wbr>")


def _degrees(turn: Range, stands: Sequence[float]) -> str:
    if stands:
        return ", ".join(f"{format_fixed(value)}°" for value in stands)
    low, high = (format_fixed(value) for value in turn)
    if low == high:
        return f"{low}°"
    # A way that passes the end of the turn begins at the greater value, in 0 to 360 or in -180 to 180 degrees.
    if turn[0] <= turn[1]:
        return f"{low} … {high}°"
    return on_sheet("through", low=low, high=high, end=180 if turn[1] < 0.0 else 0)


def _axes(sheet: SetupSheet) -> str:
    rows = []
    for axis in sheet.content.axes:
        limits = label("endless" if axis.endless else "not_stated")
        if not axis.endless and (axis.low_limit is not None or axis.high_limit is not None):
            limits = f"{format_limit(axis.low_limit)} … {format_limit(axis.high_limit)}"
        if not axis.zero_known and axis.low_limit is not None and axis.high_limit is not None:
            limits = label("travel", length=format_number(axis.high_limit - axis.low_limit))
        used = (
            ("", "") if axis.extremes is None else (format_fixed(axis.extremes.low), format_fixed(axis.extremes.high))
        )
        left = "" if axis.margin is None else format_fixed(axis.margin)
        bad = ' class="bad"' if axis.margin is not None and axis.margin < 0.0 else ""
        counted_from = on_sheet("machine_zero" if axis.zero_known else "workpiece_zero")
        rows.append(
            f"<tr{bad}><th scope=row>{escape(axis.name)} <small>{axis.unit}</small></th><td class=n>{used[0]}</td>"
            f"<td class=n>{used[1]}</td><td class=n>{escape(limits)}</td><td class=n>{left}</td>"
            f"<td>{escape(counted_from)}</td></tr>"
        )
    heads = ("axis", "#from", "#to", "#limits", "#left", "counted_from")
    return _section("travel", _table(heads, rows), "whole")


def _start(sheet: SetupSheet) -> str:
    return _section("start", _list(sheet.start, "plain"), "whole")


def _to_check(sheet: SetupSheet) -> str:
    return _section("to_check", _list(sheet.to_check))


def _checks(checks: Sequence[Check]) -> str:
    rows = [
        f'<tr class="{"bad" if check.state is State.FAIL else ""}"><td>{escape(on_sheet(_MARKS[check.state]))}</td>'
        f"<td>{capitalised(told(Wording(check.key, 'title')))}</td><td>{prose(check.said(page_words()))}</td></tr>"
        for check in checks
    ]
    notes = note_lines(stand_lines(checks, page_words()))
    return _section("proven", _table(("", "check", "result"), rows) + notes, "small")


def _files(sheet: SetupSheet) -> str:
    rows = [
        f"<tr><th scope=row><bdi>{escape(file.name)}</bdi></th><td class=n>{file.size:,}</td>"
        f'<td class="hash">{file.sha256}</td></tr>'
        for file in sheet.files
    ]
    return _section("files", _table(("file", "#bytes", "checksum"), rows)) if rows else ""


def _signatures(sheet: SetupSheet) -> str:
    rows = [f"<tr><th scope=row>{escape(on_sheet(who))}</th><td></td><td></td><td></td></tr>" for who in _SIGNATURES]
    table = _table(("", "signer", "date", "signature"), rows)
    return (
        f'<section class="sign">\n<h2>{escape(on_sheet("released"))}</h2>\n{table}</section>\n'
        f"<footer>{escape(on_sheet('belongs', version=sheet.version))}</footer>\n"
    )


def _list(texts: Iterable[str], kind: str = "") -> str:
    return f'<ul class="{kind}">' + "".join(f"<li>{prose(text)}</li>\n" for text in texts) + "</ul>\n"


def _section(title: str, body: str, kind: str = "") -> str:
    return f'<section class="{kind}">\n<h2>{escape(on_sheet(title))}</h2>\n{body}</section>\n'


def _table(headings: Sequence[str], rows: Sequence[str]) -> str:
    """Return a table; headings are names of texts, behind ``#`` those of columns of numbers, empty: none."""
    kinds = (" class=n" if head[:1] == "#" else "" for head in headings)
    names = (escape(on_sheet(head.lstrip("#"))) if head else "" for head in headings)
    cells = "".join(f"<th scope=col{kind}>{name}</th>" for kind, name in zip(kinds, names, strict=True))
    body = "\n".join(rows)
    return f"<table>\n<thead><tr>{cells}</tr></thead>\n<tbody>\n{body}\n</tbody></table>\n"


def _block(block: BlockReference | None) -> str:
    if block is None:
        return ""
    place = f"N{block.number}" if block.number >= 0 else told(phrase("line_number", line=block.nc_line))
    return f"{escape(block.file)} {place}".strip()
