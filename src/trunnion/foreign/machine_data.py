"""Machine data of a SINUMERIK 840D sl: an archive of the commissioning, or a list, as text.

In:     lines such as ``N36100 $MA_POS_LIMIT_MINUS[AX1]=-250`` or ``36100 $MA_POS_LIMIT_MINUS[AX1] -250``.
Out:    a ``ForeignMachine``.
Units:  data have mm, degrees, mm/min and rev/min, m/s^2 and rev/s^2.

Numbers and names are those of the lists of machine data: 10000 names of machine axes, 20080 of channel axes, 30300 and
30310 rotary and modulo axes, 32000 and 32300 highest speed and acceleration, 34100 reference point, 36100 and 36110
software limits, 24100 type of the first transformation with its axes in 24110.
"""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.foreign.machine import ForeignMachine, Key, Left, Stated, marks_of_controls, read_text
from trunnion.messages import Wording

_LINE: Final = re.compile(
    r"\s*(?:N?\d{5}\s+)?\$M([NCA])_(\w+)(?:\[([^\]]*)\])?\s*(?:=|\s)\s*(\"[^\"]*\"|'[^']*'|[-+.\w]+)\s*(?:;.*)?$"
)
_AXIS: Final = re.compile(r"(?:(\d),)?AX(\d+)")

_MM_PER_M, _DEG_PER_TURN = 1000.0, 360.0

#: Type of transformation, without its lowest bits -> what the first and the second rotary axis carry.
_TYPES: Final = {16: ("tool", "tool"), 32: ("part", "part"), 48: ("part", "tool")}

_OF_AXES: Final = ("POS_LIMIT_MINUS", "POS_LIMIT_PLUS", "MAX_AX_VELO", "MAX_AX_ACCEL")

#: A reference point is a place of its own, and no home for tool changes.
_NOT_TAKEN: Final = {
    "TRAFO5_PART_OFFSET_1": "compare it at the control: it counts from the table, not from the machine's frame",
    "TRAFO5_JOINT_OFFSET_1": "compare it with the points of the rotary axes: it goes from one to the other",
    "TRAFO5_JOINT_OFFSET_PART_1": "compare it with the points of the rotary axes: it goes from one to the other",
    "TRAFO5_BASE_TOOL_1": "compare it with the pivot of the head",
    "TRAFO5_ROT_AX_OFFSET_1": "a definition has no offset of an angle",
    "TRAFO5_ROT_SIGN_IS_PLUS_1": "jog the axis: the sense of a definition is that of the tool, seen from the part",
    "REFP_SET_POS": "a reference point is no position for a tool change",
}


def read_machine_data(file: Path) -> ForeignMachine:
    """Return the machine of a file of machine data.

    Raises ``InputError`` if it cannot be read, or names no axes.
    """
    data: dict[tuple[str, str], Stated] = {}
    repeated: list[Left] = []
    for number, line in enumerate(read_text(file).splitlines(), 1):
        if not (found := _LINE.match(line)):
            continue
        key = (found[2].upper(), (found[3] or "").replace(" ", "").upper())
        value = Stated(found[4].strip("\"'"), f"$M{found[1]}_{found[2]}[{found[3] or ''}]", str(file), number)
        known = data.setdefault(key, value)
        if known is not value and known.value != value.value:
            repeated.append(Left(f"{value.name} = {value.value}", value.place, f"line {known.line} counts"))
    if not any(name in ("POS_LIMIT_MINUS", "IS_ROT_AX", "MAX_AX_VELO") for name, _ in data):
        raise InputError(Problem(str(file), 0, Wording("DEF630", "no_data_of_axes")))
    metric = data.get(("SCALING_SYSTEM_IS_METRIC", ""))
    if metric is not None and str(metric.value).upper() in ("0", "FALSE"):
        raise InputError(Problem(str(file), metric.line, Wording("DEF630", "inches")))
    names = _names(data)
    values = dict(_values(data, names))
    return ForeignMachine(
        _rotary(data, names), values, (*repeated, *_left(data, names)), marks_of_controls()["machine_data"]["control"]
    )


