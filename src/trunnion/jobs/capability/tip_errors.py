"""How far the tip is off at axis values, and how much of that the workpiece zero takes.

In:     a ``Machine`` and axis values.
Out:    errors of tip and tool axis for each geometry number.
Units:  mm, radians; workpiece frame.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import repeat
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.machines import Machine, slide_positions
from trunnion.machines.sensitivity import GeometryNumber, NumberDerivative, derivatives

_SECONDS: Final = 3600.0


@dataclass(frozen=True, slots=True, eq=False)
class TipErrors:
    """Errors by one number: ``tip`` and ``left`` (k, 3) mm, as they are and with the zero set; ``axis`` (k, 3) rad."""

    number: GeometryNumber
    tip: Floats
    left: Floats | None
    axis: Floats


def tip_errors(
    machine: Machine, joints: Floats, at_zero: Floats | None, amounts: tuple[float, float]
) -> list[TipErrors]:
    """Errors at rows of axis values (k, 5); ``at_zero`` (1, 5) those where the zero was set; amounts in mm and rad."""
    constant: Iterable[NumberDerivative | None] = repeat(None) if at_zero is None else derivatives(machine, at_zero)
    found = []
    for each, there in zip(derivatives(machine, joints), constant, strict=False):
        amount = amounts[each.number.is_angle]
        left = None if there is None else amount * (each.tip - there.tip)
        found.append(TipErrors(each.number, amount * each.tip, left, amount * each.axis))
    return found


def in_radians(length: float, angle: float) -> tuple[float, float]:
    """Amounts as derivatives take them: mm, and radians of seconds of arc."""
    return length, math.radians(angle / _SECONDS)


def zero_pose(machine: Machine, zero_at: str | Mapping[str, float] | None) -> dict[str, float] | None:
    """Where the rotary axes stood when the zero was set, degrees by names; None: nothing was set.

    Raises
    ------
    InputError
        If it names something else than rotary axes, or no angles.
    """
    names = [machine.names[k] for k in machine.rotary]
    home = {name: machine.axis(name).home for name in names}
    if zero_at is None or zero_at == "none":
        return None
    if zero_at == "home":
        return home
    cure = f"give home, none, or angles such as {','.join(f'{name}=0' for name in names)}"
    if isinstance(zero_at, str):
        parts = [part.partition("=") for part in zero_at.split(",")]
        given: Mapping[str, object] = {name.strip(): value for name, _, value in parts}
    elif isinstance(zero_at, Mapping):
        given = zero_at
    else:
        raise wrong_argument("zero_at", zero_at, cure)
    for name in given:
        if name not in names:
            raise wrong_argument(
                "zero_at", str(zero_at), f"{name or 'no name'} is no rotary axis of the machine; {cure}"
            )
    try:
        pose = home | {name: float(str(value)) for name, value in given.items()}
    except ValueError:
        raise wrong_argument("zero_at", str(zero_at), cure) from None
    if not all(abs(value) < 1e5 for value in pose.values()):  # NaN is none either
        raise wrong_argument("zero_at", str(zero_at), cure)
    for name, value in pose.items():
        axis = machine.axis(name)
        if not axis.low <= value <= axis.high:
            limits = f"{name} goes from {axis.low:g} to {axis.high:g} degrees"
            raise wrong_argument("zero_at", str(zero_at), f"{limits}; give an angle within them")
    return pose


def joints_at_zero(machine: Machine, pose: Mapping[str, float]) -> Floats:
    """Axis values (1, 5) with the tip in the workpiece zero."""
    rotary = np.array([[pose[machine.names[k]] for k in machine.rotary]])
    joints = slide_positions(machine, np.zeros((1, 3)), rotary)
    if np.isnan(joints).any():
        text = ",".join(f"{name}={value:g}" for name, value in pose.items())
        raise wrong_argument("zero_at", text, "give another pose: the slides cannot reach the zero in this one")
    return joints
