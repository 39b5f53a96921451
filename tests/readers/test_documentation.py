"""The page about the reader and the reader do not drift apart."""

import re

from tests.support.locations import DOCS
from trunnion.readers.control import iso_m_codes
from trunnion.readers.families.sinumerik import cycles, expressions, flow, words
from trunnion.readers.families.sinumerik.text import MAX_NESTING
from trunnion.readers.program import limits, options, source_text

PAGE = (DOCS / "reader.md").read_text(encoding="utf-8")

#: What stands in backticks, without its value or arguments.
IN_THE_PAGE = {re.split(r"[ =(\[]", word)[0] for word in re.findall(r"`([^`\n]+)`", PAGE)}

G_WORDS = {
    *words.G_PLANES,
    *words.G_UNITS,
    *words.G_FEEDS,
    *words.G_MACHINE,
    *words.G_WITHOUT_PATH_EFFECT,
    *words.G_NOT_SIMULATED,
    *words.G_NO_MOTION,
    *(words.G_OFFSETS - set(range(506, 599)) - {55, 56}),
    0, 1, 2, 3, 4, 90, 91,
}  # fmt: skip

NAMES = (
    words.WITHOUT_PATH_EFFECT
    | words.WITHOUT_PATH_EFFECT_VALUES
    | words.WITHOUT_PATH_EFFECT_CALLS
    | words.NOT_SIMULATED
    | words.ORIENTATION
    | words.FRAMES
    | words.FLOW
    | words.TYPES
    | words.POSITION_MODES
    | words.ACTIVE
    | set(words.CONSTANTS)
    | set(cycles.CYCLES)
    | {"CYCLE800", "CYCLE832"}
    | set(expressions.FUNCTIONS)
    | expressions.OPERATORS
    | set(flow.Flow(lambda *_: None).handlers)
)


def test_every_g_word_is_in_the_page() -> None:
    assert sorted({f"G{code}" for code in G_WORDS} - IN_THE_PAGE) == []


def test_every_name_is_in_the_page() -> None:
    assert sorted(NAMES - IN_THE_PAGE) == []


def test_every_m_word_and_event_is_in_the_page() -> None:
    codes = {*iso_m_codes.EVENTS, *iso_m_codes.PROGRAM_ENDS, words.M_RETURN, iso_m_codes.TOOL_CHANGE}
    assert {f"M{code}" for code in codes} <= IN_THE_PAGE
    assert {kind for kind, _ in iso_m_codes.EVENTS.values()} <= IN_THE_PAGE


def test_limits_are_those_of_the_page() -> None:
    plain = PAGE.replace(" 000", "000")
    assert str(options.DEFAULT_OPTIONS.step_limit) in plain
    assert f"After {limits.MAX_DIAGNOSTICS} diagnostics" in plain
    assert f"After {limits.MAX_ERRORS} errors" in plain
    assert f"at most {MAX_NESTING} inside" in plain
    assert f"At most {limits.MAX_CALL_DEPTH} programs" in plain
    assert f"calls at most {limits.MAX_SUBPROGRAMS} files" in plain
    assert f"for every {limits.CHARACTERS_PER_STEP} characters" in plain
    assert f"at most {expressions.MAX_NESTING} deep" in plain
    assert f"at most {source_text.MAX_LOADED_SIZE >> 20} MiB" in plain
