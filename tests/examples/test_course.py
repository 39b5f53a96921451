"""The course: each lesson runs in both languages, its own answers are right, and what it starts with is not."""

import contextlib
import io
import re
from typing import Any

import pytest

from tests.support.course import LANGUAGES, cells, files, lessons
from tests.support.locations import ROOT

LESSONS = lessons()


def outputs(lesson: dict[str, Any], language: str, *, solved: bool) -> list[str]:
    """What the code cells of a lesson print."""
    names: dict[str, Any] = {}
    shown = []
    for kind, text in cells(lesson, language, solved=solved):
        if kind == "code":
            with contextlib.redirect_stdout(io.StringIO()) as out:
                exec(text, names)
            shown.append(out.getvalue().strip())
    return shown


def test_notebooks_and_pages_are_made_of_the_lessons() -> None:
    made = files()
    assert {path: (ROOT / path).read_text(encoding="utf-8") == text for path, text in made.items()} == dict.fromkeys(
        made, True
    )
    there = {*(ROOT / "examples/course").glob("*.ipynb"), *(ROOT / "docs/course").glob("*.md")}
    assert {path.relative_to(ROOT).as_posix() for path in there} == set(made)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", LESSONS)
def test_a_lesson_runs_and_judges_its_exercises(name: str, language: str) -> None:
    lesson, words = LESSONS[name], {"en": ("right", "not yet"), "zh": ("正确", "还不对")}
    right, wrong = words[language]
    count = len(lesson["exercise"])
    assert count >= 2
    assert outputs(lesson, language, solved=True)[1 - 2 * count :: 2] == [right] * count
    assert outputs(lesson, language, solved=False)[1 - 2 * count :: 2] == [wrong] * count


@pytest.mark.parametrize("name", LESSONS)
def test_both_languages_have_the_same_code_and_their_own_texts(name: str) -> None:
    english, chinese = (cells(LESSONS[name], language) for language in LANGUAGES)
    assert [kind for kind, _ in english] == [kind for kind, _ in chinese]
    for (kind, one), (_, other) in zip(english, chinese, strict=True):
        if kind == "markdown":
            assert re.search(r"[\u4e00-\u9fff]", other)
            assert not re.search(r"[\u4e00-\u9fff]", one)
        else:
            assert one.rsplit("\nprint(", 1)[0] == other.rsplit("\nprint(", 1)[0] or "print" not in one
