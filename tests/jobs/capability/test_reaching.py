"""What a machine reaches, as the library and the command tell it."""

import json
import math
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import GOLDEN
from trunnion.capability.part_reach import facet_reach
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.results import to_data
from trunnion.simulation.meshes import TriangleMesh, box_mesh, save_mesh

Capture = pytest.CaptureFixture[str]

CORNER = GOLDEN / "dmu65" / "corner.cls"

HEAD = """TOOL PATH/ONE,TOOL,D10
TLDATA/MILL,10,0,75,0,0
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
FEDRAT/MMPM,300
"""


@pytest.mark.parametrize(
    ("machine", "greatest_tilt"),
    [("dmu65", 90.0), ("yl569", 100.0), ("hs664rt", 110.0), ("generic_nutated_b45_c", 90.0)],
)
def test_the_share_of_the_sphere_is_that_of_the_tilts_of_the_definition(machine: str, greatest_tilt: float) -> None:
    found = trunnion.reach(machine, step=30.0)
    assert found.sphere == pytest.approx((1.0 - math.cos(math.radians(greatest_tilt))) / 2.0, abs=1e-3)
    assert [each.tilt for each in found.tilts] == [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0]
    assert [each.share for each in found.tilts] == [float(each.tilt <= greatest_tilt) for each in found.tilts]


def test_rotary_positions_are_counted_at_each_azimuth() -> None:
    """The B of a YL569 goes from -11 to 100 degrees: only tilts up to 11 degrees have a second position."""
    machine = load_machine("yl569")
    endless = replace(  # without volumes, which take their time
        machine, axes=tuple(a if a.is_rotary else replace(a, low=-math.inf, high=math.inf) for a in machine.axes)
    )
    found = trunnion.reach(endless, step=5.0)
    assert {each.tilt: set(each.branches) for each in found.tilts if each.share} == {
        0.0: {1}, 5.0: {2}, 10.0: {2}, **{float(tilt): {1} for tilt in range(15, 101, 5)},
    }  # fmt: skip
    assert len(found.tilts[1].branches) == 72
    assert len(found.tilts[0].branches) == 1


def test_one_position_reaches_the_product_of_the_travels_whatever_the_tilt() -> None:
    found = trunnion.reach("dmu65", tool_length=80, step=45.0)
    for each in found.tilts[:3]:
        assert each.one_pose is not None
        assert list(each.one_pose) == pytest.approx([735.0 * 650.0 * 560.0] * 2)
        assert each.some is not None
        assert each.every is not None
        assert each.every.low <= each.every.high <= each.some.high
        assert each.some.high >= 735.0 * 650.0 * 560.0
    assert found.tilts[3].one_pose == (0.0, 0.0)


def test_bounds_allow_for_azimuths_that_were_not_tried() -> None:
    """A head at eight azimuths: the volumes of all azimuths, by hand, are between bounds that the eight alone miss."""
    found = trunnion.reach("generic_head_head_ca", tool_length=400, step=45.0).tilts[2]
    machine = load_machine("generic_head_head_ca")
    arm = 400.0 + math.dist(machine.spindle_point, machine.axis("A").point)  # at a tilt of 90 degrees all of it swings
    ever = (3000.0 * 2000.0 + 2.0 * arm * 5000.0 + math.pi * arm**2) * 1200.0
    assert found.tilt == 90.0
    assert found.some is not None
    assert found.some.low < ever < found.some.high
    assert found.some.likely < 0.97 * ever
    assert found.every is not None
    assert found.every.low < (3000.0 - 2.0 * arm) * (2000.0 - 2.0 * arm) * 1200.0 <= found.every.high * (1.0 + 1e-9)
    assert 0.5 * arm * math.sin(math.radians(22.5)) < found.between < arm * math.radians(45.0)


def test_volumes_do_not_depend_on_the_zero_but_heads_on_the_tool() -> None:
    here = trunnion.reach("generic_head_head_ca", tool_length=100, step=45.0)
    there = trunnion.reach("generic_head_head_ca", tool_length=100, zero=(300, -200, 50), step=45.0)
    longer = trunnion.reach("generic_head_head_ca", tool_length=300, step=45.0)
    volumes = [found.tilts[1].every for found in (here, there, longer)]
    assert volumes[0] is not None
    assert volumes[1] is not None
    assert volumes[2] is not None
    assert volumes[1].likely == pytest.approx(volumes[0].likely, rel=1e-6)
    assert volumes[2].likely < 0.8 * volumes[0].likely


