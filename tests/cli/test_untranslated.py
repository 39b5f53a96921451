"""What commands print and the pages that they write have no line in another language that is still the English one."""

import re
import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.support.frozen_results import lay_out
from tests.support.locations import TESTS
from tests.support.spoken_runs import RUNS, lines_of
from tests.support.translations import TRANSLATED
from trunnion.messages import LANGUAGES

#: Words that are alike in another language, or that no language has: names, formats, words of code and of formulas.
ALIKE = {
    "zh": {"Yalong", "Sinumerik", "sl", "mm", "rms", "tool", "workpiece", "degree", "Generic", "head", "table"},
    "de": {"Code", "Name", "Operation", "Start"},
}

#: A word, and what holds none: file names, options, settings, keys of definitions, commands of LaTeX.
WORD = re.compile(r"(?<![\w/.\\{-])[A-Za-z]?[a-z]{2,}(?![\w/.(}-])")


def english_words(line: str, language: str) -> set[str]:
    """Words of a line that should be those of another language."""
    return set(WORD.findall(line)) - ALIKE["zh"] - ALIKE[language]


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Mapping[str, list[str]]]:
    """The lines of each run in each language, by its name."""
    found: dict[str, dict[str, list[str]]] = {name: {} for name in RUNS}
    with pytest.MonkeyPatch.context() as patch:
        for language in LANGUAGES:
            folder = tmp_path_factory.mktemp(language)
            lay_out(folder)
            shutil.copytree(TESTS / "data" / "foreign", folder / "foreign")
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
    assert said[name][language]
    assert not alike, "\n".join(alike)
