"""Settings of a post by their keys: the same for ``--set`` and for the library.

In:     settings as text or numbers.
Out:    text that is checked; numbers, points, and the machine as it is set up.
"""

import datetime
import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np

from trunnion import readers
from trunnion.controls import Control
from trunnion.controls.setting_rules import is_one_line
from trunnion.controls.vocabulary import TCP_SETTINGS
from trunnion.definitions.messages import meant_word
from trunnion.definitions.setting_text import setting_text
from trunnion.errors import InputError, Problem, argument_problem, setting_problem
from trunnion.jobs.inputs.arguments import no_mapping
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.machines import Machine
from trunnion.messages import Wording, declared, phrase

#: A setting as text, as a number, as several numbers (``zero``), on or off, or None: it is not set.
SettingValue: TypeAlias = (
    str | float | bool | datetime.date | Iterable[float] | Mapping[str, float] | Mapping[str, Iterable[float]] | None
)

#: Settings by their keys.
Settings: TypeAlias = Mapping[str, SettingValue]

#: Settings that may have a value for each tool, or for each work offset.
SINGLE_VALUES: Final = ("zero", "tool_length")

#: Settings of a post that may have a value for each operation.
BY_OPERATION: Final = ("compensation", "feed_rapid_from", "missing_feed", "mode", "open_cycle", "spindle")

#: What others call a setting.
_OTHER_NAMES: Final = dict.fromkeys(("speed", "rpm", "spindlespeed", "spindlesense"), "spindle")

#: Lengths and angles of ``check_tolerance`` are below this.
_GREATEST_TOLERANCE: Final = 1e6


def as_texts(settings: Settings | None) -> dict[str, str]:
    """Return settings as text, in the form that ``--set`` takes; those that are None are not set.

    Raises ``InputError`` if this is no mapping of texts to values, or with every value of a type that no setting has.
    """
    if settings is None:
        return {}
    if not isinstance(settings, Mapping):
        raise no_mapping("settings", settings)
    problems = [
        argument_problem("settings", Wording("ARG140", "no_name_of_setting", key=repr(key), type=type(key).__name__))
        for key in settings
        if not isinstance(key, str)
    ]
    texts = {key: _as_text(key, value) for key, value in settings.items() if value is not None}
    wrong = [key for key, text in texts.items() if text is None]
    problems += [setting_problem(key, _of_no_type(key, settings[key])) for key in wrong if isinstance(key, str)]
    if problems:
        raise InputError(problems)
    return {key: text for key, text in texts.items() if text is not None}


def _as_text(key: str, value: object) -> str | None:
    """Return a setting as text; None if it is of a type that settings do not have."""
    text = setting_text(value, RUN_SETTINGS[key].choices if key in RUN_SETTINGS else ())
    if text is not None or isinstance(value, bool | np.bool_ | float | np.floating):
        return text
    if isinstance(value, Mapping) and key in SINGLE_VALUES:
        texts = {name: _as_text(key, part) for name, part in value.items()}
        known = all(isinstance(name, str | int) and text is not None for name, text in texts.items())
        return ",".join(f"{name}={text}" for name, text in texts.items()) if texts and known else None
    # Several numbers are for the few settings that have them; a text of numbers that nobody wrote is none.
    several = key in RUN_SETTINGS and "," in RUN_SETTINGS[key].form
    if not several or isinstance(value, bytes | Mapping) or not isinstance(value, Iterable):
        return None
    parts = list(value)
    numbers = [part for part in parts if isinstance(part, int | float | np.number) and not isinstance(part, bool)]
    return ",".join(str(float(part)) for part in numbers) if len(numbers) == len(parts) else None


def _of_no_type(key: str, value: object) -> Wording:
    """Return the message about a value of a type that a setting does not have."""
    setting = RUN_SETTINGS.get(key)
    if setting is not None and setting.choices:
        return setting.fault(key, value)
    return Wording("ARG220", "neither_text_nor_number", value=repr(value))


