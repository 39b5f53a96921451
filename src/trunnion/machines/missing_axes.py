"""Rotary axes that a machine has not, so that one closed form serves those with two, one and none.

A missing axis turns the tool about itself. That moves neither tip nor tool axis, so nothing that a program does can ask
for it, and it stays at 0. It comes right after the axis that it is next to, on the same side: no link of the chain
changes.
"""

from typing import Final

from trunnion.machines.machine import Axis, AxisKind, Vector

#: Names that no definition and no program can have.
MISSING_NAMES: Final = ("-4", "-5")


def with_missing_axes(axes: tuple[Axis, ...], spindle: Vector) -> tuple[Axis, ...]:
    """Return the chain with two rotary axes: those that it has, and missing ones after them.

    axes     three linear axes and up to two rotary ones, from the workpiece to the tool
    spindle  direction of the spindle
    """
    turning = [k for k, axis in enumerate(axes) if axis.is_rotary]
    before = turning[-1] if turning else 0
    missing = tuple(
        Axis(
            name,
            AxisKind.ROTARY,
            axes[before].mount,
            spindle,
            axes[before].point,
            low=0.0,
            high=0.0,
            is_missing=True,
        )
        for name in MISSING_NAMES[len(turning) :]
    )
    return (*axes[: before + 1], *missing, *axes[before + 1 :])
