"""Batches whose work takes no time, and a store in which it is interrupted."""

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from random import Random
from types import TracebackType

from tests.support.batch_work import simple_work
from trunnion.batch.jobs import Batch, BatchJob
from trunnion.batch.records import FOLDER, Record
from trunnion.batch.running import BatchResult, run_jobs
from trunnion.batch.stores import FolderStore, Store
from trunnion.batch.worker_task import Action, Outcome, Task
from trunnion.batch.workers import Assignment
from trunnion.jobs.observer import SILENT, Observer


class InOrder:
    """Does the work here, one task after another; ``reverse``: the last one first."""

    def __init__(self, *, reverse: bool = False) -> None:
        self.done: list[str] = []
        self._reverse = reverse

    def __enter__(self) -> "InOrder":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        """Nothing is left to end."""

    def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        given = [each for each in tasks if each is not None]
        for assignment, task in reversed(given) if self._reverse else given:
            self.done.append(assignment.record.file)
            yield assignment, simple_work(task)


class AsTheyCome(InOrder):
    """Does the work here; of ``window`` tasks that are there at a time, any one is done next.

    shares  which shares were made: file and number
    """

    def __init__(self, window: int = 1, seed: int = 0, function: Callable[[Task], Outcome] = simple_work) -> None:
        super().__init__()
        self.shares: list[tuple[str, int]] = []
        self._window, self._random, self._function = window, Random(seed), function

    def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        coming, there = iter(tasks), list[tuple[Assignment, Task]]()
        while True:
            while len(there) < self._window and (each := next(coming, None)) is not None:
                there.append(each)
            if not there:
                return
            assignment, task = there.pop(self._random.randrange(len(there)))
            if task.share is None:
                self.done.append(assignment.record.file)
            else:
                self.shares.append((assignment.record.file, task.share[0]))
            yield assignment, self._function(task)


class Interrupted(KeyboardInterrupt):
    """What ``StoppingStore`` raises."""


class StoppingStore(FolderStore):
    """A folder in which the work is interrupted before a change, counted from 0; or within it, which leaves a part."""

    def __init__(self, folder: Path, before: int) -> None:
        super().__init__(folder)
        self.changes, self._before = 0, before

    def write(self, name: str, content: bytes, *, lasting: bool = True) -> None:
        """Write, or be interrupted."""
        self._count()
        super().write(name, content, lasting=lasting)

    def remove(self, name: str) -> None:
        """Remove, or be interrupted."""
        self._count()
        super().remove(name)

    def _count(self) -> None:
        if self.changes == self._before:
            raise Interrupted
        self.changes += 1


def write_files(folder: Path, texts: dict[str, str]) -> None:
    """Files by their names, with ``/``."""
    for name, text in texts.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())


def simple_batch(folder: Path) -> Batch:
    """All files ``.cls`` in a folder; nothing is asked of a machine."""
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.cls"))
    return Batch(folder, [BatchJob("job", Action.POST, files, {"machine": "yl569"}, extension=".mpf")])


def divided_batch(folder: Path, tiles: int) -> Batch:
    """The same, each file divided among tasks."""
    batch = simple_batch(folder)
    return replace(batch, jobs=[replace(batch.jobs[0], action=Action.SIMULATE, tiles=tiles)], home="home")


def run_simply(batch: Batch, store: Store, workers: InOrder | None = None, observer: Observer = SILENT) -> BatchResult:
    """Run a batch here."""
    team = workers or InOrder()
    return run_jobs(batch, store, lambda _: nullcontext(team), observer)


def tree(folder: Path) -> dict[str, object]:
    """All files of a folder of results: bytes, and of records all but what the work cost."""
    found: dict[str, object] = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if not path.is_file():
            continue
        content = path.read_bytes()
        is_record = name.startswith(FOLDER) and name.endswith(".json")
        found[name] = json.loads(content.splitlines()[0]) if is_record else content
    return found
