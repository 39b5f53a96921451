"""Output files of a job, which appear complete or not at all."""

import filecmp
import io
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, TypeAlias

from trunnion.errors import InputError, Problem
from trunnion.files.command_output import move_together, once_in_place
from trunnion.files.dead_jobs import remove_temporary_folders, settle_and_log
from trunnion.files.earlier_job import EarlierJob
from trunnion.files.edited import place_of_edited
from trunnion.files.hidden_folders import HiddenFolders
from trunnion.files.interrupts import held_interrupts
from trunnion.files.journal import Record
from trunnion.files.moves import Moves
from trunnion.files.places import Claims, OutputPlace, cannot_write, resolve_output
from trunnion.files.streams import open_stream, send, stream_name
from trunnion.messages import Wording

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

#: Where a first file goes: its place, or a stream that takes its bytes.
Destination: TypeAlias = OutputPlace | BinaryIO


class _RawFile(io.FileIO):
    """A file whose errors of writing name it as the caller does; errors of anything else stay what they are."""

    def __init__(self, path: Path, known_as: str) -> None:
        self._known_as = known_as
        try:
            super().__init__(path, "w+")
        except OSError as error:
            raise cannot_write(known_as, error) from None

    def write(self, data: "ReadableBuffer", /) -> int:
        try:
            return super().write(data)
        except OSError as error:
            raise cannot_write(self._known_as, error) from None


