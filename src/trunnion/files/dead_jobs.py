"""What jobs have left that were stopped before they could tidy up: a power failure, ``kill -9``, a closed computer.

In:     folders.
Out:    each file in them that was on its way is the new one, with all others of its job, or as before; hidden folders
        of jobs that nobody holds any more are gone; and what was done.
"""

import logging
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Final

from trunnion.errors import Problem, warning
from trunnion.files.hidden_folders import hidden_folders_in, remove_folder
from trunnion.files.hidden_names import TEMPORARY
from trunnion.files.journal import Outcome, read_journal
from trunnion.files.locks import LOCK, FolderLock, PlaceLock, hold, hold_places
from trunnion.messages import Wording
from trunnion.user_cache import temporary_folder

_MOST_NAMED: Final = 5

_log: Final = logging.getLogger(__name__)


def settle_dead_jobs(folders: Iterable[Path], own: Collection[Path] = ()) -> list[Problem]:
    """Finish or roll back what is found in folders, and say which.

    folders  need not exist
    own      folders in which the caller alone moves files (``hold_places``)
    """
    found: list[Problem] = []
    for folder in dict.fromkeys(folders):
        for hidden in hidden_folders_in(folder):
            found += _settle(hidden, own)
    return found


def settle_and_log(folders: Iterable[Path], own: Collection[Path] = ()) -> None:
    """Settle as above where nobody prints problems: they go to the log."""
    for problem in settle_dead_jobs(folders, own):
        _log.warning("%s", problem)


def remove_temporary_folders() -> None:
    """Remove the folders of dead jobs that wrote into streams."""
    folder = temporary_folder()
    for hidden in hidden_folders_in(folder) if folder is not None else ():
        if hidden.name.startswith(TEMPORARY) and (lock := hold(hidden)) is not None:
            lock.release()
            remove_folder(hidden)


def _settle(hidden: Path, own: Collection[Path]) -> list[Problem]:
    """Settle the job of a hidden folder, if it is dead."""
    lock = hold(hidden)
    if lock is None:
        return []
    locks: list[FolderLock | PlaceLock] = [lock]
    try:
        return _settle_held(hidden, locks, own)
    except (OSError, ValueError) as error:
        what = Wording("FIL290", "not_settled", name=hidden.name, error=error)
        return [warning(str(hidden.parent), 0, what)]
    finally:
        for each in locks:
            each.release()


def _settle_held(hidden: Path, locks: list[FolderLock | PlaceLock], own: Collection[Path]) -> list[Problem]:
    """Settle a job of which this process holds a folder, and add the locks of its other folders."""
    journal = read_journal(hidden)
    folders = [hidden, *(folder for folder in journal.folders if folder != hidden)] if journal else [hidden]
    for folder in folders[1:]:
        lock = hold(folder)
        if lock is not None:
            locks.append(lock)
        elif (folder / LOCK).exists():
            return []  # another command is at it
    outcome = None
    if journal is not None:
        moving = hold_places({folder.parent for folder in journal.folders}.difference(own), seconds=0.0)
        if moving is None:
            return []  # a job moves its files there, which settles this one first
        locks += moving
        outcome = journal.settle()
    for each in locks:
        each.release()
    for folder in folders:
        remove_folder(folder)
    return _told(hidden.parent, outcome)


def _told(folder: Path, outcome: Outcome | None) -> list[Problem]:
    """Return what is said of a job."""
    if outcome is None:
        return [warning(str(folder), 0, Wording("FIL290", "removed"))]
    told = []
    if outcome.files:
        told.append(Wording("FIL290", "finished" if outcome.finished else "rolled_back", names=_names(outcome.files)))
    if outcome.changed:
        told.append(Wording("FIL290", "changed_since", names=_names(outcome.changed)))
    return [warning(str(folder), 0, each) for each in told]


def _names(files: Iterable[Path]) -> str:
    """Return the names of the first files, and how many more there are."""
    names = [file.name for file in files]
    more = [f"{len(names) - _MOST_NAMED} more"] if len(names) > _MOST_NAMED else []
    return ", ".join([*names[:_MOST_NAMED], *more])
