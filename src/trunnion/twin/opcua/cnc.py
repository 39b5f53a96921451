"""The objects of OPC 40502 for CNC systems: interface, axes, spindle and channel of the machine.

What the specification asks for and a program does not tell (load, torque, power) is marked as not supported.
"""

from typing import Final

from asyncua import Node, ua

from trunnion.machines import Machine
from trunnion.twin.nodesets import CNC
from trunnion.twin.opcua.columns import FRAME, machine_axes
from trunnion.twin.opcua.space import VERSION, Space
from trunnion.twin.snapshots import TwinProgram, display_range

_INTERFACE_TYPE, _AXIS_TYPE, _SPINDLE_TYPE, _CHANNEL_TYPE = 1007, 1004, 1005, 1002

INTERFACE: Final = "CncInterface"
CHANNEL: Final = f"{INTERFACE}.CncChannelList.Channel1"
SPINDLE: Final = f"{INTERFACE}.CncSpindleList.Spindle1"
AXES: Final = f"{INTERFACE}.CncAxisList"

#: What drives have that is not known here.
_UNKNOWN_OF_DRIVES: Final = ("ActLoad", "ActPower", "ActTorque", "CmdTorque")

_DOUBLE, _INT32, _UINT32 = ua.VariantType.Double, ua.VariantType.Int32, ua.VariantType.UInt32
_STRING, _BOOLEAN, _STRUCT = ua.VariantType.String, ua.VariantType.Boolean, ua.VariantType.ExtensionObject

#: Parts of a position, and the names of their values.
_PARTS: Final = (("ActPos", "actual"), ("CmdPos", "actual"), ("RemDist", "to_go"))


async def build_cnc(space: Space, program: TwinProgram) -> None:
    """Add the interface with its lists of axes, spindles and channels."""
    machine = program.machine
    objects = space.server.nodes.objects
    interface = await space.add(objects, INTERFACE, INTERFACE, CNC, (CNC, _INTERFACE_TYPE))
    texts = {"VendorName": "Trunnion", "VendorRevision": VERSION, "Version": "1.00"}
    for name, text in texts.items():
        await space.put(f"{INTERFACE}.{name}", text, _STRING)
    await space.variable(f"{INTERFACE}.CncTypeName", CNC, _STRING, machine.name, is_property=True)
    await interface.set_event_notifier([ua.EventNotifier.SubscribeToEvents])
    await _channel(space, program)
    channel = space.node(CHANNEL)
    for name, column in machine_axes(machine):
        await _axis(space, machine, column, name)
        await channel.add_reference(space.id_of(f"{AXES}.{name}"), ua.ObjectIds.HasComponent)
    await _spindle(space, machine)
    await channel.add_reference(space.id_of(SPINDLE), ua.ObjectIds.HasComponent)


async def _drive(space: Space, path: str) -> None:
    """Add what axes and spindles have in common."""
    for name in _UNKNOWN_OF_DRIVES:
        await space.absent(f"{path}.{name}")
    await space.put(f"{path}.ActChannel", space.id_of(CHANNEL), ua.VariantType.NodeId)
    await space.put(f"{path}.IsInactive", False, _BOOLEAN)
    await space.put(f"{path}.IsVirtual", False, _BOOLEAN)


async def _position(space: Space, path: str, key: str, unit: str, low: float, high: float) -> None:
    await space.unit(path, unit, low, high)
    space.show(f"{key}.position", _STRUCT, path)
    for name, what in _PARTS:
        space.show(f"{key}.{what}", _DOUBLE, f"{path}.{name}")


async def _axis(space: Space, machine: Machine, column: int, name: str) -> None:
    axis, (low, high) = machine.axes[column], display_range(machine, column)
    path, unit = f"{AXES}.{name}", "DD" if axis.is_rotary else "MMT"
    await space.add(space.node(AXES), path, name, CNC, (CNC, _AXIS_TYPE))
    await _drive(space, path)
    await space.put(f"{path}.IsReferenced", True, _BOOLEAN)
    await space.put(f"{path}.IsRotational", axis.is_rotary, _BOOLEAN)
    await space.put(f"{path}.ZeroOffset", 0.0, _DOUBLE)
    await space.unit(f"{path}.ZeroOffset", unit, low, high)
    space.show(f"axis.{name}.status", _INT32, f"{path}.ActStatus")
    for measured in ("PosDirect", "PosIndirect"):
        await _position(space, f"{path}.{measured}", f"axis.{name}", unit, low, high)
    await space.historize(f"axis.{name}.actual", f"{path}.PosDirect.ActPos")


