"""Cures of messages about workers of batches: processes of this computer, and workers of a cluster."""

import multiprocessing
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.scripts import FILES
from tests.support.simulating import SLOT, STOCK, TOOL
from trunnion.batch import cluster, processing
from trunnion.batch.cluster import DaskWorkers, Scheduler
from trunnion.batch.local import LocalWorkers
from trunnion.batch.processing import work
from trunnion.batch.records import Record
from trunnion.batch.result_keys import program_version
from trunnion.batch.worker_task import Action, Status, Task
from trunnion.batch.worker_task import Outcome as Became
from trunnion.batch.workers import Assignment
from trunnion.errors import Problem, TrunnionError
from trunnion.jobs.observer import Observer


def _task(program: str = "") -> Task:
    """The verification of a program; or one that another version of Trunnion asks for."""
    files = {"files/part.mpf": FILES["part.mpf"].encode()}
    return Task(program or program_version(), Action.VERIFY, {"machine": "yl569"}, "files/part.mpf", files, {}, "", "")


class _Hearing(Observer):
    def __init__(self) -> None:
        self.found: list[Problem] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.found += problems


class _End:
    """The end of a pipe at a process, which alone closes it."""

    def __init__(self, pipe: Any) -> None:
        self.pipe = pipe

    def close(self) -> None:
        """Nothing: the process has it."""


class _Process:
    """What stands for a process: it ends before it begins or with its task, never answers, or works in a thread."""

    exitcode = -9

    def __init__(self, how: str, args: tuple[_End, Callable[[Any], Any], str]) -> None:
        self._how, self._pipe, self._work = how, args[0].pipe, args[1]

    def start(self) -> None:
        if self._how == "works":
            threading.Thread(target=self._serve, daemon=True).start()
            return
        if self._how != "ends":
            self._pipe.send(None)
        if self._how != "is silent":
            self._pipe.close()

    def _serve(self) -> None:
        with suppress(EOFError, OSError):
            self._pipe.send(None)
            while True:
                self._pipe.send(self._work(self._pipe.recv()))

    def kill(self) -> None:
        """It ends when nobody hears it any more."""

    def join(self) -> None:
        """As above."""


def _locally(how: str, timeout: float | None = None, start: float = 60.0) -> Trial:
    """Return what has one file verified by a process that does as is said."""

    def pipe() -> tuple[Any, _End]:
        ours, theirs = multiprocessing.Pipe()
        return ours, _End(theirs)

    context = SimpleNamespace(Pipe=pipe, Process=lambda target, args, daemon: _Process(how, args))

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.object(multiprocessing, "get_context", return_value=context):
            workers: LocalWorkers[int, Task] = LocalWorkers(1, work, timeout, start)
        try:
            with workers:
                found = [outcome for _, outcome in workers.run([(0, _task())])]
        except TrunnionError as error:
            return Outcome(error.problems, False)
        return Outcome(found[0].problems, found[0].status is Status.PASSED)

    return tried


