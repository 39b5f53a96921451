"""Types and values of arguments: what cannot be used is an ``InputError`` that names the argument, before any work."""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import BinaryIO, TypeGuard, TypeVar

from trunnion.errors import InputError, argument_problem
from trunnion.jobs.observer import Observer
from trunnion.messages import Wording, phrase

_Choice = TypeVar("_Choice", bound=str)


def wrong_argument(name: str, value: object, remedy: Wording) -> InputError:
    """Return the error for an argument of a type or value that cannot be used; the phrase says what to give."""
    if isinstance(value, str | int | float | bytes | tuple | None):
        wording = Wording("ARG140", "unusable", value=repr(value), remedy=remedy)
    else:
        wording = Wording("ARG140", "unusable_type", type=type(value).__name__, remedy=remedy)
    return InputError(argument_problem(name, wording))


def check_path(name: str, value: object) -> Path:
    """Return a path; errors name the argument."""
    if isinstance(value, str | os.PathLike) and isinstance(text := os.fspath(value), str) and text and "\0" not in text:
        return Path(text)
    raise wrong_argument(name, value, phrase("give_path"))


def no_mapping(name: str, value: object) -> InputError:
    """Return the error for an argument that is no mapping."""
    return InputError(argument_problem(name, Wording("ARG140", "no_mapping", type=type(value).__name__)))


def is_output(value: object) -> bool:
    """Whether something can be written as a stream."""
    return hasattr(value, "write")


def is_stream(value: object) -> TypeGuard[BinaryIO]:
    """Whether something can be read as a stream."""
    return hasattr(value, "read") and not isinstance(value, str | os.PathLike)


def check_paths(name: str, values: object) -> list[Path]:
    """Paths in a list; a text alone is none, for its letters would be taken for paths."""
    if isinstance(values, str | bytes | os.PathLike) or not isinstance(values, Iterable):
        raise wrong_argument(name, values, phrase("give_paths"))
    return [check_path(name, value) for value in values]


def check_choice(name: str, value: object, choices: Sequence[_Choice]) -> _Choice:
    """One of some words."""
    for choice in choices:
        if value == choice:
            return choice
    raise wrong_argument(name, value, phrase("give_one_of", choices=tuple(map(repr, choices))))


def check_whole(name: str, value: object, least: int) -> int:
    """Return a whole number, also as text."""
    text = str(value) if isinstance(value, str | int) and not isinstance(value, bool) else ""
    if text.isascii() and text.isdecimal() and int(text) >= least:
        return int(text)
    raise wrong_argument(name, value, phrase("give_whole", least=least))


def check_observer(value: object) -> None:
    """Refuse what is no ``Observer``."""
    if not isinstance(value, Observer):
        raise wrong_argument("observer", value, phrase("give_observer"))


def checked_angles(turn: object, tilt: object) -> tuple[float, float]:
    """Turn and tilt as arguments, checked, in whole thousandths of a degree; None is 0.

    Raises ``InputError`` if one is no number from -360 to 360.
    """
    found = []
    for name, value in (("turn", turn), ("tilt", tilt)):
        value = 0.0 if value is None else value
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= 360.0:
            raise wrong_argument(name, value, phrase("give_degrees"))
        found.append(round(float(value), 3) + 0.0)
    return found[0], found[1]
