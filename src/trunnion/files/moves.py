"""The files of a job reach their places, all or none of them, and what is recorded of them goes with them."""

import errno
import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import field
from pathlib import Path
from typing import Final

from trunnion.files.dead_jobs import settle_and_log
from trunnion.files.digests import FileDigests
from trunnion.files.hidden_folders import HiddenFolders
from trunnion.files.interrupts import held_interrupts
from trunnion.files.journal import Journal, Names, Record, begin
from trunnion.files.locks import hold_places
from trunnion.files.places import OutputPlace, cannot_write
from trunnion.messages import phrase
from trunnion.records import dataclass

#: Names of files in a message.
_MOST_NAMED: Final = 5

#: How long other jobs may take that move files in the same folders, s.
_PATIENCE: Final = 20.0


@dataclass(slots=True)
class Moves:
    """Complete files and their places.

    files      each in a hidden folder beside its place, and that folder
    withdrawn  places of files that must not be seen beside the older ones of others: their older files go away first
    records    of the programs, once all is in place
    names      of the programs of projects
    digests    of files that were read before
    """

    files: list[tuple[Path, OutputPlace, Path]] = field(default_factory=list)
    withdrawn: list[OutputPlace] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)
    names: list[Names] = field(default_factory=list)
    digests: FileDigests = field(default_factory=FileDigests)

    def add(self, hidden: HiddenFolders, file: Path, place: OutputPlace) -> int:
        """Take a complete file, and return its number."""
        self.files.append((hidden.bring(file, place), place, hidden.beside(place)))
        return len(self.files) - 1

    def number(self, path: Path) -> int | None:
        """Return the number of the file with this place; None: there is none."""
        return next((k for k, (_, place, _) in enumerate(self.files) if place.path == path), None)

    def carry_out(self) -> None:
        """Move the files to their places, all or none.

        Raises
        ------
        InputError
            If a file cannot be written.
        """
        done = False
        try:
            with held_interrupts():
                if len(self.files) == 1 and not (self.records or self.names):
                    self._move_one()
                elif self.files:
                    self._move_all()
                done = True
        except KeyboardInterrupt as stop:
            if done:  # it has waited for the end of the block
                stop.add_note(_replaced([place.path for _, place, _ in self.files]))
            elif not hasattr(stop, "__notes__"):
                stop.add_note(str(phrase("as_before")))
            raise

    def _move_one(self) -> None:
        """Replace one file, which the system does whole or not at all."""
        file, place, _ = self.files[0]
        try:
            file.replace(place.path)
        except OSError as error:
            raise cannot_write(place.name, error) from None

    def _move_all(self) -> None:
        """Move, and record, by a journal."""
        at = self.files[0][1]
        journal = None
        try:
            moves = begin([(file, place.path, folder) for file, place, folder in self.files], self.digests)
            journal = Journal(os.urandom(16).hex(), moves, tuple(self.records), tuple(self.names))
            journal.write()
            for each in self.withdrawn:
                at = each
                each.path.unlink(missing_ok=True)
            for move, (_, place, _) in zip(moves, self.files, strict=True):
                at = place
                move.new_file.replace(move.target)
            journal.sync()
            journal.record()
            journal.end()
        except BaseException as error:
            finished = _is_finished(journal, at)
            if not isinstance(error, OSError):
                if finished:
                    error.add_note(_replaced([move.target for move in moves]))
                raise
            if not finished:
                raise cannot_write(at.name, error) from None


@contextmanager
def moving_alone(places: Iterable[OutputPlace]) -> Iterator[None]:
    """Move files while no other job does so in their folders, and none that was stopped is left there.

    Raises ``InputError`` if another job takes too long.
    """
    named = {place.path.parent: place.name for place in places if not place.is_stream}
    locks = hold_places(named, _PATIENCE)
    if locks is None:
        error = BlockingIOError(errno.EBUSY, os.strerror(errno.EBUSY))
        raise cannot_write(next(iter(named.values())), error)
    try:
        settle_and_log(named, named)
        yield
    finally:
        for lock in locks:
            lock.release()


def _is_finished(journal: Journal | None, place: OutputPlace) -> bool:
    """Whether a job that was stopped is in its places all the same; all is as before otherwise."""
    try:
        return journal is not None and journal.settle().finished
    except OSError as error:  # the next command tries it again
        raise cannot_write(place.name, error) from None


def _replaced(files: Sequence[Path]) -> str:
    """Return what is said of files that have reached their places, although the job was stopped."""
    names = [file.name for file in files]
    more = len(names) - _MOST_NAMED
    shown = [*names[:_MOST_NAMED], *([str(phrase("more_files", count=more))] if more > 0 else [])]
    return str(phrase("all_new", names=", ".join(shown)))
