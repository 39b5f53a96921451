"""``--help``: of the command line, with its commands in groups, and of each command, with examples."""

import shutil
import sys
from collections.abc import Iterator
from itertools import groupby
from typing import Final

from trunnion.cli.columns import columns_of, padded, wrapped
from trunnion.cli.command_line.language import LANGUAGE, spoken_language
from trunnion.cli.terminal_text import painted
from trunnion.jobs.job import Job
from trunnion.jobs.registry import GROUPS, JOBS
from trunnion.messages import LANGUAGES, LIBRARY, filled_in, said_in
from trunnion.options.kinds import Choice
from trunnion.options.option import Many, Option

#: Columns of what is explained, and the most that lines have.
_WIDTH: Final = 24
_MOST: Final = 120


def overview() -> str:
    """All commands, by what they are for."""
    lines, longest = [f"{_word('usage')} trunnion COMMAND …", "", _word("about")], max(map(len, JOBS))
    for title, jobs in GROUPS.items():
        lines += ["", _title(_said("groups", title, english=title))]
        for job in jobs:
            lines += _entry(job.name, title_of(job), longest + 4)
    lines += [
        "",
        _word("more"),
        _word("version"),
        "",
        *_entry(f"{LANGUAGE} {'|'.join(LANGUAGES)}", _word("language"), 27),
    ]
    return "\n".join(lines) + "\n"


def command_help(job: Job) -> str:
    """How a command is called, what it takes, and two examples."""
    words = [*map(_usage, job.arguments), *_needed(job)]
    lines = [
        f"{_word('usage')} trunnion {job.name} {' '.join([*words, '[OPTIONS]'] if job.flags else words)}",
        "",
        _sentence(title_of(job)),
    ]
    lines += ["", _title(_word("arguments"))] if job.arguments else []
    for each in job.arguments:
        lines += _entry(each.value_name, help_of(each, job))
    for heading, options in groupby(sorted(job.flags, key=lambda each: each.heading != ""), lambda each: each.heading):
        about = _said("headings", heading, english=heading)
        lines += ["", _title(_word("options_about", heading=about) if heading else _word("options"))]
        for each in options:
            lines += _entry(signature(each), _explained(each, job))
        if not heading:
            lines += _entry(f"{LANGUAGE} {'|'.join(LANGUAGES)}", _word("language"))
    lines += ["", _title(_word("examples"))]
    for number, (command, what) in enumerate(job.examples, 1):
        lines += [f"  {command}", f"      {_said('command', job.name, f'example_{number}', english=what)}"]
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
    said = help_of(option, job)
    if option.required:
        return _word("required", help=said)
    if option.either.endswith("!"):
        return _word("this_or", help=said, others=tuple(others))
    if option.default in (None, ""):
        return said
    value = f"{option.default:g}" if isinstance(option.default, int | float) else option.default
    return _word("default", help=said, value=value)


def title_of(job: Job) -> str:
    """Return what a command does, in a few words."""
    return _said("command", job.name, "title", english=job.title)


def help_of(option: Option, job: Job) -> str:
    """Return what an option of a command is."""
    of_all = _said("options", option.name, english=option.help)
    return _said("command", job.name, "options", option.name, english=of_all)


def _said(*path: str, english: str) -> str:
    return said_in(spoken_language(), "help", *path, english=english)


def _word(name: str, **parameters: object) -> str:
    text = said_in(spoken_language(), "help", "words", name)
    return filled_in(text, LIBRARY, parameters)


def _entry(name: str, text: str, width: int = _WIDTH) -> Iterator[str]:
    """Yield a name, and what it is, in two columns."""
    wide = min(shutil.get_terminal_size().columns, _MOST)
    lines = wrapped(text, max(wide - width, 30))
    if columns_of(name) + 4 > width:
        yield f"  {name}"
    else:
        first, *lines = lines or [""]
        yield f"  {padded(name, width - 2)}{first}".rstrip()
    yield from (" " * width + line for line in lines)


def _title(text: str) -> str:
    return painted(text, "title", sys.stdout)


def _sentence(text: str) -> str:
    return _word("sentence", text=text[:1].upper() + text[1:])
