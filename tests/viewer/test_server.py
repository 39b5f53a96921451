"""The server: its page, columns and texts, for this computer only, whatever is asked."""

import asyncio
import socket
import threading
import time
import urllib.error
import urllib.request
import zipfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest
import uvicorn
from hypothesis import given
from hypothesis import strategies as st

from tests.support.locations import GOLDEN
from tests.support.stepped_slot import write_slot
from trunnion import InputError
from trunnion.jobs.view.viewing import prepare_view
from trunnion.simulation.replay import Replay
from trunnion.viewer.content import ViewContent
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import Access, impatient_protocol, take_port

PROGRAM = GOLDEN / "yl569" / "3_blade_finish.expected.mpf"

NAMES = ("127.0.0.1", "localhost")


@pytest.fixture(scope="module")
def content() -> ViewContent:
    return prepare_view(PROGRAM, machine="yl569")


def ask(application: Any, path: str, headers: dict[str, str], method: str = "GET") -> tuple[int, bytes, dict[str, str]]:
    """Status, body and headers of what an application answers."""
    sent: list[dict[str, Any]] = []

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": b"", "more_body": False}

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    where, _, query = path.partition("?")
    scope = {
        "type": "http", "method": method, "path": where, "raw_path": where.encode(), "query_string": query.encode(),
        "headers": [(name.lower().encode(), value.encode("latin-1")) for name, value in headers.items()],
        "http_version": "1.1", "scheme": "http", "root_path": "", "client": ("127.0.0.1", 1),
        "server": ("127.0.0.1", 80),
    }  # fmt: skip
    asyncio.run(application(scope, receive, send))
    status = sent[0]["status"]
    body = b"".join(message.get("body", b"") for message in sent[1:])
    return status, body, {name.decode(): value.decode() for name, value in sent[0]["headers"]}


def test_it_gives_the_page_its_columns_and_its_texts(content: ViewContent) -> None:
    application = view_application(content, Access(NAMES))
    status, page, _ = ask(application, "/", {"Host": "127.0.0.1:8000"})
    assert status == 200
    assert b'data-embedded="false"' in page
    for name, column in content.columns.items():
        status, body, _ = ask(application, f"/data/column/{name}", {"Host": "localhost:8000"})
        assert (status, body) == (200, column.tobytes())
    assert ask(application, "/data/text/0", {"Host": "localhost"})[1] == PROGRAM.read_bytes()


def test_it_gives_single_lines_of_cl_files(tmp_path: Path) -> None:
    cl = tmp_path / "archive.zip"
    with zipfile.ZipFile(cl, "w") as archive:
        archive.write(PROGRAM.with_name("3_blade_finish.cls"), "blade.cls")
    application = view_application(prepare_view(PROGRAM, machine="yl569", cl=cl), Access(NAMES))
    lines = PROGRAM.with_name("3_blade_finish.cls").read_bytes().splitlines(keepends=True)
    for number in (1, 40, len(lines)):
        assert ask(application, f"/data/text/1/{number}", {"Host": "localhost"})[:2] == (200, lines[number - 1])
    for beyond in (0, len(lines) + 2, 10**9):
        assert ask(application, f"/data/text/1/{beyond}", {"Host": "localhost"})[0] == 404
    assert ask(application, "/data/text/2/1", {"Host": "localhost"})[0] == 404


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "evil.example"}, {"Host": "127.0.0.1.evil.example:80"}, {},
        {"Host": "127.0.0.1:80", "Origin": "http://evil.example"}, {"Host": "127.0.0.1:80", "Origin": "null"},
        {"Host": "localhost@evil.example"}, {"Host": "localhost:evil.example"},
        {"Host": "127.0.0.1:80", "Origin": "http://127.0.0.1:81"}, {"Host": "127.0.0.1:80", "Origin": "https://127.0.0.1:80"},
        {"Host": "127.0.0.1:80", "Origin": "http://localhost:80"},
    ],
)  # fmt: skip
def test_another_host_or_origin_gets_nothing(content: ViewContent, headers: dict[str, str]) -> None:
    application = view_application(content, Access(NAMES))
    for path in ("/", "/data/column/line", "/data/text/0"):
        assert ask(application, path, headers)[0] == 403


def test_off_this_computer_a_token_is_asked_for(content: ViewContent) -> None:
    application = view_application(content, Access(NAMES, "secret", 80))
    host = {"Host": "shop-pc:80"}  # by whatever name: 0.0.0.0 stands for all addresses of this computer
    for path in ("/", "/?token=", "/?token=Secret", "/data/text/0", "/?token=%FF"):
        assert ask(application, path, host)[0] == 403
    status, _, headers = ask(application, "/?token=secret", host)
    assert status == 200
    cookie = headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    known = {**host, "Cookie": cookie.partition(";")[0]}
    assert ask(application, "/data/text/0", known)[0] == 200
    assert ask(application, "/data/text/0", {**known, "Origin": "http://evil.example"})[0] == 403


