"""``--help``: of the command line, with its commands in groups, and of each command, with examples."""

import shutil
import sys
import textwrap
from collections.abc import Iterator
from itertools import groupby
from typing import Final

from trunnion.cli.terminal_text import painted
from trunnion.jobs.job import Job
from trunnion.jobs.registry import GROUPS
from trunnion.options.kinds import Choice
from trunnion.options.option import Many, Option

_ABOUT: Final = "CL files to proven NC programs for five-axis machine tools."

#: Columns of what is explained, and the most that lines have.
_WIDTH: Final = 24
_MOST: Final = 120


def overview() -> str:
    """All commands, by what they are for."""
    lines = ["usage: trunnion COMMAND …", "", _ABOUT]
    for title, jobs in GROUPS.items():
        lines += ["", _title(title)]
        for job in jobs:
            lines += _entry(job.name, job.title, 14)
    lines += [
        "",
        "trunnion COMMAND --help explains a command with examples, trunnion explain CODE a message;",
        "trunnion --version prints the version.",
    ]
    return "\n".join(lines) + "\n"


def command_help(job: Job) -> str:
    """How a command is called, what it takes, and two examples."""
    needed = [each for each in job.flags if each.required]
    words = [*(_usage(each) for each in job.arguments), *(f"{each.flag} {each.value_name}" for each in needed)]
    lines = [
        f"usage: trunnion {job.name} {' '.join([*words, '[OPTIONS]'] if job.flags else words)}",
        "",
        _sentence(job.title),
    ]
    lines += ["", _title("Arguments")] if job.arguments else []
    for each in job.arguments:
        lines += _entry(each.value_name, each.help)
    for heading, options in groupby(sorted(job.flags, key=lambda each: each.heading != ""), lambda each: each.heading):
        lines += ["", _title(_sentence(f"options {heading}" if heading else "options").rstrip("."))]
        for each in options:
            lines += _entry(_signature(each), _explained(each))
    lines += ["", _title("Examples")]
    for command, what in job.examples:
        lines += [f"  {command}", f"      {what}"]
    return "\n".join(lines) + "\n"


def _usage(option: Option) -> str:
    name = option.value_name
    return {
        Many.MAYBE: f"[{name}]", Many.ANY: f"[{name} …]", Many.SOME: f"{name} …", Many.TWO: f"{name} {name}",
    }.get(option.many, name)  # fmt: skip


def _signature(option: Option) -> str:
    return " ".join(filter(None, (option.flag, _value(option))))


def _value(option: Option) -> str:
    name = option.value_name or ("|".join(option.kind.words) if isinstance(option.kind, Choice) else "")
    if option.many is Many.LIST:
        return f"{name} …"
    return f"[{name}]" if option.many in (Many.MAYBE, Many.BARE) and not name.startswith("[") else name


def _explained(option: Option) -> str:
    required = " (required)" if option.required or option.either.endswith("!") else ""
    return f"{option.help}{required}"


def _entry(name: str, text: str, width: int = _WIDTH) -> Iterator[str]:
    """Yield a name, and what it is, in two columns."""
    wide = min(shutil.get_terminal_size().columns, _MOST)
    lines = textwrap.wrap(text, max(wide - width, 30), break_on_hyphens=False)
    if len(name) + 3 > width:
        yield f"  {name}"
    else:
        first, *lines = lines or [""]
        yield f"  {name:<{width - 2}}{first}".rstrip()
    yield from (" " * width + line for line in lines)


def _title(text: str) -> str:
    return painted(text, "title", sys.stdout)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + "."
