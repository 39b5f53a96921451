"""Files that are divided among tasks: their results are those of one task, and only what is missing is done again."""

import os
from collections.abc import Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.support.batch_work import simple_work
from tests.support.batches import (
    AsTheyCome,
    Interrupted,
    StoppingStore,
    divided_batch,
    run_simply,
    tree,
    write_files,
)
from tests.support.dask_clusters import needs_dask
from tests.support.divided import write_divided, write_jobs
from trunnion.batch import Status, run_batch
from trunnion.batch.divided_files import SHARES
from trunnion.batch.jobs_file import load_batch
from trunnion.batch.local import LocalWorkers
from trunnion.batch.processing import work
from trunnion.batch.running import BatchResult, run_jobs
from trunnion.batch.stores import FolderStore, open_store
from trunnion.batch.worker_task import Outcome, Task
from trunnion.errors import InputError, Problem, Severity
from trunnion.jobs.observer import Observer

TEXTS = {"a/x.cls": "one", "b/x.cls": "two", "c.cls": "fail", "d.cls": "refuse"}


def whole(folder: Path) -> dict[str, object]:
    """What a batch gives that divides nothing."""
    run_simply(divided_batch(folder / "in", 1), FolderStore(folder / "whole"), AsTheyCome())
    return tree(folder / "whole")


def kept(folder: Path) -> list[str]:
    return [path.name for path in (folder / SHARES).rglob("*") if path.is_file()]


@pytest.mark.third
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("tiles", [2, 3, 7])
def test_results_are_those_of_files_that_are_not_divided(tmp_path: Path, tiles: int, seed: int) -> None:
    write_files(tmp_path / "in", TEXTS)
    team = AsTheyCome(1 + seed, seed)
    result = run_simply(divided_batch(tmp_path / "in", tiles), FolderStore(tmp_path / "out"), team)
    assert result.counts == {Status.PASSED: 2, Status.UNUSABLE: 1, Status.FAILED: 1}
    assert tree(tmp_path / "out") == whole(tmp_path)
    assert sorted(set(team.done)) == ["a/x.cls", "b/x.cls"]  # what fails in a share is not joined
    assert len(set(team.shares)) == len(team.shares)


def test_a_share_that_fails_ends_the_work_on_its_file_alone(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"a.cls": "fail", "b.cls": "one"})
    team = AsTheyCome()
    run_simply(divided_batch(tmp_path / "in", 5), FolderStore(tmp_path / "out"), team)
    assert team.shares == [("a.cls", 0), *(("b.cls", k) for k in range(5))]


@pytest.mark.parametrize("window", [1, 3])
def test_a_batch_that_is_stopped_anywhere_ends_as_if_it_were_not(tmp_path: Path, window: int) -> None:
    write_files(tmp_path / "in", {"a/x.cls": "one", "b/x.cls": "two"})
    expected = whole(tmp_path)
    stopped = 0
    for before in range(1000):
        out, first, again = tmp_path / f"out{before}", AsTheyCome(window, before), AsTheyCome(window, before + 1)
        try:
            run_simply(divided_batch(tmp_path / "in", 3), StoppingStore(out, before), first)
        except Interrupted:
            stopped += 1
        else:
            break
        run_simply(divided_batch(tmp_path / "in", 3), FolderStore(out), again)
        assert tree(out) == expected, before
        # Only the share that was about to get its place is made twice.
        assert len(first.shares) + len(again.shares) <= 2 * 3 + 1, before
    assert stopped == 1 + 2 * (3 + 2 + 3)  # README; of each file shares, result and record, removals