def check_settings(settings: Mapping[str, str], control: Control, machine: Machine) -> None:
    """Raise ``InputError`` for all settings that the control does not have or that it cannot have."""
    problems = [_unknown_setting(key, control) for key in settings if key not in {*control.settings, *RUN_SETTINGS}]
    problems += [
        setting_problem(key, Wording("ARG220", "no_single_line", value=repr(value)))
        for key, value in settings.items()
        if key not in control.settings and not is_one_line(value)
    ]
    problems += [
        setting_problem(key, setting.fault(key, settings[key]))
        for key, setting in RUN_SETTINGS.items()
        if key in settings and setting.choices and settings[key] not in setting.choices
    ]
    if settings.get("preselect") == "on" and not control.family.tool_preselection("1"):
        problems.append(setting_problem("preselect", Wording("ARG220", "never_preselected", control=control.name)))
    known = {**control.settings, **settings}
    problems += [
        setting_problem(
            key, _of_control(known[key], remedy, declared(control.setting_meanings.get(key, ""), "meanings", key))
        )
        for key, remedy in control_setting_faults(settings, control, machine)
    ]
    if problems:
        raise InputError(problems)


def _of_control(value: str, remedy: Wording, meaning: Wording) -> Wording:
    if meaning.what:
        return Wording("ARG220", "not_of_control_with_meaning", value=repr(value), remedy=remedy, meaning=meaning)
    return Wording("ARG220", "not_of_control", value=repr(value), remedy=remedy)


def control_setting_faults(
    settings: Mapping[str, str], control: Control, machine: Machine
) -> list[tuple[str, Wording]]:
    """Return the settings of a control that cannot be as they are, each with what to do: a phrase."""
    judged = {key: control.allowed_instead(key, value) for key, value in settings.items() if key in control.settings}
    faults = [(key, phrase("write", allowed=allowed)) for key, allowed in judged.items() if allowed is not None]
    faults += [(key, _no_effect(key, control)) for key in judged if _is_idle(key, settings[key], control)]
    if "work_offset" in judged and readers.can_read(machine):
        offsets = readers.reader_of(machine).work_offsets
        if not offsets.value_of(settings["work_offset"]):
            faults.append(("work_offset", phrase("write", allowed=offsets.form_said)))
    effective = {**control.settings, **{key: value for key, value in settings.items() if value}}
    own = [key for key in judged if settings[key] not in ("", control.settings[key])]
    beside = {key: control.missing_beside(key, effective) for key in own}
    faults += [(key, phrase("write_too", name=name)) for key, name in beside.items() if name]
    found = dict(faults)
    return faults + [
        (key, phrase("write", allowed=allowed))
        for key, allowed in control.family.validate_settings(effective)
        if key not in found
    ]


def _is_idle(key: str, text: str, control: Control) -> bool:
    """Whether a setting asks for something that would not be in the program."""
    return bool(text) and text != control.settings[key] and not control.has_effect(key)


def _no_effect(key: str, control: Control) -> Wording:
    if key in TCP_SETTINGS:
        return phrase("no_effect_without_tcp", control=control.name)
    fields = tuple(f"{{{name}}}" for name in control.family.SETTING_FIELDS.get(key, (key,)))
    return phrase("no_effect_without_field", control=control.name, fields=fields)


def _unknown_setting(key: str, control: Control) -> Problem:
    known = tuple(sorted((*control.settings, *RUN_SETTINGS)))
    last = key.rpartition(".")[2]
    if near := last if last in known else meant_word(key, known, _OTHER_NAMES):
        return setting_problem(key, Wording("ARG210", "unknown_but_near", control=control.name, near=near))
    return setting_problem(key, Wording("ARG210", "unknown", control=control.name, known=known))


