"""The address space of a twin's server: objects of published types, and which values their variables show.

A node of the twin is named by its path, ``CncInterface.CncAxisList.X.PosDirect.ActPos``: its NodeId is that text in the
namespace of the twin, so that a client may also name it without browsing.
"""

from collections.abc import Callable, Sequence
from dataclasses import field
from importlib import metadata
from typing import Any, Final

from asyncua import Node, Server, ua

from trunnion.records import dataclass
from trunnion.twin.nodesets import CNC, DEVICES, NODESETS, nodeset

#: Namespace of the twin's own nodes.
TWIN: Final = "urn:trunnion:twin"

#: Version of the package, from which no part of it imports.
VERSION: Final = metadata.version("trunnion")

#: Number of the type of messages of OPC 40502, and the browse name of what its NodeSet puts among the objects.
MESSAGE_TYPE: Final = 1011
_DEMO: Final = "test"

#: Number of the property of the folder for devices that its NodeSet leaves without a value.
_ONLINE_ACCESS: Final = 6095

#: Engineering units by their UN/CEFACT codes (OPC 10000-8, 5.6.3): display name and description.
_UNITS: Final = {
    "MMT": ("mm", "millimetre"),
    "DD": ("°", "degree"),
    "H81": ("mm/min", "millimetre per minute"),
    "RPM": ("r/min", "revolutions per minute"),
    "P1": ("%", "percent"),
    "SEC": ("s", "second"),
    "C16": ("mm/s", "millimetre per second"),
    "E96": ("°/s", "degree per second"),
    "M41": ("mm/s²", "millimetre per second squared"),
    "M45": ("°/s²", "degree per second squared"),
}
_UNITS_NAMESPACE: Final = "http://www.opcfoundation.org/UA/units/un/cefact"

_READ: Final = ua.AccessLevel.CurrentRead.mask
_WRITE: Final = ua.AccessLevel.CurrentWrite.mask
_HISTORY: Final = ua.AccessLevel.HistoryRead.mask


@dataclass(slots=True)
class Shown:
    """Variables that show a value, and those of them whose history is kept."""

    nodes: list[ua.NodeId] = field(default_factory=list)
    historized: list[ua.NodeId] = field(default_factory=list)


