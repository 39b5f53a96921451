"""The pages about LinuxCNC, Fanuc and Fidia and their readers do not drift apart."""

import re

import pytest

from tests.support.locations import DOCS
from trunnion.readers.families.fanuc import text as fanuc_text
from trunnion.readers.families.fanuc import variables
from trunnion.readers.families.fanuc import words as fanuc
from trunnion.readers.families.fidia import words as fidia
from trunnion.readers.families.linuxcnc import parameters
from trunnion.readers.families.linuxcnc import text as linuxcnc_text
from trunnion.readers.families.linuxcnc import words as linuxcnc
from trunnion.readers.rs274 import expressions

PAGES = {name: (DOCS / f"reader-{name}.md").read_text(encoding="utf-8") for name in ("linuxcnc", "fanuc", "fidia")}
NOT_SIMULATED = {
    name: {word.split("[")[0] for word in re.findall(r"`([^`\n]+)`", page)} for name, page in PAGES.items()
}

TABLES = {"linuxcnc": linuxcnc.TABLE, "fanuc": fanuc.TABLE, "fidia": fidia.TABLE}


@pytest.mark.parametrize("name", PAGES)
def test_every_word_is_in_its_page(name: str) -> None:
    words = {word.text for word in TABLES[name] if word.own and word.code >= 0}
    assert words - NOT_SIMULATED[name] == set()


@pytest.mark.parametrize(("name", "arithmetic"), [("linuxcnc", parameters.ARITHMETIC), ("fanuc", variables.ARITHMETIC)])
def test_operators_and_functions_are_in_their_pages(name: str, arithmetic: expressions.Arithmetic) -> None:
    assert {operator for level in arithmetic.levels for operator in level} <= NOT_SIMULATED[name]
    assert {*arithmetic.functions, *arithmetic.pairs} <= NOT_SIMULATED[name]


def test_limits_are_those_of_the_pages() -> None:
    plain = " ".join(PAGES["linuxcnc"].split())
    assert f"at most {expressions.MAX_NESTING} deep" in plain
    assert f"at most {linuxcnc_text.MAX_NESTING} deep" in plain
    assert f"equal within {parameters.EQUAL:.4f}" in plain
    assert f"at most {fanuc_text.MAX_NESTING} inside" in PAGES["fanuc"]
