"""What a job is: its options, the function that carries it out, and the words about it."""

import os
import sys
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, BinaryIO, Final

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.options.kinds import FileIn, Setting
from trunnion.options.option import Group, Option, flat
from trunnion.records import dataclass

#: stdin as a file.
STDIN: Final = "-"


@dataclass(frozen=True, slots=True)
class Job:
    """One command, as data; modules are named by texts, and imported when it is run.

    name      of the command
    title     one line for lists of commands
    options   in the order in which ``--help`` shows them
    run       ``module:function`` of the command line, which takes what is given, and returns the exit code
    examples  what is typed, and what it does
    guards    whether it finds out itself which files it must not write over: it begins to work before that is known
    goes_on   whether it goes on after it has written files, which then appear one by one and not when it ends
    """

    name: str
    title: str
    options: tuple[Option, ...]
    run: str
    examples: tuple[tuple[str, str], ...] = ()
    guards: bool = False
    goes_on: bool = False

    @property
    def arguments(self) -> list[Option]:
        """Options that are known by their place."""
        return [each for each in self.options if not each.flag]

    @property
    def flags(self) -> list[Option]:
        """Options that are known by their flag."""
        return [each for each in self.options if each.flag]

    @property
    def example(self) -> str:
        """The first example that is the command itself."""
        return next(line for line, _ in self.examples if f"trunnion {self.name}" in line)

    def option(self, name: str) -> Option | None:
        """Return the option of an argument; None if it has none."""
        return next((each for each in self.options if each.name == name), None)


def job(
    name: str, title: str, *options: Option | Group, run: str, examples: Iterable[tuple[str, str]],
    guards: bool = False, goes_on: bool = False,
) -> Job:  # fmt: skip
    """Declare a command."""
    return Job(name, title, flat(options), f"trunnion.cli.{run}", tuple(examples), guards, goes_on)


class Given:
    """What a command was given: each option's value under its name.

    job    the command
    typed  options that stand for settings, by these: what is wrong with such a setting is wrong with the option
    read   files that it reads, none of which it writes over; known once ``jobs.guard`` has asked
    """

    def __init__(self, job: Job, values: Mapping[str, Any], typed: Mapping[str, Option] = MappingProxyType({})) -> None:
        self.job = job
        self.values = dict(values)
        self.typed = typed
        self.read: list[str | os.PathLike[str]] = []

    def __getattr__(self, name: str) -> Any:
        try:
            return self.values[name]
        except KeyError:
            raise AttributeError(name) from None

    def arguments(self, *left_out: str) -> dict[str, Any]:
        """Return the arguments of the function that the command runs; stdin as a stream.

        Raises ``InputError`` if stdin is named twice: it can be read once.
        """
        options = [each for each in self.job.options if not each.own and each.name not in left_out]
        found = {each.name: self._argument(each) for each in options}
        found |= {each.name: dict(found[each.name]) for each in options if isinstance(each.kind, Setting)}
        if "settings" in found:
            found = {name: value for name, value in found.items() if not self._is_setting(name)}
        return found

    def _argument(self, option: Option) -> Any:
        value = self.values[option.name]
        if not isinstance(option.kind, FileIn) or not option.kind.stdin:
            return value
        return streams(value) if isinstance(value, list) else next(iter(streams([value])), None)

    def _is_setting(self, name: str) -> bool:
        option = self.job.option(name)
        return option is not None and bool(option.setting)


def streams(files: Iterable[str]) -> list[str | BinaryIO]:
    """Files as the library takes them: ``-`` is stdin.

    Raises ``InputError`` if stdin is named twice: it can be read once.
    """
    named = list(files)
    if named.count(STDIN) > 1:
        raise InputError(Problem("stdin", 0, Wording("ARG130", "stdin_twice", stdin=STDIN)))
    return [sys.stdin.buffer if file == STDIN else file for file in named]