def test_only_missing_shares_are_made_again(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    store = StoppingStore(tmp_path / "out", 3)  # README and two shares
    with pytest.raises(Interrupted):
        run_simply(divided_batch(tmp_path / "in", 4), store, AsTheyCome())
    assert len(kept(tmp_path / "out")) == 2
    again = AsTheyCome()
    assert run_simply(divided_batch(tmp_path / "in", 4), FolderStore(tmp_path / "out"), again).passed
    assert again.shares == [("x.cls", 2), ("x.cls", 3)]
    assert kept(tmp_path / "out") == []


@pytest.mark.parametrize("change", ["file", "tiles", "not divided", "gone"])
def test_shares_that_nobody_needs_any_more_are_removed(tmp_path: Path, change: str) -> None:
    write_files(tmp_path / "in", {"x.cls": "one", "y.cls": "two"})
    with pytest.raises(Interrupted):
        run_simply(divided_batch(tmp_path / "in", 4), StoppingStore(tmp_path / "out", 3), AsTheyCome())
    tiles = {"tiles": 3, "not divided": 1}.get(change, 4)
    if change == "file":
        write_files(tmp_path / "in", {"x.cls": "other"})
    if change == "gone":
        (tmp_path / "in/x.cls").unlink()
    again = AsTheyCome()
    batch = replace(divided_batch(tmp_path / "in", tiles), is_whole=True)
    run_simply(batch, FolderStore(tmp_path / "out"), again)
    assert len(again.shares) == {"file": 8, "tiles": 6, "not divided": 0, "gone": 4}[change]
    assert tree(tmp_path / "out") == whole(tmp_path)


@pytest.mark.parametrize("change", ["file", "arguments", "report"])
def test_shares_of_what_has_changed_are_removed_before_new_ones_are_made(tmp_path: Path, change: str) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    with pytest.raises(Interrupted):
        run_simply(divided_batch(tmp_path / "in", 4), StoppingStore(tmp_path / "out", 4), AsTheyCome())
    old = kept(tmp_path / "out")
    assert len(old) == 3
    batch = divided_batch(tmp_path / "in", 4)
    (job,) = batch.jobs
    if change == "file":
        write_files(tmp_path / "in", {"x.cls": "other"})
    if change == "arguments":
        job = replace(job, arguments={"cell": 0.5})
    if change == "report":  # which no share has
        job = replace(job, report="json")
    changes = 1 if change == "report" else 4
    with pytest.raises(Interrupted):
        run_simply(replace(batch, jobs=[job]), StoppingStore(tmp_path / "out", changes), AsTheyCome())
    new = kept(tmp_path / "out")
    assert (len(new), len({*new} & {*old})) == ((4, 3) if change == "report" else (1, 0))


def test_shares_of_another_batch_stay(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    write_files(tmp_path / "out", {f"{SHARES}/other-0123-4.zip": "theirs"})
    batch = replace(divided_batch(tmp_path / "in", 2), is_whole=True)
    assert run_simply(batch, FolderStore(tmp_path / "out"), AsTheyCome()).passed
    assert kept(tmp_path / "out") == ["other-0123-4.zip"]


@pytest.mark.parametrize("how", ["changed", "removed"])
def test_a_damaged_share_is_made_again_by_the_next_run(tmp_path: Path, how: str) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})

    class Damaging(FolderStore):
        def write(self, name: str, content: bytes, *, lasting: bool = True) -> None:
            super().write(name, b"odd" if name.startswith(SHARES) else content, lasting=lasting)
            if name.startswith(SHARES) and how == "removed":
                (tmp_path / "out" / name).unlink()

    result = run_simply(divided_batch(tmp_path / "in", 2), Damaging(tmp_path / "out"), AsTheyCome())
    (failure,) = result.failures()
    assert (failure.status, failure.error and failure.error.code) == (Status.HINDERED, "BAT395")
    assert kept(tmp_path / "out") == []
    assert run_simply(divided_batch(tmp_path / "in", 2), FolderStore(tmp_path / "out"), AsTheyCome()).passed