class OutputFiles:
    """A file being written, and further files beside it, in a hidden folder until all of them are complete.

    main   sink of the first file
    path   path at which it can be read back after ``flush``
    """

    def __init__(
        self,
        folder: Path,
        name: str,
        place: OutputPlace | None = None,
        claims: Claims | None = None,
        earlier: EarlierJob | None = None,
        edited: str = "",
    ) -> None:
        self.path = folder / name
        self._edited, self._kept = edited, dict[OutputPlace, OutputPlace]()
        self._seen: dict[OutputPlace, str | None] = {}
        self._place, self._claims, self._earlier = place, claims or Claims(), earlier
        if place is not None:
            self._keep_edited(place)
        self.main: BinaryIO = _open(self.path, place.name if place else name)
        self._subprograms: dict[Path, tuple[BinaryIO, OutputPlace]] = {}
        self._papers: list[tuple[Path, BinaryIO, OutputPlace]] = []
        self._sync_thread: ThreadPoolExecutor | None = None

    def add_file(self, name: str, *, is_numbered: bool = False) -> BinaryIO:
        """Begin a further file in the same folder, and return its sink.

        name         of the file
        is_numbered  its name is a number, for the cure where it has that of somebody else's file

        Raises ``InputError`` if there cannot be a file of this name beside the first, or if it is one that is read or
        written already, or one that exists and that no earlier job of this first file has written.
        """
        place = self.check_file(name, is_numbered=is_numbered)
        self._claims.write(place)
        path = self.path.parent / name
        self._subprograms[path] = _open(path, place.name), place
        return self._subprograms[path][0]

    def check_file(self, name: str, *, is_numbered: bool = False) -> OutputPlace:
        """Find out whether ``add_file`` can begin a file, and where it will be; errors are those of ``add_file``."""
        assert self._place is not None, "a stream is one file"
        place = resolve_output(Path(self._place.name).with_name(name))
        if place.is_stream:
            raise InputError(Problem(place.name, 0, Wording("FIL210", "subprogram_cannot_written")))
        self._claims.check(place)
        if self._earlier is None or not place.path.exists() or self._earlier.wrote(place.path):
            if self._earlier is not None:
                self._seen[place] = self._earlier.digests.of(place.path)
            return place
        if not self._earlier.has_edited(place.path):
            variant = "number_of_other_file" if is_numbered else "name_of_other_file"
            raise InputError(Problem(place.name, 0, Wording("FIL250", variant, path=Path(self._place.name).name)))
        self._keep_edited(place)
        return place

    @property
    def kept(self) -> list[tuple[OutputPlace, OutputPlace]]:
        """Programs that were edited since they were written, and where they are kept."""
        return [(place, kept) for place, kept in self._kept.items() if kept != place]

    def _keep_edited(self, place: OutputPlace) -> None:
        """Note where a program that was edited is kept; errors are those of ``place_of_edited``."""
        if self._earlier is None:
            return
        self._seen[place] = self._earlier.digests.of(place.path)
        if (kept := place_of_edited(place, self._earlier, self._edited)) is not None:
            self._kept[place] = kept

    def check_replaced(self) -> None:
        """Raise ``InputError`` for a file that no job has written, and that holds anything else than these files."""
        for path, place in self._program_files():
            if self._kept.get(place) == place:
                if not filecmp.cmp(path, place.path, shallow=False):
                    raise InputError(Problem(place.name, 0, Wording("FIL250", "of_somebody_else")))
                del self._kept[place]

    def _check_since(self) -> None:
        """Keep or refuse programs that were edited while this one was made; errors as those of ``check_replaced``."""
        if self._earlier is None:
            return
        for _, place in self._program_files():
            if self._earlier.digests.of(place.path) != self._seen.get(place):
                self._kept.pop(place, None)
                self._earlier = EarlierJob(self._earlier.first, self._earlier.digests)
                self._keep_edited(place)
        self.check_replaced()

    def add_paper(self, place: OutputPlace) -> BinaryIO:
        """Begin a report or another file about the first one, which appears with it, and return its sink."""
        folder = self.path.parent / f".paper{len(self._papers)}"
        try:
            folder.mkdir()
        except OSError as error:
            raise cannot_write(place.name, error) from None
        path = folder / place.path.name
        sink = _open(path, place.name)
        self._papers.append((path, sink, place))
        return sink

    @contextmanager
    def filled(self) -> Iterator["OutputFiles"]:
        """Take files, or further papers of a program that is complete, and close them; errors are those of ``sync``."""
        yield from _fill(self)

    def protect(self, files: Iterable[str | os.PathLike[str]]) -> None:
        """Never write over these files.

        Raises ``InputError`` if one of them is going to be written.
        """
        self._claims.read(files)

    @property
    def other_paths(self) -> list[Path]:
        """Paths of the further files, in the order in which they were begun."""
        return list(self._subprograms)

    @property
    def papers(self) -> list[tuple[Path, OutputPlace]]:
        """Paths of the papers and their places, in the order in which they were begun."""
        return [(path, place) for path, _, place in self._papers]

    def flush(self) -> None:
        """Make everything written readable at the paths."""
        for sink in self._open_sinks():
            sink.flush()

    def start_sync(self) -> None:
        """Begin to bring the first file to the disk in a thread, so that ``sync`` has less to wait for."""
        self.flush()
        self._sync_thread = self._sync_thread or ThreadPoolExecutor(1)
        self._sync_thread.submit(os.fsync, self.main.fileno())

    def sync(self) -> None:
        """Bring all files to the disk, so that a power failure cannot leave half a file under its final name."""
        self.flush()
        for sink in self._open_sinks():
            try:
                os.fsync(sink.fileno())
            except OSError as error:
                raise cannot_write(self._place.name if self._place else self.path.name, error) from None

    def restart(self) -> None:
        """Discard everything written."""
        self.main.seek(0)
        self.main.truncate()
        for path, (sink, place) in self._subprograms.items():
            sink.close()
            path.unlink()
            self._kept.pop(place, None)
            self._claims.release(place)
        self._subprograms.clear()

    def close(self) -> None:
        """Close all files; what could not be written has been reported before."""
        with held_interrupts():
            if self._sync_thread is not None:
                self._sync_thread.shutdown()
            for sink in self._open_sinks():
                with suppress(InputError):
                    sink.close()

    def publish(self, hidden: HiddenFolders, stream: BinaryIO | None) -> None:
        """Bring all files to their places, once they are closed; the first one goes to the stream if there is one."""
        if stream is not None:
            _send(self.path, stream, self._place.name if self._place else stream_name(stream))
        for path, place in self.papers:
            if place.is_stream:
                with open_stream(place) as device:
                    _send(path, device, place.name)
        move_together(partial(self.bring, hidden, main=stream is None), self.places, [hidden])

    def bring(self, hidden: HiddenFolders, moves: Moves, *, main: bool = True) -> None:
        """Add the complete files to those that move to their places; ``main``: the first one is among them.

        Raises ``InputError`` if a program there was edited since the files were begun, and is not to be kept.
        """
        self._check_since()
        program = [moves.add(hidden, path, place) for path, place in self._program_files(main=main)]
        to_files = [(path, place) for path, place in self.papers if not place.is_stream]
        papers = [moves.add(hidden, path, place) for path, place in to_files]
        moves.withdrawn += [place for _, place in to_files]
        for place, kept in self._kept.items():
            moves.add(hidden, place.path, kept)
        if self._earlier is not None and main and self._place is not None:
            moves.records.append(Record(program[-1], tuple(program), tuple(papers)))
            moves.digests.take(self._earlier.digests)

    def remember_alone(self, paper: Path) -> None:
        """Record a paper that was written although the program is not."""
        place = resolve_output(paper)
        if self._earlier is not None and not place.is_stream:
            once_in_place(partial(self._earlier.remember, [], [place.path]))

    def left_over(self, papers: Iterable[OutputPlace]) -> list[Path]:
        """Files that earlier jobs of the first file wrote with another program, and that stay beside this one.

        The program is complete, and ``papers`` are all that are written about it.
        """
        if self._earlier is None:
            return []
        self.flush()
        files = self._program_files()
        places = [*(place for _, place in files), *papers]
        return self._earlier.left_over([path for path, _ in files], [place.path for place in places])

    @property
    def places(self) -> list[OutputPlace]:
        """The places of all files."""
        return [place for _, place in (*self._program_files(), *self.papers)]

    def _program_files(self, *, main: bool = True) -> list[tuple[Path, OutputPlace]]:
        files = [(path, place) for path, (_, place) in self._subprograms.items()]
        return [*files, *([(self.path, self._place)] if main and self._place is not None else [])]

    def sinks(self) -> list[BinaryIO]:
        """Return the sinks of all files of the program, the first file's first; not those of its papers."""
        return [self.main, *(sink for sink, _ in self._subprograms.values())]

    def _open_sinks(self) -> list[BinaryIO]:
        return [sink for sink in (*self.sinks(), *(sink for _, sink, _ in self._papers)) if not sink.closed]


