"""The page of published work: every command of it does what its row says."""

import shutil
from pathlib import Path

import pytest

from tests.support.locations import GOLDEN, ROOT, TESTS
from tests.support.published_work import PAGE, groups, page
from trunnion.cli import main

ROWS = [row for rows in groups().values() for row in rows]


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with what the commands read."""
    folder = tmp_path_factory.mktemp("checkout")
    shutil.copytree(GOLDEN, folder / "tests" / "golden", ignore=shutil.ignore_patterns("results"))
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copytree(TESTS / "data" / "foreign", folder / "tests" / "data" / "foreign")
    return folder


def _exit_code(words: list[str]) -> int | str | None:
    try:
        return main(words)
    except SystemExit as end:  # after the help of a command
        return end.code


def test_the_page_is_made_of_its_rows() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_row_has_a_command_or_says_why_it_is_out() -> None:
    assert [row.can for row in ROWS if bool(row.command) == bool(row.why) or bool(row.where) == bool(row.why)] == []


@pytest.mark.parametrize(("nightly"), [False, pytest.param(True, marks=pytest.mark.nightly)], ids=["quick", "long"])
def test_every_command_does_what_its_row_says(
    nightly: bool, checkout: Path, monkeypatch: pytest.MonkeyPatch, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    monkeypatch.chdir(checkout)
    wrong = []
    for row in ROWS:
        if not row.command or row.nightly != nightly:
            continue
        code, told = _exit_code(row.words), capfdbinary.readouterr()
        if code or not (told.out or told.err) or row.prints.encode() not in told.out:
            wrong.append(f"{row.command}: exit code {code}, {told.err.decode()[-200:]}")
        elif row.holds and row.holds[1] not in Path(row.holds[0]).read_text(encoding="utf-8"):
            wrong.append(f"{row.command}: {row.holds[1]} is not in {row.holds[0]}")
    assert wrong == [], "\n".join(wrong)
