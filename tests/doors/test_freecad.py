"""The post for FreeCAD: what it writes of plain stand-ins, and real jobs of FreeCAD without a screen."""

import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace as Thing
from typing import Any

import numpy as np
import pytest

import trunnion
from tests.support.locations import ROOT, TESTS
from trunnion.cli import main
from trunnion.cli.doors import macro_folder
from trunnion.doors import trunnion_post
from trunnion.model.toolpath import CycleOn, Frame, Kind

JOBS = (
    "profile", "pocket", "adaptive", "helix", "drilling", "facing", "two_tools", "two_fixtures", "tags", "thread",
)  # fmt: skip
MACHINES = ("dmu65", "yl569", "haas_umc750")


def command(name: str, **words: float) -> Thing:
    """A Path.Command."""
    return Thing(Name=name, Parameters=words)


def bit(shape: str = "endmill", **sizes: Any) -> Thing:
    """A tool bit; sizes are quantities."""
    return Thing(ShapeName=shape, **{name: Thing(Value=value) for name, value in sizes.items()})


def operation(*commands: Thing, label: str = "POCKET", tool: Thing | None = None, **others: Any) -> Thing:
    """An operation with a tool controller."""
    tool = tool or bit(Diameter=10.0, Length=60.0, CuttingEdgeHeight=25.0)
    controller = Thing(Label="T4", ToolNumber=4, Tool=tool, SpindleSpeed=5000.0, SpindleDir="Forward", Path=None)
    return Thing(Label=label, Path=Thing(Commands=commands), ToolController=controller, **others)


START = (command("G0", Z=20.0), command("G0", X=1.0, Y=2.0))


def read(tmp_path: Path, *objects: Thing) -> trunnion.Toolpath:
    """What is written of objects, read back strictly."""
    path = tmp_path / "job.apt"
    trunnion_post.export(objects, str(path), "--cl-only")
    return trunnion.read_cl(path)


def test_moves_arcs_and_feeds_per_second(tmp_path: Path) -> None:
    given = operation(
        *START, command("G01", Z=-1.0, F=10.0), command("G1", X=11.0), command("G3", X=11.0, Y=12.0, J=5.0),
        command("G2", X=11.0, Y=2.0, Z=-2.0, I=0.0, J=-5.0), command("(note)"), CoolantMode="Flood",
    )  # fmt: skip
    (found,) = read(tmp_path, given).operations
    assert found.moves.tip.tolist() == [[1, 2, 20], [1, 2, -1], [11, 2, -1], [11, 12, -1], [11, 2, -2]]
    assert found.moves.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.LINEAR, Kind.ARC, Kind.ARC]
    assert set(found.moves.feed[1:].tolist()) == {600.0}
    assert found.arcs.centre.tolist() == [[11, 7, -1], [11, 7, -1]]
    assert found.arcs.normal.tolist() == [[0, 0, 1], [0, 0, -1]]
    assert (found.tool.diameter, found.tool.flute_length, found.name) == (10.0, 25.0, "POCKET")


@pytest.mark.parametrize(
    ("tool", "kind", "corner", "tip"),
    [
        (bit("ballend", Diameter=8.0), "MILL", 4.0, 0.0),
        (bit("bullnose", Diameter=8.0, FlatRadius=1.5), "MILL", 1.5, 0.0),
        (bit("drill", Diameter="5,0 mm", TipAngle=119.0), "DRILL", 0.0, 119.0),
        (bit("v-bit", Diameter=6.0), "UNKNOWN", 0.0, 0.0),
    ],
)
def test_tool_bits(tool: Thing, kind: str, corner: float, tip: float, tmp_path: Path) -> None:
    (found,) = read(tmp_path, operation(*START, command("G1", Z=0.0, F=1.0), tool=tool)).operations
    assert (found.tool.kind, found.tool.corner_radius, found.tool.tip_angle) == (kind, corner, tip)


