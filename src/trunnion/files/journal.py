"""The journal of a job whose files move: it is on the disk before the first move, and goes when all is done.

In:     complete files in hidden folders, their places, and what is recorded about them afterwards (``EarlierJob``).
Out:    a job whose files and records are all new, or all as before: at once, or by the next command if this one dies.

The journal lies in the first hidden folder; in the others a note leads to it. Both have the same random word, without
which nothing beside a hidden folder is touched: a journal that came with somebody's archive moves nothing elsewhere.
A file that is neither the new one nor the one before was changed since by somebody, and stays as it is.
"""

import json
import os
import shutil
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path, PurePosixPath
from typing import Any, Final

from trunnion.files.digests import FileDigests, digest_of
from trunnion.files.earlier_job import EarlierJob
from trunnion.files.hidden_folders import JOURNAL, is_hidden_folder
from trunnion.files.on_disk import sync_folder, write_whole
from trunnion.records import dataclass

#: The folder, in a hidden one, in which files survive that are replaced.
_EARLIER: Final = ".earlier"

#: Bytes that a journal may have: one that is longer is none of ours.
_MOST_BYTES: Final = 64 << 20


@dataclass(frozen=True, slots=True)
class Move:
    """A file on its way.

    folder   the hidden folder beside its place
    new      the complete file in that folder, as a relative path
    name     of the file in its place
    earlier  in that folder, where the file that was there before survives
    digest   of the new file
    before   digest of the file before; None: there was none
    """

    folder: Path
    new: str
    name: str
    earlier: str
    digest: str
    before: str | None

    @property
    def target(self) -> Path:
        """Where the file goes."""
        return self.folder.parent / self.name

    @property
    def new_file(self) -> Path:
        """Where it comes from."""
        return self.folder / self.new

    @property
    def earlier_file(self) -> Path:
        """Where the file before survives."""
        return self.folder / self.earlier

    @property
    def is_done(self) -> bool:
        """Whether the new file is in its place."""
        return digest_of(self.target) == self.digest

    @property
    def was_done(self) -> bool:
        """Whether the new file is in its place, or was, and somebody has changed it since."""
        there = digest_of(self.target)
        return there == self.digest or (there != self.before and not os.path.lexists(self.new_file))

    def undo(self) -> bool:
        """Bring back what was there before; False where somebody has changed the file since, which then stays.

        Raises ``OSError`` if that is gone.
        """
        there = digest_of(self.target)
        if there is not None and there not in (self.digest, self.before):
            return False
        if there == self.before:
            return True
        if self.before is None:
            self.target.unlink(missing_ok=True)
        else:
            self.earlier_file.replace(self.target)
        return True


