"""``trunnion post PROJECT``: all programs of a project, together or not at all."""

import argparse
from pathlib import Path

from trunnion.cli.post import old_files_told, print_dialects, print_summary
from trunnion.cli.terminal import Terminal
from trunnion.jobs.project.file import load_project
from trunnion.jobs.project.operation_programs import programs_of_operations
from trunnion.jobs.project.posting import ProjectResult, post_project
from trunnion.jobs.project.project import Division, Project


def run(arguments: argparse.Namespace) -> int:
    """Post a project."""
    project = load_project(Path(arguments.files[0]))
    papers = (paper for each in project.setups for name, paper in each.papers.by_name().items() if name != "report")
    with old_files_told([*outputs_of(project), *(str(paper) for paper in papers)]):
        result = post_project(
            arguments.files[0],
            settings=dict(arguments.settings),
            strict=arguments.strict,
            explain=arguments.explain,
            observer=Terminal(explain=arguments.explain, recorded=arguments.explain),
        )
    _print_files(result)
    return 0


def outputs_of(project: Project) -> list[str]:
    """The programs of a project by their files; of operations those that are there."""
    found: list[str] = []
    for setup in project.setups:
        by_operation = setup.division is Division.OPERATIONS
        found += map(str, programs_of_operations(setup.output) if by_operation else [setup.output])
    return found


def _print_files(result: ProjectResult) -> None:
    """Name the files of every program, and what their CL files are written in."""
    seen = set[str]()
    for program in result.results:
        print_dialects([path for path in program.toolpaths if path.file not in seen])
        seen.update(path.file for path in program.toolpaths)
    for program in result.results:
        print_summary(str(program.output), program)