class Space:
    """Builds the address space; ``shown`` are the variables by name and type of the value that they show."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self._index: dict[str, int] = {}
        self.shown: dict[tuple[str, ua.VariantType], Shown] = {}
        self.own = 0

    async def load(self, first_namespaces: Sequence[str]) -> None:
        """Register namespaces, beginning with index 2, and load the NodeSets."""
        for uri in first_namespaces:
            await self.server.register_namespace(uri)
        self.own = await self.server.register_namespace(TWIN)
        for name, is_sound in NODESETS:
            await self.server.import_xml(xmlstring=nodeset(name), strict_mode=is_sound)
        self._index = {uri: k for k, uri in enumerate(await self.server.get_namespace_array())}
        await self._mend_cnc()
        online = self.server.get_node(ua.NodeId(_ONLINE_ACCESS, self.index(DEVICES)))
        await online.write_value(ua.DataValue(ua.Variant(False, ua.VariantType.Boolean)))

    async def _mend_cnc(self) -> None:
        """Take the demo object of the NodeSet for CNC systems away, and add the type that was left out with it."""
        for node in await self.server.nodes.objects.get_children():
            if (await node.read_browse_name()).Name == _DEMO:
                await self.server.delete_nodes([node], recursive=True)
        index = self.index(CNC)
        message = ua.NodeId(MESSAGE_TYPE, index)
        if message not in self.server.iserver.aspace:
            name = ua.QualifiedName("CncMessageType", index)
            await self.server.nodes.base_event_type.add_object_type(message, name)

    def index(self, uri: str) -> int:
        """Index of a namespace."""
        return self._index[uri]

    def id_of(self, path: str) -> ua.NodeId:
        """Return the NodeId of a node of the twin."""
        return ua.NodeId(path, self.own)

    def node(self, path: str) -> Node:
        """Return a node of the twin by its path; of others by their NodeId as text."""
        return self.server.get_node(self.id_of(path))

    async def add(self, parent: Node, path: str, name: str, uri: str, of: ua.NodeId | tuple[str, int]) -> Node:
        """Add an object of a type with its mandatory children.

        parent     object in which it is
        path       its path; those of its children begin with it
        name, uri  its browse name, and the namespace of that
        of         its type: a NodeId, or namespace and number
        """
        kind = of if isinstance(of, ua.NodeId) else ua.NodeId(of[1], self.index(of[0]))
        name_of = ua.QualifiedName(name, self.index(uri))
        made = await parent.add_object(self.id_of(path), name_of, objecttype=kind, instantiate_optional=False)
        await self._remove_placeholders(made)
        return made

    async def _remove_placeholders(self, node: Node) -> None:
        """Remove what stands in a type for objects of any name: the library makes an object of it."""
        for child in await node.get_children():
            if child.nodeid.NamespaceIndex != self.own:
                continue
            if (await child.read_browse_name()).Name.startswith("<"):
                await self.server.delete_nodes([child], recursive=True)
            else:
                await self._remove_placeholders(child)

    async def folder(self, parent: Node, path: str, name: str, uri: str = TWIN) -> Node:
        """Add an object without a type of its own."""
        return await self.add(parent, path, name, uri, ua.NodeId(ua.ObjectIds.BaseObjectType))

    async def variable(
        self, path: str, uri: str, kind: ua.VariantType, value: Any = None, *, is_property: bool = False
    ) -> Node:
        """Add a variable that its type leaves open to the object that is named before the last point of its path."""
        parent, _, name = path.rpartition(".")
        node = self.node(parent)
        add = node.add_property if is_property else node.add_variable
        browse_name = ua.QualifiedName(name, self.index(uri))
        start = value if value is not None else ua.get_default_value(kind)
        return await add(self.id_of(path), browse_name, start, kind, ua.NodeId(kind.value))

    async def put(self, path: str, value: Any, kind: ua.VariantType) -> None:
        """Give a variable a value that stays."""
        await self.node(path).write_value(ua.DataValue(ua.Variant(value, kind)))

    async def absent(self, path: str) -> None:
        """Mark a variable that its type asks for, and properties of it, of which the twin knows nothing."""
        status = ua.StatusCode(ua.StatusCodes.BadNotSupported)
        without = [each for each in await self.node(path).get_properties() if await each.read_value() is None]
        for node in (self.node(path), *without):
            await node.write_value(ua.DataValue(ua.Variant(), status))

    async def declare(self, path: str, kind: int) -> None:
        """Give a variable of ``variable`` the type of variables that the NodeSet declares for it."""
        node, defines = self.node(path), ua.ObjectIds.HasTypeDefinition
        await node.delete_reference(await node.read_type_definition(), defines)
        await node.add_reference(ua.NodeId(kind), defines, bidirectional=False)

    async def unit(self, path: str, code: str, low: float | None = None, high: float | None = None) -> None:
        """Give a variable its unit, by its UN/CEFACT code, and the range of its values, as far as it has them."""
        name, described = _UNITS[code]
        number = int.from_bytes(code.encode(), "big")
        unit = ua.EUInformation(_UNITS_NAMESPACE, number, ua.LocalizedText(name), ua.LocalizedText(described))
        await self._property(path, "EngineeringUnits", unit, ua.ObjectIds.EUInformation)
        if low is not None and high is not None:
            await self._property(path, "EURange", ua.Range(low, high), ua.ObjectIds.Range)

    async def _property(self, path: str, name: str, value: Any, kind: int) -> None:
        if self.id_of(f"{path}.{name}") in self.server.iserver.aspace:
            await self.put(f"{path}.{name}", value, ua.VariantType.ExtensionObject)
        else:
            of, named = self.id_of(f"{path}.{name}"), ua.QualifiedName(name, 0)
            await self.node(path).add_property(of, named, value, ua.VariantType.ExtensionObject, ua.NodeId(kind))

    def show(self, key: str, kind: ua.VariantType, *paths: str) -> None:
        """Have variables of the twin show the value of a name."""
        self.show_at(key, kind, *map(self.id_of, paths))

    def show_at(self, key: str, kind: ua.VariantType, *nodes: ua.NodeId) -> None:
        """Have variables of any namespace show the value of a name."""
        for node in nodes:
            if node not in self.server.iserver.aspace:
                raise KeyError(node.to_string())
        self.shown.setdefault((key, kind), Shown()).nodes += nodes

    async def historize(self, key: str, path: str, kind: ua.VariantType = ua.VariantType.Double) -> None:
        """Keep the history of a value for clients that read it from a variable."""
        access = ua.DataValue(ua.Variant(_READ | _HISTORY, ua.VariantType.Byte))
        for attribute in (ua.AttributeIds.AccessLevel, ua.AttributeIds.UserAccessLevel):
            await self.node(path).write_attribute(attribute, access)
        await self.node(path).write_attribute(ua.AttributeIds.Historizing, ua.DataValue(ua.Variant(True)))
        self.shown[key, kind].historized.append(self.id_of(path))

    async def writable(self, path: str) -> None:
        """Let clients write a variable."""
        access = ua.DataValue(ua.Variant(_READ | _WRITE, ua.VariantType.Byte))
        for attribute in (ua.AttributeIds.AccessLevel, ua.AttributeIds.UserAccessLevel):
            await self.node(path).write_attribute(attribute, access)

    async def method(self, parent: str, name: str, call: Callable[..., Any], described: str) -> None:
        """Add a method without arguments."""
        node = self.node(parent)
        made = await node.add_method(self.id_of(f"{parent}.{name}"), ua.QualifiedName(name, self.own), call, [], [])
        text = ua.DataValue(ua.Variant(ua.LocalizedText(described), ua.VariantType.LocalizedText))
        await made.write_attribute(ua.AttributeIds.Description, text)
