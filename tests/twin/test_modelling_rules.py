"""The objects of the twin are as their types ask for: what is mandatory is there, and no placeholder; it is served."""

import asyncio
import socket
from collections.abc import AsyncIterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import pytest
from asyncua import Node, ua

from tests.support.twins import HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.opcua.server import TwinServer


class Nobody:
    """Nobody operates the twin."""

    def __getattr__(self, name: str) -> Any:
        return lambda *_: None


async def children(node: Node) -> dict[str, Node]:
    return {(await child.read_browse_name()).Name: child for child in await node.get_children()}


async def mandatory(kind: Node) -> list[str]:
    """What a type and those that it extends ask for."""
    rules, names = {ua.ObjectIds.ModellingRule_Mandatory}, list[str]()
    while kind is not None:
        for name, child in (await children(kind)).items():
            found = await child.get_references(ua.ObjectIds.HasModellingRule)
            if {reference.NodeId.Identifier for reference in found} & rules:
                names.append(name)
        above = await kind.get_referenced_nodes(ua.ObjectIds.HasSubtype, ua.BrowseDirection.Inverse)
        kind = above[0] if above else None
    return names


@dataclass
class Look:
    """A look at what a server has; of each type once at what it asks for."""

    asked: dict[ua.NodeId, list[str]] = field(default_factory=dict)

    async def faults(self, node: Node, path: str) -> AsyncIterator[str]:
        """What is missing in an object or a variable, or stands for others, and in those below."""
        there = await children(node)
        for reference in await node.get_references(ua.ObjectIds.HasTypeDefinition):
            kind = reference.NodeId
            if kind not in self.asked:
                self.asked[kind] = await mandatory(Node(node.session, kind))
            for name in self.asked[kind]:
                if name not in there:
                    yield f"{path}: no {name}"
        for name, child in there.items():
            if "<" in name:
                yield f"{path}: {name} stands for others"
            if await child.read_node_class() in (ua.NodeClass.Object, ua.NodeClass.Variable):
                async for each in self.faults(child, f"{path}.{name}"):
                    yield each


@dataclass
class Seen:
    """What a server had, and what it answered to messages that stayed half open."""

    found: list[str]
    programs: list[str]
    historized: int
    answers: list[bytes]


async def served() -> Seen:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        server = TwinServer(twin_program(HUB_ROUGH, machine="yl569"), Nobody(), listening, "127.0.0.1", None)
        publisher = await server.prepare(1.0)
        look = Look()
        found = [
            each
            for root in ("MachineTool", "CncInterface")
            async for each in look.faults(server.space.node(root), root)
        ]
        listed = server.space.node("MachineTool.Production.ProductionPlan.Job1.ProductionPrograms")
        names = [name for name in await children(listed) if name != "NodeVersion"]
        keys = ("program.feed", "block.line", "state.program")
        historized = sum(len(target.histories) for key in keys for target in publisher._targets[key])
        await server.start()
        answers = [await answer(begun, listening) for begun in (b"", b"HELF\x40\x00\x00\x00half")]
        await server.stop()
    return Seen(found, names, historized, answers)


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
    assert seen.programs == [HUB_ROUGH.name]
    assert seen.historized == 3


def test_a_message_that_stays_half_open_ends_its_connection(seen: Seen) -> None:
    assert seen.answers == [b"", b""]
