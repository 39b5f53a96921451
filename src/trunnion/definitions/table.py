"""A table of a definition: a typed getter for each kind of value."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TypedDict, Unpack, overload

from trunnion.definitions.account import TableAccount
from trunnion.definitions.expected import GREATEST, Expected, Form
from trunnion.definitions.messages import a_number, as_written, bounds, did_you_mean, in_quotes, in_unit, unquoted
from trunnion.definitions.source_lines import LocatedValue
from trunnion.messages import Wording


class Required:
    """The type of ``REQUIRED``: there is no default, and a missing key is a mistake."""


REQUIRED: Final = Required()

_NO_NAMES: Final[Mapping[str, str]] = MappingProxyType({})


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

    def _get(self, key: str, expected: Expected, cure: str) -> object | None:
        self.read_keys[key] = None
        self._note(key, expected)
        content = self._values.get(key)
        if content is None:
            if expected.required:
                self.add_problem(key, "is missing", cure, code="DEF310")
            return None
        return content.value

    @overload
    def text(
        self, key: str, default: str | Required = ..., *,
        one_of: Sequence[str] = ..., other_names: Mapping[str, str] = ..., example: str = ...,
        pattern: str = ..., form: str = ...,
    ) -> str: ...  # fmt: skip
    @overload
    def text(
        self, key: str, default: None, *,
        one_of: Sequence[str] = ..., other_names: Mapping[str, str] = ..., example: str = ...,
        pattern: str = ..., form: str = ...,
    ) -> str | None: ...  # fmt: skip
    def text(
        self,
        key: str,
        default: str | Required | None = REQUIRED,
        *,
        one_of: Sequence[str] = (),
        other_names: Mapping[str, str] = _NO_NAMES,
        example: str = "",
        pattern: str = "",
        form: str = "",
    ) -> str | None:
        """Return a text; with ``one_of``, one of these words, to which ``other_names`` lead in a message.

        With ``pattern`` all of it matches this regular expression, and ``form`` says in words what to write. An empty
        text, or one that does not match, is the default; a required one is returned as it is.
        """
        fallback = "" if isinstance(default, Required) else default
        words = ", ".join(f'"{word}"' for word in one_of)
        such_as = f', such as "{example}"' if example else ""
        cure = f"write one of {words}" if one_of else f"write a text in quotes{such_as}"
        cure = f"write {form}" if form else cure
        required = isinstance(default, Required)
        value = self._get(
            key, Expected(Form.TEXT, required, _told(default), one_of=tuple(one_of), pattern=pattern), cure
        )
        if value is None:
            return fallback
        if not isinstance(value, str) or (one_of and value not in one_of):
            near = did_you_mean(value, one_of, other_names) if isinstance(value, str) else ""
            quoted = "" if one_of or example else in_quotes(key, value)
            self.add_problem(key, f"is {as_written(value)}", (near + " " + cure if near else cure) + quoted)
            return fallback
        if pattern and not re.fullmatch(pattern, value):
            self.add_problem(key, f"is {as_written(value)}", cure)
            return fallback
        return value

    @overload
    def number(self, key: str, default: float | Required = ..., **limits: Unpack[Bounds]) -> float: ...
    @overload
    def number(self, key: str, default: None, **limits: Unpack[Bounds]) -> float | None: ...
    def number(self, key: str, default: float | Required | None = REQUIRED, **limits: Unpack[Bounds]) -> float | None:
        """Return a _finite number, in the unit that the key names."""
        fallback = 0.0 if isinstance(default, Required) else default
        above, at_least, at_most = limits.get("above"), limits.get("at_least"), limits.get("at_most")
        cure = f"write {a_number(key)}{bounds(above, at_least, at_most)}"
        expected = Expected(
            Form.NUMBER, isinstance(default, Required), _told(default), above=above, at_least=at_least, at_most=at_most
        )
        value = self._get(key, expected, cure)
        if value is None:
            return fallback
        number = _finite(value)
        if number is None:
            self.add_problem(key, f"is {as_written(value)}", cure + unquoted(key, value) + _magnitude(value))
            return fallback
        if not _within(number, above, at_least, at_most):
            self.add_problem(
                key,
                Wording(
                    "DEF330",
                    "is",
                    value=as_written(value),
                    a_number=a_number(key),
                    bounds=bounds(above, at_least, at_most),
                ),
            )
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
        cure = f"write a whole number{bounds(None, at_least, at_most)}" + (f', or "{nothing}"' if nothing else "")
        expected = Expected(
            Form.WHOLE, isinstance(default, Required), _told(default), at_least=at_least, at_most=at_most,
            nothing=nothing,
        )  # fmt: skip
        value = self._get(key, expected, cure)
        if value is None or (nothing and value == nothing):
            return fallback
        if not isinstance(value, int) or isinstance(value, bool) or not _within(value, None, at_least, at_most):
            self.add_problem(
                key,
                Wording(
                    "DEF330",
                    "is_or_write",
                    value=as_written(value),
                    bounds=bounds(None, at_least, at_most),
                    nothing=nothing,
                )
                if nothing
                else Wording(
                    "DEF330", "is_or_write_whole", value=as_written(value), bounds=bounds(None, at_least, at_most)
                ),
            )
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
        value = self._get(key, expected, "write true or false")
        if value is None:
            return fallback
        if not isinstance(value, bool):
            self.add_problem(key, Wording("DEF330", "is_or_write_true", value=as_written(value)))
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
        cure = f"write [{', '.join('abcdefgh'[:n])}] with {n} numbers{in_unit(key, ' ')}"
        value = self._get(key, Expected(Form.VECTOR, isinstance(default, Required), _told(default), size=n), cure)
        if value is None:
            return fallback
        numbers = _finite_numbers(value)
        if numbers is None or len(numbers) != n:
            self.add_problem(key, f"is {as_written(value)}", cure + _magnitude(value) + _decimals(value, n))
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
        cure = f"write [low, high] with low < high{in_unit(key, ', ')}"
        value = self._get(key, Expected(Form.INTERVAL, isinstance(default, Required), _told(default), size=2), cure)
        if value is None:
            return fallback
        numbers = _finite_numbers(value)
        if numbers is None or len(numbers) != 2:
            self.add_problem(key, f"is {as_written(value)}", cure + _magnitude(value) + _decimals(value, 2))
            return fallback
        low, high = numbers
        if low >= high:
            swapped = f": [{high:g}, {low:g}]?" if low > high else ""
            self.add_problem(key, f"is {as_written(value)}", cure + swapped)
            return fallback
        return low, high

    @overload
    def texts(self, key: str, default: Sequence[str] | Required = ...) -> tuple[str, ...]: ...
    @overload
    def texts(self, key: str, default: None) -> tuple[str, ...] | None: ...
    def texts(self, key: str, default: Sequence[str] | Required | None = REQUIRED) -> tuple[str, ...] | None:
        """Return a list of texts."""
        fallback = () if isinstance(default, Required) else None if default is None else tuple(default)
        cure = 'write ["one", "two"]'
        value = self._get(key, Expected(Form.TEXTS, isinstance(default, Required), _told(default)), cure)
        if value is None:
            return fallback
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            self.add_problem(
                key,
                Wording("DEF330", "is_2", value=as_written(value))
                if isinstance(value, str)
                else Wording("DEF330", "is_or_write_one", value=as_written(value)),
            )
            return fallback
        return tuple(str(item) for item in value)

    def table(self, key: str, *, required: bool = False) -> "Table":
        """Return the table under a key; an empty one if there is none."""
        cure = f"write a table [{self.key_path(key)}]"
        value = self._get(key, Expected(Form.TABLE, required), cure)
        if isinstance(value, dict):
            child = self.other(self._values[key], self.problems, self.key_path(key))
        else:
            if value is not None:
                self.add_problem(
                    key, Wording("DEF330", "is_or_write_table", value=as_written(value), key_path=self.key_path(key))
                )
            child = self.other(LocatedValue({}, self.file, self.line), self.problems, self.key_path(key))
        self.children.append(child)
        return child

    def tables(self, key: str, *, required: bool = False) -> "list[Table]":
        """Return the array of tables under a key; an empty list if there is none."""
        cure = f"write tables [[{self.key_path(key)}]]"
        value = self._get(key, Expected(Form.TABLES, required), cure)
        if value is None or value == []:
            return []
        if not isinstance(value, list) or not all(isinstance(item, LocatedValue) for item in value):
            self.add_problem(
                key, Wording("DEF330", "is_or_write_tables", value=as_written(value), key_path=self.key_path(key))
            )
            return []
        children = [self.other(item, self.problems, f"{self.key_path(key)}[{i}]") for i, item in enumerate(value)]
        self.children.extend(children)
        return children


def _told(default: object) -> object:
    """Return a default as a file could state it; None where there is none."""
    return None if isinstance(default, Required) else list(default) if isinstance(default, tuple) else default


def _finite(value: object) -> float | None:
    """Return the number that a TOML value is, or None if it is too large or none; true and false are no
    numbers here.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if abs(number) <= GREATEST else None


def _magnitude(value: object) -> str:
    """Return the bounds of all numbers in words, after a comma, if a number is beyond them; else empty."""
    numbers = [item for item in (value if isinstance(value, list) else [value]) if isinstance(item, int | float)]
    return (
        f", from {-GREATEST:g} to {GREATEST:g}" if any(GREATEST < abs(number) < math.inf for number in numbers) else ""
    )


def _decimals(value: object, n: int) -> str:
    """Return what to write instead of decimal commas, which make more numbers of an array than it should have."""
    if not isinstance(value, list) or len(value) <= n or any(not isinstance(each, int) for each in value[1:]):
        return ""
    return "; _decimals stand behind a point, such as 90.5"


def _finite_numbers(value: object) -> tuple[float, ...] | None:
    """Return the _finite numbers in a TOML array; None if it holds anything else, or is no array."""
    numbers = [_finite(item) for item in value] if isinstance(value, list) else [None]
    found = tuple(number for number in numbers if number is not None)
    return found if len(found) == len(numbers) else None


def _within(number: float, above: float | None, at_least: float | None, at_most: float | None) -> bool:
    return (
        (above is None or number > above)
        and (at_least is None or number >= at_least)
        and (at_most is None or number <= at_most)
    )