def test_holes_are_measured_from_the_height_of_r(tmp_path: Path) -> None:
    drill = command("G83", X=1.0, Y=2.0, Z=-20.0, R=3.0, Q=4.0, F=2.0)
    again = command("G83", X=9.0, Y=2.0, Z=-20.0, R=3.0, Q=4.0, F=2.0)
    (found,) = read(tmp_path, operation(*START, command("G98"), drill, again, command("G80"))).operations
    (cycle,) = (event for event in found.events if isinstance(event, CycleOn))
    assert dict(cycle.values) == {"RAPTO": (0,), "FEDTO": (-23,), "RTRCTO": (17,), "STEP": (4,), "MMPM": (120,)}
    assert found.moves.tip.tolist()[1:] == [[1, 2, 3], [9, 2, 3]]


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        (command("G1", A=30.0), "operation POCKET: G1 has the rotary word A"),
        (command("G2", X=5.0, R=9.0), "operation POCKET: G2 without I, J and K"),
        (command("G91"), "operation POCKET: G91 is not known"),
        (command("G83", Z=-20.0, R=3.0), "operation POCKET: G83 without a peck"),
        (command("M6", T=5), "operation POCKET: M6 T5 loads another tool"),
    ],
)
def test_what_is_not_followed_is_refused_by_the_name_of_its_operation(wrong: Thing, why: str, tmp_path: Path) -> None:
    with pytest.raises(trunnion_post.RefusedError, match=why):
        read(tmp_path, operation(*START, wrong))


def test_a_rapid_ends_a_cycle() -> None:
    drill, away = command("G81", X=1.0, Y=2.0, Z=-20.0, R=3.0, F=2.0), command("G0", X=50.0)
    lines = trunnion_post.Writer().job([operation(*START, drill, away, command("G80"))]).splitlines()
    assert lines[-6:-2] == ["GOTO/1,2,3", "CYCLE/OFF", "RAPID", "GOTO/50,2,20"]


def test_a_label_is_one_line_of_text(tmp_path: Path) -> None:
    cut = (*START, command("M6", T=4), command("G1", Z=0.0, F=1.0), command("(a\nGOTO/9,9,9)"))
    (found,) = read(tmp_path, operation(*cut, label="A$\nPOCKET 3/8")).operations
    assert found.name == "A POCKET 3/8"
    assert found.moves.tip.tolist() == [[1, 2, 20], [1, 2, 0]]


def test_inactive_operations_and_fixtures(tmp_path: Path) -> None:
    cut = (*START, command("G1", Z=0.0, F=1.0))
    fixtures = [
        Thing(Label=name, Path=Thing(Commands=[command(name), command("G0", Z=99.0)])) for name in ("G54", "G55")
    ]
    objects = [fixtures[0], operation(*cut), operation(*cut, label="NO", Active=False), fixtures[1], operation(*cut)]
    found = read(tmp_path, *objects).operations
    assert [(each.name, each.work_offset) for each in found] == [("POCKET", 1), ("POCKET G55", 2)]
    fixtures[1].Path.Commands[0].Name = "G59.3"
    assert read(tmp_path, *objects).operations[1].work_offset == 9


def test_dressups_upon_each_other_are_the_operation_that_they_change(tmp_path: Path) -> None:
    cut = (*START, command("G1", Z=0.0, F=1.0))
    base = operation(*cut, CoolantMode="Mist")
    ramp = Thing(Label="RAMP", Path=Thing(Commands=cut), Base=base)
    tags = Thing(Label="TAGS", Path=Thing(Commands=cut), Base=ramp)
    text = trunnion_post.Writer().job([tags])
    assert "LOADTL/4\nSPINDL/RPM,5000,CLW\nCOOLNT/MIST\n" in text
    base.Active = False
    with pytest.raises(trunnion_post.RefusedError, match="no active operation"):
        trunnion_post.Writer().job([tags])
    base.Active, base.Placement = True, placed(0, 0, 0, 30)
    with pytest.raises(trunnion_post.RefusedError, match="operation TAGS: its work plane is not that"):
        trunnion_post.Writer().job([tags])
    tags.Placement = ramp.Placement = base.Placement
    (found,) = read(tmp_path, tags).operations
    assert found.frame != Frame()


def test_an_arc_without_width_is_a_line(tmp_path: Path) -> None:
    down = command("G2", X=1.0, Y=2.0, Z=-9.0, I=0.0, J=0.0, K=-5.0)
    (found,) = read(tmp_path, operation(*START, command("G1", Z=1.0, F=1.0), down)).operations
    assert found.moves.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.LINEAR]
    assert found.moves.tip.tolist()[-1] == [1, 2, -9]


def test_a_line_of_the_cl_file_has_the_name_of_its_operation() -> None:
    begins = [(5, "ONE"), (20, "TWO")]
    assert trunnion_post.with_operation("a.apt:21: error: no", begins) == "a.apt:21: error: no (operation TWO)"
    assert trunnion_post.with_operation("passed", begins) == "passed"


def placed(x: float, y: float, z: float, tilt: float) -> Thing:
    """A placement as FreeCAD has it: turned about X by an angle, degrees, and moved."""
    c, s = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
    return Thing(toMatrix=lambda: Thing(A=(1, 0, 0, x, 0, c, -s, y, 0, s, c, z, 0, 0, 0, 1)))


