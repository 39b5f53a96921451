"""Places of results: unique, safe on every system, and the same whatever other files there are.

A result lies as its file does: of ``a/x.cls`` and ``b/x.cls`` come ``a/x.mpf`` and ``b/x.mpf``. Where two would be
one, on a system that takes capitals for small letters too, or where a file would have the name of a folder, none of
them has a result: names that depend on neighbours would leave old programs beside new ones.
"""

import re
import unicodedata
from collections.abc import Callable, Sequence
from pathlib import PurePosixPath
from typing import Final

from trunnion.batch.jobs import NOTED, BatchJob, Unit
from trunnion.batch.result_keys import digest
from trunnion.batch.worker_task import Action
from trunnion.errors import InputError, Problem
from trunnion.files import name_fault
from trunnion.messages import Wording

#: What names on some system do not have.
_ODD: Final = re.compile(r"[^\w.,+=@ ()-]")

#: Letters of an extension.
_LONGEST_EXTENSION: Final = 16

#: What packed files end in.
_PACKED: Final = frozenset({".gz", ".bz2"})


def units_of(jobs: Sequence[BatchJob]) -> list[Unit]:
    """Return the files of all jobs with the places of their results, in the order of these.

    Files whose results would have one place get another one, by which they are known but at which nothing is written
    (``Unit.clash``); only of those that write nothing, it is all they need.

    Raises ``InputError`` if names are made so that two results cannot be told apart.
    """
    files = [(number, file) for number, job in enumerate(jobs) for file in job.files]
    places = [_place(jobs[number], file) for number, file in files]
    clashes = dict.fromkeys(range(len(files)), "")
    for k in _alike(places):
        number, file = files[k]
        clashes[k] = places[k] if _writes(jobs[number]) else ""
        places[k] = _with_checksum(jobs[number], file)
    if twice := _alike(places):
        file = files[twice[0]][1]
        raise InputError(Problem(file, 0, Wording("BAT120", "no_place_own")))
    return sorted(Unit(places[k], number, file, clashes[k]) for k, (number, file) in enumerate(files))


def _writes(job: BatchJob) -> bool:
    return bool(job.report) or job.action not in NOTED


def _alike(places: Sequence[str]) -> list[int]:
    """Return the places that some system takes for the same as another one, or as a folder of it."""
    by_name: dict[str, list[int]] = {}
    for k, place in enumerate(places):
        by_name.setdefault(_folded(place), []).append(k)
    found = {k for same in by_name.values() if len(same) > 1 for k in same}
    for k, place in enumerate(places):
        above = [same for folder in PurePosixPath(_folded(place)).parents if (same := by_name.get(folder.as_posix()))]
        if above:
            found.update((k, *(other for same in above for other in same)))
    return sorted(found)


def _folded(place: str) -> str:
    return unicodedata.normalize("NFC", place).casefold()


def _place(job: BatchJob, file: str) -> str:
    name = PurePosixPath(file).name
    return _named(job, file, lambda: _stem(name) if job.action in (Action.POST, Action.CONVERT) else name)


def _with_checksum(job: BatchJob, file: str) -> str:
    return _named(job, file, lambda: f"{PurePosixPath(file).name}-{digest(f'{job.name}/{file}'.encode())[:16]}")


def _stem(name: str) -> str:
    path = PurePosixPath(name)
    return PurePosixPath(path.stem).stem if path.suffix.lower() in _PACKED else path.stem


def _named(job: BatchJob, file: str, stem: Callable[[], str]) -> str:
    ending = NOTED.get(job.action, job.extension)
    folders = PurePosixPath(file).parent.parts
    parts = [*PurePosixPath(job.output).parts, *map(_safe, folders), _safe(stem() + ending)]
    return "/".join(parts)


def _safe(part: str) -> str:
    """Return a name that every system takes: the same where it is one, else with a checksum of it."""
    if not name_fault(PurePosixPath(part)):
        return part
    stem, point, extension = part.rpartition(".")
    keeps = bool(stem) and extension.isascii() and extension.isalnum() and len(extension) < _LONGEST_EXTENSION
    stem, ending = (stem, point + extension) if keeps else (part, "")
    checksum = digest(part.encode("utf-8", "surrogateescape"))[:16]
    return f"{_ODD.sub('_', stem).strip(' .')[:100]}-{checksum}{ending}"
