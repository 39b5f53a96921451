"""Files that a project must not replace: those that no post has written as they are."""

from pathlib import Path

from trunnion.controls import load_control
from trunnion.errors import InputError, Problem
from trunnion.files import EarlierJob, resolve_output
from trunnion.jobs.inputs.reading import as_machine
from trunnion.jobs.project.project import Division, Project
from trunnion.messages import Wording


def check_replaced(project: Project) -> None:
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
            found += replaced_file(file, setup.output)
        for file in setup.papers.by_name().values():
            found += replaced_file(file, setup.output, paper=True)
    if found:
        raise InputError(found)


def replaced_file(file: Path, first: Path, *, paper: bool = False) -> list[Problem]:
    """Return the problem of a file that is there, is not empty, and is not as posts of the ``first`` have written it.

    A paper may be of a program that had another name: it is not yours if any post has written it as it is. Whether a
    program that was edited since is replaced, its own job decides.
    """
    place = resolve_output(file).path
    earlier = EarlierJob(resolve_output(first).path)
    if not place.exists() or not place.stat().st_size or (earlier.wrote_paper if paper else earlier.wrote)(place):
        return []
    if not paper and earlier.has_edited(place):
        return []
    return [Problem(str(file), 0, Wording("FIL250", "not_as_posted"))]
