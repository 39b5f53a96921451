"""A batch of thousands of small programs: ``PYTHONPATH=. python benchmarks/batch.py [--files N]``.

Posts N generated CL files of 20 to 99 points in a plain loop of one process, by two worker processes, and on a cluster
of Dask on this computer: a scheduler and two workers. There a worker is killed three times, and the scheduler once;
each is started again. Files that fail are among them. All results are compared byte for byte with those of the loop,
then the batch is run once more, which finds everything done. Prints seconds, processor time, files a second, memory of
the client, and what a file costs client and scheduler. Exit code 1 if a result differs.

It needs the extra ``cluster``; run it from the root of the repository.
"""

import argparse
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib import import_module
from pathlib import Path
from typing import Any

from tests.support.batches import run_simply, tree
from tests.support.dask_clusters import Cluster

import make_cls
import trunnion
from trunnion.batch import run_batch
from trunnion.batch.cluster import DaskWorkers, Scheduler
from trunnion.batch.jobs import Batch, BatchJob
from trunnion.batch.records import Record
from trunnion.batch.result_keys import program_version
from trunnion.batch.running import run_jobs
from trunnion.batch.stores import FolderStore, Store, open_store
from trunnion.batch.worker_task import Action, Outcome, Status, Task
from trunnion.jobs.observer import Observer

MACHINE = "yl569"
SETTINGS = {"title": "BATCH"}

#: Every so manieth file cannot be read, and is for a spindle that there is not.
WRONG, REFUSED = 97, 101

#: A fifth of all files lies between the deaths of workers and scheduler.
FEWEST = 5


def generate(folder: Path, count: int) -> None:
    """Write CL files, the same ones on every run, a hundred in a folder."""
    for k in range(count):
        points, start = 20 + k % 80, 61 * k
        head = make_cls.HEAD.replace("2500.0000", f"{2000 + k % 500}.0000" if (k + 1) % REFUSED else "99000.0000")
        lines = list(make_cls.statements(start, start + points))
        text = head + make_cls.RAPID + lines[0].partition("\n")[0] + "\n" + make_cls.ENGAGE + lines[0] + make_cls.FOOT
        text = text if (k + 1) % WRONG else text.replace("GOTO/", "GOTO/1,2\nGOTO/", 1)
        file = folder / f"{k // 100:03}" / f"part{k}.cls"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8", newline="\n")


def plain_loop(folder: Path) -> dict[str, object]:
    """Programs by their places, and of files that fail the errors."""
    found: dict[str, object] = {}
    machine = trunnion.load_machine(MACHINE)
    for file in sorted(folder.rglob("*.cls")):
        place = file.relative_to(folder).with_suffix(".mpf").as_posix()
        try:
            posted = trunnion.post(file, machine=machine, settings=SETTINGS)
        except trunnion.TrunnionError as error:
            found[place] = [(problem.line, problem.what, problem.code) for problem in error.problems]
        else:
            assert posted.text is not None
            found[place] = posted.text.encode()
    return found


class Counter(Observer):
    """Counts files, and does something after some of them."""

    def __init__(self, acts: dict[int, Callable[[], None]], count: int) -> None:
        self._acts, self._done = acts, 0
        self._each = min(100, count)
        self.memory: list[int] = []

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        return nullcontext(self._count)

    def _count(self, more: int) -> None:
        self._done += more
        if self._done % self._each == 0:
            self.memory.append(resident())
        if act := self._acts.get(self._done):
            act()


def resident() -> int:
    """Memory of this process, KB (Linux)."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * (resource.getpagesize() // 1024)


@contextmanager
def timed(what: str, count: int) -> Iterator[None]:
    """Print how long it takes, and the processor time of this process and of children that have ended."""
    started, used = time.perf_counter(), processor()
    yield
    seconds, own = time.perf_counter() - started, processor() - used
    each = f"{own / count * 1e3:.2f} ms a file"
    print(f"{what:<44} {seconds:8.1f} s {own:8.1f} s processor, {each}; {count / seconds:.1f} files/s", flush=True)


def processor() -> float:
    """Processor seconds of this process and of its children that have ended."""
    return sum(os.times()[:4])


def differences(expected: dict[str, object], out: Path, records: Sequence[Record]) -> list[str]:
    """Places at which a batch has something else than the plain loop."""
    written = {name: data for name, data in tree(out).items() if not name.startswith(".")}
    programs = {name: data for name, data in expected.items() if isinstance(data, bytes)}
    wrong = [name for name in written.keys() | programs.keys() if written.get(name) != programs.get(name)]
    errors = {}
    for record in records:
        if record.status is not Status.PASSED:
            errors[record.place] = [(each.line, each.what, each.code) for each in record.problems if each.code]
    failed = {name: found for name, found in expected.items() if not isinstance(found, bytes)}
    return [*wrong, *(name for name in errors.keys() | failed.keys() if not alike(errors.get(name), failed.get(name)))]


def alike(one: object, other: object) -> bool:
    """Whether errors are the same; a batch adds warnings behind them."""
    return isinstance(one, list) and isinstance(other, list) and one[: len(other)] == other


def nothing(task: Task) -> Outcome:
    """Work that takes no time, with a result of the size of a small program."""
    return Outcome(Status.PASSED, files={task.result: bytes(4000)}, figures={"points": 50})


def main() -> int:
    """Run it, and judge."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--files", type=int, default=10_000, help="how many; at least 5, by default 10000")
    parser.add_argument("--folder", type=Path, help="work here; by default in a temporary folder")
    asked = parser.parse_args()
    if asked.files < FEWEST:
        parser.error(f"--files is {asked.files}; give at least {FEWEST}")
    with tempfile.TemporaryDirectory() as temporary:
        return measure(asked.folder or Path(temporary), asked.files)


