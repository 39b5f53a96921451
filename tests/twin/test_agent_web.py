"""The MTConnect agent by HTTP: readers beside each other, documents in parts, and clients who mean it harm."""

import asyncio
from collections.abc import AsyncIterator
from datetime import UTC, datetime

import pytest

from tests.support.agents import NOW, Document, run_whole, with_agent
from tests.support.twins import HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.mtconnect import web
from trunnion.twin.mtconnect.agent import MTConnectAgent
from trunnion.twin.snapshots import TwinProgram


@pytest.fixture(scope="module")
def program() -> TwinProgram:
    return twin_program(HUB_ROUGH, machine="yl569")


async def got(agent: MTConnectAgent, request: bytes) -> tuple[int, bytes]:
    """Return the status and the body of an answer; 0: there is none."""
    reader, writer = await asyncio.open_connection(*agent.address.split(":"))
    writer.write(request)
    try:
        answer = await reader.read()
    except ConnectionError:
        answer = b""
    writer.close()
    head, _, body = answer.partition(b"\r\n\r\n")
    return int(head.split()[1]) if head else 0, body


def get(target: str, *fields: str) -> bytes:
    return "\r\n".join([f"GET {target} HTTP/1.1", *(fields or ("Host: localhost:5000",)), "", ""]).encode()


def test_requests_of_http_are_answered_or_refused(program: TwinProgram) -> None:
    wanted = {
        get("/probe"): (200, "Devices"),
        get("/probe", "Accept: text/html, application/xml;q=0.9", "Host: [::1]:5000"): (200, "Devices"),
        get("/nothing"): (404, "Error"),
        get("/probe", "Host: evil.example"): (403, "Error"),
        get("/probe", "Host: localhost.evil.example"): (403, "Error"),
        get("/probe", "Accept: application/json", "Host: localhost"): (406, "Error"),
        get("/probe", "Host: localhost", "Origin: http://localhost"): (200, "Devices"),
        get("/probe", "Host: localhost", "Origin: http://evil.example"): (403, "Error"),
        get("/probe", "Host: localhost", "Origin: null"): (403, "Error"),
        get("/probe", "Accept: */*"): (403, "Error"),
        get("/probe", "Accept: */*").replace(b"1.1", b"1.0"): (200, "Devices"),
        get("/probe", "Host: evil.example", "Host: localhost"): (400, "Error"),
        get("/probe", "Host : localhost"): (400, "Error"),
        get("/probe", "X: a", " Host: localhost"): (400, "Error"),
        get("/probe").replace(b"GET", b"POST"): (405, "Error"),
        get("/probe").replace(b"GET", b"PUT"): (405, "Error"),
        b"garbage\r\n\r\n": (400, "Error"),
        b"\xff\xfe\r\n\r\n": (400, "Error"),
        get("/%ff%00<>"): (404, "Error"),
    }

    async def judge(agent: MTConnectAgent) -> None:
        for request, (status, kind) in wanted.items():
            told, body = await got(agent, request)
            assert (told, Document(body).kind) == (status, kind), request
        assert await got(agent, get("/probe").replace(b"GET", b"HEAD")) == (200, b"")
        assert (await got(agent, b"x" * 100_000))[0] in (0, 431)  # it may be gone before the answer is read

    with_agent(program, judge)


