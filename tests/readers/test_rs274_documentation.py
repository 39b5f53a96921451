"""The pages about LinuxCNC, Fanuc and Fidia and their readers do not drift apart."""

import re

import pytest

from tests.support.words_page import TABLES, file_of, page
from trunnion.readers.families.fanuc import text as fanuc_text
from trunnion.readers.families.fanuc import variables
from trunnion.readers.families.linuxcnc import parameters
from trunnion.readers.families.linuxcnc import text as linuxcnc_text
from trunnion.readers.rs274 import expressions

PAGES = {name: file_of(name).read_text(encoding="utf-8") for name in TABLES}
WORDS = {name: {word.split("[")[0] for word in re.findall(r"`([^`\n]+)`", page)} for name, page in PAGES.items()}


@pytest.mark.parametrize("name", TABLES)
def test_the_words_of_a_page_are_those_of_the_reader(name: str) -> None:
    assert PAGES[name] == page(name), "run: python -m tests.support.words_page"


@pytest.mark.parametrize(("name", "arithmetic"), [("linuxcnc", parameters.ARITHMETIC), ("fanuc", variables.ARITHMETIC)])
def test_operators_and_functions_are_in_their_pages(name: str, arithmetic: expressions.Arithmetic) -> None:
    assert {operator for level in arithmetic.levels for operator in level} <= WORDS[name]
    assert {*arithmetic.functions, *arithmetic.pairs} <= WORDS[name]


def test_limits_are_those_of_the_pages() -> None:
    plain = " ".join(PAGES["linuxcnc"].split())
    assert f"at most {expressions.MAX_NESTING} deep" in plain
    assert f"at most {linuxcnc_text.MAX_NESTING} deep" in plain
    assert f"equal within {parameters.EQUAL:.4f}" in plain
    assert f"at most {fanuc_text.MAX_NESTING} inside" in PAGES["fanuc"]
