"""The MTConnect adapter, read as an agent reads it: by the documented protocol, with a parser of its own."""

import asyncio
import re
import socket
import xml.etree.ElementTree as ET
from datetime import UTC, datetime, timedelta

import pytest

from tests.support.twins import HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.mtconnect.adapter import HEARTBEAT, MTConnectAdapter
from trunnion.twin.mtconnect.device import device_xml
from trunnion.twin.playback import Playback
from trunnion.twin.running import Twin
from trunnion.twin.snapshots import TwinProgram, displayed

NAMESPACE = "{urn:mtconnect.org:MTConnectDevices:1.6}"


@pytest.fixture(scope="module")
def program() -> TwinProgram:
    return twin_program(HUB_ROUGH, machine="yl569")


class Agent:
    """Keeps what an adapter tells: values by key with their times, conditions, messages; only what is well formed."""

    def __init__(self, program: TwinProgram) -> None:
        items = {item.get("name", ""): item for item in ET.fromstring(device_xml(program)).iter(f"{NAMESPACE}DataItem")}
        self.categories = {name: item.get("category", "") for name, item in items.items()}
        self.types = {name: item.get("type", "") for name, item in items.items()}
        self.values: dict[str, list[tuple[datetime, str]]] = {}
        self.conditions: dict[str, list[list[str]]] = {}
        self.messages: list[str] = []
        self.answers: list[str] = []
        self.last = datetime(1970, 1, 1, tzinfo=UTC)

    def take(self, line: str) -> None:
        """Take a line, as an agent does: a comment, a condition, a message, or keys and values."""
        if line.startswith("* "):
            self.answers.append(line)
            return
        # A field in quotes may hold bars, each after a backslash.
        stamp, *fields = re.split(r"(?<!\\)\|", line)
        fields = [each[1:-1].replace("\\|", "|") if "\\|" in each else each for each in fields]
        time = datetime.strptime(stamp, "%Y-%m-%dT%H:%M:%S.%fZ").replace(tzinfo=UTC)
        assert time >= self.last, "times are in order"
        self.last = time
        first = fields[0]
        if self.categories[first] == "CONDITION":
            assert fields[1] in ("NORMAL", "WARNING", "FAULT", "UNAVAILABLE")
            assert len(fields) == 6
            self.conditions.setdefault(first, []).append(fields[1:])
        elif self.types[first] == "MESSAGE":
            assert len(fields) == 3
            self.messages.append(fields[2])
        else:
            assert len(fields) % 2 == 0
            for key, value in zip(fields[::2], fields[1::2], strict=True):
                assert self.categories[key] in ("SAMPLE", "EVENT")
                self.values.setdefault(key, []).append((time, value))


async def follow(agent: Agent, place: tuple[str, int], until: str) -> None:
    """Connect, ask for the heartbeat, and take lines until one contains a text."""
    reader, writer = await asyncio.open_connection(*place)
    writer.write(b"* PING\r\n")
    while line := (await reader.readline()).decode().rstrip("\n"):
        agent.take(line)
        if until in line:
            break
    writer.close()


async def run_with(program: TwinProgram, agents: list[Agent], again: Agent) -> None:
    listening = socket.create_server(("127.0.0.1", 0))
    place = listening.getsockname()[:2]
    adapter = MTConnectAdapter(program, listening)
    await adapter.begin()
    twin = Twin(program, Playback(program.timed, speed=None), 0.5)
    twin.outlets.append(adapter)
    following = [asyncio.create_task(follow(agent, place, "PROGRAM_COMPLETED")) for agent in agents]
    with socket.create_connection(place) as rude:  # sends what is no question, and no end of it
        rude.sendall(b"x" * 100_000)
        while len(adapter._agents) < len(agents):
            await asyncio.sleep(0.01)
        running = asyncio.create_task(twin.run())
        await asyncio.gather(*following)
        await follow(again, place, "Z_travel|NORMAL")
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
    await adapter.end()