def test_a_machine_without_slide_limits_has_no_volumes(capfd: Capture) -> None:
    assert main(["reach", "--machine", "hs664rt", "--step", "45"]) == 0
    out, err = capfd.readouterr()
    assert "no limits of X and Y and Z are stated" in err
    assert "[RCH210]" in err
    assert "  45°   100.0 %" in out


def cube() -> TriangleMesh:
    """A cube of 40 mm on the workpiece zero."""
    return box_mesh(np.array([-20.0, -20.0, 0.0]), np.array([20.0, 20.0, 40.0]))


def placed(machine: str, zero: tuple[float, float, float]) -> trunnion.Machine:
    return replace(load_machine(machine), workpiece_zero=zero, tool_length=100.0)


def test_all_of_a_cube_but_its_foot_is_reached_on_a_trunnion_table() -> None:
    found = facet_reach(placed("dmu65", (0.0, 0.0, 50.0)), cube(), 0.0, 5.0)
    assert found.share == pytest.approx(5.0 / 6.0)
    assert [found.normal[k].round(9).tolist() for k in found.missed] == [[0.0, 0.0, -1.0]] * 2
    assert not found.axis[found.missed].any()
    assert found.area.sum() == pytest.approx(6.0 * 1600.0)


def test_a_foot_is_reached_by_a_tool_that_leans_enough() -> None:
    machine = placed("yl569", (0.0, 0.0, 0.0))  # it tilts to 100 degrees: 10 below the horizon
    assert facet_reach(machine, cube(), 79.0, 5.0).share == pytest.approx(5.0 / 6.0)
    leaning = facet_reach(machine, cube(), 81.0, 5.0)
    assert (leaning.share, leaning.rings) == (1.0, 17)


def test_what_is_beyond_the_travel_is_told_apart() -> None:
    """Two metres up the top is above all that Z reaches, whichever way C stands."""
    away = placed("dmu65", (0.0, 0.0, 2000.0))
    found = facet_reach(away, cube(), 0.0, 5.0)
    top = [k for k in range(12) if found.normal[k, 2] > 0.5]
    assert found.axis[top].all()
    assert not found.travel[top].any()
    leaning = facet_reach(away, cube(), 30.0, 10.0)
    assert leaning.axis[np.abs(leaning.normal[:, 2]) < 0.5].all()  # their own normals, though no downward one


def test_a_part_is_read_and_judged(tmp_path: Path, capfd: Capture) -> None:
    part, data = tmp_path / "cube.stl", tmp_path / "reach.json"
    save_mesh(cube(), part)
    command = ["reach", "--machine", "dmu65", "--part", str(part), "--step", "45", "--zero", "0,0,50"]
    assert main([*command, "--tool-length", "100", "--json", str(data)]) == 1
    out = capfd.readouterr().out
    assert out.splitlines()[0] == "cube.stl: 83.3 % of the surface is reached along its normal (12 facets)"
    assert "  no such tool axis: 16.7 %, normals tilted from 180.0° to 180.0°" in out
    assert out.count(": no such tool axis") == 2
    found = json.loads(data.read_text("utf-8"))["part"]
    assert (found["facets"], len(found["no_tool_axis"]), found["no_travel"]) == (12, 2, [])
    assert found["reached_share"] == pytest.approx(5.0 / 6.0, abs=1e-6)


