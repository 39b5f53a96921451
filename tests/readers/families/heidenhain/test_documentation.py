"""The page about Klartext and the reader do not drift apart."""

import re

from tests.support.locations import DOCS
from trunnion.families import FAMILIES
from trunnion.readers.families.heidenhain import cycles, flow, fn_functions, parameters, words

PAGE = (DOCS / "reader-klartext.md").read_text(encoding="utf-8")
READER = (DOCS / "reader.md").read_text(encoding="utf-8")

#: What stands in backticks.
IN_THE_PAGE = set(re.findall(r"`([^`\n]+)`", PAGE))

M_WORDS = {
    *words.M_EVENTS, *words.M_AFTER_MOTION, *words.M_WITHOUT_PATH_EFFECT, *words.M_NOT_SIMULATED,
    *words.M_PROGRAM_ENDS, words.M_MACHINE, words.M_SECOND_MACHINE, words.M_SHORTEST, words.M_TCP, words.M_CALL_MODAL,
    words.M_PER_TURN, words.M_PER_MINUTE,
}  # fmt: skip


def test_every_m_word_is_in_the_page() -> None:
    assert sorted({f"M{code}" for code in M_WORDS} - IN_THE_PAGE) == []


def test_every_block_and_function_is_in_the_page() -> None:
    assert sorted({*words.PATHS, *words.BLOCKS_NOT_SIMULATED, *parameters.FUNCTIONS} - IN_THE_PAGE) == []


def test_every_cycle_is_in_the_page() -> None:
    numbers = {*cycles.CYCLES, *cycles.LEGACY_CYCLES, 7, 8, 9, 10, 11, 13, 26, 32, 247}
    assert sorted({f"CYCL DEF {number}" for number in numbers} - IN_THE_PAGE) == []


def test_every_cycle_that_is_only_named_is_in_the_page() -> None:
    assert sorted({str(number) for number in words.CYCLES_NOT_SIMULATED} - IN_THE_PAGE) == []


def test_every_fn_function_is_in_the_page() -> None:
    numbers = {
        0,
        18,
        *words.FN_NOT_SIMULATED,
        *fn_functions._ARITHMETIC,
        *fn_functions._SINGLE,
        *fn_functions._CONDITIONS,
    }
    assert {f"FN {number}" for number in numbers} <= IN_THE_PAGE


def test_limits_are_those_of_the_page() -> None:
    assert f"at most {flow.MAX_LABEL_DEPTH}" in PAGE
    assert f"at most {parameters.MAX_NESTING} deep" in PAGE


def test_every_family_is_in_the_page_about_readers() -> None:
    assert all(f"`{name}`" in READER for name in FAMILIES)
