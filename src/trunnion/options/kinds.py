"""Kinds of values: how a text becomes one, which of them can be, and what to write instead.

Each kind has one message, whichever front it is read by: ``parse`` takes a text, ``check`` a value that is no text.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Any, Final

from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.wording import nearest_word

#: Lengths, widths and factors are below this.
GREATEST: Final = 1e6


class WrongValueError(ValueError):
    """A value that cannot be, with what to write instead: a wording of the code ``ARG140``."""

    def __init__(self, wording: Wording) -> None:
        super().__init__(wording)
        self.wording = wording


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
    """Three numbers with commas, in files a list of them; the function that takes it judges the text.

    by_name  files may state a table with several, each under its name
    """

    by_name: bool = False


@dataclass(frozen=True, slots=True)
class Measure(Text):
    """One number; the function that takes it judges the text, and knows what stands for none.

    above, least, most  bounds in files, which state it as a number
    is_whole            it has no decimals
    by_name             files may state a table with several, each under its name
    """

    above: float | None = None
    least: int | None = None
    most: float | None = None
    is_whole: bool = False
    by_name: bool = False


@dataclass(frozen=True, slots=True)
class Number:
    """A number between bounds.

    what   the phrase of what it is: ``a tolerance``
    how    the phrase of what to write: ``a number above 0, such as 0.001``
    above  a bound that it may not have; ``least`` and ``most`` are bounds that it may have
    words  texts that stand for a value of their own
    """

    metavar: str
    what: Wording
    how: Wording
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
        return WrongValueError(Wording("ARG140", "not_of_kind", value=repr(value), kind=self.what, form=self.how))


def length(what: Wording, such_as: str, metavar: str = "MM") -> Number:
    """Return the kind of lengths, and other numbers, above 0."""
    how = phrase("number_above_zero", most=GREATEST, example=such_as)
    return Number(metavar, what, how, above=0.0, below=GREATEST)


def angle(what: Wording, least: float, most: float, such_as: str) -> Number:
    """Return the kind of angles between bounds, degrees."""
    how = phrase("degrees_from_to", least=least, most=most, example=such_as)
    return Number("DEG", what, how, least=least, most=most)


def seconds(most: float, metavar: str = "SECONDS") -> Number:
    """Return the kind of times above 0, s."""
    return Number(metavar, phrase("kind_time"), phrase("seconds_above_zero"), above=0.0, most=most)


def any_number(metavar: str) -> Number:
    """Return the kind of numbers whose range the function knows that takes them."""
    return Number(metavar, phrase("kind_number"), phrase("one_such_as_five"))


def whole(what: Wording, how: Wording, metavar: str, least: int = 0, most: float = math.inf) -> Number:
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
        near = nearest_word(str(value), self.words)
        *others, last = self.words
        wording = Wording("ARG140", "unknown_word", value=repr(value), others=tuple(others), last=last)
        if near:
            wording = Wording("ARG140", "unknown_word_but_near", near=near, **dict(wording.parameters))
        raise WrongValueError(wording)


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
            raise WrongValueError(Wording("ARG140", "no_switch", value=repr(value)))
        return value


@dataclass(frozen=True, slots=True)
class Setting:
    """A setting, ``KEY=VALUE``."""

    metavar: str = "KEY=VALUE"

    def parse(self, text: str) -> Any:
        """Key and value of a text."""
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise WrongValueError(Wording("ARG140", "no_setting", value=repr(text)))
        return key, value

    def check(self, value: object) -> Any:
        """Return the value itself; the library judges settings."""
        return value


#: Bytes that the name of a file has on no system.
_TOO_LONG: Final = 256


def _file_name(text: str) -> str:
    """Return the name of a file, unless there can be none of that name."""
    if not text:
        raise WrongValueError(Wording("ARG140", "no_file_name"))
    if any(len(part.encode("utf-8", "replace")) >= _TOO_LONG for part in re.split(r"[/\\]", text)):
        raise WrongValueError(Wording("ARG140", "file_name_too_long", value=repr(text[:40])))
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
    why      the phrase of why the name ends so
    form     what is written, where others know its endings: ``mesh``; empty: ``endings`` says it
    stdout   whether ``-`` is stdout
    folder   whether it may be a folder, which takes files of other names
    told     whether the command finds out itself what it may replace; ``jobs.replaced_outputs`` does otherwise
    """

    metavar: str = "FILE"
    endings: Sequence[str] = ()
    why: Wording | None = None
    form: str = ""
    stdout: bool = False
    folder: bool = False
    told: bool = False

    def parse(self, text: str) -> Any:
        """Its name."""
        return _file_name(text)

    def ends_so(self, name: str) -> bool:
        """Whether a name has one of the endings, or is that of stdout."""
        return not self.endings or name == "-" or name.lower().endswith(tuple(self.endings))

    def check(self, value: object) -> Any:
        """Return the name itself; ``jobs.guard`` judges whether it can be written."""
        return value


Kind = Text | Number | Choice | Switch | Setting | FileIn | FileOut
