"""A table of a definition: a typed getter for each kind of value, and account of the keys that have been read."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from types import MappingProxyType
from typing import Final, TypedDict, Unpack, overload

from trunnion.definitions.expected import GREATEST, Expected, Form, Question
from trunnion.definitions.messages import a_number, a_whole_number, as_written, in_quotes, meant_word, unquoted
from trunnion.definitions.numbers import finite, finite_numbers, has_decimal_commas, is_too_large, within
from trunnion.definitions.source_lines import LocatedValue
from trunnion.definitions.units import unit_of, without_unit
from trunnion.errors import InputError, Problem, key_subject
from trunnion.messages import Wording, foreign, phrase


class Required:
    """The type of ``REQUIRED``: there is no default, and a missing key is a mistake."""


REQUIRED: Final = Required()

#: Keys that are not known and are told one by one: for each a similar one is looked for.
_MOST_UNREAD: Final = 100

#: Keys that stand above all tables, and tables of the control that people write without its name.
_OF_WHOLE_FILE: Final = frozenset({"schema", "extends", "description"})
_OF_CONTROL: Final = frozenset({"templates", "settings", "known", "reading", "between_points"})

#: How the names of shipped files begin.
_SHIPPED: Final = str(files("trunnion"))

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
class Table:
    """A TOML table that keeps account of the keys that have been read.

    A getter that finds a mistake adds a ``Problem`` to the shared list and returns the default, or an empty value of
    its type, so that reading goes on to the next mistake. ``raise_problems`` raises them all.

    content    the table with the origin of each value
    path       its path from the root of the definition, such as ``axis[1]``
    problems   shared with all tables of the definition
    read_keys  keys that a getter has been called for
    children   tables that getters have returned
    questions  takes what getters ask for, if it is there; shared with all tables that are made of this one
    sources    files that were read for the definition, also those of which no value counts
    """

    content: LocatedValue
    path: str = ""
    problems: list[Problem] = field(default_factory=list)
    read_keys: dict[str, None] = field(default_factory=dict)
    children: list["Table"] = field(default_factory=list)
    questions: list[Question] | None = None
    sources: tuple[str, ...] = ()

    # Locations

    @property
    def file(self) -> str:
        """File of the table, or of its last change."""
        return self.content.file

    @property
    def line(self) -> int:
        """Line of the table's header in ``file``."""
        return self.content.line

    def location(self, key: str) -> tuple[str, int]:
        """File and line of a key; those of the table if the key is missing."""
        content = self._values.get(key, self.content)
        return content.file, content.line

    def text_location(self, key: str) -> tuple[str, int]:
        """File and line of the first line of a text; the line is 0 if it has none."""
        content = self._values.get(key, self.content)
        return content.file, content.line + content.begins_below if content.line else 0

    def key_path(self, key: str) -> str:
        """Path of a key from the root of the definition, such as ``axis[1].limits_deg``."""
        return f"{self.path}.{key}" if self.path else key

    # Contents as a whole

    def keys(self) -> list[str]:
        """Every key of the table, in order, read or not."""
        return list(self._values)

    def __contains__(self, key: object) -> bool:
        return key in self._values

    def to_dict(self) -> dict[str, object]:
        """Return the whole table as plain dicts, lists and scalars. Does not count as reading."""
        plain = _plain(self.content)
        assert isinstance(plain, dict)
        return plain

    def unread_copy(self) -> "Table":
        """Return the same table with no key read and no problem noted."""
        return self.other(self.content, [])

    def other(self, content: LocatedValue, problems: list[Problem], path: str | None = None) -> "Table":
        """Return an unread table that notes what is asked where this one does; its path is this one's unless it is
        given.
        """
        return Table(
            content, self.path if path is None else path, problems, questions=self.questions, sources=self.sources
        )

    def names(self) -> list[str]:
        """Every key of a table whose keys the definition chooses itself, in order: none of them is unknown."""
        self._note("", Expected(Form.ANY_KEY))
        return list(self._values)

    def files(self) -> list[str]:
        """Every file that was read for this table, also where others overrule all of its values; sorted."""
        found = set(self.sources)
        _add_files(self.content, found)
        return sorted(found)

    @property
    def _values(self) -> dict[str, LocatedValue]:
        return self.content.value if isinstance(self.content.value, dict) else {}

    # Problems

    def add_problem(self, key: str, wording: Wording | str, cure: str = "", *, code: str = "DEF330") -> None:
        """Note a mistake in the value of a key; an empty key means the table itself.

        Where the value comes from a shipped file, what another file says of this table is what does not fit it: that is
        the place.
        """
        file, line = self.location(key)
        path = self.key_path(key) if key else self.path
        if isinstance(wording, str):
            wording = foreign(wording, cure, code)
        if file != self.file and file.startswith(_SHIPPED):
            wording = wording.within("inherited", file=file, line=line)
            file, line = self.file, self._own_line()
        self.problems.append(Problem(file, line, wording.of_key(path), subject=key_subject(path)))

    def _own_line(self) -> int:
        """Return the line of the one key that the last file to change the table states besides its name, or of its
        header.
        """
        lines = [each.line for key, each in self._values.items() if each.file == self.file and key != "name"]
        return lines[0] if len(lines) == 1 else self.line

    def raise_problems(self) -> None:
        """Raise every problem noted so far.

        Raises
        ------
        InputError
            If there is one, with all of them in the order of files and lines.
        """
        if self.problems:
            raise InputError(in_order(self.problems))

    def report_unread_keys(self) -> None:
        """Note each key that has not been read; call it when the table has been read."""
        unread = [key for key in self._values if key not in self.read_keys]
        if len(unread) > _MOST_UNREAD:
            self.add_problem("", Wording("DEF330", "keys_not_known", count=len(unread)))
        for key in unread[:_MOST_UNREAD]:
            if self.path and key in _OF_WHOLE_FILE:
                self.add_problem(key, Wording("DEF320", "belongs_whole_file", key=key))
                continue
            if not self.path and key in _OF_CONTROL and "control" in self.read_keys:
                self.add_problem(key, Wording("DEF320", "belongs_control", key=key))
                continue
            same_stem = (known for known in self.read_keys if without_unit(known) == without_unit(key))
            similar = next((known for known in same_stem if unit_of(known)), "")
            if similar and unit_of(key) != unit_of(similar):
                self.add_problem(key, Wording("DEF325", "unit_does_not", similar=similar, unit_of=unit_of(similar)))
            else:
                near = meant_word(key, self.read_keys)
                if near:
                    self.add_problem(key, Wording("DEF320", "unknown_but_near", near=near))
                else:
                    self.add_problem(key, Wording("DEF320", "unknown", known=tuple(sorted(self.read_keys))))

    def mark_read(self, *keys: str) -> None:
        """Count keys as read without looking at them."""
        self.read_keys.update(dict.fromkeys(keys))

    def all_read_keys(self) -> set[str]:
        """Every key that was read here and below, without indices: ``axis.limits_deg``."""
        found = {re.sub(r"\[\d+\]", "", self.key_path(key)) for key in self.read_keys}
        return found.union(*(table.all_read_keys() for table in self.children))

    # Getters

    def _note(self, key: str, expected: Expected) -> None:
        if self.questions is not None:
            self.questions.append(Question(self.path, key, expected))

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
        pattern: str = ..., form: Wording | None = ...,
    ) -> str: ...  # fmt: skip
    @overload
    def text(
        self, key: str, default: None, *,
        one_of: Sequence[str] = ..., other_names: Mapping[str, str] = ..., example: str = ...,
        pattern: str = ..., form: Wording | None = ...,
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
        form: Wording | None = None,
    ) -> str | None:
        """Return a text; with ``one_of``, one of these words, to which ``other_names`` lead in a message.

        With ``pattern`` all of it matches this regular expression, and ``form`` is the phrase of what to write. An
        empty text, or one that does not match, is the default; a required one is returned as it is.
        """
        fallback = "" if isinstance(default, Required) else default

        def allowed() -> Wording:
            return form or _a_text(one_of, example)

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

    @overload
    def number(self, key: str, default: float | Required = ..., **limits: Unpack[Bounds]) -> float: ...
    @overload
    def number(self, key: str, default: None, **limits: Unpack[Bounds]) -> float | None: ...
    def number(self, key: str, default: float | Required | None = REQUIRED, **limits: Unpack[Bounds]) -> float | None:
        """Return a finite number, in the unit that the key names."""
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
        """Return n finite numbers, in the unit that the key names."""
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
    def texts(self, key: str, default: Sequence[str] | Required = ...) -> tuple[str, ...]: ...
    @overload
    def texts(self, key: str, default: None) -> tuple[str, ...] | None: ...
    def texts(self, key: str, default: Sequence[str] | Required | None = REQUIRED) -> tuple[str, ...] | None:
        """Return a list of texts."""
        fallback = () if isinstance(default, Required) else None if default is None else tuple(default)
        expected = Expected(Form.TEXTS, isinstance(default, Required), _told(default))
        value = self._get(key, expected, lambda: phrase("list_of_texts"))
        if value is None:
            return fallback
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            shown = as_written(value)
            self.add_problem(
                key,
                Wording("DEF330", "text_for_list", value=shown)
                if isinstance(value, str)
                else Wording("DEF330", "not_allowed", value=shown, allowed=phrase("list_of_texts")),
            )
            return fallback
        return tuple(str(item) for item in value)

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


def in_order(problems: Iterable[Problem]) -> list[Problem]:
    """Return problems, each once, by files and lines; those in shipped files, which others cause, come last."""
    return sorted(dict.fromkeys(problems), key=lambda each: (each.file.startswith(_SHIPPED), each.file, each.line))


def _told(default: object) -> object:
    """Return a default as a file could state it; None where there is none."""
    return None if isinstance(default, Required) else list(default) if isinstance(default, tuple) else default


def _plain(content: LocatedValue) -> object:
    if isinstance(content.value, dict):
        return {key: _plain(item) for key, item in content.value.items()}
    if isinstance(content.value, list):
        return [_plain(item) if isinstance(item, LocatedValue) else item for item in content.value]
    return content.value


def _add_files(content: LocatedValue, files: set[str]) -> None:
    """Add the file of a value and those of the values in it."""
    files.add(content.file)
    value = content.value
    if isinstance(value, dict | list):
        for item in value.values() if isinstance(value, dict) else value:
            if isinstance(item, LocatedValue):
                _add_files(item, files)
