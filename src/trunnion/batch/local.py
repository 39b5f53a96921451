"""Workers as processes of this computer, each with a pipe of its own: the death of one takes its own file only.

Python's own pools (``ProcessPoolExecutor``) end all of their work when one process dies, and cannot end a task that
takes too long.
"""

import multiprocessing
import signal
import tempfile
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import field
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from tempfile import TemporaryDirectory
from typing import Any, Final, Generic, Protocol, Self, TypeVar

from trunnion.batch.worker_task import Costs, Outcome, Status
from trunnion.batch.workers import died, timed_out
from trunnion.errors import InputError, Problem
from trunnion.files.interrupts import children_without_interrupts
from trunnion.messages import Wording
from trunnion.records import dataclass

#: How often a file is tried whose worker dies: the first time another one may have taken the memory.
TRIES: Final = 2

#: Seconds that the start of a process may take: imports, and the kernels, which are compiled once on a computer.
START: Final = 120.0

#: Workers that end before they can begin, one after another: then none will.
_MOST_STILLBORN: Final = 3


class FileTask(Protocol):
    """A task: work on a file, which messages name."""

    @property
    def file(self) -> str:
        """Its name."""


_Place = TypeVar("_Place")
_Task = TypeVar("_Task", bound=FileTask)


@dataclass(slots=True, eq=False)
class _Worker:
    """A process, and what it works on.

    since    when it was given that
    is_warm  whether it has ended a task before: with the first one it loads libraries and kernels
    """

    process: BaseProcess
    pipe: "Connection[Any, Any]"
    is_ready: bool = False
    given: "_Given | None" = None
    since: float = 0.0
    is_warm: bool = False


@dataclass(slots=True)
class _Given:
    assignment: Any
    task: FileTask
    tries: int = field(default=0)


