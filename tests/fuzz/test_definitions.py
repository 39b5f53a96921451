"""Definitions from anybody: a machine, or a refusal that names file and line."""

import random
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.fuzz import oracle
from tests.support.fuzz.mangle import mangle

LIBRARY = tuple(
    entry.read_bytes()
    for entry in sorted(files("trunnion.machines").joinpath("library").iterdir(), key=lambda entry: entry.name)
    if entry.name.endswith(".toml")
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for definitions."""
    return tmp_path_factory.mktemp("machines")


@pytest.mark.parametrize("seed", range(15))
def test_a_mangled_definition_is_a_machine_or_refused(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(15):
        oracle.judge_definition(mangle(rng.choice(LIBRARY), LIBRARY, rng), folder)


@settings(max_examples=60)
@given(text=st.text(alphabet="[]{}=\"'#.,axis_nme019-+einf\n ", max_size=200))
def test_random_letters_of_the_language_are_refused(folder: Path, text: str) -> None:
    assert oracle.judge_definition(text.encode(), folder) is None


@pytest.mark.parametrize(
    "text", ["a = [1}\n", "a = [}", "a = {]", "a = [1}2", "[[a}]", "a = [[[1}}}", "a = [" * 500, "a." * 500 + "b = 1"]
)
def test_brackets_that_do_not_fit_are_refused(folder: Path, text: str) -> None:
    assert oracle.judge_definition(text.encode(), folder) is None
