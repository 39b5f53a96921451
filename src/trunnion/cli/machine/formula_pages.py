"""A page of formulas as text, Markdown or LaTeX, from blocks that say nothing of how they look."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Final, TypeAlias

from trunnion.cli.columns import columns_of, padded
from trunnion.formulas.notation import name_as_latex
from trunnion.formulas.steps import Formula
from trunnion.messages import ENGLISH
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading; 1 is that of the page."""

    level: int
    text: str


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Sentences, one a line where lines count."""

    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Equations:
    """Formulas below each other."""

    formulas: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Matrix:
    """The matrix of a frame within another one."""

    within: str
    frame: str
    rows: tuple[tuple[str, ...], ...]
    latex: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class TableOf:
    """A table; with ``symbols`` its first column is mathematics."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    symbols: bool = False


Block: TypeAlias = Heading | Paragraph | Equations | Matrix | TableOf

_IN_TEXT: Final = "  "

#: What a document begins with in each language.
_PREAMBLES: Final = {
    "en": (r"\documentclass{article}", r"\usepackage[T1]{fontenc}"),
    "de": (r"\documentclass{article}", r"\usepackage[T1]{fontenc}", r"\usepackage[ngerman]{babel}"),
    "zh": (r"\documentclass{ctexart}",),
}

_LATEX_HEADS: Final = (r"\section*", r"\subsection*", r"\subsubsection*")

_LATEX_CHARACTERS: Final = str.maketrans({
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}",
    "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "°": r"\textdegree{}", "²": r"\texttwosuperior{}",
})  # fmt: skip

_MARKDOWN_CHARACTERS: Final = str.maketrans({each: f"\\{each}" for each in "\\`*_{}[]<>|#$"})


def page_lines(blocks: Iterable[Block], notation: str, language: str = ENGLISH) -> Iterator[str]:
    """Yield the lines of a page.

    notation  ``text``, ``markdown`` (formulas between $$) or ``latex`` (a whole document)
    language  of its words, which LaTeX sets by: Chinese wants XeLaTeX or LuaLaTeX
    """
    write = _WRITERS[notation]
    if notation == "latex":
        yield from (*_PREAMBLES[language], r"\usepackage{amsmath,textcomp}", r"\begin{document}")
    for k, block in enumerate(blocks):
        if k and notation != "latex":
            yield ""
        yield from write(block)
    if notation == "latex":
        yield r"\end{document}"


def _as_text(block: Block) -> Iterator[str]:
    match block:
        case Heading(level, text):
            yield text
            yield from [("=" if level == 1 else "-") * columns_of(text)] if level < 3 else []
        case Paragraph(lines):
            yield from lines
        case Equations(formulas):
            width = max(len(each.name) for each in formulas)
            yield from (f"{_IN_TEXT}{each.name:<{width}} = {each.text}" for each in formulas)
        case Matrix(within, frame, rows, _):
            yield f"{within} -> {frame}"
            yield from _columns(rows)
        case TableOf(heads, rows, _):
            yield from _columns((heads, *rows))


def _columns(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    widths = [max(map(columns_of, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (padded(cell, width) for cell, width in zip(row, widths, strict=True))
        yield (_IN_TEXT + "  ".join(cells)).rstrip()


def _as_markdown(block: Block) -> Iterator[str]:
    match block:
        case Heading(level, text):
            yield f"{'#' * level} {text.translate(_MARKDOWN_CHARACTERS)}"
        case Paragraph(lines):
            yield from (line.translate(_MARKDOWN_CHARACTERS) for line in lines)
        case Equations(formulas):
            yield "$$"
            yield from _aligned(formulas)
            yield "$$"
        case Matrix(_, _, _, _):
            yield "$$"
            yield from _matrix(block)
            yield "$$"
        case TableOf(heads, rows, symbols):
            yield f"| {' | '.join(heads)} |"
            yield f"|{' --- |' * len(heads)}"
            for first, *others in rows:
                head = f"${name_as_latex(first)}$" if symbols else first.translate(_MARKDOWN_CHARACTERS)
                yield f"| {' | '.join((head, *(cell.translate(_MARKDOWN_CHARACTERS) for cell in others)))} |"


def _as_latex(block: Block) -> Iterator[str]:
    match block:
        case Heading(level, text):
            yield f"{_LATEX_HEADS[level - 1]}{{{text.translate(_LATEX_CHARACTERS)}}}"
        case Paragraph(lines):
            yield from (line.translate(_LATEX_CHARACTERS) for line in lines)
            yield ""
        case Equations(formulas):
            yield r"\["
            yield from _aligned(formulas)
            yield r"\]"
        case Matrix(_, _, _, _):
            yield r"\["
            yield from _matrix(block)
            yield r"\]"
        case TableOf(heads, rows, symbols):
            yield rf"\begin{{tabular}}{{{'l' * len(heads)}}}"
            yield rf"{' & '.join(heads)} \\ \hline"
            for first, *others in rows:
                head = f"${name_as_latex(first)}$" if symbols else first.translate(_LATEX_CHARACTERS)
                yield rf"{' & '.join((head, *(cell.translate(_LATEX_CHARACTERS) for cell in others)))} \\"
            yield r"\end{tabular}"
            yield ""


def _aligned(formulas: Sequence[Formula]) -> Iterator[str]:
    yield r"\begin{aligned}"
    yield from (each.latex.replace(" = ", " &= ", 1) + r" \\" for each in formulas)
    yield r"\end{aligned}"


def _matrix(block: Matrix) -> Iterator[str]:
    yield rf"{{}}^{{\mathrm{{{_index(block.within)}}}}}T_{{\mathrm{{{_index(block.frame)}}}}} = \begin{{pmatrix}}"
    yield from (" & ".join(row) + r" \\" for row in block.latex)
    yield r"\end{pmatrix}"


def _index(name: str) -> str:
    return name.replace("_", r"\_")


_WRITERS: Final[dict[str, Callable[[Block], Iterator[str]]]] = {
    "text": _as_text,
    "markdown": _as_markdown,
    "latex": _as_latex,
}
