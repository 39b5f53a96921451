"""Messages of the library in the words of the command line: options in place of arguments."""

import re
from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from functools import cache, partial
from typing import TYPE_CHECKING, Final

from trunnion.cli.command_line.language import spoken_language, stated_language
from trunnion.cli.terminal_text import severity_painted
from trunnion.errors import Problem, TrunnionError, first_of_kinds
from trunnion.jobs.registry import JOBS
from trunnion.messages import ENGLISH, Wording, Words, phrase
from trunnion.records import dataclass

if TYPE_CHECKING:
    from trunnion.viewer.language import Speech

#: So many errors in lines are printed one by one; of more, so many kinds.
_MOST_ERRORS: Final = 10

#: Arguments that a command knows by their place, or under several names.
_BY_PLACE: Final = {"cl": "CL", "code": "CODE", "first": "NC", "second": "NC"}

#: A setting, such as ``setting tool=5``; an argument with a value, such as ``argument trust=ABC``; and one that is
#: switched on, such as ``force=True``.
_SETTING: Final = re.compile(r"\bsetting (?=[a-z][a-z_0-9]*=)")
_VALUE: Final = re.compile(r"\bargument ([a-z_]+)=")
_SWITCH: Final = re.compile(r"\b([a-z_]+)=True\b")


def in_command_words(text: str) -> str:
    """Return a text of the library in the words of the command line."""
    text = _VALUE.sub(lambda found: f"{_option(found[1])} ", _SETTING.sub("--set ", text))
    return _SWITCH.sub(lambda found: _option(found[1]), text)


@dataclass(frozen=True)
class CommandWords(Words):
    """Options in place of settings and arguments: of a command, where it has one for a setting."""

    command: str = ""
    language: str = ENGLISH

    def setting(self, name: str, value: str) -> str:
        """Return a setting with a value."""
        options = JOBS[self.command].options if self.command else ()
        flag = next((option.flag for option in options if option.setting == name and option.flag), "")
        if flag:
            return f"{flag} {value}"
        text = f"{name}={value}"
        return f'--set "{text}"' if " " in text else f"--set {text}"

    def argument(self, name: str, value: str) -> str:
        """Return an option with a value."""
        return f"{_option(name)} {value}"

    def switch(self, name: str) -> str:
        """Return an option that is switched on."""
        return _option(name)


#: The command that runs, whose options messages name.
_COMMAND: Final[ContextVar[str]] = ContextVar("command", default="")


def speak_of(command: str) -> None:
    """Have messages name the options of a command from here on."""
    _COMMAND.set(command)


def spoken() -> Words:
    """Return the words of the command that runs, in its language."""
    return CommandWords(_COMMAND.get(), spoken_language())


def page_speech() -> "Speech":
    """Return the language of the page that the command serves: the one that is stated, else that of each browser."""
    from trunnion.viewer.language import Speech  # most commands serve no page

    return Speech(partial(CommandWords, _COMMAND.get()), stated_language())


def said(variant: str, /, **parameters: object) -> str:
    """Return a line of the catalogue ``terminal``."""
    return in_words(Wording("terminal", variant, **parameters))


def line(variant: str, /, **parameters: object) -> str:
    """Return a line of a result, of the catalogue ``results``."""
    return in_words(Wording("results", variant, **parameters))


def part(variant: str, /, **parameters: object) -> Wording:
    """Return what stands in such a line: a wording of the catalogue ``results``."""
    return Wording("results", variant, **parameters)


def together(*texts: str) -> str:
    """Return parts of a line, one behind the other; none for those that say nothing."""
    return said("joined", texts=tuple(filter(None, texts)))


def in_words(wording: Wording) -> str:
    """Return a wording in the language and the words of the command that runs."""
    return in_command_words(wording.text("what", spoken()))


def problem_line(problem: Problem) -> str:
    """Return a problem as the command line prints it."""
    called = _option(problem.argument) if problem.argument else ""
    return in_command_words(problem.line_of_text(spoken(), called))


def painted_line(problem: Problem) -> str:
    """Return the same with its severity in colour on a terminal."""
    return severity_painted(problem_line(problem))


def problem_lines(problems: Sequence[Problem]) -> Iterator[str]:
    """Yield problems as the command line prints them; of a flood of errors the first of each kind."""
    shown, left = first_of_kinds(problems, _MOST_ERRORS)
    yield from map(problem_line, shown)
    if left:
        yield in_words(phrase("errors_left", count=left))


def error_lines(error: TrunnionError) -> str:
    """Return the problems of an error, each in its line."""
    return "\n".join(map(severity_painted, problem_lines(error.problems)))


def _option(argument: str) -> str:
    return _options().get(argument, "--" + argument.replace("_", "-"))


@cache
def _options() -> dict[str, str]:
    """Return what the command line calls an argument of the library: its flag, or what stands in its place."""
    options = [option for job in JOBS.values() for option in job.options]
    by_place = {option.name: option.value_name.partition("|")[0] for option in options if not option.flag}
    return by_place | {option.name: option.flag for option in reversed(options) if option.flag} | _BY_PLACE
