"""A setup sheet as one HTML page that prints on A4, and as JSON.

In:     ``SetupSheet``.
Out:    UTF-8. The page needs nothing else and runs no script; all text from outside is escaped.
"""

from collections.abc import Iterable, Sequence
from importlib.resources import files
from typing import Final

from trunnion.reporting.extents import BlockReference
from trunnion.reporting.html_text import (
    capitalised,
    escape,
    format_fixed,
    format_limit,
    format_number,
    format_range,
    note_lines,
    prose,
    source_hash,
)
from trunnion.reporting.set_up_values import lengths_text, zeros_text
from trunnion.reporting.setup_sheet import Range, SetupSheet, SheetOperation, SheetTool
from trunnion.results import as_json, to_data
from trunnion.verification import Verdict, stand_lines
from trunnion.verification.results import Check, State
from trunnion.wording import format_duration

#: What stands before a check of each state.
_MARKS: Final = {State.OK: "✓", State.FAIL: "✗ FAILED", State.NOT_CHECKED: "– not checked"}

#: Who signs.
_SIGNATURES: Final = ("Programmed by", "Set up by", "First part released by")


def sheet_page(sheet: SetupSheet) -> bytes:
    """Return the page."""
    style = "\n" + files("trunnion.reporting").joinpath("setup_sheet.css").read_text(encoding="utf-8")
    policy = f"default-src 'none'; style-src {source_hash(style)}; base-uri 'none'; form-action 'none'"
    parts = (_title(sheet), _picture(sheet), _tools(sheet), _operations(sheet), _axes(sheet), _start(sheet),
             _to_check(sheet), _checks(sheet.content.checks), _files(sheet), _signatures(sheet))  # fmt: skip
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Setup sheet of {escape(sheet.content.program)}</title>
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
        warning = "<br>THE SIMULATION WARNS: see To be checked" if warns else ""
        word = Verdict.IN_PART if warns and standing.verdict is Verdict.PASSED else standing.verdict
        state = "" if word is Verdict.PASSED else " open"
        said = escape(standing.said())
        verdict = f'<div class="verdict{state}">{word.word}<small>{said}{warning}</small></div>'
    else:
        verdict = f'<div class="verdict bad">MUST NOT RUN AS IT IS<small>{escape(standing.told)}</small></div>'
    items = [
        ("Machine", content.machine),
        ("Control", content.control),
        ("Title", sheet.title),
        ("Part", sheet.part),
        ("Work offset", ", ".join(sheet.offsets) or "none"),
        ("Workpiece zero on the machine, mm", zeros_text(content.zeros)),
        ("Program counts from", sheet.system),
        ("Machining time", format_duration(content.seconds)),
        ("of which in cuts", format_duration(content.cutting_seconds)),
        ("Not in these times", sheet.untimed),
        ("Lengths in the program", " and ".join(content.units)),
    ]
    items.append(("Tool length from the gauge point, mm", lengths_text(content.lengths)))
    shown = ((name, escape(value)) for name, value in items if value)
    entries = "".join(f"<div><dt>{name}</dt><dd><bdi>{value}</bdi></dd></div>" for name, value in shown)
    return (
        f"<header><div><h1><bdi>{escape(content.program)}</bdi></h1>Setup sheet</div>{verdict}</header>\n"
        f"<dl>{entries}</dl>\n"
    )


def _picture(sheet: SetupSheet) -> str:
    if not sheet.picture:
        return ""
    caption = "Tool path in the workpiece: cuts as lines, rapids dashed; the axes stand at the program zero."
    return f"<figure>{sheet.picture}<figcaption>{caption}</figcaption></figure>\n"


def _tools(sheet: SetupSheet) -> str:
    rows = [_tool(tool) for tool in sheet.tools]
    heads = ("Call", "Tool", "#Ø mm", "#Corner R mm", "#Length mm", "#Sticks out mm", "#In spindle mm", "Holder",
             "Operations", "#In cuts", "Measured length")  # fmt: skip
    return _section("Tools", _table(heads, rows))


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
    heads = ("No.", "Operation", "Tool", "#Begins at", "#Time", "#In cuts", "Cuts from … to, mm and °",
             "#F mm/min", "#S rev/min", "Coolant")  # fmt: skip
    return _section("Operations", _table(heads, rows))


