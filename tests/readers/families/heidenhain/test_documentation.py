"""The page about Klartext and the reader do not drift apart."""

import re

import pytest

from tests.support.locations import DOCS
from trunnion.families import FAMILIES
from trunnion.readers.families.heidenhain import cycles, flow, fn_functions, parameters, words

PAGE = (DOCS / "reader-klartext.md").read_text(encoding="utf-8")
READER = (DOCS / "reader.md").read_text(encoding="utf-8")

#: What stands in backticks.
NOT_SIMULATED = set(re.findall(r"`([^`\n]+)`", PAGE))

M_WORDS = {
    *words.M_EVENTS, *words.M_AFTER_MOTION, *words.M_WITHOUT_PATH_EFFECT, *words.M_NOT_SIMULATED,
    *words.M_PROGRAM_ENDS, words.M_MACHINE, words.M_SECOND_MACHINE, words.M_SHORTEST, words.M_TCP, words.M_CALL_MODAL,
    words.M_PER_TURN, words.M_PER_MINUTE,
}  # fmt: skip


@pytest.mark.parametrize("code", sorted(M_WORDS))
def test_every_m_word_is_in_the_page(code: int) -> None:
    assert f"M{code}" in NOT_SIMULATED


@pytest.mark.parametrize("word", sorted(words.PATHS | words.BLOCKS_NOT_SIMULATED.keys() | parameters.FUNCTIONS.keys()))
def test_every_block_and_function_is_in_the_page(word: str) -> None:
    assert word in NOT_SIMULATED


@pytest.mark.parametrize("number", sorted({*cycles.CYCLES, *cycles.LEGACY_CYCLES, 7, 8, 9, 10, 11, 13, 26, 32, 247}))
def test_every_cycle_is_in_the_page(number: int) -> None:
    assert f"CYCL DEF {number}" in NOT_SIMULATED


@pytest.mark.parametrize("number", sorted(words.CYCLES_NOT_SIMULATED))
def test_every_cycle_that_is_only_named_is_in_the_page(number: int) -> None:
    assert str(number) in NOT_SIMULATED


def test_every_fn_function_is_in_the_page() -> None:
    numbers = {
        0,
        18,
        *words.FN_NOT_SIMULATED,
        *fn_functions._ARITHMETIC,
        *fn_functions._SINGLE,
        *fn_functions._CONDITIONS,
    }
    assert {f"FN {number}" for number in numbers} <= NOT_SIMULATED


def test_limits_are_those_of_the_page() -> None:
    assert f"at most {flow.MAX_LABEL_DEPTH}" in PAGE
    assert f"at most {parameters.MAX_NESTING} deep" in PAGE


def test_every_family_is_in_the_page_about_readers() -> None:
    assert all(f"`{name}`" in READER for name in FAMILIES)