def _open(path: Path, known_as: str) -> BinaryIO:
    return io.BufferedRandom(_RawFile(path, known_as))


def _send(path: Path, stream: BinaryIO, name: str) -> None:
    """Write a complete file to a stream; one whose reader has gone away raises a ``BrokenPipeError``."""
    with path.open("rb") as source:
        try:
            send(source, stream)
        except BrokenPipeError:
            raise
        except (OSError, ValueError) as error:
            shown = error if isinstance(error, OSError) else OSError(str(error))
            raise cannot_write(name, shown) from None


@contextmanager
def atomic_output(
    target: str | os.PathLike[str] | Destination,
    *,
    papers: Iterable[OutputPlace] = (),
    inputs: Iterable[str | os.PathLike[str]] = (),
    is_job: bool = False,
    edited: str = "",
) -> Iterator[OutputFiles]:
    """Files that reach their places together when the block ends, or not at all if it raises.

    target  of the first file: a path, whose folder takes the others, or a stream, which takes one file only
    papers  files that will be written as well (``add_paper``): none of the others may be one of them
    inputs  files that are read: none of them is written over
    is_job  the further files get names that nobody chose: they replace only what earlier jobs of the first file have
            written, which is remembered
    edited  of a job: ``keep`` or ``replace`` programs that were edited since jobs have written them; they are refused
            otherwise

    Raises ``InputError`` if a file cannot be written. For the first file this is known when the block begins. Earlier
    files of the same names stay as they were.
    """
    place = resolve_output(target) if isinstance(target, str | os.PathLike) else target
    claims = Claims()
    claims.read(inputs)
    places = [each for each in (place, *papers) if isinstance(each, OutputPlace)]
    for each in places:
        claims.write(each)
    settle_and_log(each.path.parent for each in places if not each.is_stream)
    hidden = HiddenFolders()
    # An interruption of the first removal leaves the second one to do it.
    try:
        try:
            with ExitStack() as opened:
                yield from _fill_and_publish(place, claims, hidden, opened, edited if is_job else None)
        finally:
            hidden.remove()
    finally:
        hidden.remove()


def _fill_and_publish(
    place: Destination, claims: Claims, hidden: HiddenFolders, opened: ExitStack, edited: str | None
) -> Iterator[OutputFiles]:
    """Yield the files to be filled, and bring them to their places; ``edited`` is that of a job."""
    stream = None if isinstance(place, OutputPlace) else place
    own = place if isinstance(place, OutputPlace) else None
    if own is not None and own.is_stream:
        stream = opened.enter_context(open_stream(own))
    if is_stream := stream is not None or own is None:
        remove_temporary_folders()
    folder = hidden.temporary() if is_stream or own is None else hidden.beside(own)
    name = "stream" if is_stream or own is None else Path(own.name).name
    earlier = EarlierJob(own.path) if edited is not None and own is not None and stream is None else None
    files = OutputFiles(folder, name, own, claims, earlier, edited or "")
    yield from _fill(files)
    files.publish(hidden, stream)


def _fill(files: OutputFiles) -> Iterator[OutputFiles]:
    """Yield the files to be filled, and leave them complete and closed."""
    # An interruption of the first closing leaves the second one to do it.
    try:
        try:
            yield files
            files.sync()
            files.check_replaced()
        finally:
            files.close()
    finally:
        files.close()


@contextmanager
def atomic_file(
    target: str | os.PathLike[str] | OutputPlace, *, inputs: Iterable[str | os.PathLike[str]] = ()
) -> Iterator[BinaryIO]:
    """Yield the sink of a single file, as ``atomic_output`` makes it.

    Its ``name`` is the path at which the file can be read back after a flush.
    """
    with atomic_output(target, inputs=inputs) as files:
        yield files.main