def test_servers_on_two_ports_do_not_take_each_others_cookies(content: ViewContent) -> None:
    cookies = []
    for port in (80, 81):
        _, _, headers = ask(
            view_application(content, Access(NAMES, f"secret-{port}", port)), f"/?token=secret-{port}", {"Host": "pc"}
        )
        cookies.append(headers["set-cookie"].partition(";")[0])
    both = {"Host": "pc", "Cookie": "; ".join(cookies)}
    for port in (80, 81):
        application = view_application(content, Access(NAMES, f"secret-{port}", port))
        assert ask(application, "/data/text/0", both)[0] == 200


@pytest.mark.parametrize(("path", "method"), [("/", "GET"), ("/nothing", "GET"), ("/data/text/0", "DELETE")])
def test_no_answer_can_be_framed_or_guessed_at(content: ViewContent, path: str, method: str) -> None:
    _, _, headers = ask(view_application(content, Access(NAMES)), path, {"Host": "LocalHost:1"}, method)
    assert headers["x-frame-options"] == "DENY"
    assert headers["content-security-policy"] == "frame-ancestors 'none'"
    assert headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    "path",
    [
        "/data/text/1", "/data/text/-1", "/data/text/x", "/data/text/99999999999999999999",
        "/data/column/../../etc/passwd",
        "/data/column/%2e%2e%2fpage.py", "/etc/passwd", "//etc/passwd", "/data/column/", "/web/main.js", "/data",
    ],
)  # fmt: skip
def test_there_is_nothing_else(content: ViewContent, path: str) -> None:
    assert ask(view_application(content, Access(NAMES)), path, {"Host": "localhost"})[0] == 404


@given(path=st.text(max_size=40), method=st.sampled_from(["GET", "HEAD", "POST", "PUT", "DELETE", "BREW"]))
def test_whatever_is_asked_is_answered(content: ViewContent, path: str, method: str) -> None:
    status = ask(view_application(content, Access(NAMES)), "/" + path, {"Host": "localhost"}, method)[0]
    assert status in (200, 404, 405)


@pytest.fixture(scope="module")
def cut(tmp_path_factory: pytest.TempPathFactory) -> ViewContent:
    program, given = write_slot(tmp_path_factory.mktemp("slot"))
    return prepare_view(program, **{**given, "part": None, "cell": 1.0})


def test_it_gives_the_stock_after_rows_as_what_changes(cut: ViewContent) -> None:
    application, host = view_application(cut, Access(NAMES)), {"Host": "localhost"}
    assert cut.stock is not None
    status, whole, _ = ask(application, "/data/stock/2", host)
    assert (status, np.frombuffer(whole, "<i4", 2).tolist()) == (200, [2, -1])
    status, changed, _ = ask(application, "/data/stock/4?before=2", host)
    assert (status, np.frombuffer(changed, "<i4", 2).tolist()) == (200, [4, 2])
    assert 0 < len(changed) < len(whole)
    status, again, _ = ask(application, "/data/stock/4?before=4", host)
    assert (status, len(again)) == (200, 12)


@pytest.mark.parametrize(
    "path",
    [
        "/data/stock/99999", "/data/stock/-1", "/data/stock/x", "/data/stock/", "/data/stock/1/2",
        "/data/stock/" + "9" * 400,
    ],
)  # fmt: skip
def test_there_is_no_other_stock(cut: ViewContent, content: ViewContent, path: str) -> None:
    assert ask(view_application(cut, Access(NAMES)), path, {"Host": "localhost"})[0] == 404
    assert ask(view_application(content, Access(NAMES)), "/data/stock/1", {"Host": "localhost"})[0] == 404
    assert ask(view_application(cut, Access(NAMES)), "/data/stock/1", {"Host": "evil.example"})[0] == 403


@given(rows=st.text("0123456789-+e.x%/ ", max_size=12), before=st.text(max_size=12))
def test_whatever_is_asked_of_the_stock_is_answered(cut: ViewContent, rows: str, before: str) -> None:
    path = f"/data/stock/{rows}?before={quote(before)}"
    status, body, _ = ask(view_application(cut, Access(NAMES)), path, {"Host": "localhost"})
    assert status in (200, 404)
    assert status == 404 or len(body) >= 12


