"""Posting a project: the programs of all its set-ups appear together, once each is proven, or none of them.

In:     a project.
Out:    its programs, what the checks of the project found, and an error where one of them must not run.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.controls import load_control
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem, RefusedError, Severity, TrunnionError
from trunnion.files import EarlierJob, OutputGroup, check_outputs, output_group, resolve_output
from trunnion.jobs.inputs.arguments import check_observer, check_path
from trunnion.jobs.inputs.reading import FilePath, ToolpathLike, as_machine
from trunnion.jobs.inputs.settings import Settings, SettingValue
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.papers.files import NO_PAPERS, PaperFiles
from trunnion.jobs.papers.writing import PostPapers
from trunnion.jobs.post.planning import load_toolpaths
from trunnion.jobs.post.post_job import prepare
from trunnion.jobs.post.posting import post_beside
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.project.checks import SetupFindings, check_project
from trunnion.jobs.project.file import load_project, project_inputs, told_by_keys
from trunnion.jobs.project.left_over_setups import left_over_setups, remember_setups
from trunnion.jobs.project.operation_programs import check_tools, operation_programs, programs_of_operations
from trunnion.jobs.project.project import Division, PostedSetup, Project
from trunnion.jobs.project.settings import told_in_project
from trunnion.machines import Machine
from trunnion.model.motion import Motion

if TYPE_CHECKING:  # imported where a project is simulated
    from trunnion.jobs.simulate.result import SimulationResult


@dataclass(frozen=True, slots=True, eq=False)
class ProjectResult:
    """A project that was posted: every program of it is proven, and written.

    project     as it was read
    posted      set-ups of which something was posted, each with its programs in their order
    simulation  of all set-ups; None: it was not asked for
    problems    what the checks of the project warn of; each program has its own warnings
    """

    project: Project
    posted: tuple[tuple[PostedSetup, tuple[PostResult, ...]], ...]
    simulation: "SimulationResult | None" = None
    problems: tuple[Problem, ...] = ()

    @property
    def results(self) -> tuple[PostResult, ...]:
        """Every program, in the order of set-ups."""
        return tuple(result for _, results in self.posted for result in results)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files of all programs and of their subprograms."""
        return tuple(file for each in self.results for file in files_of(each))


def files_of(program: PostResult) -> list[Path]:
    """The file of a program, and those of its subprograms."""
    return [*([] if program.output is None else [program.output]), *program.subprograms]


def post_project(
    project: FilePath,
    *,
    settings: Settings | None = None,
    strict: bool = False,
    explain: bool = False,
    observer: Observer = SILENT,
) -> ProjectResult:
    """Post all that a project states, and prove, simulate and compare it as the project asks for.

    Parameters
    ----------
    project
        Its file (``.toml``; docs/projects.md).
    settings
        In place of those of the project, for all set-ups.
    strict
        Raise an error for unknown CL statements even if the definition says what becomes of them.
    explain
        Record why the axes were planned as they are.
    observer
        Receives the progress, warnings, and the plan and the proof of each program.

    Returns
    -------
    ProjectResult
        ``files``, the programs in ``results`` and the ``simulation``. Each program is proven.

    Raises
    ------
    InputError
        When the project, a file, a machine or a setting cannot be used.
    RefusedError
        When a program must not run, or a check of the project refuses it. No file of the project is written then.
    """
    check_observer(observer)
    loaded = load_project(check_path("project", project))
    with output_group() as group:
        return post_into(group, loaded, settings=settings, strict=strict, explain=explain, observer=observer)


