"""The tables of options on the page of the commands, made of the registry; run as a module, this writes them.

What a row says is the line of ``--help``, or what ``docs/options.toml`` says in its place, with links.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Final

from tests.support.locations import DOCS
from trunnion.jobs.job import Job
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import Choice
from trunnion.options.option import Option

PAGE: Final = DOCS / "commands.md"
MEANINGS: Final = DOCS / "options.toml"

_TABLE: Final = re.compile(r"<!-- options of (\w+) -->\n.*?<!-- end of options -->", re.DOTALL)


def meanings() -> dict[str, dict[str, str]]:
    """What the page says of options, by command and option."""
    return tomllib.loads(MEANINGS.read_text(encoding="utf-8"))


def page() -> str:
    """The page with its tables as the registry has them."""
    said = meanings()
    text = PAGE.read_text(encoding="utf-8")
    return _TABLE.sub(lambda found: _table(JOBS[found[1]], said.get(found[1], {})), text)


def _table(job: Job, said: Mapping[str, str]) -> str:
    rows = "\n".join(_rows(job, said))
    return f"<!-- options of {job.name} -->\n\n| argument | meaning |\n| --- | --- |\n{rows}\n\n<!-- end of options -->"


def _rows(job: Job, said: Mapping[str, str]) -> Iterator[str]:
    for option in job.options:
        if said.get(option.name, "").startswith("="):
            continue
        together = [option, *(each for each in job.options if said.get(each.name) == f"={option.name}")]
        meaning = said.get(option.name, option.explained)
        required = ". Required" if option.required else ""
        yield f"| {', '.join(map(_label, together))} | {_cell(meaning)}{required} |"


def _label(option: Option) -> str:
    words = "|".join(option.kind.words) if isinstance(option.kind, Choice) else ""
    return f"`{_cell(' '.join(filter(None, (option.flag, option.value_name or words))))}`"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
