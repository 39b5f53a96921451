"""The report of a simulation: a page of its own, or a section of the report of a proof.

In:     ``SimulationContent``.
Out:    HTML, with all text from outside escaped. It needs no script, and nothing outside itself: pictures are in it.
"""

import base64
from collections.abc import Iterator, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Final

from trunnion.messages import LIBRARY, Wording, Words, joined, phrase
from trunnion.reporting.html_text import (
    capitalised,
    escape,
    format_fixed,
    format_number,
    page_head,
    prose,
    said_table,
    source_hash,
    verdict_banner,
)
from trunnion.reporting.page_words import in_language, label, page_words, told, verdict_word, word
from trunnion.reporting.simulation_content import DeviationBin, SimulationContent, StockState
from trunnion.reporting.text import clean
from trunnion.simulation.setup_findings import NearMiss, SimulatedOperation, SimulationFinding
from trunnion.wording import format_duration, position

#: Findings that the page shows; the data has all.
_MOST: Final = 200

#: Width and height of a bar, pixels.
_BAR: Final = (240, 12)

_ASSETS: Final = files("trunnion.reporting")


def render_simulation_page(content: SimulationContent, words: Words = LIBRARY) -> Iterator[bytes]:
    """Yield the page in the language of who asks, piece by piece."""
    with in_language(words):
        page = _page(content)
    yield page.encode()


def _page(content: SimulationContent) -> str:
    style = "\n" + _ASSETS.joinpath("page.css").read_text(encoding="utf-8")
    policy = f"default-src 'none'; img-src data:; style-src {source_hash(style)}; base-uri 'none'; form-action 'none'"
    facts = "".join(
        f"<div><dt>{escape(label(name))}</dt><dd><bdi>{escape(value)}</bdi></dd></div>" for name, value in content.facts
    )
    title = label("simulation_title", program=content.title, verdict=verdict_word(content.verdict).lower())
    return f"""{page_head(title, style, policy, "simulate")}<body>
<main>
<header>
{verdict_banner(content.verdict, _said(content))}
<h1><bdi>{escape(content.title)}</bdi></h1>
<dl>{facts}</dl>
</header>
{simulation_section(content)}</main>
</body>
</html>
"""


def simulation_section(content: SimulationContent) -> str:
    """Return what a simulation found, in tables and pictures."""
    near = _findings(content.near, "#apart") if content.near else ""
    parts = (
        ("simulation_findings", _findings(content.findings, "#depth") + _unfound(content)),
        ("near_misses", near),
        ("finished_stock", "".join(map(_state, content.states))),
        ("material_removed", _operations(content.operations)),
        ("taken_for_granted", "".join(f"<p>{prose(each)}</p>" for each in content.remarks(page_words()))),
    )
    return "".join(f"<section>\n<h2>{escape(label(title))}</h2>\n{body}\n</section>\n" for title, body in parts if body)


def _unfound(content: SimulationContent) -> str:
    """Return that nothing was found, and what was not checked."""
    told = "" if content.findings else escape(label("nothing_was_found"))
    if content.not_checked:
        told = f"{told} {capitalised(joined(content.not_checked, page_words()))}."
    return f'<p class="note">{told.strip()}</p>' if told else ""


def _said(content: SimulationContent) -> str:
    rubs = sum(each.rubs for each in content.near)
    if content.passed and rubs:
        found = phrase("nothing_but_rubs", rubs=phrase("rubs_counted", count=rubs))
    elif content.passed:
        found = phrase("nothing_found")
    elif content.findings:
        found = Wording("report", "findings_must_not_run", count=len(content.findings))
    else:
        found = Wording("report", "see_below_must_not_run")
    return joined((found, *content.not_checked, *content.grounds), page_words())


def _findings(found: Sequence[SimulationFinding | NearMiss], size: str) -> str:
    if not found:
        return ""
    rows = [_finding(each) for each in found[:_MOST]]
    more = len(found) - _MOST
    note = f'<p class="note">{escape(label("and_more_in_data", count=more))}</p>' if more > 0 else ""
    return said_table((size, "what", "between", "program", "cl_file", "#after", "#place"), rows) + note


