"""``trunnion post --suggest``: a project with what was given, and the settings that the messages ask for."""

import os
import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import Final

from trunnion.cli.printing import tell
from trunnion.cli.terminal import Terminal
from trunnion.errors import InputError, Problem, TrunnionError
from trunnion.files import atomic_file
from trunnion.jobs.job import Given
from trunnion.jobs.post.asked_settings import asked_settings, project_text
from trunnion.jobs.post.settings_to_fill import unnamed_operations
from trunnion.machines import shipped_machines
from trunnion.messages import Wording
from trunnion.options.kinds import FileIn, FileOut
from trunnion.wording import counted

#: Options that stand in a project as they were given, where it has a key for them.
_LEFT_OUT: Final = ("settings", "simulate", "project", "strict")


class NotingTerminal(Terminal):
    """A terminal that keeps what it prints."""

    def __init__(self, *, explain: bool = False, recorded: bool = False) -> None:
        super().__init__(explain=explain, recorded=recorded)
        self.found: list[Problem] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        """Print problems, and keep them."""
        self.found += problems
        super().problems(problems)


@contextmanager
def suggestion(given: Given, target: str, terminal: NotingTerminal) -> Iterator[None]:
    """Write the project of a post, whatever becomes of its program; not where a name or an argument is wrong.

    Raises ``InputError`` if its file is there already, or does not lie above what it would name.
    """
    file = Path(given.suggest)
    if file.exists() or file.is_symlink():
        raise InputError(Problem(str(file), 0, Wording("FIL250", "definition_exists")))
    keys = _keys(given, target, file)
    problems: Sequence[Problem] = ()
    try:
        yield
    except TrunnionError as error:
        problems = error.problems
        if any(problem.code.startswith(("FIL", "ARG")) for problem in problems):
            raise
        _write(given, keys, file, [*problems, *terminal.found])
        raise
    _write(given, keys, file, terminal.found)


def _keys(given: Given, target: str, file: Path) -> dict[str, object]:
    """Return the keys of the project that say what was given."""
    machine = given.machine
    keys: dict[str, object] = {
        "machine": machine if machine in shipped_machines() else _within(machine, file),
        "cl": [_within(each, file) for each in given.cl],
        "output": _within(target, file),
    }
    for option in given.job.options:
        value = given.values[option.name]
        if option.name in (*keys, *_LEFT_OUT) or not option.key or option.setting or value in (None, "", [], False):
            continue
        names = isinstance(option.kind, FileIn | FileOut)
        several = [_within(each, file) if names else each for each in (value if isinstance(value, list) else [value])]
        keys[option.key] = several if isinstance(value, list) else several[0]
    return keys


def _within(name: str, file: Path) -> str:
    """Return a file as a project names it: from its own folder on.

    Raises ``InputError`` if it lies elsewhere.
    """
    try:
        path = PurePath(os.path.relpath(name, file.parent))
    except ValueError:  # on another drive
        path = PurePath("..")
    if name == "-" or ".." in path.parts:
        raise InputError(Problem(str(file), 0, Wording("FIL320", "project_elsewhere", name=name)))
    return path.as_posix()


def _write(given: Given, keys: dict[str, object], file: Path, problems: Sequence[Problem]) -> None:
    asked = asked_settings(problems)
    own = {each.setting: given.values[each.name] for each in given.job.options if each.setting}
    stated = {name: str(value) for name, value in own.items() if value is not None}
    text = project_text(
        keys, {**stated, **dict(given.settings)}, asked, shlex.quote(str(file)), unnamed_operations(problems)
    )
    with atomic_file(file) as sink:
        sink.write(text.encode())
    needed = sum(each.to_fill and each.is_needed for each in asked)
    tell(f"{file}: {counted(needed, 'setting')} to fill in; then: trunnion post {shlex.quote(str(file))}")