class LocalWorkers(Generic[_Place, _Task]):
    """Processes that work on tasks, each of which belongs somewhere. Use it as a context manager: they end with it.

    count     how many
    function  what they do; it must be importable
    timeout   seconds that a task may take; None: any time. It is ended by ending its process. The start of a process
              does not count: if its first task took too long, it does it once more
    start     seconds that a start may take beyond that
    """

    def __init__(
        self, count: int, function: Callable[[_Task], Outcome], timeout: float | None = None, start: float = START
    ) -> None:
        self._count, self._function, self._timeout, self._start_time = count, function, timeout, start
        self._context = multiprocessing.get_context("spawn")
        self._workers: list[_Worker] = []
        self._stillborn = 0

    def __enter__(self) -> Self:
        try:
            self._folder = TemporaryDirectory(prefix="trunnion-", ignore_cleanup_errors=True)
        except OSError as error:
            raise InputError(
                Problem("batch", 0, Wording("BAT390", "folder_temporary_files", strerror=error.strerror or error))
            ) from None
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            _end(worker)
        self._workers.clear()
        self._folder.cleanup()

    def run(self, tasks: Iterable[tuple[_Place, _Task] | None]) -> Iterator[tuple[_Place, Outcome]]:
        """Outcomes as they come, each with its assignment; no more tasks are taken than workers are free.

        Raises ``InputError`` if no worker can be started.
        """
        coming, again = iter(tasks), deque[_Given]()
        while True:
            for worker in self._idle():
                if again or (again := _next(coming)):
                    self._give(worker, again.popleft())
            if not again and len(self._workers) < self._count:
                again = _next(coming)
            if again:
                self._workers += [self._start() for _ in range(self._count - len(self._workers))]
            elif all(worker.given is None for worker in self._workers):
                return
            for worker in self._heard_of():
                yield from self._hear(worker, again)
            yield from self._late()

    def _idle(self) -> list[_Worker]:
        return [worker for worker in self._workers if worker.is_ready and worker.given is None]

    def _start(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(theirs, self._function, self._folder.name), daemon=True)
        with children_without_interrupts():
            process.start()
        theirs.close()
        return _Worker(process, ours)

    def _give(self, worker: _Worker, given: _Given) -> None:
        worker.given, worker.since = given, time.monotonic()
        given.tries += 1
        with suppress(OSError):  # it has died: its pipe tells
            worker.pipe.send(given.task)

    def _heard_of(self) -> list[_Worker]:
        """Workers that have something to tell, or have died."""
        seconds = None
        if self._timeout is not None:
            now = time.monotonic()
            left = [self._deadline(worker) - now for worker in self._workers if worker.given is not None]
            seconds = max(0.0, min(left, default=self._timeout))
        by_pipe = {worker.pipe: worker for worker in self._workers}
        return [by_pipe[pipe] for pipe in wait(list(by_pipe), seconds)]  # type: ignore[index]

    def _hear(self, worker: _Worker, again: deque[_Given]) -> Iterator[tuple[Any, Outcome]]:
        try:
            told = worker.pipe.recv()
        except (EOFError, OSError):
            yield from self._bury(worker, again)
            return
        if isinstance(told, Exception):
            raise InputError(Problem("batch", 0, Wording("BAT210", "worker_cannot_work", told=told)))
        worker.is_ready = True
        if worker.given is not None and isinstance(told, Outcome):
            was_warm, worker.is_warm = worker.is_warm, True
            given, worker.given = worker.given, None
            if not was_warm and self._timeout is not None and time.monotonic() - worker.since > self._timeout:
                given.tries -= 1
                self._give(worker, given)
                return
            yield given.assignment, told

    def _deadline(self, worker: _Worker) -> float:
        """When the time of a worker's task is over."""
        assert self._timeout is not None
        return worker.since + self._timeout + (0.0 if worker.is_warm else self._start_time)

    def _bury(self, worker: _Worker, again: deque[_Given]) -> Iterator[tuple[Any, Outcome]]:
        """Take leave of a worker that has died, and try its task again, or tell that it cannot be done."""
        self._workers.remove(worker)
        _end(worker)
        if not worker.is_ready:
            self._stillborn += 1
            if self._stillborn >= _MOST_STILLBORN:
                raise InputError(
                    Problem("batch", 0, Wording("BAT210", "worker_processes_end", exitcode=worker.process.exitcode))
                )
            return
        self._stillborn = 0
        given = worker.given
        if given is None:
            return
        if given.tries < TRIES:
            again.append(given)
            return
        yield (
            given.assignment,
            Outcome(
                Status.DIED,
                (
                    died(
                        given.task.file,
                        Wording("BAT310", "worker_process_died", tries=given.tries, exitcode=worker.process.exitcode),
                    ),
                ),
            ),
        )

    def _late(self) -> Iterator[tuple[Any, Outcome]]:
        """End the workers whose time is over."""
        if self._timeout is None:
            return
        now = time.monotonic()
        for worker in list(self._workers):
            if worker.given is not None and now >= self._deadline(worker):
                self._workers.remove(worker)
                _end(worker)
                problem = timed_out(worker.given.task.file, self._timeout)
                yield (
                    worker.given.assignment,
                    Outcome(Status.TIMED_OUT, (problem,), costs=Costs(0.0, now - worker.since)),
                )


def _next(coming: Iterator[tuple[Any, FileTask] | None]) -> "deque[_Given]":
    """Return the next task, if there is one now."""
    each = next(coming, None)
    return deque() if each is None else deque([_Given(*each)])


def _end(worker: _Worker) -> None:
    worker.process.kill()
    worker.process.join()
    worker.pipe.close()


def _serve(pipe: "Connection[Any, Any]", function: Callable[[Any], Outcome], folder: str) -> None:
    """Work on tasks until nobody gives any more, with temporary files in a folder that outlives the process."""
    tempfile.tempdir = folder
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # for a process that was not started so
    with suppress(EOFError, OSError):
        pipe.send(None)
        while True:
            task = pipe.recv()
            try:
                outcome: Outcome | Exception = function(task)
            except Exception as error:
                outcome = RuntimeError(str(error))
            pipe.send(outcome)
