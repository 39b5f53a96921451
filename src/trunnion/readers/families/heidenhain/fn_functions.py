"""FN functions of Klartext: arithmetic with Q parameters, and jumps."""

import math
import re
from collections.abc import Callable
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.heidenhain.parameters import (
    FUNCTIONS,
    KlartextError,
    Parameters,
    canonical,
    checked,
    formula,
    guarded,
)
from trunnion.readers.families.heidenhain.words import FN_ACTS, FN_NOT_SIMULATED, FN_SYSTEM_DATA, FN_WAITS

#: A parameter in the words of a function.
_PARAMETER: Final = re.compile(r"Q[LR]?[0-9]{1,4}")

#: What is written to a table, from which parameters on, and what is read.
_TABLE_WRITE: Final = re.compile(r'TABWRITE[ \t]*([^/"]*)/[ \t]*"([^"]+)"[ \t]*=[ \t]*(Q[LR]?[0-9]{1,4})[ \t]*')
_TABLE_READ: Final = re.compile(r'TABREAD[ \t]*(Q[LR]?[0-9]{1,4})[ \t]*=([^/"]*)/[ \t]*"([^"]+)"[ \t]*')

#: Ends of the names of tables that programs define; the control's own (tools, presets, datums) have others.
_OWN_TABLE: Final = re.compile(r'TABOPEN[ \t]*"?[^"]*?(?:\.TAB|[\\/:][^.\\/:"]*)"?[ \t]*', re.IGNORECASE)

#: The left side of an assignment to a parameter.
ASSIGNED: Final = re.compile(r"(Q[LR]?[0-9]{1,4})[ \t]*=[ \t]*")

_OPERAND: Final = r"([+-]?[ \t]*(?:Q[LR]?[0-9]{1,4}|[0-9]+[.,]?[0-9]*|[.,][0-9]+))"
_NUMBER = re.compile(r"[ \t]*([0-9]{1,2})[ \t]*:?[ \t]*")

#: The label of a jump, which may be that of a text parameter.
_TARGET: Final = re.compile(r'[ \t]*(?:"[^"]*"|Q[LRS]?[0-9]{1,4}|[0-9]{1,5})[ \t]*')

#: Functions of two operands: the operator, and what it does.
_ARITHMETIC: Final[dict[int, tuple[str, Callable[[float, float], float]]]] = {
    1: (r"\+", lambda a, b: a + b),
    2: ("-", lambda a, b: a - b),
    3: (r"\*", lambda a, b: a * b),
    4: ("DIV", lambda a, b: a / b),
    8: ("LEN", math.hypot),
    # The angle whose sine and cosine have the ratio of the operands.
    13: ("ANG", lambda a, b: math.degrees(math.atan2(a, b)) % 360.0),
}

#: Functions of one operand.
_SINGLE: Final = {5: "SQRT", 6: "SIN", 7: "COS"}

#: Conditional jumps: the operator, and the condition.
_CONDITIONS: Final[dict[int, tuple[str, Callable[[float, float], bool]]]] = {
    9: ("EQU", lambda a, b: a == b),
    10: ("NE", lambda a, b: a != b),
    11: ("GT", lambda a, b: a > b),
    12: ("LT", lambda a, b: a < b),
}

#: Reads system data, which only the control knows.
_SYSTEM: Final = 18

#: Functions of tables: open, write, read.
_OPEN, _WRITE, _READ = 26, 27, 28

#: Functions that give the values of parameters to others: printers, the PLC, calling programs, messages.
_GIVES_VALUES: Final = frozenset({14, 15, 17, 19, 20, 25, 29, 37, 38})


def execute(text: str, parameters: Parameters, note: Note) -> str | None:
    """Execute a function; returns the label to jump to, as written, or None.

    text   what follows FN

    Raises ``KlartextError`` if the function is not understood; the parameter that it sets has no value then.
    """
    match = _NUMBER.match(text)
    if match is None:
        raise KlartextError(Wording("NC210", "fn_needs_number"))
    number, rest = int(match[1]), text[match.end() :]
    if number in _CONDITIONS:
        return _jump(number, rest, parameters)
    if number == _READ:
        _read_table(rest, parameters, note)
        return None
    if number in FN_NOT_SIMULATED:
        if number == _WRITE:
            _check_written(rest, parameters)
        elif number in _GIVES_VALUES:
            _check_values(rest, parameters)
        foreign = number == _OPEN and not _OWN_TABLE.fullmatch(rest)
        severity = Severity.ERROR if foreign or number in FN_SYSTEM_DATA else Severity.WARNING
        of_warning = "NC226" if number in FN_WAITS else "NC221"
        code = "NC220" if severity is Severity.ERROR else of_warning
        note(Wording(code, "fn_known_not_simulated", number=number, does=FN_NOT_SIMULATED[number]), severity)
        return None
    target = ASSIGNED.match(rest.removeprefix("SYSREAD").lstrip() if number == _SYSTEM else rest)
    if target is None:
        raise KlartextError(Wording("NC220", "fn_not_simulated", number=number))
    name = canonical(target[1])
    if number == _SYSTEM:
        parameters.forget(name)
        note(Wording("NC222", "fn_18_sysread_only_control", name=name), Severity.WARNING)
        return None
    try:
        parameters[name] = _value(number, rest[target.end() :].strip(), parameters)
    except KlartextError:
        parameters.forget(name)
        raise
    return None


