"""A twin as it is served: judged by an OPC UA client of others, and by clients who mean it harm."""

import asyncio
import json
import os
import random
import shutil
import socket
import struct
import subprocess
import urllib.request
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, ua

from tests.support.locations import TESTS
from tests.support.twins import BLADE_FINISH, ServedTwin, served
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.snapshots import displayed

NODE = shutil.which("node")
JUDGE = TESTS / "twin" / "node"
HAS_CLIENT = (JUDGE / "node_modules" / "node-opcua-client").is_dir()


@pytest.mark.skipif(
    not (NODE and HAS_CLIENT) and not os.environ.get("CI"),
    reason=f"there is no Node.js with node-opcua-client: run npm ci in {JUDGE}",
)
def test_a_client_of_others_is_content(tmp_path: Path) -> None:
    result = tmp_path / "seen.json"
    with served(BLADE_FINISH, "--speed", "50", "--hold") as twin:
        command = [str(NODE), str(JUDGE / "judge.js"), twin.opcua, str(result)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:] + done.stdout[-3000:]
    seen = json.loads(result.read_text(encoding="utf-8"))
    it_finds_the_machine_by_types(seen)
    no_end_of_a_block_is_lost(seen)
    each_line_is_shown_with_the_ones_around_it(seen)
    methods_operate_and_nothing_else_is_writable(seen)


def rows_lost(values: list[float], wanted: list[float]) -> list[int]:
    """Rows whose end does not come, in their order, among values."""
    place, missing = 0, []
    for row, value in enumerate(wanted):
        found = next((k for k in range(place, len(values)) if abs(values[k] - value) <= 1e-9), None)
        if found is None:
            missing.append(row)
        else:
            place = found
    return missing


def it_finds_the_machine_by_types(seen: dict[str, Any]) -> None:
    assert seen["namespaces"][2] == "SinumerikVarProvider"  # where clients of an 840D sl look
    assert {name: axis["rotational"] for name, axis in seen["axes"].items()} == {
        "X": False, "Y": False, "Z": False, "B": True, "C": True
    }  # fmt: skip
    assert seen["machine"] == "Yalong YL569"
    assert seen["tools"] == ["Tool 2"]
    assert seen["job"] == 1
    assert set(seen["sinumerik"].values()) == {"Good"}


def no_end_of_a_block_is_lost(seen: dict[str, Any]) -> None:
    run = twin_program(BLADE_FINISH, machine="yl569").run
    assert seen["lost"] == 0
    for name, axis in seen["axes"].items():
        column = run.machine.column(name)
        wanted = displayed(run.machine, column, run.joints[:, column]).tolist()
        values = [value for _, value in axis["values"]]
        assert rows_lost(values, wanted) == [], name
        assert rows_lost([actual for _, (actual, _) in seen["positions"][name]], wanted) == [], name
        stamps = [stamp for stamp, _ in axis["values"]]
        assert stamps == sorted(set(stamps))
        moved = next(row for row, value in enumerate(wanted) if value != run.start[column])
        assert rows_lost(seen["history"][name], wanted[moved:]) == [], name


def each_line_is_shown_with_the_ones_around_it(seen: dict[str, Any]) -> None:
    lines = [line.strip() for line in BLADE_FINISH.read_text(encoding="utf-8").splitlines()]
    run = twin_program(BLADE_FINISH, machine="yl569").run
    shown = {tuple(texts) for _, texts in seen["blocks"]}
    moving = {int(run.line[row]) for row in range(5, len(run))}
    assert {tuple(lines[line - 2 : line + 1]) for line in moving} <= shown
    ran = seen["ran"]
    assert ran == [told for told in sorted(seen["blocks"])[1:] if told[0] <= ran[-1][0]]
    assert "METHOD" in seen["messages"]
    assert max(speed for _, speed in seen["speeds"]) == 2500.0


def methods_operate_and_nothing_else_is_writable(seen: dict[str, Any]) -> None:
    assert seen["calls"] == {
        "holdBefore": "BadInvalidState", "start": "Good", "again": "BadInvalidState", "hold": "Good", "goOn": "Good",
        "reset": "Good",
    }  # fmt: skip
    assert seen["runningStatus"] in (1, 2)
    assert seen["heldStatus"] == 3
    assert seen["writes"] == {
        "none": "Good", "half": "Good", "actual": 50, "tooMuch": "BadOutOfRange", "text": "BadTypeMismatch",
        "full": "Good", "position": "BadNotWritable", "name": "BadNotWritable",
    }  # fmt: skip
    assert seen["end"] == pytest.approx(seen["duration"])
    assert seen["afterReset"] == 0.0
    assert [status for _, status in seen["status"]][-1] == 0


def address_of(twin: ServedTwin) -> tuple[str, int]:
    host, _, port = twin.opcua.removeprefix("opc.tcp://").partition("/")[0].rpartition(":")
    return host, int(port)


