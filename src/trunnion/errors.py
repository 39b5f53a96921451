"""Problems, and the exceptions that carry them.

    TrunnionError            carries every Problem found, never only the first
    ├── InputError           a file, a definition or a command cannot be used           (exit 2)
    └── RefusedError         the input is understood, but its program must not run      (exit 1)

A Problem prints as ``file:line: error: what is wrong; how to correct it [CODE]``, from which editors and
CI systems jump to the line. ``trunnion.explanations`` knows what each code means.
"""

import re
import stat
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from enum import StrEnum
from itertools import chain
from pathlib import Path
from typing import Final

from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.records import dataclass
from trunnion.wording import one_line


class Severity(StrEnum):
    """Whether a problem stops the work."""

    WARNING = "warning"
    ERROR = "error"

    def said(self, words: Words = LIBRARY) -> str:
        """Return it as it is read."""
        return Wording("terminal", "error" if self is Severity.ERROR else "warning").text("what", words)


class SubjectKind(StrEnum):
    """What a problem may be with, if not with its file as a whole."""

    ARGUMENT = "argument"
    SETTING = "setting"
    KEY = "key"


@dataclass(frozen=True, slots=True)
class Subject:
    """What a problem is with, such as the argument ``tolerance``, which every front calls as its user knows it."""

    kind: SubjectKind
    name: str


def key_subject(path: str) -> Subject:
    """Return the key of a definition as what a problem is with."""
    return Subject(SubjectKind.KEY, path)


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong, its location, and how to correct it.

    file      the file, or the argument of the library
    line      counts from 1; 0 if the problem concerns the file as a whole
    wording   what is said, as data; ``what`` and ``cure`` are its English, ``code`` its kind, such as ``CL110``
    severity  whether it stops the work
    subject   what it is with: an argument, a setting, or the key of a definition; None: the file
    """

    file: str
    line: int
    wording: Wording
    severity: Severity = Severity.ERROR
    subject: Subject | None = None

    @property
    def what(self) -> str:
        """The fault."""
        return self.wording.what

    @property
    def cure(self) -> str:
        """How to correct it; may be empty."""
        return self.wording.cure

    @property
    def code(self) -> str:
        """Of what kind it is, such as ``CL110``: stays the same while messages change."""
        return self.wording.code

    @property
    def key(self) -> str:
        """The key of a definition, from its root, such as ``axis[1].limits_deg``; empty elsewhere."""
        return self._subject_of(SubjectKind.KEY)

    @property
    def argument(self) -> str:
        """The argument of the library that it is with; empty elsewhere."""
        is_argument = self.subject is not None and self.subject.kind in (SubjectKind.ARGUMENT, SubjectKind.SETTING)
        return self.file if is_argument else ""

    @property
    def setting(self) -> str:
        """The setting that it is with; empty elsewhere."""
        return self._subject_of(SubjectKind.SETTING)

    def _subject_of(self, kind: SubjectKind) -> str:
        return self.subject.name if self.subject is not None and self.subject.kind is kind else ""

    def __str__(self) -> str:
        """Return ``file:line: severity: what; cure [code]``."""
        return self.line_of_text()

    @property
    def said(self) -> Wording:
        """Its line as a wording, which can stand in others."""
        place = f"{self.file}:{self.line}" if self.line else self.file
        severity = Wording("terminal", "error" if self.severity is Severity.ERROR else "warning")
        parts = {"place": place, "severity": severity, "said": self.wording.with_cure()}
        return phrase("problem_with_code", code=self.code, **parts) if self.code else phrase("problem_at", **parts)

    def line_of_text(self, words: Words = LIBRARY, called: str = "") -> str:
        """Return what ``str`` does in the words of a front, which may call the file otherwise."""
        place = called or self.file
        place = f"{place}:{self.line}" if self.line else place
        what, cure = self.wording.text("what", words), self.wording.text("cure", words)
        said = Wording("terminal", "with_cure", what=what, cure=cure).text("what", words) if cure else what
        code = f" [{self.code}]" if self.code else ""
        return one_line(f"{place}: {self.severity.said(words)}: {said}{code}")


def warning(file: str, line: int, wording: Wording, *, subject: Subject | None = None) -> Problem:
    """Return a problem that does not stop the work."""
    return Problem(file, line, wording, Severity.WARNING, subject)


def merge_repeated(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Problems that differ only in their lines become one: at the first line, with their number.

    Those of different operations stay apart: each may want a setting of its own.
    """
    alike: dict[tuple[object, ...], list[Problem]] = {}
    for problem in problems:
        operation = problem.wording.parameter("operation")
        alike.setdefault((problem.file, operation, problem.what, problem.cure, problem.severity), []).append(problem)
    return tuple(
        same[0] if len(same) == 1 else replace(same[0], wording=same[0].wording.within("repeated", count=len(same)))
        for same in alike.values()
    )


