"""Posting the set-ups of a project, one after the other.

In:     a project, and where its files appear.
Out:    the programs of each set-up, each of them proven.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from trunnion.errors import InputError, Problem, RefusedError, TrunnionError
from trunnion.files import OutputGroup
from trunnion.jobs.inputs.reading import FilePath, ToolpathLike, as_machine
from trunnion.jobs.inputs.settings import Settings
from trunnion.jobs.inputs.simulation_input import leaves_stock_to_cl
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.papers.writing import PostPapers
from trunnion.jobs.post.planning import load_toolpaths
from trunnion.jobs.post.post_job import prepare
from trunnion.jobs.post.posting import Work, post_beside
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post_project.operation_programs import check_tools, operation_programs
from trunnion.jobs.post_project.replaced_files import replaced_file
from trunnion.jobs.project.outputs import reported_at_outputs
from trunnion.jobs.project.project import Division, PostedSetup, Project
from trunnion.jobs.project.settings import told_in_project
from trunnion.jobs.result_output import NO_PAPERS, PaperFiles
from trunnion.machines import Machine
from trunnion.model.motion import Motion
from trunnion.records import dataclass

if TYPE_CHECKING:
    from trunnion.simulation.meshes import TriangleMesh

#: A set-up, and its programs in their order.
PostedPrograms: TypeAlias = tuple[PostedSetup, tuple[PostResult, ...]]


@dataclass(frozen=True, slots=True, eq=False)
class ProjectOptions:
    """How a project is posted.

    settings  in place of those of the project, for all set-ups
    strict    unknown CL statements are errors
    explain   record why the axes are planned as they are
    replaces  also files that no post has written, because the user has seen what becomes of them
    """

    settings: Settings = field(default_factory=dict)
    strict: bool = False
    explain: bool = False
    replaces: bool = False


#: As the project states it.
NO_OPTIONS: Final = ProjectOptions()


@dataclass(frozen=True, slots=True, eq=False)
class ProjectPosting:
    """A project on its way: what all of its set-ups share.

    inputs  files that are read
    later   papers that wait for the checks of the project
    """

    group: OutputGroup
    project: Project
    options: ProjectOptions
    observer: Observer
    inputs: Sequence[FilePath]
    later: list[PostPapers] = field(default_factory=list)

    @property
    def is_strict(self) -> bool:
        """Whether unknown CL statements are errors."""
        return self.options.strict or self.project.strict

    @property
    def papers(self) -> list[Path]:
        """The papers of all set-ups."""
        return [paper for each in self.project.setups for paper in each.papers.by_name().values()]


def post_setups(posting: ProjectPosting) -> list[PostedPrograms]:
    """Post every set-up: one that is refused does not hide what is wrong with the next ones.

    Raises ``TrunnionError`` with what is wrong with all of them.
    """
    project, posted, errors = posting.project, list[PostedPrograms](), list[TrunnionError]()
    for setup in project.setups:
        try:
            posting.observer.setup(setup.name)
            with told_in_project(setup, posting.options.settings), reported_at_outputs([setup], alone=True):
                posted.append((setup, tuple(_programs(posting, setup))))
        except TrunnionError as error:
            if len(project.setups) > 1 and setup.name:  # they are told together, and may be of one CL file
                error.problems = tuple(_of_setup(problem, setup) for problem in error.problems)
            errors.append(error)
    if errors:
        raise _joined(errors)
    return posted


def _programs(posting: ProjectPosting, setup: PostedSetup) -> Iterator[PostResult]:
    """Post the programs of a set-up, one after the other."""
    options, machine = posting.options, as_machine(setup.machine)
    settings = {**setup.settings, **options.settings}
    if setup.division is not Division.OPERATIONS:
        if setup.division is Division.SUBPROGRAMS:
            settings["programs"] = "operations"
        yield _post(posting, setup, machine, _Program(setup.cl, settings, setup.output, setup.papers))
        return
    job = prepare(machine, settings)
    toolpaths = load_toolpaths(setup.cl, job, posting.is_strict, Observer())
    motions: list[Motion] = []
    for each in operation_programs(toolpaths, job, setup.output):
        if not options.replaces and (found := replaced_file(each.output, each.output)):
            raise InputError(found)
        result = _post(posting, setup, machine, _Program(each.toolpath, each.settings, each.output))
        motions += result.motions
        yield result
    posting.observer.problems(check_tools(motions, job, toolpaths[0].file))


@dataclass(frozen=True, slots=True, eq=False)
class _Program:
    """One program of a set-up."""

    cl: ToolpathLike | Sequence[ToolpathLike]
    settings: Settings
    output: Path
    papers: PaperFiles = NO_PAPERS


def _sheet_tools(posting: ProjectPosting, setup: PostedSetup) -> Mapping[str, Any]:
    """Return what the project says of the tools of a set-up; a simulation comes later, and knows more of them."""
    project = posting.project
    simulated = project.simulation.setups[next(k for k, each in enumerate(project.posted) if each is setup)]
    return {name: getattr(simulated, name) for name in ("tools", "tool_libraries", "unit")}


def _stock_of(project: Project, setup: PostedSetup) -> "str | Path | TriangleMesh | None":
    """Return the stock of the first set-up, which nothing has cut; None where it is not drawn as it stands."""
    first = project.simulation.setups[0]
    if setup is not project.posted[0] or first.pose is not None:
        return None
    return None if leaves_stock_to_cl(project.simulation.stock) else project.simulation.stock


def _post(posting: ProjectPosting, setup: PostedSetup, machine: Machine, program: _Program) -> PostResult:
    project = posting.project
    given: Any = {
        **setup.arguments, **program.papers.by_name(), "output": program.output, "settings": program.settings,
        "strict": posting.is_strict, "explain": posting.options.explain, "hooks": project.hooks,
        "columns": project.checks.longest_s is not None, "sheet_tools": _sheet_tools(posting, setup),
    }  # fmt: skip
    stock = _stock_of(project, setup)
    work = Work(posting.inputs, posting.group, can_force=False, later=posting.later, stock=stock)
    return post_beside(program.cl, machine, given, work, posting.observer)


def _of_setup(problem: Problem, setup: PostedSetup) -> Problem:
    """Return a problem that says in which set-up it is."""
    return replace(problem, wording=problem.wording.within("in_setup", setup=setup.name))


def _joined(errors: Sequence[TrunnionError]) -> TrunnionError:
    """All errors as one: a refusal only if there is no other."""
    if len(errors) == 1:
        return errors[0]
    kind = RefusedError if all(isinstance(error, RefusedError) for error in errors) else InputError
    return kind(dict.fromkeys(problem for error in errors for problem in error.problems))
