"""The settings of a program: what its headers contain that does not fit into a toolpath, as ``--set`` takes it."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from trunnion.controls.definition import Control
from trunnion.conversion.unsupported import Warnings
from trunnion.conversion.work_offsets import COMMON_OFFSETS
from trunnion.messages import Wording
from trunnion.model.machining_method import machining_method

#: Settings that mean the same on every control; the others are words and habits of a family.
_COMMON_SETTINGS = frozenset(
    {"title", "part", "date", "program", "tool", "tool_call", "tolerance", "fallback_tolerance"}
)

#: Settings whose defaults a program states, so that those of another machine must not take their place.
_DEFAULTS_OF_PROGRAMS = ("work_offset", "fallback_tolerance")

#: Tolerances that follow from INTOL and OUTTOL of an operation, where the definition sets none.
_TOLERANCES = ("tolerance", "three_axis_tolerance")

#: With another operation's value of these a part is scrap.
_MUST_NOT_BE_LOST = frozenset({"work_offset", *_TOLERANCES})

#: Tolerances are printed with five decimals.
_SAME_TOLERANCE = 5e-6


def settings_from_headers(
    control: Control, headers: Iterable[tuple[int, str, Mapping[str, str]]], warn: Warnings, target: Control
) -> dict[str, str]:
    """Return the settings that give the same headers again, without defaults.

    control  the control of the program
    headers  line, name of the operation, and values of each header
    warn     takes settings that differ between operations: a program has one value of each
    target   the control of the new program: a tolerance is left out only where it prints the same one without it
    """
    every = [
        _Header(line, operation, *_header_settings(control, values, target)) for line, operation, values in headers
    ]
    names = [header.operation for header in every]
    found: dict[str, str] = {}
    for name in dict.fromkeys(name for header in every for name in header.stated):
        stating = [header for header in every if name in header.stated]
        if all(header.says_what_follows(name) for header in stating):
            continue
        first = stating[0].stated[name]
        text = first or control.settings[name]
        for header in stating[1:]:
            value = header.stated[name]
            if value == first:
                continue
            is_named = names.count(header.operation) == 1 and not set(",:") & {*header.operation, *value}
            if is_named and control.differs_by_operation(name):
                text = f"{text},{header.operation}:{value}"
            else:
                _warn_of_one_value(warn, header.line, f"{name} is {value!r} here and {first!r} before", name)
        usual = target if name in _TOLERANCES and name in target.settings else control
        if text and not _equal_values(text, usual.settings[name]):
            found[name] = text
    return found


def transfer_settings(settings: Mapping[str, str], control: Control, target: Control) -> dict[str, str]:
    """Return the settings of a program for one control that another has too, and with the same meaning.

    A default of the program's own control that is another one on the target is stated.
    """
    stated = {**_differing_defaults(control, target), **settings}
    stated |= _modes_by_method(settings, control, target)
    known = {name: value for name, value in stated.items() if name in target.settings}
    if control.family is target.family:
        return known
    offsets = {control.settings.get("work_offset"), target.settings.get("work_offset")}
    offsets |= {offset for _, offset in control.values_by_operation("work_offset", stated.get("work_offset", "G54"))}
    same = _COMMON_SETTINGS | ({"work_offset"} if offsets <= COMMON_OFFSETS else frozenset())
    if target.settings.get("program", "").isdigit() and not settings.get("program", "").isdigit():
        same -= {"program"}  # a name, where programs have numbers
    return {name: value for name, value in known.items() if name in {*same, *target.method_defaults}}


def _differing_defaults(control: Control, target: Control) -> dict[str, str]:
    """Defaults of a control that another has too, with other values there."""
    both = [name for name in _DEFAULTS_OF_PROGRAMS if control.settings.get(name) and target.settings.get(name)]
    return {name: control.settings[name] for name in both if control.settings[name] != target.settings[name]}


def _modes_by_method(settings: Mapping[str, str], control: Control, target: Control) -> dict[str, str]:
    """Return settings of the target that follow from the machining method, for what those of the program say of the
    method.

    A mode that stands for several methods is that of the roughest.
    """
    found = {}
    for name, rules in control.method_defaults.items():
        methods = {value: part or "ROUGH" for part, value in rules}
        stated = control.values_by_operation(name, settings[name]) if name in settings else []
        if not stated or any(value not in methods for _, value in stated):
            continue
        for other in target.method_defaults:
            modes = [(operation, target.default_for_method(other, methods[value])) for operation, value in stated]
            found[other] = ",".join(f"{operation}:{mode}" if operation else f"{mode}" for operation, mode in modes)
    return found


def parse_number(text: str | None) -> float | None:
    """Return the number in a text; None if it is not one."""
    try:
        return float(text) if text else None
    except ValueError:
        return None


class _Header(NamedTuple):
    """The settings in the header of an operation.

    line, operation   of the header
    stated            what it says
    following         what it would say without a setting: what depends on method and tolerances of the operation
    """

    line: int
    operation: str
    stated: dict[str, str]
    following: dict[str, str]

    def says_what_follows(self, name: str) -> bool:
        """Whether a setting is what it would be if it were not set."""
        stated, following = self.stated[name], self.following.get(name)
        if name not in _TOLERANCES or following is None:
            return stated == following
        tolerance, other = parse_number(stated), parse_number(following)
        return tolerance is None or (other is not None and abs(tolerance - other) < _SAME_TOLERANCE)


def _warn_of_one_value(warn: Warnings, line: int, what: str, name: str) -> None:
    """Refuse, or warn of, a setting that differs between operations where the new program can have only one."""
    if name in _MUST_NOT_BE_LOST:
        warn.refuse(line, Wording("CNV142", "one_program_one", subject=what))
    else:
        warn(line, Wording("CNV142", "one_program", subject=what, name=name))


def _header_settings(
    control: Control, values: Mapping[str, str], target: Control
) -> tuple[dict[str, str], dict[str, str]]:
    """Return the settings in a header, and what follows from others on the target."""
    given = {name: value for name, value in values.items() if name in control.settings}
    intol, outtol = parse_number(values.get("intol")), parse_number(values.get("outtol"))
    default = control.settings.get("method", "")
    method = given.get("method", default)
    if method == default:
        method = machining_method(values.get("operation", ""), intol, outtol)
    fallback = parse_number(control.settings.get("fallback_tolerance")) or 0.0
    expected = intol + outtol if intol is not None and outtol is not None else fallback
    following = {name: control.default_for_method(name, method) or "" for name in control.method_defaults}
    tolerances = {"tolerance": str(expected), "three_axis_tolerance": given.get("tolerance") or str(expected)}
    following |= {name: value for name, value in tolerances.items() if not target.settings.get(name)}
    return given, following


def _equal_values(a: str, b: str) -> bool:
    """Whether two settings are the same, as text or as numbers."""
    first, second = parse_number(a), parse_number(b)
    return a == b or (first is not None and first == second)
