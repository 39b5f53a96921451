"""The declarations of commands: one parser of argparse, words that are those of their modules, functions that exist."""

from importlib import import_module

from tests.support.locations import ROOT
from trunnion.batch.worker_task import Action
from trunnion.jobs.registry import JOBS
from trunnion.options import words
from trunnion.placing.goals import Goal
from trunnion.schemas import KINDS


def test_one_module_knows_argparse() -> None:
    sources = (ROOT / "src" / "trunnion").rglob("*.py")
    assert [path.name for path in sources if "import argparse" in path.read_text(encoding="utf-8")] == ["parser.py"]


def test_words_of_options_are_those_of_their_modules() -> None:
    assert tuple(map(str, Goal)) == words.GOALS
    assert words.SCHEMAS == KINDS
    assert tuple(map(str, Action)) == words.ACTIONS


def test_every_command_is_carried_out_by_a_function() -> None:
    for job in JOBS.values():
        module, _, name = job.run.partition(":")
        assert callable(getattr(import_module(module), name)), job.name


def test_every_command_has_two_examples_that_are_understood() -> None:
    assert [job.name for job in JOBS.values() if len(job.examples) < 2] == []


def test_an_option_has_one_name_in_the_library_for_one_flag() -> None:
    names: dict[str, set[str]] = {}
    for job in JOBS.values():
        for option in job.flags:
            names.setdefault(option.flag, set()).add(option.name)
    several = {flag: sorted(found) for flag, found in names.items() if len(found) > 1}
    assert several == {"--tilt": ["tilt", "tilts"], "--tool": ["tool", "tools"], "--turn": ["only_turns", "turn"]}
