"""Settings of a post by their keys: the same for ``--set`` and for the library.

In:     settings as text or numbers.
Out:    text that is checked; numbers, points, and the machine as it is set up.
"""

import datetime
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np

from trunnion import readers
from trunnion.controls import Control
from trunnion.controls.setting_rules import is_one_line
from trunnion.controls.vocabulary import TCP_SETTINGS
from trunnion.definitions.messages import did_you_mean
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.machines import Machine

#: A setting as text, as a number, as several numbers (``zero``), on or off, or None: it is not set.
SettingValue: TypeAlias = str | float | bool | datetime.date | Iterable[float] | None

#: Settings by their keys.
Settings: TypeAlias = Mapping[str, SettingValue]

#: What True and False mean, as far as a setting has such a word.
_SWITCHES: Final = {True: ("on", "yes"), False: ("off", "no")}

#: The farthest that the workpiece zero may be from the origin of the machine, mm.
_FARTHEST_ZERO: Final = 1e5

#: Lengths and angles of ``check_tolerance`` are below this.
_GREATEST_TOLERANCE: Final = 1e6


def as_texts(settings: Settings | None) -> dict[str, str]:
    """Return settings as text, in the form that ``--set`` takes; those that are None are not set.

    Raises
    ------
    InputError
        If this is no mapping of texts to values, or with every value of a type that no setting has.
    """
    if settings is None:
        return {}
    if not isinstance(settings, Mapping):
        what, cure = f"is a {type(settings).__name__}", 'give a mapping, such as {"title": "BLADE", "tolerance": 0.01}'
        raise InputError(argument_problem("settings", what, cure, code="ARG140"))
    problems = [
        argument_problem(
            "settings", f"the key {key!r} is a {type(key).__name__}", "write the name of a setting", code="ARG140"
        )
        for key in settings
        if not isinstance(key, str)
    ]
    texts = {key: _as_text(key, value) for key, value in settings.items() if value is not None}
    wrong = [key for key, text in texts.items() if text is None]
    problems += [_problem(key, settings[key], "write a text or a number") for key in wrong if isinstance(key, str)]
    if problems:
        raise InputError(problems)
    return {key: text for key, text in texts.items() if text is not None}


def _as_text(key: str, value: object) -> str | None:
    """Return a setting as text; None if it is of a type that settings do not have."""
    if isinstance(value, bool | np.bool_):
        words = RUN_SETTINGS[key].choices if key in RUN_SETTINGS else ()
        return next((word for word in _SWITCHES[bool(value)] if word in words), None)
    if isinstance(value, str | int | np.integer | datetime.date):
        return str(value)
    if isinstance(value, float | np.floating):
        return np.format_float_positional(value, trim="-") if np.isfinite(value) else None
    # Several numbers are for the few settings that have them; a text of numbers that nobody wrote is none.
    several = key in RUN_SETTINGS and "," in RUN_SETTINGS[key].form
    if not several or isinstance(value, bytes | Mapping) or not isinstance(value, Iterable):
        return None
    parts = list(value)
    numbers = [part for part in parts if isinstance(part, int | float | np.number) and not isinstance(part, bool)]
    return ",".join(str(float(part)) for part in numbers) if len(numbers) == len(parts) else None


def _problem(key: str, value: object, cure: str) -> Problem:
    return argument_problem("settings", f"{key} is {value!r}", cure, code="ARG220")


def check_settings(settings: Mapping[str, str], control: Control, machine: Machine) -> None:
    """Raise ``InputError`` for all settings that the control does not have or that it cannot have."""
    problems = [_unknown_setting(key, control) for key in settings if key not in {*control.settings, *RUN_SETTINGS}]
    problems += [
        _problem(key, value, "write one line without control characters")
        for key, value in settings.items()
        if key not in control.settings and not is_one_line(value)
    ]
    problems += [
        _problem(key, settings[key], setting.cure(key))
        for key, setting in RUN_SETTINGS.items()
        if key in settings and setting.choices and settings[key] not in setting.choices
    ]
    if settings.get("preselect") == "on" and not control.family.tool_preselection("1"):
        cure = f"leave it out: it is not known how {control.name} selects a tool before it is called"
        problems.append(_problem("preselect", "on", cure))
    known = {**control.settings, **settings}
    problems += [
        _problem(key, known[key], f"{cure}{_meaning(key, control)}")
        for key, cure in control_setting_faults(settings, control, machine)
    ]
    if problems:
        raise InputError(problems)


