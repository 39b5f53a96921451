"""A small cluster of Dask: the results of a plain loop, although workers die and the scheduler is started again."""

import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import pytest

import trunnion
from tests.support.batch_work import simple_work
from tests.support.batches import AsTheyCome, divided_batch, run_simply, simple_batch, tree, write_files
from tests.support.dask_clusters import Cluster, needs_dask
from tests.support.divided import write_divided, write_jobs
from tests.support.locations import YL569
from trunnion.batch import Status, run_batch
from trunnion.batch.cluster import DaskWorkers, Scheduler
from trunnion.batch.divided_files import SHARES
from trunnion.batch.jobs import Batch
from trunnion.batch.records import Record
from trunnion.batch.running import BatchResult, run_jobs
from trunnion.batch.stores import FolderStore, open_store
from trunnion.batch.worker_task import Action, OtherVersionError, Task
from trunnion.batch.workers import Assignment
from trunnion.errors import InputError, Problem
from trunnion.jobs.observer import Observer
from trunnion.results import to_data

pytestmark = needs_dask


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    with Cluster(tmp_path_factory.mktemp("cluster"), 2) as found:
        yield found


class Disturber(Observer):
    """Calls a function once, when so many files are done."""

    def __init__(self, after: int, act: Callable[[], None]) -> None:
        self._left, self._act = after, act

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        return nullcontext(self._count)

    def _count(self, more: int) -> None:
        self._left -= more
        if self._left == 0:
            self._act()


def whole_files(folder: Path) -> dict[str, object]:
    """All files of a folder but what a worker was writing when it was killed, which no result has the name of."""
    return {name: content for name, content in tree(folder).items() if not name.endswith(".part")}


def run_disturbed(cluster: Cluster, batch: Batch, folder: Path, place: str) -> BatchResult:
    """Run a batch; the scheduler dies where results come back, and a worker where they are written by it."""
    store = open_store(folder.as_uri() if place == "file" else folder)
    disturb = cluster.restart_scheduler if place == "folder" else cluster.kill_worker
    return run_jobs(
        batch,
        store,
        lambda _: DaskWorkers(Scheduler(cluster.address, patience=600.0), simple_work, writing=store.worker_url),
        Disturber(9, disturb),
    )


@pytest.mark.parametrize("place", [pytest.param("folder", marks=pytest.mark.nightly), "file"])
def test_nothing_is_lost_or_doubled_although_a_worker_and_the_scheduler_die(
    cluster: Cluster, tmp_path: Path, place: str
) -> None:
    texts = {f"{k}/x.cls": f"text {k}" for k in range(40)}
    write_files(tmp_path / "in", texts | {"bad.cls": "fail", "several.cls": "several parts"})
    batch = simple_batch(tmp_path / "in")
    result = run_disturbed(cluster, batch, tmp_path / "out", place)
    assert result.counts == {Status.PASSED: 41, Status.UNUSABLE: 1}
    run_simply(batch, FolderStore(tmp_path / "loop"))
    assert whole_files(tmp_path / "out") == tree(tmp_path / "loop")


@pytest.mark.parametrize("place", [pytest.param("folder", marks=pytest.mark.nightly), "file"])
def test_shares_are_neither_lost_nor_doubled_although_a_worker_and_the_scheduler_die(
    cluster: Cluster, tmp_path: Path, place: str
) -> None:
    write_files(tmp_path / "in", {f"{k}/x.cls": f"text {k}" for k in range(8)} | {"bad.cls": "fail"})
    batch = divided_batch(tmp_path / "in", 4)
    result = run_disturbed(cluster, batch, tmp_path / "out", place)
    assert result.counts == {Status.PASSED: 8, Status.UNUSABLE: 1}
    run_simply(divided_batch(tmp_path / "in", 1), FolderStore(tmp_path / "loop"), AsTheyCome())
    assert whole_files(tmp_path / "out") == tree(tmp_path / "loop")


