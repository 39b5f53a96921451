"""Variables under the paths by which clients of a SINUMERIK 840D sl find them.

Siemens's server keeps them in the namespace ``SinumerikVarProvider``, which has index 2, below a folder ``Sinumerik``;
a path without brackets is that of the first one. Axes are numbered as the machine's control does here: slides by their
letters, then rotary axes.
"""

from typing import Final

from asyncua import Node, ua

from trunnion.twin.opcua.columns import FRAME, machine_axes
from trunnion.twin.opcua.space import Space
from trunnion.twin.snapshots import TwinProgram

VARIABLES: Final = "SinumerikVarProvider"

_DOUBLE, _INT32, _STRING = ua.VariantType.Double, ua.VariantType.Int32, ua.VariantType.String


async def build_sinumerik(space: Space, program: TwinProgram) -> None:
    """Add the folder with its variables."""
    builder = _Builder(space)
    await builder.begin()
    machine = program.machine
    for number, name in enumerate(FRAME, 1):
        await builder.fixed("Channel", "GeometricAxis", "name", number, name)
        await builder.shown("Channel", "GeometricAxis", "actToolBasePos", number, f"geo.{name}.actual", _DOUBLE)
        await builder.shown("Channel", "GeometricAxis", "toolBaseDistToGo", number, f"geo.{name}.to_go", _DOUBLE)
    for number, (name, _) in enumerate(machine_axes(machine), 1):
        await builder.fixed("Channel", "MachineAxis", "name", number, name)
        await builder.shown("Channel", "MachineAxis", "actToolBasePos", number, f"axis.{name}.actual", _DOUBLE)
        await builder.shown("Channel", "MachineAxis", "toolBaseDistToGo", number, f"axis.{name}.to_go", _DOUBLE)
    await builder.fixed("Channel", "Spindle", "name", 1, "SP1")
    await builder.shown("Channel", "Spindle", "actSpeed", 1, "spindle.actual", _DOUBLE)
    await builder.shown("Channel", "Spindle", "cmdSpeed", 1, "spindle.commanded", _DOUBLE)
    for number, key in enumerate(("block.before", "block.this", "block.after"), 1):
        await builder.shown("Channel", "ProgramInfo", "block", number, key, _STRING)
    await builder.shown("Channel", "ProgramInfo", "progName", 1, "block.file", _STRING)
    await builder.shown("Channel", "ProgramInfo", "actLineNumber", 1, "block.line", _INT32)
    for name, key, kind in (
        ("actFeedRateIpo", "program.feed", _DOUBLE),
        ("cmdFeedRateIpo", "block.feed", _DOUBLE),
        ("feedRateIpoOvr", "state.override", _DOUBLE),
        ("actTNumber", "block.tool_number", _INT32),
        ("actToolIdent", "block.tool", _STRING),
        ("chanStatus", "state.sinumerik_channel", _INT32),
        ("progStatus", "state.sinumerik_program", _INT32),
    ):
        await builder.shown("Channel", "State", name, 1, key, kind)


class _Builder:
    """Adds variables to folders that are made when they are needed."""

    def __init__(self, space: Space) -> None:
        self._space = space
        self._index = space.index(VARIABLES)
        self._folders: dict[str, Node] = {}

    async def begin(self) -> None:
        """Add the root."""
        objects, name = self._space.server.nodes.objects, ua.QualifiedName("Sinumerik", self._index)
        self._folders[""] = await objects.add_folder(ua.NodeId("Sinumerik", self._index), name)

    async def fixed(self, area: str, block: str, variable: str, number: int, text: str) -> None:
        """Add a text that stays."""
        for parent, node, name in await self._places(area, block, variable, number):
            await parent.add_variable(node, name, text, _STRING)

    async def shown(self, area: str, block: str, variable: str, number: int, key: str, kind: ua.VariantType) -> None:
        """Add a value that changes."""
        for parent, node, name in await self._places(area, block, variable, number):
            await parent.add_variable(node, name, ua.get_default_value(kind), kind)
            self._space.show_at(key, kind, node)

    async def _places(
        self, area: str, block: str, variable: str, number: int
    ) -> list[tuple[Node, ua.NodeId, ua.QualifiedName]]:
        parent = await self._folder(f"/{area}/{block}", block, await self._folder(f"/{area}", area, self._folders[""]))
        path = f"/{area}/{block}/{variable}"
        names = [f"{path}[u1,{number}]", *([path] if number == 1 else [])]
        index = self._index
        return [(parent, ua.NodeId(each, index), ua.QualifiedName(each.rpartition("/")[2], index)) for each in names]

    async def _folder(self, path: str, name: str, parent: Node) -> Node:
        if path not in self._folders:
            node, named = ua.NodeId(path, self._index), ua.QualifiedName(name, self._index)
            self._folders[path] = await parent.add_folder(node, named)
        return self._folders[path]
