"""Programs and papers of set-ups that a project no longer has, which stay beside those that it posts.

In:     a project, and what it has posted.
Out:    a warning for each set-up that is gone, and a record of those that there are, for the next post.

The record is that of ``EarlierJob`` for the project's own file: the programs that posts of the project have written.
What belongs to each of them is in the record of that program.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from trunnion.api.left_over_files import named_files
from trunnion.api.project import Project
from trunnion.errors import Problem, Severity
from trunnion.files import EarlierJob, resolve_output

_CODE: Final = "PRJ155"


def left_over_setups(project: Project, written: Iterable[Path], told: Iterable[Path]) -> list[Problem]:
    """Return the warnings.

    Parameters
    ----------
    project
        Without ``into``: what is posted elsewhere leaves nothing.
    written
        All files that the project writes now: programs, subprograms and papers.
    told
        Programs that stay and are told of already.
    """
    if project.into is not None:
        return []
    now = {resolve_output(file).path for file in written}
    known = now | {resolve_output(file).path for file in told}
    found = []
    for program in _record(project).names():
        if program in known:
            continue
        files = sorted(file for file in EarlierJob(program).written() if file not in now)
        if files:
            one = len(files) == 1
            named = named_files(files, project.folder.resolve())
            what = f"{named} {'is' if one else 'are'} of a set-up that it no longer has"
            cure = f"delete {'it' if one else 'them'}, here and on the control"
            found.append(Problem(str(project.path), 0, what, cure, Severity.WARNING, code=_CODE))
    return found


def remember_setups(project: Project, programs: Sequence[Path]) -> None:
    """Record the programs of a project, once they are in their places, and those of which something is still there."""
    if project.into is None:
        record = _record(project)
        earlier = [program for program in record.names() if EarlierJob(program).written()]
        record.remember_names([*earlier, *(resolve_output(file).path for file in programs)])


def _record(project: Project) -> EarlierJob:
    return EarlierJob(resolve_output(project.path).path)
