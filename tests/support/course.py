"""The course: notebooks and pages in two languages, made of lessons as data; run as a module, this writes them."""

import json
import tomllib
from typing import Any, Final

from tests.support.locations import DOCS, ROOT

FOLDER: Final = ROOT / "examples" / "course"
PAGES: Final = DOCS / "course"
LANGUAGES: Final = ("en", "zh")

_WORDS: Final = {
    "exercise": {"en": "Exercise", "zh": "练习"},
    "lesson": {
        "en": "The exercises are answered in the notebook of this page, `examples/course/{name}.en.ipynb`.",
        "zh": "本页由笔记本生成，练习在笔记本中作答：`examples/course/{name}.zh.ipynb`。",
    },
    "right": {"en": "right", "zh": "正确"},
    "wrong": {"en": "not yet", "zh": "还不对"},
}


def lessons() -> dict[str, dict[str, Any]]:
    """All lessons by their names."""
    return {file.stem: tomllib.loads(file.read_text(encoding="utf-8")) for file in sorted(FOLDER.glob("*.toml"))}


def cells(lesson: dict[str, Any], language: str, *, solved: bool = False) -> list[tuple[str, str]]:
    """The cells of a lesson in a language: ``markdown`` or ``code``, and its text; with its own solutions if asked."""
    found = [("markdown", f"# {lesson['title'][language]}")]
    for cell in lesson["cell"]:
        found.append(("code", cell["code"].strip()) if "code" in cell else ("markdown", cell[language].strip()))
    for number, exercise in enumerate(lesson["exercise"], 1):
        found.append(("markdown", f"## {_WORDS['exercise'][language]} {number}\n\n{exercise[language].strip()}"))
        found.append(("code", exercise["solution" if solved else "start"].strip()))
        right, wrong = (_WORDS[word][language] for word in ("right", "wrong"))
        found.append(("code", f'{exercise["check"].strip()}\nprint("{right}" if right else "{wrong}")'))
    return found


def notebook(lesson: dict[str, Any], language: str) -> str:
    """A lesson as a notebook."""
    made = []
    for number, (kind, text) in enumerate(cells(lesson, language)):
        cell: dict[str, Any] = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": text}
        made.append(cell | ({"execution_count": None, "outputs": []} if kind == "code" else {}))
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    data = {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(data, ensure_ascii=False, indent=1) + "\n"


def page(name: str, lesson: dict[str, Any], language: str) -> str:
    """A lesson as a page of the docs, without the checks of its exercises.

    Its code goes on from cell to cell, so that it is run as a lesson and not as the blocks of other pages.
    """
    checks = {exercise["check"].strip() for exercise in lesson["exercise"]}
    parts = []
    for kind, text in cells(lesson, language):
        if not any(text.startswith(check) for check in checks):
            parts.append(text if kind == "markdown" else f"```py\n{text}\n```")
    parts.insert(1, _WORDS["lesson"][language].format(name=name))
    return "\n\n".join(parts) + "\n"


def files() -> dict[str, str]:
    """All files of the course that are made, by their paths in the checkout."""
    made = {}
    for name, lesson in lessons().items():
        for language in LANGUAGES:
            made[f"examples/course/{name}.{language}.ipynb"] = notebook(lesson, language)
            made[f"docs/course/{name}-{language}.md"] = page(name, lesson, language)
    return made


if __name__ == "__main__":
    for path, text in files().items():
        (ROOT / path).write_text(text, encoding="utf-8", newline="\n")
