"""The page: complete in itself, and nothing in it runs that is not ours."""

import hashlib
import json
import re
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import GOLDEN
from tests.support.page_columns import decode_column
from trunnion import InputError, read_program, write_view
from trunnion.jobs.view.viewing import prepare_view
from trunnion.viewer.motion import COUNT
from trunnion.viewer.page import MODULES, render_view

PROGRAM = GOLDEN / "yl569" / "3_blade_finish.expected.mpf"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    file = tmp_path_factory.mktemp("view") / "view.html"
    write_view(PROGRAM, machine="yl569", output=file, tools=["2=ball:10,length=60,flutes=20"])
    return file.read_text(encoding="utf-8")


def test_nothing_is_fetched_and_nothing_foreign_runs(page: str) -> None:
    assert not re.search(r"""(?:src|href)=["']?https?:""", page)
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page)
    assert policy is not None
    assert "unsafe" not in policy[1]
    assert "default-src 'none'" in policy[1]


def test_the_columns_are_those_of_the_run(page: str) -> None:
    run = read_program(PROGRAM, machine="yl569")
    found = {name: decode_column(text.encode()) for name, text in re.findall(r'id="column-([\w-]+)">([^<]*)<', page)}
    np.testing.assert_array_equal(found["line"], run.line)
    last = np.searchsorted(found["row"], np.arange(len(run)), side="right")
    for k, name in enumerate(run.machine.names):
        axis = found[f"axis-{k}"].astype(np.int64) * COUNT
        shift = 60.0 if name == "Z" else 0.0  # slides stand where the tool's own length puts them
        known = run.tcp & ~run.machine_frame
        np.testing.assert_allclose(axis[last][known], run.joints[known, k] + shift, atol=COUNT)


@pytest.mark.parametrize("tools", [[], ["2=ball:10,flutes=20"]])
def test_a_size_that_is_only_drawn_does_not_count(tools: list[str]) -> None:
    run = read_program(PROGRAM, machine="yl569")
    content = prepare_view(PROGRAM, machine="yl569", tools=tools)
    assert {tool["length"] for tool in content.scene["tools"]} == {0.0}
    known = run.tcp & ~run.machine_frame
    last = np.searchsorted(content.columns["row"], np.arange(len(run)), side="right")
    for k in range(5):
        axis = content.columns[f"axis-{k}"].astype(np.int64) * COUNT
        np.testing.assert_allclose(axis[last][known], run.joints[known, k], atol=COUNT)


def test_a_name_from_outside_is_text(tmp_path: Path) -> None:
    program = tmp_path / "a&b<script>alert(1)<!--.mpf"
    program.write_bytes(PROGRAM.read_bytes().replace(b"Engage Move", b"</script><script>alert(2)"))
    page = b"".join(render_view(prepare_view(program, machine="yl569"), embedded=True)).decode()
    assert "<script>alert" not in page
    scene = re.search(r'id="scene">([^<]*)<', page)
    assert scene is not None
    assert json.loads(scene[1])["title"].endswith("a&b<script>alert(1)<!--.mpf")


def test_modules_share_no_name() -> None:
    names: list[str] = []
    for module in MODULES:
        text = (files("trunnion.viewer") / "web" / f"{module}.js").read_text(encoding="utf-8")
        names += re.findall(r"^(?:export )?(?:async )?(?:function|class|const|let) (\w+)", text, re.MULTILINE)
    assert len(names) == len(set(names))


def test_the_library_is_the_one_that_its_note_names() -> None:
    vendor = files("trunnion.viewer") / "web" / "vendor"
    ((name, wanted),) = re.findall(
        r"`([\w.]+)` \| `([0-9a-f]{64})`", (vendor / "README.md").read_text(encoding="utf-8")
    )
    content = (vendor / name).read_bytes()
    assert hashlib.sha256(content).hexdigest() == wanted
    assert b"</script" not in content.lower()


def test_the_page_has_another_name_than_the_program(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"let its name end in \.html"):
        write_view(PROGRAM, machine="yl569", output=tmp_path / "view.mpf")
    program = tmp_path / "program.html"
    program.write_bytes(PROGRAM.read_bytes())
    with pytest.raises(InputError):
        write_view(program, machine="yl569", output=program)
    assert program.read_bytes() == PROGRAM.read_bytes()
