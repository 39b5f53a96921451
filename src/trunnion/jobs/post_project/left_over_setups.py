"""Programs and papers of set-ups that a project no longer has, which stay beside those that it posts.

In:     a project, and what it has posted.
Out:    a warning for each program that the project no longer writes, and a record of those that it does write, for the
        next post.

The record is that of ``EarlierJob`` for the project's own file: the programs that posts of the project have written.
What belongs to each of them, and which set-up of which project wrote it last, is in the record of that program: one
that somebody else has written since is somebody else's.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Problem, warning
from trunnion.files import EarlierJob, OutputGroup, resolve_output
from trunnion.jobs.post.left_over_files import first_names
from trunnion.jobs.project.project import PostedSetup, Project
from trunnion.messages import Wording, phrase

#: With what the names of set-ups begin that are only counted.
_COUNTED: Final = "set-up "


def left_over_setups(
    project: Project, written: Iterable[Path], told: Iterable[Path], used: Iterable[Path]
) -> list[Problem]:
    """Return the warnings.

    project  without ``into``: what is posted elsewhere leaves nothing
    written  all files that the project writes now: programs, subprograms and papers
    told     programs that stay and are told of already
    used     files that the project reads: a program that it has among them (``programs``) stays with its papers
    """
    if project.into is not None:
        return []
    now, read = _places(written), _places(used)
    known = now | read | _places(told)
    found = []
    for program in _record(project).names():
        earlier = EarlierJob(program)
        if program in known or not _is_of(project, earlier):
            continue
        files = sorted(file for file in earlier.written() if file not in now | read)
        if files:
            names, more = first_names(files, project.folder.resolve())
            owner = _whose(project, earlier)
            if more:
                wording = Wording("PRJ155", "many_files_left_over", files=names, count=more, owner=owner)
            elif len(names) > 1:
                wording = Wording("PRJ155", "files_left_over", files=names, owner=owner)
            else:
                wording = Wording("PRJ155", "file_left_over", file=names[0], owner=owner)
            found.append(warning(str(project.path), 0, wording))
    return found


def remember_setups(group: OutputGroup, project: Project, programs: Sequence[tuple[PostedSetup, Path]]) -> None:
    """Have the group record the programs of a project, and those before of which something is still there."""
    if project.into is not None:
        return
    record, files = _record(project), [resolve_output(file).path for _, file in programs]
    for (setup, _), file in zip(programs, files, strict=True):
        group.record_owner(file, (str(resolve_output(project.path).path), setup.name, *setup.cl))
    known = {program: EarlierJob(program) for program in record.names()}
    earlier = [program for program, job in known.items() if _is_of(project, job) and job.written()]
    group.record_names(resolve_output(project.path).path, dict.fromkeys([*earlier, *files]))


def _is_of(project: Project, job: EarlierJob) -> bool:
    """Whether a project has written a program last."""
    return job.owner[:1] == (str(resolve_output(project.path).path),)


def _whose(project: Project, job: EarlierJob) -> Wording:
    """Of what the files of a program are: of a set-up that now writes to another one, or of none any more; a phrase.

    A set-up is known by the name that it was given, or by a CL file.
    """
    _, name, *cl = job.owner
    for setup in project.setups:
        if (name and setup.name == name and not name.startswith(_COUNTED)) or set(cl) & set(setup.cl):
            if setup.name:
                return phrase("setup_under_earlier_name", setup=setup.name.removeprefix(_COUNTED))
            return phrase("program_under_earlier_name")
    return phrase("setup_no_longer_there")


def _places(files: Iterable[Path]) -> set[Path]:
    return {resolve_output(file).path for file in files}


def _record(project: Project) -> EarlierJob:
    return EarlierJob(resolve_output(project.path).path)
