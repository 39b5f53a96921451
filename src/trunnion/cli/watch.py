"""``trunnion post --watch``: post again whenever CAM, or anyone else, writes one of the files that are read."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from datetime import datetime
from pathlib import Path
from typing import Protocol

from trunnion.cli.command_line.post_mistakes import names_project
from trunnion.cli.post import files_by_target, sheet_tools_of, simulation_of
from trunnion.cli.post_files import post_files
from trunnion.cli.printing import print_result, tell
from trunnion.cli.process import Ended
from trunnion.cli.progress import progress
from trunnion.cli.project import outputs_of
from trunnion.cli.terminal import warn_of_old
from trunnion.cli.wording import problem_lines, said
from trunnion.errors import Problem, RefusedError, TrunnionError
from trunnion.files import OutputGroup, file_on_disk, output_at_once, output_group
from trunnion.jobs.inputs.bodies import fixture_files
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.job import Given
from trunnion.jobs.observer import Observer
from trunnion.jobs.post_project.posting import post_into
from trunnion.jobs.post_project.setups import ProjectOptions
from trunnion.jobs.post_project.watching import FolderNotices, Waiting, mentioned_files, watch
from trunnion.jobs.project.file import load_project
from trunnion.jobs.project.named_files import project_inputs
from trunnion.jobs.project.project import Project
from trunnion.jobs.simulate.posted import simulation_files
from trunnion.wording import one_line


def run(given: Given) -> int:
    """Post again and again; Ctrl-C ends it with 0, as nothing else does."""
    notices = FolderNotices()
    try:
        return follow(given, notices)
    finally:
        notices.close()


def follow(given: Given, waiting: Waiting, now: Callable[[], datetime] = datetime.now) -> int:
    """Post as ``run`` does, where time passes as ``waiting`` says."""
    work: _Work = _ProjectWork(given) if names_project(given.cl) else _FilesWork(given)
    try:
        tell(said("watched", name=work.name))
        watch(_Told(work, now), waiting)
    except Ended:
        raise
    except KeyboardInterrupt:
        return 0
    raise AssertionError("a watch has no end of its own")


class _Work(Protocol):
    """Something that is posted again."""

    name: str

    def files(self) -> set[str]:
        """Return the files that it reads."""

    def post(self, group: OutputGroup) -> tuple[bool, list[str]]:
        """Post it once: whether what is written may run, and what is written."""

    def outputs(self) -> list[str]:
        """Return the files that it writes, as far as they are known."""


class _Warnings(Observer):
    """Prints warnings and progress, and nothing of what is well."""

    def problems(self, problems: Sequence[Problem]) -> None:
        """Print problems, one a line."""
        tell(*problem_lines(problems))

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """Show a progress bar."""
        return progress(stage, total, unit)


class _Told:
    """Work of which each round is told in one line, with the time."""

    def __init__(self, work: _Work, now: Callable[[], datetime]) -> None:
        self._work, self._now = work, now

    def files(self) -> set[str]:
        """Return the files that the work reads."""
        return self._work.files()

    def work(self, is_unchanged: Callable[[], bool]) -> None:
        """Post once, and say what became of it."""
        try:
            with output_at_once(), output_group() as group:
                may_run, written = self._work.post(group)
                if not is_unchanged():
                    raise _ChangedError
        except (_ChangedError, TrunnionError, OSError) as error:
            self._tell(_failure(error, is_unchanged()))
            self._warn_of_old_programs()
            return
        variant = "watched_posted" if may_run else "watched_forced"
        self._tell(said(variant, names=tuple(written)))

    def _tell(self, what: str) -> None:
        print_result(one_line(f"{self._now():%H:%M:%S} {self._work.name}: {what}"))

    def _warn_of_old_programs(self) -> None:
        """Say that programs which are there are not those of the files as they are now."""
        warn_of_old(self._work.outputs())


class _ChangedError(Exception):
    """Files have changed while they were posted."""


def _failure(error: _ChangedError | TrunnionError | OSError, is_unchanged: bool) -> str:
    """Return what a round that failed says, after its problems are printed."""
    if isinstance(error, _ChangedError) or not is_unchanged:
        return said("watched_changed")
    if isinstance(error, OSError):
        return said("watched_error", reason=str(error.strerror or error))
    tell(*problem_lines(error.problems))
    variant = "watched_refused" if isinstance(error, RefusedError) else "watched_unusable"
    return said(variant, count=len(error.problems))


def _of_definition(machine: str) -> set[str]:
    """Return the file of a machine, and what it may extend: also files of which no value counts yet."""
    return {machine, *mentioned_files(Path(machine))} if machine.endswith(".toml") else set()


class _ProjectWork:
    """A project that is posted again."""

    def __init__(self, given: Given) -> None:
        self.name = given.cl[0]
        self._given = given
        self._project: Project | None = None
        self._files = {self.name}

    def files(self) -> set[str]:
        """Return the files that the project reads; while it is broken, those that it read before."""
        try:
            self._project = load_project(Path(self.name))
            self._files = {str(file) for file in project_inputs(self._project)}
            self._files.update(*(_of_definition(each.machine) for each in self._project.setups))
        except (TrunnionError, OSError):
            self._files |= {self.name, *mentioned_files(Path(self.name))}
        return set(self._files)

    def post(self, group: OutputGroup) -> tuple[bool, list[str]]:
        """Post the project."""
        given = self._given
        options = ProjectOptions(dict(given.settings), given.strict)
        result = post_into(group, load_project(Path(self.name)), options, _Warnings())
        return True, [str(file) for file in result.files]

    def outputs(self) -> list[str]:
        """Programs of the project as it was last read."""
        return [] if self._project is None else outputs_of(self._project)


class _FilesWork:
    """CL files that are posted again."""

    def __init__(self, given: Given) -> None:
        self.name = ", ".join(given.cl)
        self._given = given
        self._definitions: set[str] = set()

    def files(self) -> set[str]:
        """CL files, definitions, and what the simulation reads."""
        given = self._given
        named = {*map(file_on_disk, given.cl), *given.subprograms, *given.hooks, *_of_definition(given.machine)}
        try:
            found = machine_files(given.machine, load_machine(given.machine))
            self._definitions = {str(file) for file in found}
        except (TrunnionError, OSError):  # those that it had before stay
            pass
        try:
            named |= {str(file) for file in simulation_files(simulation_of(given) or sheet_tools_of(given) or {})}
        except (TrunnionError, OSError):  # a project that is broken; posting will tell
            named |= {given.project, *mentioned_files(Path(given.project))} if given.project else set()
            named |= {*given.tool_libraries, *fixture_files(given.fixtures), *filter(None, (given.part, given.stock))}
        return named | self._definitions

    def post(self, group: OutputGroup) -> tuple[bool, list[str]]:
        """Post the CL files."""
        code = post_files(self._given, group, _Warnings())
        return code == 0, self.outputs()

    def outputs(self) -> list[str]:
        """Return the programs that they become."""
        try:
            return list(files_by_target(self._given, load_machine(self._given.machine)))
        except (TrunnionError, OSError):
            return []
