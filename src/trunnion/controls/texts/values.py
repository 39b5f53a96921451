"""What expressions of templates deal with: numbers, lengths, texts, lists, and records of tools and operations.

An absent value is None: what is made of it is absent too, and a line that prints it is left out.
"""

import math
import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import Final

from trunnion.controls.template import Printing
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: Stands in a printed line for an absent value.
ABSENT: Final = "\0"

#: Letters of one text that an expression makes.
LONGEST_TEXT: Final = 10_000

#: Operations and letters of one template each time that it is written.
MOST_STEPS: Final = 1_000_000
MOST_CHARACTERS: Final = 1_000_000

_GREATEST: Final = 1e15
_CONTROL_CHARACTERS: Final = dict.fromkeys((*range(32), 127, 133, 8232, 8233), " ")
_NUMBER: Final = re.compile(r"[-+]?(?:\d{1,15}\.?\d{0,15}|\.\d{1,15})", re.ASCII)


class Fault(Exception):  # noqa: N818 - it is the template's
    """What a template does that it cannot, while it is read or while it is written; its line if that is known, else 0.

    ``variant`` and parameters are those of a wording of the code DEF580.
    """

    def __init__(self, variant: str, line: int = 0, /, **parameters: object) -> None:
        super().__init__(variant)
        self.wording, self.line = Wording("DEF580", variant, **parameters), line


class Length(float):
    """A length or feed in mm, which a program prints in its unit."""


class Later:
    """A value that is worked out when a template asks for it."""

    __slots__ = ("_make",)

    def __init__(self, make: Callable[[], object]) -> None:
        self._make = cache(make)

    def value(self) -> object:
        """Return it, worked out once."""
        return self._make()


class Record(str):
    """A tool or an operation: prints as its number or name, and has ``values`` by name."""

    values: Mapping[str, object]

    def __new__(cls, text: str, values: Mapping[str, object]) -> "Record":
        """Make a record that prints as ``text``."""
        record = super().__new__(cls, text)
        record.values = values
        return record


@dataclass(slots=True, eq=False)
class Rendering:
    """One writing of a template: what it prints with, and the operations that it may still take."""

    printing: Printing
    steps: int = MOST_STEPS

    def charge(self, steps: int) -> None:
        """Count operations before they are done."""
        budget = self.printing.budget
        self.steps -= steps
        budget.steps -= steps
        if min(self.steps, budget.steps) < 0:
            raise Fault("goes_on_too_long")


def shown(value: object) -> Wording | str:
    """Return a value in a message, cut short."""
    if isinstance(value, str):
        return repr(value[:40])
    if isinstance(value, tuple | list | range):
        return phrase("a_list")
    return str(value) if isinstance(value, bool | int | float) else phrase("name_without_value")


def number_of(value: object, what: str) -> float:
    """Return a value that must be a number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Fault("number_wanted", value=shown(value), operator=what)
    return value


def as_number(value: object) -> float | None:
    """Return a number, or a text of one, as a number; None if it is none."""
    if isinstance(value, bool):
        return None
    if isinstance(value, int | float):
        return value
    if isinstance(value, str) and _NUMBER.fullmatch(value.strip()):
        number = float(value)
        return int(number) if number.is_integer() else number
    return None


def bounded(number: float) -> float:
    """Return a calculated number, if it is not too large."""
    if not (math.isfinite(number) and abs(number) <= _GREATEST):
        raise Fault("calculates_too_large_number")
    return number


def bounded_text(text: str) -> str:
    """Return a text that was made, if it is not too long."""
    if len(text) > LONGEST_TEXT:
        raise Fault("makes_too_long_text", most=LONGEST_TEXT)
    return text


def text_of(value: object, unit: float = 1.0) -> str:
    """Return a value as the text of a program that counts in ``unit``, mm; no line break comes of it."""
    if value is None:
        return ABSENT
    if isinstance(value, str):
        return str.__str__(value).translate(_CONTROL_CHARACTERS)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Fault("prints_neither_text_nor_number", value=shown(value))
    number = float(value) / unit if isinstance(value, Length) else value
    text = f"{number:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def calculated(operator: str, left: object, right: object) -> float | None:
    """Return the result of arithmetic; None if one of the numbers is absent.

    A length stays one where it is added to, or multiplied by a number.
    """
    if left is None or right is None:
        return None
    a, b = number_of(left, operator), number_of(right, operator)
    if operator in ("/", "//", "%") and b == 0:
        raise Fault("divides_by_0")
    match operator:
        case "+":
            result = a + b
        case "-":
            result = a - b
        case "*":
            result = a * b
        case "/":
            result = a / b
        case "//":
            result = a // b
        case _:
            result = a % b
    return Length(bounded(result)) if _is_length(operator, left, right) else bounded(result)


def _is_length(operator: str, left: object, right: object) -> bool:
    lengths = isinstance(left, Length) + isinstance(right, Length)
    if operator in ("+", "-", "%"):
        return lengths > 0
    return lengths == 1 and (operator == "*" or isinstance(left, Length))
