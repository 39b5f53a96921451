"""Jobs that are stopped at every single file operation: all files are old or all are new, and the records with them."""

import os
import signal
import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any, NoReturn

import pytest

from tests.support.stopped_jobs import (
    NEW,
    OLD,
    Stop,
    in_a_process_that_dies,
    left,
    needs_fork,
    old_job,
    raise_ctrl_c,
    settle,
    stopped_between_moves,
    write_job,
)
from trunnion.files import EarlierJob, output_group, resolve_output
from trunnion.files.hidden_folders import JOURNAL
from trunnion.files.locks import hold


def check_whole(folder: Path) -> bool:
    """All is old or all is new, as jobs have recorded it, and nothing else is there; whether it is new."""
    there = left(folder)
    assert there in (OLD, NEW), sorted(there)
    assert sum(1 for path in folder.rglob("*") if path.is_dir()) == 3, "hidden folders"
    first, second = (EarlierJob((folder / name).resolve()) for name in ("nc/one.mpf", "two/two.mpf"))
    for name in there:
        job = second if name.startswith("two") else first
        known = job.wrote_paper if name.startswith("reports") else job.wrote
        assert known((folder / name).resolve()), f"{name} is not as it is recorded: nothing could be posted again"
    assert {job.owner[0] for job in (first, second)} == {"project"}
    return there == NEW


@pytest.mark.parametrize(
    ("how", "after"),
    [
        pytest.param(raise_ctrl_c, False, marks=pytest.mark.nightly),
        pytest.param(raise_ctrl_c, True, marks=pytest.mark.nightly),
        (lambda: signal.raise_signal(signal.SIGINT), True),
    ],
)
def test_ctrl_c_at_any_operation_leaves_a_whole_job(how: Callable[[], Any], after: bool, tmp_path: Path) -> None:
    outcomes, notes = [], set()
    for number in count(1):
        folder = old_job(tmp_path / str(number))
        stop = Stop(number, how, after=after)
        try:
            with stop.watching():
                write_job(folder, b"new", "MORE.SPF")
        except KeyboardInterrupt as error:
            said = getattr(error, "__notes__", ["nothing"])
            outcomes.append(check_whole(folder))
            notes.add((outcomes[-1], said[0].split(":")[0]))
        else:
            outcomes.append(check_whole(folder))
        write_job(folder, b"new", "MORE.SPF")
        assert check_whole(folder), "it can be posted again"
        if not stop.came:
            break
    assert outcomes == sorted(outcomes), "from some operation on all is new"
    assert len(outcomes) > 40
    assert (True, "complete before that, all files of the new job") in notes
    assert (False, "complete before that, all files of the new job") not in notes
    assert (True, "no file was replaced") not in notes


# Before an operation is after the one before it, but for what is written between them.
@needs_fork
@pytest.mark.parametrize("after", [pytest.param(False, marks=pytest.mark.nightly), True])
def test_a_job_killed_at_any_operation_is_finished_or_rolled_back_by_the_next(after: bool, tmp_path: Path) -> None:
    outcomes, mixed = [], 0
    for number in count(1):
        folder = old_job(tmp_path / str(number))
        came = in_a_process_that_dies(lambda folder=folder: write_job(folder, b"new", "MORE.SPF"), number, after=after)  # type: ignore[misc]
        visible = {name: text for name, text in left(folder).items() if "/." not in name}
        said = settle(folder)
        assert check_whole(folder) in (True, False)
        new = check_whole(folder)
        if visible not in (OLD, NEW):
            mixed += 1
            assert [each.code for each in said] == ["FIL290"], said
            assert ("finished" if new else "rolled back") in said[0].what
        outcomes.append(new)
        assert not settle(folder), "it is told once"
        if not came:
            break
    assert outcomes == sorted(outcomes)
    assert mixed >= 4
    assert len(outcomes) > 40