def test_half_a_request_ends_its_connection(program: TwinProgram, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(web, "_PATIENCE", 0.05)

    async def judge(agent: MTConnectAgent) -> None:
        for begun in (b"", b"GET /pro", b"GET /probe HTTP/1.1\r\nHost: localhost\r\n"):
            assert await got(agent, begun) == (0, b"")
        assert (await got(agent, get("/probe")))[0] == 200

    with_agent(program, judge)


def test_half_open_connections_do_not_add_up(program: TwinProgram, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(web, "_MOST_CONNECTIONS", 3)

    async def judge(agent: MTConnectAgent) -> None:
        waiting = [await asyncio.open_connection(*agent.address.split(":")) for _ in range(3)]
        while len(agent._web._tasks) < 3:
            await asyncio.sleep(0.0)
        assert await got(agent, get("/probe")) == (0, b"")
        for _, writer in waiting:
            writer.close()
        while agent._web._tasks:
            await asyncio.sleep(0.0)
        assert (await got(agent, get("/probe")))[0] == 200

    with_agent(program, judge)


async def parts(reader: asyncio.StreamReader) -> AsyncIterator[Document]:
    """Yield the documents of an answer in parts, until it ends."""
    head = await reader.readuntil(b"\r\n\r\n")
    assert b"multipart/x-mixed-replace;boundary=" in head
    assert b"Content-Length" not in head
    boundary = head.partition(b"boundary=")[2].partition(b"\r\n")[0]
    while size := int(await reader.readuntil(b"\r\n"), 16):
        chunk = (await reader.readexactly(size + 2))[:-2]
        if chunk == b"--" + boundary + b"--\r\n":
            continue
        of_part, _, body = chunk.partition(b"\r\n\r\n")
        assert of_part.startswith(b"--" + boundary + b"\r\nContent-type: text/xml\r\nContent-length: ")
        length = int(of_part.rpartition(b" ")[2])
        assert body[length:] == b"\r\n"
        yield Document(body[:length])


async def followed(agent: MTConnectAgent, count: int) -> list[int]:
    """Return the numbers that a reader in parts is told until the program has ended."""
    reader, writer = await asyncio.open_connection(*agent.address.split(":"))
    writer.write(get(f"/sample?interval=0&count={count}"))
    numbers: list[int] = []
    async for document in parts(reader):
        numbers += [int(each.get("sequence", 0)) for each in document.observations()]
        assert document.sequences[2] == numbers[-1] + 1
        if "PROGRAM_COMPLETED" in document.values("exec"):
            break
    writer.close()
    return numbers


async def polled(agent: MTConnectAgent) -> list[int]:
    """Return the numbers that a reader is told who asks again and again, from the next number on."""
    numbers: list[int] = []
    place = 1
    while True:
        status, body = await got(agent, get(f"/sample?from={place}&count=50"))
        assert status == 200
        document = Document(body)
        numbers += [int(each.get("sequence", 0)) for each in document.observations()]
        place = document.sequences[2]
        if "PROGRAM_COMPLETED" in document.values("exec"):
            return numbers


def test_readers_beside_each_other_lose_nothing(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        readers = [followed(agent, 7), followed(agent, 5000), polled(agent), polled(agent)]
        *found, _ = await asyncio.gather(*readers, run_whole(agent))
        for numbers in found:
            assert isinstance(numbers, list)
            assert numbers == list(range(1, len(numbers) + 1))
            assert len(numbers) >= agent.buffer.last - 10

    with_agent(program, judge)


def test_a_reader_in_parts_is_waited_for_and_told_when_it_has_lost_something(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        answer = agent.respond("/sample?interval=0&count=1")
        assert not isinstance(answer, bytes)
        first = Document(await anext(answer))
        assert len(first.observations()) == 1
        assert agent.lagging() == {}
        for _ in range(50):
            agent.tell(datetime.fromtimestamp(NOW, UTC), {"line": "1"})
        assert list(agent.lagging().values()) == [2]
        for _ in range(100):
            agent.tell(datetime.fromtimestamp(NOW, UTC), {"line": "1"})
        (error,) = Document(await anext(answer)).root.iterfind("Errors/Error")
        assert error.get("errorCode") == "OUT_OF_RANGE"
        assert [part async for part in answer] == []
        assert agent.lagging() == {}

    with_agent(program, judge, 100)


def test_without_news_an_empty_document_comes(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        answer = agent.respond(f"/sample?from={agent.buffer.next}&interval=0&heartbeat=1")
        assert not isinstance(answer, bytes)
        assert Document(await anext(answer)).root.find("Streams") is not None
        assert Document(await anext(answer)).observations() == []
        now = agent.respond("/current?interval=1")
        assert not isinstance(now, bytes)
        assert len(Document(await anext(now)).observations()) == len(Document(await anext(now)).observations()) > 20
        assert agent.lagging() == {}

    with_agent(program, judge)


def test_a_reader_who_goes_is_forgotten(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        reader, writer = await asyncio.open_connection(*agent.address.split(":"))
        writer.write(get("/sample?interval=0&heartbeat=2000000000"))
        await reader.readuntil(b"</MTConnectStreams>")
        assert len(agent.streams) == 1
        writer.close()
        while agent.streams or agent._web._tasks:
            await asyncio.sleep(0.0)

    with_agent(program, judge)
