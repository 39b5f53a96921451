"""Results that no file owns any more: their file is gone, or its result now has another name.

They are removed before any work where they are as the batch has written them, for an old program beside the new one
is one that somebody may run. What somebody has changed stays, and is told each time, as are results of other batches.
"""

from collections.abc import Iterator, Sequence

from trunnion.batch.divided_files import SHARES, share_start
from trunnion.batch.jobs import Batch, Unit
from trunnion.batch.records import FOLDER, Record, known_of, parse_record, record_name
from trunnion.batch.share_seals import file_of
from trunnion.batch.stores import Store, TakenError
from trunnion.errors import Problem, warning
from trunnion.jobs.observer import Observer
from trunnion.jobs.project.paths import is_file
from trunnion.messages import Wording

#: Files that are told one by one.
_MOST_TOLD = 100

#: Other batches that are told.
_MOST_HOMES = 5


def remove_obsolete(batch: Batch, units: Sequence[Unit], store: Store, observer: Observer) -> None:
    """Remove what earlier runs of this batch have written of files that no unit owns now."""
    owned = {record_name(unit.place) for unit in units}
    names = [name for name in store.names(FOLDER) if name.endswith(".json") and name not in owned]
    if not names:
        return
    now = {(str(batch.jobs[unit.job].action), unit.file) for unit in units}
    told: list[Problem] = []
    others = 0
    for name, content in zip(names, store.read_many(names), strict=True):
        record = parse_record(content)
        if record is None:
            continue
        if record.home != batch.home:
            others += bool(record.outputs)
        elif batch.is_whole or (record.action, record.file) in now or not is_file(batch.folder / record.file):
            found = list(_removed(record, store))
            told += found
            if not any(problem.code == "BAT370" for problem in found):
                store.remove(name)
    told.sort(key=lambda problem: problem.file)
    if len(told) > _MOST_TOLD:
        more = warning(store.label, 0, Wording("BAT360", "more", count=len(told) - _MOST_TOLD))
        told[_MOST_TOLD:] = [more]
    if others:
        told.append(warning(store.label, 0, Wording("BAT370", "results_file_another", others=others)))
    if told:
        observer.problems(told)


def remove_obsolete_shares(batch: Batch, units: Sequence[Unit], store: Store, observer: Observer) -> None:
    """Remove the shares of files of this batch that no unit owns now; those of other batches are told."""
    owned = tuple({share_start(batch.home, unit.place) for unit in units})
    others = set[str]()
    for name in store.names(SHARES):
        home, _, rest = name.removeprefix(f"{SHARES}/").partition("-")
        if home != batch.home:
            others.add(f"{home}-{rest.partition('-')[0]}")
        elif not name.startswith(owned) and (batch.is_whole or _is_gone(batch, name, store)):
            store.remove(name)
    if others:
        observer.problems(
            [
                warning(
                    store.label,
                    0,
                    Wording(
                        "BAT370",
                        "shares_simulation_another",
                        count=len(others),
                        others=tuple(sorted({f"{SHARES}/{each.partition('-')[0]}-*" for each in others})[:_MOST_HOMES]),
                    ),
                )
            ]
        )


def _is_gone(batch: Batch, name: str, store: Store) -> bool:
    """Whether the file is gone that a share is of; so is that of one that does not say it."""
    try:
        file = file_of(store.read(name))
    except TakenError:
        return False
    return file is None or not is_file(batch.folder / file)


def _removed(record: Record, store: Store) -> Iterator[Problem]:
    """Remove the files of a record; what was done with each."""
    for name, checksums in sorted(known_of(record).items()):
        try:
            there = store.digest(name)
        except TakenError:
            continue
        if there is None:
            continue
        if there in checksums:
            store.remove(name)
            store.remove_empty(name)
            yield warning(name, 0, Wording("BAT360", "removed_no_such", record_file=record.file))
        else:
            yield warning(name, 0, Wording("BAT370", "stays_although_no", record_file=record.file))
