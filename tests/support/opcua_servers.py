"""An OPC UA server in the test's own process, whose variables and their times a test sets; and a cable to it."""

import asyncio
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager, suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path

from asyncua import Server, ua

NAMESPACE = "urn:tests:machine"

#: The time of the first values, microseconds since 1970.
BEGIN = 1_780_000_000_000_000

#: A list of nodes for its variables.
NODES = f"""
namespace = "{NAMESPACE}"
[columns]
X = {{ id = "x" }}
C = {{ id = "c" }}
block = {{ id = "block", element = 2 }}
gone = {{ id = "gone", optional = true }}
"""

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def write_nodes(folder: Path) -> Path:
    """The list of nodes as a file."""
    file = folder / "nodes.toml"
    file.write_text(NODES, encoding="utf-8")
    return file


class Machine:
    """Variables of a machine: X, C and three lines of a program."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._index = 0

    async def prepare(self) -> None:
        """Add the variables."""
        self._index = await self._server.register_namespace(NAMESPACE)
        for name, value in (("x", 0.0), ("c", 0.0), ("block", ["", "", ""])):
            await self._server.nodes.objects.add_variable(ua.NodeId(name, self._index), f"{self._index}:{name}", value)
        await self.show(BEGIN, {"x": 0.0, "c": 0.0, "block": ["", "", ""]})

    async def show(self, microseconds: int, values: Mapping[str, object]) -> None:
        """Set variables at a time of the machine."""
        stamp = _EPOCH + timedelta(microseconds=microseconds)
        for name, value in values.items():
            node = self._server.get_node(ua.NodeId(name, self._index))
            await node.write_value(ua.DataValue(ua.Variant(value), SourceTimestamp=stamp, ServerTimestamp=stamp))


@asynccontextmanager
async def serving(port: int = 0) -> AsyncIterator[tuple[Machine, int]]:
    """A machine, and the port on which it is served."""
    server = Server()
    await server.init()
    server.set_endpoint(f"opc.tcp://127.0.0.1:{port}/")
    server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
    machine = Machine(server)
    await machine.prepare()
    await server.start()
    try:
        yield machine, server.bserver.port
    finally:
        await server.stop()


class Cable:
    """A port that leads to another one as long as it is plugged in."""

    def __init__(self, to: int) -> None:
        self._to = to
        self._is_in = True
        self._ends: list[asyncio.StreamWriter] = []
        self.port = 0

    @asynccontextmanager
    async def laid(self) -> AsyncIterator["Cable"]:
        """Take connections until the end of the block."""
        server = await asyncio.start_server(self._connected, "127.0.0.1", 0)
        self.port = server.sockets[0].getsockname()[1]
        try:
            yield self
        finally:
            self.cut()
            server.close()

    def cut(self) -> None:
        """Break all connections, and take no more."""
        self._is_in = False
        for end in self._ends:
            end.transport.abort()
        self._ends.clear()

    def mend(self) -> None:
        """Take connections again."""
        self._is_in = True

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if not self._is_in:
            writer.transport.abort()
            return
        try:
            far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._to)
        except OSError:
            writer.transport.abort()
            return
        self._ends += [writer, far_writer]
        await asyncio.gather(_pass(reader, far_writer), _pass(far_reader, writer))


async def _pass(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
    with suppress(OSError):
        while data := await source.read(65536):
            sink.write(data)
            await sink.drain()
    sink.close()
