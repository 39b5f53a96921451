"""The page with the path in space: what it draws, and that text from outside cannot become code."""

import base64
import hashlib
import json
import re
from collections.abc import Iterator

import numpy as np
import pytest

from tests.support.page_columns import decode_column
from tests.support.reports import Page
from trunnion.model.toolpath import (
    Arcs,
    CycleOff,
    CycleOn,
    Frame,
    Kind,
    Moves,
    Operation,
    Tool,
)
from trunnion.reporting.path_page import render_path_page
from trunnion.reporting.path_series import PathSeries, collect_paths

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'--><!--&amp;"


def operation(tips: list[tuple[float, float, float]], kinds: list[Kind], **more: object) -> Operation:
    n = len(tips)
    axis = np.tile([0.0, 0.0, 1.0], (n, 1))
    columns = (np.zeros(n, np.uint8), np.full(n, 100.0), np.zeros(n, np.bool_), np.arange(1, n + 1, dtype=np.int32))
    moves = Moves(np.array(tips, np.float64), axis, np.array(kinds, np.uint8), *columns)
    fields = {"arcs": Arcs.empty(), "events": (), **more}
    return Operation(name="OP", tool=Tool(), frame=Frame(), moves=moves, line=1, **fields)  # type: ignore[arg-type]


def test_holes_go_from_their_clearance_to_the_bottom() -> None:
    cycle = CycleOn(1, 2, ("DRILL",), (("RAPTO", (2.0,)), ("FEDTO", (-8.0,))))
    holes = operation(
        [(0, 0, 50), (1, 0, 0), (2, 0, 0)], [Kind.RAPID, Kind.LINEAR, Kind.LINEAR], events=(cycle, CycleOff(3, 9))
    )
    (path,), tolerance = collect_paths([("", holes)])
    assert path.points[:, 2].tolist() == [50, 2, -8, 2, 2, -8, 2]
    assert path.rapid.tolist() == [1, 1, 0, 1, 1, 0, 1]
    assert tolerance == 0.0


def test_arcs_are_drawn_as_arcs() -> None:
    arcs = Arcs(np.array([1]), np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.array([10.0]), np.array([0]))
    (path,), _ = collect_paths([("", operation([(10, 0, 0), (-10, 0, 0)], [Kind.RAPID, Kind.ARC], arcs=arcs))])
    np.testing.assert_allclose(np.hypot(*path.points[:, :2].T), 10.0, atol=1e-5)
    assert path.points[:, 1].max() == pytest.approx(10.0, abs=0.1)
    assert path.rapid.tolist()[1:] == [0] * (len(path.points) - 1)


def test_a_long_path_is_thinned_and_says_by_how_much() -> None:
    along = np.linspace(0.0, 100.0, 4001)
    tips = [(float(x), float(5.0 * np.sin(0.3 * x)), 0.0) for x in along]
    (whole,), none = collect_paths([("", operation(tips, [Kind.LINEAR] * len(tips)))])
    (path,), tolerance = collect_paths([("", operation(tips, [Kind.LINEAR] * len(tips)))], most=200)
    assert (len(whole.points), none) == (4001, 0.0)
    assert len(path.points) <= 200
    off = np.interp(along, path.points[:, 0], path.points[:, 1]) - 5.0 * np.sin(0.3 * along)
    assert 0.0 < np.abs(off).max() <= 1.5 * tolerance < 0.5


def page(name: str) -> Iterator[bytes]:
    points = np.array([[0, 0, 0], [1, 2, 3]], np.float32)
    return render_path_page(name, [PathSeries(name, name, points, np.array([1, 0], np.int32))], 0.0)


def test_rapids_are_told_by_dashes_and_the_page_has_a_layout_for_paper() -> None:
    text = b"".join(page("OP")).decode()
    assert "rapids, dashed</label>" in text
    assert "mod(along, 2.0 * dash) > dash" in text
    assert "@media print" in text


def test_the_page_holds_the_points_and_no_text_becomes_code() -> None:
    hostile, plain = (Page(b"".join(page(name)).decode()) for name in (HOSTILE, "OP"))
    assert hostile.running == plain.running
    assert json.loads(hostile.script("data"))["operations"][0]["name"] == HOSTILE
    assert decode_column(hostile.script("0-z").encode()).view(np.float32).tolist() == [0.0, 3.0]
    assert {tag for tag, _ in hostile.elements} == {tag for tag, _ in plain.elements}
    policy = next(a["content"] for tag, a in plain.elements if tag == "meta" and a.get("http-equiv"))
    for kind, sources in (("script", plain.running), ("style", plain.styles)):
        digest = base64.b64encode(hashlib.sha256(sources[-1].encode()).digest()).decode()
        assert f"{kind}-src 'sha256-{digest}'" in str(policy)
    assert "default-src 'none'" in str(policy)
    for tag, attributes in plain.elements:
        assert tag not in {"link", "img", "iframe"}
        assert not {"src", "href", "style"} & set(attributes)
    assert not any(re.search(r"://|\b(fetch|XMLHttpRequest|WebSocket|eval)\b *\(", code) for code in plain.running)