def test_the_placement_of_an_operation_is_its_work_plane(tmp_path: Path) -> None:
    cut = (*START, command("G1", Z=0.0, F=1.0))
    level = operation(*cut, Placement=placed(0, 0, 0, 0))
    side = operation(*cut, label="SIDE", Placement=placed(5, 6, 7, 30))
    first, second = read(tmp_path, level, side).operations
    assert first.frame == Frame()
    assert second.frame.origin == (5.0, 6.0, 7.0)
    np.testing.assert_allclose(second.frame.z, (0.0, -0.5, math.sqrt(0.75)), atol=1e-6)
    assert second.moves.tip.tolist() == [[1, 2, 20], [1, 2, 0]]
    writer = trunnion_post.Writer()
    text = writer.job([side, level])
    assert len(writer.planes) == 2
    (tmp_path / "job.apt").write_text(text, encoding="utf-8")
    for machine in MACHINES:
        done = trunnion.post(tmp_path / "job.apt", machine=machine, settings={"frame": "absolute"})
        assert done.passed, machine
    with pytest.raises(trunnion_post.RefusedError, match="operation SIDE: G1 cuts before X, Y and Z are known"):
        read(tmp_path, level, operation(command("G1", X=9.0), label="SIDE", Placement=placed(0, 0, 0, 30)))


