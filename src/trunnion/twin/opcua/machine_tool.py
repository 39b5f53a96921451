"""The objects of OPC 40501-1 for monitoring machine tools: state, production job, prognosis of its end, tools."""

from typing import Final

from asyncua import ua

from trunnion.twin.nodesets import DEVICES, MACHINE_TOOL, MACHINERY
from trunnion.twin.opcua.space import Space
from trunnion.twin.snapshots import TwinProgram

MACHINE: Final = "MachineTool"
_TOOLS: Final = f"{MACHINE}.Equipment.Tools"
_JOB: Final = f"{MACHINE}.Production.ProductionPlan.Job1"
_PROGNOSES: Final = f"{MACHINE}.Notification.Prognoses"
_MONITORING: Final = f"{MACHINE}.Monitoring"

#: Numbers of types in the NodeSet.
_MACHINE_TYPE, _TOOL_LIST, _TOOL, _CHANNEL, _SPINDLE = 13, 44, 50, 16, 22
_JOB_LIST, _JOB_TYPE, _PROGNOSIS_LIST, _JOB_END = 30, 29, 2, 37
_PROGRAM: Final = 59
_MACHINES_FOLDER, _ITEM_STATE = 1001, 1002

#: States of the state machines for programs and jobs: numbers of their nodes and of the states.
PROGRAM_STATES: Final = {"Initializing": (5039, 0), "Running": (5041, 1), "Ended": (5038, 2), "Interrupted": (5040, 3)}
JOB_STATES: Final = {"Initializing": (5015, 0), "Running": (5017, 1), "Ended": (5014, 2), "Interrupted": (5016, 3)}
ITEM_STATES: Final = {"Executing": (5006, 3), "NotExecuting": (5007, 2)}

_AUTOMATIC: Final = 1  # MachineOperationMode
_NUMBER_BASED: Final = 0  # ToolManagement

_DOUBLE, _INT32, _UINT32, _UINT16 = (
    ua.VariantType.Double,
    ua.VariantType.Int32,
    ua.VariantType.UInt32,
    ua.VariantType.UInt16,
)
_STRING, _BOOLEAN, _TEXT = ua.VariantType.String, ua.VariantType.Boolean, ua.VariantType.LocalizedText


async def build_machine_tool(space: Space, program: TwinProgram) -> None:
    """Add the machine to the folder of machines."""
    machines = space.server.get_node(ua.NodeId(_MACHINES_FOLDER, space.index(MACHINERY)))
    name = program.machine.name
    await space.add(machines, MACHINE, name, MACHINE_TOOL, (MACHINE_TOOL, _MACHINE_TYPE))
    await _identification(space, program)
    await _monitoring(space)
    await _tools(space, program)
    await _production(space, program)
    await _prognoses(space, program)


async def _identification(space: Space, program: TwinProgram) -> None:
    path, key = f"{MACHINE}.Identification", program.machine.key
    await space.put(f"{path}.Manufacturer", ua.LocalizedText("Trunnion"), _TEXT)
    await space.put(f"{path}.ProductInstanceUri", f"urn:trunnion:twin:{key}", _STRING)
    await space.put(f"{path}.SerialNumber", f"twin-{key}", _STRING)
    await space.variable(f"{path}.Model", DEVICES, _TEXT, ua.LocalizedText(program.machine.name), is_property=True)


async def _monitoring(space: Space) -> None:
    whole = f"{_MONITORING}.MachineTool"
    await space.put(f"{whole}.OperationMode", _AUTOMATIC, _INT32)
    await _percent(space, f"{whole}.FeedOverride", "state.override")
    await space.variable(f"{whole}.PowerOnDuration", MACHINE_TOOL, _UINT32)
    space.show("state.hours", _UINT32, f"{whole}.PowerOnDuration")
    monitoring = space.node(_MONITORING)
    channel, spindle = f"{_MONITORING}.Channel1", f"{_MONITORING}.Spindle1"
    await space.add(monitoring, channel, "Channel1", MACHINE_TOOL, (MACHINE_TOOL, _CHANNEL))
    await space.put(f"{channel}.Name", "Channel 1", _STRING)
    await space.put(f"{channel}.ChannelMode", 0, _INT32)
    space.show("state.channel", _INT32, f"{channel}.ChannelState")
    space.show("state.override", _DOUBLE, f"{channel}.FeedOverride")
    await space.unit(f"{channel}.FeedOverride", "P1", 0.0, 100.0)
    await space.add(monitoring, spindle, "Spindle1", MACHINE_TOOL, (MACHINE_TOOL, _SPINDLE))
    await space.put(f"{spindle}.Name", "Spindle 1", _STRING)
    space.show("spindle.turning", _BOOLEAN, f"{spindle}.IsRotating")
    blocks = await space.add(
        space.node(MACHINE), f"{MACHINE}.MachineryBuildingBlocks", "MachineryBuildingBlocks", MACHINERY,
        ua.NodeId(ua.ObjectIds.FolderType),
    )  # fmt: skip
    item = f"{MACHINE}.MachineryBuildingBlocks.MachineryItemState"
    await space.add(blocks, item, "MachineryItemState", MACHINERY, (MACHINERY, _ITEM_STATE))
    _show_state(space, item, "item")


