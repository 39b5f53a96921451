"""Cases of a shop's own: projects whose programs lie beside them, and must come out as they are.

In:     a folder of projects.
Out:    for each of them how the programs that are posted now differ from those that are there, as text and as motion.
        Nothing in the folder changes before a case is accepted.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from trunnion.api.comparing import diff
from trunnion.api.dividing import programs_of_operations
from trunnion.api.observer import SILENT
from trunnion.api.post_result import PostResult
from trunnion.api.project import Division, PostedSetup, Project
from trunnion.api.project_file import load_project, project_inputs
from trunnion.api.project_posting import ProjectResult, check_within, files_of, post_into
from trunnion.api.text_difference import TextDifference, text_difference
from trunnion.api.writing import named_run
from trunnion.errors import InputError, Problem, TrunnionError
from trunnion.files import EarlierJob, output_group, resolve_output

#: What projects are called that are cases, and how the names of others end.
_NAMES: Final = ("case.toml", "part.toml")
_ENDING: Final = ".case.toml"

#: Cases that a folder may have.
_MOST_CASES: Final = 10_000


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
    motion  how it moves now against before, in lines; none where it is new
    moves   it moves as before; False where nobody can tell
    """

    files: tuple[ChangedFile, ...]
    motion: tuple[str, ...] = ()
    moves: bool = False


@dataclass(frozen=True, slots=True)
class Case:
    """A case as it comes out now.

    path      of its project
    same      files that are as they were
    changed   programs that are not
    gone      files of operations that there are no more
    warnings  what the checks of the project warn of
    error     why nothing was posted; None: it was
    """

    path: Path
    same: tuple[Path, ...] = ()
    changed: tuple[ChangedProgram, ...] = ()
    gone: tuple[Path, ...] = ()
    warnings: tuple[Problem, ...] = ()
    error: TrunnionError | None = None
    _new: tuple[tuple[Path, Path], ...] = ()
    _programs: tuple[tuple[Path, ...], ...] = ()
    _inputs: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether everything is as it was."""
        return self.error is None and not self.changed and not self.gone

    def accept(self) -> list[Path]:
        """Write the programs as they are now, all or none of them; returns the files that changed.

        They count then as what this project has posted, as after a clone of somebody else's.

        Raises
        ------
        InputError
            If a file cannot be written.
        """
        assert self.error is None, "what must not run is never accepted"
        changed = {each.file for differing in self.changed for each in differing.files}
        with output_group(remembers=False) as group:
            for new, place in self._new:
                if place in changed:
                    with group.open(resolve_output(place), inputs=self._inputs) as files, new.open("rb") as source:
                        while piece := source.read(1 << 20):
                            files.main.write(piece)
        for program in self._programs:
            places = [resolve_output(file).path for file in program]
            EarlierJob(places[0]).remember(places)
        return sorted(changed)


def find_cases(place: Path) -> list[Path]:
    """The projects of a folder and of all below it, in order; or the one project that is named.

    Raises
    ------
    InputError
        If there is none, or no such folder.
    """
    if not place.is_dir():
        if place.suffix == ".toml":
            return [place]
        raise InputError(
            Problem(str(place), 0, "is no folder, and no project (.toml)", "give a folder of cases", code="PRJ310")
        )
    found: list[Path] = []
    for folder, below, names in os.walk(place):
        below[:] = sorted(name for name in below if not name.startswith("."))
        found += [Path(folder) / name for name in sorted(names) if name in _NAMES or name.endswith(_ENDING)]
        if len(found) > _MOST_CASES:
            raise InputError(
                Problem(str(place), 0, f"has more than {_MOST_CASES} cases", "test a part of it", code="PRJ310")
            )
    if not found:
        what = f"has no case: no {', '.join(_NAMES)} or file that ends in {_ENDING} in it or below"
        raise InputError(
            Problem(str(place), 0, what, "write a project for each case (docs/projects.md)", code="PRJ310")
        )
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
            what = f"cannot be compared: {error.strerror or error}"
            case = Case(path, error=InputError(Problem(str(error.filename or path), 0, what, code="FIL120")))
        yield case


def _compared(path: Path, folder: Path) -> Case:
    project = load_project(path)
    inputs = tuple(map(str, project_inputs(project)))
    aside = project.writing_to(folder)
    for setup in aside.setups:
        setup.output.parent.mkdir(parents=True, exist_ok=True)
    with output_group(remembers=False) as group:
        result = post_into(group, aside, settings=None, strict=False, explain=False, observer=SILENT)
    places = {file: aside.place_of(file) for file in result.files}
    check_within(list(places.values()), project)
    changed = [_changed(program, setup, places) for setup, programs in result.posted for program in programs]
    differing = {each.file for program in changed if program for each in program.files}
    same = tuple(place for place in places.values() if place not in differing)
    gone = tuple(_gone(project, result, places))
    programs = tuple(tuple(places[file] for file in files_of(program)) for program in result.results)
    return Case(
        path, same, tuple(filter(None, changed)), gone, result.problems, None, tuple(places.items()), programs, inputs
    )  # fmt: skip


def _changed(program: PostResult, setup: PostedSetup, places: dict[Path, Path]) -> ChangedProgram | None:
    """How a program differs from the one that is there; None where it does not."""
    assert program.output is not None
    changed = []
    for file in files_of(program):
        there = places[file].is_file()
        difference = text_difference(places[file], file) if there else None
        if difference is not None or not there:
            changed.append(ChangedFile(places[file], difference))
    if not changed:
        return None
    if not places[program.output].is_file():
        return ChangedProgram(tuple(changed))
    beside = [places[file] for file in program.subprograms if places[file].is_file()]
    moves, lines = _motion(places[program.output], program, [*beside, *map(Path, setup.subprograms)])
    return ChangedProgram(tuple(changed), tuple(lines), moves)


def _motion(there: Path, program: PostResult, beside: Sequence[Path]) -> tuple[bool, list[str]]:
    """Whether a program moves as the one that is there, and how it differs."""
    assert program.run is not None, "nothing is posted here that nobody reads"
    run = named_run(program.run, f"{there.name} as it is posted now")
    try:
        found = diff(there, run, machine=run.machine, subprograms=beside)
    except InputError as error:
        return False, [f"the program that is there cannot be read: {error.problems[0].what}"]
    return found.same, list(found.lines())


def _gone(project: Project, result: ProjectResult, places: dict[Path, Path]) -> Iterator[Path]:
    written = set(places.values())
    for setup in project.setups:
        if setup.division is Division.OPERATIONS:
            yield from (file for file in programs_of_operations(setup.output) if file not in written)
