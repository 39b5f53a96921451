"""Text and numbers as HTML."""

import base64
import hashlib
import html
import math
import re
from collections.abc import Iterable, Sequence
from typing import Final

from trunnion.reporting.page_words import label, language_tag, verdict_word, word
from trunnion.verification import Verdict

#: A negative number with the letter before it, and where a cell of a row begins.
_NEGATIVE: Final = re.compile(r"(?<![\w-])[A-Za-z]{0,2}-\d[\d.]*")
_CELL: Final = re.compile(r"<t[dh]\b")

#: The class of a banner of each verdict, and its sign.
_BANNERS: Final = {
    Verdict.PASSED: ("good", "✓"),
    Verdict.IN_PART: ("open", "–"),
    Verdict.FAILED: ("bad", "✗"),
    Verdict.NOTHING: ("none", "–"),
}


def escape(value: object) -> str:
    """Return text escaped for HTML and for attributes in double quotes."""
    return html.escape(str(value), quote=True)


def prose(text: object) -> str:
    """Return a sentence escaped, with no break between a minus and its number: ``X-41.5`` never reads as positive."""
    return _NEGATIVE.sub(r'<span class="nb">\g<0></span>', escape(text))


def table(headings: Sequence[str], rows: Iterable[str], kind: str = "") -> str:
    """Return a table that may be wider than the page.

    headings  one with ``#`` is that of a column of numbers, ``-`` an empty one
    rows      HTML
    kind      its class; each cell of a ``tight`` one has the heading of its column, for pages too narrow for columns
    """
    names = [head.lstrip("#").strip("-") for head in headings]
    cells = "".join(
        f"<th scope=col class=n>{name}</th>" if head[:1] == "#" else f"<th scope=col>{name}</th>"
        for head, name in zip(headings, names, strict=True)
    )
    body = "\n".join(_labelled(row, names) if kind == "tight" else row for row in rows)
    head = f"<thead><tr>{cells}</tr></thead>"
    return f'<div class="wide {kind}"><table>\n{head}\n<tbody>\n{body}\n</tbody></table></div>\n'


def said_table(headings: Sequence[str], rows: Iterable[str], kind: str = "") -> str:
    """Return a table; headings are names of texts, behind ``#`` those of columns of numbers."""
    marks = (head[:1] if head[:1] == "#" else "" for head in headings)
    names = (head.lstrip("#") for head in headings)
    said = [f"{mark}{name if name == '-' else escape(label(name))}" for mark, name in zip(marks, names, strict=True)]
    return table(said, rows, kind)


def _labelled(row: str, names: Sequence[str]) -> str:
    of_cells = iter(names)
    return _CELL.sub(lambda cell: f'{cell[0]} data-of="{next(of_cells, "")}"', row)


def made_by(command: str) -> str:
    """Return the element that says which command has made a page: no other command replaces it."""
    return f'<meta name="generator" content="trunnion {command}">'


def page_head(title: str, style: str, policy: str, command: str) -> str:
    """Return the beginning of a page up to its body; ``policy`` says what it may load and run, ``command`` what has
    made it.
    """
    return f"""<!DOCTYPE html>
<html lang="{language_tag()}">
<head>
<meta charset="utf-8">
{made_by(command)}
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{escape(title)}</title>
<style>{style}</style>
</head>
"""


def verdict_banner(verdict: Verdict, said: str) -> str:
    """Return the banner of a page: its verdict, and what that stands on."""
    state, mark = _BANNERS[verdict]
    return f"""<div class="verdict {state}"><span class="mark" aria-hidden="true">{mark}</span>\
<div><strong>{escape(verdict_word(verdict))}</strong>
<span>{prose(said)}</span></div></div>"""


def note_lines(lines: Iterable[str]) -> str:
    """Return lines as notes."""
    return "".join(f'<p class="note">{prose(line)}</p>\n' for line in lines)


def format_number(value: float | None) -> str:
    """Return a number with four significant digits, as a power of ten only if very large or small.

    >>> format_number(0.00123456), format_number(12345.6), format_number(-0.5), format_number(None), format_number(3e-9)
    ('0.001235', '12346', '−0.5', '', '3e−09')
    """
    if value is None or math.isnan(value):
        return ""
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    size = abs(value)
    if size == 0.0 or 1e-7 <= size < 1e9:
        decimals = max(0, 3 - math.floor(math.log10(size))) if size else 0
        digits = f"{value:.{decimals}f}"
        digits = digits.rstrip("0").rstrip(".") if "." in digits else digits
    else:
        digits = f"{value:.3g}"
    return digits.replace("-", "−")


def format_fixed(value: float) -> str:
    """Return a number with three decimals."""
    return f"{value:.3f}".replace("-0.000", "0.000").replace("-", "−")


def format_limit(value: float | None) -> str:
    """Return a limit in words."""
    return label("no_limit") if value is None else format_number(value)


def with_unit(value: float | None, unit: str) -> str:
    """Return a number and its unit; nothing for None."""
    digits = format_number(value)
    return f"{digits} <small>{escape('°' if unit == 'deg' else word(unit))}</small>" if digits and unit else digits


def capitalised(title: str) -> str:
    """Return a title, escaped, with a capital letter."""
    return escape(title[:1].upper() + title[1:])


def format_range(values: tuple[float, float] | None) -> str:
    """Return a lowest and a highest value, once if they are alike."""
    if values is None:
        return ""
    low, high = map(format_number, values)
    return low if low == high else f"{low} … {high}"


def source_hash(source: str) -> str:
    """Return the source expression by which a policy allows a script or style."""
    return "'sha256-" + base64.b64encode(hashlib.sha256(source.encode()).digest()).decode() + "'"
