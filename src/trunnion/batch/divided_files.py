"""Files whose work is divided: shares that are kept until all of them are there, and a task that joins them.

A share is a task of its own, with a key of all that it is made from in the name under which it is kept, and in its
seal: one that is there, with its seal unbroken, is done. So a worker that dies, or a batch that is stopped, loses the
shares in work, and no others. Once the joined result is written, its shares are removed.
"""

from collections import deque
from collections.abc import Collection, Iterator, Mapping
from dataclasses import field, replace
from typing import Final

from trunnion.batch.records import FOLDER, Record
from trunnion.batch.result_keys import digest, key_of
from trunnion.batch.share_seals import BrokenSealError, Seal, sealed, unsealed
from trunnion.batch.stores import Kept, Store, TakenError
from trunnion.batch.worker_task import NO_COSTS, SHARE_FILE, Costs, Outcome, Status, Task
from trunnion.batch.workers import DAMAGED, Assignment
from trunnion.errors import InputError, Problem, warning
from trunnion.jobs.observer import Observer
from trunnion.messages import Wording
from trunnion.records import dataclass

#: The folder of shares within that of records.
SHARES: Final = f"{FOLDER}/shares"


@dataclass(slots=True, eq=False)
class _Division:
    """A file that is divided.

    seals    of its shares, by their names in the store
    missing  those that are not there yet
    failed   whether one of them came to nothing: then so does the file
    costs    of the shares that this run has made
    """

    assignment: Assignment
    task: Task
    seals: Mapping[str, Seal]
    missing: set[str]
    failed: bool = False
    costs: Costs = field(default=NO_COSTS)


class Divisions:
    """The files of a batch that are divided, from their first share to their result."""

    def __init__(self, store: Store, observer: Observer) -> None:
        self._store, self._observer = store, observer
        self._kept = set(store.names(SHARES))
        self._asked: dict[str, _Division] = {}
        self._complete: deque[_Division] = deque()
        self._joining: dict[str, _Division] = {}

    @property
    def is_waiting(self) -> bool:
        """Whether there are shares of which nothing was heard, or complete ones that nobody has joined."""
        return bool(self._asked or self._complete)

    def divide(
        self, assignment: Assignment, task: Task, count: int, digests: Mapping[str, str]
    ) -> tuple[int, Iterator[tuple[Assignment, Task]]]:
        """How many shares of a file are there, and the tasks of the others; ``digests`` are of all that it reads.

        Raises ``InputError`` if something that is no file stands in the place of a share.
        """
        record = assignment.record
        keys = [key_of(task.program, _said(task, number, count), digests) for number in range(count)]
        start = share_start(record.home, record.place)
        seals = {f"{start}{key[:32]}.share": Seal(key, k, count, record.file) for k, key in enumerate(keys)}
        self._remove(record, seals)
        missing = {name for name, seal in seals.items() if not self._is_there(name, seal)}
        division = _Division(assignment, task, seals, missing)
        if not division.missing:
            self._complete.append(division)
        return count - len(missing), self._shares(division)

    def _is_there(self, name: str, seal: Seal) -> bool:
        """Whether a share is done; one that is damaged is told."""
        try:
            content = self._store.read(name)
            if content is not None:
                unsealed(content, seal)
        except TakenError:
            raise InputError(Problem(seal.file, 0, Wording("BAT320", "one_shares_would", name=name))) from None
        except BrokenSealError as error:
            wording = Wording("BAT395", "share_is_made_again", reason=str(error))
            self._observer.problems([warning(seal.file, 0, wording)])
            return False
        return content is not None

    def _shares(self, division: _Division) -> Iterator[tuple[Assignment, Task]]:
        """Yield the shares that are missing; none any more once one of them has come to nothing."""
        number, record, task = division.assignment.number, division.assignment.record, division.task
        for name, seal in division.seals.items():
            if name in division.missing and not division.failed:
                self._asked[name] = division
                share = replace(task, share=(seal.number, seal.of), report="", seals=(seal,))
                yield Assignment(number, replace(record, place=name, key=seal.key), is_share=True), share

    def take(self, assignment: Assignment, outcome: Outcome) -> tuple[Assignment, Outcome] | None:
        """Keep a share; if there will be none, the file and what becomes of it, once."""
        name = assignment.record.place
        division = self._asked.pop(name)
        division.costs = division.costs + outcome.costs
        if outcome.status is Status.PASSED:
            keep_share(self._store, name, outcome, division.seals[name])
            self._kept.add(name)
            division.missing.discard(name)
            if not division.missing and not division.failed:
                self._complete.append(division)
            return None
        is_first, division.failed = not division.failed, True
        return (division.assignment, replace(outcome, costs=division.costs)) if is_first else None

    def complete(self) -> Iterator[tuple[Assignment, Task]]:
        """Yield what joins the shares of files that have all of them."""
        while self._complete:
            division = self._complete.popleft()
            self._joining[division.assignment.record.place] = division
            shares = tuple(self._content(name) for name in division.seals)
            seals = tuple(division.seals.values())
            yield division.assignment, replace(division.task, shares=shares, seals=seals, spent=division.costs)

    def _content(self, name: str) -> bytes | Kept:
        kept = Kept(self._store.address, name)
        return kept if kept.address else self._store.read(name) or b""

    def end(self, record: Record) -> None:
        """Remove the shares of a file that has its result; or those that are damaged, if they were."""
        division = self._joining.pop(record.place, None)
        if record.status.is_final:
            self._remove(record)
        elif division is not None and any(problem.code == DAMAGED for problem in record.problems):
            sound = {name for name, seal in division.seals.items() if self._is_sound(name, seal)}
            # Where each has its seal, and they do not go together all the same, nobody knows which one is wrong.
            self._remove(record, sound if len(sound) < len(division.seals) else ())

    def _is_sound(self, name: str, seal: Seal) -> bool:
        """Whether a share can stay; what is no file does, which the next run tells."""
        try:
            unsealed(self._store.read(name), seal)
        except BrokenSealError:
            return False
        except TakenError:
            self._kept.discard(name)
            return False
        return True

    def _remove(self, record: Record, but: Collection[str] = ()) -> None:
        start = share_start(record.home, record.place)
        for name in sorted(self._kept):
            if name.startswith(start) and name not in but:
                self._store.remove(name)
                self._kept.discard(name)


def keep_share(store: Store, name: str, outcome: Outcome, seal: Seal) -> Outcome:
    """Write a share to its place, unless a worker has done so; the outcome without it."""
    if SHARE_FILE in outcome.files:
        store.write(name, sealed(outcome.files[SHARE_FILE], seal))
    return replace(outcome, files={})


def share_start(home: str, place: str) -> str:
    """Return what the names of all shares of a file begin with."""
    return f"{SHARES}/{home}-{digest(place.encode())[:16]}-"


def _said(task: Task, number: int, count: int) -> dict[str, object]:
    """Return what a share is made from besides files; neither the form of a report nor the place of a result."""
    return {"share": [number, count], "said": [task.action, task.arguments, task.file]}