def post_into(
    group: OutputGroup, project: Project, *, settings: Settings | None, strict: bool, explain: bool,
    observer: Observer, replaces: bool = False,
) -> ProjectResult:  # fmt: skip
    """Post a project; its files appear with those of the ``group``. Errors are those of ``post_project``.

    A set-up that is refused does not hide what is wrong with the next ones. ``replaces``: also files that no post has
    written, because the user has seen what becomes of them.
    """
    inputs = project_inputs(project)
    papers = [paper for each in project.setups for paper in each.papers.by_name().values()]
    check_outputs([*(each.output for each in project.setups), *papers], inputs)
    if not replaces:
        _check_replaced(project)
    observer.problems(_running_hooks(project))
    post = _SetupPost(
        group, project, inputs, dict(settings or {}), strict or project.strict, explain, observer, replaces
    )
    posted, errors = list[tuple[PostedSetup, tuple[PostResult, ...]]](), list[TrunnionError]()
    for setup in project.setups:
        try:
            observer.setup(setup.name)
            with told_in_project(setup, settings or {}):
                posted.append((setup, tuple(post.programs(setup))))
        except TrunnionError as error:
            if len(project.setups) > 1 and setup.name:  # they are told together, and may be of one CL file
                error.problems = tuple(_of_setup(problem, setup) for problem in error.problems)
            errors.append(error)
    if errors:
        raise _joined(errors)
    check_within([file for _, results in posted for each in results for file in files_of(each)], project)
    with told_by_keys(project.path):
        simulation, of_setups = check_project(project, posted, observer)
    programs = [file for _, results in posted for each in results for file in files_of(each)]
    used = [Path(name) for name in inputs]
    found = [problem for each in of_setups for problem in each.problems]
    found += _left_over(posted, [*programs, *papers, *used])
    found += left_over_setups(project, [*programs, *papers], [Path(each.file) for each in found], used)
    outputs = [(setup, each.output) for setup, results in posted for each in results if each.output is not None]
    group.afterwards(partial(remember_setups, project, outputs))
    refused = [problem for problem in found if problem.severity is Severity.ERROR]
    warnings = [problem for problem in found if problem.severity is Severity.WARNING]
    observer.problems(warnings)
    if refused:
        nothing = Problem(str(project.path), 0, "no program of the project is written", code="CTL940")
        raise RefusedError([*refused, nothing])
    _write_papers(project, post.later, of_setups)
    return ProjectResult(project, tuple(posted), simulation, tuple(warnings))


def _write_papers(project: Project, waiting: Sequence[PostPapers], of_setups: Sequence[SetupFindings]) -> None:
    """Write the papers that have waited for the checks."""
    if not waiting:
        return
    from trunnion.jobs.project.papers import write_setup_papers  # only for those that have some

    papers = {each.target.path: each for each in waiting}
    for number, (setup, found) in enumerate(zip(project.posted, of_setups, strict=True)):
        if setup is not None and setup.output in papers:
            write_setup_papers(papers[setup.output], project, number, found)


def _running_hooks(project: Project) -> list[Problem]:
    """Warnings of the code that a project has run: it may come from anyone."""
    what, cure = f"runs as Python, because {project.path.name} names it", "read it before, if it is not yours"
    return [Problem(file, 0, what, cure, Severity.WARNING, code="HOK150") for file in project.hooks]


def check_within(files: Sequence[Path], project: Project) -> None:
    """Raise ``InputError`` for files of subprograms and operations that links lead out of the folder."""
    folder = project.into or project.folder
    what, cure = "leads out of the folder of the project", "remove the link"
    if outside := [file for file in files if not is_within(file, folder)]:
        raise InputError([Problem(str(file), 0, what, cure, code="PRJ120") for file in outside])


