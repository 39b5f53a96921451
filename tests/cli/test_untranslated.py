"""What commands print and the pages that they write have no line in another language that is still the English one."""

import contextlib
import re
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import pytest

from tests.support.frozen_results import lay_out
from tests.support.spoken_runs import NOT_RUN, RUNS, lay_out_more, lines_of
from tests.support.translations import TRANSLATED
from trunnion.cli import main
from trunnion.jobs.describe.controls import describe_controls
from trunnion.jobs.registry import JOBS
from trunnion.machines import load_machine, shipped_machines
from trunnion.messages import LANGUAGES

#: Words that are alike in another language, or that no language has: names, formats, words of code and of formulas.
ALIKE = {
    "zh": {
        "Yalong",
        "Sinumerik",
        "sl",
        "mm",
        "min",
        "rms",
        "tool",
        "workpiece",
        "degree",
        "Generic",
        "head",
        "table",
        "Home",
        "End",
    },
    "de": {"Code", "Name", "Operation", "Start", "in"},
}

#: What machines and controls are called.
NAMES = sorted(
    {load_machine(key).name for key in shipped_machines()} | {each.name for each in describe_controls()},
    key=len,
    reverse=True,
)

#: What the system says, and what is printed of files and is typed.
QUOTED = ("Connect call failed", "3 is no name of anything", "trunnion test changed")

#: How lines begin that a batch keeps of its files, in English for everybody.
KEPT = ("CTL720 ",)

#: A word, and what holds none: file names, options, settings, keys of definitions, commands of LaTeX.
WORD = re.compile(r"(?<![\w/.\\{-])[A-Za-z]?[a-z]{2,}(?![\w/.(}-])")

#: Lines of programs and of definitions, which have no language.
CODE = re.compile(r"\s*(?:N\d+ )?[;(#{<]|\s*[\w.]+ = ")


def english_words(line: str, language: str) -> set[str]:
    """Words of a line that should be those of another language."""
    return set() if CODE.match(line) else set(WORD.findall(line)) - ALIKE["zh"] - ALIKE[language]


#: Words behind each other, which a sentence has.
SENTENCE = re.compile(r"(?<![\w/.\\{-])[A-Za-z]?[a-z]{2,}(?: [a-z]{2,}){2,}(?![\w/.(}-])")


def english_parts(line: str) -> set[str]:
    """Three words behind each other, which are no name of a machine or a control."""
    for name in (*NAMES, *QUOTED):
        line = line.replace(name, "")
    found = [each.split() for each in SENTENCE.findall(line)] if not CODE.match(line) else []
    return {" ".join(words[k : k + 3]) for words in found for k in range(len(words) - 2)}


#: Runs that read what another one writes.
AFTER = {"check": "new", "build": "new"}

Said = Callable[[str], Mapping[str, list[str]]]


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> Said:
    """Return what gives the lines of a run in each language, by its name."""
    folders = {language: tmp_path_factory.mktemp(language) for language in LANGUAGES}
    for folder in folders.values():
        lay_out(folder)
        lay_out_more(folder)

    @cache
    def lines(name: str) -> Mapping[str, list[str]]:
        if name in AFTER:
            lines(AFTER[name])
        found = {}
        for language, folder in folders.items():
            with contextlib.chdir(folder):
                found[language] = lines_of(RUNS[name], Path(name).suffix, language)
        return found

    return lines


@pytest.mark.parametrize("name", RUNS)
def test_no_line_is_still_the_english_one(name: str, said: Said) -> None:
    lines = said(name)
    assert all(lines.values())
    for language in TRANSLATED:
        alike = left_over(lines["en"], lines[language], language)
        assert not alike, "\n".join([language, *alike])


def left_over(in_english: list[str], in_other: list[str], language: str) -> list[str]:
    """Lines that are the English ones, or have words behind each other of them."""
    english = {line.strip() for line in in_english}
    alike = [line for line in map(str.strip, in_other) if line in english and english_words(line, language)]
    parts = set().union(*map(english_parts, in_english))
    alike += [line for line in in_other if english_parts(line) & parts and line not in alike]
    return [line for line in alike if not line.startswith(KEPT)]


def test_every_command_is_run() -> None:
    assert {run[0] for run in RUNS.values()} | set(NOT_RUN) == set(JOBS)
    assert not {run[0] for run in RUNS.values()} & set(NOT_RUN)


def test_a_resolved_definition_says_where_values_come_from_in_the_language(capsys: pytest.CaptureFixture[str]) -> None:
    for language, head in (("zh", "# 各值的来源："), ("de", "# Woher jeder Wert kommt:")):
        assert main(["machines", "yl569", "--resolved", "--language", language]) == 0
        assert capsys.readouterr().out.startswith(head)
