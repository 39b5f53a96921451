"""Project files of ``trunnion simulate``: a set-up that is written once, and set-ups in turn."""

import json
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import ROOT
from tests.support.sweeps import CUBE, CUBE_FACES
from trunnion.cli import main
from trunnion.jobs.project.file import read_project
from trunnion.simulation.meshes import TriangleMesh, save_mesh

HEAD = "G21 G90 G17 G40 G49 G80 G54\nT1 M6\nG43 H1\nS1000 M3\nG0 X-20 Y0 Z20\n"
SLOT = HEAD + "N50 G0 Z-5\nN60 G1 X70 F500\nN70 G0 Z20\nM5\nM30\n"
PROJECT = """\
[simulation]
machine = "xyzac_trt"
stock = "box:50,40,10,0,-20,-10"
cell_mm = 1.0
programs = ["nc/slot.ngc"]
tools = ["1=flat:10,length=60,flutes=20,holder=40x50"]
"""
#: The slot from above, and after a turn about X the same slot from below: nothing but a web of 2 mm is left.
SETUPS = """\
[simulation]
machine = "xyzac_trt"
stock = "box:50,40,12,0,-20,-12"
part = "part.stl"
cell_mm = 1.0
tools = ["1=flat:10,length=60,flutes=20,holder=40x50"]

[[simulation.setup]]
name = "top"
programs = ["nc/slot.ngc"]

[[simulation.setup]]
name = "bottom"
programs = ["nc/slot.ngc"]
pose = { turn_deg = [180, 0, 0], origin_mm = [0, 0, -12] }
"""


def cuboid(low: tuple[float, float, float], high: tuple[float, float, float]) -> TriangleMesh:
    return TriangleMesh(np.array(low) + CUBE * (np.array(high) - np.array(low)), CUBE_FACES)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "nc").mkdir()
    (tmp_path / "nc" / "slot.ngc").write_text(SLOT)
    boxes = [cuboid((0, -20, -12), (50, -5, 0)), cuboid((0, 5, -12), (50, 20, 0)), cuboid((0, -5, -7), (50, 5, -5))]
    faces = np.concatenate([box.faces + 8 * k for k, box in enumerate(boxes)])
    save_mesh(TriangleMesh(np.concatenate([box.vertices for box in boxes]), faces), tmp_path / "part.stl")
    return tmp_path


def project(folder: Path, text: str, name: str = "plate.toml") -> Path:
    (folder / name).write_text(text)
    return folder / name


