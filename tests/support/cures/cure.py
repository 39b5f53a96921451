"""What a cure is tried with, what draws its message, and what it ends in."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import trunnion
from trunnion.errors import Problem, TrunnionError
from trunnion.explanations import explanations
from trunnion.jobs.observer import Observer
from trunnion.messages import Wording, foreign

#: Text in place of another one, or settings; None: one that is left out.
Change: TypeAlias = tuple[str, str] | Mapping[str, str | None]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a run says, and whether it ended well; a code whose explanation alone has a cure counts without variant."""

    problems: tuple[Problem, ...]
    is_sound: bool

    @property
    def said(self) -> set[tuple[str, str]]:
        """Codes and variants of all that was said, with what is filled in."""
        found = {(each.code, each.variant) for problem in self.problems for each in _with_parts(problem.wording)}
        return found | {(code, "") for code, _ in found}

    def cures(self, code: str, variant: str) -> list[str]:
        """The cures of a message, as said or as its explanation has them, with the settings or arguments concerned."""
        if not variant:
            return [explanations()[code].cure]
        return [
            f"{problem.subject.name if problem.subject else ''}: {each.cure}"
            for problem in self.problems
            for each in _with_parts(problem.wording)
            if (each.code, each.variant) == (code, variant)
        ]


#: Runs a text in a folder with settings.
Trial: TypeAlias = Callable[[str, Mapping[str, str], Path], Outcome]


@dataclass(frozen=True, slots=True)
class Cure:
    """A message, and what its cure changes.

    code, variant   of the message
    trial           how it is tried
    text            the smallest input that draws it
    changes         what its cure changes, in text or settings
    settings        with which it is drawn
    refuses         the cure promises a refusal
    cured_by        what the cure wants done in place of the trial; None: the same again
    stays           the cure has something looked at, and nothing changed: the input ends well as it is
    """

    code: str
    variant: str
    trial: Trial
    text: str
    changes: tuple[Change, ...]
    settings: Mapping[str, str] = field(default_factory=dict)
    refuses: bool = False
    cured_by: Trial | None = None
    stays: bool = False

    def faults(self, folder: Path) -> Iterator[str]:
        """What is wrong with the cure; nothing where it does what it says."""
        message = self.code, self.variant
        before = self.trial(self.text, self.settings, folder)
        if message not in before.said:
            yield f"{self.code} {self.variant} is not drawn: {sorted(before.said)} {before.problems}"
            return
        said = " / ".join(before.cures(*message))
        if self.stays:
            if not before.is_sound or self.changes:
                yield f"{self.code} {self.variant} does not end well as it is: {said} {before.problems}"
            return
        text, settings = self.text, dict(self.settings)
        for change in self.changes:
            if isinstance(change, tuple):
                if change[0] not in text:
                    yield f"{self.code} {self.variant}: {change[0]!r} is not in the text"
                text = text.replace(*change)
            else:
                settings = {key: value for key, value in {**settings, **change}.items() if value is not None}
                for name in change:
                    if name not in said:
                        yield f"{self.code} {self.variant}: the cure does not name {name}: {said}"
        after = (self.cured_by or self.trial)(text, settings, folder)
        if message in after.said:
            yield f"{self.code} {self.variant} is drawn still: {said}"
        if after.is_sound == self.refuses:
            rest = "; ".join(map(str, after.problems))
            yield f"{self.code} {self.variant} ends {'well' if after.is_sound else 'badly'}: {said}\n    {rest}"


def marked(message: str, trial: Trial, *lines: str, head: str = "", foot: str = "", **settings: str) -> Cure:
    """Return the cure of a message, "CODE VARIANT", by lines between a head and a foot.

    A line that begins with "- " goes out, one that begins with "+ " comes in; the others stand in both texts. Where
    there are no such lines, the cure has nothing changed.
    """
    code, _, variant = message.partition(" ")
    wrong, cured = (
        "".join((head, *(f"{line.removeprefix(own)}\n" for line in lines if not line.startswith(other)), foot))
        for own, other in (("- ", "+ "), ("+ ", "- "))
    )
    changes = ((wrong, cured),) if wrong != cured else ()
    return Cure(code, variant, trial, wrong, changes, settings, stays=not changes)


def read(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a CL file; settings are those of the reading."""
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    try:
        found = trunnion.read_cl(file, **settings)  # type: ignore[arg-type]
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome(tuple(found.remarks), True)


class _Hearing(Observer):
    def __init__(self) -> None:
        self.found: list[Problem] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.found += problems


def post(machine: str = "yl569") -> Trial:
    """Return what posts a CL file for a machine."""

    def posted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file, heard = folder / "part.cls", _Hearing()
        file.write_text(text, encoding="utf-8")
        try:
            result = trunnion.post(file, machine=machine, settings=settings, observer=heard)
        except TrunnionError as error:
            return Outcome((*heard.found, *error.problems), False)
        return Outcome((*heard.found, *result.problems), result.passed)

    return posted


def verify(machine: str = "yl569") -> Trial:
    """Return what verifies a program on a machine; settings are its arguments."""

    def verified(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file, heard = folder / "part.mpf", _Hearing()
        file.write_text(text, encoding="utf-8")
        try:
            found = trunnion.verify(file, machine=machine, observer=heard, **settings)  # type: ignore[arg-type]
        except TrunnionError as error:
            return Outcome((*heard.found, *error.problems), False)
        noted = [Problem(str(file), each.line, each.wording, each.severity) for each in found.run.diagnostics]
        failed = [Problem(str(file), 0, foreign(each.title, code=each.key)) for each in found.checks if not each.passed]
        return Outcome((*heard.found, *noted, *failed), found.passed)

    return verified


def define(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Load the definition of a machine; it has no settings."""
    file = folder / "ours.toml"
    file.write_text(text, encoding="utf-8")
    try:
        trunnion.describe_machine(file)
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome((), True)


def messages(cures: Iterable[Cure]) -> set[tuple[str, str]]:
    """Codes and variants of cures."""
    return {(each.code, each.variant) for each in cures}


def _with_parts(wording: Wording) -> Iterator[Wording]:
    yield wording
    for _, value in wording.parameters:
        if isinstance(value, Wording):
            yield from _with_parts(value)
