"""Settings of a post by their keys: the same for ``--set`` and for the library.

In:     settings as text or numbers.
Out:    text that is checked; numbers, points, and the machine as it is set up.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final, TypeAlias

from trunnion.controls import Control
from trunnion.controls.vocabulary import PROGRAM_CHOICES
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine
from trunnion.model.motion import PoleStrategy
from trunnion.model.run import EXTENDED_OFFSET_BASE, ORIGIN_OFFSET_BASE
from trunnion.output.subprograms import MIN_SUBPROGRAM_BYTES

#: A setting as text, as a number, or as several numbers (``zero``).
SettingValue: TypeAlias = str | float | Iterable[float]

#: Settings by their keys.
Settings: TypeAlias = Mapping[str, SettingValue]

#: Settings with few values, the default first.
_CHOICES: Final = {
    "units": ("mm", "inch"),
    "numbers": ("on", "off"),
    "programs": ("one", "operations"),
    "tcp": ("on", "off"),
    "frame": ("first", "absolute"),
    "rewind": ("insert", "none"),
    "pole": tuple(PoleStrategy),
    "lower_feed": ("no", "yes"),
    "cycles": ("on", "off"),
    **PROGRAM_CHOICES,
}

#: Settings that are numbers: lowest and highest value, and what to write.
_NUMBERS: Final = {
    "pole_angle": (1e-3, 10.0, "pole_angle=DEG, by how much the tool axis may lean near the pole, such as 0.1"),
    "tip_tolerance": (1e-4, 10.0, "tip_tolerance=MM, how far the tip may be off between points, such as 0.005"),
    "axis_tolerance": (1e-3, 10.0, "axis_tolerance=DEGREES, how far the tool axis may be off, such as 0.05"),
    "split": (
        MIN_SUBPROGRAM_BYTES,
        1e12,
        f"split=BYTES, the largest size of a subprogram, at least {MIN_SUBPROGRAM_BYTES}",
    ),
    "tool_retract": (0.0, 1e4, "tool_retract=MM, how far along the tool axis before it goes home, such as 50"),
    "limit_margin": (0.0, 1e3, "limit_margin=NUMBER, how far axes stay from their limits, mm and degrees, such as 0.5"),
    "tool_length": (0.0, 1e4, "tool_length=MM, from the spindle's gauge point to the tip, such as tool_length=120.5"),
}

#: Settings of the post itself; all others belong to the control, whose templates print them.
RUN_SETTINGS: Final = (*_CHOICES, *_NUMBERS, "mode", "zero", "clearance")

#: The farthest that the workpiece zero may be from the origin of the machine, mm.
_FARTHEST_ZERO: Final = 1e5

#: Lengths and angles of ``check_tolerance`` are below this.
_GREATEST_TOLERANCE: Final = 1e6


def as_texts(settings: Settings | None) -> dict[str, str]:
    """Settings as text, in the form that ``--set`` takes."""
    return {key: _as_text(value) for key, value in (settings or {}).items()}


def _as_text(value: SettingValue) -> str:
    if isinstance(value, Iterable) and not isinstance(value, str):
        return ",".join(str(float(part)) for part in value)
    return str(value)


def check_settings(settings: Mapping[str, str], control: Control) -> None:
    """Raise ``InputError`` for all settings that the control does not have or that make no sense."""
    known = (*control.settings, *RUN_SETTINGS)
    problems = [
        Problem("--set", 0, f"{key} is not a setting of {control.name}", f"write one of {', '.join(known)}")
        for key in settings
        if key not in known
    ]
    problems += [
        Problem("--set", 0, f"{key} has a line break or a control character in it", "write it in one line")
        for key, value in settings.items()
        if any(ord(character) < 32 for character in value)
    ]
    problems += [
        Problem("--set", 0, f"{key} is {settings[key]!r}", f"write {' or '.join(f'{key}={one}' for one in choices)}")
        for key, choices in {**_CHOICES, **control.family.SETTING_CHOICES}.items()
        if settings.get(key, choices[0]) not in choices
    ]
    problems += [
        Problem("--set", 0, f"{key} is {settings[key]!r}", cure)
        for key, cure in control.family.validate_settings(settings)
    ]
    if not settings.get("edge", "1").isdigit():
        problems.append(Problem("--set", 0, f"edge is {settings['edge']!r}", "write a whole number, such as edge=1"))
    if problems:
        raise InputError(problems)


def split_by_operation(
    settings: Mapping[str, str], control: Control
) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """Settings of the program, and those of single operations by their names: ``method=ROUGH,TOP:FINISH``.

    Raises
    ------
    InputError
        If an operation is given a value that the control cannot have, or a setting has two values for all operations.
    """
    program: dict[str, str] = {}
    own: dict[str, dict[str, str]] = {}
    problems: list[Problem] = []
    for key, text in settings.items():
        if ":" not in text or not control.differs_by_operation(key):
            program[key] = text
            continue
        for entry in text.split(","):
            name, _, value = entry.rpartition(":")
            if name:
                own.setdefault(name, {})[key] = value
            elif key in program:
                cure = f"write {key}=VALUE,OPERATION:VALUE: a text can have no comma beside a colon"
                problems.append(Problem("--set", 0, f"{key} has two values for all operations: {text!r}", cure))
            else:
                program[key] = value
    if problems:
        raise InputError(problems)
    for values in own.values():
        check_settings({**program, **values}, control)
    return program, own


def check_operation_names(
    own: Mapping[str, Mapping[str, str]], settings: Mapping[str, str], names: Iterable[str]
) -> None:
    """Raise ``InputError`` for settings of operations not among ``names``, or where ``settings`` cannot differ."""
    known = list(dict.fromkeys(names))
    cure = f"write one of {', '.join(known)}; in a setting that can differ by operation, a colon follows its name"
    problems = [
        Problem("--set", 0, f"{key} is set for operation {name}, and the program has none of that name", cure)
        for name, values in own.items()
        if name not in known
        for key in values
    ]
    problems += [
        Problem("--set", 0, f"{key} is {text!r}, and it cannot differ by operation", f"write {key}=VALUE")
        for key, text in settings.items()
        if key != "mode" and any(entry.rpartition(":")[0] in known for entry in text.split(",") if ":" in entry)
    ]
    if problems:
        raise InputError(problems)


def number_setting(settings: Mapping[str, str], key: str) -> float | None:
    """A setting as a number; None if it is not set.

    Raises
    ------
    InputError
        If it is not a number, or out of range.
    """
    text = settings.get(key)
    if text is None:
        return None
    low, high, cure = _NUMBERS[key]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise InputError(Problem("--set", 0, f"{key} is {text!r}", f"write {cure}"))
    return value


def apply_setup(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """The machine with the workpiece zero and the tool length of the settings."""
    if "zero" in settings:
        machine = replace(machine, workpiece_zero=_point_setting(settings["zero"]))
    length = number_setting(settings, "tool_length")
    return machine if length is None else replace(machine, tool_length=length)


def with_limit_margin(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """The machine for planning: every limit is nearer by the setting ``limit_margin``.

    Raises
    ------
    InputError
        If an axis has no travel left.
    """
    margin = number_setting(settings, "limit_margin")
    if not margin:
        return machine
    axes = [
        axis if axis.endless else replace(axis, low=axis.low + margin, high=axis.high - margin) for axis in machine.axes
    ]
    lost = [axis.name for axis in axes if not axis.low < axis.high]
    if lost:
        what = f"limit_margin is {margin:g}, and axis {lost[0]} has no travel left"
        raise InputError(Problem("--set", 0, what, "write a smaller number"))
    return replace(machine, axes=tuple(axes))


def set_up_machine(machine: Machine, zero: str | Iterable[float] | None, tool_length: str | float | None) -> Machine:
    """The machine with its workpiece zero and its tool length, mm, where they are given."""
    given = {"zero": zero, "tool_length": tool_length}
    return apply_setup(machine, as_texts({key: value for key, value in given.items() if value is not None}))


def check_tolerance(option: str, value: float | None) -> None:
    """Raise ``InputError`` for a tolerance that is not above 0."""
    if value is not None and not 0.0 < value < _GREATEST_TOLERANCE:
        raise InputError(Problem(option, 0, f"is {value!r}", "give a number above 0, such as 0.001"))


def m_code(text: str) -> int | None:
    """Return the number of an M word; None where there is none."""
    return int(text[1:]) if text[:1] == "M" and text[1:].isdigit() else None


def work_offset_number(text: str) -> int | None:
    """The number of a work offset: 54 for ``G54``, 603 for ``G54.1 P3``, 501 for ``G55 O1``; None for other names."""
    code = text.strip().upper().removeprefix("G")
    origin = re.fullmatch(r"55 +O0*(\d{1,2})", code)
    if origin:
        return ORIGIN_OFFSET_BASE + int(origin[1])
    extended = re.fullmatch(r"54\.1 *P0*(\d{1,3})", code)
    if extended:
        return EXTENDED_OFFSET_BASE + int(extended[1])
    return int(code) if code.isdigit() else None


def _point_setting(text: str) -> tuple[float, float, float]:
    """The setting ``zero``: X, Y and Z in mm."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = math.nan
    if not max(abs(x), abs(y), abs(z)) <= _FARTHEST_ZERO or math.isnan(x + y + z):
        cure = "write zero=X,Y,Z: the workpiece zero on the machine, mm, such as zero=0,0,120.5"
        raise InputError(Problem("--set", 0, f"zero is {text!r}", cure))
    return x, y, z
