"""A definition that extends the shipped machine nearest to one of others, and what a definition has otherwise."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

from trunnion.controls.definition_files import load_control_table
from trunnion.controls.loading import control_library
from trunnion.definitions import resolve_extends
from trunnion.definitions.toml_text import written
from trunnion.errors import InputError, argument_problem
from trunnion.foreign.machine import ForeignMachine, Key, Left, Stated, because
from trunnion.machines import AngleOutput, Axis, Machine, load_machine
from trunnion.machines.loading import shipped_machines
from trunnion.machines.machine import Vector
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.schemas import first_line

_HEAD: Final = """\
# From {sources}{like}.
# Nobody has measured a number marked "measure:" on your machine: compare it, and take the mark away. trunnion check
# reports which marks are left; what the files have and a definition does not take stands at the end.
"""

#: Relative and absolute differences of numbers that are the same; of lines of rotation, mm and components.
_SAME: Final = 1e-9
_SAME_LINE: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Written:
    """A definition as text, the values of the files that are in it, and those that are not."""

    text: str
    taken: Mapping[Key, Stated]
    left: tuple[Left, ...]


@dataclass(frozen=True, slots=True)
class Difference:
    """A value that a definition has otherwise than a file of others; None where it states none."""

    key: str
    here: Any
    there: Any
    source: str

    @property
    def is_axis(self) -> bool:
        """Whether it is a whole axis that the definition does not have."""
        return self.key.count(".") == 1


def nearest_machine(found: ForeignMachine) -> str:
    """Return the shipped machine whose rotary axes have the names and carry the same as those of a machine of others;
    empty if there is none, but the files state all that a definition of its own needs.

    Where several do, one with the same control counts, then that whose limits are nearest.

    Raises ``InputError`` if there is none, and the files do not state enough.
    """
    ranked = []
    for name in shipped_machines():
        machine = load_machine(name)
        if _rotary(machine) == list(found.rotary) and _fits(machine, found):
            ranked.append((_control_of(machine) != found.control, _far(machine, found), name))
    if (
        not ranked
        and found.control
        and len(found.rotary) == 2
        and all(_is_whole(found, name) for name, _ in found.rotary)
    ):
        return ""
    if not ranked:
        axes = " ".join(f"{name} ({mount})" for name, mount in found.rotary)
        raise InputError(argument_problem("like", Wording("DEF640", "no_such_machine", axes=axes or "?")))
    return min(ranked)[2]


def written_definition(found: ForeignMachine, base: str, name: str) -> Written:
    """Return a definition that extends ``base`` and has what the files of others state, marked as
    unmeasured, with what is left at its end; one of its own where ``base`` is empty.
    """
    if not base:
        return _whole_definition(found, name)
    machine = load_machine(base)
    outside = dict((*_homes_outside(found, machine), *_endless_against_limits(found, machine)))
    for key, value in found.values.items():
        if key[0] == "axis" and (why := _no_place(key, machine)):
            outside[key] = Left(f"{'.'.join(key)} = {written(value.value)}", value.source, why)
    taken = {key: value for key, value in found.values.items() if key not in outside}
    lines = [
        first_line("machine") + _HEAD.format(sources=_sources(taken), like=f", like {base} where these say nothing")
    ]
    lines += [f"schema = 1\nextends = {written(base)}\nname = {written(name)}\n"]
    lines += _spindle(taken)
    for axis in machine.own_axes:
        lines += _axis(axis, {key[2]: value for key, value in taken.items() if key[:2] == ("axis", axis.name)})
    lines += _control(_control_of(machine), found.control, taken)
    return _with_rest(lines, taken, (*found.left, *outside.values()))


def _no_place(key: Key, machine: Machine) -> Wording | None:
    """Return why a machine has no place for a value of an axis; None if it has."""
    axis = next((each for each in machine.own_axes if each.name == key[1]), None)
    if axis is None:
        return because("no_axis", machine=machine.key, axis=key[1])
    turns = key[2] in ("endless", "point_mm") or "_deg" in key[2]
    if (turns and not axis.is_rotary) or (key[2].endswith("_mm") and key[2] != "point_mm" and axis.is_rotary):
        return because("rotary_axis" if axis.is_rotary else "linear_axis", machine=machine.key, axis=key[1])
    return None


def _with_rest(lines: list[str], taken: Mapping[Key, Stated], left: tuple[Left, ...]) -> Written:
    """Return a definition with what is left at its end."""
    lines += [f"# not taken: {each.what} ({each.where}): {each.why}" for each in left]
    return Written("\n".join(_visible(line) for line in lines).rstrip() + "\n", taken, left)


def _whole_definition(found: ForeignMachine, name: str) -> Written:
    """Return a definition with all five axes: nothing says what the linear ones carry, so they carry the tool."""
    rotary = dict(found.rotary)
    linear = dict.fromkeys("XYZ", "tool")
    parts = {each: mount for each, mount in rotary.items() if mount == "part"}
    heads = {each: mount for each, mount in rotary.items() if mount == "tool"}
    lines = [
        first_line("machine") + _HEAD.format(sources=_sources(found.values), like="; no shipped machine is like it")
    ]
    lines += [f"schema = 1\nname = {written(name)}\n", *_spindle(found.values)]
    for each, mount in (parts | linear | heads).items():
        own = {key[2]: value for key, value in found.values.items() if key[:2] == ("axis", each)}
        turns = each in rotary
        axis = ["[[axis]]", f"name = {written(each)}", f"kind = {written('rotary' if turns else 'linear')}"]
        axis += [f"carries = {written(mount)}" + ("" if turns else " # measure: the files do not say which side moves")]
        if not turns:
            axis += [f"direction = {written([float(each == letter) for letter in 'XYZ'])}"]
        elif "point_mm" not in own:
            axis += ["point_mm = [0, 0, 0] # measure: the files do not say where it lies"]
        lines.append("\n".join([*axis, *(_marked(key, value) for key, value in own.items()), ""]))
    lines += _control("", found.control, found.values)
    return _with_rest(lines, found.values, found.left)


def _is_whole(found: ForeignMachine, name: str) -> bool:
    """Whether direction and travel of a rotary axis are stated."""
    keys = {key[2] for key in found.values if key[:2] == ("axis", name)}
    return "direction" in keys and bool({"limits_deg", "endless"} & keys)


def _sources(values: Mapping[Key, Stated]) -> str:
    """Return the names of the files that state values."""
    return ", ".join(dict.fromkeys(value.source.rpartition(", ")[2].rpartition(":")[0] for value in values.values()))


def _homes_outside(found: ForeignMachine, machine: Machine) -> Iterator[tuple[Key, Left]]:
    """Yield homes beyond the travel that counts, which is that of the shipped machine where the files state none."""
    for axis in machine.own_axes:
        unit = "deg" if axis.is_rotary else "mm"
        home = found.values.get(("axis", axis.name, f"home_{unit}"))
        travel = found.values.get(("axis", axis.name, f"limits_{unit}"))
        low, high = (axis.low, axis.high) if travel is None else travel.value
        if home is not None and not low <= home.value <= high:
            why = because(
                "home_outside", home=written(home.value), machine=machine.key, low=f"{low:g}", high=f"{high:g}"
            )
            yield ("axis", axis.name, f"home_{unit}"), Left(because("home_of", axis=axis.name), home.source, why)


def _endless_against_limits(found: ForeignMachine, machine: Machine) -> Iterator[tuple[Key, Left]]:
    """Yield axes without limits in the files, where the shipped machine has some: those stay until they are
    measured.
    """
    for axis in machine.own_axes:
        endless = found.values.get(("axis", axis.name, "endless"))
        if endless is not None and axis.has_limits:
            why = because("limits_count", machine=machine.key, low=f"{axis.low:g}", high=f"{axis.high:g}")
            yield ("axis", axis.name, "endless"), Left(because("without_limits", axis=axis.name), endless.source, why)


def differences(found: ForeignMachine, machine: Machine) -> Iterator[Difference]:
    """Yield the values of axes and control that a definition has otherwise than a machine of others, in the order of
    the files.

    Lines of rotation are compared as such: a point may lie anywhere on its line, and a line that points the other way
    with the other sense is the same.
    """
    axes = {axis.name: axis for axis in machine.own_axes}
    control: dict[str, Any] = resolve_extends(machine.control, control_library()).to_dict()
    for key, value in found.values.items():
        if key[0] == "control" and not _is_same(here := _of_control(control, key), value.value):
            yield Difference(".".join(key), here, value.value, value.source)
        if key[0] == "axis" and key[1] in axes:
            axis = axes[key[1]]
            if key[2] == "point_mm":
                yield from _off_line(axis, value, machine.spindle_point)
            elif key[2] == "direction" and ("axis", axis.name, "positive") in found.values:
                yield from _askew(axis, value)
            elif key[2] == "positive" and (line := found.values.get(("axis", axis.name, "direction"))):
                yield from _other_sense(axis, value, line)
            elif not _is_same(here := None if _no_place(key, machine) else _here(axis, key[2]), value.value):
                yield Difference(".".join(key), here, value.value, value.source)
    for name in dict.fromkeys(key[1] for key in found.values if key[0] == "axis" and key[1] not in axes):
        first = next(value for key, value in found.values.items() if key[:2] == ("axis", name))
        yield Difference(f"axis.{name}", None, "stated", first.source)


def _off_line(axis: Axis, stated: Stated, gauge: Vector) -> Iterator[Difference]:
    """Yield the components in which a point, from the gauge point, is beside the line of rotation, mm."""
    there = [float(value) + start for value, start in zip(stated.value, gauge, strict=True)]
    away = [value - own for value, own in zip(there, axis.point, strict=True)]
    along = sum(a * b for a, b in zip(away, axis.direction, strict=True))
    for letter, off, part, own, value in zip("XYZ", away, axis.direction, axis.point, there, strict=True):
        if abs(off - along * part) > _SAME_LINE:
            yield Difference(f"axis.{axis.name}.point_mm {letter}", own, round(value, 9), stated.source)


def _askew(axis: Axis, stated: Stated) -> Iterator[Difference]:
    """Yield the components in which a line of rotation is not parallel to that of a definition."""
    size = math.hypot(*stated.value)
    there = [value / size for value in stated.value] if size > 0.0 else [0.0, 0.0, 0.0]
    if sum(a * b for a, b in zip(there, axis.direction, strict=True)) < 0.0:
        there = [-value + 0.0 for value in there]
    for letter, own, value in zip("XYZ", axis.direction, there, strict=True):
        if abs(own - value) > _SAME_LINE:
            yield Difference(f"axis.{axis.name}.direction {letter}", own, round(value, 9), stated.source)


def _other_sense(axis: Axis, stated: Stated, line: Stated) -> Iterator[Difference]:
    """Yield a sense of rotation that is the other one, along the line as the definition has it."""
    along = sum(a * b for a, b in zip(line.value, axis.direction, strict=True))
    sense = (1.0 if stated.value == "standard" else -1.0) * (1.0 if along >= 0.0 else -1.0)
    if sense != axis.sense:
        there = "standard" if sense > 0.0 else "reversed"
        yield Difference(f"axis.{axis.name}.positive", str(axis.positive), there, stated.source)


def _rotary(machine: Machine) -> list[tuple[str, str]]:
    return [(axis.name, str(axis.mount)) for axis in machine.own_axes if axis.is_rotary]


def _fits(machine: Machine, found: ForeignMachine) -> bool:
    """Whether the lines of rotation have the directions that are stated."""
    for axis in machine.own_axes:
        stated = found.values.get(("axis", axis.name, "direction"))
        if stated is not None and not _is_parallel(axis.direction, stated.value):
            return False
    return True


def _is_parallel(one: Any, other: Any) -> bool:
    size = math.hypot(*one) * math.hypot(*other)
    return size > 0.0 and abs(sum(a * b for a, b in zip(one, other, strict=True))) > (1.0 - 1e-6) * size


def _far(machine: Machine, found: ForeignMachine) -> float:
    """How far the limits of rotary axes are apart, degrees."""
    far = 0.0
    for axis in machine.own_axes:
        stated = found.values.get(("axis", axis.name, "limits_deg"))
        if stated is not None and axis.has_limits:
            far += sum(abs(a - b) for a, b in zip((axis.low, axis.high), stated.value, strict=True))
        elif axis.is_rotary and (stated is not None) is not axis.has_limits:
            far += 360.0
    return far


def _spindle(taken: Mapping[Key, Stated]) -> Iterator[str]:
    if own := {key[1]: value for key, value in taken.items() if key[0] == "spindle"}:
        yield "\n".join(["[spindle]", *(_marked(key, value) for key, value in own.items()), ""])


def _axis(axis: Axis, own: Mapping[str, Stated]) -> Iterator[str]:
    if not own:
        return
    lines = ["[[axis]]", f"name = {written(axis.name)}"]
    lines += [_marked(key, value) for key, value in own.items()]
    if "limits_deg" in own and axis.endless:
        why = f"# measure: {own['limits_deg'].source}"
        lines += [f"endless = false {why}"]
        lines += [f'output = "none" {why}'] if axis.output is not AngleOutput.NONE else []
    yield "\n".join([*lines, ""])


def _control(own: str, control: str, taken: Mapping[Key, Stated]) -> Iterator[str]:
    """Yield what differs from the control that counts; a control of another family brings its own."""
    if control and control != own:
        yield f"[control]\nextends = {written(control)} # measure: the files have its words\n"
    known: dict[str, Any] = load_control_table(control or own).to_dict()
    tables: dict[str, list[str]] = {}
    for key, value in taken.items():
        if key[0] == "control" and key[1] == "format":
            formats = {each["name"]: each for each in known.get("format", ())}
            if key[2] in formats and formats[key[2]].get(key[3]) != value.value:
                tables[f"[[control.format]]\nname = {written(key[2])}"] = [_marked(key[3], value)]
        elif key[0] == "control" and _has_other(known.get(key[1]), key[2], value.value):
            tables.setdefault(f"[control.{key[1]}]", []).append(_marked(key[2], value))
    for head, lines in tables.items():
        yield "\n".join([head, *lines, ""])


def _has_other(table: Any, key: str, value: Any) -> bool:
    """Whether a table of a control can have a key, and has another value there."""
    return isinstance(table, dict) and (key in table or "OFF" in table) and table.get(key) != value


def _of_control(control: Mapping[str, Any], key: Key) -> Any:
    """Return a value of a control; None where it states none."""
    table = control.get(key[1])
    if key[1] == "format":
        table = next((each for each in table or () if each.get("name") == key[2]), None)
    value = table.get(key[-1]) if isinstance(table, dict) else None
    return value[0] if isinstance(value, list) and len(value) == 1 else value


def _control_of(machine: Machine) -> str:
    """Return the shipped control that a shipped machine extends."""
    return machine.control.text("extends", "")


def _visible(text: str) -> str:
    """Return a text without characters that no definition has."""
    return "".join(letter if letter.isprintable() or letter == "\n" else "?" for letter in text)


def _marked(key: str, value: Stated) -> str:
    return f"{key} = {written(value.value)} # measure: {value.source}"


def _here(axis: Axis, key: str) -> Any:
    if key.startswith("limits"):
        return [axis.low, axis.high] if axis.has_limits else None
    if key.startswith("rapid"):
        return axis.rapid
    if key.startswith("acceleration"):
        return axis.acceleration
    if key.startswith("home"):
        return axis.home if axis.home_is_stated else None
    if key == "point_mm":
        return list(axis.point)
    return {"endless": axis.endless, "positive": str(axis.positive), "direction": list(axis.direction)}[key]


def _is_same(here: Any, there: Any) -> bool:
    if isinstance(here, list) and isinstance(there, list):
        return len(here) == len(there) and all(map(_is_same, here, there))
    if isinstance(here, bool) or isinstance(there, bool) or isinstance(here, str) or here is None:
        return bool(here == there)
    return math.isclose(here, there, rel_tol=_SAME, abs_tol=_SAME)
