"""``trunnion.simulate``: programs that cut stock, and what they do that they must not."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.sweeps import CUBE, CUBE_FACES
from trunnion.cli import main
from trunnion.simulation.meshes import TriangleMesh, load_mesh, save_mesh
from trunnion.simulation.tool_deltas import as_the_tool_goes

HEAD = "G21 G90 G17 G40 G49 G80\nT1 M6\nG43 H1\nS1000 M3\nG0 X-20 Y0 Z20\n"
SLOT = HEAD + "N50 G0 Z-5\nN60 G1 X70 F500\nN70 G0 Z20\nM5\nM30\n"
STOCK = "box:50,40,10,0,-20,-10"
TOOL = "1=flat:10,length=60,flutes=20,holder=40x50"


def simulate(tmp_path: Path, program: str, **arguments: object) -> trunnion.SimulationResult:
    nc = tmp_path / "part.ngc"
    nc.write_text(program)
    given: dict[str, object] = {"machine": "xyzac_trt", "stock": STOCK, "tools": [TOOL], "cell": 0.5} | arguments
    return trunnion.simulate(nc, **given)  # type: ignore[arg-type]


def cuboid(low: tuple[float, float, float], high: tuple[float, float, float]) -> TriangleMesh:
    return TriangleMesh(np.array(low) + CUBE * (np.array(high) - np.array(low)), CUBE_FACES)


def slotted(depth: float) -> TriangleMesh:
    """The stock with a slot of 10 mm along X: three boxes that touch."""
    boxes = [
        cuboid((0, -20, -10), (50, -5, 0)), cuboid((0, 5, -10), (50, 20, 0)), cuboid((0, -5, -10), (50, 5, -depth)),
    ]  # fmt: skip
    vertices = np.concatenate([box.vertices for box in boxes])
    return TriangleMesh(vertices, np.concatenate([box.faces + 8 * k for k, box in enumerate(boxes)]))


def test_a_slot_is_cut_and_nothing_is_wrong(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT)
    assert found.passed
    assert found.removed == pytest.approx(2500.0, rel=1e-3)
    (operation,) = found.operations
    assert (operation.tool, operation.air, operation.findings) == ("1", 0.0, 0)


def test_the_volume_of_each_block_and_minute_is_told(tmp_path: Path) -> None:
    halves = SLOT.replace("N60 G1 X70 F500\n", "N60 G1 X30 F500\nG1 X70 F250\n")
    found = simulate(tmp_path, halves)
    (operation,) = found.operations
    blocks = operation.blocks
    assert blocks.line.tolist() == [7, 8]
    # The first block removes what is before the cutter's middle at X30 and the half circle before it.
    first = 5.0 * (300.0 + math.pi * 25.0 / 2.0)
    np.testing.assert_allclose(blocks.removed, [first, 2500.0 - first], rtol=5e-3)
    np.testing.assert_allclose(blocks.rate, blocks.removed / [50.0 / 500.0, 40.0 / 250.0], rtol=2e-3)
    assert blocks.removed.sum() == pytest.approx(operation.removed, rel=1e-12)
    data = tmp_path / "found.json"
    found.write_report(data)
    told = json.loads(data.read_text())["operations"][0]["blocks"]
    assert (told["line"], len(told["removed_mm3"]), len(told["mm3_per_min"])) == ([7, 8], 2, 2)


@pytest.mark.parametrize(
    ("program", "kind", "block", "depth"),
    [
        (SLOT.replace("N60 G1 X70 F500", "N60 G0 X70"), "rapid through stock", 60, 5.0),
        (SLOT.replace("S1000 M3", "S1000"), "cuts with the spindle off", 60, 5.0),
        (SLOT.replace("Z-5", "Z-9.5").replace("Z20\nM5", "Z20\nM5"), None, 60, 9.5),
    ],
    ids=["rapid", "standing", "sound"],
)
def test_what_a_block_must_not_do_is_found(
    tmp_path: Path, program: str, kind: str | None, block: int, depth: float
) -> None:
    found = simulate(tmp_path, program)
    if kind is None:
        assert found.passed
        return
    (finding,) = found.findings
    assert (finding.kind, finding.block, finding.line) == (kind, block, 7)
    assert finding.depth == pytest.approx(depth, abs=0.1)
    assert not found.passed


@pytest.mark.parametrize(
    ("tool", "kind", "depth"),
    [
        ("1=flat:10,length=60,flutes=3", "shank into stock", 2.0),
        ("1=flat:10,length=4,flutes=4,holder=40x50", "holder into stock", 1.0),
    ],
    ids=["flutes", "holder"],
)
def test_what_does_not_cut_meets_the_stock(tmp_path: Path, tool: str, kind: str, depth: float) -> None:
    found = simulate(tmp_path, SLOT, tools=[tool])
    kinds = {finding.kind: finding for finding in found.findings}
    assert kinds[kind].block == 60
    assert kinds[kind].depth == pytest.approx(depth, abs=0.1)


def test_the_part_that_comes_out_is_compared_with_the_design(tmp_path: Path) -> None:
    sound = simulate(tmp_path, SLOT, part=slotted(5.0))
    assert sound.left is not None
    assert sound.gouge is not None
    assert sound.passed
    assert max(sound.left.largest, sound.gouge.largest) <= sound.limit
    gouged = simulate(tmp_path, SLOT, part=slotted(4.6))
    assert gouged.gouge is not None
    assert gouged.gouge.largest == pytest.approx(0.4, abs=0.01)
    assert [(one.kind, one.block) for one in gouged.findings] == [("gouge", 60)]
    assert gouged.findings[0].depth == pytest.approx(0.4, abs=0.01)
    left = simulate(tmp_path, SLOT, part=slotted(6.0))
    assert left.left is not None
    assert left.left.largest == pytest.approx(1.0, abs=0.01)
    assert left.left.volume == pytest.approx(500.0, rel=0.2)
    assert left.passed  # a roughing program leaves material


def test_what_is_gone_altogether_names_the_block_that_took_it(tmp_path: Path) -> None:
    pin = cuboid((30, -2, -10), (32, 2, 0))
    rest = cuboid((0, 12, -10), (50, 20, 0))
    part = TriangleMesh(np.concatenate((pin.vertices, rest.vertices)), np.concatenate((CUBE_FACES, CUBE_FACES + 8)))
    program = SLOT.replace("N50 G0 Z-5", "N50 G0 Z-11").replace("N60 G1 X70 F500", "N55 G1 X12 F500\nN60 G1 X70")
    tool = "1=flat:20,length=60,flutes=20,holder=40x50"
    found = simulate(tmp_path, program, part=part, tools=[tool], cell=1.0)
    assert [(one.kind, one.block) for one in found.findings] == [("gouge", 60)]
    x, y, z = found.findings[0].place
    assert 30.0 < x < 32.0
    assert -2.0 < y < 2.0
    assert -10.0 < z < 0.0
    assert found.findings[0].depth == pytest.approx(2.0, abs=0.1)


KLARTEXT = (
    "0 BEGIN PGM PART MM\n1 TOOL CALL 1 Z S3000 DL+0.5\n2 L X-20 Y+0 R0 FMAX M3\n3 L Z+20 FMAX\n4 L Z-5 FMAX\n"
    "5 L X+70 F500\n6 L Z+20 FMAX\n7 M30\n8 END PGM PART MM\n"
)
SINUMERIK = "T1 D1\nM6\nG54 G17 G90\nS3000 M3\nG0 X-20 Y0 Z20\nTOFFL=0.5\nG0 Z-5\nG1 X70 F500\nG0 Z20\nM30\n"


@pytest.mark.parametrize(
    ("program", "machine", "removed", "told"),
    [
        (KLARTEXT, "dmu65", 2250.0, ""),
        (KLARTEXT.replace("DL+0.5", "DL-0.5 DR+0.1"), "dmu65", 2750.0, ""),
        (
            KLARTEXT.replace("DL+0.5", "DR+0.5").replace("X+70", "X+70 RL"),
            "dmu65",
            None,
            "DR adds 0.5 mm to the radius",
        ),
        (SINUMERIK, "yl569", 2250.0, ""),
        (SINUMERIK.replace("TOFFL", "TOFF[3]"), "yl569", None, "TOFF moves the tool by 0.5 mm"),
        (SLOT.replace("N50", "G43.2 Z0.5\nN50"), "xyzac_trt", None, "G43.2 Z moves the tool by 0.5 mm"),
        (SLOT.replace("G43 H1", "G43 H5"), "xyzac_trt", 2500.0, "is taken for its own length"),
    ],
    ids=["DL", "DL and DR", "DR compensated", "TOFFL", "TOFF", "G43.2", "H5"],
)
def test_what_a_program_adds_to_its_tool_is_simulated_or_refused(
    tmp_path: Path, program: str, machine: str, removed: float | None, told: str
) -> None:
    found = simulate(tmp_path, program, machine=machine)
    assert found.passed is (removed is not None)
    assert not [one for one in found.remarks if "path is that without it" in one.what and removed and "DL" in one.what]
    if removed is not None:
        assert found.removed == pytest.approx(removed, rel=1e-3)
    assert [told in one.what for one in found.remarks if told and told in one.what] == ([True] if told else [])


def test_the_length_of_another_tool_is_an_error(tmp_path: Path) -> None:
    tools = [TOOL, TOOL.replace("1=", "5=", 1)]
    two = SLOT.replace("G43 H1", "G43 H5").replace("M5\nM30", "T5 M6\nG49\nM30")
    found = simulate(tmp_path, two, tools=tools, cell=1.0)
    assert [one.line for one in found.remarks if "cuts with the length of tool 5" in one.what] == [7]
    assert not found.passed


def test_a_length_goes_along_the_tool_and_not_into_machine_positions(tmp_path: Path) -> None:
    program = "T1 D1\nM6\nG54 G90\nS3000 M3\nSUPA G0 Z0\nTRAORI\nG0 X0 Y0 Z50 B30 C0\nTOFFL=2\nG1 Z10 F500\nM30\n"
    nc = tmp_path / "part.mpf"
    nc.write_text(program)
    run = trunnion.read_program(nc, machine="yl569")
    longer, problems = as_the_tool_goes(run)
    assert not problems
    moved = longer.tip - run.tip
    assert moved[-1] == pytest.approx(2.0 * run.axis[-1])
    assert abs(run.axis[-1][2]) < 0.9
    assert not moved[:-1].any()


def test_the_time_of_a_finding_is_that_of_its_place(tmp_path: Path) -> None:
    (standing,) = simulate(tmp_path, SLOT.replace("S1000 M3", "S1000")).findings
    whole = simulate(tmp_path, SLOT).operations[0].seconds
    x, y, _ = standing.place
    there = (x - math.sqrt(25.0 - y * y) + 20.0) / 90.0  # of the block, when the tool of 10 mm first covers the place
    begin = standing.seconds - there * 90.0 / 500.0 * 60.0
    assert 0.0 < begin < whole - 90.0 / 500.0 * 60.0  # there are rapids before and after
    assert there < 0.8
    clamp = cuboid((55, -5, -20), (65, 5, -3))
    hit = next(one for one in simulate(tmp_path, SLOT, fixtures=clamp).findings if one.kind == "collision")
    assert begin + 0.7 * 10.8 < hit.seconds < begin + 10.8


def near_stock(found: trunnion.SimulationResult) -> list[tuple[str, int, float]]:
    return [(one.between[0], one.block, one.distance) for one in found.near if one.between[1] == "stock"]


def test_shank_and_holder_near_the_stock_are_told(tmp_path: Path) -> None:
    over = "1=flat:10,length=6.5,flutes=6.5,holder=40x50"  # 1.5 mm above the top
    found = simulate(tmp_path, SLOT, tools=[over], near=2.0)
    ((body, block, distance),) = near_stock(found)
    assert (body, block) == ("holder of tool 1", 60)
    assert distance == pytest.approx(1.5, abs=0.06)
    assert found.passed
    (one,) = [each for each in found.near if each.between[1] == "stock"]
    assert one.place[2] == pytest.approx(0.0, abs=0.6)
    assert not near_stock(simulate(tmp_path, SLOT, tools=[over], near=1.4))
    again = SLOT.replace("Z-5", "Z-2.5").replace("N70", "G0 Z20\nG0 X-20\nG0 Z-5\nN65 G1 X70\nN70")
    thick = "1=flat:10,length=60,flutes=3,shank=8"  # in the slot, 1 mm from its walls
    beside = simulate(tmp_path, again, tools=[thick], near=2.0)
    assert beside.passed
    *_, (body, block, distance) = near_stock(beside)
    assert (body, block) == ("shank of tool 1", 65)
    assert distance == pytest.approx(1.0, abs=0.06)
    touching = simulate(tmp_path, SLOT, tools=["1=flat:10,length=4,flutes=4,holder=40x50"], near=2.0)
    assert {one.kind for one in touching.findings} == {"holder into stock"}
    assert not [one for one in near_stock(touching) if one[1] == 60]


def test_a_fixture_is_hit_and_come_near_to(tmp_path: Path) -> None:
    clamp = cuboid((55, -5, -20), (65, 5, -6))
    beside = simulate(tmp_path, SLOT, fixtures=[clamp], near=2.0)
    assert beside.passed
    assert [(one.block, round(one.distance, 3)) for one in beside.near] == [(60, 1.0)]
    assert beside.near[0].between == ("fixture 1", "cutter of 1")
    higher = cuboid((55, -5, -20), (65, 5, -3))
    found = simulate(tmp_path, SLOT, fixtures=higher, stop_at="first")
    (finding,) = found.findings
    assert (finding.kind, finding.block, finding.between) == ("collision", 60, ("fixture 1", "cutter of 1"))
    assert [one.findings for one in found.operations] == [1]
    assert found.pairs == 3  # with cutter, shank and holder
    later = SLOT.replace("N70 G0 Z20", "N70 G0 X-20\nN80 G0 Y15\nN90 G0 X70\nN95 G0 Z20")
    stopped = simulate(tmp_path, later, fixtures=higher, stop_at="first")
    assert [one.block for one in stopped.findings] == [60]
    assert 90 in {one.block for one in simulate(tmp_path, later, fixtures=higher).findings}
    (until,) = simulate(tmp_path, later.replace("N70 G0 X-20", "N70 Z-8"), fixtures=higher, until=70).findings
    assert (until.block, until.last_block) == (60, 60)  # what comes later is not simulated, however deep it goes
    assert finding.depth == pytest.approx(2.0, abs=0.1)
    assert found.remarks[-1].what.startswith("the bodies of the machine are not checked")


def test_the_bodies_of_the_machine_are_checked_where_it_is_known_where_they_are(tmp_path: Path) -> None:
    names = {body.name for body in trunnion.load_machine("xyzac_trt").bodies}
    unknown = simulate(tmp_path, SLOT)
    (tmp_path / "own.toml").write_text('extends = "xyzac_trt"\n[spindle]\ngauge_point_mm = [0, 0, 0]\n')
    sunk = simulate(tmp_path, SLOT, zero="0,0,-60", machine=tmp_path / "own.toml")
    told = "the bodies of the machine are not checked"
    assert [told in remark.what for remark in unknown.remarks] == [True]
    assert not [remark for remark in sunk.remarks if told in remark.what]
    assert {one.between[0] for one in sunk.findings if one.kind == "collision"} & names
    unstated = simulate(tmp_path, SLOT, zero="0,0,-60")
    assert not {one.between[0] for one in unstated.findings if one.kind == "collision"} & names
    assert any("has no spindle.gauge_point_mm" in remark.what for remark in unstated.remarks)


@pytest.mark.parametrize(("given", "missing"), [({}, "workpiece zero"), ({"zero": "0,0,0"}, "tool length of the run")])
def test_machine_positions_that_cannot_be_placed_are_told(tmp_path: Path, given: dict[str, str], missing: str) -> None:
    program = SLOT.replace("N70 G0 Z20\n", "N70 G0 Z20\nG53 G0 Z0\n")
    told = f"retracts along the tool axis: the {missing} is not known"
    assert any(told in remark.what for remark in simulate(tmp_path, program, **given).remarks)
    placed = simulate(tmp_path, program, zero="0,0,0", tool_length="110")
    assert not any("retracts along the tool axis" in remark.what for remark in placed.remarks)


def test_a_stock_outside_of_the_travel_is_told(tmp_path: Path) -> None:
    machine = trunnion.load_machine("xyzac_trt")
    low = next(axis.low for axis in machine.axes if axis.name == "X")
    told = "beyond the travel of X: its corners need"
    inside = simulate(tmp_path, SLOT, zero=f"{low},0,0")
    assert not any(told in remark.what for remark in inside.remarks)
    outside = simulate(tmp_path, SLOT, zero=f"{low - 7.0},0,0")
    (remark,) = (each for each in outside.remarks if told in each.what)
    assert "reaches 7.000 mm" in remark.what
    assert f"need {low - 7.0:.3f} to {low + 43.0:.3f}" in remark.what


def test_it_ends_after_the_first_finding_or_before_a_block(tmp_path: Path) -> None:
    program = SLOT.replace("N70 G0 Z20", "N70 G0 Y15\nN80 G0 X-20\nN90 G0 Z20")
    whole = simulate(tmp_path, program)
    first = simulate(tmp_path, program, stop_at="first")
    assert [one.block for one in whole.findings] == [80]
    assert first.simulation.stopped is not None
    assert first.removed == pytest.approx(whole.removed)
    before = simulate(tmp_path, program, until="N60")
    assert before.removed == 0.0
    with pytest.raises(trunnion.InputError, match="no block N7777"):
        simulate(tmp_path, program, until="N7777")


def steps(word: str, depth: float) -> str:
    """The slot in steps of 0.09 mm."""
    way = "\n".join(f"{word} X{-20 + 0.09 * k:.3f}" for k in range(1, 1001))
    return HEAD + f"N50 G1 Z-{depth} F500\n{way}\nG0 Z20\nM5\nM30\n"


@pytest.mark.parametrize(
    ("program", "kind", "depth"),
    [
        (steps("G0", 5.0), "rapid through stock", 5.0),
        (steps("G1", 5.0).replace("S1000 M3", "S1000"), "cuts with the spindle off", 5.0),
        (steps("G1", 5.25), "gouge", 0.25),
    ],
    ids=["rapid", "standing", "gouge"],
)
def test_small_steps_hide_nothing(tmp_path: Path, program: str, kind: str, depth: float) -> None:
    found = simulate(tmp_path, program, part=slotted(5.0))
    (finding,) = [one for one in found.findings if one.kind == kind]
    assert finding.depth == pytest.approx(depth, abs=0.02)
    assert finding.line > 100
    first = simulate(tmp_path, program, part=slotted(5.0), stop_at="first")
    assert 0.0 < first.removed < 0.5 * found.removed


def test_a_machine_position_across_the_tool_in_the_stock_is_an_error(tmp_path: Path) -> None:
    program = SLOT.replace("N70 G0 Z20", "N65 G1 X20\nN70 G53 G0 X20 Y60\nN80 G53 G0 Z0")
    found = simulate(tmp_path, program)
    assert not found.passed
    assert [one.line for one in found.remarks if "across the tool axis" in one.what] == [9]
    assert simulate(tmp_path, SLOT.replace("N70 G0 Z20", "N70 G53 G0 Z0\nN80 G53 G0 X0 Y0")).passed
    known = simulate(tmp_path, program, zero="0,0,-100", tool_length=60)
    assert ("rapid through stock", 70) in {(one.kind, one.block) for one in known.findings}


def test_a_swivel_beside_the_stock_needs_the_zero(tmp_path: Path) -> None:
    program = SLOT.replace("N70 G0 Z20", "N70 G0 Z10\nN75 G0 A30\nN78 G0 A0\nN80 G0 Z20")
    found = simulate(tmp_path, program)
    assert [one.line for one in found.remarks if "turns rotary axes without TCP" in one.what] == [9]
    assert not found.passed
    assert not found.findings  # none is invented
    home = SLOT.replace("N70 G0 Z20", "N70 G53 G0 Z0\nN75 G0 A30\nN78 G0 A0")
    assert simulate(tmp_path, home).passed


@pytest.mark.parametrize(
    "program",
    [SLOT.replace("N50", "T1 M6\nG43 H1\nN50"), SLOT.replace("S1000 M3", "S0 M3"), SLOT.replace("S1000 M3", "M3")],
    ids=["change", "zero", "no speed"],
)
def test_a_spindle_that_stands_is_found(tmp_path: Path, program: str) -> None:
    assert {(one.kind, one.block) for one in simulate(tmp_path, program).findings} == {
        ("cuts with the spindle off", 60)
    }


def test_a_program_that_never_touches_the_stock_says_so(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT.replace("Y0", "Y100"))
    assert [one for one in found.remarks if "takes nothing from the stock" in one.what]


def test_a_tool_length_that_is_left_out_is_an_error(tmp_path: Path) -> None:
    two = SLOT.replace("M5\nM30", "T2 M6\nS1000 M3\nG0 X-20 Y10 Z-3\nN95 G1 X70\nG0 Z20\nM5\nM30")
    tools = [TOOL, TOOL.replace("1=", "2=", 1)]
    forgotten = simulate(tmp_path, two, tools=tools)
    assert not forgotten.passed
    assert [one for one in forgotten.remarks if "with the length of tool 1" in one.what]
    off = simulate(tmp_path, two.replace("T2 M6", "G49\nT2 M6"), tools=tools)
    assert [one for one in off.remarks if "without a tool length" in one.what]
    assert simulate(tmp_path, two.replace("T2 M6", "T2 M6\nG43 H2"), tools=tools).passed
    (never,) = [one for one in simulate(tmp_path, SLOT.replace("G43 H1\n", "")).remarks if "length:" in one.what]
    assert (never.line, never.severity) == (6, "error")
    sinumerik = "G710 G90 G54\nT1 M6\nD{}\nS1000 M3\nG0 X-20 Y0 Z20\nG0 Z-5\nG1 X70 F500\nG0 Z20\nM30\n"
    assert not simulate(tmp_path, sinumerik.format(0), machine="yl569").passed
    assert simulate(tmp_path, sinumerik.format(1), machine="yl569").passed


def test_meshes_that_are_odd_are_told(tmp_path: Path) -> None:
    small = cuboid((0, 0, 0), (0.05, 0.04, 0.01))
    save_mesh(small, tmp_path / "metres.stl")
    for which in ("stock", "part", "fixtures"):
        with pytest.raises(trunnion.InputError, match="look like metres; export it in mm"):
            simulate(tmp_path, SLOT, **{which: str(tmp_path / "metres.stl")})
    save_mesh(cuboid((0, -20, -10), (50, 20, 0)).turned_out(), tmp_path / "inside.stl")
    turned = simulate(tmp_path, SLOT, stock=tmp_path / "inside.stl")
    assert [one for one in turned.remarks if "inside out" in one.what]
    assert turned.removed == pytest.approx(2500.0, rel=1e-3)


def test_a_tool_that_could_pass_between_the_rays_is_refused(tmp_path: Path) -> None:
    thin = "1=flat:0.6,length=60,flutes=20"
    with pytest.raises(trunnion.InputError, match=r"pass between the rays unseen; take cells of 0\.3 mm"):
        simulate(tmp_path, SLOT, tools=[thin])
    assert max(simulate(tmp_path, SLOT, tools=[thin], cell=None, stock="box:10,4,10,0,-2,-10").cell) <= 0.3


def test_what_the_reader_warns_of_is_told(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT.replace("N60", "G54\nN55 G55\nN60"))
    assert [one for one in found.remarks if "work offset" in one.what]


def test_a_block_before_which_it_ends_may_stand_before_what_runs_earlier(tmp_path: Path) -> None:
    nc = tmp_path / "part.h"
    nc.write_text(
        "0 BEGIN PGM PART MM\n1 TOOL CALL 1 Z S3000\n2 L X-20 Y+0 R0 FMAX M3\n3 L Z+20 FMAX\n4 CALL LBL 1\n"
        "5 L Z+30 FMAX\n6 M30\n7 LBL 1\n8 L Z-5 FMAX\n9 L X+70 F500\n10 L Z+20 FMAX\n11 LBL 0\n12 END PGM PART MM\n"
    )
    found = trunnion.simulate(nc, machine="dmu65", stock=STOCK, tools=[TOOL], cell=0.5, until=5)
    assert found.removed == pytest.approx(2500.0, rel=1e-3)


def test_several_programs_cut_the_same_stock(tmp_path: Path) -> None:
    one, two = tmp_path / "one.ngc", tmp_path / "two.ngc"
    one.write_text(SLOT)
    two.write_text(SLOT.replace("Y0", "Y10"))
    found = trunnion.simulate([one, two], machine="xyzac_trt", stock=STOCK, tools=[TOOL], cell=0.5)
    assert found.removed == pytest.approx(5000.0, rel=1e-3)
    again = trunnion.simulate([one, one], machine="xyzac_trt", stock=STOCK, tools=[TOOL], cell=0.5)
    assert again.operations[1].removed == pytest.approx(0.0, abs=1e-6)
    assert again.air[0].length == pytest.approx(90.0)


def test_a_program_with_an_error_cuts_up_to_there(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT.replace("N60", "N55 G4711\nN60"))
    assert not found.passed
    assert found.removed == 0.0
    assert [remark for remark in found.remarks if "it is cut up to there" in remark.what]


def test_a_file_that_is_no_program_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="is this a program of xyzac_trt"):
        simulate(tmp_path, "".join(f"line {k} of a text\n" for k in range(30)))


@pytest.mark.parametrize(
    ("argument", "value"),
    [("nc", 5), ("nc", []), ("tools", [7]), ("fixtures", 3), ("part", 4), ("cell", -1.0), ("threads", 0)],
)
def test_an_argument_that_is_none_is_named(tmp_path: Path, argument: str, value: object) -> None:
    given: dict[str, object] = {"nc": tmp_path / "part.ngc", "machine": "xyzac_trt", "stock": STOCK, "tools": TOOL}
    (tmp_path / "part.ngc").write_text(SLOT)
    assert trunnion.simulate(**given, cell=1.0).passed  # type: ignore[arg-type]
    with pytest.raises(trunnion.InputError) as raised:
        trunnion.simulate(**given | {argument: value})  # type: ignore[arg-type]
    assert raised.value.problems[0].file == argument


def test_a_tool_is_never_guessed(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="tool 1"):
        simulate(tmp_path, SLOT, tools=[])
    with pytest.raises(trunnion.InputError, match="before it calls a tool"):
        simulate(tmp_path, SLOT.replace("T1 M6\nG43 H1\n", ""))


@pytest.mark.parametrize("stock", ["box:1,2", "box:0,1,1", "box:a,1,1", "cylinder:1,2,3,4", "box:1e9,1,1"])
def test_stock_that_is_none_is_refused(tmp_path: Path, stock: str) -> None:
    with pytest.raises(trunnion.InputError, match=r"write box:X,Y,Z"):
        simulate(tmp_path, SLOT, stock=stock)


def test_a_cell_for_which_there_is_no_memory_is_refused_with_one_that_does(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match=r"cells of 0\.\d+ mm take less than 3 GB"):
        simulate(tmp_path, SLOT, cell=0.0001)


def test_a_cylinder_is_bored(tmp_path: Path) -> None:
    program = HEAD.replace("X-20", "X0") + "N60 G1 Z-12 F500\nN70 G0 Z20\nM5\nM30\n"
    found = simulate(tmp_path, program, stock="cylinder:30,10,-10", cell=0.25)
    assert found.removed == pytest.approx(250.0 * math.pi, rel=0.01)


def test_the_command_says_it_in_text_and_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nc = tmp_path / "part.ngc"
    nc.write_text(SLOT.replace("N60 G1 X70 F500", "N60 G0 X70"))
    given = [str(nc), "--machine", "xyzac_trt", "--stock", STOCK, "--tool", TOOL, "--cell", "0.5"]
    assert main(["simulate", *given, "--json", str(tmp_path / "out.json")]) == 1
    text = capsys.readouterr().out
    data = json.loads((tmp_path / "out.json").read_text())
    assert "part.ngc:7: N60 rapid through stock: tool 1, stock: 5.000 mm deep" in text
    (collision,) = data["collisions"]
    assert (collision["between"], collision["block"], collision["line"]) == (["tool 1", "stock"], 60, 7)
    assert main(["simulate", *given, "--save-stock", str(tmp_path / "left.stl")]) == 1
    assert load_mesh(tmp_path / "left.stl", closed=True).volume == pytest.approx(17500.0, rel=1e-5)
    capsys.readouterr()
    assert data["removed_mm3"] == pytest.approx(2500.0, rel=1e-3)
    one, page = str(tmp_path / "one.json"), tmp_path / "nowhere" / "page.html"
    for twice in (["--report", one, "--json", one], ["--json", str(page)], ["--save-stock", str(nc)]):
        assert main(["simulate", *given, *twice]) == 2
        assert "mm³" not in capsys.readouterr().out  # before anything is computed
    assert not Path(one).exists()
    assert main(["simulate", *given, "--json", "-"]) == 1
    assert json.loads(capsys.readouterr().out)["removed_mm3"] == data["removed_mm3"]


@pytest.mark.parametrize(
    ("stock", "words"),
    [
        ("box:50,40,9.5,0,-20,-10", "reaches 0.500 mm beyond the stock"),
        ("cylinder:70,10,-10", "before anything is cut"),
    ],
)
def test_a_part_that_its_stock_does_not_hold_fails(tmp_path: Path, stock: str, words: str) -> None:
    part = cuboid((-30, -30, -10), (30, 30, 0)) if stock.startswith("cyl") else slotted(5.0)
    found = simulate(tmp_path, SLOT, stock=stock, part=part, until=60, cell=1.0)
    assert not found.passed
    assert [one.file for one in found.remarks if words in one.what] == ["part"]
    with pytest.raises(trunnion.InputError, match="more than half of a cell"):
        simulate(tmp_path, SLOT, accuracy=0.6, cell=1.0)
