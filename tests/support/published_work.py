"""The page of what published works do, made of its data; run as a module, this writes it."""

import shlex
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from tests.support.locations import DOCS

PAGE: Final = DOCS / "published-work.md"
ROWS: Final = DOCS / "published-work.toml"

_HEAD: Final = """# What published works do, and where it is here

Five published works on five-axis post-processing are what Trunnion was measured by: their machines, controls, checks
and the impeller that was cut. A row is a thing that one of them does, with the page that explains it and a command that
shows it. The tests run every command, in the checkout, and look for a text in what most of them print or write. Rows
that are out say why. The list follows what these works say of machines, controls, checks, impeller and twin; it is not
a list of all their sentences.
"""


@dataclass(frozen=True, slots=True)
class Row:
    """One thing that a published work does."""

    can: str
    where: str = ""
    command: str = ""
    prints: str = ""
    holds: tuple[str, ...] = ()
    why: str = ""
    nightly: bool = False

    @property
    def words(self) -> list[str]:
        """The command without its first word."""
        return shlex.split(self.command)[1:]


def groups() -> dict[str, tuple[Row, ...]]:
    """The rows by their groups."""
    data: dict[str, Any] = tomllib.loads(ROWS.read_text(encoding="utf-8"))
    return {group["title"]: tuple(Row(**row) for row in group["rows"]) for group in data["group"]}


def page() -> str:
    """The page of the docs."""
    found = groups()
    count = sum(map(len, found.values()))
    out = sum(bool(row.why) for rows in found.values() for row in rows)
    text = f"{_HEAD}\n{count} rows: {count - out} work, {out} are out.\n"
    for title, rows in found.items():
        text += f"\n## {title}\n\n" + "\n".join(_table(rows)) + "\n"
    return text


def _table(rows: tuple[Row, ...]) -> Iterator[str]:
    if rows[0].why:
        yield from ("| what | why it is out |", "| --- | --- |")
        yield from (f"| {row.can} | {row.why} |" for row in rows)
        return
    yield from ("| what | page | command |", "| --- | --- | --- |")
    for row in rows:
        command = row.command.replace("|", "\\|")
        name = row.where.removesuffix(".md").rpartition("/")[2].replace("-", " ")
        yield f"| {row.can} | [{name}]({row.where}) | `{command}` |"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