@pytest.mark.nightly
def test_a_divided_simulation_is_that_of_one_process_although_a_worker_dies(cluster: Cluster, tmp_path: Path) -> None:
    nc, given = write_divided(tmp_path)
    report = "wall.ngc.simulation.json"
    simulated = replace(trunnion.simulate(nc, **given), programs=("wall.ngc",), seconds=0.0)
    result = run_batch(
        write_jobs(tmp_path, 4),
        results=tmp_path / "out",
        scheduler=cluster.address,
        observer=Disturber(2, cluster.kill_worker),
    )
    (record,) = result.records()
    assert (record.status, record.figures["findings"]) == (Status.FAILED, len(simulated.findings))
    expected = json.loads(json.dumps(to_data(simulated)))
    written = json.loads((tmp_path / "out" / report).read_text())
    for text in (expected, written):  # one names the files by their paths
        text["travel"] = [{**each, "program": Path(each["program"]).name} for each in text["travel"]]
        for each in ("collisions", "near", "air", "operations", "remarks"):
            for row in text[each]:
                row["file"] = Path(row["file"]).name
    assert written == expected
    assert not [path for path in (tmp_path / "out" / SHARES).rglob("*") if path.is_file()]


def test_programs_are_those_of_a_plain_loop(cluster: Cluster, tmp_path: Path) -> None:
    text, programs = (YL569 / "2_hub_rough.cls").read_bytes(), {}
    for k in range(4):
        file = tmp_path / f"in/{k % 2}/p{k}.cls"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text.replace(b"RPM,2000", f"RPM,{2000 + k}".encode(), 1))
        posted = trunnion.post(file, machine="yl569", settings={"title": "X"}).text
        programs[f"{k % 2}/p{k}.mpf"] = (posted or "").encode()
    result = run_batch(
        tmp_path / "in", results=tmp_path / "out", action="post", machine="yl569", settings={"title": "X"},
        scheduler=cluster.address,
    )  # fmt: skip
    assert result.passed
    written = tree(tmp_path / "out")
    assert {name: data for name, data in written.items() if not name.startswith(".")} == programs
    again = run_batch(
        tmp_path / "in", results=tmp_path / "out", action="post", machine="yl569", settings={"title": "X"}, workers=1
    )
    assert again.done == 4  # what a cluster has done, this computer need not do


class Listener(Observer):
    def __init__(self) -> None:
        self.codes: list[str] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.codes += [each.code for each in problems]


def test_a_scheduler_without_workers_is_told_and_left_in_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("trunnion.batch.cluster.SILENCE", 0.0)
    # Its clock goes on by half a second with each look: however busy this computer is, two looks tell and leave.
    clock = SimpleNamespace(monotonic=count(step=0.5).__next__, sleep=time.sleep)
    monkeypatch.setattr("trunnion.batch.cluster.time", clock)
    write_files(tmp_path / "in", {"x.cls": "one"})
    listener = Listener()
    with Cluster(tmp_path, 0) as cluster, pytest.raises(InputError, match="BAT240"):
        run_jobs(
            simple_batch(tmp_path / "in"),
            FolderStore(tmp_path / "out"),
            lambda _: DaskWorkers(Scheduler(cluster.address, wait=2.5), simple_work, observer=listener),
        )
    assert listener.codes == ["BAT240"]


def _other_version(task: Task) -> None:
    raise OtherVersionError("a worker has Trunnion 0")


def test_workers_of_another_version_end_the_batch(cluster: Cluster) -> None:
    task = Task("", Action.POST, {}, "files/a.cls", {"files/a.cls": b""}, {"files/m": b"shared"}, "a.mpf", "")
    record = Record("a.mpf", "a.cls", "", "post", "", Status.BROKEN)
    with (
        DaskWorkers(Scheduler(cluster.address), _other_version) as workers,  # type: ignore[arg-type]
        pytest.raises(InputError, match=r"a worker has Trunnion 0.*BAT210"),
    ):
        list(workers.run([(Assignment(0, record), task)]))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "tls://127.0.0.1:9", "nonsense://x"])
def test_a_scheduler_that_is_not_there_is_told(monkeypatch: pytest.MonkeyPatch, address: str) -> None:
    monkeypatch.setattr("trunnion.batch.cluster._ATTEMPT", 0.2)
    with pytest.raises(InputError, match="BAT220"), DaskWorkers(Scheduler(address), simple_work):
        pass