def test_a_project_says_what_the_arguments_say(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plate = project(folder, PROJECT)
    found = trunnion.simulate(plate)
    assert found.passed
    assert found.removed == pytest.approx(2500.0, rel=1e-3)
    assert (found.setups, found.findings) == ((), ())
    coarse = trunnion.simulate(plate, cell=2.0, stock="box:50,40,10,0,-20,-8")
    assert max(coarse.cell) == 2.0
    assert coarse.removed == pytest.approx(3500.0, rel=0.1)
    assert main(["simulate", str(plate), "--cell", "2", "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["cell_mm"] == 2.0


def test_the_stock_of_one_set_up_is_that_of_the_next(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plate = project(folder, SETUPS)
    found = trunnion.simulate(plate)
    assert found.passed
    assert [one.setup for one in found.operations] == ["top", "bottom"]
    assert [round(each.removed) for each in found.setups] == [2500, 2500]
    assert found.removed == pytest.approx(5000.0, rel=1e-3)
    assert found.left is not None
    assert found.left.largest <= found.limit
    assert found.setups[0].left is not None
    assert found.setups[0].left.largest == pytest.approx(5.0, abs=0.01)  # what the second one takes
    low, high = found.simulation.stock.lattice.low, found.simulation.stock.lattice.high
    assert np.allclose([low, high], [[0, -20, -12], [50, 20, 0]])
    deeper = project(folder, SETUPS.replace('"nc/slot.ngc"]\npose', '"nc/deep.ngc"]\npose'), "deeper.toml")
    (folder / "nc" / "deep.ngc").write_text(SLOT.replace("Z-5", "Z-6"))
    assert main(["simulate", str(deeper), "--json", str(folder / "out.json")]) == 1
    assert "bottom: " in capsys.readouterr().out
    data = json.loads((folder / "out.json").read_text())
    assert [(one["name"], one["passed"]) for one in data["setups"]] == [("top", True), ("bottom", False)]
    assert [(one["kind"], one["setup"], one["block"]) for one in data["collisions"]] == [("gouge", "bottom", 60)]
    assert data["collisions"][0]["depth_mm"] == pytest.approx(1.0, abs=0.01)
    assert main(["simulate", str(deeper), "--report", str(folder / "out.html")]) == 1
    page = (folder / "out.html").read_text()
    assert page.count("data:image/png;base64,iVBORw0KGgo") == 4  # two of each set-up
    assert "<h3>bottom</h3>" in page
    assert "bottom: deep.ngc:7 N60" in page
    trunnion.write_report(found, folder / "out.json")
    assert json.loads((folder / "out.json").read_text())["passed"]
    for name in ("plate.toml", "nc/slot.ngc"):
        before = (folder / name).read_bytes()
        assert main(["simulate", str(plate), "--report", str(folder / name)]) == 2
        assert (folder / name).read_bytes() == before


def test_a_turn_that_is_no_quarter_says_what_it_costs(folder: Path) -> None:
    turned = SETUPS.replace("[180, 0, 0]", "[160, 0, 0]").replace('part = "part.stl"\n', "")
    found = trunnion.simulate(project(folder, turned))
    assert [one.what for one in found.remarks if "turned through its surface: it may be 0.5 mm off" in one.what]


def test_a_set_up_has_its_own_work_offset(folder: Path) -> None:
    told = trunnion.simulate(project(folder, PROJECT + 'work_offset = "G55"\n'))
    assert not told.passed
    assert any("cuts in G54, and the set-up is in G55" in one.what for one in told.remarks if one.line)
    assert trunnion.simulate(project(folder, PROJECT + 'work_offset = "G54"\n')).passed


def wrong(plate: Path, **given: object) -> list[tuple[int, str]]:
    with pytest.raises(trunnion.InputError) as raised:
        trunnion.simulate(plate, **given)  # type: ignore[arg-type]
    return [(problem.line, f"{problem.what}; {problem.cure}") for problem in raised.value.problems]


def test_every_mistake_is_told_at_once_with_its_line(folder: Path) -> None:
    text = PROJECT.replace("cell_mm = 1.0", 'cel_mm = 1.0\nnear_mm = -2\npart = "../secret.stl"').replace(
        "slot", "slit"
    )
    found = wrong(project(folder, text))
    assert [line for line, _ in found] == [4, 5, 6, 7]
    for (_, told), words in zip(
        found, ['did you mean "cell_mm"', "above 0", "leads out of the folder", "there is no such file"], strict=True
    ):
        assert words in told
    assert wrong(project(folder, SETUPS.replace("turn_deg", "turn")))[0][0] == 15
    first = SETUPS.replace('name = "top"', 'name = "top"\npose = { turn_deg = [180, 0, 0] }')
    assert "coordinates of this set-up" in wrong(project(folder, first))[0][1]


@pytest.mark.third
@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (PROJECT.replace("box:50,40,10,0,-20,-10", "box:50,40"), 3, "simulation.stock: box:50,40 has 2 numbers"),
        (PROJECT.replace("1=flat:10", "1=flt:10"), 6, "simulation.tools: "),
        (PROJECT.replace("cell_mm = 1.0", "cell_mm = 0.0001"), 4, "cells of 0.0001 mm take"),
        (PROJECT.replace('machine = "xyzac_trt"', 'machine = "xyzac"'), 2, "did you mean"),
        (PROJECT.replace('machine = "xyzac_trt"\n', ""), 1, "simulation.machine is missing"),
        ("[simulations]\n", 0, "is no project"),
        ("[simulation]\nstock = [\n", 3, "is not TOML"),
        (SETUPS.replace("[simulation]", '[simulation]\nprograms = ["nc/slot.ngc"]', 1), 2, "beside set-ups"),
        (PROJECT + 'extends = "/etc/passwd"\n', 7, "write extends above the first table"),
    ],
    ids=["stock", "tool", "cell", "machine", "none", "table", "toml", "programs", "extends"],
)
def test_a_mistake_is_told_where_it_stands(folder: Path, text: str, line: int, words: str) -> None:
    (found,) = wrong(project(folder, text))
    assert found[0] == line
    assert words in found[1]


def test_texts_are_judged_with_everything_else(folder: Path) -> None:
    text = (
        PROJECT.replace("box:50,40,10,0,-20,-10", "box:50,40")
        .replace("cell_mm", "cel_mm")
        .replace("1=flat:10", "1=endmill:10")
    )
    found = wrong(project(folder, text + 'work_offset = "54"\n'))
    assert [line for line, _ in found] == [3, 4, 6, 7]
    assert "has 2 numbers" in found[0][1]
    assert 'did you mean "flat"?' in found[2][1]
    assert "write G54 to G59" in found[3][1]
    assert 'such as "G54"' in wrong(project(folder, PROJECT + "work_offset = 54\n"))[0][1]
    both = SETUPS.replace('name = "top"', 'name = "top"\ntools = ["2=ball:6"]').replace(
        'name = "bottom"', 'name = "bottom"\ntools = ["3=ball:6"]'
    )
    told = wrong(project(folder, both))
    assert [words.partition(":")[0] for _, words in told] == ["top", "bottom"]


def test_the_example_comes_out_and_is_what_the_page_shows() -> None:
    plate = ROOT / "examples" / "simulation" / "plate.toml"
    shown = plate.read_text(encoding="utf-8").split("\n", 2)[2]  # without its schema and the remark
    assert f"```toml\n{shown}```" in (ROOT / "docs" / "simulation.md").read_text(encoding="utf-8")
    found = trunnion.simulate(plate)
    assert found.passed
    assert [one.removed for one in found.operations] == pytest.approx([8000.0, 5000.0, 6400.0], rel=1e-3)
    assert found.left is not None
    assert found.left.largest < 0.01
    assert [one.what for one in found.remarks if "gauge_point_mm" not in one.what] == []


def test_a_project_is_told_by_its_content_and_stands_alone(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plate, nc = project(folder, PROJECT), folder / "nc" / "slot.ngc"
    assert "file not found; give the path of a project" in wrong(folder / "none.toml")[0][1]
    assert "let its name end in .toml" in wrong(project(folder, PROJECT, "plate.txt"))[0][1]
    assert main(["simulate", str(nc), str(plate)]) == 2
    assert "stands beside other programs; give it alone" in capsys.readouterr().err
    assert main(["simulate", str(nc), "--machine", "xyzac_trt"]) == 2
    assert "--stock: error: is missing" in capsys.readouterr().err
    assert "would be that of all set-ups" in wrong(project(folder, SETUPS), zero=(0, 0, 0))[0][1]
    assert main(["simulate", str(plate), "--save-stock", str(nc)]) == 2
    assert main(["simulate", str(plate), "--json", str(nc)]) == 2
    assert nc.read_text() == SLOT


def test_what_is_given_may_be_missing_in_the_project(folder: Path) -> None:
    bare = PROJECT.replace('machine = "xyzac_trt"\n', "").replace('stock = "box:50,40,10,0,-20,-10"\n', "")
    assert trunnion.simulate(
        project(folder, bare), machine="xyzac_trt", stock="box:50,40,10,0,-20,-10"
    ).removed == pytest.approx(2500.0, rel=1e-3)


@pytest.mark.third
@pytest.mark.parametrize(
    "value", ["[]", "[[]]", "{}", "[{}]", "[{}, 1]", "1", "-1", "nan", "true", '""', '"x"', '["x", 1]', "2026-01-01"]
)
def test_a_value_of_any_type_is_told_with_its_line(folder: Path, value: str) -> None:
    keys = ["setup", "stock", "machine", "programs", "subprograms", "fixtures", "part", "cl", "tools", "until"]
    keys += [
        "unit",
        "zero_mm",
        "tool_length_mm",
        "work_offset",
        "cell_mm",
        "accuracy_mm",
        "near_mm",
        "stop_at",
        "until",
    ]
    lines = dict(line.split(" = ", 1) for line in PROJECT.splitlines()[1:])
    told = {}
    for key in keys:
        text = "\n".join(f"{name} = {each}" for name, each in (lines | {key: value}).items())
        told[key] = mistakes(project(folder, f"[simulation]\n{text}\n"))
    assert all(problem.line for problems in told.values() for problem in problems)
    assert all(told[key] for key in ("setup", "stock", "programs"))
    for key in ("pose", "pose.turn_deg", "name", "programs"):
        place = 'name = "bottom"' if key == "name" else 'programs = ["nc/slot.ngc"]\npose = {'
        mistakes(project(folder, SETUPS.replace(place, f"{key} = {value} #")))


def mistakes(path: Path) -> list[trunnion.Problem]:
    try:
        read_project(path)
    except trunnion.InputError as error:
        return list(error.problems)
    return []


def test_what_an_earlier_set_up_took_of_the_part_fails(folder: Path) -> None:
    (folder / "nc" / "deep.ngc").write_text(SLOT.replace("Z-5", "Z-6"))
    later = SETUPS.replace('part = "part.stl"\n', "").replace("slot", "deep", 1) + 'part = "part.stl"\n'
    found = trunnion.simulate(project(folder, later))
    assert not found.passed
    (told,) = [one for one in found.remarks if "is missing 1.000 mm deep" in one.what]
    assert told.what.startswith("bottom: ")
    assert told.what.endswith("before this set-up cuts anything")
    assert told.cure.startswith("check what the earlier set-ups took there")


def test_floor_and_wall_that_an_earlier_set_up_took_are_no_deeper_than_they_are(folder: Path) -> None:
    boxes = [cuboid((0, -20, -12), (50, -5, 0)), cuboid((0, -5, -12), (50, 5, -5)), cuboid((0, 5, -12), (50, 20, 0))]
    faces = np.concatenate([box.faces + 8 * k for k, box in enumerate(boxes)])
    save_mesh(TriangleMesh(np.concatenate([box.vertices for box in boxes]), faces), folder / "part.stl")
    # 1.5 mm too deep, and 1.5 mm into the wall: along the wall 6.5 mm are missing, along the edge all 50.
    (folder / "nc" / "deep.ngc").write_text(SLOT.replace("Z-5", "Z-6.5").replace("Y0", "Y1.5"))
    (folder / "nc" / "slot.ngc").write_text(HEAD + "G1 X0 F500\nM5\nM30\n")
    later = SETUPS.replace('part = "part.stl"\n', "").replace("slot", "deep", 1) + 'part = "part.stl"\n'
    same = later.replace("[180, 0, 0], origin_mm = [0, 0, -12]", "[0, 0, 0]")
    found = trunnion.simulate(project(folder, same), cell=0.4)
    (told,) = [one.what for one in found.remarks if "is missing" in one.what]
    assert 1.4 < float(told.split()[3]) < 3.5


def test_remarks_name_their_set_up(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    home = SLOT.replace("N70 G0 Z20", "N70 G0 Z20\nG53 G0 Z0")
    (folder / "nc" / "slot.ngc").write_text(home)
    twice = SETUPS.replace('"nc/slot.ngc"', '"nc/slot.ngc", "nc/slot.ngc"').replace(
        "cell_mm", "zero_mm = [0, 0, 0]\ncell_mm"
    )
    assert main(["simulate", str(project(folder, twice)), "--json", str(folder / "out.json")]) in (0, 1)
    told = capsys.readouterr().err
    remarks = json.loads((folder / "out.json").read_text())["remarks"]
    assert {one["setup"] for one in remarks} == {"top", "bottom"}
    assert all(one["text"].startswith(one["setup"] + ": ") for one in remarks)
    assert sum("spindle.gauge_point_mm" in one["text"] for one in remarks) == 2, "in each set-up"
    assert "top: machine positions are taken as retracts" in told
    assert "bottom: machine positions are taken as retracts" in told
