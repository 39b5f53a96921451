"""Results that no file owns any more: removed where the batch has written them, told otherwise."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from tests.support.batches import InOrder, Interrupted, StoppingStore, run_simply, simple_batch, tree, write_files
from trunnion.batch.jobs import Batch
from trunnion.batch.records import FOLDER, parse_record, record_name
from trunnion.batch.result_keys import home_of
from trunnion.batch.stores import FolderStore
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer

TEXTS = {"a/x.cls": "one", "b.cls": "several parts", "c.cls": "fail", "d.cls": "two"}


class Listener(Observer):
    def __init__(self) -> None:
        self.told: list[tuple[str, str]] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.told += [(each.file, each.code) for each in problems]


def batch_of(folder: Path, *, is_whole: bool = False) -> Batch:
    return replace(simple_batch(folder), home=home_of(folder), is_whole=is_whole)


def named(batch: Batch, *names: str, extension: str = ".mpf", output: str = "") -> Batch:
    """The same batch with some of its files, or other names of results."""
    (job,) = batch.jobs
    return replace(batch, jobs=[replace(job, files=list(names) or job.files, extension=extension, output=output)])


def programs(out: Path) -> list[str]:
    return [name for name in tree(out) if not name.startswith(FOLDER)]


ALL = ["a/x.mpf", "b.programs/SUB1", "b.programs/SUB2", "b.programs/b.mpf", "d.mpf"]


def run(batch: Batch, out: Path) -> list[tuple[str, str]]:
    listener = Listener()
    run_simply(batch, FolderStore(out), observer=listener)
    return listener.told


def test_the_program_of_a_file_that_is_gone_is_removed(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    assert run(batch_of(tmp_path / "in"), tmp_path / "out") == []
    assert programs(tmp_path / "out") == ALL
    (tmp_path / "in/b.cls").unlink()
    told = run(batch_of(tmp_path / "in"), tmp_path / "out")
    assert told == [(f"b.programs/{name}", "BAT360") for name in ("SUB1", "SUB2", "b.mpf")]
    assert programs(tmp_path / "out") == ["a/x.mpf", "d.mpf"]
    assert run(batch_of(tmp_path / "in"), tmp_path / "out") == []
    run(batch_of(tmp_path / "in"), tmp_path / "fresh")
    assert tree(tmp_path / "out") == tree(tmp_path / "fresh")


@pytest.mark.parametrize("change", [{"extension": ".h"}, {"output": "new"}])
def test_the_program_with_the_name_of_before_is_removed(tmp_path: Path, change: dict[str, str]) -> None:
    write_files(tmp_path / "in", TEXTS)
    run(batch_of(tmp_path / "in"), tmp_path / "out")
    told = run(named(batch_of(tmp_path / "in"), **change), tmp_path / "out")
    assert [name for name, code in told if code == "BAT360"] == ALL
    run(named(batch_of(tmp_path / "in"), **change), tmp_path / "fresh")
    assert tree(tmp_path / "out") == tree(tmp_path / "fresh")
    assert len(programs(tmp_path / "out")) == len(ALL)


def test_a_file_beside_another_one_takes_the_name_from_both(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one", "y.cls": "two"})
    run(batch_of(tmp_path / "in"), tmp_path / "out")
    write_files(tmp_path / "in", {"x.ncl": "one"})
    batch = named(batch_of(tmp_path / "in"), "x.cls", "x.ncl", "y.cls")
    assert run(batch, tmp_path / "out") == [("x.mpf", "BAT360")]
    assert programs(tmp_path / "out") == ["y.mpf"]
    result = run_simply(batch, FolderStore(tmp_path / "out"))
    assert [(each.file, each.error and each.error.code) for each in result.failures()] == [
        ("x.cls", "BAT380"), ("x.ncl", "BAT380"),
    ]  # fmt: skip
    (tmp_path / "in/x.ncl").unlink()
    assert run(batch_of(tmp_path / "in"), tmp_path / "out") == []
    assert programs(tmp_path / "out") == ["x.mpf", "y.mpf"]


def test_what_somebody_has_changed_stays_and_is_told_each_time(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    run(batch_of(tmp_path / "in"), tmp_path / "out")
    (tmp_path / "in/d.cls").unlink()
    write_files(tmp_path / "out", {"d.mpf": "mine"})
    for _ in range(2):
        assert run(batch_of(tmp_path / "in"), tmp_path / "out") == [("d.mpf", "BAT370")]
        assert (tmp_path / "out/d.mpf").read_bytes() == b"mine"
    (tmp_path / "out/d.mpf").unlink()
    assert run(batch_of(tmp_path / "in"), tmp_path / "out") == []


def test_files_of_a_folder_that_are_not_asked_for_this_time_keep_their_programs(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    run(batch_of(tmp_path / "in"), tmp_path / "out")
    assert run(named(batch_of(tmp_path / "in"), "a/x.cls"), tmp_path / "out") == []
    assert programs(tmp_path / "out") == ALL


def test_files_that_a_file_of_jobs_does_not_name_any_more_lose_their_programs(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    run(batch_of(tmp_path / "in", is_whole=True), tmp_path / "out")
    told = run(named(batch_of(tmp_path / "in", is_whole=True), "a/x.cls"), tmp_path / "out")
    assert [name for name, _ in told] == ALL[1:]
    assert programs(tmp_path / "out") == ALL[:1]
    folders = sorted(path.name for path in (tmp_path / "out").iterdir() if path.is_dir())
    assert folders == [".trunnion-batch", "a"]


def test_results_of_another_batch_stay(tmp_path: Path) -> None:
    write_files(tmp_path / "one", {"x.cls": "one"})
    write_files(tmp_path / "other", {"y.cls": "two"})
    run(batch_of(tmp_path / "one"), tmp_path / "out")
    assert run(batch_of(tmp_path / "other"), tmp_path / "out") == [(str(tmp_path / "out"), "BAT370")]
    assert programs(tmp_path / "out") == ["x.mpf", "y.mpf"]


def test_a_folder_that_was_moved_is_the_same_batch_once_it_has_run(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    run(batch_of(tmp_path / "in"), tmp_path / "out")
    (tmp_path / "in").rename(tmp_path / "moved")
    again = InOrder()
    run_simply(batch_of(tmp_path / "moved"), FolderStore(tmp_path / "out"), again)
    assert again.done == []
    (tmp_path / "moved/d.cls").unlink()
    assert run(batch_of(tmp_path / "moved"), tmp_path / "out") == [("d.mpf", "BAT360")]


@pytest.mark.parametrize("name", ["../mine", "/mine", "link/mine", "x/../../mine", ".trunnion-batch/../../mine"])
def test_a_record_that_names_files_elsewhere_removes_none(tmp_path: Path, name: str) -> None:
    write_files(tmp_path, {"mine": "of one", "in/x.cls": "one", "in/y.cls": "two"})
    out = tmp_path / "out"
    run(batch_of(tmp_path / "in"), out)
    (out / "link").symlink_to(tmp_path, target_is_directory=True)
    (out / "x").mkdir()
    named_elsewhere = str(tmp_path / "mine") if name == "/mine" else name
    record = out / record_name("x.mpf")
    record.write_bytes(record.read_bytes().replace(b'"x.mpf": {', f'"{named_elsewhere}": {{'.encode()))
    assert (parse_record(record.read_bytes()) is None) is (name != "link/mine")  # a link is told by the store
    (tmp_path / "in/x.cls").unlink()
    run(batch_of(tmp_path / "in"), out)
    assert (tmp_path / "mine").read_bytes() == b"of one"


def test_it_may_be_stopped_anywhere(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    new = named(batch_of(tmp_path / "in"), "a/x.cls", "d.cls", extension=".h")
    write_files(tmp_path / "small", {"a/x.cls": "one", "d.cls": "two"})
    run(named(batch_of(tmp_path / "small"), extension=".h"), tmp_path / "whole")
    for before in range(1000):
        out = tmp_path / f"out{before}"
        run(batch_of(tmp_path / "in", is_whole=True), out)
        try:
            run_simply(replace(new, is_whole=True), StoppingStore(out, before))
        except Interrupted:
            run(replace(new, is_whole=True), out)
            assert tree(out) == tree(tmp_path / "whole"), before
        else:
            assert tree(out) == tree(tmp_path / "whole")
            break
    assert before > 8
