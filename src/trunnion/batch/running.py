"""A batch from its jobs to its results: what is done already is left, everything else is given to workers."""

import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import field, replace
from operator import attrgetter
from pathlib import Path, PurePosixPath
from typing import Annotated, Any, ClassVar, Final

from trunnion.batch.divided_files import Divisions
from trunnion.batch.jobs import Batch, BatchJob, Unit
from trunnion.batch.local import LocalWorkers
from trunnion.batch.obsolete_results import remove_obsolete, remove_obsolete_shares
from trunnion.batch.places import units_of
from trunnion.batch.processing import work
from trunnion.batch.records import (
    Record,
    check_store,
    commit,
    read_records,
    record_bytes,
    record_name,
    settle,
)
from trunnion.batch.result_keys import digest, key_of, program_version
from trunnion.batch.stores import Store
from trunnion.batch.warning_counts import CountedWarning, WarningCounter
from trunnion.batch.worker_task import FILES, Outcome, Status, Task
from trunnion.batch.workers import Assignment, Workers
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.project.paths import is_file
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import FIRST, NOT_DATA, Figure, to_data

#: What data says of a file.
_OF_FILE: Final = ("job", "file", "status", "outputs", "error")


@dataclass(frozen=True, slots=True, eq=False)
class BatchResult:
    """What became of a batch; records of its files stay with the results, and are read when they are asked for.

    units   all files, in the order of the places of their results
    store   where the results are
    counts  how many became what
    done    how many were done already
    failed  indices of the units that did not pass
    jobs    their names
    new     indices of the units of which this run has written files
    warned  the warnings of all files by their codes, those of the most files first
    """

    SCHEMA: ClassVar[int] = 1

    units: Annotated[Sequence[Unit], NOT_DATA]
    store: Annotated[Store, Figure("results", take=attrgetter("label"))]
    counts: Mapping[Status, int]
    done: Annotated[int, Figure("done_before")]
    failed: Annotated[Sequence[int], NOT_DATA] = field(repr=False)
    jobs: Annotated[Sequence[str], NOT_DATA] = ()
    new: Annotated[Sequence[int], NOT_DATA] = field(default=(), repr=False)
    warned: Annotated[Sequence[CountedWarning], NOT_DATA] = ()

    @property
    @Figure(after=FIRST)
    def passed(self) -> bool:
        """Whether every file is done, and may run."""
        return not self.failed

    @property
    @Figure()
    def files(self) -> Any:
        """What became of each file, as data."""
        return to_data(list(self.records()), only=_OF_FILE)

    def records(self) -> Iterator[Record]:
        """Return what became of each file, in the order of the places of results."""
        return self._read(self.units)

    def failures(self) -> Iterator[Record]:
        """Return the same of those that did not pass."""
        return self._read([self.units[k] for k in self.failed])

    def written(self) -> Iterator[Record]:
        """Return the same of those of which this run has written files."""
        return self._read([self.units[k] for k in self.new])

    def _read(self, units: Sequence[Unit]) -> Iterator[Record]:
        for record in read_records(self.store, [unit.place for unit in units]):
            if record is not None:
                yield record


def run_jobs(
    batch: Batch, store: Store, workers: Callable[[int], AbstractContextManager[Workers]], observer: Observer = SILENT
) -> BatchResult:
    """Do what is not done yet of a batch.

    workers  makes the workers, of at most as many as there are files

    Raises ``InputError`` if results cannot be kept, or nobody can work. What is done by then stays done.
    """
    units = units_of(batch.jobs)
    check_store(store)
    remove_obsolete(batch, units, store, observer)
    remove_obsolete_shares(batch, units, store, observer)
    steps = [batch.jobs[unit.job].tasks for unit in units]
    is_divided, new = sum(steps) > len(units), list[int]()
    with observer.progress("batch", sum(steps), "tasks" if is_divided else "files") as advance:
        found, divisions = _Tally(steps, advance), Divisions(store, observer)
        pending = _Pending(batch, store, units, found, divisions)
        with workers(sum(steps)) as team:
            for assignment, outcome in team.run(pending.tasks()):
                if assignment.is_share:
                    assert isinstance(outcome, Outcome)  # a share has no record
                    found.step(assignment.number)
                    told = divisions.take(assignment, outcome)
                    if told is None:
                        continue
                    assignment, outcome = told
                record = outcome if isinstance(outcome, Record) else settle(store, assignment.record, outcome)
                divisions.end(record)
                found.add(assignment.number, record)
                new += [assignment.number] if record.outputs else []
    names = [job.name for job in batch.jobs]
    failed, warned = sorted(found.failed), found.warnings.found()
    return BatchResult(units, store, dict(found.counts), pending.done, failed, names, sorted(new), warned)


class _Tally:
    """What became of files: counts, the numbers of those that did not pass, what is warned of; and the progress.

    ``steps`` are the tasks of each file.
    """

    def __init__(self, steps: Sequence[int], advance: Callable[[int], None]) -> None:
        self.counts = Counter[Status]()
        self.failed: list[int] = []
        self.warnings = WarningCounter()
        self._left = list(steps)
        self._advance = advance

    def step(self, number: int, count: int = 1) -> None:
        """Tell that shares of a file are done; of one that has failed already nothing is told."""
        count = min(count, self._left[number])
        self._left[number] -= count
        if count:
            self._advance(count)

    def add(self, number: int, record: Record) -> None:
        """Count a file."""
        self.counts[record.status] += 1
        self.warnings.add(number, record)
        if record.status is not Status.PASSED:
            self.failed.append(number)
        self.step(number, self._left[number])


