"""Serves a twin: OPC UA, and MTConnect beside it, until it is ended."""

import asyncio
from collections.abc import Callable, Coroutine

from trunnion.records import dataclass
from trunnion.twin.mtconnect.adapter import MTConnectAdapter
from trunnion.twin.mtconnect.agent import MTConnectAgent
from trunnion.twin.opcua.outlet import OpcUaOutlet
from trunnion.twin.opcua.server import Security, TwinServer
from trunnion.twin.ports import TwinPort
from trunnion.twin.running import Twin
from trunnion.verification.grounds import NO_GROUNDS, Grounds


@dataclass(frozen=True, slots=True)
class TwinAddresses:
    """Where a twin is served.

    opcua        address of the OPC UA server
    mtconnect    host and port of the MTConnect adapter; empty: there is none
    agent        host and port of the MTConnect agent; empty: there is none
    fingerprint  of the server's certificate (SHA-1, as clients show it); empty: there is none
    grounds      what positions and times stand on besides the program
    """

    opcua: str
    mtconnect: str
    agent: str
    fingerprint: str
    grounds: Grounds = NO_GROUNDS


@dataclass(frozen=True, slots=True)
class Ports:
    """What is taken already; the address of OPC UA is the one by which clients name this computer."""

    opcua: TwinPort
    mtconnect: TwinPort | None
    agent: TwinPort | None = None


async def serve_program(
    twin: Twin,
    ports: Ports,
    *,
    security: Security | None,
    started: bool,
    ready: Callable[[TwinAddresses], None],
) -> None:
    """Serve a program until cancelled.

    twin      the program, its clock and its samples
    ports     where it is served
    security  who may use it; None: anybody on this computer
    started   it runs at once; else a client starts it
    ready     is called when clients can connect
    """
    program = twin.program
    server = TwinServer(program, twin, ports.opcua.socket, ports.opcua.host, security)
    publisher = await server.prepare(twin.playback.speed)
    twin.outlets.append(OpcUaOutlet(program, server, publisher, twin.clock()))
    adapter = MTConnectAdapter(program, ports.mtconnect.socket) if ports.mtconnect is not None else None
    agent = MTConnectAgent(program, ports.agent.socket, twin.clock) if ports.agent is not None else None
    told = [each for each in (adapter, agent) if each is not None]
    twin.outlets.extend(told)
    try:
        for port in filter(None, (ports.opcua, ports.mtconnect, ports.agent)):
            port.open()
        await server.start()
        for each in told:
            await each.begin()
        shdr, documents = adapter.address if adapter else "", agent.address if agent else ""
        ready(TwinAddresses(server.address, shdr, documents, server.fingerprint, program.grounds))
        await twin.run(started=started)
    finally:
        for each in told:
            await each.end()
        await server.stop()


def run_until_ended(serving: Callable[[], Coroutine[None, None, None]]) -> None:
    """Run a server until Ctrl-C, which is how it is meant to end."""
    try:
        asyncio.run(serving())
    except KeyboardInterrupt as end:
        if type(end) is not KeyboardInterrupt:  # another signal
            raise
