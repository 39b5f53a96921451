"""What a machine's definition means, as text and as data for ``trunnion check``; and all of them, a line each."""

import math
import sys
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.columns import CodeLine, columns_of, padded, table, width_of
from trunnion.cli.wording import in_command_words, in_words, line, part, together
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
from trunnion.messages import declared, word_said
from trunnion.results import to_data

_LEGEND: Final = ("legend_jog", "legend_sides", "legend_up", "legend_reversed")

#: Above the columns of the list of machines; the order goes from the workpiece to the tool.
_HEADS: Final = ("machine", "part_to_tool", "rotary_axes", "range", "travel", "control", "name")

#: Columns of a tool axis.
_OF_AXIS: Final = 24

_PART: Final = {Mount.PART: "kind_of_table", Mount.TOOL: "kind_of_head"}


def machine_lines(found: MachineDescription) -> Iterator[str]:
    """Yield what the definition means, in lines."""
    machine, jogs = found.machine, found.jogs
    yield f"{machine.name} ({machine.key})"
    yield from [in_words(declared(machine.description, "descriptions"))] if machine.description else []
    yield from ("", *map(line, _LEGEND), "")
    yield line("order_of_axes", axes=tuple(map(word_said, jogs.order)))
    yield from _spindle_lines(machine)
    yield ""
    for jog in jogs.axes:
        yield from _axis_lines(jog)
    if jogs.poses:
        yield from ("", line("where_tool_points"), line("axes_at_zero"))
        yield from _pose_lines(jogs)
    if jogs.same_axis:
        yield ""
        yield from _solution_lines(jogs)
    yield from ("", line("texts_of_control", control=found.control))
    for text in found.texts:
        yield f"  {text.name}"
        yield from (CodeLine(f"    {each}") for each in text.lines)
    yield from ("", line("what_is_assumed"), *(f"  {in_words(each)}" for each in found.taken))


def machine_data(found: MachineDescription) -> dict[str, object]:
    """Return the same as plain data: what is not limited or not known is None."""
    data: dict[str, object] = to_data(found)
    return data | {"assumed": [in_command_words(each) for each in found.assumed]}


def _spindle_lines(machine: Machine) -> Iterator[str]:
    yield line("spindle_points", direction=named_direction(machine.spindle_direction))
    yield line("lengths_begin", point=_point(machine.spindle_point))
    speeding, change = machine.facts.spindle_acceleration_rpm_s, machine.facts.tool_change_s
    how = part("changes_at_once") if speeding is None else part("changes_by", rate=number_text(speeding, 1))
    seconds = part("change_no_time") if change is None else part("change_seconds", seconds=number_text(change, 2))
    yield line("speed_and_change", how=how, time=seconds)
    zero = machine.workpiece_zero
    yield line("workpiece_zero", point=_point(zero)) if zero else line("workpiece_zero_open")


def _axis_lines(jog: AxisJog) -> Iterator[str]:
    axis = jog.axis
    unit = "°" if axis.is_rotary else " mm"
    label = f"{axis.name}+ {jog.step:g}{unit}"
    yield f"{label:<10} {in_words(jog.tool_said)}"
    yield f"{'':<10} {in_words(jog.iron_said)}"
    rest = together(_travel(axis, unit), _home(axis, unit))
    if axis.is_rotary:
        rest = line("turns_about", point=_point(axis.point), direction=named_direction(axis.direction), rest=rest)
    yield f"{'':<10} {rest}"
    yield f"{'':<10} {_dynamics(axis, unit)}"


def _dynamics(axis: Axis, unit: str) -> str:
    stated = ", ".join(
        line(f"dynamics_{name}", value=f"{number_text(value, 4)}{unit}{per}")
        for name, value, per in (
            ("rapid", axis.rapid, "/min"), ("acceleration", axis.acceleration, "/s²"), ("jerk", axis.jerk, "/s³")
        )
        if value is not None
    )  # fmt: skip
    missing = tuple(
        part(f"name_{name}")
        for name, value in (("rapid", axis.rapid), ("acceleration", axis.acceleration))
        if value is None
    )
    return together(stated, line("dynamics_missing", names=missing) if missing else "")


