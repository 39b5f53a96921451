"""The report of a sensitivity: what each geometry number of a machine does to a program, as one HTML page.

In:     ``SensitivityContent`` and ``PlotSeries``.
Out:    UTF-8 HTML that needs nothing else, with all text from outside escaped.
"""

from collections.abc import Iterator, Sequence

from trunnion.messages import LIBRARY, Words
from trunnion.records import dataclass
from trunnion.reporting.html_page import plot_page
from trunnion.reporting.html_text import escape, format_number, note_lines, said_table
from trunnion.reporting.page_words import in_language, label
from trunnion.reporting.plot_series import PlotSeries


@dataclass(frozen=True, slots=True)
class ErrorCells:
    """How far the tip is off: largest and rms, mm, and the block of the largest in words."""

    largest: float
    rms: float
    place: str


@dataclass(frozen=True, slots=True)
class NumberRow:
    """One number: its name, how far it is off in words, tip errors as they are and with the zero set, axis error."""

    name: str
    amount: str
    tip: ErrorCells
    zeroed: ErrorCells | None
    axis_deg: float


@dataclass(frozen=True, slots=True)
class SensitivityContent:
    """What the page says besides its plots.

    facts    names and values at the head
    numbers  the worst first
    notes    paragraphs below the table
    """

    program: str
    facts: Sequence[tuple[str, str]]
    numbers: Sequence[NumberRow]
    notes: Sequence[str]


def render_sensitivity_page(content: SensitivityContent, series: PlotSeries, words: Words = LIBRARY) -> Iterator[bytes]:
    """Yield the page in the language of who asks, piece by piece."""
    with in_language(words):
        title, body = label("sensitivity_title", program=content.program), _body(content)
    yield from plot_page(title, body, [series], words, command="sensitivity")


def _body(content: SensitivityContent) -> str:
    facts = "".join(
        f"<div><dt>{escape(name)}</dt><dd><bdi>{escape(value)}</bdi></dd></div>" for name, value in content.facts
    )
    notes = note_lines(content.notes)
    return f"""<body>
<main>
<header>
<h1>{escape(label("sensitivity_of", program=content.program))}</h1>
<dl>{facts}</dl>
</header>
<section>
<h2>{escape(label("tip_errors"))}</h2>
{_table(content.numbers)}
{notes}</section>
"""


def _table(numbers: Sequence[NumberRow]) -> str:
    zeroed = any(each.zeroed is not None for each in numbers)
    heads = ["number_of_machine", "#off_by"]
    heads += ["#with_zero_set", "at", "#rms"] if zeroed else []
    heads += ["#as_it_is", "at", "#rms", "#axis_error"]
    return said_table(heads, map(_row, numbers))


def _row(each: NumberRow) -> str:
    cells = "".join(
        f"<td class=n>{_fixed(errors.largest)}</td><td class=at>{escape(errors.place)}</td>"
        f"<td class=n>{_fixed(errors.rms)}</td>"
        for errors in (each.zeroed, each.tip)
        if errors is not None
    )
    axis = format_number(each.axis_deg) if each.axis_deg else ""
    return (
        f"<tr><th scope=row><bdi>{escape(each.name)}</bdi></th><td class=n>{escape(each.amount)}</td>{cells}"
        f"<td class=n>{axis}</td></tr>"
    )


def _fixed(value: float) -> str:
    return f"{value:.5f}"
