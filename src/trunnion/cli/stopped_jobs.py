"""Before a command reads or writes anything: what jobs that were stopped have left in its folders."""

import os
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Final

from trunnion.cli.printing import tell_problem
from trunnion.cli.wording import problem_line
from trunnion.errors import TrunnionError
from trunnion.files import settle_dead_jobs
from trunnion.jobs.job import Given
from trunnion.options.kinds import FileIn, FileOut
from trunnion.options.option import Option

#: Folders within one that a command is given.
_MOST_FOLDERS: Final = 10_000


def settle_stopped_jobs(given: Given) -> None:
    """Finish or roll back what is found in the folders of a command, and say which."""
    for problem in settle_dead_jobs(_folders(given)):
        tell_problem(problem_line(problem))


def _folders(given: Given) -> Iterator[Path]:
    """Yield the folders of all files that a command is given, and of those that a project writes."""
    for option in given.job.options:
        if not isinstance(option.kind, FileIn | FileOut) and "FOLDER" not in option.value_name:
            continue
        value = given.values[option.name]
        for name in value if isinstance(value, list) else [value]:
            if isinstance(name, str) and name not in ("", "-") and "\0" not in name:
                with suppress(OSError):  # a name that no file can have is refused where it is opened
                    yield from _of_name(option, name)


def _of_name(option: Option, name: str) -> Iterator[Path]:
    path = Path(os.path.realpath(name))
    if path.is_dir():
        yield from islice(_within(path), _MOST_FOLDERS)
        return
    yield path.parent
    if (
        name.endswith(".toml")
        and not isinstance(option.kind, FileOut)
        and path.is_file()
        and b"setup" in path.read_bytes()
    ):
        yield from _of_project(path)


def _within(folder: Path) -> Iterator[Path]:
    """Yield a folder and those in it, which a command may read as well."""
    for path, names, _ in os.walk(folder):
        yield Path(path)
        names[:] = sorted(name for name in names if not name.startswith("."))


def _of_project(path: Path) -> Iterator[Path]:
    from trunnion.jobs.project.file import load_project  # most commands are about none

    with suppress(TrunnionError, OSError):
        for setup in load_project(path).setups:
            for file in (setup.output, *setup.papers.by_name().values()):
                yield Path(os.path.realpath(file)).parent