def _meaning(key: str, control: Control) -> str:
    meaning = control.setting_meanings.get(key)
    return f". {meaning}" if meaning else ""


def control_setting_faults(settings: Mapping[str, str], control: Control, machine: Machine) -> list[tuple[str, str]]:
    """Return the settings of a control that cannot be as they are, each with its cure."""
    judged = {key: control.setting_cure(key, value) for key, value in settings.items() if key in control.settings}
    faults = [(key, cure) for key, cure in judged.items() if cure]
    faults += [(key, _no_effect(key, control)) for key in judged if _is_idle(key, settings[key], control)]
    if "work_offset" in judged and readers.can_read(machine):
        offsets = readers.reader_of(machine).work_offsets
        faults += [] if offsets.value_of(settings["work_offset"]) else [("work_offset", f"write {offsets.form}")]
    effective = {**control.settings, **{key: value for key, value in settings.items() if value}}
    own = [key for key in judged if settings[key] not in ("", control.settings[key])]
    beside = {key: control.missing_beside(key, effective) for key in own}
    faults += [(key, f"write {name} too: without it no line has it") for key, name in beside.items() if name]
    found = dict(faults)
    return faults + [(key, cure) for key, cure in control.family.validate_settings(effective) if key not in found]


def _is_idle(key: str, text: str, control: Control) -> bool:
    """Whether a setting asks for something that would not be in the program."""
    return bool(text) and text != control.settings[key] and not control.has_effect(key)


def _no_effect(key: str, control: Control) -> str:
    fields = " or ".join(f"{{{name}}}" for name in control.family.SETTING_FIELDS.get(key, (key,)))
    where = "it has no TCP" if key in TCP_SETTINGS else f"no template of its definition has {fields}"
    return f"leave it out: it has no effect on {control.name}, for {where}"


def _unknown_setting(key: str, control: Control) -> Problem:
    known = (*control.settings, *RUN_SETTINGS)
    cure = did_you_mean(key, known) or f"{control.name} has {', '.join(sorted(known))}"
    return argument_problem("settings", f"{key} is not a setting of {control.name}", cure, code="ARG210")


def split_by_operation(
    settings: Mapping[str, str], control: Control, machine: Machine
) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """Return settings of the program, and those of single operations by their names: ``method=ROUGH,TOP:FINISH``.

    Raises
    ------
    InputError
        If an operation is given a value that the control cannot have, or a setting has two values for all operations.
    """
    program: dict[str, str] = {}
    own: dict[str, dict[str, str]] = {}
    problems: list[Problem] = []
    for key, text in settings.items():
        for name, value in control.values_by_operation(key, text):
            if name and key in own.get(name, ()):
                what = f"{key} has two values for operation {name}: {text!r}"
                problems.append(argument_problem("settings", what, f"write {key}={name}:VALUE once", code="ARG230"))
            elif name:
                own.setdefault(name, {})[key] = value
            elif key in program:
                cure = f"write {key}=VALUE,OPERATION:VALUE: a text can have no comma beside a colon"
                problems.append(
                    argument_problem(
                        "settings", f"{key} has two values for all operations: {text!r}", cure, code="ARG230"
                    )
                )
            else:
                program[key] = value
    if problems:
        raise InputError(problems)
    for values in own.values():
        check_settings({**program, **values}, control, machine)
    return program, own


