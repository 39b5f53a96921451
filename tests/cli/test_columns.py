"""Lines and tables fit the terminal, and lose nothing; in a file or a pipe they stay as they are."""

import io
import re
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.cli import main
from trunnion.cli.columns import CodeLine, folded, table, width_of

WORDS = st.lists(st.text("abc.,0", min_size=1, max_size=12), min_size=1, max_size=20)


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@settings(max_examples=examples(25))
@given(WORDS, st.sampled_from([" ", "  "]), st.integers(40, 90))
def test_a_line_is_broken_at_blanks_and_keeps_its_words(words: list[str], gap: str, width: int) -> None:
    pieces = list(folded(f"  {gap.join(words)}", width))
    assert " ".join(pieces).split() == words
    assert all(len(piece) <= width for piece in pieces)


def test_what_has_no_blank_and_what_is_code_is_never_cut() -> None:
    long = "a" * 100
    assert list(folded(f"see {long} there", 40)) == ["see", f"  {long}", "  there"]
    code = CodeLine("G1 X1 " * 20)
    assert list(folded(code, 40)) == [code]
    assert list(folded("see " * 40, None)) == ["see " * 40]


@pytest.mark.parametrize("width", range(20, 60))
def test_chinese_lines_neither_begin_with_what_closes_nor_end_with_what_opens(width: int) -> None:
    text = "或存储另一个原点（G28.1）；此前写过的（见“工艺单”）会留在数控系统中，这是警告。" * 2
    pieces = list(folded(text, width))
    assert "".join(piece.strip() for piece in pieces) == text
    assert not [piece for piece in pieces if piece.lstrip()[0] in "，。；）”" or piece[-1] in "（“"]


def test_a_line_goes_on_under_its_last_column() -> None:
    assert list(folded("tip   ok    largest 0.000000 mm in X, Y or Z, rms 0.000000", 40)) == [
        "tip   ok    largest 0.000000 mm in X, Y",
        "            or Z, rms 0.000000",
    ]


def test_columns_without_room_stand_in_further_lines() -> None:
    rows = [("name", "off by", "at", "rms"), ("zero", "0.01", "N470 (line 47)", "0.00176")]
    assert list(table(rows, None, frozenset({1, 3}))) == [
        "name  off by  at                  rms",
        "zero    0.01  N470 (line 47)  0.00176",
    ]
    assert list(table(rows, 30, frozenset({1, 3}))) == [
        "name  off by  at",
        "        rms",
        "zero    0.01  N470 (line 47)",
        "    0.00176",
    ]


@pytest.mark.parametrize("command", [["machines"], ["controls"], ["check", "yl569"], ["explain", "CL110"]])
def test_what_a_command_lists_fits_a_terminal_of_80_columns(
    command: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, narrow = io.StringIO(), _Terminal()
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "80")
    for stream in (whole, narrow):
        monkeypatch.setattr(sys, "stdout", stream)
        assert main(command) == 0
    template = re.compile(r"    .*\{|    ;")  # lines of a program
    lines = [line for line in narrow.getvalue().splitlines() if not template.match(line)]
    assert [line for line in lines if len(line) > 80] == []
    assert sorted(narrow.getvalue().split()) == sorted(whole.getvalue().split())


def test_a_terminal_says_how_wide_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "72")
    assert (width_of(_Terminal()), width_of(io.StringIO())) == (72, None)
    monkeypatch.setenv("COLUMNS", "3")
    assert width_of(_Terminal()) == 40
    monkeypatch.delenv("COLUMNS")
    assert width_of(_Terminal()) is None
