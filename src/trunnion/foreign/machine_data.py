"""Machine data of a SINUMERIK 840D sl: an archive of the commissioning, or a list, as text.

In:     lines such as ``N36100 $MA_POS_LIMIT_MINUS[AX1]=-250``, ``36100 $MA_POS_LIMIT_MINUS[AX1] -250`` or
        ``$TC_CARR7[1]=-1``.
Out:    a ``ForeignMachine``.
Units:  data have mm, degrees, mm/min and rev/min, m/s^2 and rev/s^2.

Numbers and names are those of the lists of machine data: 10000 names of machine axes, 20080 of channel axes, 30300 and
30310 rotary and modulo axes, 32000 and 32300 highest speed and acceleration, 34100 reference point, 36100 and 36110
software limits. Rotary axes are in ``chain_data``.
"""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.foreign.chain_data import Chain, Data, chain_of, of_value
from trunnion.foreign.machine import (
    ForeignMachine,
    Key,
    Left,
    Stated,
    because,
    index,
    marks_of_controls,
    not_taken,
    number,
    place_in,
    read_text,
)
from trunnion.messages import Wording

_LINE: Final = re.compile(
    r"\s*(?:N?\d{1,6}\s+)?\$(M[NCA]_\w+|TC_CARR\d{1,2})\s*(?:\[([^\]]*)\])?\s*(?:=|\s)\s*"
    r"(\"[^\"]*\"|'[^']*'|[-+.\w]+)\s*(?:;.*)?$"
)
_DATUM: Final = re.compile(r"\s*(?:N?\d{1,6}\s+)?\$(?:M[NCA]_|TC_CARR)")
_AXIS: Final = re.compile(r"(?:(\d),)?AX(\d{1,6})")

_MM_PER_M, _DEG_PER_TURN = 1000.0, 360.0

_OF_AXES: Final = ("POS_LIMIT_MINUS", "POS_LIMIT_PLUS", "MAX_AX_VELO", "MAX_AX_ACCEL")

#: Why data are not taken (texts of the catalogue ``foreign``): a reference point is no home for tool changes.
_NOT_TAKEN: Final = {
    "TRAFO5_ROT_AX_OFFSET_1": "no_offset_of_angle",
    "TRAFO5_ROT_SIGN_IS_PLUS_1": "jog_for_sense",
    "REFP_SET_POS": "reference_point",
}
#: Data that say which axis is which, or that are in ``chain_data``.
_USED: Final = re.compile(
    r"AXCONF_MACHAX_NAME_TAB|AXCONF_CHANAX_NAME_TAB|AXCONF_MACHAX_USED|IS_ROT_AX|ROT_IS_MODULO|SCALING_SYSTEM_IS_METRIC"
    r"|TRAFO_TYPE_1|TRAFO_AXES_IN_1|TRAFO5_\w+_1|TC_CARR\d+|REFP_SET_POS|" + "|".join(_OF_AXES)
)

#: Lines that are not understood, of which each is reported; the rest is counted.
_MOST_LINES: Final = 20


def read_machine_data(file: Path) -> ForeignMachine:
    """Return the machine of a file of machine data.

    Raises ``InputError`` if it cannot be read, or names no axes.
    """
    data: dict[tuple[str, str], Stated] = {}
    left: list[Left] = []
    odd: list[Left] = []
    for line_number, line in enumerate(read_text(file).splitlines(), 1):
        found = _LINE.match(line)
        if not found or (found[1].startswith("TC_CARR") and not found[2]):
            if _DATUM.match(line):
                odd.append(Left(line.strip()[:80], place_in(file, line_number), because("no_datum")))
            continue
        name = re.sub(r"M[NCA]_", "", found[1]).upper()
        key = (name, (found[2] or "").replace(" ", "").upper())
        label = f"${found[1]}[{found[2]}]" if found[2] else f"${found[1]}"
        value = Stated(found[3].strip("\"'"), label, str(file), line_number)
        known = data.setdefault(key, value)
        if known is not value and known.value != value.value:
            left.append(not_taken(value, because("line_counts", line=known.line)))
    left += odd[:_MOST_LINES]
    if len(odd) > _MOST_LINES:
        rest = odd[_MOST_LINES]
        left.append(Left(because("more_lines", count=len(odd) - _MOST_LINES), rest.where, rest.reason))
    if not any(name in ("POS_LIMIT_MINUS", "IS_ROT_AX", "MAX_AX_VELO", "TC_CARR23") for name, _ in data):
        raise InputError(Problem(str(file), 0, Wording("DEF630", "no_data_of_axes")))
    metric = data.get(("SCALING_SYSTEM_IS_METRIC", ""))
    if metric is not None and str(metric.value).upper() in ("0", "FALSE"):
        raise InputError(Problem(str(file), metric.line, Wording("DEF630", "inches")))
    names = _names(data, left)
    chain = chain_of(data, names)
    values = _with_chain(dict(_values(data, names, chain)), chain)
    control = marks_of_controls()["machine_data"]["control"]
    return ForeignMachine(_rotary(chain), values, (*left, *chain.left, *_left(data, names, chain)), control)


