"""The shipped machines, a line each: what to compare with one's own before one of them is extended."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.controls import load_control
from trunnion.machines import Axis, Machine
from trunnion.machines.machine import Mount

_PART: Final = {Mount.PART: "table", Mount.TOOL: "head"}


def machine_list(machines: Sequence[Machine]) -> Iterator[str]:
    """Key, where the rotary axes are, what all axes reach, control and name, in columns."""
    rows = [_cells(machine) for machine in machines]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()


def _cells(machine: Machine) -> tuple[str, ...]:
    rotary = [axis for axis in machine.axes if axis.is_rotary]
    slides = [axis for axis in machine.axes if not axis.is_rotary]
    # As they are spoken of: from the tool to the workpiece where both are told.
    kind = "/".join(_PART[axis.mount] for axis in reversed(rotary))
    return (
        machine.key,
        kind,
        ", ".join(_turns(axis) for axis in reversed(rotary)),
        _travel(sorted(slides, key=lambda each: each.name)),
        load_control(machine.control.unread_copy()).name,
        machine.name,
    )


def _turns(axis: Axis) -> str:
    if axis.endless:
        return f"{axis.name} endless"
    return f"{axis.name} {axis.low:g} to {axis.high:g}°" if math.isfinite(axis.high - axis.low) else axis.name


def _travel(slides: Sequence[Axis]) -> str:
    stated = [axis for axis in slides if math.isfinite(axis.high - axis.low)]
    told = ", ".join(f"{axis.name} {axis.high - axis.low:g}" for axis in stated)
    return f"{told} mm" if stated else "travel not stated"