async def _percent(space: Space, path: str, key: str) -> None:
    await space.variable(path, MACHINE_TOOL, _DOUBLE)
    await space.declare(path, ua.ObjectIds.AnalogUnitRangeType)
    await space.unit(path, "P1", 0.0, 100.0)
    space.show(key, _DOUBLE, path)


def _show_state(space: Space, path: str, what: str) -> None:
    """Have a state machine show a state."""
    space.show(f"state.{what}.text", _TEXT, f"{path}.CurrentState")
    space.show(f"state.{what}.id", ua.VariantType.NodeId, f"{path}.CurrentState.Id")
    number = f"{path}.CurrentState.Number"
    if space.id_of(number) in space.server.iserver.aspace:
        space.show(f"state.{what}.number", _UINT32, number)


async def _tools(space: Space, program: TwinProgram) -> None:
    equipment = space.node(f"{MACHINE}.Equipment")
    tools = await space.add(equipment, _TOOLS, "Tools", MACHINE_TOOL, (MACHINE_TOOL, _TOOL_LIST))
    for place, name in enumerate(program.tools, 1):
        path = f"{_TOOLS}.Tool{place}"
        await space.add(tools, path, f"Tool {name}", MACHINE_TOOL, (MACHINE_TOOL, _TOOL))
        await space.put(f"{path}.ControlIdentifier1", program.tool_number(name), _UINT32)
        await space.put(f"{path}.ControlIdentifierInterpretation", _NUMBER_BASED, _INT32)
        await space.put(f"{path}.Locked", False, _BOOLEAN)
        await space.absent(f"{path}.Locked.ReasonForLocking")
        for text in ("Identifier", "Name"):
            await space.variable(f"{path}.{text}", MACHINE_TOOL, _STRING, name, is_property=True)


async def _production(space: Space, program: TwinProgram) -> None:
    path = f"{MACHINE}.Production"
    active = f"{path}.ActiveProgram"
    await space.put(f"{active}.Name", program.name, _STRING)
    await space.put(f"{active}.NumberInList", 1, _UINT16)
    _show_state(space, f"{active}.State", "program_machine")
    plan = f"{path}.ProductionPlan"
    await space.add(space.node(path), plan, "ProductionPlan", MACHINE_TOOL, (MACHINE_TOOL, _JOB_LIST))
    await space.add(space.node(plan), _JOB, "Job1", MACHINE_TOOL, (MACHINE_TOOL, _JOB_TYPE))
    await space.put(f"{_JOB}.Identifier", program.name, _STRING)
    await space.put(f"{_JOB}.NumberInList", 1, _UINT16)
    await space.put(f"{_JOB}.RunsPlanned", 1, _UINT32)
    space.show("state.runs_planned", _UINT32, f"{_JOB}.RunsPlanned")
    space.show("state.runs_are_planned", _BOOLEAN, f"{_JOB}.RunsPlanned.IsValid")
    space.show("state.completed", _UINT32, f"{_JOB}.RunsCompleted")
    _show_state(space, f"{_JOB}.State", "job")
    await _programs(space, program)


async def _programs(space: Space, program: TwinProgram) -> None:
    """List the programs of the job: the main program, and the subprograms that it calls."""
    listed = space.node(f"{_JOB}.ProductionPrograms")
    for number, name in enumerate(program.files, 1):
        path = f"{_JOB}.ProductionPrograms.Program{number}"
        await space.add(listed, path, name, MACHINE_TOOL, (MACHINE_TOOL, _PROGRAM))
        await space.put(f"{path}.Name", name, _STRING)
        await space.put(f"{path}.NumberInList", number, _UINT16)


async def _prognoses(space: Space, program: TwinProgram) -> None:
    notification = space.node(f"{MACHINE}.Notification")
    listed = await space.add(notification, _PROGNOSES, "Prognoses", MACHINE_TOOL, (MACHINE_TOOL, _PROGNOSIS_LIST))
    path = f"{_PROGNOSES}.JobEnd"
    await space.add(listed, path, "JobEnd", MACHINE_TOOL, (MACHINE_TOOL, _JOB_END))
    await space.put(f"{path}.SourceIdentifier", program.name, _STRING)
    space.show("state.end", ua.VariantType.DateTime, f"{path}.PredictedTime")
