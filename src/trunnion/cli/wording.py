"""Messages of the library in the words of the command line: options in place of arguments."""

import re
from typing import Final

from trunnion.errors import Problem, TrunnionError

#: Options that are not called after their arguments.
_OPTIONS: Final = {
    "settings": "--set",
    "work_offset": "--offset",
    "subprograms": "--with",
    "to_subprograms": "--to-with",
    "tools": "--tool",
    "libraries": "--tools",
    "fixtures": "--fixture",
    "operations": "--operation",
    "cl": "CL",
    "code": "CODE",
    "impeller": "IMPELLER",
    "nc": "NC",
    "first": "NC",
    "second": "NC",
}

#: A setting, such as ``setting tool=5``; an argument with a value, such as ``argument trust=ABC``; and one that is
#: switched on, such as ``force=True``.
_SETTING: Final = re.compile(r"\bsetting (?=[a-z][a-z_0-9]*=)")
_VALUE: Final = re.compile(r"\bargument ([a-z_]+)=")
_SWITCH: Final = re.compile(r"\b([a-z_]+)=True\b")


def in_command_words(text: str) -> str:
    """A text of the library in the words of the command line."""
    text = _VALUE.sub(lambda found: f"{_option(found[1])} ", _SETTING.sub("--set ", text))
    return _SWITCH.sub(lambda found: _option(found[1]), text)


def problem_line(problem: Problem) -> str:
    """A problem as the command line prints it."""
    text = in_command_words(str(problem))
    return _option(problem.argument) + text.removeprefix(problem.file) if problem.argument else text


def error_lines(error: TrunnionError) -> str:
    """The problems of an error, each in its line."""
    return "\n".join(map(problem_line, error.problems))


def _option(argument: str) -> str:
    return _OPTIONS.get(argument, "--" + argument.replace("_", "-"))
