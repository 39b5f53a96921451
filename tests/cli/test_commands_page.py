"""The page of the commands has a table of every command, with all of its options."""

from tests.support.commands_page import PAGE, meanings, page
from trunnion.jobs.registry import JOBS


def test_the_tables_are_those_of_the_registry() -> None:
    assert page() == PAGE.read_text(encoding="utf-8"), "python -m tests.support.commands_page writes them"


def test_every_command_has_a_section_with_its_options() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert [name for name in JOBS if f"\n## trunnion {name}\n" not in text] == []
    assert [name for name in JOBS if f"<!-- options of {name} -->" not in text] == []


def test_nothing_is_explained_that_is_no_option() -> None:
    wrong = [f"{name}.{key}" for name, said in meanings().items() for key in said if JOBS[name].option(key) is None]
    assert wrong == []
