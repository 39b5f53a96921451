"""The device model of a machine for an MTConnect agent: what the adapter tells, as XML (MTConnectDevices 1.6)."""

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Final

from trunnion.machines import Machine
from trunnion.twin.mtconnect.shdr import shown_text
from trunnion.twin.snapshots import TwinProgram

_NAMESPACE: Final = "urn:mtconnect.org:MTConnectDevices:1.6"
_SCHEMA: Final = f"{_NAMESPACE} http://schemas.mtconnect.org/schemas/MTConnectDevices_1.6.xsd"

#: A data item: key of the adapter, category, type, and further attributes.
Item = tuple[str, str, str, dict[str, str]]

_PATH_ITEMS: Final[tuple[Item, ...]] = (
    ("exec", "EVENT", "EXECUTION", {}),
    ("mode", "EVENT", "CONTROLLER_MODE", {}),
    ("program", "EVENT", "PROGRAM", {"subType": "ACTIVE"}),
    ("main_program", "EVENT", "PROGRAM", {"subType": "MAIN"}),
    ("block", "EVENT", "BLOCK", {}),
    ("line", "EVENT", "LINE_NUMBER", {"subType": "ABSOLUTE"}),
    ("block_number", "EVENT", "LINE_LABEL", {}),
    ("tool", "EVENT", "TOOL_NUMBER", {}),
    ("part_count", "EVENT", "PART_COUNT", {"subType": "ALL"}),
    ("feed_override", "EVENT", "PATH_FEEDRATE_OVERRIDE", {"subType": "PROGRAMMED"}),
    (
        "feed",
        "SAMPLE",
        "PATH_FEEDRATE",
        {"subType": "ACTUAL", "units": "MILLIMETER/SECOND", "nativeUnits": "MILLIMETER/MINUTE"},
    ),
    (
        "tip",
        "SAMPLE",
        "PATH_POSITION",
        {"subType": "ACTUAL", "units": "MILLIMETER_3D", "nativeUnits": "MILLIMETER_3D", "coordinateSystem": "WORK"},
    ),
    ("message", "EVENT", "MESSAGE", {}),
)  # fmt: skip


def device_name(machine: Machine) -> str:
    """Name of the device: letters, digits and underscores."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in machine.key) or "machine"


def device_xml(program: TwinProgram) -> str:
    """Return the device model of the machine of a program, as an agent reads it from its file of devices."""
    root = ET.Element(
        "MTConnectDevices",
        {
            "xmlns": _NAMESPACE,
            "xmlns:xsi": "http://www.w3.org/2001/XMLSchema-instance",
            "xsi:schemaLocation": _SCHEMA,
        },
    )
    # An agent writes a header of its own; this one is for the schema, and says nothing that changes.
    ET.SubElement(
        root, "Header", creationTime=_text(datetime(2026, 1, 1, tzinfo=UTC)), sender="trunnion", instanceId="1",
        version="1.6.0.0", assetBufferSize="1", assetCount="0", bufferSize="1",
    )  # fmt: skip
    ET.SubElement(root, "Devices").append(device_model(program))
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def device_model(program: TwinProgram, further: Iterable[Item] = ()) -> ET.Element:
    """Return the device, its components and data items; ``further``: items that it has besides."""
    machine = program.machine
    name, shown = device_name(machine), shown_text(machine.name)
    device = ET.Element("Device", id="d", uuid=f"trunnion-twin-{name}", name=name)
    description = ET.SubElement(device, "Description", manufacturer="Trunnion", model=shown)
    description.text = f"Twin of {shown}"
    _items(device, "d", [("avail", "EVENT", "AVAILABILITY", {}), *further])
    components = ET.SubElement(device, "Components")
    _axes(components, machine)
    controller = ET.SubElement(components, "Controller", id="c", name="controller")
    _items(controller, "c", [("estop", "EVENT", "EMERGENCY_STOP", {}), ("system", "CONDITION", "SYSTEM", {})])
    path = ET.SubElement(ET.SubElement(controller, "Components"), "Path", id="p", name="path")
    _items(path, "p", _PATH_ITEMS)
    return device


def _axes(components: ET.Element, machine: Machine) -> None:
    axes = ET.SubElement(components, "Axes", id="axes", name="axes")
    listed = ET.SubElement(axes, "Components")
    for column, axis in machine.own_columns:
        kind, name = ("Rotary" if axis.is_rotary else "Linear"), axis.name
        element = ET.SubElement(listed, kind, id=f"axis_{name}", name=name)
        measured = ("ANGLE", "DEGREE") if axis.is_rotary else ("POSITION", "MILLIMETER")
        units = {"subType": "ACTUAL", "units": measured[1], "nativeUnits": measured[1]}
        system = "MACHINE" if machine.is_placed(column) else "WORK"
        where = {} if axis.is_rotary else {"coordinateSystem": system}
        items: list[Item] = [
            (f"{name}_actual", "SAMPLE", measured[0], units | where),
            (f"{name}_state", "EVENT", "AXIS_STATE", {}),
            (f"{name}_travel", "CONDITION", "POSITION", {}),
        ]
        _items(element, f"axis_{name}", items)
    spindle = ET.SubElement(listed, "Rotary", id="spindle", name="S", nativeName="S1")
    revolutions = {"units": "REVOLUTION/MINUTE", "nativeUnits": "REVOLUTION/MINUTE"}
    _items(
        spindle, "spindle",
        [
            ("S_actual", "SAMPLE", "ROTARY_VELOCITY", {"subType": "ACTUAL", **revolutions}),
            ("S_commanded", "SAMPLE", "ROTARY_VELOCITY", {"subType": "COMMANDED", **revolutions}),
            ("S_direction", "EVENT", "DIRECTION", {"subType": "ACTUAL"}),
        ],
    )  # fmt: skip


def _items(of: ET.Element, prefix: str, items: Iterable[Item]) -> None:
    listed = ET.SubElement(of, "DataItems")
    for key, category, kind, further in items:
        ET.SubElement(
            listed, "DataItem", {"category": category, "id": f"{prefix}_{key}", "type": kind, "name": key} | further
        )


def _text(moment: datetime) -> str:
    return moment.isoformat(timespec="seconds").replace("+00:00", "Z")
