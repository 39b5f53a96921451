"""The builder's server: requests of its own page alone, of bounded size, and garbage that leaves it alive."""

import asyncio
import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.builder.server import builder_application
from trunnion.builder.session import BuilderSession
from trunnion.viewer.serving import Access

HOST = {"Host": "127.0.0.1:8000", "Content-Type": "application/json"}


@pytest.fixture(scope="module")
def application(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return builder_application(BuilderSession(tmp_path_factory.mktemp("builder")), Access(("127.0.0.1", "localhost")))


def ask(
    application: Any, path: str, body: bytes | None, headers: dict[str, str] = HOST, pieces: int = 1, query: bytes = b""
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
        "query_string": query, "headers": [(name.lower().encode(), value.encode()) for name, value in headers.items()],
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
        ({"Content-Type": "Application/JSON; charset=utf-8"}, 200),
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


@settings(max_examples=examples(150), suppress_health_check=[HealthCheck.function_scoped_fixture])
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


#: Values that TOML has and that a field or a table of a definition does not take.
STRANGE = st.sampled_from(
    [
        "inf", "-inf", "nan", "2020-01-01", "07:32:00", "1979-05-27T07:32:00Z", "[{a=1}]", "[1, 2]", '["X"]', "{}",
        "{ a = { b = nan } }", "[]", "[[1], [inf]]", "true", '""', '"""\n"""', "5", "1" * 400,
        "[" * 200 + "]" * 200, '[{name="X"},{name="Y"}]', "[{name=5}]", "[{}, 1]",
    ]
)  # fmt: skip
KEYS = st.sampled_from(
    ["name", "extends", "description", "axis", "spindle", "control", "workpiece", "spindle.max_rpm", "body",
     "spindle.direction", "control.extends", "control.format", "control.settings", "control.settings.title",
     "control.templates", "control.coolant", "control.codes", "control.known", "control.block_numbers",
     "control.block_numbers.step"]
)  # fmt: skip
AXIS_KEYS = st.sampled_from(
    ["name", "kind", "direction", "limits_mm", "limits_deg", "point_mm", "endless", "remove", "x"]
)
BODIES = st.sampled_from(["", "[[axis]]\n", '[[axis]]\nname = "B"\n', '[[axis]]\nname = "X"\n[[axis]]\nname = "Y"\n'])


@st.composite
def strange_texts(draw: st.DrawFn) -> str:
    """A definition that TOML reads, with a value where it is out of place."""
    head = draw(st.sampled_from(['extends = "yl569"\n', 'extends = "dmu65"\nname = "x"\n', ""]))
    tables = draw(BODIES)
    key = draw(AXIS_KEYS if tables and draw(st.booleans()) else KEYS)
    line = f"{key} = {draw(STRANGE)}\n"
    return head + (tables + line if tables else line)


@settings(max_examples=examples(40), suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(strange_texts(), st.data())
def test_a_text_of_any_values_is_judged_and_changed(application: Any, text: str, data: Any) -> None:
    status, answer = ask(application, "/judge", json.dumps({"text": text}).encode())
    assert status == 200, text
    fields = [each for page in json.loads(answer)["pages"].values() for each in page]
    moves: Any = {"move": data.draw(st.sampled_from("XYB")), "by": 1}
    change = moves
    if fields and data.draw(st.booleans()):
        change = {
            "path": data.draw(st.sampled_from(fields))["path"],
            "value": data.draw(st.sampled_from([5, None, "x"])),
        }
    assert ask(application, "/change", json.dumps({"text": text, **change}).encode())[0] == 200, (text, change)


@pytest.mark.parametrize(
    "text",
    [
        "a." * 3000 + "a=1",
        "a = " + "[" * 5000 + "]" * 5000,
        "[" + "a." * 50 + "a]\n",
        f"a = 0x{'f' * 5000}",
        "x" * 300_000,
    ],
)
def test_a_text_that_cannot_be_read_is_changed_by_nobody(application: Any, text: str) -> None:
    for change in ({"path": ["name"], "value": 1}, {"move": "X", "by": 1}):
        status, answer = ask(application, "/change", json.dumps({"text": text, **change}).encode())
        assert status == 200
        assert json.loads(answer)["unclear"] == "broken"
        assert json.loads(answer)["text"] == text


def test_a_path_of_names_alone_is_refused(application: Any) -> None:
    for path in ([["a"], "x"], ["axis", ["a"], ["b"], "x"]):
        body = {"text": "[axis]\na = 1\n", "path": path, "value": 1}
        assert ask(application, "/change", json.dumps(body).encode())[0] == 400


@pytest.mark.parametrize("file", ["missing.toml", "../x.toml", "/etc/passwd", "%2e%2e%2fx.toml"])
def test_a_page_of_no_file_is_not_found(application: Any, file: str) -> None:
    assert ask(application, "/", None, query=f"file={file}".encode())[0] == 404


def test_paths_of_files_are_not_served(application: Any, tmp_path: Path) -> None:
    for path in ("/etc/passwd", "/../pyproject.toml", "/web/main.js", f"{tmp_path}"):
        assert ask(application, path, None)[0] in (404, 405)
