"""``trunnion post PROJECT``: all programs of a project, together or not at all."""

import argparse

from trunnion.api.project_posting import ProjectResult, post_project
from trunnion.cli.post import print_dialects, print_summary
from trunnion.cli.terminal import Terminal


def run(arguments: argparse.Namespace) -> int:
    """Post a project."""
    result = post_project(
        arguments.files[0],
        settings=dict(arguments.settings),
        strict=arguments.strict,
        explain=arguments.explain,
        observer=Terminal(explain=arguments.explain, recorded=arguments.explain),
    )
    _print_files(result)
    return 0


def _print_files(result: ProjectResult) -> None:
    """Name the files of every program, and what their CL files are written in."""
    seen = set[str]()
    for program in result.results:
        print_dialects([path for path in program.toolpaths if path.file not in seen])
        seen.update(path.file for path in program.toolpaths)
    for program in result.results:
        print_summary(str(program.output), program)
