"""``trunnion post --suggest``: a project with what was given, and the settings that the messages ask for."""

import os
import re
import shlex
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import Final

from trunnion.cli.printing import tell
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, part, spoken
from trunnion.errors import InputError, Problem, Severity, TrunnionError
from trunnion.files import atomic_file
from trunnion.jobs.job import Given
from trunnion.machines import shipped_machines
from trunnion.messages import Wording, library_words, phrase
from trunnion.options.kinds import FileIn, FileOut, Setting, Switch
from trunnion.options.option import Option

#: A key of a project, where other options have words in place of one.
_NAME: Final = re.compile(r"\w+")


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
    unsaid = _unsaid(given)
    try:
        yield
    except TrunnionError as error:
        problems = [*error.problems, *terminal.found]
        if any(problem.code.startswith(("FIL", "ARG")) for problem in error.problems):
            raise
        from trunnion.jobs.post.asked_settings import asked_settings  # what only a suggestion needs

        if any(each.is_needed for each in asked_settings(problems)):
            _write(given, (keys, unsaid), file, problems)
        else:
            tell(line("nothing_suggested", file=str(file)))
        raise
    _write(given, (keys, unsaid), file, terminal.found)


def _keys(given: Given, target: str, file: Path) -> dict[str, object]:
    """Return the keys of the project that say what was given."""
    machine = given.machine
    keys: dict[str, object] = {
        "machine": machine if machine in shipped_machines() else _within(machine, file),
        "cl": [_within(each, file) for each in given.cl],
        "output": _within(target, file),
    }
    for option in _given(given):
        value = given.values[option.name]
        if option.name in keys or isinstance(option.kind, Setting) or option.setting or not _has_key(option):
            continue
        if isinstance(option.kind, Switch):
            keys |= (
                {option.key: True} if _NAME.fullmatch(option.key) else tomllib.loads(option.key.replace("] ", "]\n"))
            )
            continue
        keys[option.key] = _stated(value, option, file)
    return {**_of_project(given, file), **keys}


def _of_project(given: Given, file: Path) -> dict[str, object]:
    """Return the keys of the project that states what the program is simulated with; none without one.

    Raises ``InputError`` if it cannot be read.
    """
    if given.project is None:
        return {}
    from trunnion.jobs.project.file import read_project
    from trunnion.jobs.project.keys import OF_PROJECT, OF_SETUP

    own = {"machine", "cl", *dict(given.settings), *(each.setting or each.name for each in _given(given))}
    simulation = read_project(Path(given.project), ("nc", *own))
    stated = [(simulation, each) for each in OF_PROJECT] + [(simulation.setups[0], each) for each in OF_SETUP]
    values = [(option, getattr(place, option.name)) for place, option in stated if option.name not in own | {"until"}]
    return {
        option.key: _stated(list(value) if isinstance(value, tuple) else value, option, file)
        for option, value in values
        if value is not None and value is not False and value not in ((), [], {}) and _NAME.fullmatch(option.key)
    }


def _given(given: Given) -> list[Option]:
    """Return the options that were given."""
    return [each for each in given.job.options if given.values[each.name] not in (None, "", each.empty)]


def _has_key(option: Option) -> bool:
    """Whether a project states an option under its key; the key of a table may have its value."""
    return _NAME.fullmatch(option.key) is not None or option.key.startswith("[")


def _unsaid(given: Given) -> list[str]:
    """Return the options that were given and that no project states."""
    return [
        each.flag
        for each in _given(given)
        if each.flag and each.name not in ("suggest", "project") and not each.setting and not _has_key(each)
    ]


def _stated(value: object, option: Option, file: Path) -> object:
    """Return the value of an option, or its values, as a project has them."""
    several = [_as_stated(each, option, file) for each in (value if isinstance(value, list) else [value])]
    return several if isinstance(value, list) else several[0]


def _as_stated(value: object, option: Option, file: Path) -> object:
    """Return a value as a project has it."""
    from trunnion.simulation.fixtures import is_stated_fixture
    from trunnion.simulation.stock.solids import is_mesh

    kind = option.kind
    if not isinstance(kind, FileIn | FileOut):
        return value
    leads = kind.leads if isinstance(kind, FileIn) else ""
    if (leads == "stock" and not is_mesh(str(value))) or (leads == "fixture" and is_stated_fixture(str(value))):
        return value
    return _within(str(value), file)


def _within(name: str, file: Path) -> str:
    """Return a file as a project names it: from its own folder on.

    Raises ``InputError`` if it lies elsewhere, or no project names a file so.
    """
    from trunnion.jobs.project.paths import leads_out

    try:
        path = PurePath(os.path.relpath(name, file.parent))
    except ValueError:  # on another drive
        path = PurePath("..")
    if name == "-" or ".." in path.parts:
        raise InputError(Problem(str(file), 0, Wording("FIL320", "project_elsewhere", name=name)))
    if leads_out(path.as_posix()):
        raise InputError(Problem(str(file), 0, Wording("FIL320", "never_in_project", name=name)))
    return path.as_posix()


def _write(given: Given, said: tuple[dict[str, object], list[str]], file: Path, problems: Sequence[Problem]) -> None:
    """Write the project; ``said`` are its keys, and the options that no project states."""
    from trunnion.jobs.post.asked_settings import asked_settings, project_text
    from trunnion.jobs.post.settings_to_fill import GATHERED, unnamed_operations

    asked = asked_settings(problems)
    own = {each.setting: given.values[each.name] for each in given.job.options if each.setting}
    stated = {name: str(value) for name, value in own.items() if value is not None}
    keys, unsaid = said
    head = [phrase("to_post_project", file=shlex.quote(str(file)))]
    head += [phrase("not_in_project", options=tuple(unsaid))] if unsaid else []
    head += [phrase("operation_not_named", operation=each) for each in unnamed_operations(problems)]
    words = library_words(spoken().language)
    text = project_text(keys, {**stated, **dict(given.settings)}, asked, head, words)
    with atomic_file(file) as sink:
        sink.write(text.encode())
    needed = sum(each.to_fill and each.is_needed for each in asked)
    decisions = sum(not each.to_fill and each.is_needed for each in asked)
    answered = [problem for each in asked for problem in each.problems]
    others = [each for each in problems if each.severity is Severity.ERROR and each.code != GATHERED]
    others = [each for each in others if each not in answered]
    parts = [part("settings_to_fill", count=needed)]
    parts += [part("decisions_behind", count=decisions)] if decisions else []
    parts += [part("errors_otherwise", count=len(others))] if others else []
    tell(line("suggested", file=str(file), parts=tuple(parts), name=shlex.quote(str(file))))