def test_agents_are_told_every_end_of_a_block(program: TwinProgram) -> None:
    agents, again = [Agent(program), Agent(program)], Agent(program)
    asyncio.run(run_with(program, agents, again))
    run = program.run
    for agent in agents:
        assert f"* PONG {HEARTBEAT}" in agent.answers
        for column, axis in enumerate(run.machine.axes):
            told = [float(value) for _, value in agent.values[f"{axis.name}_actual"]]
            place = 0
            for wanted in displayed(run.machine, column, run.joints[:, column]).tolist():
                place = next(k for k in range(place, len(told)) if abs(told[k] - wanted) < 1e-9)
            times = [time for time, _ in agent.values[f"{axis.name}_actual"]]
            assert times == sorted(times)
        assert [value for _, value in agent.values["exec"]][-2:] == ["ACTIVE", "PROGRAM_COMPLETED"]
        assert agent.messages == ["METHOD"]
        assert max(float(value) for _, value in agent.values["S_actual"]) == 2000.0
    # One who connects again is told all values first.
    assert again.values.keys() == {
        key for key, category in again.categories.items() if category != "CONDITION" and key != "message"
    }
    assert again.conditions.keys() == {key for key, category in again.categories.items() if category == "CONDITION"}


def test_what_was_told_of_the_travel_is_a_fault_of_the_axis(program: TwinProgram) -> None:
    async def tell() -> list[str]:
        listening = socket.create_server(("127.0.0.1", 0))
        adapter = MTConnectAdapter(program, listening)
        await adapter.begin()
        await adapter.alarm("travel B", "axis B is | beyond\nits travel", datetime(2026, 1, 2, tzinfo=UTC))
        reader, writer = await asyncio.open_connection(*listening.getsockname()[:2])
        lines: list[str] = []
        while not lines or "B_travel" not in lines[-1]:
            lines.append((await reader.readline()).decode())
        writer.close()
        await adapter.end()
        return lines

    agent = Agent(program)
    for line in asyncio.run(tell()):
        agent.take(line.rstrip("\n"))
    assert agent.conditions["B_travel"] == [["FAULT", "travel B", "", "", "axis B is | beyond its travel"]]


def test_the_device_model_is_whole(program: TwinProgram) -> None:
    root = ET.fromstring(device_xml(program))
    assert root.tag == f"{NAMESPACE}MTConnectDevices"
    assert [child.tag.removeprefix(NAMESPACE) for child in root] == ["Header", "Devices"]
    identifiers = [each.get("id") for each in root.iter() if each.get("id")]
    assert len(identifiers) == len(set(identifiers))
    items = list(root.iter(f"{NAMESPACE}DataItem"))
    names = [item.get("name") for item in items]
    assert len(names) == len(set(names))
    assert "AVAILABILITY" in {item.get("type") for item in items}
    for item in items:
        if item.get("category") == "SAMPLE":
            assert item.get("units")
    linear = {each.get("name") for each in root.iter(f"{NAMESPACE}Linear")}
    rotary = {each.get("name") for each in root.iter(f"{NAMESPACE}Rotary")}
    assert (linear, rotary) == ({"X", "Y", "Z"}, {"B", "C", "S"})


def test_stamps_are_those_of_the_wall(program: TwinProgram) -> None:
    agent, begun = Agent(program), datetime.now(UTC)
    asyncio.run(run_with(program, [agent], Agent(program)))
    for values in agent.values.values():
        assert all(begun - timedelta(hours=1) < time < begun + timedelta(hours=1) for time, _ in values)


def test_times_are_in_order_when_the_program_is_held_and_goes_on(program: TwinProgram) -> None:
    """Held while axes move, slowed down, and reset, by a wall clock that an agent looks at as well."""
    lines: list[str] = []

    async def operate(speed: float | None) -> None:
        with socket.create_server(("127.0.0.1", 0)) as listening:
            adapter = MTConnectAdapter(program, listening)
            adapter._send = lines.append  # type: ignore[method-assign, assignment]
            twin = Twin(program, Playback(program.timed, speed=speed, loop=True), 0.005)
            twin.outlets.append(adapter)
            running = asyncio.create_task(twin.run())
            for k in range(12):
                await asyncio.sleep(0.02)
                if await twin.hold():
                    await asyncio.sleep(0.01 * (k % 2))
                    await twin.start()
                await twin.set_override(100.0 - k)
            await twin.hold()
            await twin.reset()
            running.cancel()
            await asyncio.gather(running, return_exceptions=True)

    for speed in (1.0, 50.0, None):
        lines.clear()
        asyncio.run(operate(speed))
        agent = Agent(program)
        for line in lines:
            agent.take(line.rstrip("\n"))  # asserts that no time is before the last one
        states = [value for _, value in agent.values["exec"]]
        assert states.count("FEED_HOLD") >= 10
        assert states.count("ACTIVE") >= 10
