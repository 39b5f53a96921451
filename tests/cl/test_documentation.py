"""The page about CL files and the reader do not drift apart."""

import re
from collections.abc import Callable

import pytest

from tests.support.locations import DOCS
from trunnion import convert, read_cl
from trunnion.cl.arcs import RADIUS_TOLERANCE
from trunnion.cl.dialects import DIALECTS
from trunnion.cl.phases import COLOUR_PHASES
from trunnion.cl.statements import HANDLERS
from trunnion.cl.writers import WRITERS

PAGE = (DOCS / "cl.md").read_text(encoding="utf-8")


def test_every_statement_that_is_read_is_in_the_page() -> None:
    named = set(re.findall(r"`([A-Z-]+(?: PATH)?)", PAGE))
    assert {major.replace("TOOLPATH", "TOOL PATH") for major in HANDLERS} <= named


def test_every_colour_and_the_tolerance_are_in_the_page() -> None:
    assert all(re.search(rf"\| {colour} \|", PAGE) for colour in COLOUR_PHASES)
    assert f"{RADIUS_TOLERANCE} mm" in PAGE


def test_the_table_of_dialects_is_that_of_the_registry() -> None:
    page = (DOCS / "cl-dialects.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([a-z]+)` \| [^|]+ \| ([^|]+) \|$", page, re.MULTILINE)
    assert [name for name, _ in rows] == list(DIALECTS)
    for name, samples in rows:
        lines = [sample.encode() for sample in re.findall(r"`([^`]+)`", samples)]
        dialect = DIALECTS[name]
        patterns = dialect.marks if dialect.first_line is None else (dialect.first_line,)
        assert all(any(mark.match(line) for mark in patterns) for line in lines), name
        missing = [mark.pattern for mark in patterns if not any(mark.match(line) for line in lines)]
        assert not missing, name


@pytest.mark.parametrize("page", ["batch.md", "cl-dialects.md", "commands.md", "convert.md"])
def test_lists_of_dialects_are_those_that_are_read_or_written(page: str) -> None:
    text = re.sub(r" \([^)]*\)", "", (DOCS / page).read_text(encoding="utf-8"))
    name = f"`?(?:{'|'.join(DIALECTS)})`?"
    lists = [re.findall(name, each[0]) for each in re.finditer(rf"{name}(?:(?:, | or | and |\|){name})+", text)]
    assert lists
    assert all({each.strip("`") for each in listed} in (set(DIALECTS), set(WRITERS)) for listed in lists), lists


def test_the_library_names_the_dialects_that_it_reads_and_writes() -> None:
    assert _named(read_cl) >= set(DIALECTS)
    assert _named(convert) >= set(WRITERS)


def _named(function: Callable[..., object]) -> set[str]:
    """The words between quotation marks in the docstring of a function."""
    return set(re.findall(r'``"([a-z]+)"``', function.__doc__ or ""))
