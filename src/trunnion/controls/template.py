"""Text templates: lines with ``{name}`` and ``{name:format}`` fields.

A template prints values and nothing else: it computes nothing and reads nothing. A line with a field whose value is
absent is left out, so that a program without a date has no line for one. A part in double brackets, such as
``TOOL CALL {tool}[[ S{speed}]]``, is left out alone. A number for a name, such as ``{50:coordinate}``, is that number:
a format that has inches prints it as a length in mm.

Templates with conditions and loops are ``trunnion.controls.text_template``, in which fields mean the same.
"""

import re
from collections.abc import Container, Mapping, Sequence
from dataclasses import field, replace
from functools import lru_cache
from importlib.resources import files
from typing import Final

from trunnion.controls.words import NumberFormat, WordRangeError
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

Value = str | float | None


class PrintedText(str):
    """A text that is not known before the program is proven: a template prints it, and asks nothing of it."""

    __slots__ = ()


#: Operations of a template language that the texts of one program may take, and characters that they may have.
_MOST_STEPS: Final = 50_000_000
_MOST_CHARACTERS: Final = 64_000_000

_SHIPPED: Final = str(files("trunnion"))

_OPTIONAL_PART = re.compile(r"\[\[(.*?)\]\]")
_FIELD = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)(?::([A-Za-z_][A-Za-z0-9_]*))?\}")
_NUMBER_FIELD = re.compile(r"\{([-+]?(?:\d+\.?\d*|\.\d+)):([A-Za-z_][A-Za-z0-9_]*)\}")
#: A word, up to the blank before it, with a field of the secondary rotary axis.
_SECONDARY_WORD = re.compile(r" ?[^\s\[\]]*\{\{? ?secondary\w*[^}]*\}\}?[^\s\[\]]*")
_SEGMENT = re.compile(r"\[\[.*?\]\]|(?:(?!\[\[).)+")

_LEFT = re.compile(r"[{}]|\[\[|\]\]")


@dataclass(slots=True, eq=False)
class Budget:
    """What the texts of one program may still take: operations of the template language, and characters."""

    steps: int = _MOST_STEPS
    characters: int = _MOST_CHARACTERS


@dataclass(frozen=True, slots=True, eq=False)
class Printing:
    """What a program prints its templates with.

    formats  number formats by name
    lengths  values in mm that a program of another unit prints in it, also without a format
    unit     of the program, mm
    numbers  settings that are numbers, for conditions
    lists    lists of records, and records, by name: the program's tools and operations
    budget   of the program
    own      what only the place has, for functions: `lines` that stand there without a template, and its values
    """

    formats: Mapping[str, NumberFormat]
    lengths: Container[str] = ()
    unit: float = 1.0
    numbers: Container[str] = ()
    lists: Mapping[str, object] = field(default_factory=dict)
    budget: Budget = field(default_factory=Budget)
    own: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """What stands at a place of a program.

    lines  of text
    words  of the place that are others, by their keys; None: left out
    base   the lines of the definition, where a function has written others in their place; None: it has not
    source  what has written the lines; None: the writer of the program itself
    """

    lines: Sequence[str]
    words: Mapping[str, float | None] = field(default_factory=dict)
    base: Sequence[str] | None = None
    source: "Template | None" = None


