"""``trunnion place --goal collisions``, and what other goals tell of bodies."""

import json
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main
from trunnion.simulation.meshes import TriangleMesh, box_mesh, save_mesh

BLADE = str(YL569 / "3_blade_finish.cls")

TOOL = "2=ball:10,length=60,flutes=20,holder=40x50"

HEAD_HEAD = ["place", BLADE, "--machine", "generic_head_head_ca", "--goal", "collisions", "--turn", "0"]


@pytest.fixture
def plate(tmp_path: Path) -> str:
    """Wide, and 40 mm below the path."""
    return saved(box_mesh(np.array([-200.0, -200, -60]), np.array([200.0, 200, -45])), tmp_path / "plate.stl")


def saved(mesh: TriangleMesh, file: Path) -> str:
    save_mesh(mesh, file)
    return str(file)


def test_text_and_data_name_the_nearest_bodies_and_their_line(
    plate: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = tmp_path / "placed.json"
    options = ["--tool", TOOL, "--fixture", plate, "--zero", "0,0,0", "--json", str(data)]
    assert main([*HEAD_HEAD, *options]) == 0
    lines = capsys.readouterr().out.splitlines()
    nearest = next(line for line in lines if line.startswith("  nearest to each other: "))
    assert nearest.startswith("  nearest to each other: spindle nose and fixture plate.stl are 11.26")
    assert f"({BLADE}:23); at the present zero spindle nose and fixture plate.stl" in nearest
    assert any(
        line.startswith("  no place at the turns that were tried keeps bodies farther apart than") for line in lines
    )
    always = next(line for line in lines if line.startswith("  wherever the part sits: "))
    assert "cutter of 2 and fixture plate.stl are 14.31" in always
    found = json.loads(data.read_text("utf-8"))
    assert found["fits"] is True
    assert found["best"]["nearest"]["between"] == ["spindle nose", "fixture plate.stl"]
    assert found["best"]["nearest"]["line"] == 23
    assert found["best"]["nearest"]["file"] == BLADE
    assert found["best"]["value"] == found["best"]["nearest"]["distance_mm"] == found["distance_mm"]
    assert found["most_distance_mm"] == pytest.approx(found["distance_mm"], abs=0.1)
    assert found["nearest_anywhere"]["distance_mm"] > found["distance_mm"]
    assert found["present"]["nearest"]["distance_mm"] == pytest.approx(found["distance_mm"], abs=1e-3)


def test_what_touches_at_every_place_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tall = saved(box_mesh(np.array([20.0, -200, -60]), np.array([60.0, 200, 45])), tmp_path / "tall.stl")
    applied = tmp_path / "part.mpf"
    assert main([*HEAD_HEAD, "--tool", TOOL, "--fixture", tall, "--apply", str(applied)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(
        "generic_head_head_ca: bodies touch wherever the part sits: cutter of 2 and fixture tall.stl touch ("
    )
    assert not applied.exists()
    # What no other goal judges, it tells.
    assert main([*HEAD_HEAD[:4], "--turn", "0", "--tool", TOOL, "--fixture", tall]) == 0
    told = capsys.readouterr()
    assert "cutter of 2 and fixture tall.stl touch" in told.out
    warning = next(line for line in told.err.splitlines() if line.endswith("[PLC300]"))
    assert "warning: cutter of 2 and fixture tall.stl touch at the best place; the goal margin allows it" in warning


def test_the_program_of_the_best_place_is_proven_with_the_length_of_the_tool(plate: str, tmp_path: Path) -> None:
    program = tmp_path / "part.mpf"
    found = trunnion.place(
        BLADE, machine="generic_head_table_bc", goal="collisions", turns=[0.0, 90.0], tools=[TOOL], fixtures=plate
    )
    assert found.fits
    assert found.tool_length_mm == 110.0
    assert found.nearest is not None
    assert found.most_distance_mm is not None
    assert found.best is not None
    assert found.best.nearest is not None
    assert found.best.margin_mm >= 1.0 - 1e-6
    posted = trunnion.post_placed(found, machine="generic_head_table_bc", output=program)
    assert posted.passed
    again = trunnion.place(
        program, machine="generic_head_table_bc", turns=[0.0], tools=[TOOL], zero=found.zero_mm,
        fixtures=trunnion_turned(plate, found.turn_deg or 0.0), tool_length=110.0,
    )  # fmt: skip
    assert again.present is not None
    assert again.present.nearest is not None
    assert again.present.nearest.distance_mm == pytest.approx(found.best.nearest.distance_mm, abs=0.01)


def trunnion_turned(file: str, degrees: float) -> TriangleMesh:
    """The mesh of a file turned about Z, as the part of the program is."""
    from trunnion.simulation.meshes import load_mesh

    angle, pose = np.radians(degrees), np.eye(4)
    pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return load_mesh(file).moved(pose)


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (["--machine", "generic_head_head_ca"], "SIM310"),
        (["--machine", "generic_head_head_ca", "--tool", "2=ball:x"], "SIM153"),
        (["--machine", "generic_head_head_ca", "--tool", TOOL, "--stock", "box:1,2"], "SIM122"),
        (["--machine", "generic_head_head_ca", "--tool", TOOL, "--fixture", "none.stl"], "FIL110"),
    ],
)
def test_what_cannot_be_judged_is_refused(options: list[str], code: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["place", BLADE, *options, "--goal", "collisions", "--turn", "0"]) == 2
    assert f"[{code}]" in capsys.readouterr().err


def test_the_nose_of_a_shipped_machine_without_gauge_point_is_kept_apart(capsys: pytest.CaptureFixture[str]) -> None:
    part = ["place", BLADE, "--machine", "yl569", "--turn", "0", "--tool-length", "110", "--goal", "collisions"]
    assert main(part) == 0
    assert "gauge_point_mm" not in capsys.readouterr().err


def test_where_no_place_changes_distances_the_margin_decides(plate: str, capsys: pytest.CaptureFixture[str]) -> None:
    part = ["place", BLADE, "--machine", "generic_nutated_b45_c", "--turn", "0", "--tool-length", "110", "--tool", TOOL]
    assert main([*part, "--goal", "collisions", "--fixture", plate]) == 0
    told = capsys.readouterr().out.splitlines()
    assert main([*part, "--fixture", plate]) == 0
    other = capsys.readouterr().out.splitlines()
    assert told[0].endswith(": 330.496 mm to the limits")
    assert other[0].endswith(": 330.496 mm to the limits")
    near = [line.split(";")[0] for line in (*told, *other) if line.startswith("  nearest to each other: ")]
    assert len(near) == 2
    assert near[0] == near[1]  # of the spindle nose and the plate