@pytest.mark.parametrize(
    ("settings", "folder"),
    [
        ({}, ".local/share/FreeCAD/Macro"),
        ({"user.cfg": ""}, ".local/share/FreeCAD/Macro"),
        ({"user.cfg": "OWN"}, "OWN"),
        ({"user.cfg": "OWN", "v1-1/user.cfg": ""}, ".local/share/FreeCAD/v1-1/Macro"),
        ({"user.cfg": "damaged"}, ".local/share/FreeCAD/Macro"),
    ],
)
@pytest.mark.skipif(sys.platform != "linux", reason="the folders of Linux")
def test_the_folder_is_the_one_of_the_settings_of_freecad(
    settings: dict[str, str], folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    for age, (name, text) in enumerate(settings.items()):
        file = tmp_path / ".config" / "FreeCAD" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        chosen = f'<FCText Name="MacroPath">{tmp_path / text}</FCText>' if text == "OWN" else ""
        groups = "".join(f'<FCParamGroup Name="{each}">' for each in ("Root", "BaseApp", "Preferences", "Macro"))
        file.write_text(f"<FCParameters>{groups}{chosen}{'</FCParamGroup>' * 4}</FCParameters>"[len(text) == 7 :])
        os.utime(file, (1e9 + age, 1e9 + age))
    assert macro_folder() == tmp_path / folder
    assert main(["freecad", "install"]) == 0
    assert (tmp_path / folder / "trunnion_post.py").is_file()
    assert main(["freecad", "install", "--remove"]) == 0
    assert not list((tmp_path / folder).iterdir())


def test_install_and_remove(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["freecad", "install", "--folder", str(tmp_path / "Macro")]) == 0
    command_file = tmp_path / "Macro" / "trunnion_post.json"
    assert json.loads(command_file.read_text(encoding="utf-8"))["command"][0] == sys.executable
    assert main(["freecad", "install", "--remove", "--folder", str(tmp_path / "Macro")]) == 0
    assert main(["freecad", "install", "--remove", "--folder", str(tmp_path / "Macro")]) == 0
    assert not list((tmp_path / "Macro").iterdir())
    assert "is not in" in capsys.readouterr().out


@pytest.mark.skipif(not shutil.which("freecadcmd"), reason="FreeCAD is not installed")
def test_jobs_of_freecad_become_proven_programs(tmp_path: Path) -> None:
    assert main(["freecad", "install", "--folder", str(tmp_path / "Macro")]) == 0
    given = {
        "QT_QPA_PLATFORM": "offscreen", "LC_ALL": "C.UTF-8", "TRUNNION_POST": str(tmp_path / "Macro"),
        "TRUNNION_OUT": str(tmp_path), "TRUNNION_ARGS": "|".join(f"--machine {each}" for each in MACHINES),
        "TRUNNION_JOBS": ",".join(JOBS), "HOME": str(tmp_path),
    }  # fmt: skip
    script = TESTS / "data" / "freecad" / "jobs.py"
    subprocess.run(
        ["freecadcmd", str(script)], env={**os.environ, **given}, stdin=subprocess.DEVNULL, check=False, timeout=600,
        capture_output=True,
    )  # fmt: skip
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert found == dict.fromkeys(JOBS, "ok")
    for name in JOBS:
        assert (tmp_path / f"{name}.nc").stat().st_size > 200
        assert "passed" in (tmp_path / f"{name}.html").read_text(encoding="utf-8").lower()
    assert len({each.frame for each in trunnion.read_cl(tmp_path / "two_tools.apt").operations}) == 1
    removed = {}
    for name in (each for each in JOBS if each != "two_fixtures"):  # which cuts at two places of a table
        for machine in MACHINES:
            # A thread mill has a form that CL files have no words for, and cuts more than the part has.
            own = {"tools": ["5=flat:6,length=50,flutes=40"]} if name == "thread" else {"part": tmp_path / "block.stl"}
            result = trunnion.post(tmp_path / f"{name}.apt", machine=machine, simulation={**own, "cell": 1.0})
            assert result.simulation is not None
            gouge = result.simulation.gouge
            assert gouge is None if name == "thread" else gouge is not None and gouge.largest < 1.0, (name, machine)
            removed[name, machine] = result.simulation.removed
    volumes = {name: {round(removed[name, machine]) for machine in MACHINES} for name in JOBS if name != "two_fixtures"}
    assert all(max(each) - min(each) <= 0.005 * min(each) for each in volumes.values()), volumes
    assert min(volumes["profile"]) - 100 > min(volumes["tags"]), "tags are left"
    assert min(volumes["thread"]) > min(volumes["helix"]) + 700


@pytest.mark.skipif(not shutil.which("freecadcmd"), reason="FreeCAD is not installed")
def test_the_sample_is_cut_to_the_form_of_the_part_on_three_machines(tmp_path: Path) -> None:
    assert main(["freecad", "install", "--folder", str(tmp_path)]) == 0
    given = {
        "QT_QPA_PLATFORM": "offscreen", "LC_ALL": "C.UTF-8", "HOME": str(tmp_path), "TRUNNION_OUT": str(tmp_path),
        "TRUNNION_ARGS": "--machine haas_umc750",
    }  # fmt: skip
    done = subprocess.run(
        ["freecadcmd", str(ROOT / "examples" / "freecad" / "plate.py")], env={**os.environ, **given},
        stdin=subprocess.DEVNULL, check=False, timeout=600, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "plate.nc").stat().st_size > 2000
    for machine in MACHINES:
        result = trunnion.post(
            tmp_path / "plate.apt", machine=machine, simulation={"part": tmp_path / "plate.stl", "cell": 0.5}
        )
        found = result.simulation
        assert result.passed
        assert found is not None
        assert found.left is not None
        assert found.gouge is not None
        assert found.stock_from == str(tmp_path / "plate.apt")
        assert (found.left.largest < 0.5, found.gouge.largest < 0.1) == (True, True), (machine, found.left, found.gouge)


@pytest.mark.parametrize("arguments", ["--cl-only", "--machine yl569"])
def test_a_file_that_is_no_cl_of_this_post_is_not_replaced(arguments: str, tmp_path: Path) -> None:
    path = tmp_path / "job.apt"
    path.write_text("PARTNO/BY HAND\n", encoding="utf-8")
    given = operation(*START, command("G1", Z=-1.0, F=10.0))
    output = path if arguments == "--cl-only" else tmp_path / "job.mpf"
    with pytest.raises(trunnion_post.RefusedError, match=r"job\.apt would be replaced by the CL file"):
        trunnion_post.export([given], str(output), arguments)
    assert [file.read_text(encoding="utf-8") for file in tmp_path.iterdir()] == ["PARTNO/BY HAND\n"]
    path.write_text("", encoding="utf-8")
    for _ in range(2):
        trunnion_post.export([given], str(path), "--cl-only")


def test_a_post_that_was_edited_is_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ["freecad", "install", "--folder", str(tmp_path)]
    post = tmp_path / "trunnion_post.py"
    post.write_text("# of an installation that nothing is known of\n", encoding="utf-8")
    assert [main(line), main(line)] == [0, 0]
    shipped = post.read_bytes()
    assert len(list(tmp_path.iterdir())) == 2
    post.write_bytes(shipped + b"# ours\n")
    capsys.readouterr()
    assert main(line) == 0
    assert post.read_bytes() == shipped
    (kept,) = tmp_path.glob("trunnion_post.py.edited-*")
    assert kept.read_bytes() == shipped + b"# ours\n"
    assert f"is kept as {kept.name}" in capsys.readouterr().err


def test_install_says_where_there_can_be_no_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").touch()
    assert main(["freecad", "install", "--folder", str(tmp_path / "file")]) == 2
    assert "file: error: cannot be written" in capsys.readouterr().err
