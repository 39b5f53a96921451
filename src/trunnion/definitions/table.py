"""A table of a definition: a typed getter for each kind of value."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple, TypedDict, Unpack, overload

from trunnion.definitions.account import TableAccount
from trunnion.definitions.expected import GREATEST, Expected, Form
from trunnion.definitions.messages import a_number, a_whole_number, as_written, in_quotes, meant_word, unquoted
from trunnion.definitions.numbers import finite, finite_numbers, has_decimal_commas, is_too_large, within
from trunnion.definitions.setting_text import setting_text
from trunnion.definitions.source_lines import LocatedValue
from trunnion.definitions.units import unit_of
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass


class Required:
    """The type of ``REQUIRED``: there is no default, and a missing key is a mistake."""


REQUIRED: Final = Required()

_NO_NAMES: Final[Mapping[str, str]] = MappingProxyType({})


class TextForm(NamedTuple):
    """How a text is written: the phrase that says it, and a regular expression of all of it; empty: any."""

    phrase: Wording | None = None
    pattern: str = ""


_ANY_TEXT: Final = TextForm()


class Bounds(TypedDict, total=False):
    """What a number may be; a key that is absent or None sets no bound."""

    above: float | None
    at_least: float | None
    at_most: float | None


class WholeBounds(TypedDict, total=False):
    """What a whole number may be; a key that is absent or None sets no bound.

    ``nothing`` is a word that stands for the default: it takes away what the definition extends.
    """

    at_least: int | None
    at_most: int | None
    nothing: str


@dataclass(eq=False)
class Table(TableAccount):
    """A TOML table with a getter for each kind of value, which keeps account of the keys that have been read.

    A getter that finds a mistake adds a ``Problem`` to the shared list and returns the default, or an empty value of
    its type, so that reading goes on to the next mistake. ``raise_problems`` raises them all.
    """

    def _get(self, key: str, expected: Expected, allowed: Callable[[], Wording]) -> object | None:
        """Return the value of a key; ``allowed`` makes the phrase of what may be written, which is seldom needed."""
        self.read_keys[key] = None
        self._note(key, expected)
        content = self._values.get(key)
        if content is None:
            if expected.required:
                self.add_problem(key, Wording("DEF310", "missing", allowed=allowed()))
            return None
        return content.value

    def _refuse(self, key: str, value: object, allowed: Wording, numbers: int = 1) -> None:
        """Note a value that cannot be, with a hint where it is a slip that people make."""
        shown = as_written(value)
        if is_too_large(value):
            wording = Wording("DEF330", "too_large", value=shown, allowed=allowed, least=-GREATEST, greatest=GREATEST)
        elif has_decimal_commas(value, numbers):
            wording = Wording("DEF330", "decimal_commas", value=shown, allowed=allowed)
        else:
            wording = Wording("DEF330", "not_allowed", value=shown, allowed=allowed)
        self.add_problem(key, wording)

    @overload
    def text(
        self, key: str, default: str | Required = ..., *,
        one_of: Sequence[str] = ..., other_names: Mapping[str, str] = ..., example: str = ...,
        written: TextForm = ...,
    ) -> str: ...  # fmt: skip
    @overload
    def text(
        self, key: str, default: None, *,
        one_of: Sequence[str] = ..., other_names: Mapping[str, str] = ..., example: str = ...,
        written: TextForm = ...,
    ) -> str | None: ...  # fmt: skip
    def text(
        self,
        key: str,
        default: str | Required | None = REQUIRED,
        *,
        one_of: Sequence[str] = (),
        other_names: Mapping[str, str] = _NO_NAMES,
        example: str = "",
        written: TextForm = _ANY_TEXT,
    ) -> str | None:
        """Return a text; with ``one_of``, one of these words, to which ``other_names`` lead in a message.

        An empty text, or one that is not ``written`` so, is the default; a required one is returned as it is.
        """
        pattern = written.pattern
        fallback = "" if isinstance(default, Required) else default

        def allowed() -> Wording:
            return written.phrase or _a_text(one_of, example)

        required = isinstance(default, Required)
        value = self._get(
            key, Expected(Form.TEXT, required, _told(default), one_of=tuple(one_of), pattern=pattern), allowed
        )
        if value is None:
            return fallback
        if not isinstance(value, str) or (one_of and value not in one_of):
            near = meant_word(value, one_of, other_names) if isinstance(value, str) else ""
            quoted = "" if one_of or example else in_quotes(key, value)
            shown = as_written(value)
            if near:
                wording = Wording("DEF330", "not_allowed_but_near", value=shown, near=near, allowed=allowed())
            elif quoted:
                wording = Wording("DEF330", "not_in_quotes", value=shown, allowed=allowed(), line=quoted)
            else:
                wording = Wording("DEF330", "not_allowed", value=shown, allowed=allowed())
            self.add_problem(key, wording)
            return fallback
        if pattern and not re.fullmatch(pattern, value):
            self.add_problem(key, Wording("DEF330", "not_allowed", value=as_written(value), allowed=allowed()))
            return fallback
        return value

    def setting(self, key: str, words: Sequence[str] = ()) -> str | None:
        """Return the text of a setting, which may be stated as a number too, or as true or false where ``words`` have a
        word for it; None where it is neither.
        """
        value = self._get(key, Expected(Form.SETTING, required=True), lambda: phrase("text_or_number"))
        text = setting_text(value, words)
        if text is None and value is not None:
            allowed = _a_text(words, "") if words else phrase("text_or_number")
            self.add_problem(key, Wording("DEF330", "not_allowed", value=as_written(value), allowed=allowed))
        return text

    @overload
    def number(self, key: str, default: float | Required = ..., **limits: Unpack[Bounds]) -> float: ...
    @overload
    def number(self, key: str, default: None, **limits: Unpack[Bounds]) -> float | None: ...
    def number(self, key: str, default: float | Required | None = REQUIRED, **limits: Unpack[Bounds]) -> float | None:
        """Return a _finite number, in the unit that the key names."""
        fallback = 0.0 if isinstance(default, Required) else default
        above, at_least, at_most = limits.get("above"), limits.get("at_least"), limits.get("at_most")

        def allowed() -> Wording:
            return a_number(unit_of(key), above, at_least, at_most)

        expected = Expected(
            Form.NUMBER, isinstance(default, Required), _told(default), above=above, at_least=at_least, at_most=at_most
        )
        value = self._get(key, expected, allowed)
        if value is None:
            return fallback
        number = finite(value)
        if line := unquoted(key, value):
            wording = Wording("DEF330", "in_quotes", value=as_written(value), allowed=allowed(), line=line)
            self.add_problem(key, wording)
            return fallback
        if number is None or not within(number, above, at_least, at_most):
            self._refuse(key, value, allowed())
            return fallback
        return number

    @overload
    def integer(self, key: str, default: int | Required = ..., **limits: Unpack[WholeBounds]) -> int: ...
    @overload
    def integer(self, key: str, default: None, **limits: Unpack[WholeBounds]) -> int | None: ...
    def integer(self, key: str, default: int | Required | None = REQUIRED, **limits: Unpack[WholeBounds]) -> int | None:
        """Return a whole number."""
        fallback = 0 if isinstance(default, Required) else default
        at_least, at_most = limits.get("at_least"), limits.get("at_most")
        nothing = limits.get("nothing", "")

        def allowed() -> Wording:
            number = a_whole_number("", None, at_least, at_most)
            return phrase("number_or_word", number=number, word=nothing) if nothing else number

        expected = Expected(
            Form.WHOLE, isinstance(default, Required), _told(default), at_least=at_least, at_most=at_most,
            nothing=nothing,
        )  # fmt: skip
        value = self._get(key, expected, allowed)
        if value is None or (nothing and value == nothing):
            return fallback
        if not isinstance(value, int) or isinstance(value, bool) or not within(value, None, at_least, at_most):
            self.add_problem(key, Wording("DEF330", "not_allowed", value=as_written(value), allowed=allowed()))
            return fallback
        return value

    @overload
    def flag(self, key: str, default: bool | Required = ...) -> bool: ...
    @overload
    def flag(self, key: str, default: None) -> bool | None: ...
    def flag(self, key: str, default: bool | Required | None = REQUIRED) -> bool | None:
        """Return true or false."""
        fallback = False if isinstance(default, Required) else default
        expected = Expected(Form.FLAG, isinstance(default, Required), _told(default))
        value = self._get(key, expected, lambda: phrase("true_or_false"))
        if value is None:
            return fallback
        if not isinstance(value, bool):
            self.add_problem(key, Wording("DEF330", "no_flag", value=as_written(value)))
            return fallback
        return value

    @overload
    def vector(self, key: str, n: int, default: Sequence[float] | Required = ...) -> tuple[float, ...]: ...
    @overload
    def vector(self, key: str, n: int, default: None) -> tuple[float, ...] | None: ...
    def vector(
        self, key: str, n: int, default: Sequence[float] | Required | None = REQUIRED
    ) -> tuple[float, ...] | None:
        """Return n _finite numbers, in the unit that the key names."""
        fallback = (0.0,) * n if isinstance(default, Required) else None if default is None else tuple(default)
        expected = Expected(Form.VECTOR, isinstance(default, Required), _told(default), size=n)
        value = self._get(key, expected, lambda: _a_vector(n, unit_of(key)))
        if value is None:
            return fallback
        numbers = finite_numbers(value)
        if numbers is None or len(numbers) != n:
            self._refuse(key, value, _a_vector(n, unit_of(key)), n)
            return fallback
        return numbers

    @overload
    def interval(self, key: str, default: tuple[float, float] | Required = ...) -> tuple[float, float]: ...
    @overload
    def interval(self, key: str, default: None) -> tuple[float, float] | None: ...
    def interval(
        self, key: str, default: tuple[float, float] | Required | None = REQUIRED
    ) -> tuple[float, float] | None:
        """Return [low, high] with low < high, in the unit that the key names."""
        fallback = (-math.inf, math.inf) if isinstance(default, Required) else default
        expected = Expected(Form.INTERVAL, isinstance(default, Required), _told(default), size=2)
        value = self._get(key, expected, lambda: _an_interval(unit_of(key)))
        if value is None:
            return fallback
        numbers = finite_numbers(value)
        if numbers is None or len(numbers) != 2:
            self._refuse(key, value, _an_interval(unit_of(key)), 2)
            return fallback
        low, high = numbers
        if low > high:
            shown, allowed = as_written(value), _an_interval(unit_of(key))
            self.add_problem(key, Wording("DEF330", "swapped", value=shown, allowed=allowed, low=high, high=low))
            return fallback
        if low == high:
            self._refuse(key, value, _an_interval(unit_of(key)), 2)
            return fallback
        return low, high

    @overload
    def texts(
        self, key: str, default: Sequence[str] | Required = ..., *, allowed: Wording | None = ...
    ) -> tuple[str, ...]: ...
    @overload
    def texts(self, key: str, default: None, *, allowed: Wording | None = ...) -> tuple[str, ...] | None: ...
    def texts(
        self, key: str, default: Sequence[str] | Required | None = REQUIRED, *, allowed: Wording | None = None
    ) -> tuple[str, ...] | None:
        """Return a list of texts; ``allowed`` says which, by default any."""
        allowed = allowed or phrase("list_of_texts")
        fallback = () if isinstance(default, Required) else None if default is None else tuple(default)
        expected = Expected(Form.TEXTS, isinstance(default, Required), _told(default))
        value = self._get(key, expected, lambda: allowed)
        if value is None:
            return fallback
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            shown = as_written(value)
            self.add_problem(
                key,
                Wording("DEF330", "text_for_list", value=shown)
                if isinstance(value, str)
                else Wording("DEF330", "not_allowed", value=shown, allowed=allowed),
            )
            return fallback
        return tuple(str(item) for item in value)

    @overload
    def lines(self, key: str, default: str | Required = ...) -> str: ...
    @overload
    def lines(self, key: str, default: None) -> str | None: ...
    def lines(self, key: str, default: str | Required | None = REQUIRED) -> str | None:
        """Return a text of several lines, which may be stated as the list of them too."""
        fallback = "" if isinstance(default, Required) else default
        expected = Expected(Form.LINES, isinstance(default, Required), _told(default))
        value = self._get(key, expected, lambda: phrase("text_or_lines"))
        if isinstance(value, list) and all(isinstance(item, str) for item in value):
            return "\n".join(value)
        if value is not None and not isinstance(value, str):
            allowed = phrase("text_or_lines")
            self.add_problem(key, Wording("DEF330", "not_allowed", value=as_written(value), allowed=allowed))
            return fallback
        return fallback if value is None else value

    def table(self, key: str, *, required: bool = False) -> "Table":
        """Return the table under a key; an empty one if there is none."""

        def allowed() -> Wording:
            return phrase("table", key=self.key_path(key))

        value = self._get(key, Expected(Form.TABLE, required), allowed)
        if isinstance(value, dict):
            child = self.other(self._values[key], self.problems, self.key_path(key))
        else:
            if value is not None:
                self.add_problem(key, Wording("DEF330", "not_allowed", value=as_written(value), allowed=allowed()))
            child = self.other(LocatedValue({}, self.file, self.line), self.problems, self.key_path(key))
        self.children.append(child)
        return child

    def tables(self, key: str, *, required: bool = False) -> "list[Table]":
        """Return the array of tables under a key; an empty list if there is none."""

        def allowed() -> Wording:
            return phrase("tables", key=self.key_path(key))

        value = self._get(key, Expected(Form.TABLES, required), allowed)
        if value is None or value == []:
            return []
        if not isinstance(value, list) or not all(isinstance(item, LocatedValue) for item in value):
            self.add_problem(key, Wording("DEF330", "not_allowed", value=as_written(value), allowed=allowed()))
            return []
        children = [self.other(item, self.problems, f"{self.key_path(key)}[{i}]") for i, item in enumerate(value)]
        self.children.extend(children)
        return children


def _a_text(one_of: Sequence[str], example: str) -> Wording:
    if one_of:
        return phrase("one_of", words=tuple(f'"{word}"' for word in one_of))
    return phrase("text_such_as", example=example) if example else phrase("text")


def _a_vector(n: int, unit: str) -> Wording:
    letters = tuple("abcdefgh"[:n])
    if unit:
        return phrase("vector_in_unit", letters=letters, count=n, unit=unit)
    return phrase("vector", letters=letters, count=n)


def _an_interval(unit: str) -> Wording:
    return phrase("interval_in_unit", unit=unit) if unit else phrase("interval")


def _told(default: object) -> object:
    """Return a default as a file could state it; None where there is none."""
    return None if isinstance(default, Required) else list(default) if isinstance(default, tuple) else default
