"""A batch that is run again: it does what is missing or has changed, and comes out as if it had never been stopped."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tests.support.batches import InOrder, Interrupted, StoppingStore, run_simply, simple_batch, tree, write_files
from tests.support.dask_clusters import needs_dask
from trunnion.batch.records import FOLDER, Record, record_name
from trunnion.batch.stores import FolderStore, open_store
from trunnion.batch.worker_task import Outcome, Status, Task
from trunnion.batch.workers import Assignment

TEXTS = {"a/x.cls": "one", "b/x.cls": "two", "c.cls": "fail", "d.cls": "several parts", "e.cls": "refuse"}
CHANGED = {"a/x.cls": "other", "b/x.cls": "fail", "c.cls": "mended", "d.cls": "single", "e.cls": "several now"}


def test_results_lie_as_their_files_do(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    result = run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"))
    written = {name: data for name, data in tree(tmp_path / "out").items() if not name.startswith(FOLDER)}
    assert written == {
        "a/x.mpf": b"of one", "b/x.mpf": b"of two",
        "d.programs/d.mpf": b"of several parts", "d.programs/SUB1": b"one", "d.programs/SUB2": b"two",
    }  # fmt: skip
    assert result.counts == {Status.PASSED: 3, Status.UNUSABLE: 1, Status.FAILED: 1}
    assert [(each.file, each.error and each.error.code) for each in result.failures()] == [
        ("c.cls", "CL310"), ("e.cls", "tip"),
    ]  # fmt: skip
    assert not result.passed


def test_what_is_done_is_not_done_again(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    first, again = InOrder(), InOrder()
    store = FolderStore(tmp_path / "out")
    run_simply(simple_batch(tmp_path / "in"), store, first)
    before = tree(tmp_path / "out")
    result = run_simply(simple_batch(tmp_path / "in"), store, again)
    assert (len(first.done), again.done, result.done) == (5, [], 5)
    assert result.counts == {Status.PASSED: 3, Status.UNUSABLE: 1, Status.FAILED: 1}
    assert tree(tmp_path / "out") == before


@pytest.mark.parametrize(
    ("spoil", "done"),
    [
        (lambda folder: (folder / "in/a/x.cls").write_bytes(b"else"), ["a/x.cls"]),
        (lambda folder: (folder / "out/b/x.mpf").unlink(), ["b/x.cls"]),
        (lambda folder: (folder / "out/d.programs/SUB2").unlink(), ["d.cls"]),
        (lambda folder: (folder / "out" / record_name("a/x.mpf")).write_bytes(b"{"), ["a/x.cls"]),
        (lambda folder: (folder / "out" / record_name("c.mpf")).unlink(), ["c.cls"]),
        (lambda folder: (folder / "in/new.cls").write_bytes(b"new"), ["new.cls"]),
    ],
)
def test_only_what_is_missing_or_has_changed_is_done(tmp_path: Path, spoil: object, done: list[str]) -> None:
    write_files(tmp_path / "in", TEXTS)
    store, again = FolderStore(tmp_path / "out"), InOrder()
    run_simply(simple_batch(tmp_path / "in"), store)
    assert callable(spoil)
    spoil(tmp_path)
    run_simply(simple_batch(tmp_path / "in"), store, again)
    assert again.done == done
    run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "fresh"))
    assert tree(tmp_path / "out") == tree(tmp_path / "fresh")


@pytest.mark.parametrize("reverse", [False, True])
def test_a_batch_that_is_stopped_anywhere_ends_as_if_it_were_not(tmp_path: Path, reverse: bool) -> None:
    write_files(tmp_path / "in", TEXTS)
    run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "whole"))
    stopped = 0
    for before in range(1000):
        out = tmp_path / f"out{before}"
        try:
            run_simply(simple_batch(tmp_path / "in"), StoppingStore(out, before), InOrder(reverse=reverse))
        except Interrupted:
            stopped += 1
        else:
            break
        run_simply(simple_batch(tmp_path / "in"), FolderStore(out))
        assert tree(out) == tree(tmp_path / "whole"), before
    assert stopped == 1 + 5 + 5  # README, records, files


def test_changed_files_that_are_stopped_anywhere_end_as_if_they_were_not(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    write_files(tmp_path / "new", CHANGED)
    run_simply(simple_batch(tmp_path / "new"), FolderStore(tmp_path / "whole"))
    stopped = 0
    for before in range(1000):
        out = tmp_path / f"out{before}"
        run_simply(simple_batch(tmp_path / "in"), FolderStore(out))
        try:
            run_simply(simple_batch(tmp_path / "new"), StoppingStore(out, before))
        except Interrupted:
            stopped += 1
        else:
            assert tree(out) == tree(tmp_path / "whole")
            break
        run_simply(simple_batch(tmp_path / "new"), FolderStore(out))
        assert tree(out) == tree(tmp_path / "whole"), before
    assert stopped > 12


def test_an_old_program_does_not_stay_where_its_file_fails_now(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    store = FolderStore(tmp_path / "out")
    run_simply(simple_batch(tmp_path / "in"), store)
    assert (tmp_path / "out/x.mpf").exists()
    write_files(tmp_path / "in", {"x.cls": "fail"})
    run_simply(simple_batch(tmp_path / "in"), store)
    assert not (tmp_path / "out/x.mpf").exists()


@pytest.mark.parametrize("is_changed", [False, True])
def test_a_file_of_somebody_else_is_never_replaced(tmp_path: Path, is_changed: bool) -> None:
    write_files(tmp_path / "in", {"x.cls": "one", "y.cls": "two"})
    store = FolderStore(tmp_path / "out")
    if is_changed:  # by hand, after the batch has written it
        run_simply(simple_batch(tmp_path / "in"), store)
    write_files(tmp_path / "out", {"x.mpf": "mine"})
    for _ in range(2):
        result = run_simply(simple_batch(tmp_path / "in"), store)
        assert (tmp_path / "out/x.mpf").read_bytes() == b"mine"
        assert (tmp_path / "out/y.mpf").read_bytes() == b"of two"
        assert [(each.file, each.error and each.error.code) for each in result.failures()] == [("x.cls", "BAT320")]
    (tmp_path / "out/x.mpf").unlink()
    assert run_simply(simple_batch(tmp_path / "in"), store).passed


@pytest.mark.parametrize("address", ["", pytest.param("file", marks=needs_dask)])
def test_a_folder_in_the_place_of_a_result_concerns_its_file_only(tmp_path: Path, address: str) -> None:
    write_files(tmp_path / "in", {"x.cls": "one", "y.cls": "two", "z/z.cls": "three"})
    write_files(tmp_path / "out", {"x.mpf/mine": "mine", "z": "a file"})
    store = open_store((tmp_path / "out").as_uri() if address else tmp_path / "out")
    for _ in range(2):
        result = run_simply(simple_batch(tmp_path / "in"), store)
        assert [(each.file, each.error and each.error.code) for each in result.failures()] == [
            ("x.cls", "BAT320"), ("z/z.cls", "BAT320"),
        ]  # fmt: skip
        assert (tmp_path / "out/y.mpf").read_bytes() == b"of two"
        assert (tmp_path / "out/x.mpf/mine").read_bytes() == b"mine"
    (tmp_path / "out/z").unlink()
    (tmp_path / "out/x.mpf/mine").unlink()
    (tmp_path / "out/x.mpf").rmdir()
    assert run_simply(simple_batch(tmp_path / "in"), store).passed


@pytest.mark.parametrize(("changed", "done"), [("x.sub", ["x.cls"]), ("tools.toml", ["x.cls", "y.cls"]), ("z.sub", [])])
def test_what_goes_with_files_counts(tmp_path: Path, changed: str, done: list[str]) -> None:
    texts = dict.fromkeys(("x.cls", "y.cls", "x.sub", "y.sub", "z.sub", "tools.toml"), "one")
    write_files(tmp_path / "in", texts)
    (job,) = simple_batch(tmp_path / "in").jobs
    shared = {"files/tools.toml": tmp_path / "in/tools.toml"}
    job = replace(job, shared=shared, beside={"subprograms": ["{folder}/{stem}.sub"]})
    batch = replace(simple_batch(tmp_path / "in"), jobs=[job])
    store, again = FolderStore(tmp_path / "out"), InOrder()
    run_simply(batch, store)
    write_files(tmp_path / "in", {changed: "other"})
    run_simply(batch, store, again)
    assert again.done == done


def test_a_file_that_changes_while_it_is_worked_on_is_done_again(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one", "y.cls": "two"})

    class Changing(InOrder):
        def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Outcome | Record]]:
            for each in super().run(tasks):
                write_files(tmp_path / "in", {"x.cls": "changed"})
                yield each

    store, again = FolderStore(tmp_path / "out"), InOrder()
    run_simply(simple_batch(tmp_path / "in"), store, Changing())
    assert (tmp_path / "out/x.mpf").read_bytes() == b"of one"
    run_simply(simple_batch(tmp_path / "in"), store, again)
    assert again.done == ["x.cls"]
    assert (tmp_path / "out/x.mpf").read_bytes() == b"of changed"


def test_a_job_with_another_name_is_not_done_again(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    store, again = FolderStore(tmp_path / "out"), InOrder()
    batch = simple_batch(tmp_path / "in")
    run_simply(batch, store)
    renamed = replace(batch, jobs=[replace(batch.jobs[0], name="new")])
    result = run_simply(renamed, store, again)
    assert again.done == []
    assert {record.job for record in result.records()} == {"new"}


def test_links_lead_no_reading_out_of_the_folder(tmp_path: Path) -> None:
    write_files(tmp_path, {"real.cls": "secret", "in/sub/same.cls": "inside", "in/x.cls": "one", "in/y.cls": "two"})
    (tmp_path / "in/x.sub").symlink_to(tmp_path / "real.cls")
    (tmp_path / "in/y.sub").symlink_to(tmp_path / "in/sub/same.cls")
    batch = simple_batch(tmp_path / "in")
    job = replace(batch.jobs[0], files=["x.cls", "y.cls"], beside={"subprograms": ["{folder}/{stem}.sub"]})
    result = run_simply(replace(batch, jobs=[job]), FolderStore(tmp_path / "out"))
    (failure,) = result.failures()
    assert (failure.file, failure.error and failure.error.code) == ("x.cls", "FIL120")
    assert failure.error is not None
    assert "x.sub, which leads out of the folder by a link" in failure.error.what


def test_a_file_that_leads_elsewhere_since_it_was_found_is_not_read(tmp_path: Path) -> None:
    write_files(tmp_path, {"real.cls": "secret", "in/x.cls": "one"})
    batch = simple_batch(tmp_path / "in")
    (tmp_path / "in/x.cls").unlink()
    (tmp_path / "in/x.cls").symlink_to(tmp_path / "real.cls")
    result = run_simply(batch, FolderStore(tmp_path / "out"))
    assert result.counts == {Status.UNUSABLE: 1}
    (failure,) = result.failures()
    assert failure.error is not None
    assert (failure.file, failure.error.code) == ("x.cls", "FIL120")
    assert failure.error.what == "leads out of the folder by a link"


def test_results_that_lost_their_records_are_taken_over_where_they_are_the_same(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    write_files(tmp_path / "out", {"x.mpf": "of one"})
    assert run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out")).passed


def test_another_version_of_trunnion_does_everything_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    store, again = FolderStore(tmp_path / "out"), InOrder()
    run_simply(simple_batch(tmp_path / "in"), store)
    monkeypatch.setattr("trunnion.batch.running.program_version", lambda: "9.9")
    run_simply(simple_batch(tmp_path / "in"), store, again)
    assert again.done == ["x.cls"]


def test_a_file_that_cannot_be_read_fails_alone(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one", "y.cls": "two"})
    batch = simple_batch(tmp_path / "in")
    (tmp_path / "in/x.cls").unlink()
    result = run_simply(batch, FolderStore(tmp_path / "out"))
    assert [(each.file, each.error and each.error.code) for each in result.failures()] == [("x.cls", "FIL120")]
    assert (tmp_path / "out/y.mpf").exists()