def _operation(each: SheetOperation, names: Sequence[str]) -> str:
    facts = ", ".join(escape(text) for text in (each.mode, each.method, *each.notes) if text)
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
    feeds += [f"{format_range(each.cuts.feed_per_rev)} mm/rev"] if each.cuts.feed_per_rev else []
    sense = "" if each.cuts.sense in ("", "clockwise") else f"<br><small>{escape(each.cuts.sense)}</small>"
    return (
        f"<tr><td>{each.number}</td><th scope=row><bdi>{_name(each.name)}</bdi><br><small>{facts}</small></th>"
        f"<td><bdi>{escape(each.tool)}</bdi></td><td class=n>{_block(each.cuts.start)}</td>"
        f"<td class=n>{format_duration(each.seconds)}</td><td class=n>{format_duration(each.cutting_seconds)}</td>"
        f"<td class=cuts>{'<br>'.join(box)}</td><td class=n>{'<br>'.join(feeds)}</td>"
        f"<td class=n>{format_range(each.cuts.rpm)}{sense}</td><td>{escape(each.cuts.coolant)}</td></tr>"
    )


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
    through = "" if turn[0] <= turn[1] else f" through {180 if turn[1] < 0.0 else 0}°"
    return f"{low} … {high}°{through}"


def _axes(sheet: SetupSheet) -> str:
    rows = []
    for axis in sheet.content.axes:
        limits = "endless" if axis.endless else "not stated"
        if not axis.endless and (axis.low_limit is not None or axis.high_limit is not None):
            limits = f"{format_limit(axis.low_limit)} … {format_limit(axis.high_limit)}"
        if not axis.zero_known and axis.low_limit is not None and axis.high_limit is not None:
            limits = f"travel {format_number(axis.high_limit - axis.low_limit)}"
        used = (
            ("", "") if axis.extremes is None else (format_fixed(axis.extremes.low), format_fixed(axis.extremes.high))
        )
        left = "" if axis.margin is None else format_fixed(axis.margin)
        bad = ' class="bad"' if axis.margin is not None and axis.margin < 0.0 else ""
        counted_from = "the machine's zero" if axis.zero_known else "the workpiece zero"
        rows.append(
            f"<tr{bad}><th scope=row>{escape(axis.name)} <small>{axis.unit}</small></th><td class=n>{used[0]}</td>"
            f"<td class=n>{used[1]}</td><td class=n>{limits}</td><td class=n>{left}</td><td>{counted_from}</td></tr>"
        )
    heads = ("Axis", "#From", "#To", "#Limits", "#Left", "Counted from")
    return _section("Travel", _table(heads, rows), "whole")


def _start(sheet: SetupSheet) -> str:
    return _section("Start", _list(sheet.start, "plain"), "whole")


def _to_check(sheet: SetupSheet) -> str:
    return _section("To be checked at the machine: the proof cannot see it", _list(sheet.to_check))


def _checks(checks: Sequence[Check]) -> str:
    rows = [
        f'<tr class="{"bad" if check.state is State.FAIL else ""}"><td>{_MARKS[check.state]}</td>'
        f"<td>{capitalised(check.title)}</td><td>{prose(check.told)}</td></tr>"
        for check in checks
    ]
    return _section("What was proven", _table(("", "Check", "Result"), rows) + note_lines(stand_lines(checks)), "small")


def _files(sheet: SetupSheet) -> str:
    rows = [
        f"<tr><th scope=row><bdi>{escape(file.name)}</bdi></th><td class=n>{file.size:,}</td>"
        f'<td class="hash">{file.sha256}</td></tr>'
        for file in sheet.files
    ]
    return _section("Files of the program", _table(("File", "#Bytes", "SHA-256"), rows)) if rows else ""


def _signatures(sheet: SetupSheet) -> str:
    rows = [f"<tr><th scope=row>{who}</th><td></td><td></td><td></td></tr>" for who in _SIGNATURES]
    table = _table(("", "Name", "Date", "Signature"), rows)
    return (
        f'<section class="sign">\n<h2>Released</h2>\n{table}</section>\n'
        f"<footer>{escape(sheet.version)}. A sheet belongs to the files whose checksums it has.</footer>\n"
    )


def _list(texts: Iterable[str], kind: str = "") -> str:
    return f'<ul class="{kind}">' + "".join(f"<li>{prose(text)}</li>\n" for text in texts) + "</ul>\n"


def _section(title: str, body: str, kind: str = "") -> str:
    return f'<section class="{kind}">\n<h2>{title}</h2>\n{body}</section>\n'


def _table(headings: Sequence[str], rows: Sequence[str]) -> str:
    """Return a table; a heading with ``#`` is that of a column of numbers."""
    cells = "".join(
        f"<th scope=col class=n>{head[1:]}</th>" if head[:1] == "#" else f"<th scope=col>{head}</th>"
        for head in headings
    )
    body = "\n".join(rows)
    return f"<table>\n<thead><tr>{cells}</tr></thead>\n<tbody>\n{body}\n</tbody></table>\n"


def _block(block: BlockReference | None) -> str:
    if block is None:
        return ""
    place = f"N{block.number}" if block.number >= 0 else f"line {block.nc_line}"
    return f"{escape(block.file)} {place}".strip()