def is_ended_by_server(sent: bytes, place: tuple[str, int]) -> bool:
    """Whether the server ends a connection on which something was sent."""
    with socket.create_connection(place, timeout=120) as connection:
        try:
            connection.sendall(sent)
            while connection.recv(65536):
                pass
        except ConnectionError:
            pass
        except TimeoutError:
            return False
        return True


HELLO = b"HELF" + struct.pack("<IIIIII", 32, 0, 65535, 65535, 0, 0) + struct.pack("<i", -1)


#: What is no OPC UA, or none that makes sense.
NONSENSE = {
    "random": random.Random(5).randbytes(4096),
    "http": b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
    "empty": b"HELF" + struct.pack("<I", 0),
    "huge": b"HELF" + struct.pack("<I", 0xFFFFFFFF) + b"x" * 1000,
    "too large": b"MSGF" + struct.pack("<III", 2**31, 1, 1),
    "no channel": HELLO + b"MSGF" + struct.pack("<II", 40, 7) + b"\xff" * 28,
    "no policy": HELLO + b"OPNF" + struct.pack("<II", 60, 0) + b"\xff" * 48,
    "many": HELLO + b"MSGC" * 40_000,
}


@pytest.mark.nightly
def test_clients_who_mean_harm_do_none(tmp_path: Path) -> None:
    with served(BLADE_FINISH, "--speed", "50", "--hold", "--agent-port", "0", home=tmp_path) as twin:
        with urllib.request.urlopen(f"{twin.agent}/probe") as answer:
            assert b"<Device " in answer.read()
        for name, sent in NONSENSE.items():
            assert is_ended_by_server(sent, address_of(twin)), name
        asyncio.run(flood(twin))
        assert asyncio.run(read_state(twin)) == "ready"
        with socket.create_connection(address_of(twin)) as connection:
            connection.sendall(HELLO)
            twin.process.terminate()
            _, told = twin.process.communicate(timeout=120)
        assert (twin.process.returncode, told) == (128 + 15, "")


async def read_state(twin: ServedTwin) -> str:
    async with Client(twin.opcua, timeout=120, watchdog_intervall=600) as client:
        space = await client.get_namespace_index("urn:trunnion:twin")
        return str(await client.get_node(ua.NodeId("Twin.State", space)).read_value())


async def flood(twin: ServedTwin) -> None:
    """Clients who go without a word, and one who asks for too much."""
    for _ in range(20):
        _, writer = await asyncio.open_connection(*address_of(twin))
        writer.write(HELLO)
        writer.transport.abort()
    async with Client(twin.opcua, timeout=120, watchdog_intervall=600) as client:
        space = await client.get_namespace_index("urn:trunnion:twin")
        node = client.get_node(ua.NodeId("Twin.ProgramTime", space))
        subscription = await client.create_subscription(1.0, Counter())
        created = await subscription.subscribe_data_change([node] * 6000)
        refused = [each for each in created if isinstance(each, ua.StatusCode)]
        assert len(refused) == 1000
        assert {each.name for each in refused} == {"BadTooManyMonitoredItems"}
        with pytest.raises(ua.UaStatusCodeError):
            await node.write_value(1.0)
        with pytest.raises(ua.UaStatusCodeError):
            await client.nodes.objects.add_object(space, "mine")


class Counter:
    """Counts what it is notified of."""

    def __init__(self) -> None:
        self.count = 0

    def datachange_notification(self, *_given: Any) -> None:
        self.count += 1


def test_a_client_reads_how_axes_move_and_which_switches_are_on() -> None:
    async def read(address: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        async with Client(address) as client:
            for name in ("Velocity", "Acceleration", "Jerk", "AtPlus"):
                node = client.get_node(f"ns=3;s=Twin.Axes.X.{name}")
                value = await node.read_data_value(raise_on_bad_status=False)
                found[name] = value.Value.Value if value.StatusCode.is_good() else value.StatusCode.name
            unit = client.get_node("ns=3;s=Twin.Axes.X.Acceleration.EngineeringUnits")
            found["unit"] = (await unit.read_value()).DisplayName.Text
            for name in ("ToolInSpindle", "SpindleTurns"):
                found[name] = await client.get_node(f"ns=3;s=Twin.{name}").read_value()
            for name in ("DoorClosed", "ClampClosed", "Forces.Z"):
                value = await client.get_node(f"ns=3;s=Twin.{name}").read_data_value(raise_on_bad_status=False)
                found[name] = value.StatusCode.name
        return found

    with served(BLADE_FINISH, "--hold") as twin:
        seen = asyncio.run(read(twin.opcua))
    assert seen == {
        "Velocity": 0.0, "Acceleration": 0.0, "Jerk": 0.0, "AtPlus": "BadNotSupported", "unit": "mm/s²",
        "ToolInSpindle": False, "SpindleTurns": False, "DoorClosed": "BadNotSupported",
        "ClampClosed": "BadNotSupported", "Forces.Z": "BadNotSupported",
    }  # fmt: skip
