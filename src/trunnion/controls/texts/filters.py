"""The filters of templates. ``docs/templates.md`` explains them; the number formats of a control are filters too."""

import unicodedata
from collections.abc import Callable, Mapping
from typing import Any, Final

from jinja2 import pass_context
from jinja2.runtime import Context

from trunnion.controls.template import PrintedText, number_text
from trunnion.controls.texts.values import (
    LONGEST_TEXT,
    Fault,
    Length,
    Rendering,
    as_number,
    bounded_text,
    number_of,
    shown,
    text_of,
)

#: The name under which a template's context has its ``Rendering``; none of its own names begins so.
RENDERING: Final = "_rendering"

#: Filters that stand for what is written otherwise, or must be bounded. No template can write such a name.
FORMAT: Final = "number format"
EACH: Final = "passes of a loop"
RANGE: Final = "whole numbers"
JOINED: Final = "texts one after the other"
COMPARED: Final = "a comparison"

_LONGEST_RANGE: Final = 10_000
_FARTHEST: Final = 10**12
_WIDEST: Final = 200


def rendering_of(context: Context) -> Rendering:
    """Return the writing of a template that is going on."""
    rendering = context.parent[RENDERING]
    assert isinstance(rendering, Rendering)
    return rendering


@pass_context
def printed(context: Context, value: object) -> str:
    """Return a value as the text of the program."""
    return text_of(value, rendering_of(context).printing.unit)


# What the tree puts in place of something else


@pass_context
def _format(context: Context, value: object, name: str) -> str | None:
    """Return a number in a number format of the control."""
    if value is None or value == "":
        return None
    printing, number = rendering_of(context).printing, as_number(value)
    number_format = printing.formats[name]
    if isinstance(value, Length) and printing.unit != 1.0 and number_format.unit == 1.0:
        raise Fault("length_in_format_of_mm", name=name)
    if number is None:
        raise Fault("no_number_for_format", value=shown(value), name=name)
    return number_text("value", number, number_format)


@pass_context
def _each(context: Context, items: object, steps: int) -> tuple[object, ...]:
    """Return what a loop goes through, once its passes are paid for."""
    if items is None:
        return ()
    if not isinstance(items, tuple | list | range):
        raise Fault("goes_through_no_list", value=shown(items))
    rendering_of(context).charge(steps * len(items))
    return tuple(items)


def _range(first: object, *others: object) -> range:
    """Whole numbers, as Python's range has them."""
    numbers = [each for each in (first, *others) if isinstance(each, int) and not isinstance(each, bool)]
    if len(numbers) != len(others) + 1 or len(numbers) > 3 or (len(numbers) == 3 and numbers[2] == 0):
        raise Fault("range_of_no_whole_numbers")
    if max(map(abs, numbers)) > _FARTHEST or len(found := range(*numbers)) > _LONGEST_RANGE:
        raise Fault("too_long_range", most=_LONGEST_RANGE)
    return found


@pass_context
def _joined(context: Context, first: object, *others: object) -> str | None:
    """Texts one after the other; None if one is absent."""
    unit, parts = rendering_of(context).printing.unit, (first, *others)
    return None if any(part is None for part in parts) else bounded_text("".join(text_of(part, unit) for part in parts))


# Texts


def _of_text(what: str, change: Callable[..., str]) -> Callable[..., str | None]:
    """Return a filter of texts, which leaves an absent one absent."""

    def changed(value: object, *arguments: object) -> str | None:
        return None if value is None else bounded_text(change(_plain(value, what), *arguments))

    return changed


def _plain(value: object, what: str) -> str:
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, int | float) and not isinstance(value, bool):
        return text_of(value)
    raise Fault("text_wanted", value=shown(value), filter=what)


def _ascii(text: str) -> str:
    letters = unicodedata.normalize("NFKD", text.replace("ß", "ss").replace("Ø", "O").replace("ø", "o"))
    plain = "".join(letter for letter in letters if not unicodedata.combining(letter))
    return "".join(letter if " " <= letter <= "~" else "?" for letter in plain.upper())


def _cut(text: str, most: object = 80) -> str:
    return text[: _whole(most, "cut", LONGEST_TEXT)]


def _pad(text: str, width: object = 0, sign: object = "0") -> str:
    if not isinstance(sign, str) or len(sign) != 1:
        raise Fault("pads_with_no_letter")
    return text.rjust(_whole(width, "pad", _WIDEST), sign)


