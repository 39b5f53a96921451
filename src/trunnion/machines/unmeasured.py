"""Which numbers about a machine stand on values that nobody has measured.

In:     a ``Machine``, and axis values that count.
Out:    the values that matter there, in the order of the definition.
Units:  mm, degrees.

A value matters only where another one would change the number: the travel of an axis that stands still does not, nor
does the point of a rotary axis that does not turn. For the geometry ``trunnion.machines.sensitivity`` says so.
"""

from collections.abc import Collection, Iterator, Mapping
from enum import StrEnum
from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions.marked_values import MarkedValue
from trunnion.machines.machine import Machine
from trunnion.machines.sensitivity import NumberKind, derivatives

#: What moves the tip by less, mm for each mm or radian, does not matter.
_NOTHING: Final = 1e-6


class ValueKind(StrEnum):
    """What a value of a definition is about."""

    GEOMETRY = "geometry"
    ANGLES = "angles"
    TRAVEL = "travel"
    HOME = "home"
    RAPID = "rapid"
    ACCELERATION = "acceleration"
    SPINDLE = "spindle"
    WAITS = "waits"
    BODIES = "bodies"
    TABLE = "table"
    CONTROL = "control"


_KINDS: Final = {
    "point_mm": ValueKind.GEOMETRY, "direction": ValueKind.GEOMETRY, "gauge_point_mm": ValueKind.GEOMETRY,
    "zero_mm": ValueKind.GEOMETRY, "output": ValueKind.ANGLES, "positive": ValueKind.ANGLES,
    "endless": ValueKind.TRAVEL, "limits_mm": ValueKind.TRAVEL, "limits_deg": ValueKind.TRAVEL,
    "home_mm": ValueKind.HOME, "home_deg": ValueKind.HOME,
    "rapid_mm_min": ValueKind.RAPID, "rapid_deg_min": ValueKind.RAPID,
    "acceleration_mm_s2": ValueKind.ACCELERATION, "acceleration_deg_s2": ValueKind.ACCELERATION,
    "max_rpm": ValueKind.SPINDLE, "min_rpm": ValueKind.SPINDLE, "tool_change_s": ValueKind.WAITS,
    "acceleration_rpm_s": ValueKind.WAITS, "carries": ValueKind.BODIES,
}  # fmt: skip

#: Keys of the tables that are about one thing.
_TABLES: Final = {"body": ValueKind.BODIES, "facts": ValueKind.TABLE, "control": ValueKind.CONTROL}

_NUMBERS: Final = {
    "point_mm": (NumberKind.POINT,),
    "direction": (NumberKind.DIRECTION, NumberKind.SPINDLE),
    "gauge_point_mm": (NumberKind.GAUGE_POINT,),
    "zero_mm": (NumberKind.WORKPIECE_ZERO,),
}

#: What positions of axes stand on.
POSITIONS: Final = (ValueKind.GEOMETRY, ValueKind.ANGLES)


def unmeasured_values(
    machine: Machine, kinds: Collection[ValueKind], joints: Floats | None = None
) -> tuple[MarkedValue, ...]:
    """Return the values of some kinds that nobody has measured and that matter.

    joints  (n, 5) some axis values that count, in the order of ``machine.axes``; None: any may
    """
    found = [value for value in machine.nobody_measured if kind_of(value) in kinds]
    if joints is None or not found:
        return tuple(found)
    rows = joints[np.isfinite(joints).all(axis=1)]
    moving = {axis.name for k, axis in machine.own_columns if len(rows) and np.ptp(rows[:, k]) > 0.0}
    geometry = set(_geometry_that_matters(machine, rows)) if any(each.key in _NUMBERS for each in found) else set()
    return tuple(value for value in found if _matters(value, moving, geometry))


def corners(machine: Machine, ranges: Mapping[str, tuple[float, float]]) -> Floats:
    """Return the axis values (32, 5) at the ends of ranges of axes; 0 for an axis that has none."""
    return np.array(list(product(*(ranges.get(axis.name, (0.0, 0.0)) for axis in machine.axes))))


def kind_of(value: MarkedValue) -> ValueKind:
    """Return what a value is about."""
    return _TABLES.get(value.table) or _KINDS.get(value.key, ValueKind.CONTROL)


def _matters(value: MarkedValue, moving: Collection[str], geometry: Collection[tuple[str, str]]) -> bool:
    if value.key in _NUMBERS:
        return (value.of if value.table == "axis" else "", value.key) in geometry
    return value.table != "axis" or value.of in moving


def _geometry_that_matters(machine: Machine, rows: Floats) -> Iterator[tuple[str, str]]:
    """Yield axis and key of each number that moves the tip in one of some rows.

    Where the workpiece zero is not stated it is set at the machine with the rotary axes at zero, and takes what the
    tip is off there.
    """
    there = derivatives(machine, np.zeros((1, 5)))
    for each, at_zero in zip(derivatives(machine, rows), there, strict=True):
        tip = each.tip if machine.workpiece_zero is not None else each.tip - at_zero.tip
        if len(tip) and float(np.abs(tip).max()) > _NOTHING:
            key = next((key for key, kinds in _NUMBERS.items() if each.number.kind in kinds), "")
            yield each.number.axis, key
