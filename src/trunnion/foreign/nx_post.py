"""A post of NX Post Builder: the event handler (``.tcl``), the definition file (``.def``) and the builder's ``.pui``.

In:     the files of one post. None is run: statements ``set NAME "value"`` outside of procedures count, the last of a
        name, if the value is no expression.
Out:    a ``ForeignMachine``.

The variables ``mom_kin_…`` describe the machine, ``mom_sys_…`` codes and numbers of blocks. The fourth axis of a
machine with two tables carries the fifth, and so it does in a head.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.foreign.machine import (
    ForeignMachine,
    Key,
    Left,
    Stated,
    WordCounts,
    because,
    not_taken,
    number,
    place_in,
    read_text,
)
from trunnion.messages import Wording
from trunnion.records import dataclass

_SET: Final = re.compile(
    r"\s*set\s+(?:::)?(mom_(?:kin|sys)_\w+(?:\([\w, ]+\))?)\s+(\"[^\"$\[]*\"|[-+.\w\\#]+)\s*(?:;.*)?$"
)
_COMPUTED: Final = re.compile(r"\s*set\s+(?:::)?(mom_kin_\w+(?:\([\w, ]+\))?)\s+(\S.*)")
_IN_PUI: Final = re.compile(r'\s*\{?"\$(mom_(?:kin|sys)_\w+(?:\([\w, ]+\))?)"\s+"([^"$\[]*)"')
_PROC: Final = re.compile(r"\s*proc\s+(?:::)?(\w+)")
_LITERAL: Final = re.compile(r"\s*MOM_output_(?:literal|text)\s+\"([^\"]*)\"")
_BLOCK: Final = re.compile(r"\s*(?:MOM_do_template|MOM_force\s+once)\s+(\w+)")
_COMMAND: Final = re.compile(r"\s*(PB_CMD_\w+)")
_TEMPLATE: Final = re.compile(r"\s*BLOCK_TEMPLATE\s+(\w+)")
_FORMAT: Final = re.compile(r"\s*FORMAT\s+(\w+)\s+\"&([_+])([_0])(\d+)([._])(\d+)([_0])\"")
_ADDRESS: Final = re.compile(r"\s*ADDRESS\s+(\w+)")
_OF_ADDRESS: Final = re.compile(r"\s*FORMAT\s+(\w+)\s*$")

#: Planes of rotary axes -> their directions.
_PLANES: Final = {"XY": (0.0, 0.0, 1.0), "YZ": (1.0, 0.0, 0.0), "ZX": (0.0, 1.0, 0.0), "XZ": (0.0, 1.0, 0.0)}

#: Kinds of machine -> what the fourth and the fifth axis carry, and whether the fifth is nearer to the workpiece.
_KINDS: Final = {
    "5_axis_dual_table": ("part", "part", True),
    "5_axis_dual_head": ("tool", "tool", False),
    "5_axis_head_table": ("tool", "part", True),
}

#: Events -> the template in which a definition has their lines.
_EVENTS: Final = {
    "MOM_start_of_program": "program_start", "PB_start_of_program": "program_start",
    "MOM_end_of_program": "program_end", "MOM_first_tool": "first_tool", "MOM_tool_change": "tool_change",
    "PB_auto_tool_change": "tool_change", "MOM_start_of_path": "operation_start", "PB_start_of_path": "operation_start",
    "MOM_end_of_path": "operation_end_…", "PB_end_of_path": "operation_end_…", "MOM_initial_move": "approach_…",
    "MOM_first_move": "approach_…",
}  # fmt: skip

#: Variables -> codes of a control; ``control.codes`` has them by name, ``control.coolant`` by word.
_CODES: Final = {
    "mom_sys_rapid_code": "rapid", "mom_sys_linear_code": "linear", "mom_sys_circle_code(CLW)": "arc_clockwise",
    "mom_sys_circle_code(CCLW)": "arc_counterclockwise", "mom_sys_cutcom_plane_code(XY)": "plane_xy",
    "mom_sys_cutcom_plane_code(ZX)": "plane_zx", "mom_sys_cutcom_plane_code(YZ)": "plane_yz",
    "mom_sys_cutcom_code(OFF)": "comp_off", "mom_sys_cutcom_code(LEFT)": "comp_left",
    "mom_sys_cutcom_code(RIGHT)": "comp_right", "mom_sys_spindle_direction_code(CLW)": "spindle_clockwise",
    "mom_sys_spindle_direction_code(CCLW)": "spindle_counterclockwise",
    "mom_sys_spindle_direction_code(OFF)": "spindle_off", "mom_sys_program_stop_code": "stop",
    "mom_sys_optional_stop_code": "optional_stop",
}  # fmt: skip
_COOLANT: Final = re.compile(r"mom_sys_coolant_code\((OFF|ON|FLOOD|MIST|TAP|THRU|AIR)\)")
_BLOCKS: Final = {
    "mom_sys_seqnum_start": "start", "mom_sys_seqnum_incr": "step", "mom_sys_seqnum_max": "highest",
    "mom_sys_seqnum_freq": "every",
}  # fmt: skip

#: Addresses -> the number format of a definition that they use.
_ADDRESSES: Final = {"X": "coordinate", "fourth_axis": "angle", "F": "feed", "S": "speed"}

#: Keys of a rotary axis, and the variables of which they are made.
_PARTS_OF_AXES: Final = (
    (("limits_deg", "endless"), ("min_limit", "max_limit")),
    (("direction",), ("plane", "vector(0)", "vector(1)", "vector(2)")),
    (("point_mm",), ("center_offset(0)", "center_offset(1)", "center_offset(2)")),
)
#: Variables that are looked at for what is made of others, or that describe no machine with five axes.
_LOOKED_AT: Final = re.compile(
    r"mom_kin_(?:machine_type|output_unit|post_data_unit|[xyz]_axis_limit|pivot_gua?ge_offset|rapid_feed_rate"
    r"|max_dpm|linearization_tol|tool_change_time"
    r"|[45]th_axis_(?:leader|type|plane|rotation|min_limit|max_limit|vector\(\d\)|center_offset\(\d\)))"
)
_INCH: Final = 25.4
#: Limits of more are those of an axis that turns without end.
_ENDLESS: Final = 9000.0


@dataclass(slots=True)
class _Post:
    """What the files say, before it is understood."""

    stated: dict[str, Stated] = field(default_factory=dict)
    formats: dict[str, Stated] = field(default_factory=dict)
    addresses: dict[str, str] = field(default_factory=dict)
    lines: dict[str, list[str]] = field(default_factory=dict)
    blocks: dict[str, list[str]] = field(default_factory=dict)
    left: list[Left] = field(default_factory=list)
    words: WordCounts = field(default_factory=WordCounts)


def read_nx_post(files: Sequence[Path]) -> ForeignMachine:
    """Return the machine of a post.

    files  those of one post, in any order; where two state a value, the event handler counts

    Raises ``InputError`` if a file cannot be read, or none describes a machine with two rotary axes.
    """
    post = _Post()
    for file in sorted(files, key=lambda each: (".tcl", ".pui", ".def").index(each.suffix.lower())):
        _read(file, read_text(file), post)
    kind = post.stated.get("mom_kin_machine_type")
    if kind is None:
        raise InputError(Problem(str(files[0]), 0, Wording("DEF620", "no_kinematics")))
    if kind.value not in _KINDS:
        raise InputError(Problem(kind.file, kind.line, Wording("DEF620", "other_kind", kind=kind.value)))
    names = [_name_of(post, "4th", kind), _name_of(post, "5th", kind)]
    if names[0] == names[1]:
        raise InputError(Problem(kind.file, kind.line, Wording("DEF620", "one_letter", name=names[0])))
    mounts = _KINDS[kind.value]
    order = [(names[0], mounts[0]), (names[1], mounts[1])]
    values = dict(_values(post, names, kind.value))
    return ForeignMachine(
        tuple(reversed(order) if mounts[2] else order),
        values,
        tuple(_left(post, names, mounts[:2], values)),
        post.words.control,
    )


def _read(file: Path, text: str, post: _Post) -> None:
    is_pui, event, block, address = file.suffix.lower() == ".pui", "", "", ""
    procedure = ""
    for row, line in enumerate(text.splitlines(), 1):
        if found := (_IN_PUI if is_pui else _SET).match(line):
            _note(post, Stated(found[2].strip('"').strip(), found[1].replace(" ", ""), str(file), row), procedure)
            continue
        if not is_pui and not procedure and (found := _COMPUTED.match(line)):
            where = place_in(file, row)
            post.stated.pop(found[1], None)
            post.left.append(Left(f"{found[1]} = {found[2].strip()}", where, because("computed")))
            continue
        post.words.count(line)
        if line.startswith("}"):
            procedure = ""
        if found := _PROC.match(line):
            event, procedure = _EVENTS.get(found[1], ""), found[1]
        elif found := _TEMPLATE.match(line):
            block = found[1]
        elif found := _FORMAT.match(line):
            post.formats[found[1]] = Stated(int(found[6]), f"FORMAT {found[1]}", str(file), row)
        elif found := _ADDRESS.match(line):
            address, block = found[1], ""
        elif address and (found := _OF_ADDRESS.match(line)):
            post.addresses.setdefault(address, found[1])
        elif event and (found := _LITERAL.match(line) or _BLOCK.match(line) or _COMMAND.match(line)):
            post.lines.setdefault(event, []).append(f"{line.strip()} ({place_in(file, row)})")
        elif block and (word := line.strip()) and word not in "{}":
            post.blocks.setdefault(block, []).append(word)


def _note(post: _Post, value: Stated, procedure: str) -> None:
    """Keep a value: the last that a file sets outside of procedures counts, of the first file that has it; the others
    are reported.
    """
    known = post.stated.get(value.name)
    if procedure:
        if value.name.startswith("mom_kin_") and (known is None or known.value != value.value):
            post.left.append(not_taken(value, because("set_while_running", procedure=procedure)))
        return
    if known is None or known.file == value.file:
        post.stated[value.name] = value
    if known is not None and known.value != value.value:
        counts = post.stated[value.name]
        other = known if counts is value else value
        post.left.append(not_taken(other, because("value_counts", value=str(counts.value), place=counts.place)))


def _name_of(post: _Post, which: str, kind: Stated) -> str:
    name = post.stated.get(f"mom_kin_{which}_axis_leader")
    if name is None or not re.fullmatch(r"[A-Za-z]", name.value):
        place = kind if name is None else name
        raise InputError(Problem(place.file, place.line, Wording("DEF620", "no_letter", axis=which)))
    return str(name.value).upper()


def _number(post: _Post, name: str) -> Stated | None:
    """Return a number; None where none is stated."""
    found = post.stated.get(name)
    value = None if found is None else number(found.value)
    return found.as_value(value) if found is not None and value is not None else None


def _values(post: _Post, names: Sequence[str], kind: str) -> Iterator[tuple[Key, Stated]]:
    unit = post.stated.get("mom_kin_post_data_unit", post.stated.get("mom_kin_output_unit"))
    scale = _INCH if unit is not None and str(unit.value).upper().startswith("IN") else 1.0
    for which, name in zip(("4th", "5th"), names, strict=True):
        yield from _axis(post, which, name)
    yield from _points(post, names, kind, scale)
    for place, name in enumerate("XYZ"):
        if home := _number(post, f"mom_sys_home_pos({place})"):
            yield ("axis", name, "home_mm"), home.as_value(home.value * scale)
        if (rapid := _number(post, "mom_kin_rapid_feed_rate")) and rapid.value > 0.0:
            yield ("axis", name, "rapid_mm_min"), rapid.as_value(rapid.value * scale)
    for variable, code in _CODES.items():
        if found := _whole(post, variable):
            yield ("control", "codes", code), found
    for variable in post.stated:
        if (match := _COOLANT.fullmatch(variable)) and (found := _whole(post, variable)):
            yield ("control", "coolant", match[1]), found
    for variable, key in _BLOCKS.items():
        if (found := _whole(post, variable)) and (found.value > 0 or key == "start"):
            yield ("control", "block_numbers", key), found
    for address, name in _ADDRESSES.items() if scale == 1.0 else ():
        if decimals := post.formats.get(post.addresses.get(address, "")):
            yield ("control", "format", name, "decimals"), decimals


def _whole(post: _Post, name: str) -> Stated | None:
    found = _number(post, name)
    return found.as_value(int(found.value)) if found is not None and found.value.is_integer() else None


def _axis(post: _Post, which: str, name: str) -> Iterator[tuple[Key, Stated]]:
    """Yield direction, sense and travel of a rotary axis."""
    start = f"mom_kin_{which}_axis_"
    plane = post.stated.get(f"{start}plane")
    vector = [_number(post, f"{start}vector({k})") for k in range(3)]
    if plane is not None and str(plane.value).upper() in _PLANES:
        yield ("axis", name, "direction"), plane.as_value(list(_PLANES[str(plane.value).upper()]))
    elif vector[0] and vector[1] and vector[2] and any(each.value for each in vector if each):
        yield ("axis", name, "direction"), vector[0].as_value([each.value for each in vector if each])
    if sense := post.stated.get(f"{start}rotation"):
        is_reversed = str(sense.value).lower() == "reverse"
        yield ("axis", name, "positive"), sense.as_value("reversed" if is_reversed else "standard")
    low, high = _number(post, f"{start}min_limit"), _number(post, f"{start}max_limit")
    limited = post.stated.get(f"mom_sys_{which}_axis_has_limits")
    if low is None or high is None or not low.value < high.value:
        return
    if (limited is not None and limited.value == "0") or high.value - low.value > _ENDLESS:
        yield ("axis", name, "endless"), high.as_value(True)
    else:
        yield ("axis", name, "limits_deg"), low.as_value([low.value, high.value])


def _points(post: _Post, names: Sequence[str], kind: str, scale: float) -> Iterator[tuple[Key, Stated]]:
    """Yield the points of the rotary axes, mm: the fourth from the machine's zero, the fifth from the fourth.

    Those of a head stand above the gauge point, which is then the zero of the frame: the fifth by the pivot length.
    """
    first, second = (_offset(post, which, scale) for which in ("4th", "5th"))
    if kind == "5_axis_dual_table":
        if first:
            yield ("axis", names[0], "point_mm"), first
            if second:
                both = [a + b for a, b in zip(first.value, second.value, strict=True)]
                yield ("axis", names[1], "point_mm"), second.as_value(both)
        return
    pivot = _number(post, "mom_kin_pivot_gauge_offset") or _number(post, "mom_kin_pivot_guage_offset")
    if pivot is None:
        return
    yield ("spindle", "gauge_point_mm"), pivot.as_value([0.0, 0.0, 0.0])
    at = [0.0, 0.0, pivot.value * scale]
    if kind == "5_axis_head_table":
        yield ("axis", names[0], "point_mm"), pivot.as_value(at)
        return
    yield ("axis", names[1], "point_mm"), pivot.as_value(at)
    if second:
        yield ("axis", names[0], "point_mm"), second.as_value([a - b for a, b in zip(at, second.value, strict=True)])


def _offset(post: _Post, which: str, scale: float) -> Stated | None:
    found = [_number(post, f"mom_kin_{which}_axis_center_offset({k})") for k in range(3)]
    if found[0] is None or not all(found):
        return None
    return found[0].as_value([each.value * scale for each in found if each])


def _left(post: _Post, names: Sequence[str], mounts: Sequence[str], values: Mapping[Key, Stated]) -> Iterator[Left]:
    yield from post.left
    for which, mount in zip(("4th", "5th"), mounts, strict=True):
        kind = post.stated.get(f"mom_kin_{which}_axis_type")
        if kind is not None and kind.value and str(kind.value).lower() != {"part": "table", "tool": "head"}[mount]:
            yield not_taken(kind, because("machine_type_counts"))
    pivot = _number(post, "mom_kin_pivot_gauge_offset")
    if pivot is not None and pivot.value and ("spindle", "gauge_point_mm") not in values:
        yield not_taken(pivot, because("no_pivot"))
    for which, name in zip(("4th", "5th"), names, strict=True):
        for keys, parts in _PARTS_OF_AXES:
            if not any(("axis", name, key) in values for key in keys):
                for found in (post.stated.get(f"mom_kin_{which}_axis_{part}") for part in parts):
                    if found is not None:
                        yield not_taken(found, because("cannot_be_made", key=keys[0], axis=name))
    for name in "xyz":
        if travel := post.stated.get(f"mom_kin_{name}_axis_limit"):
            said = because("travel_of", axis=name.upper(), value=str(travel.value))
            yield Left(said, travel.source, because("travel_without_begin"))
    for name, why in (
        ("mom_kin_max_dpm", "angular_feed"),
        ("mom_kin_linearization_tol", "setting_tolerance"),
        ("mom_kin_tool_change_time", "take_the_time"),
    ):
        if found := post.stated.get(name):
            yield not_taken(found, because(why))
    if ("control", "format", "coordinate", "decimals") not in values:
        for address in _ADDRESSES:
            if found := post.formats.get(post.addresses.get(address, "")):
                said = because("decimals_of", name=found.name, address=address, decimals=str(found.value))
                yield Left(said, found.place, because("in_inches"))
    for found in post.stated.values():
        if found.name.startswith("mom_kin_") and not _LOOKED_AT.fullmatch(found.name):
            yield not_taken(found, because("no_such_value"))
    for event, lines in post.lines.items():
        for line in lines:
            words = _block_words(post, line)
            place = line.rpartition(" (")[2].rstrip(")")
            yield Left(line.rpartition(" (")[0] + words, place, because("in_template", name=event))


def _block_words(post: _Post, line: str) -> str:
    found = _BLOCK.match(line)
    words = post.blocks.get(found[1], ()) if found else ()
    return f": {' '.join(words)}" if words else ""
