"""What the options of ``trunnion post`` mean together: CL files, or a project that states everything itself."""

from collections.abc import Sequence
from typing import Final

from trunnion.cli.command_line.help_texts import signature
from trunnion.jobs.job import Given
from trunnion.messages import Wording

#: Options that stand beside a project, although it has a key for them.
_BESIDE: Final = ("cl", "strict", "settings")


def names_project(files: Sequence[str]) -> bool:
    """Whether files name a project: no CL file is called so."""
    return any(file.endswith(".toml") for file in files)


def post_mistake(given: Given) -> Wording | None:
    """Return what does not go together, and the cure; None where everything does."""
    if names_project(given.cl):
        return _mistake_of_project(given)
    if given.machine is None:
        machine = given.job.option("machine")
        assert machine is not None
        return Wording("ARG120", "missing", names=(signature(machine),), example=given.job.example)
    if given.watch and "-" in (*given.cl, given.output):
        return Wording("ARG120", "watched_stream")
    return None


def _mistake_of_project(given: Given) -> Wording | None:
    project = next(file for file in given.cl if file.endswith(".toml"))
    if len(given.cl) > 1:
        return Wording("ARG120", "project_among_files", project=project)
    if given.force:
        return Wording("ARG120", "forced_project", project=project)
    if given.suggest:
        return Wording("ARG120", "suggested_project", project=project)
    for option in given.job.options:
        if option.key and option.name not in _BESIDE and given.values[option.name]:
            return Wording("ARG120", "not_with_project", option=option.flag, key=option.key)
    return None
