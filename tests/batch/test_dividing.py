"""Files that are divided among tasks: their results are those of one task, and only what is missing is done again."""

from dataclasses import replace
from pathlib import Path

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
from tests.support.divided import write_divided, write_jobs
from trunnion.batch import Status, run_batch
from trunnion.batch.dividing import SHARES
from trunnion.batch.jobs_file import load_batch
from trunnion.batch.local import LocalWorkers
from trunnion.batch.running import BatchResult, run_jobs
from trunnion.batch.stores import FolderStore
from trunnion.batch.task import Outcome, Task
from trunnion.batch.work import work
from trunnion.errors import InputError

TEXTS = {"a/x.cls": "one", "b/x.cls": "two", "c.cls": "fail", "d.cls": "refuse"}


def whole(folder: Path) -> dict[str, object]:
    """What a batch gives that divides nothing."""
    run_simply(divided_batch(folder / "in", 1), FolderStore(folder / "whole"), AsTheyCome())
    return tree(folder / "whole")


def kept(folder: Path) -> list[str]:
    return [path.name for path in (folder / SHARES).rglob("*") if path.is_file()]


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


@pytest.mark.parametrize("tiles", [2, 3, 7])
def test_a_simulation_that_is_divided_gives_the_same_bytes(
    tmp_path: Path, undivided: dict[str, object], tiles: int
) -> None:
    write_divided(tmp_path)
    team = AsTheyCome(3, tiles, work)
    run_work(write_jobs(tmp_path, tiles), team)
    assert len(team.shares) == tiles
    assert tree(tmp_path / f"out{tiles}") == undivided


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


def test_a_share_that_takes_too_long_fails_its_file_and_the_others_are_kept(tmp_path: Path) -> None:
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
