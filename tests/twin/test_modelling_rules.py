"""The objects of the twin are as their types ask for: what is mandatory is there, and no placeholder."""

import asyncio
import socket
from collections.abc import AsyncIterator
from contextlib import suppress
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


async def mandatory(kind: Node) -> AsyncIterator[tuple[str, Node]]:
    """What a type and those that it extends ask for."""
    rules = {ua.ObjectIds.ModellingRule_Mandatory}
    while kind is not None:
        for name, child in (await children(kind)).items():
            found = await child.get_references(ua.ObjectIds.HasModellingRule)
            if {reference.NodeId.Identifier for reference in found} & rules:
                yield name, child
        above = await kind.get_referenced_nodes(ua.ObjectIds.HasSubtype, ua.BrowseDirection.Inverse)
        kind = above[0] if above else None


async def faults(node: Node, path: str) -> AsyncIterator[str]:
    """What is missing in an object or a variable, or stands for others, and in those below."""
    there = await children(node)
    for reference in await node.get_references(ua.ObjectIds.HasTypeDefinition):
        kind = Node(node.session, reference.NodeId)
        async for name, _ in mandatory(kind):
            if name not in there:
                yield f"{path}: no {name}"
    for name, child in there.items():
        if "<" in name:
            yield f"{path}: {name} stands for others"
        if await child.read_node_class() in (ua.NodeClass.Object, ua.NodeClass.Variable):
            async for each in faults(child, f"{path}.{name}"):
                yield each


async def served() -> tuple[list[str], list[str], list[int]]:
    program = twin_program(HUB_ROUGH, machine="yl569")
    with socket.create_server(("127.0.0.1", 0)) as listening:
        server = TwinServer(program, Nobody(), listening, "127.0.0.1", None)
        publisher = await server.prepare(1.0)
        found = []
        for root in ("MachineTool", "CncInterface"):
            found += [each async for each in faults(server.space.node(root), root)]
        listed = server.space.node("MachineTool.Production.ProductionPlan.Job1.ProductionPrograms")
        names = [name for name in await children(listed) if name != "NodeVersion"]
        historized = [
            len(target.histories)
            for key in ("program.feed", "block.line", "state.program")
            for target in publisher._targets[key]
        ]
    return found, names, historized


def test_all_that_types_ask_for_is_there_and_nothing_stands_for_others() -> None:
    found, programs, historized = asyncio.run(served())
    assert found == []
    assert programs == [HUB_ROUGH.name]
    assert sum(historized) == 3


@pytest.mark.parametrize("begun", [b"", b"HELF\x40\x00\x00\x00half"])
def test_a_message_that_stays_half_open_ends_its_connection(begun: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.twin.opcua.transport._PATIENCE", 0.2)

    async def asked() -> bytes:
        with socket.create_server(("127.0.0.1", 0)) as listening:
            server = TwinServer(twin_program(HUB_ROUGH, machine="yl569"), Nobody(), listening, "127.0.0.1", None)
            await server.prepare(1.0)
            await server.start()
            reader, writer = await asyncio.open_connection(*listening.getsockname()[:2])
            writer.write(begun)
            with suppress(ConnectionResetError):
                found = await asyncio.wait_for(reader.read(1), 120)
                await server.stop()
                return found
            await server.stop()
            return b""

    assert asyncio.run(asked()) == b""
