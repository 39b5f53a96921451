"""Settings that state one thing of operations whose CL file leaves it out: ``8000,DRILL:1200``."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TypeVar

from trunnion.errors import InputError, setting_problem
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath

_Value = TypeVar("_Value")


def stated_by_operation(
    key: str, settings: Mapping[str, str], value_of: Callable[[str], _Value | None]
) -> dict[str, _Value]:
    """Return what a setting states, by operation; that of all others has no name.

    ``value_of`` makes a value of its text, and None of one that is none.

    Raises ``InputError`` if the setting is none, or states two values of one operation.
    """
    found: dict[str, _Value] = {}
    for name, value in stated_values(key, settings, value_of):
        if name in found:
            raise value_twice(key, settings)
        found[name] = value
    return found


def stated_values(
    key: str, settings: Mapping[str, str], value_of: Callable[[str], _Value | None]
) -> Iterator[tuple[str, _Value]]:
    """Yield what a setting states, each value with the operation that it is of; none: all others.

    Raises ``InputError`` if the setting is none.
    """
    text = settings.get(key, "")
    for entry in text.split(",") if text else ():
        name, _, written = entry.rpartition(":")
        value = value_of(written)
        if value is None:
            raise InputError(setting_problem(key, RUN_SETTINGS[key].fault(key, text)))
        yield name, value


def value_twice(key: str, settings: Mapping[str, str]) -> InputError:
    """Return the error of a setting with two values of one operation."""
    return InputError(setting_problem(key, Wording("ARG220", "value_twice", name=key, value=repr(settings[key]))))


def check_operations(key: str, names: Iterable[str], toolpaths: Iterable[Toolpath]) -> None:
    """Raise ``InputError`` for operations, named before a colon, that are in none of the toolpaths."""
    known = tuple(dict.fromkeys(each.name for path in toolpaths for each in path.operations))
    problems = [
        setting_problem(key, Wording("ARG230", "no_operation_before_colon", name=name, known=known))
        for name in sorted({*names} - {"", *known})
    ]
    if problems:
        raise InputError(problems)
