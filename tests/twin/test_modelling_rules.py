"""The objects of the twin are as their types ask for: what is mandatory is there, and no placeholder; it is served."""

import asyncio
import re
import socket
import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import AsyncIterator
from contextlib import suppress
from dataclasses import dataclass, field

import pytest
from asyncua import Node, Server, ua

from tests.support.twins import HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.nodesets import NODESETS, nodeset
from trunnion.twin.opcua.outlet import OpcUaOutlet
from trunnion.twin.opcua.server import TwinServer
from trunnion.twin.playback import Playback
from trunnion.twin.running import Twin

MANDATORY = ua.ObjectIds.ModellingRule_Mandatory

#: What has a value or parts.
INSTANCES = (ua.NodeClass.Object, ua.NodeClass.Variable)


async def children(node: Node) -> dict[str, Node]:
    return {(await child.read_browse_name()).Name: child for child in await node.get_children()}


async def is_mandatory(node: Node) -> bool:
    found = await node.get_references(ua.ObjectIds.HasModellingRule)
    return MANDATORY in {reference.NodeId.Identifier for reference in found}


async def lineage(kind: Node | None) -> AsyncIterator[Node]:
    """A type and those that it extends."""
    while kind is not None:
        yield kind
        above = await kind.get_referenced_nodes(ua.ObjectIds.HasSubtype, ua.BrowseDirection.Inverse)
        kind = above[0] if above else None


@dataclass
class Look:
    """A look at what a server has; of each type once at what it declares."""

    declared: dict[ua.NodeId, dict[str, list[Node]]] = field(default_factory=dict)
    mandatory: dict[ua.NodeId, bool] = field(default_factory=dict)
    seen: set[ua.NodeId] = field(default_factory=set)
    asked: int = 0

    async def faults(self, node: Node, path: str, declarations: list[Node] | None = None) -> list[str]:
        """What is missing in an instance and those below, stands for others, has no value or another type.

        declarations: what its parent's type says of it, which may ask for more than its own type
        """
        found, there, asked = list[str](), await children(node), defaultdict[str, list[Node]](list)
        kinds = await node.get_referenced_nodes(ua.ObjectIds.HasTypeDefinition)
        kinds += await node.get_referenced_nodes(ua.ObjectIds.HasInterface)
        for source in (*(declarations or []), *kinds):
            for name, each in (await self.declarations(source)).items():
                asked[name] += each
        for name, each in asked.items():
            if any([await self.is_asked_for(declaration) for declaration in each]):
                self.asked += 1
                if name not in there:
                    found.append(f"{path}: no {name}")
        for name, child in there.items():
            below = f"{path}.{name}"
            if "<" in name:
                found.append(f"{below}: stands for others")
            if child.nodeid in self.seen or await child.read_node_class() not in INSTANCES:
                continue
            self.seen.add(child.nodeid)
            found += [f"{below}: {each}" for each in await self.of_other_type(child, asked[name])]
            if await has_no_value(child):
                found.append(f"{below}: no value, and good")
            found += await self.faults(child, below, asked[name])
        return found

    async def declarations(self, source: Node) -> dict[str, list[Node]]:
        """What a type, or a declaration in one, says of its parts."""
        if source.nodeid not in self.declared:
            parts = self.declared[source.nodeid] = defaultdict(list)
            async for each in lineage(source):
                for name, child in (await children(each)).items():
                    parts[name].append(child)
        return self.declared[source.nodeid]

    async def is_asked_for(self, declaration: Node) -> bool:
        if declaration.nodeid not in self.mandatory:
            self.mandatory[declaration.nodeid] = await is_mandatory(declaration)
        return self.mandatory[declaration.nodeid]

    async def of_other_type(self, node: Node, declarations: list[Node]) -> list[str]:
        """Types that a node should be of, and is not."""
        defines = ua.ObjectIds.HasTypeDefinition
        own = [each for kind in await node.get_referenced_nodes(defines) async for each in lineage(kind)]
        wanted = [kind for declaration in declarations for kind in await declaration.get_referenced_nodes(defines)]
        return [f"no {(await kind.read_browse_name()).Name}" for kind in wanted if kind not in own]


async def has_no_value(node: Node) -> bool:
    """Whether a variable shows nothing, and says that this is good."""
    if await node.read_node_class() is not ua.NodeClass.Variable:
        return False
    shown = await node.read_data_value(raise_on_bad_status=False)
    return bool(shown.StatusCode.is_good() and shown.Value.Value is None)


async def looked(server: Server, look: Look) -> list[str]:
    """What is wrong in all objects but those of OPC UA itself."""
    found: list[str] = []
    for root in await server.nodes.objects.get_children():
        name = await root.read_browse_name()
        if name.NamespaceIndex:
            found += await look.faults(root, name.Name)
    return found


@dataclass
class Seen:
    """What a server had, and what it answered to messages that stayed half open."""

    found: list[str]
    asked: int
    after_harm: list[str]
    not_loaded: list[str]
    programs: list[str]
    historized: int
    answers: list[bytes]