@pytest.mark.nightly
@needs_fork
def test_a_command_that_rolls_back_may_be_killed_as_well(tmp_path: Path) -> None:
    outcomes = set()
    for number in range(32, 41, 4):
        for second in count(1):
            folder = old_job(tmp_path / f"{number}_{second}")
            in_a_process_that_dies(lambda folder=folder: write_job(folder, b"new", "MORE.SPF"), number, after=True)  # type: ignore[misc]
            came = in_a_process_that_dies(lambda folder=folder: settle(folder), second, after=True)  # type: ignore[misc]
            settle(folder)
            outcomes.add(check_whole(folder))
            if not came:
                break
    assert outcomes == {False, True}


@needs_fork
def test_the_next_job_in_a_folder_settles_it_first(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    write_job(folder, b"new", "MORE.SPF")
    assert check_whole(folder)
    assert "has been rolled back: " in caplog.text


@needs_fork
def test_a_file_that_was_changed_since_is_not_brought_back_over(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    (folder / "nc" / "SUB.SPF").unlink()
    (folder / "nc" / "SUB.SPF").write_bytes(b"by hand")
    said = settle(folder)
    assert left(folder) == {**OLD, "nc/SUB.SPF": b"by hand"}
    assert [each.what for each in said][1] == "changed since by somebody, and left as it is: SUB.SPF"


@needs_fork
def test_the_folders_of_a_job_may_have_another_name_since(tmp_path: Path) -> None:
    folder = old_job(tmp_path / "a")
    stopped_between_moves(folder)
    folder.rename(tmp_path / "b")
    settle(tmp_path / "b")
    assert left(tmp_path / "b") == OLD


def test_a_job_that_lives_is_left_alone(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    with output_group() as group, group.open(resolve_output(folder / "nc" / "one.mpf")) as files:
        files.main.write(b"new")
        hidden = [path for path in (folder / "nc").iterdir() if path.is_dir()]
        assert [hold(each) for each in hidden] == [None]
        if hasattr(os, "fork"):
            assert not in_a_process_that_dies(lambda: settle(folder), 10_000, after=True)
        assert not settle(folder)
        assert all(path.exists() for path in hidden)


def test_folders_of_others_are_left_alone(tmp_path: Path) -> None:
    other = tmp_path / "nc" / ".cache.0123456789ab"
    other.mkdir(parents=True)
    (other / "file").write_bytes(b"theirs")
    (tmp_path / "nc" / ".link.0123456789ab").symlink_to(tmp_path)
    assert not settle(tmp_path)
    assert (other / "file").read_bytes() == b"theirs"


@needs_fork
@pytest.mark.parametrize(
    ("before", "after"),
    [('"name": "SUB.SPF"', '"name": "../two/two.mpf"'), ('"moves": [', '"moves": [7, '),
     *(pytest.param(*edit, marks=pytest.mark.nightly) for edit in [
         ('"new": "SUB.SPF"', '"new": "../../two/two.mpf"'), ('"records": [', '"records": [{"first": 99}, '),
         ('{"word"', '{"wort"'), ('{"word": "', '{"word": "0'),
     ])],
)  # fmt: skip
def test_a_journal_that_somebody_has_made_moves_nothing(before: str, after: str, tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    (journal,) = (path for path in (folder / "nc").rglob(JOURNAL) if b'"moves"' in path.read_bytes())
    assert before in journal.read_text()
    journal.write_text(journal.read_text().replace(before, after))
    there = {name: text for name, text in left(folder).items() if "/." not in name}
    said = settle(folder)
    assert {name: text for name, text in left(folder).items() if "/." not in name} == there
    assert {each.code for each in said} == {"FIL290"}
    assert any("neither to their places nor back" in each.what for each in said)


@pytest.mark.skipif(sys.platform == "win32", reason="a folder is made unwritable otherwise there")
@needs_fork
def test_what_cannot_be_brought_back_stays_for_the_next_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)

    def full(*_: Any) -> NoReturn:
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", full)
        assert all("Input/output error" in each.what for each in settle(folder))
    assert left(folder)["nc/SUB.SPF"] == b"new"
    assert "has been rolled back" in settle(folder)[0].what
    assert left(folder) == OLD
