"""Machines as a mistake in the loader or in a definition would make them."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

from trunnion.machines import AngleOutput, Axis, AxisKind, Machine, Mount, PositiveDirection, PreferredSign

Vector = tuple[float, float, float]

_FLIPPED_SENSE: Final = {
    PositiveDirection.STANDARD: PositiveDirection.REVERSED,
    PositiveDirection.REVERSED: PositiveDirection.STANDARD,
}
_OTHER_SIGN: Final = {
    PreferredSign.POSITIVE: PreferredSign.NEGATIVE,
    PreferredSign.NEGATIVE: PreferredSign.POSITIVE,
    PreferredSign.EITHER: PreferredSign.NEGATIVE,
}


def negative(vector: Vector) -> Vector:
    """The opposite vector."""
    return -vector[0] + 0.0, -vector[1] + 0.0, -vector[2] + 0.0


def flip_sense(axis: Axis) -> Axis:
    """The axis counted the other way."""
    return replace(axis, positive=_FLIPPED_SENSE[axis.positive])


def turn_round(axis: Axis) -> Axis:
    """The axis with its direction the other way."""
    return replace(axis, direction=negative(axis.direction))


def mirror_point(axis: Axis) -> Axis:
    """A rotary axis on the other side of zero."""
    return replace(axis, point=negative(axis.point))


def exchange_sides(axis: Axis) -> Axis:
    """The axis carries the other side."""
    return replace(axis, mount=Mount.PART if axis.mount is Mount.TOOL else Mount.TOOL)


def _shift(column: int) -> Callable[[Axis], Axis]:
    def shifted(axis: Axis) -> Axis:
        point = list(axis.point)
        point[column] += 1.0
        return replace(axis, point=(point[0], point[1], point[2]))

    return shifted


def mirror_limits(axis: Axis) -> Axis:
    """Travel of the other sign."""
    return replace(axis, low=-axis.high, high=-axis.low)


#: What one axis may have wrong.
AXIS_MUTATIONS: Final[dict[str, Callable[[Axis], Axis]]] = {
    "sense": flip_sense,
    "direction": turn_round,
    "direction rolled": lambda axis: replace(axis, direction=(axis.direction[2], *axis.direction[:2])),
    "side": exchange_sides,
    "limits": mirror_limits,
    "home": lambda axis: replace(axis, home=-axis.home + 0.0),
    "preferred sign": lambda axis: replace(axis, prefer=_OTHER_SIGN[axis.prefer]) if axis.is_rotary else axis,
    "point mirrored": mirror_point,
    "point along X": _shift(0),
    "point along Y": _shift(1),
    "point along Z": _shift(2),
    "endless": lambda axis: replace(axis, endless=not axis.endless) if axis.is_rotary else axis,
    "output": lambda axis: replace(axis, output=AngleOutput.SYMMETRIC) if axis.endless else axis,
    "name": lambda axis: replace(axis, name=axis.name + "1"),
}


def mutants(machine: Machine) -> Iterator[tuple[str, Machine]]:
    """Every mistake once, by its name; those that change nothing are left out.

    The point of a slide means nothing, and neither does that of a rotary axis along its own direction.
    """
    for k, axis in enumerate(machine.axes):
        for name, mutate in AXIS_MUTATIONS.items():
            changed = mutate(axis)
            if changed == axis or _is_same_line(axis, changed):
                continue
            axes = (*machine.axes[:k], changed, *machine.axes[k + 1 :])
            yield f"{axis.name} {name}", replace(machine, axes=axes)
    for k in range(4):
        axes = (*machine.axes[:k], machine.axes[k + 1], machine.axes[k], *machine.axes[k + 2 :])
        yield f"order of {machine.axes[k].name} and {machine.axes[k + 1].name}", replace(machine, axes=axes)
    yield "spindle direction", replace(machine, spindle_direction=negative(machine.spindle_direction))
    gauge = machine.spindle_point
    if any(gauge):
        yield "gauge point mirrored", replace(machine, spindle_point=negative(gauge))
    for k in range(3):
        moved = [part + (1.0 if k == j else 0.0) for j, part in enumerate(gauge)]
        yield f"gauge point along {'XYZ'[k]}", replace(machine, spindle_point=(moved[0], moved[1], moved[2]))
        zero = [1.0 if k == j else 0.0 for j in range(3)]
        yield f"workpiece zero along {'XYZ'[k]}", replace(machine, workpiece_zero=(zero[0], zero[1], zero[2]))


def _is_same_line(axis: Axis, changed: Axis) -> bool:
    if replace(changed, point=axis.point) != axis:
        return False
    if axis.kind is AxisKind.LINEAR:
        return True
    off = [b - a for a, b in zip(axis.point, changed.point, strict=True)]
    x, y, z = axis.direction
    cross = (off[1] * z - off[2] * y, off[2] * x - off[0] * z, off[0] * y - off[1] * x)
    return max(map(abs, cross)) < 1e-12
