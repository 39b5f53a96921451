"""``trunnion place``."""

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import trunnion
from trunnion.cli import main
from trunnion.jobs.place.project import placed_setup
from trunnion.model.clamping import Clamping
from trunnion.model.clamping_notices import HeadNotices
from trunnion.placing.program_heads import stated_place
from trunnion.simulation.meshes import TriangleMesh, box_mesh, save_mesh

BLADE = "tests/golden/yl569/3_blade_finish.cls"
CONTOUR = "tests/golden/yl569/1_contour_rough.cls"
HUB = "tests/golden/yl569/2_hub_rough.cls"


def test_text_names_the_place_its_margins_and_what_limits_it(capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["place", HUB, "--machine", "yl569", "--tool-length", "100", "--turn", "0", "--zero", "0,0,120"])
    lines = capsys.readouterr().out.splitlines()
    assert code == 0
    assert lines[0].startswith("yl569: best zero ")
    assert lines[1] == "  the part is clamped as it is drawn"
    assert [line.split()[0] for line in lines[2:7]] == ["X", "Y", "Z", "C", "B"]
    assert all("left" in line for line in lines[2:5])
    assert lines[5].endswith("degrees, no limits")
    assert "degrees of -11 to 100: " in lines[6]
    assert lines[7].startswith("  it is held by ")
    assert f"({HUB}:" in lines[7]
    assert lines[8].startswith("  present zero 0.000,0.000,120.000: ")
    assert lines[9] == "  it fits at 1 of 1 turn"
    assert lines[10].startswith("  clamped so, the zero may be anywhere within X ")
    assert lines[11].startswith("  and not beyond X ")


