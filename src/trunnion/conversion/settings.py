"""The settings of a program: what its headers contain that does not fit into a toolpath, as ``--set`` takes it."""

from collections.abc import Iterable, Mapping

from trunnion.controls.definition import Control
from trunnion.conversion.unsupported import Warnings
from trunnion.conversion.work_offsets import COMMON_OFFSETS
from trunnion.model.machining_method import machining_method

#: Settings that mean the same on every control; the others are words and habits of a family.
_COMMON_SETTINGS = frozenset(
    {"title", "part", "date", "program", "tool", "tool_call", "tolerance", "fallback_tolerance"}
)

#: Tolerances are printed with five decimals.
_SAME_TOLERANCE = 5e-6


def settings_from_headers(
    control: Control, headers: Iterable[tuple[int, str, Mapping[str, str]]], warn: Warnings
) -> dict[str, str]:
    """The settings that give the same headers again, without defaults.

    Parameters
    ----------
    control
        The control of the program.
    headers
        Line, name of the operation, and values of each header.
    warn
        Takes settings that differ between operations: a program has one value of each.
    """
    merged: dict[str, str] = {}
    own: dict[str, str] = {}
    every = list(headers)
    names = [operation for _, operation, _ in every]
    for line, operation, values in every:
        for name, value in _header_settings(control, values).items():
            if merged.setdefault(name, value) == value:
                continue
            is_named = names.count(operation) == 1 and not set(",:") & {*operation, *value}
            if is_named and control.differs_by_operation(name):
                own[name] = f"{own.get(name, '')},{operation}:{value}"
                continue
            what = f"{name} is {value!r} here and {merged[name]!r} before; one program has one"
            if name == "work_offset":
                warn.refuse(line, what, "give each operation a name of its own")
            else:
                warn(line, what, f"the first is taken; see setting {name}=…")
    differing = {name: (merged.pop(name) or control.settings[name]) + text for name, text in own.items()}
    same = {name: value for name, value in merged.items() if value}
    return differing | {k: value for k, value in same.items() if not _equal_values(value, control.settings[k])}


def transfer_settings(settings: Mapping[str, str], control: Control, target: Control) -> dict[str, str]:
    """The settings of a program for one control that another has too, and with the same meaning."""
    known = {name: value for name, value in settings.items() if name in target.settings}
    if control.family is target.family:
        return known
    offsets = {control.settings.get("work_offset"), target.settings.get("work_offset")}
    offsets |= {entry.rpartition(":")[2] for entry in settings.get("work_offset", "").split(",") if entry}
    same = _COMMON_SETTINGS | ({"work_offset"} if offsets <= COMMON_OFFSETS else frozenset())
    if target.settings.get("program", "").isdigit() and not settings.get("program", "").isdigit():
        same -= {"program"}  # a name, where programs have numbers
    return {name: value for name, value in known.items() if name in same}


def parse_number(text: str | None) -> float | None:
    """The number in a text; None if it is not one."""
    try:
        return float(text) if text else None
    except ValueError:
        return None


def _header_settings(control: Control, values: Mapping[str, str]) -> dict[str, str]:
    """The settings in a header, without those that follow from others."""
    given = {name: value for name, value in values.items() if name in control.settings}
    intol, outtol = parse_number(values.get("intol")), parse_number(values.get("outtol"))
    default = control.settings.get("method", "")
    method = given.get("method", default)
    if method == default:
        method = machining_method(values.get("operation", ""), intol, outtol)
    for setting in control.method_defaults:
        if given.get(setting) == control.default_for_method(setting, method):
            given.pop(setting, None)
    fallback = parse_number(control.settings.get("fallback_tolerance")) or 0.0
    expected = intol + outtol if intol is not None and outtol is not None else fallback
    tolerance = parse_number(given.get("tolerance"))
    if tolerance is None or abs(tolerance - expected) < _SAME_TOLERANCE:
        given.pop("tolerance", None)
    return given


def _equal_values(a: str, b: str) -> bool:
    """Whether two settings are the same, as text or as numbers."""
    first, second = parse_number(a), parse_number(b)
    return a == b or (first is not None and first == second)
