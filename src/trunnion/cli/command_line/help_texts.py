"""``--help``: of the command line, with its commands in groups, and of each command, with examples."""

import shutil
import sys
import textwrap
from collections.abc import Iterator
from itertools import groupby
from typing import Final

from trunnion.cli.terminal_text import painted
from trunnion.jobs.job import Job
from trunnion.jobs.registry import GROUPS, JOBS
from trunnion.options.kinds import Choice
from trunnion.options.option import Many, Option

_ABOUT: Final = "CL files to proven NC programs for five-axis machine tools."

#: Columns of what is explained, and the most that lines have.
_WIDTH: Final = 24
_MOST: Final = 120


def overview() -> str:
    """All commands, by what they are for."""
    lines, longest = ["usage: trunnion COMMAND …", "", _ABOUT], max(map(len, JOBS))
    for title, jobs in GROUPS.items():
        lines += ["", _title(title)]
        for job in jobs:
            lines += _entry(job.name, job.title, longest + 4)
    lines += [
        "",
        "trunnion COMMAND --help explains a command with examples, trunnion explain CODE a message;",
        "trunnion --version prints the version.",
    ]
    return "\n".join(lines) + "\n"


def command_help(job: Job) -> str:
    """How a command is called, what it takes, and two examples."""
    words = [*map(_usage, job.arguments), *_needed(job)]
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
            lines += _entry(signature(each), _explained(each, job))
    lines += ["", _title("Examples")]
    for command, what in job.examples:
        lines += [f"  {command}", f"      {what}"]
    return "\n".join(lines) + "\n"


def _usage(option: Option) -> str:
    name = option.value_name
    return {
        Many.MAYBE: f"[{name}]", Many.ANY: f"[{name} …]", Many.SOME: f"{name} …", Many.TWO: f"{name} {name}",
    }.get(option.many, name)  # fmt: skip


def _needed(job: Job) -> Iterator[str]:
    """Yield the options that must be given, and those of which one must be."""
    yield from (signature(each) for each in job.flags if each.required)
    for group in dict.fromkeys(each.either for each in job.flags if each.either.endswith("!")):
        yield f"({' | '.join(signature(each) for each in job.flags if each.either == group)})"


def signature(option: Option) -> str:
    """Return how an option is written, with what stands for its value."""
    return " ".join(filter(None, (option.flag, _value(option))))


def _value(option: Option) -> str:
    name = option.value_name or ("|".join(option.kind.words) if isinstance(option.kind, Choice) else "")
    if option.many is Many.LIST:
        return f"{name} …"
    return f"[{name}]" if option.many is Many.MAYBE and not name.startswith("[") else name


def _explained(option: Option, job: Job) -> str:
    """Return what an option is, what it is where it is not given, and whether it must be."""
    others = [each.flag for each in job.flags if each.either == option.either and each is not option]
    if option.required:
        return f"{option.help} (required)"
    if option.either.endswith("!"):
        return f"{option.help} (this or {' or '.join(others)} is required)"
    return option.explained


def _entry(name: str, text: str, width: int = _WIDTH) -> Iterator[str]:
    """Yield a name, and what it is, in two columns."""
    wide = min(shutil.get_terminal_size().columns, _MOST)
    lines = textwrap.wrap(text, max(wide - width, 30), break_on_hyphens=False)
    if len(name) + 4 > width:
        yield f"  {name}"
    else:
        first, *lines = lines or [""]
        yield f"  {name:<{width - 2}}{first}".rstrip()
    yield from (" " * width + line for line in lines)


def _title(text: str) -> str:
    return painted(text, "title", sys.stdout)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + "."
