"""``trunnion post PROJECT``: all programs of a project, together or not at all."""

from pathlib import Path

from trunnion.cli.post import old_files_told, print_summary
from trunnion.cli.printing import tell
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, spoken
from trunnion.files import check_outputs
from trunnion.jobs.job import Given
from trunnion.jobs.post_project.operation_programs import programs_of_operations
from trunnion.jobs.post_project.posting import ProjectResult, post_project
from trunnion.jobs.project.file import load_project
from trunnion.jobs.project.named_files import project_inputs
from trunnion.jobs.project.project import Division, Project


def run(given: Given) -> int:
    """Post a project."""
    project = load_project(Path(given.cl[0]))
    if given.json not in (None, "-"):
        given.read = [*project_inputs(project), *outputs_of(project)]
        check_outputs([given.json], given.read)
    papers = (paper for each in project.setups for name, paper in each.papers.by_name().items() if name != "report")
    with old_files_told([*outputs_of(project), *(str(paper) for paper in papers)]):
        result = post_project(
            given.cl[0],
            settings=dict(given.settings),
            strict=given.strict,
            explain=given.explain,
            observer=Terminal(explain=given.explain, recorded=given.explain),
        )
    _print_files(result)
    if given.json is not None:
        show(given, lambda: {"schema": 2, "programs": result.results}, ())
    return 0


def outputs_of(project: Project) -> list[str]:
    """Return the programs of a project by their files; of operations those that are there."""
    found: list[str] = []
    for setup in project.setups:
        by_operation = setup.division is Division.OPERATIONS
        found += map(str, programs_of_operations(setup.output) if by_operation else [setup.output])
    return found


def _print_files(result: ProjectResult) -> None:
    """Name the files of every program."""
    for program in result.results:
        print_summary(str(program.output), program)
    if result.simulation is not None:
        tell(line("simulation_line", told=result.simulation.line(spoken())))
