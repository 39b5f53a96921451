"""Posting a project: the programs of all its set-ups appear together, once each is proven, or none of them.

In:     a project.
Out:    its programs, what the checks of the project found, and an error where one of them must not run.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.controls.vocabulary import RADIUS_REGISTER_SETTING
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem, RefusedError, Severity, warning
from trunnion.files import OutputGroup, check_outputs, output_group, resolve_output
from trunnion.jobs.inputs.arguments import check_observer, check_path
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.settings import Settings, as_texts
from trunnion.jobs.inputs.simulation_input import leaves_stock_to_cl
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post_project.checks import SetupFindings, check_project
from trunnion.jobs.post_project.left_over_setups import left_over_setups, remember_setups
from trunnion.jobs.post_project.operation_programs import programs_of_operations
from trunnion.jobs.post_project.replaced_files import check_replaced
from trunnion.jobs.post_project.setups import NO_OPTIONS, PostedPrograms, ProjectOptions, ProjectPosting, post_setups
from trunnion.jobs.post_project.unsimulated import unsimulated_problems
from trunnion.jobs.project.file import load_project, told_by_keys
from trunnion.jobs.project.named_files import project_inputs
from trunnion.jobs.project.outputs import reported_at_outputs
from trunnion.jobs.project.project import Division, PostedSetup, Project
from trunnion.messages import Wording
from trunnion.records import dataclass

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
    """Return the file of a program, and those of its subprograms."""
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
        return post_into(group, loaded, ProjectOptions(settings or {}, strict, explain), observer)


def post_into(
    group: OutputGroup,
    project: Project,
    options: ProjectOptions = NO_OPTIONS,
    observer: Observer = SILENT,
) -> ProjectResult:
    """Post a project; its files appear with those of the ``group``. Errors are those of ``post_project``."""
    posting = _prepared(group, project, options, observer)
    posted = post_setups(posting)
    posting = _with_stated_stock(posting, posted)
    found = _judged(posting, posted)
    outputs = [(setup, each.output) for setup, results in posted for each in results if each.output is not None]
    remember_setups(group, project, outputs)
    warnings = _reported(posting, found)
    _write_papers(posting, found)
    return ProjectResult(project, tuple(posted), found.simulation, tuple(warnings))


def _with_stated_stock(posting: ProjectPosting, posted: Sequence[PostedPrograms]) -> ProjectPosting:
    """Return the project with the stock that the CL files of its first set-up state, where it states none itself."""
    project = posting.project
    if not posted or posted[0][0] is not project.posted[0] or not leaves_stock_to_cl(project.simulation.stock):
        return posting
    stated = posted[0][1][0].stated_stock if posted[0][1] else None
    if stated is None:
        return posting
    simulation = replace(project.simulation, stock=stated.stock, stock_from=stated.file)
    return replace(posting, project=replace(project, simulation=simulation))


def _prepared(group: OutputGroup, project: Project, options: ProjectOptions, observer: Observer) -> ProjectPosting:
    """Return what is posted, once it is known that nothing is written over that must stay."""
    project = _simulated_as_posted(project, options.settings)
    posting = ProjectPosting(group, project, options, observer, project_inputs(project))
    with reported_at_outputs(project.setups):
        check_outputs([*(each.output for each in project.setups), *posting.papers], posting.inputs)
        if not options.replaces:
            check_replaced(project)
    observer.problems(_running_hooks(project))
    return posting


def _simulated_as_posted(project: Project, settings: Settings) -> Project:
    """Return the project with what the registers of the radius hold, as it is given for its posts."""
    holds = as_texts(settings).get(RADIUS_REGISTER_SETTING)
    if holds is None:
        return project
    setups = [replace(each, radius_register=holds) for each in project.simulation.setups]
    return replace(project, simulation=replace(project.simulation, setups=setups))


def _running_hooks(project: Project) -> list[Problem]:
    """Warnings of the code that a project has run: it may come from anyone."""
    return [warning(file, 0, Wording("HOK150", "runs_hooks", project=project.path.name)) for file in project.hooks]


@dataclass(frozen=True, slots=True, eq=False)
class _Found:
    """What the checks of a project found; problems are errors and warnings as it judges them."""

    simulation: "SimulationResult | None"
    of_setups: list[SetupFindings]
    problems: list[Problem]


def _judged(posting: ProjectPosting, posted: Sequence[PostedPrograms]) -> _Found:
    """Simulate, compare, and find what posts before have left."""
    project, programs = posting.project, [file for _, results in posted for each in results for file in files_of(each)]
    check_within(programs, project)
    with told_by_keys(project.path):
        simulation, of_setups = check_project(project, posted, posting.observer)
        unsimulated = list(unsimulated_problems(project, posted))
    used = [Path(name) for name in posting.inputs]
    found = [*unsimulated, *(problem for each in of_setups for problem in each.problems)]
    found += _left_over(posted, [*programs, *posting.papers, *used])
    found += left_over_setups(project, [*programs, *posting.papers], [Path(each.file) for each in found], used)
    return _Found(simulation, of_setups, found)


def _reported(posting: ProjectPosting, found: _Found) -> list[Problem]:
    """Report warnings, and return them.

    Raises ``RefusedError`` if there are errors.
    """
    refused = [problem for problem in found.problems if problem.severity is Severity.ERROR]
    warnings = [problem for problem in found.problems if problem.severity is Severity.WARNING]
    posting.observer.problems(warnings)
    if refused:
        nothing = Problem(str(posting.project.path), 0, Wording("CTL940", "no_program_of_project"))
        raise RefusedError([*refused, nothing])
    return warnings


def _write_papers(posting: ProjectPosting, found: _Found) -> None:
    """Write the papers that have waited for the checks."""
    if not posting.later:
        return
    from trunnion.jobs.post_project.papers import write_setup_papers  # only for those that have some

    papers, project = {each.target.path: each for each in posting.later}, posting.project
    for number, (setup, own) in enumerate(zip(project.posted, found.of_setups, strict=True)):
        if setup is not None and setup.output in papers:
            write_setup_papers(papers[setup.output], project, number, own)


def check_within(files: Sequence[Path], project: Project) -> None:
    """Raise ``InputError`` for files of subprograms and operations that links lead out of the folder."""
    folder = project.into or project.folder
    if outside := [file for file in files if not is_within(file, folder)]:
        raise InputError([Problem(str(file), 0, Wording("PRJ120", "leads_out_of_folder")) for file in outside])


def _left_over(posted: Sequence[tuple[PostedSetup, tuple[PostResult, ...]]], used: Sequence[Path]) -> list[Problem]:
    """Warnings of programs of operations that the CL files no longer have, but for files that are ``used``."""
    found, known = list[Problem](), {resolve_output(file).path for file in used}
    for setup, _ in posted:
        if setup.division is not Division.OPERATIONS:
            continue
        for file in programs_of_operations(setup.output):
            if resolve_output(file).path not in known:
                found.append(warning(str(file), 0, Wording("PRJ150", "operation_gone")))
    return found
