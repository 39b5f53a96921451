"""Definitions from anybody: a machine, or a refusal that names file and line."""

import random
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.fuzz import oracle
from tests.support.fuzz.mangle import mangle
from tests.support.projects import PROJECT, SETUPS, project
from trunnion.errors import InputError, Problem
from trunnion.jobs.project.file import load_project

LIBRARY = tuple(
    entry.read_bytes()
    for entry in sorted(files("trunnion.machines").joinpath("library").iterdir(), key=lambda entry: entry.name)
    if entry.name.endswith(".toml")
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for definitions."""
    return tmp_path_factory.mktemp("machines")


@pytest.mark.third
@pytest.mark.parametrize("seed", range(15))
def test_a_mangled_definition_is_a_machine_or_refused(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(15):
        oracle.judge_definition(mangle(rng.choice(LIBRARY), LIBRARY, rng), folder)


@settings(max_examples=examples(60))
@given(text=st.text(alphabet="[]{}=\"'#.,axis_nme019-+einf\n ", max_size=200))
def test_random_letters_of_the_language_are_refused(folder: Path, text: str) -> None:
    assert oracle.judge_definition(text.encode(), folder) is None


@pytest.mark.parametrize(
    "text", ["a = [1}\n", "a = [}", "a = {]", "a = [1}2", "[[a}]", "a = [[[1}}}", "a = [" * 500, "a." * 500 + "b = 1"]
)
def test_brackets_that_do_not_fit_are_refused(folder: Path, text: str) -> None:
    assert oracle.judge_definition(text.encode(), folder) is None


@pytest.mark.parametrize("seed", range(5))
def test_a_mangled_project_is_a_project_or_refused(tmp_path: Path, seed: int) -> None:
    """Whatever becomes of it, it names no file outside of its folder."""
    rng = random.Random(seed)
    part = project(tmp_path / "part", SETUPS)
    checked = PROJECT + '[checks]\nsimulate = "warn"\n'
    texts = (SETUPS.encode(), checked.encode(), b'cl = ["../x"]\n[settings]\nzero = [1, 2]\n')
    for _ in range(60):
        part.write_bytes(mangle(rng.choice(texts), texts, rng))
        for problem in _mistakes(part):
            assert problem.file == str(part) or "yl569" in str(problem)


def _mistakes(part: Path) -> list[Problem]:
    """What is wrong with a project; one that is none may name no file outside of its folder."""
    try:
        found = load_project(part)
    except InputError as error:
        return list(error.problems)
    for setup in found.setups:
        named = [*map(Path, setup.cl), setup.output]
        assert all(file.resolve().is_relative_to(part.parent) for file in named)
    return []
