"""The language of the command line: what chooses it, and what a terminal that lacks its letters gets."""

import io
import json
import logging
import sys
from pathlib import Path

import pytest

from tests.support.locations import TESTS
from trunnion.cli import SpokenLog, main
from trunnion.cli.command_line.language import speaking, spoken_language, stated_language, with_language
from trunnion.messages import phrase

CHINESE = "有错误"


@pytest.fixture(autouse=True)
def _plain(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("TRUNNION_LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG", "PYTHONIOENCODING"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")


def chosen(words: list[str]) -> tuple[list[str], str, str]:
    """The words without a language, the language that is spoken, and the one that is stated."""
    rest, stated = with_language(words)
    with speaking(stated):
        return rest, spoken_language(), stated_language()


@pytest.mark.parametrize(
    ("stated", "language"),
    [
        ({}, "en"),
        ({"LANG": "zh_CN.UTF-8"}, "zh"),
        ({"LANG": "zh"}, "zh"),
        ({"LANG": "zh-Hans"}, "zh"),
        ({"LANG": "de_AT@euro"}, "de"),
        ({"LANG": "DE_DE"}, "de"),
        ({"LANG": "C"}, "en"),
        ({"LANG": "POSIX"}, "en"),
        ({"LANG": "fr_FR.UTF-8"}, "en"),
        ({"LANG": "dev"}, "en"),
        ({"LANG": "zh_CN.UTF-8", "LC_MESSAGES": "de_DE.UTF-8"}, "de"),
        ({"LANG": "zh_CN.UTF-8", "LC_MESSAGES": "de_DE.UTF-8", "LC_ALL": "C"}, "en"),
        ({"LANG": "zh_CN.UTF-8", "LC_ALL": ""}, "zh"),
    ],
)
def test_the_surroundings_choose(stated: dict[str, str], language: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in stated.items():
        monkeypatch.setenv(name, value)
    assert chosen(["check", "a"]) == (["check", "a"], language, "")


@pytest.mark.parametrize(
    ("variable", "words", "language", "stated"),
    [
        ("zh", [], "zh", "zh"),
        ("zh_CN.UTF-8", [], "zh", "zh"),
        ("zh", ["--language", "en"], "en", "en"),
        ("fr", [], "de", ""),
        ("", [], "de", ""),
    ],
)
def test_the_own_variable_goes_before_the_surroundings(
    variable: str, words: list[str], language: str, stated: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LANG", "de_DE.UTF-8")
    monkeypatch.setenv("TRUNNION_LANGUAGE", variable)
    assert chosen(words) == ([], language, stated)


@pytest.mark.parametrize(
    ("words", "rest", "language"),
    [
        (["check", "a", "--language", "zh"], ["check", "a"], "zh"),
        (["--language=de", "check", "a"], ["check", "a"], "de"),
        (["--lang", "en", "check"], ["check"], "en"),
        (["check", "--language", "zh", "--language", "de"], ["check"], "de"),
        (["check", "--", "--language", "zh"], ["check", "--", "--language", "zh"], "en"),
        (["check", "--language"], ["check", "--language"], "en"),
        (["check", "--language", "fr"], ["check", "--language", "fr"], "en"),
    ],
)
def test_the_option_chooses(words: list[str], rest: list[str], language: str) -> None:
    assert chosen(words)[:2] == (rest, language)


def test_a_language_that_is_none_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    for words, what in ((["--language", "fr", "check"], "write en, zh or de"), (["check", "--language"], "no value")):
        with pytest.raises(SystemExit) as end:
            main(words)
        assert end.value.code == 2
        assert what in capsys.readouterr().err


class Terminal(io.TextIOWrapper):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("encoding", ["gbk", "gb18030", "utf-8", "latin-1", "ascii"])
def test_output_follows_the_terminal(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = io.BytesIO()
    monkeypatch.setattr(sys, "stderr", Terminal(kept, encoding=encoding, write_through=True))
    assert main(["check", "轮毂.toml", "--language", "zh"]) == 2
    text = kept.getvalue().decode(encoding)
    assert ("轮毂" in text) == (encoding not in ("latin-1", "ascii"))
    assert "DEF110" in text or "FIL110" in text


def test_a_terminal_that_lacks_the_letters_is_told_in_english(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    monkeypatch.setattr(sys, "stderr", Terminal(io.BytesIO(), encoding="latin-1"))
    assert chosen([])[1] == "en"
    monkeypatch.setenv("LANG", "de_DE")
    assert chosen([])[1] == "de"


def test_pipes_are_utf8_unless_python_is_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    for stated, encoding in (("", "utf-8"), ("gbk", "gbk"), ("gbk:strict", "gbk"), ("nonsense", "utf-8")):
        kept = io.BytesIO()
        monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(kept, encoding="cp1252", write_through=True))
        monkeypatch.setenv("PYTHONIOENCODING", stated)
        assert main(["check", "轮毂.toml"]) == 2
        assert "轮毂" in kept.getvalue().decode(encoding)


def test_data_is_the_same_in_every_language(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    data = []
    for language in ("en", "zh", "de"):
        assert main(["explain", "CL110", "--json", "-", "--language", language]) == 0
        data.append(json.loads(capsys.readouterr().out))
    assert data[0] == data[1] == data[2]


def test_a_comparison_is_said_in_the_language(capsys: pytest.CaptureFixture[str]) -> None:
    program = str(TESTS / "golden" / "yl569" / "2_hub_rough.expected.mpf")
    assert main(["diff", program, program, "--machine", "yl569", "--language", "de"]) == 0
    assert capsys.readouterr().out.startswith("gleich: ")


@pytest.mark.parametrize(
    ("language", "unstated", "unknown"),
    [("zh", "（未给出）", "无法理解"), ("de", "(nicht angegeben)", "nicht verstanden")],
)
def test_what_is_not_stated_or_understood_is_said_in_the_language(
    language: str, unstated: str, unknown: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    program = tmp_path / "a.mpf"
    program.write_text("G90 G17 G54\nT1 D1\nM6\nS1000 M3\nG0 X0 Y0 Z50 B0 C0\nG1 Z40 C5 F100\nWHO_KNOWS\nM30\n")
    main(["verify", str(program), "--machine", "yl569", "--language", language])
    told = "".join(capsys.readouterr())
    assert unstated in told
    assert "not stated" not in told
    main(["diff", str(program), str(program), "--machine", "yl569", "--language", language])
    told = "".join(capsys.readouterr())
    assert f"a.mpf:7: {unknown}" in told
    assert "not understood" not in told


def test_what_is_logged_for_the_user_is_said_in_the_language() -> None:
    def said(*logged: object) -> str:
        return SpokenLog().format(logging.LogRecord("trunnion.jit", logging.INFO, "", 0, "%s", logged, None))

    with speaking("zh"):
        assert said(phrase("compiling_some", count=3)).startswith("正在为本机编译 3 个内核，只需一次，需要几秒钟")
        assert said("as it is") == "as it is"
    assert said(phrase("compiling")).startswith("compiling kernels for this computer, once; this takes some seconds")
