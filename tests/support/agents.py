"""MTConnect agents, and their documents taken apart by the rules of the standard."""

import asyncio
import re
import socket
import xml.etree.ElementTree as ET
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager

from trunnion.twin.mtconnect.agent import MTConnectAgent
from trunnion.twin.playback import Playback
from trunnion.twin.running import Twin
from trunnion.twin.snapshots import TwinProgram

NOW = 1_780_000_000.0

#: Attributes that the schema of each document wants in its header.
HEADER = {"creationTime", "instanceId", "version", "sender"}
KEPT = {"bufferSize", "deviceModelChangeTime"}
SEQUENCES = {"firstSequence", "lastSequence", "nextSequence"}
ASSETS = {"assetBufferSize", "assetCount"}
HEADERS = {
    "Devices": HEADER | KEPT | ASSETS, "Streams": HEADER | KEPT | SEQUENCES, "Error": HEADER | {"bufferSize"},
    "Assets": HEADER | ASSETS | {"deviceModelChangeTime"},
}  # fmt: skip


@asynccontextmanager
async def serving(program: TwinProgram, kept: int = 5000) -> AsyncIterator[MTConnectAgent]:
    agent = MTConnectAgent(program, socket.create_server(("127.0.0.1", 0)), lambda: NOW, kept)
    await agent.begin()
    try:
        yield agent
    finally:
        await agent.end()


def with_agent(
    program: TwinProgram, what: Callable[[MTConnectAgent], Awaitable[None]], kept: int = 5000, *, run: bool = False
) -> None:
    """Do something with an agent; ``run``: after the program has run."""

    async def do() -> None:
        async with serving(program, kept) as agent:
            if run:
                await run_whole(agent)
            await what(agent)

    asyncio.run(do())


async def run_whole(agent: MTConnectAgent) -> None:
    """Run the program of an agent to its end."""
    twin = Twin(agent.program, Playback(agent.program.timed, speed=None), 0.5)
    twin.outlets.append(agent)
    running = asyncio.create_task(twin.run())
    while agent.values.get("exec") != "PROGRAM_COMPLETED":
        await asyncio.sleep(0.0)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)


class Document:
    """A document that is well formed, of the kind that its namespace says, with the header that the schema wants."""

    def __init__(self, data: bytes) -> None:
        self.root = ET.fromstring(data)
        named = re.fullmatch(r"\{(urn:mtconnect\.org:MTConnect(\w+):2\.0)\}MTConnect\2", self.root.tag)
        assert named is not None
        for element in self.root.iter():
            assert element.tag.startswith(f"{{{named[1]}}}")
            element.tag = element.tag.rpartition("}")[2]
        self.kind, header = named[2], self.root[0]
        assert set(header.attrib) == HEADERS[self.kind]
        self.sequences = [int(header.get(name, 0)) for name in ("firstSequence", "lastSequence", "nextSequence")]

    def observations(self) -> list[ET.Element]:
        found = [each for group in self.root.iterfind("Streams/DeviceStream/ComponentStream/*") for each in group]
        return sorted(found, key=lambda each: int(each.get("sequence", 0)))

    def values(self, name: str) -> list[str]:
        return [each.text or "" for each in self.observations() if each.get("name") == name]


def asked(agent: MTConnectAgent, target: str) -> Document:
    answer = agent.respond(target)
    assert isinstance(answer, bytes)
    return Document(answer)