def acting_function(text: str) -> int | None:
    """Return the number behind FN if the program stops, waits or speaks to the PLC there; None: it does not."""
    match = _NUMBER.match(text)
    return int(match[1]) if match is not None and int(match[1]) in FN_ACTS else None


def _check_values(text: str, parameters: Parameters) -> None:
    """Check that each parameter in words has a value; texts in quotes are none."""
    for name in _PARAMETER.findall(re.sub(r'"[^"]*"', "", text)):
        formula(name, parameters)


def _check_written(rest: str, parameters: Parameters) -> None:
    """Check that what is written to a table has values: one parameter for each column, in order of their numbers."""
    match = _TABLE_WRITE.fullmatch(rest)
    if match is None:
        raise KlartextError(Wording("NC220", "fn_not_simulated", number=_WRITE))
    _check_values(match[1], parameters)
    for name in _of_columns(match[3], match[2]):
        formula(name, parameters)


def _read_table(rest: str, parameters: Parameters, note: Note) -> None:
    """Read a table, which only the control has: one parameter for each column, in order of their numbers."""
    match = _TABLE_READ.fullmatch(rest)
    if match is None:
        raise KlartextError(Wording("NC220", "fn_not_simulated", number=_READ))
    for name in _of_columns(match[1], match[3]):
        parameters.forget(name)
        note(Wording("NC222", "tabread_only_control", name=name), Severity.WARNING)
    _check_values(match[2], parameters)


def _of_columns(first: str, columns: str) -> list[str]:
    """Return the parameters of the columns of a table, of which the first is given."""
    kind = first.rstrip("0123456789")
    number = int(first[len(kind) :])
    return [f"{kind}{number + k}" for k in range(len(columns.split(",")))]


def assign(name: str, text: str, parameters: Parameters) -> None:
    """Set a parameter by a formula; raises errors as ``execute`` does."""
    try:
        parameters[canonical(name)] = formula(text, parameters)
    except KlartextError:
        # The old value no longer holds.
        parameters.forget(canonical(name))
        raise


def _value(number: int, rest: str, parameters: Parameters) -> float:
    if number == 0:
        return formula(rest, parameters)
    if number in _SINGLE:
        word = _SINGLE[number]
        match = re.fullmatch(rf"{word}[ \t]*{_OPERAND}", rest)
        if match is None:
            raise KlartextError(Wording("NC210", "fn_takes_value", number=number, word=word))
        operand = formula(match[1], parameters)
        return guarded(lambda: FUNCTIONS[word](operand), word)
    if number not in _ARITHMETIC:
        raise KlartextError(Wording("NC220", "fn_not_simulated", number=number))
    word, work = _ARITHMETIC[number]
    match = re.fullmatch(rf"{_OPERAND}[ \t]*{word}[ \t]*{_OPERAND}", rest)
    if match is None:
        raise KlartextError(Wording("NC210", "fn_takes_two_values", number=number))
    first, second = formula(match[1], parameters), formula(match[2], parameters)
    return checked(guarded(lambda: work(first, second), f"FN {number}"))


def _jump(number: int, rest: str, parameters: Parameters) -> str | None:
    word, holds = _CONDITIONS[number]
    match = re.fullmatch(rf"IF[ \t]*{_OPERAND}[ \t]*{word}[ \t]*{_OPERAND}[ \t]*GOTO[ \t]*LBL(.*)", rest.rstrip())
    if match is None:
        raise KlartextError(Wording("NC210", "fn_takes_if_two_values", number=number, word=word))
    if not _TARGET.fullmatch(match[3]):
        raise KlartextError(Wording("NC210", "label_number_name_quotes"))
    first, second = formula(match[1], parameters), formula(match[2], parameters)
    return match[3] if holds(first, second) else None