@dataclass(frozen=True, slots=True)
class Record:
    """What is recorded of a program once it is in its place; files are numbers of moves.

    first       its first file
    program     all its files; none: only the owner is recorded
    papers      the files about it
    owner       for whom it was written (``EarlierJob.set_owner``); empty: that stays
    """

    first: int
    program: tuple[int, ...] = ()
    papers: tuple[int, ...] = ()
    owner: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Names:
    """The programs of a project, which are recorded under its own file."""

    project: str
    programs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a job.

    finished  its files are in their places; otherwise those before are back
    files     the places, but for those of the next
    changed   files that somebody has changed since, which stay as they are
    """

    finished: bool
    files: tuple[Path, ...]
    changed: tuple[Path, ...] = ()


@dataclass(frozen=True, slots=True)
class Journal:
    """The moves of a job, and what is recorded after them."""

    word: str
    moves: tuple[Move, ...]
    records: tuple[Record, ...] = ()
    names: tuple[Names, ...] = ()

    @property
    def folders(self) -> list[Path]:
        """The hidden folders, the first of which holds the journal."""
        return list(dict.fromkeys(move.folder for move in self.moves))

    def write(self) -> None:
        """Bring the journal to the disk, as its last step under its own name; all that it names is there before."""
        for folder in {path.parent for move in self.moves for path in (move.new_file, move.earlier_file)}:
            sync_folder(folder)
        first, *others = self.folders
        for folder in others:
            note = {"word": self.word, "journal": _relative(first, folder.parent)}
            _write(folder / JOURNAL, json.dumps(note))
        of_moves = [{**asdict(move), "folder": _relative(move.folder, first.parent)} for move in self.moves]
        text = {
            "word": self.word,
            "moves": of_moves,
            "records": [asdict(record) for record in self.records],
            "names": [asdict(names) for names in self.names],
        }
        _write(first / JOURNAL, json.dumps(text))

    def settle(self) -> Outcome:
        """Finish what is all in its place, and bring everything back otherwise; can be done again.

        Raises
        ------
        OSError
            If a file cannot be brought back. The journal stays.
        """
        files = tuple(move.target for move in self.moves)
        finished = all(move.was_done for move in self.moves)
        changed = tuple(move.target for move in self.moves if not (move.is_done if finished else move.undo()))
        self.sync()
        if finished:
            self.record()
        self.end()
        return Outcome(finished, tuple(file for file in files if file not in changed), changed)

    def sync(self) -> None:
        """Bring the names of the files in their places to the disk: nothing is recorded that may be lost again."""
        for folder in {move.folder.parent for move in self.moves}:
            sync_folder(folder)

    def record(self) -> None:
        """Record what has been written."""
        known = {move.target: move.digest for move in self.moves}
        for record in self.records:
            earlier = EarlierJob(self.moves[record.first].target)
            if record.program:
                program = [self.moves[k].target for k in record.program]
                earlier.remember(program, [self.moves[k].target for k in record.papers], known)
            if record.owner:
                earlier.set_owner(record.owner)
        for names in self.names:
            EarlierJob(Path(names.project)).remember_names(map(Path, names.programs))

    def end(self) -> None:
        """Remove the journal, the first part of it first: without that, notes mean nothing."""
        first, *others = self.folders
        (first / JOURNAL).unlink(missing_ok=True)
        if others:
            sync_folder(first)
        for folder in others:
            (folder / JOURNAL).unlink(missing_ok=True)


def begin(files: Sequence[tuple[Path, Path, Path]], digests: FileDigests) -> tuple[Move, ...]:
    """Return the moves of files, once those that they replace have second names under which they survive.

    files    each the complete file, its place, and the hidden folder beside that
    digests  of files that were read before

    Raises ``OSError`` if a file that is replaced can be kept under no other name.
    """
    moves = []
    for k, (file, place, folder) in enumerate(files):
        earlier = folder / _EARLIER / str(k)
        earlier.parent.mkdir(exist_ok=True)
        before = digests.of(place)
        _keep(place, earlier)
        new = file.relative_to(folder).as_posix()
        moves.append(Move(folder, new, place.name, f"{_EARLIER}/{k}", digests.of(file) or "", before))
    return tuple(moves)


def read_journal(folder: Path) -> Journal | None:
    """Return the journal of a hidden folder, or of the job to which a note in it leads; None: there is none any more.

    Raises
    ------
    ValueError
        If there is one that is not as this module writes it.
    """
    found = _read(folder / JOURNAL)
    if found is not None and "journal" in found:
        first = Path(os.path.normpath(folder.parent / str(found["journal"])))
        if not is_hidden_folder(first):
            return None
        word, found = found.get("word"), _read(first / JOURNAL)
        if found is not None and found.get("word") != word:
            raise ValueError("a note leads to the journal of another job")
        folder = first
    if found is None:
        return None
    try:
        return _journal(found, folder)
    except (KeyError, TypeError, AttributeError, IndexError) as error:
        raise ValueError(f"{JOURNAL} is not as it was written: {error}") from None


def _journal(found: dict[str, Any], first: Path) -> Journal:
    """Return what a journal says, once it is known to stay beside its own hidden folders."""
    word = found["word"]
    moves = []
    for each in found["moves"]:
        folder = Path(os.path.normpath(first.parent / each["folder"]))
        if folder != first and (not is_hidden_folder(folder) or (_read(folder / JOURNAL) or {}).get("word") != word):
            raise ValueError(f"{folder} is of another job")
        parts = [each["new"], each["earlier"], each["name"]]
        if any(PurePosixPath(part).is_absolute() or ".." in Path(part).parts for part in parts):
            raise ValueError("a path leads out of its folder")
        if any(_leaves(folder, folder / part) for part in parts[:2]):
            raise ValueError("a link leads out of its folder")
        if Path(each["name"]).name != each["name"]:
            raise ValueError("a place is in another folder")
        moves.append(Move(**{**each, "folder": folder}))
    records = [
        Record(each["first"], tuple(each["program"]), tuple(each["papers"]), tuple(each["owner"]))
        for each in found["records"]
    ]
    if any(not 0 <= k < len(moves) for each in records for k in (each.first, *each.program, *each.papers)):
        raise ValueError("a record is of no file")
    names = [Names(str(each["project"]), tuple(map(str, each["programs"]))) for each in found["names"]]
    if any(Path(each.project).suffix.lower() != ".toml" for each in names):
        raise ValueError("a record is of no project")
    if not moves:
        raise ValueError("nothing moves")
    return Journal(word, tuple(moves), tuple(records), tuple(names))


def _leaves(folder: Path, file: Path) -> bool:
    """Whether a path within a folder is that of another file, or leads to one by a link."""
    there = Path(os.path.realpath(folder))
    return file == folder or file.is_symlink() or not Path(os.path.realpath(file.parent)).is_relative_to(there)


def _keep(target: Path, before: Path) -> None:
    """Give a file, if it exists, a second name under which it survives being replaced."""
    if not target.exists():
        return
    if target.is_dir():
        raise IsADirectoryError(21, f"{target.name} is a folder")
    try:
        os.link(target, before)
    except OSError:  # some file systems have no hard links
        shutil.copy2(target, before)
        with before.open("r+b") as copy:
            os.fsync(copy.fileno())


def _read(file: Path) -> dict[str, Any] | None:
    """Return what a journal or a note holds; None: there is none."""
    try:
        if file.is_symlink() or file.stat().st_size > _MOST_BYTES:
            raise ValueError(f"{file} is none that was written here")
        found = json.loads(file.read_bytes())
    except FileNotFoundError:
        return None
    except (OSError, RecursionError) as error:
        raise ValueError(str(error)) from None
    if not isinstance(found, dict) or not isinstance(found.get("word"), str):
        raise ValueError(f"{file} is none that was written here")
    return found


def _write(file: Path, text: str) -> None:
    """Write a file to the disk, with the names of its folder and of the files in it."""
    write_whole(file, text, file.with_name(f"{file.name}.part"))
    sync_folder(file.parent)
    sync_folder(file.parent.parent)


def _relative(path: Path, start: Path) -> str:
    """Return a path from a folder on, so that both may be known under other names elsewhere."""
    try:
        return Path(os.path.relpath(path, start)).as_posix()
    except ValueError:  # another drive
        return str(path)