def _names(data: Mapping[tuple[str, str], Stated]) -> dict[int, str]:
    """Return the names of axes by their numbers: as the channel calls them, else as the machine does."""
    found: dict[int, str] = {}
    for (name, index), value in data.items():
        if name == "AXCONF_MACHAX_NAME_TAB" and index.isdecimal():
            found.setdefault(int(index) + 1, str(value.value))
    for (name, index), used in data.items():
        if name == "AXCONF_MACHAX_USED" and index.isdecimal() and str(used.value).isdecimal():
            channel = data.get(("AXCONF_CHANAX_NAME_TAB", index))
            if channel is not None:
                found[int(used.value)] = str(channel.value)
    return {number: _letter(name) for number, name in found.items() if re.fullmatch(r"[A-Za-z]\w{0,7}", name)}


def _letter(name: str) -> str:
    """Return the name of an axis in a definition: machine axes have a number behind their letter (X1)."""
    return name[0].upper() if re.fullmatch(r"[A-Za-z]1", name) else name.upper()


def _number(value: Stated | None) -> float | None:
    try:
        return None if value is None else float(value.value)
    except ValueError:
        return None


def _of_axis(data: Mapping[tuple[str, str], Stated], name: str, axis: int) -> Stated | None:
    """Return a datum of an axis; of one with sets, the first."""
    return data.get((name, f"AX{axis}")) or data.get((name, f"0,AX{axis}"))


def _is_rotary(data: Mapping[tuple[str, str], Stated], axis: int) -> bool:
    found = _of_axis(data, "IS_ROT_AX", axis)
    return found is not None and str(found.value).upper() in ("1", "TRUE")


def _values(data: Mapping[tuple[str, str], Stated], names: Mapping[int, str]) -> Iterator[tuple[Key, Stated]]:
    for axis, name in names.items():
        turns = _is_rotary(data, axis)
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


def _transformed(data: Mapping[tuple[str, str], Stated]) -> list[int]:
    """Return the numbers of the two rotary axes of the first transformation, as its data have them."""
    channel = [data.get(("TRAFO_AXES_IN_1", str(place))) for place in (3, 4)]
    used = [
        data.get(("AXCONF_MACHAX_USED", str(int(each.value) - 1)))
        for each in channel
        if each and each.value.isdecimal()
    ]
    found = [int(each.value) for each in used if each is not None and str(each.value).isdecimal()]
    return found if len(found) == 2 else []


def _rotary(data: Mapping[tuple[str, str], Stated], names: Mapping[int, str]) -> tuple[tuple[str, str], ...]:
    """Return the rotary axes from the workpiece to the tool, where the type of the transformation says what they carry.

    The first axis of the data of two tables carries the second; that of two heads carries it, too; of the mixed ones
    the first turns the part.
    """
    kind = data.get(("TRAFO_TYPE_1", ""))
    number = int(kind.value) if kind is not None and str(kind.value).isdecimal() else 0
    mounts = _TYPES.get(number & 0x70)
    axes = _transformed(data)
    if mounts is None or len(axes) != 2 or any(axis not in names for axis in axes):
        return ()
    order = [(names[axes[0]], mounts[0]), (names[axes[1]], mounts[1])]
    return tuple(reversed(order)) if mounts == ("part", "part") else tuple(order)


def _left(data: Mapping[tuple[str, str], Stated], names: Mapping[int, str]) -> Iterator[Left]:
    taken = {(value.file, value.line) for _, value in _values(data, names)}
    for (name, index), value in data.items():
        if name in _OF_AXES and (value.file, value.line) not in taken and (axis := _AXIS.fullmatch(index)):
            partner = data.get(("POS_LIMIT_MINUS", index)) if name == "POS_LIMIT_PLUS" else None
            if int(axis[2]) not in names:
                yield Left(f"{value.name} = {value.value}", value.place, "no name of this axis is stated")
            elif partner is None or (partner.file, partner.line) not in taken:
                yield Left(f"{value.name} = {value.value}", value.place, "no value of the axis can be made of it")
    for (name, index), value in data.items():
        axis = _AXIS.fullmatch(index)
        if name in _NOT_TAKEN and (axis is None or int(axis[2]) in names):
            yield Left(f"{value.name} = {value.value}", value.place, _NOT_TAKEN[name])
