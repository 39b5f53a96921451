"""``trunnion info``: what CL files hold, as text, data and a page."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.cl_dialects import WRITERS, Step
from tests.support.locations import SHARED, YL569
from trunnion.cli import main

PATH = [
    Step("TOOL", (5.0, 10.0, 1.0)),
    Step("SPINDLE", (900.0,), "CLW"),
    Step("RAPID", point=(10.0, 0.0, 50.0)),
    Step("FEED", (300.0,)),
    Step("GOTO", point=(10.0, 0.0, 5.0)),
    Step("ARC", point=(0.0, 10.0, 5.0), centre=(0.0, 0.0, 5.0), start=(10.0, 0.0, 5.0)),
    Step("RAPID", point=(1.0, 2.0, 50.0)),
    Step("CYCLE", (5.0, 2.0, 90.0, 1.0), "DRILL", holes=((1.0, 2.0, 3.0), (4.0, 5.0, 3.0))),
    Step("RAPID", point=(4.0, 5.0, 50.0)),
    Step("TOOL", (6.0, 8.0, 0.0)),
    Step("SPINDLE", (1200.0,), "CLW"),
    Step("RAPID", point=(30.0, 0.0, 60.0), axis=(0.6, 0.0, 0.8)),
    Step("FEED", (250.0,)),
    Step("GOTO", point=(20.0, 0.0, 10.0), axis=(0.6, 0.0, 0.8)),
    Step("RAPID", point=(30.0, 8.0, 60.0), axis=(0.6, 0.0, 0.8)),
    Step("TOOL", (7.0, 6.0, 3.0)),
    Step("RAPID", point=(0.0, 0.0, 50.0)),
    Step("GOTO", point=(0.0, 0.0, 10.0)),
    Step("GOTO", point=(1.0, 0.0, 10.0), axis=(0.6, 0.0, 0.8)),
]

CLSF = """UNITS/MM
TOOL PATH/FACE,TOOL,MILL
TLDATA/MILL,20.0,0.8,75.0,0.0,0.0
MSYS/0,0,100,0,1,0,-1,0,0
LOAD/TOOL,3,ADJUST,4
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50
FEDRAT/MMPM,600
GOTO/0,0,0
FEDRAT/MMPR,0.1
GOTO/100,0,0
DELAY/2
SHOPEV/17
SHOPEV/18
END-OF-PATH
TOOL PATH/SIDE,TOOL,MILL
TLDATA/MILL,20.0,0.8,75.0,0.0,0.0
MSYS/0,0,100,0,0,1,-1,0,0
GOTO/1,2,3
CYCLE/DRILL,RAPTO,2,FEDTO,-8,MMPM,60,DWELL,1.5
GOTO/5,0,0
GOTO/6,0,0
CYCLE/OFF
END-OF-PATH
"""


def data_of(files: list[Path], capsys: pytest.CaptureFixture[str], *options: str) -> dict[str, Any]:
    assert main(["info", *map(str, files), "--json", *options]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


@pytest.mark.parametrize("inch", [False, True], ids=["mm", "inch"])
@pytest.mark.parametrize("dialect", WRITERS)
def test_every_dialect_is_described(
    tmp_path: Path, dialect: str, inch: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "part.txt"
    text = WRITERS[dialect](inch).write(PATH)
    file.write_text(text, encoding="utf-8")
    found = data_of([file], capsys)
    assert (found["dialect"], found["units"]) == (dialect, "inch" if inch else "mm")
    counts = [sum(operation[name] for operation in found["operations"]) for name in ("points", "arcs", "holes")]
    assert counts[1:] == [1, 2]
    others = text.count("TLON,GOFWD")  # an arc of CATIA has its end point in itself
    assert sum(counts) == others + sum(bool(re.match(r"\s*GOTO\s*/", line)) for line in text.splitlines())
    assert [operation["kind"] for operation in found["operations"]] == ["three-axis", "3+2", "simultaneous"]
    assert found["operations"][1]["planes"] == [[0.6, 0.0, 0.8]]
    unit = 25.4 if inch else 1.0
    tools = [(tool["number"], tool["diameter"], tool["corner_radius"]) for tool in found["tools"]]
    assert [number for number, *_ in tools] == [5, 6, 7]
    for (_, *sizes), expected in zip(tools, [(10.0, 1.0), (8.0, 0.0), (6.0, 3.0)], strict=True):
        assert sizes == pytest.approx([size * unit for size in expected])
    low, high = found["extents"]
    assert low == pytest.approx([0.0, 0.0, -2.0 * unit])  # the bottom of a hole
    assert high == pytest.approx([30 * unit, 10 * unit, 60 * unit])


@pytest.fixture(scope="module")
def clsf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("info") / "part.cls"
    file.write_text(CLSF, encoding="utf-8")
    return file


def test_lengths_and_times_are_those_of_the_programmed_feeds(clsf: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = data_of([clsf], capsys)
    face, side = found["operations"]
    # 50 mm at 600 mm/min, 100 mm at 0.1 mm/rev and 1000 rev/min, a dwell; then two holes of 10 mm at 60 mm/min
    assert (face["cutting_length"], face["cutting_seconds"]) == (150.0, 5.0 + 60.0 + 2.0)
    assert (side["cutting_seconds"], side["rapid_length"]) == (2 * 11.5, pytest.approx(29**0.5 + 1.0))
    assert (face["moves_without_time"], side["moves_without_time"]) == (0, 1)  # SIDE begins without a feed
    assert (face["feed"], face["feed_per_rev"], face["rpm"]) == ([600, 600], [0.1, 0.1], [1000, 1000])
    assert (side["holes"], side["cycles"], side["kind"]) == (2, ["DRILL"], "3+2")
    assert found["cutting_seconds"] == pytest.approx(face["cutting_seconds"] + side["cutting_seconds"])


def test_times_that_nobody_waits_for_are_not_known(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    slow = CLSF.replace("RPM,1000", "RPM,1e-300").replace("MMPM,600", "MMPM,1e-300").replace("MMPM,60,", "MMPM,1e-300,")
    file = tmp_path / "slow.cls"
    file.write_text(slow.replace("DELAY/2", "DELAY/2,REV").replace(",DWELL,1.5", ""), encoding="utf-8")
    found = data_of([file], capsys)
    assert found["cutting_seconds"] == 0.0
    assert [operation["moves_without_time"] for operation in found["operations"]] == [3, 3]
    assert main(["info", str(file)]) == 0
    capsys.readouterr()
    file.write_text(CLSF.replace("MMPM,600", "MMPM,-0"), encoding="utf-8")
    assert data_of([file], capsys)["moves_without_time"] == 2


def test_systems_tools_and_unknown_statements_are_listed(clsf: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = data_of([clsf], capsys)
    assert [system["z"] for system in found["systems"]] == [[0, 0, 1], [0, -1, 0]]
    assert [operation["system"] for operation in found["operations"]] == [0, 1]
    (tool,) = found["tools"]
    assert (tool["number"], tool["register"], tool["name"], tool["operations"]) == (3, 4, "MILL", [0, 1])
    (unknown,) = found["unknown"]
    assert (unknown["statement"], unknown["count"], unknown["line"]) == ("SHOPEV/17", 2, 14)
    assert main(["info", str(clsf)]) == 0
    text = capsys.readouterr().out
    for words in (
        "NX CLSF (TOOL PATH/ in line 2)",
        "FACE  three-axis  T3 MILL",
        "d 20 r 0.8 length 75",
        ":14: SHOPEV/17",
    ):
        assert words in text
    assert main(["info", str(clsf), "--strict"]) == 2


def test_the_command_shows_what_the_library_gives(clsf: Path, capsys: pytest.CaptureFixture[str]) -> None:
    described = trunnion.describe_cl([clsf, YL569 / "2_hub_rough.cls"])
    found = data_of([clsf, YL569 / "2_hub_rough.cls"], capsys)
    assert [operation.name for operation in described.operations] == [each["name"] for each in found["operations"]]
    assert found["dialect"] == described.dialect == "clsf"
    assert set(found) == {*(name for name in described.__slots__ if name != "toolpaths"), "schema"}


def test_files_in_different_dialects_and_units_are_one_job(
    tmp_path: Path, clsf: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "other"
    other.write_text(WRITERS["apt"](True).write(PATH), encoding="utf-8")
    found = data_of([other, clsf], capsys)
    assert (found["dialect"], found["units"]) == (None, None)
    assert [(file["dialect"], file["units"]) for file in found["files"]] == [("apt", "inch"), ("clsf", "mm")]
    assert [operation["name"] for operation in found["operations"]][-2:] == ["FACE", "SIDE"]


def test_the_plot_is_no_file_that_is_read(clsf: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = clsf.with_suffix(".html")
    page.write_text(CLSF, encoding="utf-8")
    assert main(["info", str(page), "--plot", str(page)]) == 2
    assert page.read_text(encoding="utf-8") == CLSF
    assert "although it is read" in capsys.readouterr().err
    assert main(["info", str(clsf), "--plot", str(clsf.with_suffix(".png"))]) == 2
    assert "let its name end in .html" in capsys.readouterr().err
    page.unlink()
    assert main(["info", str(clsf), "--plot", str(page)]) == 0
    assert "<canvas" in page.read_text(encoding="utf-8")


REAL = sorted([*SHARED.glob("data/creo/*"), *SHARED.glob("data/solidworks/*.apt"), *SHARED.glob("data/nx/*.cls")])


@pytest.mark.skipif(not REAL, reason="the files of others are not beside the project")
def test_every_goto_of_real_files_is_counted(capsys: pytest.CaptureFixture[str]) -> None:
    for file in REAL:
        found = data_of([file], capsys)
        lines = file.read_text(encoding="latin-1").splitlines()
        count = sum(bool(re.match(r"\s*GOTO\s*/", line)) for line in lines)
        assert sum(o["points"] + o["arcs"] + o["holes"] for o in found["operations"]) == count, file.name
