"""Workers of a cluster, by a scheduler of Dask: one task for each file, whose bytes go there and come back.

Results are written here, or by the workers where these reach the place of results themselves (``writing``). A worker
that dies loses nothing: the scheduler gives its tasks to others. If the scheduler is gone, this waits for it to come
back and asks again for what it has not heard of; what comes twice is the same, and is kept once.
"""

import logging
import queue
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, Final

from trunnion.batch.divided_files import keep_share
from trunnion.batch.records import Record, settle
from trunnion.batch.result_keys import digest
from trunnion.batch.stores import Kept, Store, open_store
from trunnion.batch.worker_task import OtherVersionError, Outcome, Status, Task
from trunnion.batch.workers import Assignment, died
from trunnion.errors import InputError, Problem, warning
from trunnion.extras import import_extra
from trunnion.jobs.observer import SILENT, Observer
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.wording import format_duration

#: Where Dask's client logs.
_LOG: Final = logging.getLogger("distributed.client")

#: Tasks that wait at each thread of the workers, so that none is idle; and the fewest in all.
_AHEAD: Final = 2
_FEWEST: Final = 8

#: Results that are fetched together.
_TOGETHER: Final = 64

#: Seconds between looks at the connection, that one attempt takes, and for which a scheduler that is gone is awaited.
_LOOK: Final = 1.0
_ATTEMPT: Final = 5.0
PATIENCE: Final = 120.0

#: Seconds without any worker after which that is told, and told again.
SILENCE: Final = 5.0
_REMIND: Final = 60.0


@dataclass(frozen=True, slots=True)
class Tls:
    """Files of certificates (PEM): of the authority that signs, of this client, and its key; none: Dask's own
    configuration says.
    """

    ca: Path | None = None
    cert: Path | None = None
    key: Path | None = None


@dataclass(slots=True, eq=False)
class _Asked:
    """A task that was given to the scheduler."""

    assignment: Assignment
    task: Task
    future: Any


@dataclass(frozen=True, slots=True)
class Scheduler:
    """A scheduler of Dask.

    address   such as ``tcp://host:8786`` or ``tls://host:8786``
    patience  seconds for which it is awaited where it is gone
    wait      seconds for which it may be without any worker before the batch ends; None: any time
    """

    address: str
    tls: Tls = Tls()
    patience: float = PATIENCE
    wait: float | None = None