@dataclass(frozen=True, slots=True)
class _SetupPost:
    """Posts set-ups of a project: what all of them share."""

    group: OutputGroup
    project: Project
    inputs: Sequence[FilePath]
    settings: Mapping[str, SettingValue]
    strict: bool
    explain: bool
    observer: Observer
    replaces: bool
    #: Papers that wait for the checks of the project.
    later: list[PostPapers] = field(default_factory=list)

    def programs(self, setup: PostedSetup) -> Iterator[PostResult]:
        """Post the programs of a set-up, one after the other."""
        machine = as_machine(setup.machine)
        settings = {**setup.settings, **self.settings}
        if setup.division is not Division.OPERATIONS:
            if setup.division is Division.SUBPROGRAMS:
                settings["programs"] = "operations"
            yield self._program(setup, machine, setup.cl, settings, setup.output, setup.papers)
            return
        job = prepare(machine, settings)
        toolpaths = load_toolpaths(setup.cl, job, self.strict, Observer())
        motions: list[Motion] = []
        for each in operation_programs(toolpaths, job, setup.output):
            if not self.replaces and (found := _replaced(each.output, each.output)):
                raise InputError(found)
            result = self._program(setup, machine, each.toolpath, each.settings, each.output, NO_PAPERS)
            motions += result.motions
            yield result
        self.observer.problems(check_tools(motions, job, toolpaths[0].file))

    def _program(
        self,
        setup: PostedSetup,
        machine: Machine,
        cl: ToolpathLike | Sequence[ToolpathLike],
        settings: Settings,
        output: Path,
        papers: PaperFiles,
    ) -> PostResult:
        return post_beside(
            cl, self.inputs, machine=machine, output=output, settings=settings, strict=self.strict, force=False,
            explain=self.explain, papers=papers, columns=self.project.checks.longest_s is not None,
            subprograms=setup.subprograms, hooks=self.project.hooks, observer=self.observer, group=self.group,
            forcing="", later=self.later, turn=setup.turn, tilt=setup.tilt,
        )  # fmt: skip


def _check_replaced(project: Project) -> None:
    """Raise ``InputError`` for files that would be replaced, and that are not as posts have written them.

    The author of a project has named them, who may be anyone: not the user, whose files they are.
    """
    found: list[Problem] = []
    for setup in project.setups:
        named = [] if setup.division is Division.OPERATIONS else [setup.output]
        extension = load_control(as_machine(setup.machine).control).extension
        # A program is replaced by a program, as after a clone; all else only if it is ours.
        named = [file for file in named if file.suffix.lower() != extension.lower()]
        for file in named:
            found += _replaced(file, setup.output)
        for file in setup.papers.by_name().values():
            found += _replaced(file, setup.output, paper=True)
    if found:
        raise InputError(found)


def _replaced(file: Path, first: Path, *, paper: bool = False) -> list[Problem]:
    """The problem of a file that is there, is not empty, and is not as posts of the ``first`` have written it.

    A paper may be of a program that had another name: it is not yours if any post has written it as it is.
    """
    place = resolve_output(file).path
    earlier = EarlierJob(resolve_output(first).path)
    if not place.exists() or not place.stat().st_size or (earlier.wrote_paper if paper else earlier.wrote)(place):
        return []
    what = "would be replaced, although no post has written it as it is"
    cure = "remove it, or take the new one over with trunnion test"
    return [Problem(str(file), 0, what, cure, code="FIL250")]


def _left_over(posted: Sequence[tuple[PostedSetup, tuple[PostResult, ...]]], used: Sequence[Path]) -> list[Problem]:
    """Warnings of programs of operations that the CL files no longer have, but for files that are ``used``."""
    found, known = list[Problem](), {resolve_output(file).path for file in used}
    for setup, _ in posted:
        if setup.division is not Division.OPERATIONS:
            continue
        for file in programs_of_operations(setup.output):
            if resolve_output(file).path not in known:
                what = "is the program of an operation that the CL files no longer have"
                found.append(
                    Problem(
                        str(file), 0, what, "remove it from here and from the control", Severity.WARNING, code="PRJ150"
                    )
                )
    return found


def _of_setup(problem: Problem, setup: PostedSetup) -> Problem:
    """A problem that says in which set-up it is."""
    return replace(problem, what=f"{problem.what} (set-up {setup.name})")


def _joined(errors: Sequence[TrunnionError]) -> TrunnionError:
    """All errors as one: a refusal only if there is no other."""
    if len(errors) == 1:
        return errors[0]
    kind = RefusedError if all(isinstance(error, RefusedError) for error in errors) else InputError
    return kind(dict.fromkeys(problem for error in errors for problem in error.problems))