def _travel(axis: Axis, unit: str) -> str:
    if axis.endless:
        return line("endless_adding") if axis.output == "none" else line("endless_written", output=str(axis.output))
    if not axis.has_limits:
        return line("travel_not_stated_unchecked")
    return line("travel_from_to", low=number_text(axis.low, 4), high=number_text(axis.high, 4), unit=unit)


def _home(axis: Axis, unit: str) -> str:
    variant = "home_at" if axis.home_is_stated else "home_at_not_stated"
    return line(variant, value=number_text(axis.home, 4), unit=unit)


def _pose_lines(jogs: JogTable) -> Iterator[str]:
    width = max(len(_values(pose)) for pose in jogs.poses)
    axes = [line("tool_axis_at", axis=_point(pose.tool_axis)) for pose in jogs.poses]
    wide = max(columns_of(line("tool_axis_at", axis=" " * _OF_AXIS)), *map(columns_of, axes))
    for pose, axis in zip(jogs.poses, axes, strict=True):
        place = f"{padded(axis, wide)}  {line('gauge_point_at', point=_point(pose.gauge_point))}"
        yield f"  {_values(pose):<{width}}  {place}{'' if pose.in_travel else '  ' + line('out_of_travel')}"


def _solution_lines(jogs: JogTable) -> Iterator[str]:
    one, other = (
        f"{_values(pose)}{'' if pose.in_travel else ' (' + line('out_of_travel') + ')'}" for pose in jogs.same_axis
    )
    yield line("same_tool_axis", one=one, other=other)
    yield line("cuts_begin_in", which=jogs.prefers)


def _values(pose: RotaryPose) -> str:
    return " ".join(
        f"{name}{'-' if value < 0 else '+'}{number_text(abs(value), 3)}" for name, value in pose.values.items()
    )


def _point(vector: Vector) -> str:
    return f"({', '.join(number_text(each, 3) for each in vector)})"


def machine_list(machines: Sequence[Machine]) -> Iterator[str]:
    """Key, the order of the axes and where the rotary ones are, what all reach, control and name, in columns."""
    heads = tuple(line(f"head_{head}") for head in _HEADS)
    return table([heads, *map(_cells, machines)], width_of(sys.stdout))


def _cells(machine: Machine) -> tuple[str, ...]:
    rotary = [axis for axis in machine.own_axes if axis.is_rotary]
    slides = [axis for axis in machine.own_axes if not axis.is_rotary]
    # As they are spoken of: from the tool to the workpiece where both are told.
    kind = "/".join(line(_PART[axis.mount]) for axis in reversed(rotary))
    if len(rotary) < 2:
        kind = line("kind_four_axis", mount=kind) if rotary else line("kind_three_axis")
    return (
        machine.key,
        " ".join(in_words(word_said(axis)) for axis in order_of_axes(machine)),
        kind,
        ", ".join(_turn_text(axis) for axis in reversed(rotary)),
        _slide_travel(sorted(slides, key=lambda each: each.name)),
        load_control(machine.control).name,
        machine.name,
    )


def _turn_text(axis: Axis) -> str:
    if axis.endless:
        return line("axis_endless", axis=axis.name)
    if not math.isfinite(axis.high - axis.low):
        return axis.name
    return line("axis_range", axis=axis.name, low=axis.low, high=axis.high)


def _slide_travel(slides: Sequence[Axis]) -> str:
    stated = [axis for axis in slides if math.isfinite(axis.high - axis.low)]
    told = ", ".join(f"{axis.name} {axis.high - axis.low:g}" for axis in stated)
    return f"{told} mm" if stated else line("travel_not_stated")
