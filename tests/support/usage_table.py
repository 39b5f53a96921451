"""Help texts, and messages of wrong arguments, of every command: ``python -m tests.support.usage_table`` writes them.

The files are frozen: whoever changes a word of them does it on purpose, and the change shows in the diff.
"""

import io
import json
import os
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from itertools import groupby
from pathlib import Path
from typing import Final

from tests.support.locations import GOLDEN
from trunnion.cli.command_line.parser import parse
from trunnion.jobs.job import Job
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import Choice, FileIn, FileOut, Setting, Switch, Text
from trunnion.options.option import Many, Option

HELPS: Final = GOLDEN / "usage" / "helps.txt"
MESSAGES: Final = GOLDEN / "usage" / "messages.json"

#: Columns of the terminal for which texts are wrapped.
_COLUMNS: Final = "100"


def helps() -> str:
    """``--help`` of the command line and of all commands."""
    return "\n".join(f"$ trunnion {' '.join(words)}\n{_ended(words)[1]}" for words in _help_lines())


def messages() -> dict[str, list[object]]:
    """Exit code and stderr of command lines that cannot be understood."""
    told = {" ".join(words): _ended(words) for words in _wrong_lines()}
    return {line: [code, text] for line, (code, text) in told.items()}


def _help_lines() -> Iterator[list[str]]:
    yield ["--help"]
    for name in JOBS:
        yield [name, "--help"]


def _wrong_lines() -> Iterator[list[str]]:
    yield []
    yield ["psot", "a.cls"]
    yield ["--nonsense"]
    for job in JOBS.values():
        good = good_line(job)
        if good != [job.name]:
            yield [job.name]
        for _, options in groupby(sorted(filter(_is_either, job.flags), key=_either), _either):
            one, *others = ([each.flag, *values(each)] for each in options)
            for other in others:
                yield [*good, *one, *other]
        yield [*good, "--nonsense"]
        yield [*good, "one", "too", "many"]
        for each in job.flags:
            if isinstance(each.kind, Switch):
                yield [*good, f"{each.flag}=x"]
                continue
            yield [*good, each.flag]
            if not isinstance(each.kind, Text | FileIn | FileOut):
                yield [*good, each.flag, "x"]
            yield from ([*good, alias, *values(each)] for alias in each.aliases)


def _is_either(option: Option) -> bool:
    return bool(option.either)


def _either(option: Option) -> str:
    return option.either


def good_line(job: Job) -> list[str]:
    """A line that the parser takes, as short as can be."""
    found = [job.name]
    for each in job.arguments:
        if each.many not in (Many.MAYBE, Many.ANY):
            found += values(each)
    for each in job.flags:
        if each.required:
            found += [each.flag, *values(each)]
    chosen = next((each for each in job.flags if each.either.endswith("!")), None)
    found += [] if chosen is None else [chosen.flag, *values(chosen)]
    return [*found, "--machine", "yl569"] if job.name == "post" else found


def values(option: Option) -> list[str]:
    """Values that an option takes."""
    if isinstance(option.kind, Switch):
        return []
    kind = option.kind
    value = kind.words[0] if isinstance(kind, Choice) else "title=A" if isinstance(kind, Setting) else "1"
    return [value] * (2 if option.many is Many.TWO else 1)


def _ended(words: list[str]) -> tuple[int, str]:
    """How parsing ends the process, and what it prints; 0 and nothing where it does not."""
    shown, before = io.StringIO(), os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = _COLUMNS
    try:
        with redirect_stdout(shown), redirect_stderr(shown):
            parse(words)
    except SystemExit as stop:
        return int(stop.code or 0), shown.getvalue()
    finally:
        os.environ.pop("COLUMNS") if before is None else os.environ.update(COLUMNS=before)
    return 0, shown.getvalue()


def write() -> None:
    """Write both files."""
    HELPS.parent.mkdir(exist_ok=True)
    HELPS.write_text(helps(), encoding="utf-8")
    Path(MESSAGES).write_text(json.dumps(messages(), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write()
