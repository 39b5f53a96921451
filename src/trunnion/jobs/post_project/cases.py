"""Cases of a shop's own: projects whose programs lie beside them, and must come out as they are.

In:     a folder of projects.
Out:    for each of them how the programs that are posted now differ from those that are there, as text and as motion.
        Nothing in the folder changes before a case is accepted.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from trunnion.errors import InputError, Problem, TrunnionError
from trunnion.files import EarlierJob, output_group, resolve_output
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post.writing import named_run
from trunnion.jobs.post_project.case_papers import StalePaper, stale_papers
from trunnion.jobs.post_project.operation_programs import programs_of_operations
from trunnion.jobs.post_project.posting import check_within, files_of, post_into
from trunnion.jobs.post_project.setups import ProjectOptions
from trunnion.jobs.post_project.text_difference import TextDifference, text_difference
from trunnion.jobs.post_project.watching import State, state_of
from trunnion.jobs.project.file import load_project
from trunnion.jobs.project.named_files import project_inputs
from trunnion.jobs.project.project import Division, PostedSetup, Project
from trunnion.jobs.result_output import NO_PAPERS
from trunnion.jobs.verify.comparing import diff
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.verification.comparison.result import Comparison

#: What projects are called that are cases, and how the names of others end.
_NAMES: Final = ("case.toml", "part.toml")
_ENDING: Final = ".case.toml"

#: Cases that a folder may have.
_MOST_CASES: Final = 10_000


#: Bytes that a program may have had, and how many times those that it has now; of more it is not read.
_MOST_BYTES: Final = 10 << 20
_MOST_TIMES: Final = 10


@dataclass(frozen=True, slots=True)
class ChangedFile:
    """A file that is not as it was.

    file  where it lies in the case
    text  how it differs; None: it is not there yet
    """

    file: Path
    text: TextDifference | None


@dataclass(frozen=True, slots=True)
class ChangedProgram:
    """A program of which a file is not as it was.

    files   those, with subprograms
    motion  how it moves now against before, or why nobody can tell; None where it is new
    """

    files: tuple[ChangedFile, ...]
    motion: Comparison | Wording | None = None


@dataclass(frozen=True, slots=True)
class Case:
    """A case as it comes out now.

    path      of its project
    same      files that are as they were
    changed   programs that are not
    papers    papers that are not of the programs as they are now
    gone      files of operations that there are no more
    warnings  what the checks of the project warn of
    error     why nothing was posted; None: it was
    """

    path: Path
    same: tuple[Path, ...] = ()
    changed: tuple[ChangedProgram, ...] = ()
    papers: tuple[StalePaper, ...] = ()
    gone: tuple[Path, ...] = ()
    warnings: tuple[Problem, ...] = ()
    error: TrunnionError | None = None
    _project: Project | None = None
    _programs: tuple[tuple[Path, ...], ...] = ()
    _state: State = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether everything is as it was."""
        return self.error is None and not (self.changed or self.papers or self.gone)

    def accept(self) -> "Accepted":
        """Write programs and papers as they are now, all or none of them, and remove programs that are gone.

        They count then as what this project has posted, as after a clone of somebody else's. Programs that are gone
        are removed only if they are as a post has written them.

        Raises ``TrunnionError`` if a file cannot be written, or one that is read has changed since.
        """
        project = self._project
        assert self.error is None, "what must not run is never accepted"
        assert project is not None
        changed = {each.file for differing in self.changed for each in differing.files}
        changed |= {each.file for each in self.papers}
        if changed:
            changed.update(paper for each in project.setups for paper in each.papers.by_name().values())
            with output_group(remembers=False) as group:
                result = post_into(group, project, ProjectOptions(replaces=True))
                if state_of(list(self._state)) != self._state:
                    raise InputError(Problem(str(self.path), 0, Wording("PRJ160", "changed_since_compared")))
            self._remember([files_of(program) for program in result.results])
        else:
            self._remember([list(program) for program in self._programs])
        removed = [file for file in self.gone if EarlierJob(resolve_output(file).path).wrote(resolve_output(file).path)]
        for file in removed:
            file.unlink()
        return Accepted(tuple(sorted(changed)), tuple(removed))

    def _remember(self, programs: Sequence[Sequence[Path]]) -> None:
        """Record programs, and papers with the first file of theirs, as what posts have written."""
        papers = {} if self._project is None else {each.output: each.papers for each in self._project.setups}
        for program in programs:
            named = papers.get(program[0], NO_PAPERS).by_name().values()
            places = [resolve_output(file).path for file in program]
            earlier = EarlierJob(places[0])
            owner = earlier.owner
            earlier.remember(places, [resolve_output(file).path for file in named])
            earlier.set_owner(owner)


@dataclass(frozen=True, slots=True)
class Accepted:
    """What became of a case: files that are new, and those that were removed."""

    written: tuple[Path, ...]
    removed: tuple[Path, ...]


