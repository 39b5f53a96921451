"""What a machine's definition means, as text and as data for ``trunnion check``; and all of them, a line each."""

import math
import sys
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.columns import CodeLine, table, width_of
from trunnion.cli.wording import in_command_words
from trunnion.controls import load_control
from trunnion.jobs.describe.machines import MachineDescription
from trunnion.machines import Axis, Machine
from trunnion.machines.jog_table import (
    AxisJog,
    JogTable,
    RotaryPose,
    named_direction,
    number_text,
    order_of_axes,
)
from trunnion.machines.machine import Mount, Vector
from trunnion.results import to_data

_LEGEND: Final = (
    "Jog the machine and compare. X Y Z are the directions of the definition.",
    "The table is what carries the part, the head what carries the tool.",
    "With Z up and -Y towards the operator, what goes to +Z rises, and -Y is the front.",
    'An axis that goes the other way at the machine wants positive = "reversed" (a rotary one), or another direction.',
)

#: Above the columns of the list of machines; the order goes from the workpiece to the tool.
_HEADS: Final = ("machine", "part to tool", "rotary axes", "range", "travel", "control", "name")

_PART: Final = {Mount.PART: "table", Mount.TOOL: "head"}


def machine_lines(found: MachineDescription) -> Iterator[str]:
    """Yield what the definition means, in lines."""
    machine, jogs = found.machine, found.jogs
    yield f"{machine.name} ({machine.key})"
    yield from [machine.description] if machine.description else []
    yield from ("", *_LEGEND, "")
    yield f"From the workpiece to the tool: {' '.join(jogs.order)}"
    yield from _spindle_lines(machine)
    yield ""
    for jog in jogs.axes:
        yield from _axis_lines(jog)
    yield from (
        "",
        "Where the tool points, in directions of the workpiece, and where the spindle's gauge point is then;",
    )
    yield "linear axes at zero, positions in mm from the workpiece zero"
    yield from _pose_lines(jogs)
    yield ""
    yield from _solution_lines(jogs)
    yield from ("", f"Texts of {found.control}; {{field}} stands for a value")
    for text in found.texts:
        yield f"  {text.name}"
        yield from (CodeLine(f"    {line}") for line in text.lines)
    yield from ("", "What is assumed", *(f"  {in_command_words(each)}" for each in found.assumed))


def machine_data(found: MachineDescription) -> dict[str, object]:
    """Return the same as plain data: what is not limited or not known is None."""
    data: dict[str, object] = to_data(found)
    return data | {"assumed": [in_command_words(each) for each in found.assumed]}


def _spindle_lines(machine: Machine) -> Iterator[str]:
    along = named_direction(machine.spindle_direction)
    yield f"Spindle, all axes at zero: from the tip of the tool to the holder it points to {along}."
    yield f"Tool lengths begin at {_point(machine.spindle_point)} mm, all axes at zero."
    speeding, change = machine.facts.spindle_acceleration_rpm_s, machine.facts.tool_change_s
    how = "at once" if speeding is None else f"by {number_text(speeding, 1)} rev/min a second"
    seconds = "no time" if change is None else f"{number_text(change, 2)} s"
    yield f"In times, its speed changes {how}, and a tool change takes {seconds}."
    zero = machine.workpiece_zero
    yield f"Workpiece zero: {f'{_point(zero)} mm' if zero else 'not stated, taken for (0, 0, 0)'}."


def _axis_lines(jog: AxisJog) -> Iterator[str]:
    axis = jog.axis
    unit = "°" if axis.is_rotary else " mm"
    label = f"{axis.name}+ {jog.step:g}{unit}"
    yield f"{label:<10} {jog.tool}"
    yield f"{'':<10} {jog.iron}"
    line = f"turns about the line through {_point(axis.point)} along {named_direction(axis.direction)}; "
    yield f"{'':<10} {line if axis.is_rotary else ''}{_travel(axis, unit)}; {_home(axis, unit)}"
    yield f"{'':<10} {_dynamics(axis, unit)}"


def _dynamics(axis: Axis, unit: str) -> str:
    stated = [
        f"{name} {number_text(value, 4)}{unit}{per}"
        for name, value, per in (
            ("rapid", axis.rapid, "/min"), ("acceleration", axis.acceleration, "/s²"), ("jerk", axis.jerk, "/s³")
        )
        if value is not None
    ]  # fmt: skip
    missing = [name for name, value in (("rapid", axis.rapid), ("acceleration", axis.acceleration)) if value is None]
    return (
        ", ".join(stated)
        + ("; " if stated and missing else "")
        + (f"{' and '.join(missing)} not stated: times count no limit" if missing else "")
    )


def _travel(axis: Axis, unit: str) -> str:
    if axis.endless:
        return "endless, " + ("turns add up" if axis.output == "none" else f"written in {axis.output}")
    if not axis.has_limits:
        return "travel not stated, and not checked"
    return f"travel {number_text(axis.low, 4)} to {number_text(axis.high, 4)}{unit}"


def _home(axis: Axis, unit: str) -> str:
    return f"home {number_text(axis.home, 4)}{unit}{'' if axis.home_is_stated else ', which is not stated'}"


def _pose_lines(jogs: JogTable) -> Iterator[str]:
    width = max(len(_values(pose)) for pose in jogs.poses)
    for pose in jogs.poses:
        place = f"{_point(pose.tool_axis):<24}  gauge point {_point(pose.gauge_point)}"
        yield f"  {_values(pose):<{width}}  tool axis {place}{'' if pose.in_travel else '  out of travel'}"


def _solution_lines(jogs: JogTable) -> Iterator[str]:
    one, other = (f"{_values(pose)}{'' if pose.in_travel else ' (out of travel)'}" for pose in jogs.same_axis)
    yield f"The same tool axis: {one}, and {other}."
    yield f"Of two such positions cuts begin in {jogs.preferred}."


def _values(pose: RotaryPose) -> str:
    return " ".join(
        f"{name}{'-' if value < 0 else '+'}{number_text(abs(value), 3)}" for name, value in pose.values.items()
    )


def _point(vector: Vector) -> str:
    return f"({', '.join(number_text(part, 3) for part in vector)})"


def machine_list(machines: Sequence[Machine]) -> Iterator[str]:
    """Key, the order of the axes and where the rotary ones are, what all reach, control and name, in columns."""
    return table([_HEADS, *map(_cells, machines)], width_of(sys.stdout))


def _cells(machine: Machine) -> tuple[str, ...]:
    rotary = [axis for axis in machine.axes if axis.is_rotary]
    slides = [axis for axis in machine.axes if not axis.is_rotary]
    # As they are spoken of: from the tool to the workpiece where both are told.
    kind = "/".join(_PART[axis.mount] for axis in reversed(rotary))
    return (
        machine.key,
        " ".join(order_of_axes(machine)),
        kind,
        ", ".join(_turn_text(axis) for axis in reversed(rotary)),
        _slide_travel(sorted(slides, key=lambda each: each.name)),
        load_control(machine.control).name,
        machine.name,
    )


def _turn_text(axis: Axis) -> str:
    if axis.endless:
        return f"{axis.name} endless"
    return f"{axis.name} {axis.low:g} to {axis.high:g}°" if math.isfinite(axis.high - axis.low) else axis.name


def _slide_travel(slides: Sequence[Axis]) -> str:
    stated = [axis for axis in slides if math.isfinite(axis.high - axis.low)]
    told = ", ".join(f"{axis.name} {axis.high - axis.low:g}" for axis in stated)
    return f"{told} mm" if stated else "travel not stated"