def check_operation_names(
    own: Mapping[str, Mapping[str, str]], settings: Mapping[str, str], names: Iterable[str]
) -> None:
    """Raise ``InputError`` for settings of operations not among ``names``, or where ``settings`` cannot differ."""
    known = list(dict.fromkeys(names))
    cure = f"write one of {', '.join(known)}; in a setting that can differ by operation, a colon follows its name"
    problems = [
        argument_problem(
            "settings", f"{key} is set for operation {name}, and the program has none of that name", cure, code="ARG230"
        )
        for name, values in own.items()
        if name not in known
        for key in values
    ]
    problems += [
        argument_problem(
            "settings", f"{key} is {text!r}, and it cannot differ by operation", f"write {key}=VALUE", code="ARG230"
        )
        for key, text in settings.items()
        if key != "mode" and any(entry.rpartition(":")[0] in known for entry in text.split(",") if ":" in entry)
    ]
    if problems:
        raise InputError(problems)


def number_setting(settings: Mapping[str, str], key: str) -> float | None:
    """Return a setting as a number; None if it is not set.

    Raises
    ------
    InputError
        If it is not a number, or out of range.
    """
    text = settings.get(key)
    if text is None:
        return None
    setting = RUN_SETTINGS[key]
    assert setting.bounds is not None
    low, high = setting.bounds
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise InputError(_problem(key, text, setting.cure(key)))
    return value


def apply_setup(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """Return the machine with the workpiece zero and the tool length of the settings."""
    if "zero" in settings:
        machine = replace(machine, workpiece_zero=_point_setting(settings["zero"]))
    length = number_setting(settings, "tool_length")
    return machine if length is None else replace(machine, tool_length=length)


def with_limit_margin(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """Return the machine for planning: every limit is nearer by the setting ``limit_margin``.

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
        raise InputError(argument_problem("settings", what, "write a smaller number", code="ARG220"))
    return replace(machine, axes=tuple(axes))


def set_up_machine(machine: Machine, zero: str | Iterable[float] | None, tool_length: str | float | None) -> Machine:
    """Return the machine with its workpiece zero and its tool length, mm, where they are given.

    Raises
    ------
    InputError
        Of the argument, if it cannot be.
    """
    for name, value in (("zero", zero), ("tool_length", tool_length)):
        try:
            machine = apply_setup(machine, as_texts({name: value}))
        except InputError as error:
            raise InputError([_of_argument(problem, name) for problem in error.problems]) from None
    return machine


def _of_argument(problem: Problem, name: str) -> Problem:
    """Return a problem with a setting as one with the argument of its name."""
    what, cure = problem.what.removeprefix(f"{name} "), problem.cure.replace(f"write {name}=", "write ", 1)
    return argument_problem(name, what, cure, problem.severity, code=problem.code)


def check_tolerance(argument: str, value: object, *, optional: bool = False) -> None:
    """Raise ``InputError`` for a tolerance, mm or degrees, that is no number above 0; an optional one may be None."""
    if value is None and optional:
        return
    if isinstance(value, int | float | np.number) and not isinstance(value, bool | np.complexfloating):
        is_tolerance = 0.0 < float(value) < _GREATEST_TOLERANCE
    else:
        is_tolerance = False
    if not is_tolerance:
        raise InputError(
            argument_problem(argument, f"is {value!r}", "give a number above 0, such as 0.001", code="ARG140")
        )


def m_code(text: str) -> int | None:
    """Return the number of an M word; None where there is none."""
    return int(text[1:]) if text[:1] == "M" and text[1:].isdigit() else None


def work_offset_setting(text: str, machine: Machine) -> int | None:
    """Return the value in the column ``Run.work_offset`` of a work offset as programs for a machine write it.

    None if nothing reads programs for the machine.

    Raises
    ------
    InputError
        If it is no work offset of the machine's control.
    """
    if not readers.can_read(machine):
        return None
    offsets = readers.reader_of(machine).work_offsets
    value = offsets.value_of(" ".join(text.upper().split()))
    if value is None:
        raise InputError(argument_problem("work_offset", f"is {text!r}", f"write {offsets.form}", code="ARG220"))
    return value


def _point_setting(text: str) -> tuple[float, float, float]:
    """Return the setting ``zero``: X, Y and Z in mm."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = math.nan
    if not max(abs(x), abs(y), abs(z)) <= _FARTHEST_ZERO or math.isnan(x + y + z):
        raise InputError(_problem("zero", text, RUN_SETTINGS["zero"].cure("zero")))
    return x, y, z