def _finding(each: SimulationFinding | NearMiss) -> str:
    """Return a row: how deep or how far apart, what, where in the programs, when and where."""
    cl = ""
    if isinstance(each, NearMiss):
        what, size = ("rubs", "") if each.rubs else ("near", f"{each.distance:.3f}")
    else:
        what, size = each.kind, f"{each.depth:.3f}"
        cl = f"{Path(each.cl_file).name}:{each.cl_line}" if each.cl_file else ""
    number = f" N{each.block}" if each.block >= 0 else ""
    stretch = f"<br><small>{escape(told(each.among))}</small>" if each.among is not None else ""
    between = _text(", ".join(map(word, each.between)))
    return (
        f"<tr><td class=n>{size}</td><th scope=row>{escape(word(what))}</th><td>{between}</td>"
        f"<td>{_place(each)}{number}{stretch}</td><td>{_text(cl)}</td>"
        f"<td class=n>{format_duration(each.seconds)}</td><td class=n>{position(each.place)}</td></tr>"
    )


def _place(each: SimulationFinding | NearMiss | SimulatedOperation) -> str:
    """Return the set-up, the file without its folder, and the line."""
    return _text(f"{each.setup + ': ' if each.setup else ''}{Path(each.file).name}:{each.line}")


def _text(text: str) -> str:
    return escape(clean(text))


def _operations(operations: Sequence[SimulatedOperation]) -> str:
    rows = [
        f"<tr><th scope=row>{_place(each)}</th><td>{_text(each.tool)}</td><td class=n>{each.removed:.1f}</td>"
        f"<td class=n>{each.gouged:.2f}</td><td class=n>{format_duration(each.seconds)}</td>"
        f"<td class=n>{_rate(each)}</td><td class=n>{each.air:.0f}</td><td class=n>{each.findings or ''}</td></tr>"
        for each in operations
    ]
    heads = ("from", "tool", "#removed", "#of_the_part", "#time", "#rate", "#in_air", "#findings")
    return said_table(heads, rows) if rows else ""


def _rate(each: SimulatedOperation) -> str:
    return format_number(60.0 * each.removed / each.seconds) if each.seconds > 0.0 else ""


def _state(state: StockState) -> str:
    title = f"<h3>{escape(state.name)}</h3>\n" if state.name else ""
    lines = [label("volume_removed", volume=state.removed)]
    for name, excess in (("left_on_part", state.left), ("missing_from_part", state.gouge)):
        if excess is not None:
            lines.append(label(name, most=excess[0], volume=excess[1]))
    if state.deviation:
        lines.append(label("colours"))
    words = "".join(f"<p>{escape(line)}</p>\n" for line in lines)
    pictures = "".join(
        '<figure><img alt="' + escape(label("the_stock", view=word(view))) + '"'
        f' src="data:image/png;base64,{base64.b64encode(png).decode()}">'
        f"<figcaption>{escape(word(view))}</figcaption></figure>"
        for view, png in state.pictures
    )
    return title + words + f'<div class="pair">{pictures}</div>\n' + _histogram(state.deviation)


def _histogram(bins: Sequence[DeviationBin]) -> str:
    """Return the surface by its deviation; bars are to the scale of what deviates."""
    if not bins:
        return ""
    width, height = _BAR
    most = max((each.area for each in bins if not each.low <= 0.0 <= each.high), default=0.0)
    total = sum(each.area for each in bins)
    rows = []
    for each in bins:
        within = each.low <= 0.0 <= each.high
        long = width * each.area / most if most and not within else 0.0
        colour = "#c03030" if each.high < 0.0 else "#2864c8"
        bar = f'<rect width="{long:.1f}" height="{height}" fill="{colour}"/>' if long else ""
        picture = f'<svg width="{width}" height="{height}" aria-hidden="true">{bar}</svg>'
        rows.append(
            f"<tr><td class=n>{format_fixed(each.low)} … {format_fixed(each.high)}</td>"
            f"<td class=n>{each.area:.1f}</td><td class=n>{100.0 * each.area / max(total, 1e-12):.2f}</td>"
            f"<td>{escape(label('as_design')) if within else picture}</td></tr>"
        )
    heads = ("#from_to", "#surface", "#percent", "-")
    return f"<h3>{escape(label('deviation'))}</h3>\n" + said_table(heads, rows, "tight")
