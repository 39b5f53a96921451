"""What a published twin of a machine shows beyond the specifications: how axes move, and switches of the machine.

``Twin.Axes.NAME`` has ``Velocity``, ``Acceleration`` and ``Jerk``, and the switches ``AtMinus`` and ``AtPlus`` at the
ends of the travel; ``Twin.ToolInSpindle``, ``Twin.SpindleTurns``, ``Twin.DoorClosed`` and ``Twin.ClampClosed`` are
switches too. ``Twin.Forces`` is the place of the forces of a cut, which nothing computes yet.
"""

from typing import Final

from asyncua import ua

from trunnion.twin.opcua.columns import RATES, machine_axes
from trunnion.twin.opcua.operating import OBJECT
from trunnion.twin.opcua.space import TWIN, Space
from trunnion.twin.snapshots import TwinProgram
from trunnion.twin.switches import SWITCHES, has_switch

AXES: Final = f"{OBJECT}.Axes"
FORCES: Final = f"{OBJECT}.Forces"

#: Columns -> the switches that show them.
_SWITCHES: Final = (
    ("block.has_tool", "ToolInSpindle"), ("spindle.turning", "SpindleTurns"), ("block.door", "DoorClosed"),
    ("block.clamp", "ClampClosed"),
)  # fmt: skip

_DOUBLE, _BOOLEAN = ua.VariantType.Double, ua.VariantType.Boolean

#: Units of velocity and acceleration of a linear and of a rotary axis; a jerk is in mm/s^3 or degrees/s^3.
_UNITS: Final = {False: ("C16", "M41"), True: ("E96", "M45")}


async def build_motion(space: Space, program: TwinProgram) -> None:
    """Add the axes with their rates and switches, and the switches of the spindle, below the object of the twin."""
    machine = program.machine
    await space.folder(space.node(OBJECT), AXES, "Axes")
    for name, column in machine_axes(machine):
        axis, path = machine.axes[column], f"{AXES}.{name}"
        await space.folder(space.node(AXES), path, name)
        for what in RATES:
            await space.variable(f"{path}.{what.capitalize()}", TWIN, _DOUBLE)
            space.show(f"axis.{name}.{what}", _DOUBLE, f"{path}.{what.capitalize()}")
        for what, unit in zip(RATES, _UNITS[axis.is_rotary], strict=False):
            await space.unit(f"{path}.{what.capitalize()}", unit)
        for key, switch in (("at_minus", "AtMinus"), ("at_plus", "AtPlus")):
            await space.variable(f"{path}.{switch}", TWIN, _BOOLEAN)
            if axis.has_limits and machine.is_placed(column):
                space.show(f"axis.{name}.{key}", _BOOLEAN, f"{path}.{switch}")
            else:
                await space.absent(f"{path}.{switch}")
    for key, switch in _SWITCHES:
        await space.variable(f"{OBJECT}.{switch}", TWIN, _BOOLEAN)
        if (name := key.removeprefix("block.")) in SWITCHES and not has_switch(machine, name):
            await space.absent(f"{OBJECT}.{switch}")
        else:
            space.show(key, _BOOLEAN, f"{OBJECT}.{switch}")
    await space.folder(space.node(OBJECT), FORCES, "Forces")
    for name in ("X", "Y", "Z"):
        await space.variable(f"{FORCES}.{name}", TWIN, _DOUBLE)
        await space.absent(f"{FORCES}.{name}")