def test_a_result_that_is_there_is_not_divided_again(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    store, again = FolderStore(tmp_path / "out"), AsTheyCome()
    run_simply(divided_batch(tmp_path / "in", 1), store, AsTheyCome())
    assert run_simply(divided_batch(tmp_path / "in", 3), store, again).done == 1
    assert not again.done
    assert not again.shares


def run_work(jobs: Path, team: AsTheyCome | None = None) -> BatchResult:
    """Run a file of jobs here, with the work itself."""
    batch = load_batch(jobs)
    assert batch.results is not None
    return run_simply(batch, FolderStore(batch.results), team or AsTheyCome(function=work))


@pytest.fixture(scope="module")
def undivided(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    folder = tmp_path_factory.mktemp("undivided")
    write_divided(folder)
    assert run_work(write_jobs(folder, 1)).counts == {Status.FAILED: 1}
    found = tree(folder / "out1")
    assert {name for name in found if not name.startswith(".")} == {"wall.ngc.simulation.json"}
    return found


@pytest.mark.nightly
@pytest.mark.parametrize("tiles", [2, 3, 7])
def test_a_simulation_that_is_divided_gives_the_same_bytes(
    tmp_path: Path, undivided: dict[str, object], tiles: int
) -> None:
    write_divided(tmp_path)
    team = AsTheyCome(3, tiles, work)
    run_work(write_jobs(tmp_path, tiles), team)
    assert len(team.shares) == tiles
    assert tree(tmp_path / f"out{tiles}") == undivided


@pytest.mark.nightly
def test_processes_give_the_same_bytes(tmp_path: Path, undivided: dict[str, object]) -> None:
    write_divided(tmp_path)
    run_batch(write_jobs(tmp_path, 3), workers=2)
    assert tree(tmp_path / "out3") == undivided


def test_a_worker_that_is_killed_takes_its_share_only(tmp_path: Path) -> None:
    mark = tmp_path / "mark"
    write_files(tmp_path / "in", {"x.cls": f"dies in 1 {mark}", "y.cls": "one"})
    result = run_jobs(
        divided_batch(tmp_path / "in", 3), FolderStore(tmp_path / "out"), lambda most: LocalWorkers(2, simple_work)
    )
    assert mark.exists()
    assert result.passed
    assert tree(tmp_path / "out") == whole(tmp_path)


def test_a_share_that_takes_too_long_fails_its_file_and_the_others_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    later = count(step=1.0)
    # Time goes by for the team when the other share is kept, however busy the computer is.
    clock = SimpleNamespace(monotonic=lambda: next(later) if kept(tmp_path / "out") else 0.0)
    monkeypatch.setattr("trunnion.batch.local.time", clock)
    write_files(tmp_path / "in", {"x.cls": "sleeps in 1 60"})
    result = run_jobs(
        divided_batch(tmp_path / "in", 2),
        FolderStore(tmp_path / "out"),
        lambda most: LocalWorkers(2, simple_work, 0.3, 0.3),
    )
    assert result.counts == {Status.TIMED_OUT: 1}
    assert len(kept(tmp_path / "out")) == 1


def test_errors_are_those_of_a_file_that_is_not_divided(tmp_path: Path) -> None:
    nc, _ = write_divided(tmp_path)
    nc.write_text(nc.read_text().replace("T2 M6", "T3 M6"))
    outcomes = []
    for tiles in (1, 3):
        result = run_work(write_jobs(tmp_path, tiles))
        outcomes.append([(each.status, each.problems, each.warnings, each.figures) for each in result.failures()])
    assert outcomes[0] == outcomes[1]
    assert outcomes[0][0][0] is Status.UNUSABLE


def test_what_a_simulation_cannot_be_divided_for_is_told(tmp_path: Path) -> None:
    write_divided(tmp_path)
    with pytest.raises(InputError, match=r"tiles has no meaning with stop_at.*SIM116"):
        load_batch(write_jobs(tmp_path, 2, more='stop_at = "first"'))
    load_batch(write_jobs(tmp_path, 1, more='stop_at = "first"'))
    for text in ("tiles = 0", "tiles = 1001", "tiles = 2.5"):
        jobs = write_jobs(tmp_path, 2)
        jobs.write_text(jobs.read_text().replace("tiles = 2", text))
        with pytest.raises(InputError, match="tiles is"):
            load_batch(jobs)
    jobs = write_jobs(tmp_path, 2)
    jobs.write_text('[[job]]\nfiles = ["wall.ngc"]\nmachine = "xyzac_trt"\ntiles = 2\n')
    with pytest.raises(InputError, match="BAT110"):
        load_batch(jobs)


def test_what_shares_cost_is_part_of_what_the_file_costs(tmp_path: Path) -> None:
    write_divided(tmp_path)
    spent: list[tuple[bool, float]] = []

    def timed(task: Task) -> Outcome:
        found = work(task)
        spent.append((bool(task.shares), found.costs.processor_s))
        return found

    (record,) = run_work(write_jobs(tmp_path, 3), AsTheyCome(function=timed)).records()
    *shares, (joins, together) = spent
    assert joins
    assert record.costs.processor_s == together > sum(each for _, each in shares) > 0.0


class Listening(Observer):
    """Keeps what is told: code, severity, text."""

    def __init__(self) -> None:
        self.told: list[tuple[str, Severity, str]] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.told += [(each.code or "", each.severity, each.what) for each in problems]


def stopped_before_joining(folder: Path, texts: dict[str, str], shares: int) -> Path:
    """Results of a batch that was stopped with so many of the four shares of each file; the folder of shares."""
    write_files(folder / "in", texts)
    with pytest.raises(Interrupted):
        run_simply(divided_batch(folder / "in", 4), StoppingStore(folder / "out", 1 + shares), AsTheyCome())
    assert len(kept(folder / "out")) == shares
    return folder / "out" / SHARES


def by_number(folder: Path) -> dict[int, Path]:
    """Kept shares by what they hold."""
    return {int(path.read_bytes().rpartition(b"\n(")[2].split(b",")[0]): path for path in folder.iterdir()}


ODD = ["another file", "another number", "changed", "cut short", "no seal", "empty", "odd seal"]


@pytest.mark.third
@pytest.mark.parametrize("how", ODD)
def test_a_share_that_is_not_what_its_name_says_is_told_and_it_alone_is_made_again(tmp_path: Path, how: str) -> None:
    mine = by_number(stopped_before_joining(tmp_path / "mine", {"x.cls": "one"}, 3))
    other = by_number(stopped_before_joining(tmp_path / "other", {"x.cls": "two"}, 3))
    content = mine[1].read_bytes()
    assert content.endswith(b"\n(1, 4) of one")
    mine[1].write_bytes({
        "another file": other[1].read_bytes(), "another number": mine[2].read_bytes(),
        "changed": content.replace(b"of one", b"of two"), "cut short": content[:-1],
        "no seal": b"(1, 4) of one", "empty": b"",
        "odd seal": b'trunnion share 1 {"sha256": 1, "key": [], "number": 1, "of": 4, "file": {}}\n',
    }[how])  # fmt: skip
    again, listening = AsTheyCome(), Listening()
    out = tmp_path / "mine/out"
    assert run_simply(divided_batch(tmp_path / "mine/in", 4), FolderStore(out), again, listening).passed
    assert again.shares == [("x.cls", 1), ("x.cls", 3)]
    ((code, severity, what),) = listening.told
    assert (code, severity) == ("BAT395", Severity.WARNING)
    assert "share 2 of 4" in what
    assert tree(out) == whole(tmp_path / "mine")


def test_of_shares_that_are_joined_only_the_damaged_ones_are_lost(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})

    def damaging(task: Task) -> Outcome:
        if task.shares:
            by_number(tmp_path / "out" / SHARES)[2].write_bytes(b"odd")
        return simple_work(task)

    out, again = FolderStore(tmp_path / "out"), AsTheyCome()
    result = run_simply(divided_batch(tmp_path / "in", 4), out, AsTheyCome(function=damaging))
    (failure,) = result.failures()
    assert failure.error is not None
    assert (failure.error.code, "share 3 of 4" in failure.error.what) == ("BAT395", True)
    assert sorted(by_number(tmp_path / "out" / SHARES)) == [0, 1, 3]
    assert run_simply(divided_batch(tmp_path / "in", 4), out, again).passed
    assert again.shares == [("x.cls", 2)]


def test_what_another_run_has_joined_meanwhile_counts(tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"x.cls": "one"})
    batch, out = divided_batch(tmp_path / "in", 3), FolderStore(tmp_path / "out")

    def overtaken(task: Task) -> Outcome:
        if task.shares:
            assert run_simply(batch, out, AsTheyCome()).passed
            assert kept(tmp_path / "out") == []
        return simple_work(task)

    assert run_simply(batch, out, AsTheyCome(function=overtaken)).counts == {Status.PASSED: 1}
    assert tree(tmp_path / "out") == whole(tmp_path)