def test_data_has_the_place_the_region_and_the_turns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "placed.json"
    assert main(["place", BLADE, "--machine", "yl569", "--turns", "90", "--tool-length", "0", "--json", str(file)]) == 0
    data = json.loads(file.read_text("utf-8"))
    assert data["schema"] == 2
    assert data["fits"] is True
    assert data["present"] is None
    assert len(data["best"]["zero_mm"]) == 3
    assert {axis["axis"] for axis in data["best"]["axes"]} == {"X", "Y", "Z"}
    assert data["best"]["axes"][0]["low"]["limit_mm"] == -250.0
    assert data["best"]["axes"][0]["low"]["file"] == BLADE
    assert data["share_of_turns"] == 1.0
    assert [turn["turn_deg"] for turn in data["turns"]][:1] == [0.0]
    assert len(data["region"]["corners_mm"]) > 8
    capsys.readouterr()
    assert main(["place", BLADE, "--machine", "yl569", "--turn", "0", "--tool-length", "0", "--json", "-"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert [turn["turn_deg"] for turn in printed["turns"]] == [0.0]


def test_the_picture_is_svg_that_shows_the_margin_over_table_and_turn(tmp_path: Path) -> None:
    file = tmp_path / "placed.svg"
    arguments = ["place", BLADE, "--machine", "yl569", "--turns", "120", "--tool-length", "0", "--plot", str(file)]
    assert main([*arguments, "--zero", "0,0,50"]) == 0
    root = ElementTree.parse(file).getroot()
    texts = [element.text or "" for element in root.iter("{http://www.w3.org/2000/svg}text")]
    assert any(text.startswith("yl569: margin at Z ") for text in texts)
    assert any("cross" in text for text in texts)
    assert len(list(root.iter("{http://www.w3.org/2000/svg}rect"))) > 300


def test_a_part_that_fits_nowhere_is_refused_with_what_conflicts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    machine = tmp_path / "short.toml"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "Y"\nlimits_mm = [-1, 3]\n', "utf-8")
    program = tmp_path / "never.mpf"
    code = main(["place", HUB, "--machine", str(machine), "--tool-length", "0", "--turn", "0", "--apply", str(program)])
    out = capsys.readouterr().out
    assert code == 1
    assert "fits nowhere" in out
    assert "these conflict: Y at -1 (" in out or "these conflict: Y at 3 (" in out
    assert not program.exists()


def test_travel_that_is_missing_is_told_where_one_slide_has_too_little(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The contour is 103.296 mm wide in Y, the circle of radius 51.648 mm: 80 mm are 23.296 too few."""
    machine = tmp_path / "short.toml"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "Y"\nlimits_mm = [-30, 50]\n', "utf-8")
    contour = "tests/golden/yl569/1_contour_rough.cls"
    assert main(["place", contour, "--machine", str(machine), "--tool-length", "0", "--turn", "0"]) == 1
    out = capsys.readouterr().out
    assert "fits nowhere: 11.648 mm too far at the least" in out
    assert "Y needs 23.296 mm more travel" in out


def test_a_tool_axis_out_of_reach_is_told_with_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    machine = tmp_path / "stiff.toml"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "B"\nlimits_deg = [-5, 20]\n', "utf-8")
    program = "tests/golden/yl569/3_blade_finish.expected.mpf"
    code = main(["place", program, "--machine", str(machine), "--tool-length", "0", "--turn", "0"])
    out = capsys.readouterr().out
    assert code == 1
    assert "the rotary axes reach the path at no turn" in out
    assert f"{program}:46: B would have to leave its travel, -5 to 20 degrees" in out


def test_apply_posts_the_part_where_it_sits_best(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "placed.mpf"
    code = main(["place", BLADE, "--machine", "yl569", "--tool-length", "90", "--turn", "45", "--apply", str(program)])
    err = capsys.readouterr().err
    assert code == 0
    assert program.exists()
    assert "travel        ok" in err


def test_the_program_says_how_the_part_is_clamped_and_verify_takes_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, sheet = tmp_path / "placed.mpf", tmp_path / "placed.html"
    machine = ["--machine", "yl569", "--tool-length", "90"]
    angles = ["--turn", "45", "--tilt", "-10"]
    assert main(["place", BLADE, *machine, *angles, "--apply", str(program), "--sheet", str(sheet)]) == 0
    out = capsys.readouterr().out
    lines = out.splitlines()
    assert "tilted -10 degrees about X, then turned 45 degrees: " in lines[0]
    assert "fixture angle of -10 degrees about X of the part, right-handed: its +Y side goes down" in lines[1]
    assert lines[2] == "  then turn the part by 45 degrees about Z, counter-clockwise seen from above (from +Z)"
    head = program.read_text("utf-8").splitlines()[:4]
    assert head[0].endswith(";PART TILTED -10 DEG FIRST, ABOUT ITS X, RIGHT-HANDED, ITS +Y SIDE DOWN")
    assert head[1].endswith(";PART TURNED 45 DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z")
    x, y, z = lines[0].split("best zero ")[1].split(", ")[0].split(",")
    assert head[2].endswith(f";WORKPIECE ZERO X{x} Y{y} Z{z} MM ON THE MACHINE, AXES AT 0")
    assert any(line.endswith(";ZERO FOR TOOL LENGTH 90 MM, FROM GAUGE POINT TO TIP") for line in head)
    assert "PART TURNED 45 DEG" in sheet.read_text("utf-8")
    assert "and not turned: the program is for the turned part" in sheet.read_text("utf-8")
    verified = ["verify", str(program), "--cl", BLADE, *machine]
    assert main(verified) == 1
    told = capsys.readouterr().err
    assert "tilted by -10 degrees about X and turned by 45 degrees about Z" in told
    assert "PLC220" in told
    assert main([*verified, *angles[:2]]) == 1
    assert "PLC220" in capsys.readouterr().err


def test_a_program_that_is_clamped_as_told_is_verified_without_a_word(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "placed.mpf"
    machine = ["--machine", "yl569", "--tool-length", "90"]
    for angles in (["--turn", "45", "--tilt", "-10"], ["--turn", "-30"], ["--turn", "0"]):
        assert main(["place", BLADE, *machine, *angles, "--apply", str(program)]) == 0
        capsys.readouterr()
        assert main(["verify", str(program), "--cl", BLADE, *machine, *angles]) == 0
        assert "PLC220" not in capsys.readouterr().err
    assert ";PART CLAMPED AS DRAWN, NOT TURNED" in program.read_text("utf-8")
    assert main(["verify", str(program), *machine, "--turn", "5"]) == 2  # without CL files there is nothing to turn
    assert "there are none" in capsys.readouterr().err


@pytest.mark.third
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tilt", "91"], "is not a tilt"),
        (["--tilt", "nan"], "is not a tilt"),
        (["--free", "--tilt", "5"], "not allowed with"),
        (["--free", "--turns", "1"], "give wider steps"),
        (["--sheet", "sheet.html"], "--apply"),
        (["--turns", "0"], "is not a step of turns"),
        (["--turns", "nan"], "is not a step of turns"),
        (["--turn", "inf"], "is not a turn"),
        (["--goal", "beauty"], "is unknown; write margin"),
        (["--plot", "picture.png"], "FIL260"),
        (["--zero", "1,2"], "--zero"),
        (["--json", "-", "--apply", "-"], "stdout"),
        (["--tool-length", "long"], "--tool-length"),
    ],
)
def test_what_cannot_be_is_refused(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = main(["place", BLADE, "--machine", "yl569", *arguments])
    except SystemExit as ended:
        code = int(ended.code or 0)
    assert code == 2
    assert message in capsys.readouterr().err


def test_files_that_cannot_be_placed_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = tmp_path / "empty.cls"
    empty.write_text("", "utf-8")
    assert main(["place", str(empty), "--machine", "yl569"]) == 2
    assert main(["place", str(tmp_path / "none.cls"), "--machine", "yl569"]) == 2
    assert main(["place", BLADE, "--machine", "hs664rt"]) == 2
    assert "PLC130" in capsys.readouterr().err
    program = "tests/golden/yl569/3_blade_finish.expected.mpf"
    assert main(["place", BLADE, program, "--machine", "yl569"]) == 2
    assert "PLC110" in capsys.readouterr().err
    assert main(["place", program, "--machine", "yl569", "--turn", "0", "--apply", str(tmp_path / "x.mpf")]) == 2
    assert "PLC140" in capsys.readouterr().err


def test_a_set_up_of_a_project_is_placed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The plate is 2 x 65 by 2 x 32 mm of path: travel less that is a box, and the whole region."""
    project = "examples/project/part.toml"
    assert main(["place", project, "--setup", "top", "--turn", "0"]) == 0
    out = capsys.readouterr().out
    assert "best zero 0.000,0.000,133.000, turned 0 degrees: 118.000 mm to the limits" in out
    assert "present zero 0.000,0.000,-5.000: 99.000 mm to the limits; the best place has 19.000 mm more" in out
    assert "may be anywhere within X -185.000 to 185.000, Y -118.000 to 118.000, Z -104.000 to 370.000" in out
    assert "not beyond" not in out
    assert main(["place", project]) == 2
    assert "top, bottom [PLC170]" in capsys.readouterr().err
    assert main(["place", project, "--setup", "side"]) == 2
    assert "PLC170" in capsys.readouterr().err
    assert main(["place", project, BLADE]) == 2
    assert main(["place", BLADE, "--machine", "yl569", "--setup", "top"]) == 2
    assert main(["place", BLADE]) == 2
    assert "--machine" in capsys.readouterr().err
    hooked = tmp_path / "hooked.toml"
    (tmp_path / "blade.cls").write_text(Path(BLADE).read_text("utf-8"), "utf-8")
    (tmp_path / "h.py").write_text("def on_operation(operation, context):\n    return None\n", "utf-8")
    hooked.write_text('machine = "yl569"\ncl = ["blade.cls"]\noutput = "b.mpf"\nhooks = ["h.py"]\n', "utf-8")
    assert main(["place", str(hooked)]) == 2
    assert "PLC160" in capsys.readouterr().err


def test_a_set_up_is_placed_with_what_is_clamped_there(capsys: pytest.CaptureFixture[str]) -> None:
    """The nose is 110 mm above the tip, which goes 6 mm into the stock, and 8 mm into the part that was turned over.

    The stock is 80 mm wide in Y on a table of 420 mm; options stand in place of what the project states.
    """
    part = ["place", "examples/project/part.toml", "--turn", "0", "--setup"]
    assert main([*part, "top"]) == 0
    out = capsys.readouterr().out
    assert "table: 170.000 left to its edge; it is the definition's, 700 x 420 mm" in out
    assert "nearest to each other: spindle nose and stock are 104.000 mm apart" in out
    assert "wherever the part sits: cutter of shell end mill and fixture vice.stl are 14.000 mm apart" in out
    assert main([*part, "bottom"]) == 0
    assert "spindle nose and part are 102.000 mm apart" in capsys.readouterr().out
    assert main([*part, "top", "--stock", "box:100,200,30,-50,-100,-30"]) == 0
    assert "table: 110.000 left to its edge" in capsys.readouterr().out


def test_stock_and_part_of_a_later_set_up_lie_as_poses_have_brought_them(tmp_path: Path) -> None:
    project = tmp_path / "part.toml"
    (tmp_path / "hub.cls").write_text(Path(HUB).read_text("utf-8"), "utf-8")
    save_mesh(box_mesh(np.zeros(3), np.array([4.0, 5.0, 6.0])), tmp_path / "part.stl")
    setup = '[[setup]]\nname = "{0}"\ncl = ["hub.cls"]\noutput = "{0}.mpf"\n'
    text = 'machine = "yl569"\nstock = "box:10,20,30"\npart = "part.stl"\n'
    text += setup.format("a") + setup.format("b")
    text += "pose = { turn_deg = [180, 0, 0], origin_mm = [1, 0, 30] }\n" + setup.format("c")
    project.write_text(text, "utf-8")
    assert placed_setup(project, "a").bodies.stock == "box:10,20,30"
    for name in "bc":
        bodies = placed_setup(project, name).bodies
        assert isinstance(bodies.stock, TriangleMesh)
        assert isinstance(bodies.part, TriangleMesh)
        for mesh, low, high in ((bodies.stock, (1, -20, 0), (11, 0, 30)), (bodies.part, (1, -5, 24), (5, 0, 30))):
            assert mesh.vertices.min(axis=0) == pytest.approx(low)
            assert mesh.vertices.max(axis=0) == pytest.approx(high)


@pytest.mark.parametrize("goal", ["slides", "rotary", "overspeed"])
def test_goals_other_than_the_margin_tell_the_nearest_limits(
    goal: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = tmp_path / "placed.json"
    command = ["place", CONTOUR, "--machine", "yl569", "--tool-length", "100", "--turn", "0", "--goal", goal]
    assert main([*command, "--json", str(data)]) == 0
    out, found = capsys.readouterr().out, json.loads(data.read_text("utf-8"))
    assert "  nearest limit" in out
    assert "it is held by" not in out
    least = min(axis["margin_mm"] for axis in found["best"]["axes"])
    use = {axis["axis"]: axis for axis in found["best"]["axes"]}
    assert found["limits"]
    for limit in found["limits"]:
        axis = use[limit["axis"]]
        left = {"low": axis["least_mm"] - limit["limit_mm"], "high": limit["limit_mm"] - axis["greatest_mm"]}
        assert left[limit["end"]] == pytest.approx(least, abs=2e-3)


def test_the_edge_is_told_with_the_limits_that_are_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    """A stock of 300 by 420 mm fills the table in Y."""
    command = ["place", CONTOUR, "--machine", "yl569", "--tool-length", "100", "--turn", "0", "--goal", "slides"]
    assert main([*command, "--stock", "box:300,420,40,-150,-210,0"]) == 0
    line = next(line for line in capsys.readouterr().out.splitlines() if "nearest limit" in line)
    assert line.startswith("  nearest limits: the table's edge at Y -210; the table's edge at Y 210; ")


def test_the_table_that_counts_is_told_and_a_zero_beyond_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    machine, command = tmp_path / "small.toml", ["place", HUB, "--tool-length", "100", "--turn", "0", "--machine"]
    machine.write_text('extends = "yl569"\n[facts]\ntable_size_mm = [9, 8]\ntable_centre_mm = [100, 90]\n', "utf-8")
    assert main([*command, str(machine)]) == 0
    told = (
        "the zero is beyond the table, the definition's, 9 x 8 mm, its middle at X100.000 Y90.000: give stock or part"
    )
    assert told in capsys.readouterr().out
    assert main([*command, "yl569"]) == 0
    assert "table" not in capsys.readouterr().out


def test_a_program_with_other_rotary_positions_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The contour is cut upright: a tilt by 10 degrees is B 10 with C 135, or B -10 with C 315."""
    program = tmp_path / "placed.mpf"
    command = ["place", CONTOUR, "--machine", "yl569", "--tool-length", "120", "--zero", "0,0,0"]
    assert main([*command, "--tilt", "-10", "--turn", "45", "--apply", str(program)]) == 0
    out = capsys.readouterr().out
    assert "  C 135.000 to 135.000 degrees" in out
    assert "B-10. C315." in program.read_text("utf-8")
    at_feed = "at feed C 315.000 to 315.000, B -10.000 to -10.000 degrees: 93.70"
    assert f"  the program takes other rotary positions, {at_feed}" in out
    present = "present zero 0.000,0.000,0.000, turned 0 degrees: 98.352 mm to the limits; the best place, tilted -10"
    assert f"  {present} degrees about X, then turned 45 degrees, has 4.647 mm less" in out
    assert main([*command, "--turn", "0", "--apply", str(program)]) == 0
    out = capsys.readouterr().out
    assert "other rotary positions" not in out
    assert "98.352 mm to the limits; the best place has the same" in out


def test_a_program_that_is_converted_still_says_how_the_part_is_clamped(tmp_path: Path) -> None:
    program, other = tmp_path / "placed.mpf", tmp_path / "other.h"
    machine = ["--machine", "yl569", "--tool-length", "90"]
    assert main(["place", BLADE, *machine, "--turn", "30", "--apply", str(program)]) == 0
    assert main(["convert", str(program), "--machine", "yl569", "--to-machine", "dmu65", "--output", str(other)]) == 0
    head = other.read_text("utf-8").splitlines()[:4]
    assert head[1].endswith("; PART TURNED 30 DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z")
    assert not any("WORKPIECE ZERO" in line for line in head)


def test_a_zero_that_begins_below_nothing_needs_no_equals_sign(capsys: pytest.CaptureFixture[str]) -> None:
    for zero in (["--zero", "-31,0,-77.5"], ["--zero=-31,0,-77.5"]):
        assert main(["place", HUB, "--machine", "yl569", "--tool-length", "120", "--turn", "0", *zero]) == 0
        assert "present zero -31.000,0.000,-77.500" in capsys.readouterr().out


def test_a_simulation_wants_the_angles_of_the_head(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, machine = tmp_path / "turned.mpf", ["--machine", "yl569"]
    angles = ["--turn", "45", "--tilt", "-10"]
    assert main(["place", HUB, *machine, "--tool-length", "120", *angles, "--apply", str(program)]) == 0
    capsys.readouterr()
    body = ["--stock", "box:80,40,40,-10,-20,-40", "--tool", "2=ball:8,length=80,flutes=40", "--cell", "4"]
    main(["simulate", str(program), *machine, *body])
    told = capsys.readouterr().err
    said = "its head says that the part is tilted by -10 degrees about X and turned by 45 degrees about Z"
    assert f"turned.mpf: warning: {said}; give the turn 45 and the tilt -10" in told
    assert "[PLC230]" in told
    main(["simulate", str(program), *machine, *body, *angles])
    printed = capsys.readouterr()
    assert "PLC230" not in printed.err
    assert "it is clamped tilted -10 degrees about X, then turned 45 degrees about Z" in printed.out
    main(["simulate", str(program), *machine, *body, *angles, "--zero", "0,0,0", "--tool-length", "100"])
    assert "tool length of 120 mm" in capsys.readouterr().err


def test_an_nc_program_that_is_to_be_applied_is_refused_before_it_is_placed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, out = "tests/golden/yl569/2_hub_rough.expected.mpf", tmp_path / "placed.mpf"
    data = tmp_path / "placed.json"
    command = ["place", program, "--machine", "yl569", "--tool-length", "0", "--turn", "0"]
    assert main([*command, "--apply", str(out), "--json", str(data)]) == 2
    printed = capsys.readouterr()
    assert "PLC140" in printed.err
    assert printed.out == ""
    assert not out.exists()
    assert not data.exists()
    assert main([*command, "--json", str(data)]) == 0


def test_turns_that_were_asked_for_are_told_from_those_around_the_best(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = tmp_path / "placed.json"
    assert main(["place", HUB, "--machine", "yl569", "--tool-length", "0", "--turns", "90", "--json", str(data)]) == 0
    line = next(line for line in capsys.readouterr().out.splitlines() if "it fits at" in line)
    turns = json.loads(data.read_text("utf-8"))["turns"]
    more = [turn for turn in turns if not turn["asked"]]
    assert [turn["turn_deg"] for turn in turns if turn["asked"]] == [0.0, 90.0, 180.0, 270.0]
    assert more
    fits = sum(turn["fits"] for turn in more)
    assert line == f"  it fits at 4 of the 4 turns asked for; around the best, {len(more)} more were tried, {fits} fit"


#: One machine of each family of controls.
FAMILIES = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")


@pytest.mark.third
@pytest.mark.parametrize("source", FAMILIES)
def test_what_is_converted_from_a_placed_program_says_how_the_part_is_clamped_and_no_more(
    tmp_path: Path, source: str
) -> None:
    program = tmp_path / "placed.nc"
    trunnion.post(
        HUB, machine=source, output=program, turn=30.5, tilt=-10.0, force=True,
        settings={"zero": (1.0, 2.0, -33.25), "tool_length": 100.0},
    )  # fmt: skip
    assert stated_place(program) == HeadNotices(Clamping(30.5, -10.0), (1.0, 2.0, -33.25), 100.0)
    for machine in FAMILIES:
        other = tmp_path / f"{machine}.nc"
        trunnion.convert(program, machine=source, to_machine=machine, output=other, force=True)
        assert stated_place(other) == HeadNotices(Clamping(30.5, -10.0))
        text = other.read_text("utf-8")
        assert text.count("PART TURNED") == text.count("PART TILTED") == 1
        assert "WORKPIECE ZERO X" not in text
        assert "ZERO FOR TOOL LENGTH" not in text
    cl = tmp_path / "back.cls"
    trunnion.convert(program, machine=source, to_cl=True, output=cl, force=True)
    lines = cl.read_text("utf-8").splitlines()
    assert [line[:14] for line in lines if "PART T" in line] == ["$$ PART TILTED", "$$ PART TURNED"]
    assert not any("WORKPIECE ZERO" in line or "ZERO FOR" in line for line in lines)
