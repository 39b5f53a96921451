"""A survey of a folder as one HTML page that needs nothing else, and runs no script.

In:     ``SurveyContent``.
Out:    UTF-8. All text from outside is escaped.
"""

from collections.abc import Iterable, Sequence
from importlib.resources import files

from trunnion.records import dataclass
from trunnion.reporting.html_text import escape, page_head, source_hash
from trunnion.reporting.page_words import on_survey
from trunnion.reporting.text import clean


@dataclass(frozen=True, slots=True)
class RateRow:
    """How files of one dialect or likeness fare on one control."""

    kind: str
    looks: str
    control: str
    files: int
    passed: int
    became: str


@dataclass(frozen=True, slots=True)
class BlockerRow:
    """A code that keeps files from going through: in how many, in how many alone, and the first of them."""

    code: str
    files: int
    opens: int
    place: str
    what: str
    cure: str


@dataclass(frozen=True, slots=True)
class FileRow:
    """A file: what it is, what became of it, on how many machines it went through, and why not on the others.

    is_proven  on all of them, against its CL file
    """

    file: str
    kind: str
    looks: str
    became: str
    is_proven: bool
    is_in_part: bool
    through: str
    reasons: Sequence[str]


@dataclass(frozen=True, slots=True)
class SurveyContent:
    """What the page says.

    facts     names and values at the head
    machines  with their controls
    others    machines on which programs were read as well
    """

    folder: str
    facts: Sequence[tuple[str, str]]
    machines: Sequence[tuple[str, str]]
    others: Sequence[str]
    rates: Sequence[RateRow]
    blockers: Sequence[BlockerRow]
    files: Sequence[FileRow]


def render_survey_page(content: SurveyContent) -> bytes:
    """Return the page."""
    style = "\n" + files("trunnion.reporting").joinpath("page.css").read_text(encoding="utf-8")
    policy = f"default-src 'none'; style-src {source_hash(style)}; base-uri 'none'; form-action 'none'"
    facts = "".join(f"<div><dt>{escape(name)}</dt><dd>{escape(value)}</dd></div>" for name, value in content.facts)
    title = on_survey("survey_of", folder=clean(content.folder))
    listed = on_survey(
        "machines", machines=tuple(f"{clean(name)} ({clean(control)})" for name, control in content.machines)
    )
    if content.others:
        others = tuple(map(clean, content.others))
        listed = on_survey("machines_and_others", machines=listed, others=others)
    parts = (_rates(content.rates), _blockers(content.blockers), _files(content.files))
    body = f"""<body>
<main>
<header>
<h1>{escape(title)}</h1>
<dl>{facts}</dl>
<p class="note">{escape(on_survey("how"))} {escape(listed)}</p>
</header>
{"".join(parts)}</main>
</body>
</html>
"""
    return (page_head(title, style, policy, "survey") + body).encode()


def _rates(rates: Sequence[RateRow]) -> str:
    rows = (
        (_cell(each.kind), _cell(each.looks or on_survey("no_control")), _cell(each.control),
         _number(on_survey("of", passed=each.passed, count=each.files)), _cell(each.became))
        for each in rates
    )  # fmt: skip
    return _section("by_dialect", ("what", "looks_like", "control", "#went_through", "became"), rows)


def _blockers(blockers: Sequence[BlockerRow]) -> str:
    rows = (
        (_cell(each.code), _number(each.files), _number(each.opens), _cell(each.place), _cell(each.what),
         _cell(each.cure))
        for each in blockers
    )  # fmt: skip
    heads = ("code", "#files", "#no_other_error", "first_place", "fault", "cure")
    return _section("blocked_by", heads, rows, on_survey("further_faults")) if blockers else ""


def _files(found: Sequence[FileRow]) -> str:
    rows = "".join(
        f'<tr class="{_colour(each)}"><th scope=row><bdi>{_text(each.file)}</bdi></th>{_cell(each.kind)}'
        f"{_cell(each.looks)}<td><span class=tag>{_text(each.became)}</span></td>{_number(each.through)}"
        f"<td>{'<br>'.join(map(_text, each.reasons))}</td></tr>\n"
        for each in found
    )
    head = _head(("file", "what", "looks_like", "became", "#on_machines", "why"))
    table = f'<div class="wide"><table>\n{head}<tbody>\n{rows}</tbody>\n</table></div>'
    return f"<section>\n<h2>{escape(on_survey('files'))}</h2>\n{table}\n</section>\n"


def _colour(each: FileRow) -> str:
    """Return the class of a row: proven; in part, or only read; not. One that was not tried has none."""
    if not each.through:
        return ""
    return "good" if each.is_proven else "open" if each.is_in_part else "bad"


def _section(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]], note: str = "") -> str:
    lines = "".join(f"<tr>{''.join(cells)}</tr>\n" for cells in rows)
    said = f'<p class="note">{escape(note)}</p>\n' if note else ""
    return (
        f'<section>\n<h2>{escape(on_survey(title))}</h2>\n<div class="wide"><table>\n{_head(heads)}'
        f"<tbody>\n{lines}</tbody>\n</table></div>\n{said}</section>\n"
    )


def _head(heads: Sequence[str]) -> str:
    cells = "".join(
        f"<th scope=col{' class=n' if each[0] == '#' else ''}>{escape(on_survey(each.lstrip('#')))}</th>"
        for each in heads
    )
    return f"<thead><tr>{cells}</tr></thead>\n"


def _cell(text: str) -> str:
    return f"<td><bdi>{_text(text)}</bdi></td>"


def _number(text: object) -> str:
    return f"<td class=n>{escape(text)}</td>"


def _text(text: str) -> str:
    return escape(clean(text))