#: Parameters that are what a message is about: a word or a code, or what is called. Variables are one kind.
_WORDS: Final = frozenset({"word", "code", "words", "call", "label", "letter", "extension", "function", "cycle"})

#: The value of a word that is no code: ``X12.5``; and what stands behind the name of a word: ``FL [ X ] = 9``.
_VALUE: Final = re.compile(r"(?<=^[A-FH-LN-Z])[ =]*[-+.0-9].*$|(?<=[A-Z0-9_])[ ]*[=(\[].*$")


def kind_of(wording: Wording) -> tuple[str, ...]:
    """Return of what kind a message is: its code and variant, with those of the wordings that are filled in."""
    parts = (kind_of(value) for _, value in wording.parameters if isinstance(value, Wording))
    return tuple(chain((wording.code, wording.variant), *parts))


def mistake_of(wording: Wording) -> tuple[str, ...]:
    """Return which mistake a message is about: its kind and its words, as another G code is another mistake."""
    return (*kind_of(wording), *_words_of(wording))


def _words_of(wording: Wording) -> tuple[str, ...]:
    """Return the words that a message is about, without their values."""
    inner = (_words_of(value) for _, value in wording.parameters if isinstance(value, Wording))
    own = [_VALUE.sub("", str(value).upper()) for name, value in wording.parameters if name in _WORDS]
    return tuple(chain(own, *inner))


def first_of_kinds(problems: Sequence[Problem], most: int) -> tuple[list[Problem], int]:
    """Where more than ``most`` lines have errors, keep the first error of each kind, with the number of its kind.

    Errors of a file as a whole, and all that is no error, stay as they are. Kinds are those of one file
    (``mistake_of``).

    Returns the problems, with ``most`` kinds of errors at most, and the number of errors of the kinds left out.
    """
    in_lines = [problem for problem in problems if problem.severity is Severity.ERROR and problem.line > 0]
    if len(in_lines) <= most:
        return list(problems), 0
    firsts, counts = dict[tuple[str, tuple[str, ...]], Problem](), Counter[tuple[str, tuple[str, ...]]]()
    for problem in in_lines:
        kind = problem.file, mistake_of(problem.wording)
        firsts.setdefault(kind, problem)
        counts[kind] += 1
    named = list(firsts.items())[:most]
    said = {
        id(first): first if counts[kind] == 1 else replace(first, wording=_first_of(first.wording, counts[kind]))
        for kind, first in named
    }
    grouped = set(map(id, in_lines))
    found = [said.get(id(each), each) for each in problems if id(each) in said or id(each) not in grouped]
    return found, len(in_lines) - sum(counts[kind] for kind, _ in named)


def _first_of(wording: Wording, count: int) -> Wording:
    return wording.within("first_of_kind", count=count)


def argument_problem(name: str, wording: Wording, severity: Severity = Severity.ERROR) -> Problem:
    """Return a problem with an argument of a function of the library."""
    return Problem(name, 0, wording, severity, Subject(SubjectKind.ARGUMENT, name))


def setting_problem(name: str, wording: Wording) -> Problem:
    """Return a problem with a setting; a project states it at a key of its own."""
    return Problem("settings", 0, wording.of_key(name), subject=Subject(SubjectKind.SETTING, name))


def unusable_file(path: Path, what: Wording) -> Problem | None:
    """Return why a path is no file that can be read; None if it may be one. ``what`` is meant: ``an NC program``."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:  # also names that no system allows
        is_missing = isinstance(error, FileNotFoundError | NotADirectoryError)
        reason = getattr(error, "strerror", None) or error
        if is_missing:
            return Problem(str(path), 0, Wording("FIL110", "file_not_found", subject=what))
        return Problem(str(path), 0, Wording("FIL120", "cannot_read", reason=reason, subject=what))
    if stat.S_ISDIR(mode):
        return Problem(str(path), 0, Wording("FIL130", "folder_not", subject=what))
    return None if stat.S_ISREG(mode) else Problem(str(path), 0, Wording("FIL130", "not_regular_file", subject=what))


class TrunnionError(Exception):
    """Base of all errors that Trunnion raises on purpose.

    problems  everything that is wrong
    """

    def __init__(self, problems: Problem | Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))


class InputError(TrunnionError):
    """A file, a definition or a command cannot be used."""


class MissingExtraError(InputError):
    """An optional package is not installed: nothing can be said of what was to be tried with it."""


class RefusedError(TrunnionError):
    """The input is understood, but the program that it asks for must not run."""
