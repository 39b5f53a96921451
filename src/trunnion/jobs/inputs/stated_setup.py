"""Where the part sits and how long the tools are, as settings and arguments state it.

In:     the settings ``zero`` and ``tool_length``: one value for all, or one for each work offset and each tool.
Out:    the machine as it is set up.
"""

import math
import re
from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Final, TypeAlias, TypeVar

from trunnion import readers
from trunnion.errors import InputError, setting_problem
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.jobs.inputs.settings import as_argument, as_texts
from trunnion.machines import Machine
from trunnion.machines.machine import Vector, tool_key
from trunnion.messages import Wording, phrase

#: A workpiece zero: for all work offsets, or by their names.
ZeroLike: TypeAlias = str | Iterable[float] | Mapping[str, Iterable[float]]

#: A length: of all tools, or by their numbers or names.
LengthLike: TypeAlias = str | float | Mapping[str, float]

Key = TypeVar("Key", bound=Hashable)

#: The farthest that the workpiece zero may be from the origin of the machine, mm.
_FARTHEST_ZERO: Final = 1e5

#: Where a value begins that has a name: ``G54=``, ``G54.1 P2=``, ``3=``.
_NAMED: Final = re.compile(r"(?:^|,)([^=,]+)=")


def apply_setup(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """Return the machine with the workpiece zeros and the tool lengths of the settings."""
    if "zero" in settings:
        every, single = _divided(settings["zero"])
        named = [(_work_offset(name, machine, settings["zero"]), name, text) for name, text in single]
        zeros = {offset: _point(text, settings) for offset, text in _each_once("zero", named)}
        machine = replace(machine, zeros=zeros, workpiece_zero=_point(every, settings) if every else None)
    if "tool_length" in settings:
        every, single = _divided(settings["tool_length"])
        tools = [(tool_key(name), name, text) for name, text in single]
        lengths = {tool: _length(text, settings) for tool, text in _each_once("tool_length", tools)}
        machine = replace(machine, tool_lengths=lengths, tool_length=_length(every, settings) if every else None)
    return machine


def set_up_machine(machine: Machine, zero: ZeroLike | None, tool_length: LengthLike | None) -> Machine:
    """Return the machine with its workpiece zeros and its tool lengths, mm, where they are given.

    Raises
    ------
    InputError
        Of the argument, if it cannot be.
    """
    for name, value in (("zero", zero), ("tool_length", tool_length)):
        try:
            machine = apply_setup(machine, as_texts({name: value}))
        except InputError as error:
            raise InputError([as_argument(problem, name) for problem in error.problems]) from None
    return machine


def check_one_zero(machine: Machine, why: Wording) -> None:
    """Refuse zeros of single work offsets where none is selected.

    Raises ``InputError`` of the argument.
    """
    if machine.zeros:
        raise InputError(as_argument(setting_problem("zero", why), "zero"))


def length_of_tool_missing(tool: str) -> InputError:
    """Return the error of lengths of single tools where that of one is missing."""
    wording = Wording("ARG220", "length_of_tool_missing", tool=f"tool {tool}" if tool else "the tool in the spindle")
    return InputError(as_argument(setting_problem("tool_length", wording), "tool_length"))


def _divided(text: str) -> tuple[str, list[tuple[str, str]]]:
    """Return the value for all, empty if there is none, and the values that have a name."""
    parts = _NAMED.split(text)
    return parts[0].strip(), [
        (name.strip(), value.strip()) for name, value in zip(parts[1::2], parts[2::2], strict=True)
    ]


def _each_once(setting: str, named: Iterable[tuple[Key, str, str]]) -> Iterator[tuple[Key, str]]:
    """Yield each tool or work offset with its text; raises ``InputError`` for one that is named twice.

    named   the tool or the work offset, the name that was written for it, and the text
    """
    written: dict[Key, str] = {}
    for key, name, text in named:
        if key in written:
            names = dict.fromkeys((written[key], name))
            raise InputError(setting_problem(setting, Wording("ARG220", "named_twice", names=tuple(names))))
        written[key] = name
        yield key, text


def _work_offset(name: str, machine: Machine, text: str) -> int:
    """Return the value in ``Run.work_offset`` of a work offset as programs for the machine write it."""
    offsets = readers.reader_of(machine).work_offsets if readers.can_read(machine) else None
    value = None if offsets is None else offsets.value_of(" ".join(name.upper().split()))
    if value is None:
        form = phrase("zero_for_all") if offsets is None else offsets.form_said
        wording = Wording("ARG220", "no_work_offset", value=repr(name), form=form)
        raise InputError(setting_problem("zero", wording))
    return value


def _length(text: str, settings: Mapping[str, str]) -> float:
    """Return a length in mm."""
    setting = RUN_SETTINGS["tool_length"]
    assert setting.bounds is not None
    low, high = setting.bounds
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise InputError(setting_problem("tool_length", setting.fault("tool_length", settings["tool_length"])))
    return value


def _point(text: str, settings: Mapping[str, str]) -> Vector:
    """Return X, Y and Z in mm."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = math.nan
    if not max(abs(x), abs(y), abs(z)) <= _FARTHEST_ZERO or math.isnan(x + y + z):
        raise InputError(setting_problem("zero", RUN_SETTINGS["zero"].fault("zero", settings["zero"])))
    return x, y, z