def find_cases(place: Path) -> list[Path]:
    """Return the projects of a folder and of all below it, in order; or the one project that is named.

    Raises ``InputError`` if there is none, or no such folder.
    """
    if not place.is_dir():
        if place.suffix == ".toml":
            return [place]
        raise InputError(Problem(str(place), 0, Wording("PRJ310", "no_folder_of_cases")))
    found: list[Path] = []
    for folder, below, names in os.walk(place):
        below[:] = sorted(name for name in below if not name.startswith("."))
        found += [Path(folder) / name for name in sorted(names) if name in _NAMES or name.endswith(_ENDING)]
        if len(found) > _MOST_CASES:
            raise InputError(Problem(str(place), 0, Wording("PRJ310", "too_many_cases", most=_MOST_CASES)))
    if not found:
        raise InputError(Problem(str(place), 0, Wording("PRJ310", "no_case", names=_NAMES, ending=_ENDING)))
    return found


@contextmanager
def posted_case(path: Path) -> Iterator[Case]:
    """Post a case into a folder of its own, and compare; it can be accepted within the block."""
    with TemporaryDirectory(prefix="trunnion-", ignore_cleanup_errors=True) as folder:
        try:
            case = _compared(path, Path(folder))
        except TrunnionError as error:
            case = Case(path, error=error)
        except OSError as error:
            case = Case(
                path,
                error=InputError(
                    Problem(
                        str(error.filename or path),
                        0,
                        Wording("FIL120", "case_unreadable", reason=error.strerror or error),
                    )
                ),
            )
        yield case


def _compared(path: Path, folder: Path) -> Case:
    project = load_project(path)
    state = state_of(sorted(map(str, project_inputs(project))))
    aside = project.writing_to(folder)
    for setup in aside.setups:
        for file in (setup.output, *setup.papers.by_name().values()):
            file.parent.mkdir(parents=True, exist_ok=True)
    with output_group(remembers=False) as group:
        result = post_into(group, aside)
    places = {file: aside.place_of(file) for file in result.files}
    check_within(list(places.values()), project)
    changed = [_changed(program, setup, places) for setup, programs in result.posted for program in programs]
    differing = {each.file for program in changed if program for each in program.files}
    same = tuple(place for place in places.values() if place not in differing)
    gone = tuple(_gone(project, places))
    pairs = zip(project.setups, aside.setups, strict=True)
    papers = tuple(stale for old, new in pairs for stale in stale_papers(old.papers, new.papers))
    programs = tuple(tuple(places[file] for file in files_of(program)) for program in result.results)
    return Case(
        path, same, tuple(filter(None, changed)), papers, gone, result.problems, None, project, programs, state
    )  # fmt: skip


def _changed(program: PostResult, setup: PostedSetup, places: dict[Path, Path]) -> ChangedProgram | None:
    """How a program differs from the one that is there; None where it does not."""
    assert program.output is not None
    changed = []
    for file in files_of(program):
        there = places[file].is_file()
        difference = _difference(places[file], file) if there else None
        if difference is not None or not there:
            changed.append(ChangedFile(places[file], difference))
    if not changed:
        return None
    if not places[program.output].is_file():
        return ChangedProgram(tuple(changed))
    if large := next((places[file] for file in files_of(program) if _is_large(places[file], file)), None):
        return ChangedProgram(tuple(changed), phrase("not_compared_larger", file=large.name))
    beside = [places[file] for file in program.subprograms if places[file].is_file()]
    motion = _motion(places[program.output], program, [*beside, *map(Path, setup.subprograms)])
    return ChangedProgram(tuple(changed), motion)


def _is_large(there: Path, now: Path) -> bool:
    """Whether a file is so much larger than what comes out that it is no earlier state of it, and is not read."""
    return there.is_file() and there.stat().st_size > _MOST_BYTES + _MOST_TIMES * now.stat().st_size


def _difference(there: Path, now: Path) -> TextDifference | None:
    if _is_large(there, now):
        return TextDifference(phrase("bytes_differ", there=there.stat().st_size, now=now.stat().st_size))
    return text_difference(there, now)


def _motion(there: Path, program: PostResult, beside: Sequence[Path]) -> Comparison | Wording:
    """Return how a program moves against the one that is there, or why nobody can tell."""
    assert program.run is not None, "nothing is posted here that nobody reads"
    run = named_run(program.run, f"{there.name} as it is posted now")
    try:
        return diff(there, run, machine=run.machine, subprograms=beside)
    except InputError as error:
        return phrase("program_unreadable", reason=error.problems[0].wording)


def _gone(project: Project, places: dict[Path, Path]) -> Iterator[Path]:
    written = set(places.values())
    for setup in project.setups:
        if setup.division is Division.OPERATIONS:
            yield from (file for file in programs_of_operations(setup.output) if file not in written)