class DaskWorkers:
    """The workers of a scheduler. Use it as a context manager.

    function  what they do; they must be able to import it
    writing   address of the store to which workers write themselves; empty: they give results back
    observer  is told that the scheduler is gone, or has no workers
    """

    def __init__(
        self,
        scheduler: Scheduler,
        function: Callable[[Task], Outcome],
        *,
        writing: str = "",
        observer: Observer = SILENT,
    ) -> None:
        self._observer = observer
        self._function = function
        self._distributed = import_extra("distributed", "cluster")
        self._scheduler, self._address, self._writing = scheduler, scheduler.address, writing
        self._alone_since, self._silent_for = time.monotonic(), SILENCE
        self._client: Any = None
        self._blobs: dict[str, Any] = {}
        self._told: queue.SimpleQueue[str] = queue.SimpleQueue()

    def __enter__(self) -> "DaskWorkers":
        # Its client prints how a connection was lost, which is told here in words of our own.
        self._was_disabled, _LOG.disabled = _LOG.disabled, True
        try:
            self._connect(_ATTEMPT)
        except BaseException:
            _LOG.disabled = self._was_disabled
            raise
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self._leave()
        finally:
            _LOG.disabled = self._was_disabled

    def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        """Outcomes as they come, each with its assignment; a bounded number of tasks is with the scheduler.

        Raises ``InputError`` if the scheduler is gone for too long, or its workers cannot do the work.
        """
        coming, asked = iter(tasks), dict[str, _Asked]()
        looked = self._alone_since = time.monotonic()
        while True:
            while len(asked) < self._window():
                each = next(coming, None)
                if each is None:
                    break
                asked[each[0].record.place] = _Asked(*each, self._submit(*each))
            if not asked:
                return
            yield from self._take(asked, self._heard_of(asked))
            if time.monotonic() - looked >= _LOOK:
                looked = time.monotonic()
                self._look(asked)
                self._miss_workers()
                # A result that was lost with its worker and made again is told of once only.
                yield from self._take(asked, [place for place in asked if _is_done(asked[place])][:_TOGETHER])

    def _window(self) -> int:
        """How many tasks are with the scheduler at once."""
        return max(_FEWEST, _AHEAD * self._threads)

    def _connect(self, seconds: float) -> None:
        """Connect, within some seconds."""
        deadline = time.monotonic() + seconds
        while True:
            try:
                self._client = self._distributed.Client(
                    self._address, timeout=_ATTEMPT, set_as_default=False, security=self._security(),
                    name="trunnion-batch",
                )  # fmt: skip
                self._blobs.clear()
                self._count_threads()
                return
            # Dask asserts where a client that takes its time is not there in time.
            except (OSError, ValueError, TypeError, ImportError, AssertionError) as error:
                if time.monotonic() >= deadline or not isinstance(error, OSError):
                    raise InputError(
                        Problem(self._address, 0, Wording("BAT220", "no_scheduler_dask", error=str(error)[:200]))
                    ) from None
                time.sleep(_LOOK)

    def _security(self) -> Any:
        tls = self._scheduler.tls
        if tls == Tls():
            return None
        return self._distributed.Security(
            tls_ca_file=_name(tls.ca), tls_client_cert=_name(tls.cert), tls_client_key=_name(tls.key),
            require_encryption=True,
        )  # fmt: skip

    def _leave(self) -> None:
        """Close the connection; the scheduler forgets what nobody asks for any more."""
        if self._client is not None:
            with suppress(Exception):
                self._client.close(timeout=_ATTEMPT)
            self._client = None

    def _count_threads(self) -> None:
        with suppress(Exception):  # it is gone: that is told where it is looked for
            self._threads = sum(self._client.nthreads().values())

    _threads = 0

    def _submit(self, assignment: Assignment, task: Task) -> Any:
        """Give a task to the scheduler; content that many tasks share goes there once."""
        place = assignment.record.place
        names = sorted(task.shared)
        shared = [self._blob(_content(task.shared[name])) for name in names]
        shares = task.shares if self._writing else tuple(map(_bytes_of, task.shares))
        bare = replace(task, shared={}, shares=shares)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph", UserWarning)
            future = self._client.submit(
                _work, self._function, bare, names, shared, assignment.record, self._writing,
                key=f"trunnion-{assignment.record.key}-{digest(place.encode())[:16]}", pure=False, retries=0,
            )  # fmt: skip
        future.add_done_callback(lambda _: self._told.put(place))
        return future

    def _blob(self, content: bytes) -> Any:
        name = f"trunnion-file-{digest(content)}"
        if name not in self._blobs:
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", "Sending large graph", UserWarning)
                self._blobs[name] = self._client.submit(bytes, content, key=name)
        return self._blobs[name]

    def _heard_of(self, asked: "Mapping[str, _Asked]") -> list[str]:
        """Tasks that are done, waiting a moment for the first: they are fetched together."""
        places = dict[str, None]()
        with suppress(queue.Empty):
            places[self._told.get(timeout=_LOOK)] = None
            while len(places) < _TOGETHER:
                places[self._told.get_nowait()] = None
        return [place for place in places if place in asked and _is_done(asked[place])]

    def _take(self, asked: "dict[str, _Asked]", places: list[str]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        """Yield what came of tasks that are done; one whose result was lost is given again."""
        finished = [place for place in places if asked[place].future.status == "finished"]
        fetched = dict[str, Outcome | Record]()
        with suppress(Exception):  # what cannot be fetched with the others is asked for alone
            futures = {place: asked[place].future for place in finished}
            fetched = self._client.gather(futures) if futures else fetched
        for place in places:
            each = asked.pop(place)
            found: Outcome | Record | None = fetched.get(place)
            if found is None:
                found = self._fetch(each)
            if found is None:
                each.future = self._submit(each.assignment, each.task)
                asked[place] = each
            else:
                yield each.assignment, found

    def _fetch(self, each: "_Asked") -> Outcome | Record | None:
        """Return what came of a task; None: it was lost on the way."""
        try:
            found: Outcome | Record = each.future.result(timeout=_ATTEMPT)
        except Exception as error:
            return self._outcome_of(error, each)
        return found

    def _outcome_of(self, error: Exception, each: "_Asked") -> Outcome | None:
        """Return what an error of a task means; None: the connection failed, and it is to be given again."""
        name = type(error).__name__
        if name == "KilledWorker":
            return Outcome(Status.DIED, (died(each.task.file, Wording("BAT310", "several_workers_died")),))
        if isinstance(error, InputError):
            raise error
        if name in ("CancelledError", "FutureCancelledError", "TimeoutError", "CommClosedError") or isinstance(
            error, OSError
        ):
            return None
        is_other = isinstance(error, OtherVersionError | ImportError)
        if is_other:
            wording = Wording("BAT210", "worker_of_other_version", reason=str(error))
        else:
            wording = Wording("BAT210", "worker_fails", error=name, reason=str(error)[:300])
        raise InputError(Problem(self._address, 0, wording))

    def _look(self, asked: "Mapping[str, _Asked]") -> None:
        """Connect again if the scheduler is gone, and give it all tasks that it does not know any more."""
        is_running = self._client.status == "running"
        lost = [each for each in asked.values() if each.future.status in ("cancelled", "lost")]
        if is_running and not lost:
            self._count_threads()
            return
        if not is_running:
            self._observer.problems(
                [
                    warning(
                        self._address, 0, Wording("BAT230", "scheduler_gone_awaited", patience=self._scheduler.patience)
                    )
                ]
            )
        self._leave()
        self._connect(self._scheduler.patience)
        for each in asked.values():
            each.future = self._submit(each.assignment, each.task)

    def _miss_workers(self) -> None:
        """Tell that there are no workers, after a while and then now and then."""
        now = time.monotonic()
        if self._threads:
            self._alone_since, self._silent_for = now, SILENCE
            return
        alone = now - self._alone_since
        if self._scheduler.wait is not None and alone >= self._scheduler.wait:
            raise InputError(
                Problem(
                    self._address,
                    0,
                    Wording(
                        "BAT240", "scheduler_had_no", format_duration=format_duration(alone), address=self._address
                    ),
                )
            )
        if alone >= self._silent_for:
            self._silent_for = alone + _REMIND
            self._observer.problems(
                [
                    warning(
                        self._address,
                        0,
                        Wording(
                            "BAT240",
                            "scheduler_no_worker",
                            format_duration=format_duration(alone),
                            address=self._address,
                        ),
                    )
                ]
            )


def _is_done(each: _Asked) -> bool:
    return each.future.status in ("finished", "error")


def _name(path: Path | None) -> str | None:
    return None if path is None else str(path)


def _content(content: bytes | Path) -> bytes:
    return content if isinstance(content, bytes) else content.read_bytes()


def _bytes_of(share: bytes | Kept) -> bytes:
    return share if isinstance(share, bytes) else share.read()


def _work(
    function: Callable[[Task], Outcome], task: Task, names: list[str], shared: list[bytes], record: Record, writing: str
) -> Outcome | Record:
    """Do the work at a worker."""
    outcome = function(replace(task, shared=dict(zip(names, shared, strict=True))))
    if not writing:
        return outcome
    if task.share is not None:
        return keep_share(_store(writing), record.place, outcome, *task.seals)
    return settle(_store(writing), record, outcome)


@cache
def _store(address: str) -> Store:
    return open_store(address)
