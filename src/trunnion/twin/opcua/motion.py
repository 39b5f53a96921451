"""What a published twin of a machine shows beyond the specifications: how axes move, and switches of the machine.

``Twin.Axes.NAME`` has ``Velocity``, ``Acceleration`` and ``Jerk``, and the switches ``AtMinus`` and ``AtPlus`` at the
ends of the travel; ``Twin.ToolInSpindle`` and ``Twin.SpindleTurns`` are switches too.
"""

from typing import Final

from asyncua import ua

from trunnion.twin.opcua.columns import RATES, machine_axes
from trunnion.twin.opcua.operating import OBJECT
from trunnion.twin.opcua.space import TWIN, Space
from trunnion.twin.snapshots import TwinProgram

AXES: Final = f"{OBJECT}.Axes"

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
    for key, switch in (("block.has_tool", "ToolInSpindle"), ("spindle.turning", "SpindleTurns")):
        await space.variable(f"{OBJECT}.{switch}", TWIN, _BOOLEAN)
        space.show(key, _BOOLEAN, f"{OBJECT}.{switch}")
