"""Worker processes of this computer: the same results by any number of them, and whatever becomes of one."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.support.batch_work import simple_work
from tests.support.batches import run_simply, simple_batch, tree, write_files
from trunnion.batch.local import LocalWorkers
from trunnion.batch.records import Record
from trunnion.batch.running import run_jobs
from trunnion.batch.stores import FolderStore
from trunnion.batch.worker_task import Action, Status, Task
from trunnion.batch.workers import Assignment
from trunnion.errors import InputError


@pytest.mark.parametrize("count", [1, 2, 3])
def test_any_number_of_workers_gives_the_same_although_one_is_killed(tmp_path: Path, count: int) -> None:
    marks = [tmp_path / "first", tmp_path / "second"]
    texts = {f"{k}/x.cls": f"text {k}" for k in range(20)}
    texts |= {
        "bad.cls": "fail",
        "several.cls": "several parts",
        "3/y.cls": f"die {marks[0]}",
        "7/z.cls": f"die {marks[1]}",
    }
    write_files(tmp_path / "in", texts)
    batch = simple_batch(tmp_path / "in")
    result = run_jobs(batch, FolderStore(tmp_path / "out"), lambda _: LocalWorkers(count, simple_work))
    assert all(mark.exists() for mark in marks)  # both have killed a worker, which now is over
    run_simply(batch, FolderStore(tmp_path / "loop"))
    assert tree(tmp_path / "out") == tree(tmp_path / "loop")
    assert result.counts == {Status.PASSED: 23, Status.UNUSABLE: 1}


def test_a_file_that_kills_every_worker_fails_alone_and_is_tried_again_next_time(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"a.cls": "one", "deadly.cls": "always die", "z.cls": "two"})
    store = FolderStore(tmp_path / "out")
    result = run_jobs(simple_batch(tmp_path / "in"), store, lambda _: LocalWorkers(1, simple_work))
    (failure,) = result.failures()
    assert (failure.file, failure.status, failure.error and failure.error.code) == ("deadly.cls", Status.DIED, "BAT310")
    assert failure.error is not None
    assert "2 times" in failure.error.what
    assert result.counts == {Status.PASSED: 2, Status.DIED: 1}
    write_files(tmp_path / "in", {"deadly.cls": "good"})
    again = run_simply(simple_batch(tmp_path / "in"), store)
    assert (again.passed, again.done) == (True, 2)


def test_a_file_that_takes_too_long_is_ended_and_tried_again_next_time(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"slow.cls": "sleep 600"})
    store = FolderStore(tmp_path / "out")
    result = run_jobs(
        simple_batch(tmp_path / "in"), store, lambda _: LocalWorkers(2, simple_work, timeout=0.1, start=0.1)
    )
    (failure,) = result.failures()
    assert (failure.status, failure.error and failure.error.code) == (Status.TIMED_OUT, "BAT350")
    assert not failure.status.is_final


def test_the_start_of_a_process_does_not_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mark = tmp_path / "mark"
    # 100 s go by for the team while the first file is worked on, and none after that, however busy the computer is.
    clock = SimpleNamespace(monotonic=lambda: 100.0 * mark.exists())
    monkeypatch.setattr("trunnion.batch.local.time", clock)
    write_files(tmp_path / "in", {"a.cls": f"cold {mark} 0.5 0", "b.cls": "quick"})
    store = FolderStore(tmp_path / "out")
    result = run_jobs(simple_batch(tmp_path / "in"), store, lambda _: LocalWorkers(1, simple_work, timeout=0.1))
    assert result.counts == {Status.PASSED: 2}
    assert mark.read_text(encoding="utf-8") == "cold"


def test_a_first_file_that_is_slow_again_is_late(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"slow.cls": f"cold {tmp_path / 'mark'} 0.6 600"})
    store = FolderStore(tmp_path / "out")
    result = run_jobs(simple_batch(tmp_path / "in"), store, lambda _: LocalWorkers(1, simple_work, timeout=0.1))
    assert result.counts == {Status.TIMED_OUT: 1}


def test_no_process_is_started_where_nothing_is_to_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(tmp_path / "in", {"a.cls": "one"})
    run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"))
    monkeypatch.setattr(LocalWorkers, "_start", None)
    result = run_jobs(
        simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"), lambda _: LocalWorkers(2, simple_work)
    )
    assert result.done == 1


def _cannot_work(task: Task) -> None:
    raise RuntimeError("another version")


def test_workers_that_cannot_work_end_the_batch() -> None:
    task = Task("", Action.POST, {}, "files/a.cls", {"files/a.cls": b""}, {}, "a.mpf", "")
    record = Record("a.mpf", "a.cls", "", "post", "", Status.BROKEN)
    with (
        LocalWorkers[Assignment, Task](1, _cannot_work) as workers,  # type: ignore[arg-type]
        pytest.raises(InputError, match=r"another version.*BAT210"),
    ):
        list(workers.run([(Assignment(0, record), task)]))