async def _spindle(space: Space, machine: Machine) -> None:
    path, fastest = SPINDLE, machine.spindle_max_rpm or 0.0
    await space.add(space.node(f"{INTERFACE}.CncSpindleList"), path, "Spindle1", CNC, (CNC, _SPINDLE_TYPE))
    await _drive(space, path)
    for name in ("ActGear", "CmdGear"):
        await space.put(f"{path}.{name}", 1, _UINT32)
    for name in ("ActOverride", "CmdOverride"):
        await space.put(f"{path}.{name}", 100.0, _DOUBLE)
        await space.unit(f"{path}.{name}", "P1", 0.0, 100.0)
    for name, key in (("ActSpeed", "spindle.actual"), ("CmdSpeed", "spindle.commanded")):
        await space.unit(f"{path}.{name}", "RPM", 0.0, fastest)
        space.show(key, _DOUBLE, f"{path}.{name}")
    for name, key in (("ActStatus", "spindle.status"), ("ActTurnDirection", "spindle.direction")):
        space.show(key, _INT32, f"{path}.{name}")
    await _absent_position(space, f"{path}.AnglePos")
    await space.historize("spindle.actual", f"{path}.ActSpeed")


async def _absent_position(space: Space, path: str) -> None:
    for each in (path, *(f"{path}.{name}" for name, _ in _PARTS)):
        await space.absent(each)


async def _channel(space: Space, program: TwinProgram) -> None:
    path = CHANNEL
    node = await space.add(space.node(f"{INTERFACE}.CncChannelList"), path, "Channel1", CNC, (CNC, _CHANNEL_TYPE))
    await node.set_event_notifier([ua.EventNotifier.SubscribeToEvents])
    await space.put(f"{path}.Id", 1, _UINT32)
    for name in ("ActMainProgramName", "ActMainProgramFile"):
        await space.put(f"{path}.{name}", program.name, _STRING)
    await space.put(f"{path}.BlockMode", False, _BOOLEAN)
    for name in ("ActJogIncrement", "DryRunFeed", "ActModalOffsetFunction"):
        await space.absent(f"{path}.{name}")
    for name, key, kind in (
        ("ActFeedrate", "program.feed", _DOUBLE),
        ("CmdFeedrate", "block.feed", _DOUBLE),
        ("ActOverride", "state.override", _DOUBLE),
        ("CmdOverride", "state.override", _DOUBLE),
        ("ActGFunctions", "block.g", _UINT32),
        ("ActMFunctions", "block.m", _UINT32),
        ("ActOperationMode", "state.mode", _INT32),
        ("CmdOperationMode", "state.mode", _INT32),
        ("ActProgramBlock", "block.texts", _STRING),
        ("ActProgramName", "block.file", _STRING),
        ("ActProgramFile", "block.file", _STRING),
        ("ActProgramStatus", "state.program", _INT32),
        ("ActStatus", "state.channel", _INT32),
        ("FeedHold", "state.hold", _BOOLEAN),
        ("ToolId", "block.tool_number", _UINT32),
    ):
        space.show(key, kind, f"{path}.{name}")
    for name, kind in (("ActProgramLine", _STRING), ("ActProgramFileOffset", _UINT32)):
        await space.variable(f"{path}.{name}", CNC, kind)
        await space.declare(f"{path}.{name}", ua.ObjectIds.DataItemType)
    space.show("block.number", _STRING, f"{path}.ActProgramLine")
    space.show("block.line", _UINT32, f"{path}.ActProgramFileOffset")
    await space.historize("program.feed", f"{path}.ActFeedrate")
    await space.historize("block.texts", f"{path}.ActProgramBlock", _STRING)
    await space.historize("block.line", f"{path}.ActProgramFileOffset", _UINT32)
    await space.historize("state.program", f"{path}.ActProgramStatus", _INT32)
    for name in ("ActFeedrate", "CmdFeedrate"):
        await space.unit(f"{path}.{name}", "H81", 0.0, 1e6)
    for name in ("ActOverride", "CmdOverride"):
        await space.unit(f"{path}.{name}", "P1", 0.0, 100.0)
    await space.writable(f"{path}.CmdOverride")
    await _tool_centre_point(space, program.machine, path)


async def _tool_centre_point(space: Space, machine: Machine, path: str) -> None:
    """Positions of the tip: without frames of the program, base and workpiece coordinates are the same here."""
    rotary = {machine.names[k]: display_range(machine, k) for k in machine.own_rotary}
    for frame in ("PosTcpWcs", "PosTcpBcs"):
        for name in FRAME:
            await _position(space, f"{path}.{frame}{name}", f"tip.{name}", "MMT", -1e5, 1e5)
        for name in ("A", "B", "C"):
            if name in rotary:
                await _position(space, f"{path}.{frame}{name}", f"axis.{name}", "DD", *rotary[name])
            else:
                await _absent_position(space, f"{path}.{frame}{name}")


def event_sources(space: Space) -> tuple[Node, ...]:
    """Nodes at which alarms and messages are told."""
    return (space.server.get_node(ua.NodeId(ua.ObjectIds.Server)), space.node(INTERFACE), space.node(CHANNEL))
