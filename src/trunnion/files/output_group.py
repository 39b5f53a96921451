"""Jobs whose files appear together, or none of them."""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.files.command_output import move_together
from trunnion.files.dead_jobs import settle_and_log
from trunnion.files.earlier_job import EarlierJob
from trunnion.files.hidden_folders import HiddenFolders
from trunnion.files.journal import Names, Record
from trunnion.files.moves import Moves
from trunnion.files.output import OutputFiles
from trunnion.files.places import Claims, OutputPlace
from trunnion.messages import Wording


class OutputGroup:
    """Several jobs, each with its files: all of them reach their places together."""

    def __init__(self, *, remembers: bool = True) -> None:
        self._remembers = remembers
        self._claims = Claims()
        self._folders: list[HiddenFolders] = []
        self._complete: list[tuple[OutputFiles, HiddenFolders]] = []
        self._owners: dict[Path, tuple[str, ...]] = {}
        self._names: list[Names] = []

    @contextmanager
    def open(
        self,
        place: OutputPlace,
        *,
        papers: Iterable[OutputPlace] = (),
        inputs: Iterable[str | os.PathLike[str]] = (),
        edited: str = "",
    ) -> Iterator[OutputFiles]:
        """Yield the files of a job, as ``atomic_output`` has them; none appears before the group is published.

        Raises ``InputError`` as ``atomic_output``, also where another job of the group writes or reads the same file;
        or if a place is a device, which takes what it gets at once.
        """
        places = [place, *papers]
        for each in places:
            if each.is_stream:
                raise InputError(Problem(each.name, 0, Wording("FIL210", "device_several_files")))
        self._claims.read(inputs)
        for each in places:
            self._claims.write(each)
        settle_and_log(each.path.parent for each in places)
        hidden = HiddenFolders()
        self._folders.append(hidden)
        earlier = EarlierJob(place.path) if self._remembers else None
        files = OutputFiles(hidden.beside(place), Path(place.name).name, place, self._claims, earlier, edited)
        with files.filled():
            yield files
        self._complete.append((files, hidden))

    def publish(self) -> None:
        """Bring the files of all jobs to their places."""
        places = [place for files, _ in self._complete for place in files.places]
        move_together(self._bring, places, self._folders)

    def _bring(self, moves: Moves) -> None:
        moves.names += self._names
        for files, hidden in self._complete:
            files.bring(hidden, moves)
        for path, owner in self._owners.items():
            number = moves.number(path)
            assert number is not None, "the program of a job of the group"
            moves.records.append(Record(number, owner=owner))

    def record_owner(self, program: Path, owner: Iterable[str]) -> None:
        """Record for whom a program of the group is written (``EarlierJob.set_owner``), once it is in its place."""
        self._owners[program] = tuple(owner)

    def record_names(self, project: Path, programs: Iterable[Path]) -> None:
        """Record the programs of a project under its own file, once they are in their places."""
        self._names.append(Names(str(project), tuple(map(str, programs))))

    def remove(self) -> None:
        """Remove what has not reached its place; can be called again if it was interrupted."""
        for hidden in self._folders:
            hidden.remove()


@contextmanager
def output_group(*, remembers: bool = True) -> Iterator[OutputGroup]:
    """Jobs whose files reach their places together when the block ends, or not at all if it raises.

    remembers  files that nobody has named replace only what earlier jobs have written, and these are remembered

    Raises ``InputError`` if a file cannot be written. Earlier files of the same names stay as they were.
    """
    group = OutputGroup(remembers=remembers)
    # An interruption of the first removal leaves the second one to do it.
    try:
        try:
            yield group
            group.publish()
        finally:
            group.remove()
    finally:
        group.remove()