def _with_chain(values: dict[Key, Stated], chain: Chain) -> dict[Key, Stated]:
    """Add the lines of rotation; the software limits of an axis count before the range of the swivel data."""
    for key, value in chain.values.items():
        known = values.get(key) or values.get((*key[:2], "endless")) if key[2:] == ("limits_deg",) else None
        if known is None:
            values[key] = value
        elif known.value != value.value:
            why = because("range_of_cycle800", name=known.name, place=known.place)
            chain.left.append(Left(of_value(key, value), value.place, why))
    return values


def _rotary(chain: Chain) -> tuple[tuple[str, str], ...]:
    """Return the rotary axes from the workpiece to the tool: of two tables, and of one of each, the second is first."""
    order = chain.order
    return tuple(reversed(order)) if order and order[1][1] == "part" else order


def _names(data: Data, left: list[Left]) -> dict[int, str]:
    """Return the names of axes by their numbers: as the channel calls them, else as the machine does."""
    found: dict[int, Stated] = {}
    for (name, place), value in data.items():
        if name == "AXCONF_MACHAX_NAME_TAB" and (row := index(place)) is not None:
            found.setdefault(row + 1, value)
    for (name, place), used in data.items():
        if name == "AXCONF_MACHAX_USED" and index(place) is not None and (axis := index(used.value)):
            channel = data.get(("AXCONF_CHANAX_NAME_TAB", place))
            if channel is not None:
                found[axis] = channel
    names: dict[int, str] = {}
    for axis, value in found.items():
        if not re.fullmatch(r"[A-Za-z]\w{0,7}", str(value.value), re.ASCII):
            if value.value:
                left.append(not_taken(value, because("no_axis_name")))
        elif (name := _letter(str(value.value))) in names.values():
            left.append(not_taken(value, because("axis_name_taken", axis=name)))
        else:
            names[axis] = name
    return names


def _letter(name: str) -> str:
    """Return the name of an axis in a definition: machine axes have a number behind their letter (X1)."""
    return name[0].upper() if re.fullmatch(r"[A-Za-z]1", name) else name.upper()


def _number(value: Stated | None) -> float | None:
    return None if value is None else number(value.value)


def _of_axis(data: Data, name: str, axis: int) -> Stated | None:
    """Return a datum of an axis; of one with sets, the first."""
    return data.get((name, f"AX{axis}")) or data.get((name, f"0,AX{axis}"))


def _is_rotary(data: Data, axis: int) -> bool:
    found = _of_axis(data, "IS_ROT_AX", axis)
    return found is not None and str(found.value).upper() in ("1", "TRUE")


def _values(data: Data, names: Mapping[int, str], chain: Chain) -> Iterator[tuple[Key, Stated]]:
    turning = {name for name, _ in chain.order}
    for axis, name in names.items():
        turns = name in turning or _is_rotary(data, axis)
        unit, scale = ("deg", _DEG_PER_TURN) if turns else ("mm", 1.0)
        modulo = _of_axis(data, "ROT_IS_MODULO", axis)
        if turns and modulo is not None and str(modulo.value).upper() in ("1", "TRUE"):
            yield ("axis", name, "endless"), modulo.as_value(True)
        else:
            low, high = (_of_axis(data, f"POS_LIMIT_{end}", axis) for end in ("MINUS", "PLUS"))
            ends = _number(low), _number(high)
            if low is not None and ends[0] is not None and ends[1] is not None and ends[0] < ends[1]:
                yield ("axis", name, f"limits_{unit}"), low.as_value([ends[0], ends[1]])
        fastest, hardest = (_of_axis(data, datum, axis) for datum in ("MAX_AX_VELO", "MAX_AX_ACCEL"))
        if fastest is not None and (speed := _number(fastest)) and speed > 0.0:
            yield ("axis", name, f"rapid_{unit}_min"), fastest.as_value(speed * scale)
        if hardest is not None and (most := _number(hardest)) and most > 0.0:
            per_second = most * (_DEG_PER_TURN if turns else _MM_PER_M)
            yield ("axis", name, f"acceleration_{unit}_s2"), hardest.as_value(per_second)


def _left(data: Data, names: Mapping[int, str], chain: Chain) -> Iterator[Left]:
    taken = {(value.file, value.line) for _, value in _values(data, names, chain)}
    for (name, place), value in data.items():
        if name in _OF_AXES and (value.file, value.line) not in taken and (axis := _AXIS.fullmatch(place)):
            partner = data.get(("POS_LIMIT_MINUS", place)) if name == "POS_LIMIT_PLUS" else None
            if int(axis[2]) not in names:
                yield not_taken(value, because("axis_without_name"))
            elif partner is None or (partner.file, partner.line) not in taken:
                yield not_taken(value, because("no_value_of_axis"))
    for (name, place), value in data.items():
        axis = _AXIS.fullmatch(place)
        if name in _NOT_TAKEN and (axis is None or int(axis[2]) in names):
            yield not_taken(value, because(_NOT_TAKEN[name]))
    rest = [value for (name, _), value in data.items() if not _USED.fullmatch(name)]
    if rest:
        yield Left(because("other_machine_data", count=len(rest)), rest[0].place, because("no_such_values"))
