"""Kinds of values: how a text becomes one, which of them can be, and what to write instead.

Each kind has one message, whichever front it is read by: ``parse`` takes a text, ``check`` a value that is no text.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from trunnion.wording import nearest_word

#: Lengths, widths and factors are below this.
GREATEST: Final = 1e6


class WrongValueError(ValueError):
    """A value that cannot be, with what to write instead."""


@dataclass(frozen=True, slots=True)
class Text:
    """Any text; the function that takes it knows what it may be.

    example  of one, for messages about a file that states it
    """

    metavar: str = "TEXT"
    example: str = ""

    def parse(self, text: str) -> Any:
        """Return the value of a text."""
        return text

    def check(self, value: object) -> Any:
        """Return the value itself."""
        return value


@dataclass(frozen=True, slots=True)
class Point(Text):
    """Three numbers with commas, in files a list of them; the function that takes it judges the text."""


@dataclass(frozen=True, slots=True)
class Measure(Text):
    """One number; the function that takes it judges the text, and knows what stands for none.

    above, least, most  bounds in files, which state it as a number
    is_whole            it has no decimals
    """

    above: float | None = None
    least: int | None = None
    most: float | None = None
    is_whole: bool = False


@dataclass(frozen=True, slots=True)
class Number:
    """A number between bounds.

    what   ``a tolerance``
    how    what to write, after "write": ``a number above 0, such as 0.001``
    above  a bound that it may not have; ``least`` and ``most`` are bounds that it may have
    words  texts that stand for a value of their own
    """

    metavar: str
    what: str
    how: str
    above: float = -math.inf
    below: float = math.inf
    least: float = -math.inf
    most: float = math.inf
    is_whole: bool = False
    words: Mapping[str, Any] = field(default_factory=dict)

    def parse(self, text: str) -> Any:
        """Return the number of a text."""
        if text in self.words:
            return self.words[text]
        if self.is_whole and not (text.isascii() and text.isdigit() and len(text) < 10):
            raise self._error(text)
        try:
            return self.check(int(text) if self.is_whole else float(text))
        except ValueError:
            raise self._error(text) from None

    def check(self, value: object) -> Any:
        """Return the number itself; raises ``WrongValueError`` if it is none, or out of bounds."""
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise self._error(value)
        if self._is_bounded and not (self.above < value < self.below and self.least <= value <= self.most):
            raise self._error(value)
        return value

    @property
    def _is_bounded(self) -> bool:
        """Whether it has bounds here; of others the function that takes them knows the range."""
        return any(map(math.isfinite, (self.above, self.below, self.least, self.most)))

    def _error(self, value: object) -> WrongValueError:
        return WrongValueError(f"{value!r} is not {self.what}; write {self.how}")


def length(what: str, such_as: str, metavar: str = "MM") -> Number:
    """Return the kind of lengths, and other numbers, above 0."""
    how = f"a number above 0 and below {GREATEST:.0f}, such as {such_as}"
    return Number(metavar, what, how, above=0.0, below=GREATEST)


def angle(what: str, least: float, most: float, such_as: str) -> Number:
    """Return the kind of angles between bounds, degrees."""
    return Number("DEG", what, f"degrees, {least:g} to {most:g}, such as {such_as}", least=least, most=most)


def seconds(most: float, metavar: str = "SECONDS") -> Number:
    """Return the kind of times above 0, s."""
    return Number(metavar, "a time", "seconds above 0, such as 600", above=0.0, most=most)


def whole(what: str, how: str, metavar: str, least: int = 0, most: float = math.inf) -> Number:
    """Return the kind of whole numbers."""
    return Number(metavar, what, how, least=least, most=most, is_whole=True)


@dataclass(frozen=True, slots=True)
class Choice:
    """One of some words."""

    words: tuple[str, ...]
    metavar: str = ""

    def parse(self, text: str) -> Any:
        """Return the word itself."""
        return self.check(text)

    def check(self, value: object) -> Any:
        """Return the word itself; raises ``WrongValueError`` if it is none of them."""
        if value in self.words:
            return value
        *others, last = self.words
        near = nearest_word(str(value), self.words)
        asked = f'did you mean "{near}"? ' if near else ""
        listed = f"{', '.join(others)} or {last}" if others else last
        raise WrongValueError(f"{value!r} is unknown; {asked}write {listed}")


@dataclass(frozen=True, slots=True)
class Switch:
    """On if it is there.

    value  what it then is
    """

    value: bool = True
    metavar: str = ""

    def parse(self, text: str) -> Any:  # a switch has no text
        """Return what it is where it is there."""
        return self.value

    def check(self, value: object) -> Any:
        """Return the value, if it is on or off."""
        if not isinstance(value, bool):
            raise WrongValueError(f"{value!r} is not a switch; write True or False")
        return value


@dataclass(frozen=True, slots=True)
class Setting:
    """A setting, ``KEY=VALUE``."""

    metavar: str = "KEY=VALUE"

    def parse(self, text: str) -> Any:
        """Key and value of a text."""
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise WrongValueError(f"{text!r} is not a setting; write KEY=VALUE")
        return key, value

    def check(self, value: object) -> Any:
        """Return the value itself; the library judges settings."""
        return value


#: Bytes that the name of a file has on no system.
_TOO_LONG: Final = 256


def _file_name(text: str) -> str:
    """Return the name of a file, unless there can be none of that name."""
    if not text:
        raise WrongValueError("'' names no file; write its path")
    if any(len(part.encode("utf-8", "replace")) >= _TOO_LONG for part in re.split(r"[/\\]", text)):
        raise WrongValueError(f"{text[:40]!r}… is longer than the name of a file can be; write a shorter one")
    return text


@dataclass(frozen=True, slots=True)
class FileIn:
    """A file that is read.

    leads  to which other files it may lead: ``machine``, ``library``, ``project``, ``stock``, ... of ``jobs.guard``
    stdin  whether ``-`` is stdin
    """

    metavar: str = "FILE"
    leads: str = ""
    stdin: bool = False

    def parse(self, text: str) -> Any:
        """Its name."""
        return _file_name(text)

    def check(self, value: object) -> Any:
        """Return the name itself; the library judges whether it can be read."""
        return value


@dataclass(frozen=True, slots=True)
class FileOut:
    """A file that is written.

    endings  of its name, one of which it has; empty: any
    why      the name ends so
    form     what is written, where others know its endings: ``mesh``; empty: ``endings`` says it
    stdout   whether ``-`` is stdout
    folder   whether it may be a folder, which takes files of other names
    """

    metavar: str = "FILE"
    endings: Sequence[str] = ()
    why: str = ""
    form: str = ""
    stdout: bool = False
    folder: bool = False

    def parse(self, text: str) -> Any:
        """Its name."""
        return _file_name(text)

    def check(self, value: object) -> Any:
        """Return the name itself; ``jobs.guard`` judges whether it can be written."""
        return value


Kind = Text | Number | Choice | Switch | Setting | FileIn | FileOut
