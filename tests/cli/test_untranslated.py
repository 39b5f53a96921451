"""What commands print and the pages that they write have no line in another language that is still the English one."""

import re
from collections.abc import Mapping
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


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Mapping[str, list[str]]]:
    """The lines of each run in each language, by its name."""
    found: dict[str, dict[str, list[str]]] = {name: {} for name in RUNS}
    with pytest.MonkeyPatch.context() as patch:
        for language in LANGUAGES:
            folder = tmp_path_factory.mktemp(language)
            lay_out(folder)
            lay_out_more(folder)
            patch.chdir(folder)
            for name, run in RUNS.items():
                found[name][language] = lines_of(run, Path(name).suffix, language)
    return found


@pytest.mark.parametrize("name", RUNS)
@pytest.mark.parametrize("language", TRANSLATED)
def test_no_line_is_still_the_english_one(
    name: str, language: str, said: Mapping[str, Mapping[str, list[str]]]
) -> None:
    english = {line.strip() for line in said[name]["en"]}
    alike = [line for line in map(str.strip, said[name][language]) if line in english and english_words(line, language)]
    parts = set().union(*map(english_parts, said[name]["en"]))
    alike += [line for line in said[name][language] if english_parts(line) & parts and line not in alike]
    assert said[name][language]
    assert not alike, "\n".join(alike)


def test_every_command_is_run() -> None:
    assert {run[0] for run in RUNS.values()} | set(NOT_RUN) == set(JOBS)
    assert not {run[0] for run in RUNS.values()} & set(NOT_RUN)


def test_a_resolved_definition_says_where_values_come_from_in_the_language(capsys: pytest.CaptureFixture[str]) -> None:
    for language, head in (("zh", "# 各值的来源："), ("de", "# Woher jeder Wert kommt:")):
        assert main(["machines", "yl569", "--resolved", "--language", language]) == 0
        assert capsys.readouterr().out.startswith(head)