def _each(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Do the work on files of names, at one of which Trunnion has an error."""

    def broken(task: Task, *_: Any) -> Any:
        raise ZeroDivisionError(f"no room for {task.file}")

    found: list[Became] = []
    for name in text.split():
        how = {Action.VERIFY: broken} if name == "broken.mpf" else {}
        with patch.dict(processing._DOING, how):
            found.append(work(_task()))
    problems = tuple(problem for outcome in found for problem in outcome.problems)
    return Outcome(problems, all(outcome.status is Status.PASSED for outcome in found))


class _Future:
    """A task that is done as soon as there is a worker, by the call itself."""

    def __init__(self, client: "_Client", call: Callable[[], Any]) -> None:
        self._client, self._call = client, call

    @property
    def status(self) -> str:
        return "finished" if self._client.is_there and self._client.nthreads() else "pending"

    def add_done_callback(self, call: Callable[[Any], Any]) -> None:
        """Nobody waits for it: it is looked at now and then."""

    def result(self, timeout: float) -> Any:
        return self._call()


class _Client:
    """A scheduler with a worker."""

    is_there = True
    raises: Exception | None = None

    def __init__(self, address: str, **_: Any) -> None:
        """Connect."""

    @property
    def status(self) -> str:
        return "running" if self.is_there else "closed"

    def nthreads(self) -> dict[str, int]:
        return {"worker": 1}

    def submit(self, call: Callable[..., Any], *given: Any, **_: Any) -> _Future:
        def done() -> Any:
            if self.raises:
                raise self.raises
            return call(*given)

        return _Future(self, done)

    def gather(self, futures: Mapping[str, _Future]) -> dict[str, Any]:
        return {place: future.result(1.0) for place, future in futures.items()}

    def close(self, timeout: float) -> None:
        """Nothing is open."""


class KilledWorker(Exception):  # noqa: N818  Dask calls it so
    """What Dask raises of a task over which several workers have died."""


class _Killing(_Client):
    raises = KilledWorker("a task has killed three workers")


class _Lacking(_Client):
    raises = RuntimeError("no libstdc++ here")


class _Nowhere(_Client):
    def __init__(self, address: str, **_: Any) -> None:
        raise OSError(f"nothing answers at {address}")


class _Idle(_Client):
    """A scheduler without workers; or whose first worker comes late."""

    comes_at = 10**9

    def __init__(self, address: str, **_: Any) -> None:
        self._asked = 0

    def nthreads(self) -> dict[str, int]:
        self._asked += 1
        return {"worker": 1} if self._asked >= self.comes_at else {}


class _Late(_Idle):
    comes_at = 9


class _Leaving(_Client):
    """A scheduler that is gone once, and there again when it is sought."""

    times = 0

    def __init__(self, address: str, **_: Any) -> None:
        _Leaving.times += 1
        self.is_there = _Leaving.times % 2 == 0


def _afar(client: type[_Client] = _Client, program: str = "", wait: float | None = None) -> Trial:
    """Return what has one file verified by a scheduler; it is looked at all the time, and nobody waits."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        task, heard = _task(program), _Hearing()
        assignment = Assignment(0, Record("part.mpf", "part.mpf", "", "verify", "key", Status.BROKEN))
        modules = {"distributed": SimpleNamespace(Client=client)}
        with patch.dict(sys.modules, modules), patch.multiple(cluster, _LOOK=0.0, _ATTEMPT=0.0, SILENCE=0.0):
            try:
                with DaskWorkers(Scheduler("tcp://mill:8786", wait=wait), work, observer=heard) as workers:
                    found = [outcome for _, outcome in workers.run([(assignment, task)])]
            except TrunnionError as error:
                return Outcome((*heard.found, *error.problems), False)
        assert isinstance(found[0], Became)
        return Outcome((*heard.found, *found[0].problems), found[0].status is Status.PASSED)

    return tried


def _simulated(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Simulate a program as a worker does."""
    arguments = {"machine": "xyzac_trt", "stock": STOCK, "tools": [TOOL], "cell": 2.0}
    files = {"files/part.ngc": text.encode()}
    found = work(Task(program_version(), Action.SIMULATE, arguments, "files/part.ngc", files, {}, "", ""))
    return Outcome(found.problems, found.status is Status.PASSED)


_WORKS: Final = _locally("works", 60.0)

CURES: Final = (
    Cure("BAT330", "trunnion_error_here", _each, "part.mpf broken.mpf", ((" broken.mpf", ""),)),
    Cure("BAT210", "worker_processes_end", _locally("ends"), "", (), cured_by=_WORKS),
    Cure("BAT310", "worker_process_died", _locally("dies"), "", (), cured_by=_WORKS),
    Cure("BAT350", "was_not_done", _locally("is silent", 0.0, 0.0), "", (), cured_by=_WORKS),
    Cure("BAT210", "", _afar(program="0.1"), "", (), cured_by=_afar()),
    Cure("BAT210", "worker_of_other_version", _afar(program="0.1"), "", (), cured_by=_afar()),
    Cure("BAT210", "worker_fails", _afar(_Lacking), "", (), cured_by=_afar()),
    Cure("BAT220", "no_scheduler_dask", _afar(_Nowhere), "", (), cured_by=_afar()),
    Cure("BAT230", "scheduler_gone_awaited", _afar(_Leaving), "", (), stays=True),
    Cure("BAT240", "scheduler_no_worker", _afar(_Late), "", (), cured_by=_afar()),
    Cure("BAT240", "scheduler_had_no", _afar(_Idle, wait=0.0), "", (), cured_by=_afar(wait=0.0)),
    Cure("BAT310", "several_workers_died", _afar(_Killing), "", (), cured_by=_afar()),
    Cure("BAT340", "", _simulated, SLOT.replace("G1 X70", "G0 X70"), (("G0 X70", "G1 X70"),)),
)