@dataclass(frozen=True, slots=True, eq=False)
class Template:
    """The lines of a template as they are written, with its file in the definition and the line of the first one.

    ``step`` is the number of lines in the file from one to the next: 0 where a list of them stands in one line.
    """

    name: str
    lines: tuple[str, ...]
    file: str = ""
    line: int = 0
    step: int = field(default=1, kw_only=True)

    @property
    def title(self) -> Wording:
        """What messages call it: a phrase."""
        return phrase("template_of_definition", name=self.name)

    @property
    def is_of_user(self) -> bool:
        """Whether it stands in a file of the user, and not in one that is shipped."""
        return not self.file.startswith(_SHIPPED)

    @property
    def of_definition(self) -> "Template | None":
        """What the definition has in its place: itself, unless it is a function of the user."""
        return self

    @property
    def is_text(self) -> bool:
        """Whether it has conditions or loops, so that its lines are not those of the program."""
        return False

    @property
    def record_values(self) -> frozenset[str]:
        """The values of tools and operations that it asks for."""
        return frozenset()

    def without_secondary(self) -> "Template":
        """Return the template for a machine with one rotary axis: no word of the second beside one of the first."""
        return replace(self, lines=tuple(map(_without_secondary, self.lines)))

    def fields(self) -> frozenset[tuple[str, str]]:
        """Return the (name, format) of every field; the format is empty where the field has none."""
        return _fields(self.lines)

    def fields_by_line(self) -> list[frozenset[tuple[str, str]]]:
        """Return the fields of each line."""
        return [_fields((line,)) for line in self.lines]

    def plain_lines(self) -> list[str]:
        """Return the lines with a zero byte for each field."""
        return [without_fields(line) for line in self.lines]

    def pattern_lines(self) -> tuple[str, ...]:
        """Return the lines from which a program may have been written: with fields, and without other expressions."""
        return self.lines

    def place_of(self, line: int) -> tuple[str, int]:
        """Return file and line of the definition of one of the lines, counted from 0."""
        return self.file, self.line + self.step * line if self.line else 0

    def fields_beside(self, name: str) -> list[set[str]]:
        """Return for each place of a field the other fields without which it is not printed."""
        found = []
        for text in self.lines:
            always = {field for field, _ in _FIELD.findall(_OPTIONAL_PART.sub("", text))}
            parts = [{field for field, _ in _FIELD.findall(part)} for part in _OPTIONAL_PART.findall(text)]
            places = [always] if name in always else [always | part for part in parts if name in part]
            found += [place - {name} for place in places]
        return found

    def numbers(self) -> set[tuple[str, str]]:
        """Return the (number, format) of every field that is a number."""
        return {(number, number_format) for text in self.lines for number, number_format in _NUMBER_FIELD.findall(text)}

    def unread_fields(self) -> list[str]:
        """Return the lines with braces or double brackets that are no field and no optional part."""
        return [text for text in self.lines if _LEFT.search(without_fields(_OPTIONAL_PART.sub(r"\1", text)))]

    def answer(self, values: Mapping[str, Value], printing: Printing) -> Answer:
        """Return what stands at its place; errors as ``expand`` raises them."""
        return Answer(self.expand(values, printing), source=self)

    def expand(self, values: Mapping[str, Value], printing: Printing) -> list[str]:
        """Return the lines with their values, without the lines and bracketed parts whose values are absent.

        Raises ``InputError`` if the value of a field with a format is not a number.

        Raises ``WordRangeError`` if it is beyond the limits of its format.
        """
        formats = printing.formats

        def field_text(match: re.Match[str]) -> str:
            value = values[match[1]]
            if match[2]:
                return number_text(match[1], self._number(match[0], value), formats[match[2]])
            if printing.unit != 1.0 and match[1] in printing.lengths:
                return f"{float(value or 0.0) / printing.unit:.6g}"
            return f"{value:g}" if isinstance(value, float) else str(value)

        def is_complete(text: str) -> bool:
            return all(values[name] not in (None, "") for name, _ in _FIELD.findall(text))

        lines = [_OPTIONAL_PART.sub(lambda part: part[1] if is_complete(part[1]) else "", text) for text in self.lines]
        complete = [_FIELD.sub(field_text, text) for text in lines if is_complete(text)]
        return [_NUMBER_FIELD.sub(lambda field: formats[field[2]].text(float(field[1])), text) for text in complete]

    def _number(self, field: str, value: Value) -> float:
        assert value is not None  # such lines are left out
        try:
            return float(value)
        except ValueError:
            plain = f"{field.partition(':')[0]}}}"
            wording = Wording("DEF510", "text_with_format", field=field, value=repr(value), plain=plain)
            raise InputError(Problem(self.file, self.line, wording)) from None


def number_text(name: str, number: float, number_format: NumberFormat) -> str:
    """Return a number in a format.

    Raises ``WordRangeError`` if it is beyond the limits of the format.
    """
    if not number_format.least <= number <= number_format.greatest:
        limit = number_format.least if number < number_format.least else number_format.greatest
        shown = name.replace("_", " ")
        raise WordRangeError(Wording("CTL110", "number_beyond_format", name=shown, value=number, limit=limit))
    return number_format.text(number)


def _without_secondary(line: str) -> str:
    """Return a line without words of the secondary rotary axis; a part with no other rotary axis keeps them, and is
    left out with them, for they are absent.
    """
    parts = _SEGMENT.findall(line)
    return "".join(_SECONDARY_WORD.sub("", part) if "primary" in part else part for part in parts)


@lru_cache(maxsize=1024)  # each setting of a control asks for those of all templates
def _fields(lines: tuple[str, ...]) -> frozenset[tuple[str, str]]:
    return frozenset((name, number_format or "") for text in lines for name, number_format in _FIELD.findall(text))


def without_fields(text: str) -> str:
    """Return a line of a template with a zero byte for each field."""
    return _NUMBER_FIELD.sub("\0", _FIELD.sub("\0", text))