def test_points_of_cl_files_are_judged_with_their_lines(tmp_path: Path, capfd: Capture) -> None:
    """A tilt of 95 degrees is one for the YL569 and not for the DMU 65; 500 mm of Y are within no travel there."""
    file = tmp_path / "part.cls"
    lines = ["GOTO/0,0,50,0,0,1", "GOTO/10,0,20,0.996194698,0,-0.087155743", "GOTO/0,500,20,0,0,1"]
    file.write_text(HEAD + "\n".join(lines) + "\nEND-OF-PATH\n", encoding="utf-8")
    setup = ["--zero", "0,0,50", "--tool-length", "100", "--step", "45"]
    assert main(["reach", str(file), "--machine", "dmu65", *setup]) == 1
    out = capfd.readouterr().out.splitlines()[0]
    assert "3 points, tilts from 0.00° to 95.00°" in out
    assert "the tool axis of 1 point cannot be had, first in line 7; 1 point beyond the travel, first in line 8" in out
    assert main(["reach", str(CORNER), "--machine", "dmu65", "--step", "45"]) == 0
    told = "tilts from 54.74° to 54.74°: every tool axis can be had; but linear axes are not judged (give --zero)"
    assert capfd.readouterr().out.splitlines()[0].endswith(told)
    assert main(["reach", str(CORNER), "--machine", "dmu65", "--step", "45", "--zero", "0,0,50"]) == 0
    told = ": all reached; but Z is not judged (give --tool-length)"
    assert capfd.readouterr().out.splitlines()[0].endswith(told)
    assert main(["reach", str(CORNER), "--machine", "dmu65", *setup]) == 0
    assert capfd.readouterr().out.splitlines()[0].endswith(": all reached")
    assert main(["reach", str(CORNER), "--machine", "ucp800", *setup, "--json", "-"]) == 0
    assert json.loads(capfd.readouterr().out)["slides_not_judged"] == ["X", "Y", "Z"]
    assert main(["reach", str(CORNER), "--machine", "ucp800", *setup]) == 0
    told = "but linear axes are not judged (the machine states no limits)"
    assert capfd.readouterr().out.splitlines()[0].endswith(told)


def test_the_picture_is_drawn_and_data_hold_the_same(tmp_path: Path, capfd: Capture) -> None:
    picture = tmp_path / "reach.svg"
    assert main(["reach", "--machine", "yl569", "--step", "30", "--plot", str(picture), "--json", "-"]) == 0
    data = json.loads(capfd.readouterr().out)
    assert data == to_data(trunnion.reach("yl569", step=30.0))
    drawing = ET.fromstring(picture.read_text("utf-8"))
    sectors = [each for each in drawing.iter("{http://www.w3.org/2000/svg}path") if each.get("class") in ("one", "two")]
    assert len(sectors) == 4  # tilts of 0, 30, 60 and 90 degrees, whole rings


@pytest.mark.third
@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--step", "0.1"], "--step: error: is 0.1; give a number of degrees from 1 to 45"),
        (["--step", "0"], "--step: error: is 0.0; give a number of degrees from 1 to 45"),
        (["--lean", "91"], "--lean: error: is 91.0"),
        (["--lean", "nan"], "--lean: error: is nan"),
        (["--plot", "reach.png"], "reach.png: error: reach is drawn as SVG; let its name end in .svg"),
        (["--part", "none.stl"], "none.stl: error: file not found"),
        (["none.cls"], "none.cls: error: file not found"),
    ],
)
def test_what_cannot_be_used_is_told(arguments: list[str], what: str, capfd: Capture) -> None:
    assert main(["reach", "--machine", "hs664rt", *arguments]) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert what in err


def test_a_table_that_tilts_depends_on_the_tool_length_and_a_warning_says_so(capfd: Capture) -> None:
    """At 90 degrees the tool of a DMU 65 lies across: without a length its tip hardly comes beyond the spindle."""
    assert main(["reach", "--machine", "dmu65", "--step", "45"]) == 0
    assert "the tool length is not known and counts as 0; give --tool-length MM" in capfd.readouterr().err
    assert main(["reach", "--machine", "dmu65", "--step", "45", "--tool-length", "100"]) == 0
    assert "tool length" not in capfd.readouterr().err
    short, long = (
        next(each for each in trunnion.reach("dmu65", step=45.0, tool_length=length).tilts if each.tilt == 90.0)
        for length in (0.0, 100.0)
    )
    assert short.every is not None
    assert long.every is not None
    assert short.every.likely < long.every.likely


def test_a_part_that_leaks_is_told(tmp_path: Path, capfd: Capture) -> None:
    corners = [(0, 0, 0), (30, 0, 0), (0, 30, 0)]
    facet = "".join(f"vertex {x} {y} {z}\n" for x, y, z in corners)
    file = tmp_path / "open.stl"
    file.write_text(f"solid s\nfacet normal 0 0 1\nouter loop\n{facet}endloop\nendfacet\nendsolid s\n")
    main(["reach", "--machine", "dmu65", "--part", str(file), "--step", "45"])
    err = capfd.readouterr().err
    assert "open.stl: warning: leaks: 3 edges of its surface are open" in err
    assert "[SIM214]" in err
