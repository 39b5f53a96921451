"""What the options of ``trunnion post`` mean together: CL files, or a project that states everything itself."""

from collections.abc import Sequence
from typing import Final

from trunnion.jobs.job import Given

#: Options that stand beside a project, although it has a key for them.
_BESIDE: Final = ("cl", "strict", "settings")


def names_project(files: Sequence[str]) -> bool:
    """Whether files name a project: no CL file is called so."""
    return any(file.endswith(".toml") for file in files)


def post_mistake(given: Given) -> str:
    """Return what does not go together, and the cure; empty where everything does."""
    if names_project(given.cl):
        return _mistake_of_project(given)
    if given.machine is None:
        return "the following arguments are required: --machine"
    if given.watch and "-" in (*given.cl, given.output):
        return "--watch reads files again and again, and writes files: name them in place of -"
    return ""


def _mistake_of_project(given: Given) -> str:
    project = next(file for file in given.cl if file.endswith(".toml"))
    if len(given.cl) > 1:
        return f"{project} is a project, and stands beside other files; give it alone"
    if given.force:
        return f"{project} is a project, whose programs must all be fit to run; to force one, post its CL files alone"
    for option in given.job.options:
        if option.key and option.name not in _BESIDE and given.values[option.name]:
            return f"{option.flag} does not go with a project; write it there, as {option.key}, or give CL files"
    return ""
