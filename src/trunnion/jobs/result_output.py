"""Where a result goes: to a file, to a stream, or into memory; and where its papers go."""

import io
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field
from pathlib import Path
from typing import BinaryIO, Final, TypeAlias

from trunnion.errors import InputError, Problem
from trunnion.files import OutputFiles, OutputGroup, OutputPlace, atomic_output, check_stream, resolve_output
from trunnion.jobs.inputs.arguments import check_path
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.registry import JOBS
from trunnion.messages import Wording
from trunnion.options.kinds import FileOut
from trunnion.records import dataclass

#: A file by its path, a stream that takes bytes, or None: the result keeps the text.
OutputLike: TypeAlias = str | os.PathLike[str] | BinaryIO | None


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """A result that is being written; nothing of it appears before the block of ``open_target`` has ended.

    files   takes what is written
    name    what messages call it
    path    of the file; None: it is no file, or a device
    memory  takes the text where there is no other place; None: there is
    papers  places of its report and of other files about it, by what they are
    """

    files: OutputFiles
    name: str = "the program"
    path: Path | None = None
    memory: io.BytesIO | None = None
    papers: Mapping[str, OutputPlace] = field(default_factory=dict)

    @property
    def subprograms(self) -> tuple[Path, ...]:
        """The files beside the first, once the block has ended."""
        return tuple(self.path.with_name(file.name) for file in self.files.other_paths) if self.path else ()


def check_output_name(argument: str, file: object, endings: Sequence[str], why: Wording | None) -> OutputPlace:
    """Return the place of an output whose name tells its form, which is found out before any work; ``why`` says why it
    is so.

    Raises ``InputError`` if its name ends otherwise, or it cannot be written.
    """
    place = resolve_output(check_path(argument, file))
    if Path(place.name).suffix.lower() not in endings:
        raise InputError(Problem(place.name, 0, Wording("FIL260", "other_ending", why=why, endings=tuple(endings))))
    return place


def declared_output(command: str, option: str, file: object) -> OutputPlace:
    """Return the place of an output that a command declares, found out before any work; errors as
    ``check_output_name``.
    """
    declared = JOBS[command].option(option)
    assert declared is not None
    assert isinstance(declared.kind, FileOut)
    return check_output_name(option, file, declared.kind.endings, declared.kind.why)


def check_report_name(file: FilePath) -> OutputPlace:
    """Return the place of a report, which is found out before any work.

    Raises ``InputError`` if it is of an unknown form, or cannot be written.
    """
    return declared_output("post", "report", file)


@contextmanager
def open_target(
    place: OutputLike,
    *,
    papers: Mapping[str, str | os.PathLike[str] | None] | None = None,
    inputs: Iterable[str | os.PathLike[str]] = (),
    group: OutputGroup | None = None,
    edited: str = "",
) -> Iterator[Target]:
    """Open the place of a result.

    place   of the result
    papers  files about it by what they are (``report``), which appear with it; None: there is no such file
    inputs  files that are read: none of them is written over
    group   of jobs whose files appear together; None: the files of this one appear when the block ends
    edited  what becomes of programs there that were edited since they were written (the setting of that name)

    Raises ``InputError`` when a file cannot be written; this is found out before anything is computed.
    """
    beside = {what: resolve_output(file) for what, file in (papers or {}).items() if file is not None}
    if group is not None:
        assert isinstance(place, str | os.PathLike), "streams take one result alone"
        found = resolve_output(place)
        with group.open(found, papers=beside.values(), inputs=inputs, edited=edited) as files:
            yield Target(files, found.name, Path(place), papers=beside)
        return
    if isinstance(place, str | os.PathLike):
        found = resolve_output(place)
        path = None if found.is_stream else Path(place)
        with atomic_output(found, papers=beside.values(), inputs=inputs, is_job=True, edited=edited) as files:
            yield Target(files, found.name, path, papers=beside)
        return
    memory = io.BytesIO() if place is None else None
    stream: BinaryIO | None = memory if place is None else place
    assert stream is not None
    check_stream(stream, "output")
    with atomic_output(stream, papers=beside.values(), inputs=inputs) as files:
        yield Target(files, memory=memory, papers=beside)


def written_text(path: Path | None, memory: io.BytesIO | None, encoding: str = "utf-8") -> str | None:
    """Return what was written to a file or into memory; None where it went to a stream."""
    if memory is not None:
        return memory.getvalue().decode(encoding)
    return None if path is None else path.read_bytes().decode(encoding)


@dataclass(frozen=True, slots=True)
class PaperFiles:
    """Where the papers of a post go; None: there is no such paper.

    report    ``.html`` or ``.json``
    sheet     the setup sheet, ``.html`` or ``.json``
    listing   of the motions, of any name
    manifest  ``.json``, beside the program
    """

    report: Path | None = None
    sheet: Path | None = None
    listing: Path | None = None
    manifest: Path | None = None

    def by_name(self) -> dict[str, Path]:
        """Return the papers that there are."""
        return {name: getattr(self, name) for name in PAPERS if getattr(self, name) is not None}

    @property
    def need_columns(self) -> bool:
        """Whether one of them takes the columns of the verification."""
        return any(each is not None for each in (self.report, self.sheet, self.manifest))


#: No papers at all.
NO_PAPERS: Final = PaperFiles()

#: The papers by their names, and what each is called in a sentence.
PAPERS: Final = {"report": "report", "sheet": "setup sheet", "listing": "listing", "manifest": "manifest"}


def paper_files(
    report: FilePath | None, sheet: FilePath | None, listing: FilePath | None, manifest: FilePath | None, output: object
) -> PaperFiles:
    """Return the papers of a post, whose places are found out before any work.

    Raises ``InputError`` if one is of an unknown form or cannot be written, or a manifest is not beside its program.
    """
    if report is not None:
        check_report_name(report)
    if sheet is not None:
        declared_output("post", "sheet", sheet)
    if manifest is not None:
        place = declared_output("post", "manifest", manifest)
        program = Path(output) if isinstance(output, str | os.PathLike) else None
        if program is None or program.parent.resolve() != Path(manifest).parent.resolve():
            raise InputError(Problem(place.name, 0, Wording("FIL320", "manifest_elsewhere")))
    places = (None if each is None else Path(each) for each in (report, sheet, listing, manifest))
    return PaperFiles(*places)
