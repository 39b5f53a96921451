"""Jobs that are stopped at every single file operation: all files are old or all are new, and the records with them."""

import os
import signal
import sys
import threading
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
from trunnion.files.hidden_folders import JOURNAL, hidden_folders_in
from trunnion.files.hidden_names import hidden_name
from trunnion.files.journal import read_journal
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
    for number in range(32, 51, 6):
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


@needs_fork
@pytest.mark.parametrize("which", ["earlier", "file"])
def test_a_link_in_a_hidden_folder_brings_nothing_from_elsewhere(which: str, tmp_path: Path) -> None:
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    (theirs / "0").write_bytes(b"secret")
    folder = old_job(tmp_path / "shop")
    stopped_between_moves(folder)
    (earlier,) = (folder / "nc").rglob(".earlier")
    if which == "earlier":
        earlier.rename(tmp_path / "earlier")
        earlier.symlink_to(theirs)
    else:
        (earlier / "0").unlink()
        (earlier / "0").symlink_to(theirs / "0")
    said = settle(folder)
    assert (theirs / "0").read_bytes() == b"secret"
    assert (folder / "nc" / "SUB.SPF").read_bytes() == b"new"
    assert any("a link leads out of its folder" in each.what for each in said)


@needs_fork
def test_a_journal_records_no_program_as_a_project(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    (journal,) = (path for path in (folder / "nc").rglob(JOURNAL) if b'"moves"' in path.read_bytes())
    other = str(folder.resolve() / "part.toml")
    journal.write_text(journal.read_text().replace(other, other.replace("part.toml", "nc/one.mpf")))
    assert any("a record is of no project" in each.what for each in settle(folder))
    assert EarlierJob((folder / "nc" / "one.mpf").resolve()).wrote((folder / "nc" / "one.mpf").resolve())


@needs_fork
def test_a_job_whose_files_were_all_in_place_is_finished_although_one_was_edited_since(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    for hidden in [each for name in ("nc", "two", "reports") for each in hidden_folders_in(folder / name)]:
        journal = read_journal(hidden)
        assert journal is not None
        for move in journal.moves:
            if move.new_file.exists():
                move.new_file.replace(move.target)
    (folder / "nc" / "SUB.SPF").write_bytes(b"by hand")
    said = [each.what for each in settle(folder)]
    assert left(folder) == {**NEW, "nc/SUB.SPF": b"by hand"}
    assert "has been finished" in said[0]
    assert "SUB.SPF" not in said[0]
    assert said[1] == "changed since by somebody, and left as it is: SUB.SPF"


@needs_fork
def test_files_that_are_back_are_not_told_with_those_that_were_changed(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    (folder / "nc" / "SUB.SPF").write_bytes(b"by hand")
    said = [each.what for each in settle(folder)]
    assert "rolled back" in said[0]
    assert "SUB.SPF" not in said[0]


@needs_fork
def test_what_is_gone_is_not_told_as_brought_back(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    for earlier in folder.rglob(".earlier/*"):
        earlier.unlink()
    assert all("neither to their places nor back" in each.what for each in settle(folder))


def test_the_folder_of_a_dead_job_is_known_by_its_name_alone(tmp_path: Path) -> None:
    hidden = tmp_path / "nc" / hidden_name(".one.mpf.")
    hidden.mkdir(parents=True)
    (hidden / "one.mpf").write_bytes(b"half")
    assert [each.code for each in settle(tmp_path)] == ["FIL290"]
    assert not hidden.exists()


@needs_fork
@pytest.mark.skipif(sys.platform == "win32", reason="no folder is locked there")
def test_two_jobs_move_their_files_one_after_the_other(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    real = os.replace
    came: list[threading.Thread] = []

    def replace(source: Any, target: Any) -> None:
        if Path(target).name == JOURNAL and not came:
            came.append(threading.Thread(target=write_job, args=(folder, b"other", "MORE.SPF")))
            came[0].start()
            came[0].join(0.5)
            assert came[0].is_alive(), "it waits"
        real(source, target)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "replace", replace)
        write_job(folder, b"new", "MORE.SPF")
    came[0].join()
    assert set(left(folder).values()) <= {b"new", b"other"}
    assert len(set(left(folder).values())) == 1


@needs_fork
@pytest.mark.skipif(sys.platform == "win32", reason="no folder is locked there")
def test_a_job_settles_one_that_was_stopped_while_it_was_made(tmp_path: Path) -> None:
    folder = old_job(tmp_path)
    with output_group() as group, group.open(resolve_output(folder / "nc" / "one.mpf")) as files:
        files.main.write(b"other")
        files.add_file("SUB.SPF").write(b"old")
        stopped_between_moves(folder)
    assert left(folder)["nc/SUB.SPF"] == b"old"
    assert not settle(folder)
    assert left(folder) == {**OLD, "nc/one.mpf": b"other"}


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