class _Pending:
    """The tasks that are not done yet, made one at a time as workers ask for them.

    done  how many were found done so far
    """

    def __init__(self, batch: Batch, store: Store, units: Sequence[Unit], found: _Tally, divisions: Divisions) -> None:
        self.done = 0
        self._batch, self._store, self._units, self._found, self._divisions = batch, store, units, found, divisions
        self._shared = [{name: path.read_bytes() for name, path in job.shared.items()} for job in batch.jobs]
        self._digests = [{name: digest(data) for name, data in each.items()} for each in self._shared]

    def tasks(self) -> Iterator[tuple[Assignment, Task] | None]:
        """Yield tasks, and None where one must be waited for; files that cannot be read are failures at once."""
        for each in self._of_files():
            yield from self._divisions.complete()  # what is joined needs its shares no more
            yield each
        while self._divisions.is_waiting:
            yield next(self._divisions.complete(), None)

    def _record(self, unit: Unit) -> Record:
        job = self._batch.jobs[unit.job]
        return Record(unit.place, unit.file, job.name, str(job.action), "", Status.BROKEN, home=self._batch.home)

    def _of_files(self) -> Iterator[tuple[Assignment, Task]]:
        """Yield the tasks of all files."""
        records = read_records(self._store, [unit.place for unit in self._units])
        for number, (unit, before) in enumerate(zip(self._units, records, strict=True)):
            job, record = self._batch.jobs[unit.job], self._record(unit)
            try:
                task = task_of(self._batch.folder, job, unit, self._shared[unit.job])
            except InputError as error:
                self._found.add(number, commit(self._store, record, Outcome(Status.UNUSABLE, error.problems)))
                continue
            digests = {**self._digests[unit.job], **{name: digest(data) for name, data in task.files.items()}}
            key = _key(task, digests)
            if before is not None and before.is_done(key, self._store):
                self._take_over(before, record)
                self.done += 1
                self._divisions.end(before)  # the last run may have ended before it did
                self._found.add(number, before)
                continue
            assignment = Assignment(number, replace(record, key=key))
            if job.tiles > 1:
                try:
                    there, shares = self._divisions.divide(assignment, task, job.tiles, digests)
                except InputError as error:
                    outcome = Outcome(Status.HINDERED, error.problems)
                    self._found.add(number, commit(self._store, record, outcome))
                    continue
                self._found.step(number, there)
                yield from shares
            else:
                yield assignment, task

    def _take_over(self, before: Record, record: Record) -> None:
        """Take over a record that is done, with the name that its job has now."""
        if (before.job, before.home) != (record.job, record.home):
            renamed = replace(before, job=record.job, home=record.home)
            self._store.write(record_name(record.place), record_bytes(renamed))


def task_of(folder: Path, job: BatchJob, unit: Unit, shared: Mapping[str, bytes]) -> Task:
    """Return the task of a unit, with the content of its files as it is now; what goes with it and is missing is left
    out.

    Raises ``InputError`` if a file cannot be read, leads out of the folder, or its result has no place.
    """
    if unit.clash:
        raise InputError(Problem(unit.file, 0, Wording("BAT380", "result_would_another", clash=unit.clash)))
    arguments: dict[str, Any] = dict(job.arguments)
    name = FILES + unit.file
    own = {name: _read(folder, unit.file, unit.file)}
    for argument, patterns in job.beside.items():
        arguments[argument] = []
        for pattern in patterns:
            beside = _beside(pattern, unit.file)
            arguments[argument].append(FILES + beside)
            if is_file(folder / beside):
                own[FILES + beside] = _read(folder, beside, unit.file)
    result = PurePosixPath(unit.place).name
    report = f"{result}.{job.report}" if job.report else ""
    return Task(program_version(), job.action, arguments, name, own, shared, result, report)


def _read(folder: Path, name: str, file: str) -> bytes:
    """Return the content of a file that the work on ``file`` reads; links are followed within the folder."""
    path = folder / name
    if not is_within(path, folder):
        raise InputError(
            Problem(
                file,
                0,
                Wording("FIL120", "leads_out_folder")
                if name == file
                else Wording("FIL120", "goes_leads_out", name=name),
            )
        )
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(
            Problem(
                file,
                0,
                Wording("FIL120", "archive_unreadable", strerror=error.strerror or error)
                if name == file
                else Wording("FIL120", "goes_cannot_read", name=name, strerror=error.strerror or error),
            )
        ) from None


def _beside(pattern: str, file: str) -> str:
    """Return the name of a file that goes with another one."""
    path = PurePosixPath(file)
    return PurePosixPath(pattern.replace("{folder}", path.parent.as_posix()).replace("{stem}", path.stem)).as_posix()


def _key(task: Task, digests: Mapping[str, str]) -> str:
    said = [task.action, task.arguments, task.file, task.result, task.report]
    return key_of(task.program, {"said": said}, digests)


def local_workers(count: int | None, timeout: float | None) -> Callable[[int], AbstractContextManager[Workers]]:
    """Return what makes workers on this computer: ``count``, by default as many as there are processors."""

    def make(most: int) -> AbstractContextManager[Workers]:
        return LocalWorkers(max(1, min(count or os.cpu_count() or 1, most)), work, timeout)

    return make
