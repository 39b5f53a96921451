"""Files whose work is divided: shares that are kept until all of them are there, and a task that joins them.

A share is a task of its own, with a key of all that it is made from in the name under which it is kept; a file that is
there is one that is done, as files appear whole. So a worker that dies, or a batch that is stopped, loses the shares in
work, and no others. Once the joined result is written, its shares are removed.
"""

from collections import deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from trunnion.batch.keys import digest, key_of
from trunnion.batch.records import FOLDER, Record
from trunnion.batch.stores import Kept, Store
from trunnion.batch.task import NO_COSTS, SHARE_FILE, Costs, Outcome, Status, Task
from trunnion.batch.workers import DAMAGED, Assignment

#: The folder of shares within that of records.
SHARES: Final = f"{FOLDER}/shares"


@dataclass(slots=True, eq=False)
class _Division:
    """A file that is divided.

    names    of its shares in the store
    missing  those that are not there yet
    failed   whether one of them came to nothing: then so does the file
    costs    of the shares that this run has made
    """

    assignment: Assignment
    task: Task
    names: Sequence[str]
    missing: set[str]
    failed: bool = False
    costs: Costs = field(default=NO_COSTS)


class Divisions:
    """The files of a batch that are divided, from their first share to their result."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._kept = set(store.names(SHARES))
        self._asked: dict[str, _Division] = {}
        self._complete: deque[_Division] = deque()

    @property
    def is_waiting(self) -> bool:
        """Whether there are shares of which nothing was heard, or complete ones that nobody has joined."""
        return bool(self._asked or self._complete)

    def divide(
        self, assignment: Assignment, task: Task, count: int, digests: Mapping[str, str]
    ) -> tuple[int, Iterator[tuple[Assignment, Task]]]:
        """How many shares of a file are there, and the tasks of the others; ``digests`` are of all that it reads."""
        record = assignment.record
        keys = [key_of(task.program, _said(task, number, count), digests) for number in range(count)]
        names = [f"{_start(record)}{key[:32]}.zip" for key in keys]
        self._remove(record, names)
        division = _Division(assignment, task, names, set(names) - self._kept)
        if not division.missing:
            self._complete.append(division)
        return count - len(division.missing), self._shares(division, keys)

    def _shares(self, division: _Division, keys: Sequence[str]) -> Iterator[tuple[Assignment, Task]]:
        """Yield the shares that are missing; none any more once one of them has come to nothing."""
        number, record, task = division.assignment.number, division.assignment.record, division.task
        for k, (name, key) in enumerate(zip(division.names, keys, strict=True)):
            if name in division.missing and not division.failed:
                self._asked[name] = division
                share = replace(task, share=(k, len(keys)), report="")
                yield Assignment(number, replace(record, place=name, key=key), is_share=True), share

    def take(self, assignment: Assignment, outcome: Outcome) -> tuple[Assignment, Outcome] | None:
        """Keep a share; if there will be none, the file and what becomes of it, once."""
        name = assignment.record.place
        division = self._asked.pop(name)
        division.costs = division.costs + outcome.costs
        if outcome.status is Status.PASSED:
            keep_share(self._store, name, outcome)
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
            shares = tuple(self._content(name) for name in division.names)
            yield division.assignment, replace(division.task, shares=shares, spent=division.costs)

    def _content(self, name: str) -> bytes | Kept:
        kept = Kept(self._store.address, name)
        return kept if kept.address else self._store.read(name) or b""

    def end(self, record: Record) -> None:
        """Remove the shares of a file that has its result, or whose shares are damaged."""
        if record.status.is_final or any(problem.code == DAMAGED for problem in record.problems):
            self._remove(record)

    def remove_others(self, records: Collection[Record], home: str) -> None:
        """Remove the shares of all files of a batch but some."""
        own = {_start(record) for record in records}
        for name in sorted(self._kept):
            if name.startswith(f"{SHARES}/{home}-") and not name.startswith(tuple(own)):
                self._store.remove(name)
                self._kept.discard(name)

    def _remove(self, record: Record, but: Collection[str] = ()) -> None:
        for name in sorted(self._kept):
            if name.startswith(_start(record)) and name not in but:
                self._store.remove(name)
                self._kept.discard(name)


def keep_share(store: Store, name: str, outcome: Outcome) -> Outcome:
    """Write a share to its place, unless a worker has done so; the outcome without it."""
    if SHARE_FILE in outcome.files:
        store.write(name, outcome.files[SHARE_FILE])
    return replace(outcome, files={})


def _start(record: Record) -> str:
    """What the names of all shares of a file begin with."""
    return f"{SHARES}/{record.home}-{digest(record.place.encode())[:16]}-"


def _said(task: Task, number: int, count: int) -> dict[str, object]:
    """What a share is made from besides files; neither the form of a report nor the place of a result."""
    return {"share": [number, count], "said": [task.action, task.arguments, task.file]}