def _replace(text: str, old: object = "", new: object = "") -> str:
    old, new = _plain(old, "replace"), _plain(new, "replace")
    if not old or len(text) + text.count(old) * len(new) > LONGEST_TEXT:
        raise Fault("replaces_empty_text")
    return text.replace(old, new)


def _whole(value: object, what: str, most: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= most:
        raise Fault("whole_number_wanted", value=shown(value), filter=what, most=most)
    return value


# Numbers and lists


def _round(value: object, decimals: object = 0) -> float | None:
    if value is None:
        return None
    rounded = round(float(number_of(value, "round")), _whole(decimals, "round", 9))
    if isinstance(value, Length):
        return Length(rounded)
    return int(rounded) if decimals == 0 else rounded


def _absolute(value: object) -> float | None:
    if value is None:
        return None
    number = abs(number_of(value, "abs"))
    return Length(number) if isinstance(value, Length) else number


def _list(value: object, what: str) -> tuple[object, ...]:
    if isinstance(value, tuple | list | range):
        return tuple(value)
    raise Fault("list_wanted", value=shown(value), filter=what)


@pass_context
def _join(context: Context, value: object, between: object = "") -> str:
    items, unit, sign = _list(value, "join"), rendering_of(context).printing.unit, _plain(between, "join")
    rendering_of(context).charge(len(items))
    if len(sign) * len(items) > LONGEST_TEXT:
        raise Fault("makes_too_long_text", most=LONGEST_TEXT)
    return bounded_text(sign.join(text_of(item, unit) for item in items if item is not None))


def _default(value: object, other: object = None) -> object:
    return other if value is None or value == "" else value


def _is_odd(value: object) -> bool:
    return number_of(value, "odd") % 2 == 1


def _is_even(value: object) -> bool:
    return number_of(value, "even") % 2 == 0


#: The tests of templates, behind ``is``.
TESTS: Final[Mapping[str, Callable[..., bool]]] = {
    "none": lambda value: value is None, "odd": _is_odd, "even": _is_even,
}  # fmt: skip

_OWN: Final[Mapping[str, Callable[..., Any]]] = {
    "upper": _of_text("upper", str.upper),
    "lower": _of_text("lower", str.lower),
    "trim": _of_text("trim", str.strip),
    "ascii": _of_text("ascii", _ascii),
    "cut": _of_text("cut", _cut),
    "pad": _of_text("pad", _pad),
    "replace": _of_text("replace", _replace),
    "default": _default,
    "number": as_number,
    "round": _round,
    "abs": _absolute,
    "count": lambda value: len(_list(value, "count")),
    "first": lambda value: next(iter(_list(value, "first")), None),
    "last": lambda value: next(iter(_list(value, "last")[::-1]), None),
    "join": _join,
}

#: Values that a filter takes in brackets, at most; all others take none, nor do number formats.
MOST_ARGUMENTS: Final[Mapping[str, int]] = {"cut": 1, "pad": 2, "replace": 2, "default": 1, "round": 1, "join": 1}

#: Letters that take as long as one step: those of a text that is looked through, and that are taken apart.
_LETTERS_A_STEP: Final = 8
_SLOW: Final = frozenset({"ascii"})

#: Filters that print a text as it is.
_PRINTING: Final = frozenset({"default", JOINED})


def _priced(name: str, change: Callable[..., Any]) -> Callable[..., Any]:
    """Return a filter that is paid for by the letters of its texts, as loops are by their passes."""
    a_step = 1 if name in _SLOW else _LETTERS_A_STEP
    takes_context = hasattr(change, "jinja_pass_arg")

    @pass_context
    def priced(context: Context, *arguments: object) -> object:
        rendering = rendering_of(context)
        printed_only = any(isinstance(each, PrintedText) for each in arguments)
        if printed_only and name not in _PRINTING:
            raise Fault("machining_time_for_value", name=name)
        rendering.charge(sum(len(each) for each in arguments if isinstance(each, str)) // a_step)
        changed = change(context, *arguments) if takes_context else change(*arguments)
        if isinstance(changed, str):
            rendering.charge(len(changed) // a_step)
        return PrintedText(changed) if printed_only and isinstance(changed, str) else changed

    return priced


def _compared(value: object) -> object:
    """One side of a comparison."""
    return value


_MADE: Final[Mapping[str, Callable[..., Any]]] = {
    **_OWN, FORMAT: _format, EACH: _each, RANGE: _range, JOINED: _joined, COMPARED: _compared,
}  # fmt: skip

ALL: Final[Mapping[str, Callable[..., Any]]] = {name: _priced(name, change) for name, change in _MADE.items()}
