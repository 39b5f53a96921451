"""Warnings as a report has them: each thing once, with how often it was said.

In:     the problems that a job told.
Out:    groups, in the order in which they were first told.

Text from outside is cleaned here of characters that no file can hold.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

from trunnion.errors import Problem
from trunnion.messages import LIBRARY, Part, Wording, Words, phrase
from trunnion.records import dataclass
from trunnion.reporting.text import clean
from trunnion.results import NOT_DATA, OptionalLine, OptionalText, to_data


@dataclass(frozen=True, slots=True)
class RemarkGroup:
    """What was told ``count`` times, with text and place of the first time; ``code`` is that of its message."""

    severity: str
    code: OptionalText
    text: str
    cure: OptionalText
    file: OptionalText
    line: OptionalLine
    count: int
    problem: Annotated[Problem, NOT_DATA]

    def said(self, part: Part, words: Words) -> str:
        """Return ``text`` or ``cure`` in the language of who asks."""
        return clean(self.problem.wording.text(part, words))

    def severity_said(self, words: Words) -> str:
        """Return ``severity`` in the language of who asks."""
        return self.problem.severity.said(words)

    def line_in(self, words: Words) -> str:
        """Return it as a line in the language of who asks, as ``Problem`` is printed, with its count."""
        place = f"{self.file}:{self.line}" if self.line else self.file
        texts = tuple(filter(None, (self.said("what", words), self.said("cure", words))))
        what = Wording("terminal", "joined", texts=texts).text("what", words)
        more = phrase("more_like_it", count=self.count - 1).text("what", words) if self.count > 1 else ""
        return f"{place}: {self.severity_said(words)}: {what}{f' [{self.code}]' if self.code else ''}{more}"

    def __str__(self) -> str:
        """Return it as a line in English."""
        return self.line_in(LIBRARY)


def remark_groups(problems: Iterable[Problem]) -> tuple[RemarkGroup, ...]:
    """Return the groups of problems that say the same of several places of a file or tool."""
    return tuple(_group(each) for each in _alike(problems))


def remark_data(problems: Iterable[Problem]) -> list[dict[str, Any]]:
    """Return the first problem of each group as data, with its ``count``."""
    return [{**to_data(each[0]), "count": len(each)} for each in _alike(problems)]


def _alike(problems: Iterable[Problem]) -> Iterable[list[Problem]]:
    groups: dict[tuple[str, str, str, tuple[str, ...]], list[Problem]] = {}
    for problem in problems:
        kind = (str(problem.severity), problem.code, problem.file, _kind(problem.wording))
        groups.setdefault(kind, []).append(problem)
    return groups.values()


def _kind(wording: Wording) -> tuple[str, ...]:
    """Return what is said, whatever it is said of: which text it is, and which texts stand in it."""
    inner = (value for _, value in wording.parameters if isinstance(value, Wording))
    return (wording.variant or wording.what, *(name for each in inner for name in _kind(each)))


def _group(problems: list[Problem]) -> RemarkGroup:
    first = problems[0]
    return RemarkGroup(
        severity=str(first.severity),
        code=first.code,
        text=clean(first.what),
        cure=clean(first.cure),
        file=clean(Path(first.file).name),
        line=first.line,
        count=len(problems),
        problem=first,
    )
