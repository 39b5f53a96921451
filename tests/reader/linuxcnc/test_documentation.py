"""The page about LinuxCNC and the reader do not drift apart."""

import re
from pathlib import Path

import pytest

from trunnion.reader.linuxcnc import blocks, words

PAGE = (Path(__file__).parents[3] / "docs" / "reader-linuxcnc.md").read_text(encoding="utf-8")
NAMED = set(re.findall(r"`([^`\n]+)`", PAGE))

G_WORDS = {
    *words.MOTIONS, *words.PLANES, *words.UNITS, *words.DISTANCES, *words.ARC_DISTANCES, *words.FEED_MODES,
    *words.OFFSETS, *words.RETURNS, *words.CYCLES, *words.SILENT, *words.NAMED, words.DWELL,
    words.MACHINE, words.CANCEL,
}  # fmt: skip
M_WORDS = {
    *words.M_EVENTS, *words.M_ENDS, *words.M_SILENT, *words.M_NAMED, *words.M_CALLS, words.M_CHANGE, words.M_TCP,
    words.M_IDENTITY,
}  # fmt: skip


@pytest.mark.parametrize("code", sorted(G_WORDS))
def test_every_g_word_is_in_the_page(code: int) -> None:
    assert f"G{code / 10:g}" in NAMED


@pytest.mark.parametrize("code", sorted(M_WORDS))
def test_every_m_word_is_in_the_page(code: int) -> None:
    assert f"M{code}" in NAMED


def test_every_function_and_limit_is_in_the_page() -> None:
    assert {*blocks._FUNCTIONS, "ATAN"} <= NAMED
    assert {operator for level in blocks._LEVELS for operator in level} <= NAMED
    assert f"most {blocks.DEEPEST} deep" in " ".join(PAGE.split())
    assert f"up to {blocks.HIGHEST} " in PAGE