async def served() -> Seen:
    program = twin_program(HUB_ROUGH, machine="yl569")
    with socket.create_server(("127.0.0.1", 0)) as listening:
        twin = Twin(program, Playback(program.timed, speed=1.0), 1.0)
        server = TwinServer(program, twin, listening, "127.0.0.1", None)
        publisher = await server.prepare(1.0)
        twin.outlets.append(OpcUaOutlet(program, server, publisher, twin.clock()))
        await twin.reset()  # tells what the machine shows
        look = Look()
        found = await looked(server, look)
        missing = await not_loaded(server)
        listed = server.space.node("MachineTool.Production.ProductionPlan.Job1.ProductionPrograms")
        names = [name for name in await children(listed) if name != "NodeVersion"]
        keys = ("program.feed", "block.texts", "block.line", "state.program")
        historized = sum(len(target.histories) for key in keys for target in publisher._targets[key])
        await server.start()
        answers = [await answer(begun, listening) for begun in (b"", b"HELF\x40\x00\x00\x00half")]
        await harm(server)
        after = await looked(server, Look())
        await server.stop()
    return Seen(found, look.asked, after, missing, names, historized, answers)


async def not_loaded(server: Server) -> list[str]:
    """Nodes that a NodeSet has by its rules, and of which the server does not know it."""
    spaces, missing = await server.get_namespace_array(), []
    for name, is_sound in NODESETS:
        root = ET.fromstring(re.sub(r'\sxmlns="[^"]+"', "", nodeset(name), count=1))
        (space,) = root.findall("Models/Model")
        index = spaces.index(space.get("ModelUri"))
        for node in root:
            rules = {each.text for each in node.iterfind("References/Reference[@ReferenceType='HasModellingRule']")}
            local = str(node.get("NodeId")).partition(";")[2]
            if rules & {"i=78"} and local:
                there = server.get_node(f"ns={index};{local}")
                is_wanted = is_sound or there.nodeid in server.iserver.aspace
                if is_wanted and not await is_mandatory(there):
                    missing.append(f"{name}: {node.get('BrowseName')}")
    return missing


#: What is done to a server that was sound, and what is found then.
HARM = {
    "CncInterface.CncAxisList.X.ActLoad.EURange": "CncInterface.CncAxisList.X.ActLoad: no EURange",
    "MachineTool.Identification.SerialNumber": "Machines.Yalong YL569.Identification: no SerialNumber",
    "MachineTool.Production.ActiveProgram.State.CurrentState.Id":
        "Machines.Yalong YL569.Production.ActiveProgram.State.CurrentState: no Id",
    "CncInterface.CncSpindleList": "CncInterface: no CncSpindleList",
}  # fmt: skip


async def harm(server: TwinServer) -> None:
    """Take away what is mandatory, in depth and in inherited types, a value and a type."""
    for path in HARM:
        await server.delete_nodes([server.space.node(path)], recursive=True)
    job = "MachineTool.Production.ProductionPlan.Job1"
    completed = server.iserver.aspace[server.space.id_of(f"{job}.RunsCompleted")]
    completed.attributes[ua.AttributeIds.Value].value = ua.DataValue(ua.Variant())
    await server.space.declare("MachineTool.Monitoring.MachineTool.FeedOverride", ua.ObjectIds.BaseDataVariableType)
    await server.space.folder(server.space.node(f"{job}.ProductionPrograms"), f"{job}.Any", "<OrderedObject>")


async def answer(begun: bytes, listening: socket.socket) -> bytes:
    """What comes before the end of a connection on which a message was begun."""
    reader, writer = await asyncio.open_connection(*listening.getsockname()[:2])
    writer.write(begun)
    with suppress(ConnectionResetError):
        async with asyncio.timeout(120):
            return await reader.read(1)
    return b""


@pytest.fixture(scope="module")
def seen() -> Seen:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("trunnion.twin.opcua.transport._PATIENCE", 0.2)
        return asyncio.run(served())


def test_all_that_types_ask_for_is_there_and_nothing_stands_for_others(seen: Seen) -> None:
    assert seen.found == []
    assert seen.asked > 300
    assert seen.programs == [HUB_ROUGH.name]
    assert seen.historized == 4


def test_the_server_has_all_rules_of_the_nodesets(seen: Seen) -> None:
    assert seen.not_loaded == []


def test_what_is_missing_is_found(seen: Seen) -> None:
    job = "Machines.Yalong YL569.Production.ProductionPlan.Job1"
    assert set(seen.after_harm) >= {
        *HARM.values(),
        f"{job}.RunsCompleted: no value, and good",
        "Machines.Yalong YL569.Monitoring.MachineTool.FeedOverride: no AnalogUnitRangeType",
        f"{job}.ProductionPrograms.<OrderedObject>: stands for others",
    }


def test_a_message_that_stays_half_open_ends_its_connection(seen: Seen) -> None:
    assert seen.answers == [b"", b""]
