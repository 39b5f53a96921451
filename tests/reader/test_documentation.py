"""The page about the reader and the reader do not drift apart."""

import re
from pathlib import Path

import pytest

from trunnion.readers.common import interpreter, text
from trunnion.readers.families.sinumerik import cycles, expressions, flow, words
from trunnion.readers.families.sinumerik.text import DEEPEST

PAGE = (Path(__file__).parents[2] / "docs" / "reader.md").read_text(encoding="utf-8")

#: What stands in backticks, without its value or arguments.
NAMED = {re.split(r"[ =(\[]", word)[0] for word in re.findall(r"`([^`\n]+)`", PAGE)}

G_WORDS = {
    *words.G_PLANES,
    *words.G_UNITS,
    *words.G_FEEDS,
    *words.G_MACHINE,
    *words.G_SILENT,
    *words.G_NAMED,
    *words.G_NO_MOTION,
    *(words.G_OFFSETS - set(range(506, 599)) - {55, 56}),
    0, 1, 2, 3, 4, 90, 91,
}  # fmt: skip

NAMES = (
    words.SILENT
    | words.SILENT_VALUES
    | words.SILENT_CALLS
    | words.NAMED
    | words.ORIENTATION
    | words.FRAMES
    | words.FLOW
    | words.TYPES
    | words.WAYS
    | words.ACTIVE
    | set(words.CONSTANTS)
    | set(cycles.CYCLES)
    | {"CYCLE800", "CYCLE832"}
    | set(expressions.FUNCTIONS)
    | expressions.OPERATORS
    | set(flow.Flow(lambda *_: None).handlers)
)


@pytest.mark.parametrize("code", sorted(G_WORDS))
def test_every_g_word_is_in_the_page(code: int) -> None:
    assert f"G{code}" in NAMED


@pytest.mark.parametrize("name", sorted(NAMES))
def test_every_name_is_in_the_page(name: str) -> None:
    assert name in NAMED


def test_every_m_word_and_event_is_in_the_page() -> None:
    codes = {*words.M_EVENTS, *words.M_SPINDLE, *words.M_ENDS, words.M_RETURN, words.M_CHANGE}
    assert {f"M{code}" for code in codes} <= NAMED
    assert {kind for kind, _ in words.M_EVENTS.values()} <= NAMED


def test_limits_are_those_of_the_page() -> None:
    plain = PAGE.replace(" 000", "000")
    assert str(interpreter.STEPS) in plain
    assert f"After {interpreter.MOST_FINDINGS} findings" in plain
    assert f"at most {DEEPEST} inside" in plain
    assert f"At most {interpreter.DEEPEST_CALL} programs" in plain
    assert f"calls at most {interpreter.MOST_FILES} files" in plain
    assert f"for every {interpreter.LONG} characters" in plain
    assert f"at most {expressions.DEEPEST} deep" in plain
    assert f"at most {text.LARGEST_WHOLE >> 20} MiB" in plain
