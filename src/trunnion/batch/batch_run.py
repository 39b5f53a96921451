"""The front door of batches: what is asked for, as arguments, and what became of it."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Final, Literal, TypedDict, Unpack

from trunnion.batch.cluster import DaskWorkers, Scheduler, Tls
from trunnion.batch.jobs import Batch, folder_batch
from trunnion.batch.jobs_file import load_batch
from trunnion.batch.places import units_of
from trunnion.batch.processing import work
from trunnion.batch.running import BatchResult, local_workers, run_jobs
from trunnion.batch.stores import Store, open_store
from trunnion.batch.summary import check_summary, write_summary
from trunnion.batch.worker_task import Action
from trunnion.batch.workers import Workers
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.files import check_outputs
from trunnion.files.places import file_identity
from trunnion.jobs.arguments import taken
from trunnion.jobs.inputs.arguments import check_choice, check_observer, check_path
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.settings import Settings
from trunnion.jobs.observer import SILENT, Observer
from trunnion.messages import Wording

#: Arguments about the run as a whole; files of jobs state all others.
_OF_RUN: Final = ("results", "workers", "timeout", "scheduler", "wait", "tls", "summary")

#: Workers of one computer.
_MOST_WORKERS: Final = 1024


class BatchArguments(TypedDict, total=False):
    """Arguments of ``trunnion.batch.run_batch``."""

    results: FilePath | None
    action: Literal["post", "convert", "verify", "simulate"] | None
    machine: FilePath | None
    files: Sequence[str]
    settings: Settings | None
    to_machine: FilePath | None
    to_cl: bool
    cl: Sequence[str]
    stock: FilePath | None
    tools: Sequence[str]
    report: Literal["html", "json"] | None
    tiles: int | None
    workers: int | None
    timeout: float | None
    scheduler: str | None
    wait: float | None
    tls: Tls | None
    summary: FilePath | None


def run_batch(
    jobs: FilePath, *, observer: Observer = SILENT, written: Sequence[FilePath] = (), **given: Unpack[BatchArguments]
) -> BatchResult:
    """Post, convert, verify or simulate many files; what is done already is not done again.

    Parameters
    ----------
    jobs
        A file of jobs (``.toml``; docs/batch.md), which states all but ``results`` and what follows ``tiles``; or a
        folder, of which every file is taken that the action is for.
    results
        Folder of the results, or an address of fsspec such as ``s3://bucket/folder``; by default what the file of jobs
        says.
    action
        What is done with each file of a folder.
    machine
        The machine of a folder's programs: a name, or a path.
    files
        Patterns of names in a folder, such as ``"**/*.nc"``; by default the extensions of CL files, or that of the
        machine's programs.
    settings
        As ``trunnion.post`` takes them.
    to_machine, to_cl
        Where a conversion leads.
    cl
        Names of the CL files that a program is compared with, ``"{folder}/{stem}.cls"``, below the folder.
    stock, tools
        As ``trunnion.simulate`` takes them.
    report
        Form of the report of each file; None: there is none.
    tiles
        Tasks among which a simulation of a folder's program is divided, by tiles of its stock; by default it is one.
    workers
        Processes of this computer; by default as many as there are processors.
    timeout
        Seconds that a file may take on this computer; None: any time.
    scheduler
        Address of a scheduler of Dask, such as ``"tcp://host:8786"``, whose workers do the work.
    wait
        Seconds for which the scheduler may be without any worker; None: any time, which is told.
    tls
        Certificates for a scheduler at ``tls://``.
    summary
        File of a table of all files, ``.sqlite`` or ``.parquet``.
    observer
        Receives the progress, in files; in tasks where some files are divided.
    written
        Files that the caller writes besides: they, and the summary, must be none of those that the jobs read.

    Returns
    -------
    BatchResult
        ``passed``, ``counts``, and ``failures()``, which are read where the results are.

    Raises
    ------
    InputError
        When the jobs cannot be used, results cannot be kept, or nobody can work. A file that fails raises nothing.

    Notes
    -----
    Processes of this computer import the script that calls this: it does so behind ``if __name__ == "__main__":``.

    Examples
    --------
    >>> from trunnion.batch import run_batch
    >>> result = run_batch(
    ...     "tests/golden/yl569", results="build/batch", action="post", machine="yl569", files=["2_*.cls"], workers=1
    ... )
    >>> result.passed, [record.place for record in result.records()]
    (True, ['2_hub_rough.mpf'])
    """
    check_observer(observer)
    path = check_path("jobs", jobs)
    found = taken(BatchArguments, "batch", given)
    stated = {name: value for name, value in found.items() if name not in _OF_RUN}
    results, summary = found["results"], found["summary"]
    if summary is not None:
        check_summary(summary)
    team = _team(found, observer)
    batch = _batch(path, stated, results)
    _check_written([*([] if summary is None else [summary]), *written], path, batch)
    place = results if results is not None else batch.results
    if place is None:
        raise InputError(argument_problem("results", Wording("ARG130", "missing")))
    store = open_store(place if isinstance(place, str) else Path(place))
    _check_results(batch, store)
    result = run_jobs(batch, store, team(store), observer)
    if summary is not None:
        write_summary(result, summary)
    return result


def _batch(path: Path, given: Mapping[str, Any], results: FilePath | None) -> Batch:
    """Return the jobs of a file, or those of a folder as arguments say."""
    stated = {name: value for name, value in given.items() if value or (name == "tiles" and value is not None)}
    if not path.is_dir():
        if stated and path.suffix != ".toml" and not path.exists():
            raise InputError(Problem(str(path), 0, Wording("FIL110", "no_such_folder")))
        if stated:
            raise InputError(argument_problem(next(iter(stated)), Wording("ARG130", "file_jobs_states", path=path)))
        return load_batch(path)
    if "action" not in stated:
        raise InputError(argument_problem("action", Wording("ARG130", "missing_action")))
    check_choice("action", stated["action"], tuple(Action))
    action, patterns = Action(stated.pop("action")), stated.pop("files", ())
    inside = results if results is not None and "://" not in str(results) else None
    return folder_batch(path, action, stated, None if inside is None else Path(inside), patterns)


def _check_written(written: Sequence[FilePath], jobs: Path, batch: Batch) -> None:
    """Refuse to write over a file that the jobs read, or two outputs into one."""
    if written:
        shared = (file for job in batch.jobs for file in job.shared.values())
        names = (batch.folder / name for job in batch.jobs for name in job.files)
        check_outputs(written, [*([] if jobs.is_dir() else [jobs]), *shared, *names])


def _check_results(batch: Batch, store: Store) -> None:
    """Refuse results that would take the places of files that the jobs read."""
    if store.folder is None or not store.folder.is_dir():
        return
    read = {file_identity(batch.folder / name): name for job in batch.jobs for name in job.files}
    for unit in units_of(batch.jobs):
        if file := read.get(file_identity(store.folder / unit.place)):
            wording = Wording("FIL240", "result_over_input", result=unit.place, file=file)
            raise InputError(argument_problem("results", wording))


def _team(
    given: BatchArguments, observer: Observer
) -> Callable[[Store], Callable[[int], AbstractContextManager[Workers]]]:
    """Return what makes the workers once the place of results is known."""
    workers, timeout, scheduler = given["workers"], given["timeout"], given["scheduler"]
    wait, tls = given["wait"], given["tls"]
    if scheduler is None:
        for name, value in (("tls", tls), ("wait", wait)):
            if value is not None:
                raise InputError(argument_problem(name, Wording("ARG130", "scheduler")))
        return lambda _: local_workers(workers, timeout)
    for name, local in (("workers", workers), ("timeout", timeout)):
        if local is not None:
            raise InputError(argument_problem(name, Wording("ARG130", "processes_computer_workers")))
    dask = Scheduler(scheduler, tls or Tls(), wait=wait)
    return lambda store: lambda _: DaskWorkers(dask, work, writing=store.worker_url, observer=observer)
