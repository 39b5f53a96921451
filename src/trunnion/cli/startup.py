"""``trunnion post``: CL files, a project, or either of them again and again."""

from trunnion.cli.command_line.post_mistakes import names_project
from trunnion.cli.post_files import post_files
from trunnion.jobs.job import Given


def run(given: Given) -> int:
    """Post every CL file, or a project; or watch them."""
    if given.watch:
        from trunnion.cli.watch import run as watch

        return watch(given)
    if names_project(given.cl):
        from trunnion.cli.project import run as post_project

        return post_project(given)
    return post_files(given)