def measure(folder: Path, count: int) -> int:
    """Do it in a folder."""
    wrong = 0
    generate(folder / "in", count)
    print(f"{count} files, Trunnion {program_version()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    trunnion.post(next((folder / "in").rglob("part0.cls")), machine=MACHINE)  # kernels are compiled and loaded
    with timed("plain loop, one process", count):
        expected = plain_loop(folder / "in")
    for results, is_disturbed, scheduler in (
        ("local", False, False),
        ("cluster", False, True),
        ("disturbed", True, True),
    ):
        with Cluster(folder, 2) if scheduler else nullcontext() as cluster:
            if cluster is not None:
                wait_for(cluster)
            observer = Counter(disturbances(cluster, count) if cluster is not None and is_disturbed else {}, count)
            with timed(f"batch, two workers: {results}", count):
                result = run_batch(
                    folder / "in", results=folder / results, action="post", machine=MACHINE, settings=SETTINGS,
                    workers=None if scheduler else 2, scheduler=cluster.address if cluster is not None else None,
                    summary=folder / f"{results}.sqlite", observer=observer,
                )  # fmt: skip
        found = differences(expected, folder / results, list(result.records()))
        wrong += len(found)
        growth = (observer.memory[-1] - observer.memory[len(observer.memory) // 2]) / max(1, count // 2)
        print(f"  {dict(result.counts)}, {len(found)} differ; client {resident() // 1024} MB, +{growth:.2f} KB a file")
    with timed("the same again: everything is done", count):
        result = run_batch(
            folder / "in", results=folder / "disturbed", action="post", machine=MACHINE, settings=SETTINGS, workers=2
        )
    wrong += result.done != count
    costs(folder, count)
    print("all results are those of the plain loop" if not wrong else f"{wrong} RESULTS DIFFER")
    return 1 if wrong else 0


def disturbances(cluster: Cluster, count: int) -> dict[int, Callable[[], None]]:
    """Three deaths of a worker, and one of the scheduler."""
    kills = {count * k // 5: lambda k=k: cluster.kill_worker(k % 2) for k in (1, 2, 3)}
    return {**kills, count * 4 // 5: cluster.restart_scheduler}


def wait_for(cluster: Cluster) -> None:
    """Wait until the workers are there."""
    started = time.perf_counter()
    distributed: Any = import_module("distributed")
    with distributed.Client(cluster.address, timeout=60) as client:
        client.wait_for_workers(2, timeout=120)
        there = time.perf_counter() - started
        futures = [client.submit(_import, k, workers=[each]) for k, each in enumerate(client.nthreads())]
        used = client.gather(futures)
    print(f"  workers there after {there:.1f} s; import of Trunnion {max(used):.2f} s of processor time")


def _import(_: int) -> float:
    used = time.process_time()
    import trunnion.batch.processing

    assert trunnion.batch.processing
    return time.process_time() - used


def costs(folder: Path, count: int) -> None:
    """Measure what a file costs besides its work: the client alone, and by the scheduler."""
    files = sorted(each.relative_to(folder / "in").as_posix() for each in (folder / "in").rglob("*.cls"))
    batch = Batch(folder / "in", [BatchJob("job", Action.POST, files, {"machine": MACHINE}, extension=".mpf")])
    with timed("client alone: read, checksum, write", count):
        run_simply(batch, FolderStore(folder / "client"))
    with Cluster(folder, 2) as cluster:
        wait_for(cluster)
        for what, place in (("results come here", folder / "empty"), ("workers write", (folder / "far").as_uri())):
            store, used = open_store(place), processor_of(cluster.scheduler.pid)
            with timed(f"client with tasks that do nothing: {what}", count):
                run_jobs(batch, store, dask_workers(cluster, store))
            spent = processor_of(cluster.scheduler.pid) - used
            print(f"  scheduler: {spent / count * 1e3:.2f} ms of processor time a file", flush=True)


def dask_workers(cluster: Cluster, store: Store) -> Callable[[int], DaskWorkers]:
    """Return what makes workers that do nothing, and write to a store themselves where they reach it."""
    return lambda _: DaskWorkers(Scheduler(cluster.address), nothing, writing=store.worker_url)


def processor_of(process: int) -> float:
    """Processor seconds of another process so far."""
    psutil: Any = import_module("psutil")  # comes with Dask
    found = psutil.Process(process).cpu_times()
    return float(found.user + found.system)


if __name__ == "__main__":
    sys.exit(main())