def test_a_question_ends_when_a_later_one_comes(cut: ViewContent, monkeypatch: pytest.MonkeyPatch) -> None:
    assert cut.stock is not None
    stock = cut.stock
    cutting, later = threading.Event(), threading.Event()
    go_to = Replay.go_to

    def wait(replay: Replay, rows: int, go_on: Callable[[], bool] = lambda: True) -> bool:
        """The first question is still being answered when the second one comes."""
        if not cutting.is_set():
            cutting.set()
            later.wait(120)
            while go_on():
                time.sleep(0.001)
        return go_to(replay, rows, go_on)

    monkeypatch.setattr(Replay, "go_to", wait)
    with ThreadPoolExecutor(2) as threads:
        first = threads.submit(stock.answer, 4, -1)
        assert cutting.wait(120)
        second = threads.submit(stock.answer, 5, -1)
        later.set()
        assert first.result(120) is None
        assert second.result(120) is not None
        cutting.clear()
        last = threads.submit(stock.answer, 4, -1)
        assert cutting.wait(120)
        end_of(view_application(cut, Access(NAMES)))
        assert last.result(120) is None


def end_of(application: Any) -> None:
    """Start and end an application, as its server does."""
    told = iter(("lifespan.startup", "lifespan.shutdown"))

    async def receive() -> dict[str, Any]:
        return {"type": next(told)}

    async def send(_message: dict[str, Any]) -> None:
        pass

    asyncio.run(application({"type": "lifespan"}, receive, send))


def test_many_questions_at_once_leave_it_alive(cut: ViewContent) -> None:
    assert cut.stock is not None
    stock, rows = cut.stock, cut.stock.rows
    with ThreadPoolExecutor(8) as threads:
        found = list(threads.map(lambda k: stock.answer(k % (rows + 1), k % 3), range(40)))
    assert all(each is None or len(each) >= 12 for each in found)
    assert stock.answer(rows, -1) is not None


@pytest.fixture(scope="module")
def port(content: ViewContent) -> Iterator[int]:
    listening = take_port("127.0.0.1", 0)
    server = uvicorn.Server(uvicorn.Config(view_application(content, Access(NAMES)), log_level="critical"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield listening.getsockname()[1]
    server.should_exit = True
    thread.join()
    listening.close()


@pytest.mark.parametrize(
    "garbage",
    [
        b"", b"\x00\xff\x16\x03\x01", b"GET", b"GET / HTTP/9.9\r\n\r\n", b"GET / HTTP/1.1\r\nX: " + b"a" * 200_000,
        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\nx", b"A" * 1_000_000,
        b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 5_000 + b"\r\n",
    ],
)  # fmt: skip
def test_garbage_leaves_the_server_alive(port: int, garbage: bytes) -> None:
    with socket.create_connection(("127.0.0.1", port), timeout=120) as connection:
        try:
            connection.sendall(garbage)
            connection.shutdown(socket.SHUT_WR)
            connection.recv(100)
        except OSError:
            pass  # it may hang up
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/data/text/0", timeout=120) as answer:
        assert answer.read() == PROGRAM.read_bytes()


def test_a_port_that_is_taken_is_told(port: int) -> None:
    with pytest.raises(InputError, match="the port is taken; choose another port"):
        take_port("127.0.0.1", port)
    with pytest.raises(InputError, match="choose a port from 1 to 65535"):
        take_port("127.0.0.1", 70_000)
    with take_port("127.0.0.1", 0) as taken, pytest.raises(ConnectionRefusedError):  # nobody answers yet
        socket.create_connection(taken.getsockname(), timeout=120)


async def takes_a_body(_scope: Any, receive: Any, send: Any) -> None:
    """Take the whole body of a request before it is answered, as the builder does."""
    while (await receive()).get("more_body"):
        pass
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"0")]})
    await send({"type": "http.response.body"})


@pytest.mark.parametrize(
    "half", [b"", b"GET / HTTP/1.1\r\nHost: local", b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n{"]
)
def test_a_request_that_stays_half_open_is_ended(half: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.viewer.serving._PATIENCE", 0.2)
    monkeypatch.setattr("trunnion.viewer.serving._PATIENCE_WITH_BODY", 0.3)
    listening = take_port("127.0.0.1", 0)
    config = uvicorn.Config(takes_a_body, http=impatient_protocol(), log_level="critical", lifespan="off")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    port = listening.getsockname()[1]
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=120) as connection:
            connection.sendall(half)
            with suppress(ConnectionResetError):
                assert connection.recv(1) == b""
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/", data=b"x" * 500_000, timeout=120) as answer:
            assert answer.status == 200
    finally:
        server.should_exit = True
        thread.join()
        listening.close()