@pytest.mark.third
@pytest.mark.parametrize("what", ["folder", "pipe", "link"])
@pytest.mark.parametrize("is_url", [False, pytest.param(True, marks=needs_dask)])
def test_what_is_no_file_in_the_place_of_a_share_fails_its_file_before_any_work(
    tmp_path: Path, what: str, is_url: bool
) -> None:
    folder = stopped_before_joining(tmp_path, {"x.cls": "one", "y.cls": "two"}, 2)
    path = by_number(folder)[1]
    content = path.read_bytes()
    path.unlink()
    if what == "folder":
        path.mkdir()
    elif what == "link":
        (tmp_path / "elsewhere").write_bytes(content)
        path.symlink_to(tmp_path / "elsewhere")
    elif hasattr(os, "mkfifo"):
        os.mkfifo(path)
    else:
        pytest.skip("there are no such pipes here")
    team = AsTheyCome()
    store = open_store((tmp_path / "out").as_uri() if is_url else tmp_path / "out")
    result = run_simply(divided_batch(tmp_path / "in", 4), store, team)
    (failure,) = result.failures()
    assert failure.error is not None
    assert (failure.file, failure.error.code) == ("x.cls", "BAT320")
    assert team.shares == [("y.cls", k) for k in range(4)]


def test_shares_of_another_batch_are_told(tmp_path: Path) -> None:
    stopped_before_joining(tmp_path, {"x.cls": "one"}, 2)
    listening = Listening()
    renamed = replace(divided_batch(tmp_path / "in", 4), home="renamed")
    assert run_simply(renamed, FolderStore(tmp_path / "out"), AsTheyCome(), listening).passed
    ((code, severity, what),) = listening.told
    assert (code, severity) == ("BAT370", Severity.WARNING)
    assert "shares of 1 simulation of another batch" in what
    assert len(kept(tmp_path / "out")) == 2


def test_shares_of_a_file_that_is_gone_from_a_folder_are_removed_and_those_of_one_left_out_stay(tmp_path: Path) -> None:
    stopped_before_joining(tmp_path, {"x.cls": "one", "y.cls": "two"}, 2)
    batch = divided_batch(tmp_path / "in", 4)
    without = replace(batch, jobs=[replace(batch.jobs[0], files=["y.cls"])])
    for left in (2, 0):
        assert run_simply(without, FolderStore(tmp_path / "out"), AsTheyCome()).passed
        assert len(kept(tmp_path / "out")) == left
        (tmp_path / "in/x.cls").unlink(missing_ok=True)


@pytest.mark.parametrize("tiles", ["", 0, "x", "2.5"])
def test_a_number_of_tiles_that_is_none_is_told(tmp_path: Path, tiles: Any) -> None:
    write_files(tmp_path, {"x.ngc": "G0 X1\n"})
    with pytest.raises(InputError, match=r"tiles.*whole number"):
        run_batch(
            tmp_path, action="simulate", machine="xyzac_trt", stock="box:1,1,1", results=tmp_path / "out", tiles=tiles
        )
