"""What a view has of a simulation: its findings in their rows, its warnings, and a picture that is not too fine."""

import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trunnion
from tests.support.simulating import HEAD, STOCK, TOOL, cuboid
from tests.support.stepped_slot import write_slot
from trunnion import InputError
from trunnion.jobs.view.viewing import prepare_view
from trunnion.simulation.meshes import save_mesh
from trunnion.viewer.content import ViewContent

#: A slot on whose way one clamp stands and another one beside it, 3 mm from the tool; and a word of no control.
PROGRAM = HEAD + "N50 G0 Z-5\nN60 G1 X70 F500\nN70 G0 Z20\nN80 G1 Q1\nN90 G0 X80\nM5\nM30\n"


def test_the_findings_are_those_of_the_simulation(tmp_path: Path) -> None:
    program, clamps = tmp_path / "part.ngc", [tmp_path / "hit.stl", tmp_path / "near.stl"]
    program.write_text(PROGRAM, encoding="utf-8")
    save_mesh(cuboid((60.0, -3.0, -8.0), (64.0, 3.0, -2.0)), clamps[0])
    save_mesh(cuboid((52.0, 8.0, -8.0), (55.0, 10.0, -2.0)), clamps[1])
    given: dict[str, Any] = {"machine": "xyzac_trt", "stock": STOCK, "fixtures": clamps, "tools": [TOOL]}
    given |= {"cell": 1.0, "near": 6.0}
    found = trunnion.simulate(program, **given)
    content = prepare_view(program, **given)
    marks = [mark for mark in content.said()["findings"] if mark.get("place")]
    assert "collision" in {mark["kind"] for mark in marks}
    assert "near" in {mark["kind"] for mark in marks}
    wanted = [(one.line, list(one.place)) for one in found.findings]
    wanted = sorted(wanted + [(one.line, list(one.place)) for one in found.near])
    assert sorted((mark["line"], mark["place"]) for mark in marks) == wanted
    lines = content.columns["line"]
    assert all(lines[mark["row"]] == mark["line"] for mark in marks)
    assert any(mark["kind"] == "simulation" and "part.ngc" in mark["text"] for mark in content.said()["findings"])
    keys = {check["key"]: check["state"] == "ok" for check in content.said()["checks"]}
    assert keys["collision"] is False
    assert content.scene["stock"]["rows"] < len(lines)  # the program has an error, and is cut up to there
    assert any("not checked" in remark for remark in content.said()["stock"]["remarks"])


def test_a_picture_is_coarser_than_the_finest_simulation(tmp_path: Path) -> None:
    program, given = write_slot(tmp_path)
    content = prepare_view(program, **{**given, "cell": 0.1})
    stock = content.scene["stock"]
    assert stock["simulated"] == 0.1
    assert 0.1 < max(stock["cell"]) < 0.2
    off = content.columns["stock-deviation"] * stock["deviation"]["unit"]
    assert (off.min(), off.max()) == pytest.approx((-1.0, 1.0), abs=0.01)
    assert np.count_nonzero(np.abs(off) > 0.99) > 1000


def test_a_stock_that_no_picture_can_show_is_refused(tmp_path: Path) -> None:
    program, given = write_slot(tmp_path)
    given |= {"stock": "box:900,900,500,0,-450,-500", "tools": ["1=flat:4,length=600,flutes=550"], "cell": 2.0}
    with pytest.raises(InputError, match="too large to be shown as it is cut with a tool of 4 mm"):
        prepare_view(program, **{**given, "part": None})


def test_a_page_holds_as_many_states_as_find_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program, given = write_slot(tmp_path)
    content = prepare_view(program, **{**given, "cell": 1.0})
    assert content.stock is not None
    whole = page_states(content)
    assert whole[0] == (0, -1)
    assert [rows for rows, _ in whole] == content.stock.page_states
    monkeypatch.setattr("trunnion.viewer.stock._PAGE_BYTES", len(content.stock.packed()) - 1)
    told: list[int] = []
    content = prepare_view(program, **{**given, "cell": 1.0})
    assert content.stock is not None
    content.stock.packed(told.append)
    fewer = page_states(content)
    assert len(told) == len(whole)
    assert 2 <= len(fewer) < len(whole)
    assert (fewer[0], fewer[-1][0]) == (whole[0], whole[-1][0])
    for states in (whole, fewer):
        assert [before for _, before in states[1:]] == [rows for rows, _ in states[:-1]]


def page_states(content: ViewContent) -> list[tuple[int, int]]:
    """Rows of the states that a page holds, and of those that they change."""
    assert content.stock is not None
    data, found = zlib.decompress(content.stock.packed()), []
    while data:
        length = int.from_bytes(data[:4], "little")
        rows, before = np.frombuffer(data, "<i4", 2, 4).tolist()
        found.append((rows, before))
        data = data[4 + length :]
    return found


def test_more_findings_than_are_shown_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.jobs.view.stock._MOST", 2)
    program, given = write_slot(tmp_path)
    plunges = "".join(f"G0 Y{12 * (-1) ** k} Z20\nG0 Z-{4 + k}\nG0 Z20\n" for k in range(3))
    program.write_text(program.read_text().replace("N95 G0 X80\n", f"G0 X25\n{plunges}"), encoding="utf-8")
    content = prepare_view(program, **{**given, "part": None, "cell": 1.0})
    shown = [mark for mark in content.said()["findings"] if mark["kind"] == "rapid through stock"]
    assert len(shown) == 2
    assert any(
        re.fullmatch(r"rapid through stock: 2 of \d are shown", one) for one in content.said()["stock"]["remarks"]
    )