def split_by_operation(
    settings: Mapping[str, str], control: Control, machine: Machine
) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """Return settings of the program, and those of single operations by their names: ``method=ROUGH,TOP:FINISH``.

    Raises ``InputError`` if an operation is given a value that the control cannot have, or a setting has two values for
    all operations.
    """
    program: dict[str, str] = {}
    own: dict[str, dict[str, str]] = {}
    problems: list[Problem] = []
    for key, text in settings.items():
        for name, value in control.values_by_operation(key, text):
            if name and key in own.get(name, ()):
                twice = Wording("ARG230", "two_values_of_operation", name=key, operation=name, value=repr(text))
                problems.append(setting_problem(key, twice))
            elif name:
                own.setdefault(name, {})[key] = value
            elif key in program:
                twice = Wording("ARG230", "two_values_of_all_operations", name=key, value=repr(text))
                problems.append(setting_problem(key, twice))
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
    known = tuple(dict.fromkeys(names))
    problems = [
        setting_problem(key, Wording("ARG230", "no_operation_before_colon", name=name, known=known))
        for name, values in own.items()
        if name not in known
        for key in values
    ]
    problems += [
        setting_problem(key, Wording("ARG230", "cannot_differ", name=key, value=repr(text)))
        for key, text in settings.items()
        if key not in BY_OPERATION
        and any(entry.rpartition(":")[0] in known for entry in text.split(",") if ":" in entry)
    ]
    if problems:
        raise InputError(problems)


def number_setting(settings: Mapping[str, str], key: str) -> float | None:
    """Return a setting as a number; None if it is not set.

    Raises ``InputError`` if it is not a number, or out of range.
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
        raise InputError(setting_problem(key, setting.fault(key, text)))
    return value


def with_limit_margin(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """Return the machine for planning: every limit is nearer by the setting ``limit_margin``.

    Raises ``InputError`` if an axis has no travel left.
    """
    margin = number_setting(settings, "limit_margin")
    if not margin:
        return machine
    axes = [
        axis if axis.endless else replace(axis, low=axis.low + margin, high=axis.high - margin) for axis in machine.axes
    ]
    lost = [axis.name for axis in axes if not axis.low < axis.high]
    if lost:
        wording = Wording("ARG220", "no_travel_left", margin=margin, axis=lost[0])
        raise InputError(setting_problem("limit_margin", wording))
    return replace(machine, axes=tuple(axes))


def as_argument(problem: Problem, name: str) -> Problem:
    """Return a problem with a setting as one with an argument that stands for it, whose value stands alone."""
    setting = RUN_SETTINGS.get(problem.setting)
    own = {} if setting is None else {"written": setting.form, "choices": setting.choices}
    return argument_problem(name, problem.wording.bare().with_parameters(**own), severity=problem.severity)


@contextmanager
def reported_as_arguments(arguments: Mapping[str, str]) -> Iterator[None]:
    """Have problems with settings that arguments stand for told as problems with these.

    arguments   setting -> argument
    """
    try:
        yield
    except InputError as error:
        if not any(each.setting in arguments for each in error.problems):
            raise
        told = [
            as_argument(each, arguments[each.setting]) if each.setting in arguments else each for each in error.problems
        ]
        raise InputError(told) from None


def check_tolerance(argument: str, value: object, *, optional: bool = False) -> None:
    """Raise ``InputError`` for a tolerance, mm or degrees, that is no number above 0; an optional one may be None."""
    if value is None and optional:
        return
    if isinstance(value, int | float | np.number) and not isinstance(value, bool | np.complexfloating):
        is_tolerance = 0.0 < float(value) < _GREATEST_TOLERANCE
    else:
        is_tolerance = False
    if not is_tolerance:
        raise InputError(argument_problem(argument, Wording("ARG140", "no_tolerance", value=repr(value))))


def m_code(text: str) -> int | None:
    """Return the number of an M word; None where there is none."""
    return int(text[1:]) if text[:1] == "M" and text[1:].isdigit() else None


def work_offset_setting(text: str, machine: Machine) -> int | None:
    """Return the value in the column ``Run.work_offset`` of a work offset as programs for a machine write it.

    None if nothing reads programs for the machine.

    Raises ``InputError`` if it is no work offset of the machine's control.
    """
    if not readers.can_read(machine):
        return None
    offsets = readers.reader_of(machine).work_offsets
    value = offsets.value_of(" ".join(text.upper().split()))
    if value is None:
        wording = Wording("ARG220", "no_work_offset", value=repr(text), form=offsets.form_said)
        raise InputError(argument_problem("work_offset", wording))
    return value
