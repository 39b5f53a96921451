"""The builder's server: requests of its own page alone, of bounded size, and garbage that leaves it alive."""

import asyncio
import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from trunnion.builder.server import builder_application
from trunnion.builder.session import BuilderSession
from trunnion.viewer.serving import Access

HOST = {"Host": "127.0.0.1:8000", "Content-Type": "application/json"}


@pytest.fixture(scope="module")
def application(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return builder_application(BuilderSession(tmp_path_factory.mktemp("builder")), Access(("127.0.0.1", "localhost")))


def ask(
    application: Any, path: str, body: bytes | None, headers: dict[str, str] = HOST, pieces: int = 1
) -> tuple[int, bytes]:
    """Status and body of what an application answers to a POST; GET without a body."""
    sent: list[dict[str, Any]] = []
    waiting = [body or b""] * pieces

    async def receive() -> dict[str, Any]:
        piece = waiting.pop() if waiting else b""
        return {"type": "http.request", "body": piece, "more_body": bool(waiting)}

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    scope = {
        "type": "http", "method": "GET" if body is None else "POST", "path": path, "raw_path": path.encode(),
        "query_string": b"", "headers": [(name.lower().encode(), value.encode()) for name, value in headers.items()],
        "http_version": "1.1", "scheme": "http", "root_path": "", "client": ("127.0.0.1", 1),
        "server": ("127.0.0.1", 80),
    }  # fmt: skip
    asyncio.run(application(scope, receive, send))
    return sent[0]["status"], b"".join(message.get("body", b"") for message in sent[1:])


def test_it_gives_its_page_and_judges(application: Any) -> None:
    status, page = ask(application, "/", None)
    assert status == 200
    assert b"Content-Security-Policy" in page
    status, answer = ask(application, "/judge", json.dumps({"text": 'extends = "yl569"\nname = "x"\n'}).encode())
    assert status == 200
    assert json.loads(answer)["problems"] == []


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Host": "evil.example"}, 403),
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Content-Type": "text/plain"}, 415),
        ({"Content-Type": "application/x-www-form-urlencoded"}, 415),
        ({"Origin": "http://127.0.0.1:8000"}, 200),
    ],
)
def test_other_pages_can_ask_for_nothing(application: Any, headers: dict[str, str], status: int) -> None:
    assert ask(application, "/judge", b'{"text": ""}', {**HOST, **headers})[0] == status


def test_a_request_that_is_too_large_is_ended(application: Any) -> None:
    assert ask(application, "/judge", b"x" * 1_000_000, pieces=40)[0] == 413


@pytest.mark.parametrize(
    "body", [b"", b"[]", b"{", b"5", b"\xff", b'{"text": 5}', b"[" * 100_000, b'{"text": "\\ud800"}']
)
def test_garbage_is_answered(application: Any, body: bytes) -> None:
    assert ask(application, "/judge", body)[0] in (200, 400)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    what=st.sampled_from(["begin", "judge", "change", "sample", "save", "other"]),
    body=st.fixed_dictionaries(
        {},
        optional={
            key: st.one_of(
                JSON, st.sampled_from(['extends = "yl569"\n', "a.toml", ["axis", ["B"], "limits_deg"], "yl569"])
            )
            for key in (
                "text",
                "path",
                "value",
                "move",
                "by",
                "base",
                "chain",
                "control",
                "name",
                "seen",
                "cl",
                "before",
            )
        },
    ),
)
def test_whatever_is_asked_is_answered(application: Any, what: str, body: dict[str, Any]) -> None:
    assert ask(application, f"/{what}", json.dumps(body).encode())[0] in (200, 400, 404)


def test_paths_of_files_are_not_served(application: Any, tmp_path: Path) -> None:
    for path in ("/etc/passwd", "/../pyproject.toml", "/web/main.js", f"{tmp_path}"):
        assert ask(application, path, None)[0] in (404, 405)
