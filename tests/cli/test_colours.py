"""Severities have colours on a terminal that has them, unless ``NO_COLOR`` forbids it."""

import io
import sys

import pytest

from trunnion.cli import main
from trunnion.cli.terminal_text import painted


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_colours_are_for_terminals_that_have_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert painted("error", "error", _Terminal()) == "\x1b[1;31merror\x1b[0m"
    assert painted("error", "error", io.StringIO()) == "error"
    monkeypatch.setenv("TERM", "dumb")
    assert painted("error", "error", _Terminal()) == "error"
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("NO_COLOR", "1")
    assert painted("error", "error", _Terminal()) == "error"


@pytest.mark.parametrize("words", [["--help"], ["diff", "--help"]])
def test_titles_of_help_are_bold(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    out = _Terminal()
    monkeypatch.setattr(sys, "stdout", out)
    with pytest.raises(SystemExit):
        main(words)
    assert "\x1b[1m" in out.getvalue()
    assert "\ufffd" not in out.getvalue()
