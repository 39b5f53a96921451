"""What the last job at a place has written: all other files there belong to somebody, and nobody has named them.

In:     the place of a job's first file.
Out:    whether a file there is still what that job wrote, and which of its files are of another program.

The record is in the user's cache, a small file for each place: of each file its size, its digest, and a digest of the
program that was written with it; and who wrote last, if that was a project. A paper has a record of its own, too: its
program may get another name. Where a record is missing every file is somebody else's.
"""

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final

from trunnion.files.digests import FileDigests
from trunnion.files.on_disk import sync_folder, write_whole
from trunnion.user_cache import user_cache

#: Places that are remembered; of more the oldest are forgotten, down to the second number.
_MOST_PLACES: Final = 4000
_PLACES_KEPT: Final = 3500

#: What stands in place of the digest of a program in the record that a paper has of its own.
_PAPER: Final = "paper"

#: The name, which no file has, under which a record holds its owner.
_OWNER: Final = ""


class EarlierJob:
    """The files that jobs whose first file has this path have written, by their digests.

    first    that path
    digests  of the files that were looked at
    """

    def __init__(self, first: Path, digests: FileDigests | None = None) -> None:
        self.first = first
        self.digests = digests or FileDigests()
        self._folder = first.parent
        cache = user_cache()
        name = hashlib.sha256(os.fsencode(os.path.normcase(first))).hexdigest()[:32]
        self._record = None if cache is None else cache / "trunnion" / "written" / f"{name}.json"
        self._digests = self._read()

    def wrote(self, file: Path) -> bool:
        """Whether a file that exists is as one of these jobs has written it."""
        if file.parent != self._folder:
            return EarlierJob(file).wrote(file)
        known = self._digests.get(os.path.normcase(file.name))
        return known is not None and self._is_as_known(file, known)

    def has_edited(self, file: Path) -> bool:
        """Whether a file is one that these jobs have written, and that somebody has changed since; no empty one is."""
        if file.parent != self._folder:
            return EarlierJob(file).has_edited(file)
        known = self._digests.get(os.path.normcase(file.name))
        return bool(known) and file.is_file() and file.stat().st_size > 0 and not self.wrote(file)

    def is_foreign(self, file: Path) -> bool:
        """Whether a file holds what these jobs have not written: it was edited since, or is somebody else's.

        Where nothing can be remembered nobody knows it, and every file would be.
        """
        return file.is_file() and file.stat().st_size > 0 and not self.wrote(file) and self._remembers

    @property
    def _remembers(self) -> bool:
        """Whether there is a place for the record."""
        if self._record is None:
            return False
        there = next(folder for folder in self._record.parents if folder.exists())
        return os.access(there, os.W_OK)

    def wrote_paper(self, file: Path) -> bool:
        """Whether a file that exists is as any job has written it as a paper, or one of these jobs at all."""
        if self.wrote(file):
            return True
        own = EarlierJob(file)
        known = own._digests.get(own._key(file), "")
        return known.split(":")[2:] == [_PAPER] and self._is_as_known(file, known)

    @property
    def owner(self) -> tuple[str, ...]:
        """What the last job has stated by ``set_owner``; empty where it has not."""
        try:
            found = json.loads(self._digests.get(_OWNER, "[]"))
        except (ValueError, RecursionError):
            return ()
        return tuple(str(each) for each in found) if isinstance(found, list) else ()

    def set_owner(self, owner: Iterable[str]) -> None:
        """Record for whom the last job has written, until another one writes."""
        self._write({**self._read(), _OWNER: json.dumps(list(owner))})

    def written(self) -> list[Path]:
        """All files of the record that are there as these jobs have written them."""
        return [file for file, known in self._known() if file.is_file() and self._is_as_known(file, known)]

    def names(self) -> list[Path]:
        """All files of the record, whatever has become of them."""
        return [file for file, _ in self._known()]

    def left_over(self, program: Iterable[Path], written: Iterable[Path]) -> list[Path]:
        """Files that earlier jobs wrote with another program, that are as they wrote them, and that now stay.

        program  the files of the program that is written now, wherever they are
        written  the places of all files that are written now
        """
        again = {self._key(file) for file in written}
        stay = [
            (file, known)
            for file, known in self._known()
            if self._key(file) not in again and file.is_file() and self._is_as_known(file, known)
        ]
        job = _job(map(self._digest, program)) if stay else ""
        return [file for file, known in stay if known.split(":")[2:] != [job]]

    def remember(
        self, program: Iterable[Path], papers: Iterable[Path] = (), known: Mapping[Path, str] | None = None
    ) -> None:
        """Record a program, and papers about it, that have been written; it does no harm where that is not possible.

        program  all files of the program
        papers   files about it
        known    digests of files that need not be read again
        """
        if self._record is None:
            return
        of_program, about_it = list(program), list(papers)
        for other in (file for file in of_program if file.parent != self._folder):
            EarlierJob(other).remember([other], (), known)
        digests = {name: known for name, known in self._known_by_name().items() if (self._folder / name).exists()}
        found = {file: (known or {}).get(file) or self._digest(file) for file in (*of_program, *about_it)}
        job = _job(found[file] for file in of_program)
        for file, digest in found.items():
            if digest and file.exists():
                digests[self._key(file)] = f"{file.stat().st_size}:{digest}:{job}"
        self._write(digests)
        for paper in about_it:
            if found[paper] and paper.exists():
                own = EarlierJob(paper)
                own._write({own._key(paper): f"{paper.stat().st_size}:{found[paper]}:{_PAPER}"})

    def remember_names(self, files: Iterable[Path]) -> None:
        """Record the names of these files, and of no others; what they hold is in records of their own."""
        self._write({self._key(file): "" for file in files})

    def _known(self) -> list[tuple[Path, str]]:
        """Return the files of the record, and what is known of each."""
        return [(self._folder / name, known) for name, known in self._known_by_name().items()]

    def _known_by_name(self) -> dict[str, str]:
        """Return the record without its owner."""
        return {name: known for name, known in self._digests.items() if name != _OWNER}

    def _write(self, digests: dict[str, str]) -> None:
        """Replace the record; it does no harm where that is not possible."""
        if self._record is None:
            return
        text = json.dumps(digests)
        part = self._record.with_suffix(f".{os.getpid()}")
        with suppress(OSError):
            _make_folder(self._record.parent)
            write_whole(self._record, text, part)
            _forget_oldest(self._record.parent)
            sync_folder(self._record.parent)

    def _is_as_known(self, file: Path, known: str) -> bool:
        """Whether a file has the size and the digest of the record."""
        size, digest = known.split(":")[:2] if ":" in known else ("", known)
        # The size first: a file that is somebody else's may be endless.
        return size in ("", str(file.stat().st_size)) and self._digest(file) == digest

    def _digest(self, file: Path) -> str:
        """Return the digest of a file, empty if it cannot be read."""
        return self.digests.of(file) or ""

    def _key(self, file: Path) -> str:
        """Return what a file is called in the record: its name, or its whole path if it is in another folder."""
        return os.path.normcase(file.name if file.parent == self._folder else file)

    def _read(self) -> dict[str, str]:
        try:
            found = json.loads(b"" if self._record is None else self._record.read_bytes())
        except (OSError, ValueError, RecursionError):
            return {}
        return {name: text for name, text in found.items() if isinstance(text, str)} if isinstance(found, dict) else {}


def _job(digests: Iterable[str]) -> str:
    """Digest of a program by those of its files."""
    return hashlib.sha256("".join(sorted(digests)).encode()).hexdigest()


def _make_folder(folder: Path) -> None:
    """Make a folder with all above it, so that their names are on the disk."""
    if not folder.is_dir():
        _make_folder(folder.parent)
        folder.mkdir(exist_ok=True)
        sync_folder(folder.parent)


def _forget_oldest(folder: Path) -> None:
    if sum(1 for _ in folder.iterdir()) <= _MOST_PLACES:
        return
    with os.scandir(folder) as entries:
        ages = [(entry.stat().st_mtime_ns, entry.path) for entry in entries]
    for _, path in sorted(ages)[:-_PLACES_KEPT]:
        with suppress(OSError):
            Path(path).unlink()
