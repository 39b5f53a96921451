"""``trunnion.simulate``: fixtures, the machine's bodies, and where they are."""

import math
from pathlib import Path

import pytest

import trunnion
from tests.support.simulating import SLOT, cuboid, simulate
from trunnion.cli.simulate import simulation_lines
from trunnion.jobs.simulate.report import simulation_content
from trunnion.machines import load_machine
from trunnion.reporting.simulation_page import render_simulation_page
from trunnion.results import to_data
from trunnion.simulation.meshes import save_mesh

#: Why the machine is not checked where blocks name its positions.
AT_MACHINE = "where blocks name positions of the machine: no gauge point stated"

#: The slot for a control of the YL569.
SLOT_OF_YL569 = (
    "G17 G40 G90 G710 G94\nTRAFOOF\nT=1\nM6\nG54\nG0 X-20 Y0 Z20 D1 S1000 M3\nZ-5\nG1 X70 F500\nG0 Z20\nM30\n"
)


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
    (deeper,) = simulate(tmp_path, later.replace("N70 G0 X-20", "N70 X60 Z-8"), fixtures=higher, until=80).findings
    # The machine stops where they touch first, not where it would be deepest.
    assert (deeper.first_block, deeper.block, deeper.last_block) == (60, 70, 70)
    assert deeper.stretch == f"from N60 (line {deeper.first_line}) to line {deeper.last_line}"
    assert deeper.first_line < deeper.line
    assert found.remarks[-1].what.startswith("the bodies of the machine are not checked")


def test_the_bodies_of_the_machine_are_checked_where_it_is_known_where_they_are(tmp_path: Path) -> None:
    names = {body.name for body in trunnion.load_machine("xyzac_trt").bodies}
    unknown = simulate(tmp_path, SLOT)
    (tmp_path / "own.toml").write_text('extends = "xyzac_trt"\n[spindle]\ngauge_point_mm = [0, 0, 0]\n')
    sunk = simulate(tmp_path, SLOT, zero="0,0,-60", machine=tmp_path / "own.toml")
    told = "the bodies of the machine are not checked"
    assert sum(told in remark.what for remark in unknown.remarks) == 1
    assert not [remark for remark in sunk.remarks if told in remark.what]
    assert {one.between[0] for one in sunk.findings if one.kind == "collision"} & names
    unstated = simulate(tmp_path, SLOT, zero="0,0,-60")
    assert {one.between[0] for one in unstated.findings if one.kind == "collision"} & names
    assert not any("spindle.gauge_point_mm" in remark.what for remark in unstated.remarks)


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


def test_a_machine_position_across_the_tool_in_the_stock_is_an_error(tmp_path: Path) -> None:
    program = SLOT.replace("N70 G0 Z20", "N65 G1 X20\nN70 G53 G0 X20 Y60\nN80 G53 G0 Z0")
    found = simulate(tmp_path, program)
    assert not found.passed
    assert [one.line for one in found.remarks if "across the tool axis" in one.what] == [9]
    assert simulate(tmp_path, SLOT.replace("N70 G0 Z20", "N70 G53 G0 Z0\nN80 G53 G0 X0 Y0")).passed
    stated = load_machine("xyzac_trt", {"spindle": {"gauge_point_mm": [0, 0, 0]}})
    known = simulate(tmp_path, program, machine=stated, zero="0,0,-100", tool_length=60)
    assert ("rapid through stock", 70) in {(one.kind, one.block) for one in known.findings}


def test_a_swivel_beside_the_stock_needs_the_zero(tmp_path: Path) -> None:
    program = SLOT.replace("N70 G0 Z20", "N70 G0 Z10\nN75 G0 A30\nN78 G0 A0\nN80 G0 Z20")
    found = simulate(tmp_path, program)
    assert [one.line for one in found.remarks if "turns rotary axes without TCP" in one.what] == [9]
    assert not found.passed
    assert not found.findings  # none is invented
    home = SLOT.replace("N70 G0 Z20", "N70 G53 G0 Z0\nN75 G0 A30\nN78 G0 A0")
    assert simulate(tmp_path, home).passed


def test_fixtures_are_called_by_their_files(tmp_path: Path) -> None:
    clamp = cuboid((55, -5, -20), (65, 5, -3))
    (tmp_path / "other").mkdir()
    for name in ("vice.stl", "jaw.stl", "other/jaw.stl"):
        save_mesh(clamp, tmp_path / name)
    files = [tmp_path / name for name in ("vice.stl", "jaw.stl", "other/jaw.stl")]
    found = simulate(tmp_path, SLOT, fixtures=[*files, clamp], cell=1.0)
    assert {one.between[0] for one in found.findings} == {
        "fixture vice.stl", "fixture 2 jaw.stl", "fixture 3 jaw.stl", "fixture 4",
    }  # fmt: skip


def test_what_is_sunk_in_the_table_is_a_warning_without_a_gauge_point(tmp_path: Path) -> None:
    """The rotary table of the YL569 ends at Z -50 of the machine, its cradle is at Z -230 to -115."""
    vice = cuboid((-60, -30, -45), (60, 30, -15))
    given: dict[str, object] = {"machine": "yl569", "tool_length": 110, "fixtures": vice}

    def sunk(zero: str, **more: object) -> list[str]:
        found = simulate(tmp_path, SLOT_OF_YL569, **(given | more), zero=zero)
        assert found.not_checked in ((), (AT_MACHINE,))
        return [each.what for each in found.remarks if each.code == "SIM313"]

    assert sunk("0,0,-5") == []  # it stands on the table
    assert sunk("0,0,-5.05") == []
    (low,) = sunk("0,0,-7")
    assert low == "is 2.0 mm deep inside of rotary table, a body of the machine"
    assert len(sunk("0,0,-160")) == 2  # the stock is in the cradle as well
    assert len(sunk("0,0,-160", fixtures=[])) == 1


def test_the_verdict_says_that_collisions_with_the_machine_were_not_checked(tmp_path: Path) -> None:
    folder = Path("examples/simulation")
    unstated = trunnion.simulate(
        folder / "plate_top.mpf", machine="yl569", stock="box:100,80,30,-50,-40,-30", zero=(0, 0, -20),
        tool_libraries=[folder / "tools.toml"], tool_length=110, cell=1.0,
    )  # fmt: skip
    assert unstated.passed
    why = f"collisions with the machine: not checked ({AT_MACHINE})"
    stands_on = (
        "not all was judged (SIM146); stands on 10 values nobody measured; assumed: the control starts with CYCLE800()"
    )
    assert unstated.verdict == f"nothing found; {why}; {stands_on}"
    assert list(simulation_lines(unstated))[-1] == f"Passed in part: {unstated.verdict}"
    page = b"".join(render_simulation_page(simulation_content(unstated))).decode()
    assert page.count(why) == 1
    assert "Nothing was found." in page
    assert to_data(unstated)["not_checked"] == [AT_MACHINE]
    unknown = simulate(tmp_path, SLOT)
    assert "not checked (workpiece zero or tool length not stated); " in unknown.verdict


@pytest.mark.parametrize("project", ["examples/project/part.toml", "examples/simulation/plate.toml"])
def test_the_example_stands_on_the_table_and_is_checked_with_the_machine(project: str) -> None:
    found = trunnion.simulate(project)
    assert found.verdict.startswith("nothing found; stands on 13 values nobody measured; assumed: ")
    assert (found.remarks, found.not_checked) == ((), ())


def test_a_shank_as_thick_as_its_flutes_rubs_along_a_wall_that_a_pass_before_has_left(tmp_path: Path) -> None:
    deeper = SLOT.replace("N70", "G0 Z20\nG0 X-20\nG0 Z-9\nN65 G1 X70\nN70")
    found = simulate(tmp_path, deeper, tools=["1=flat:10,length=60,flutes=6"])
    assert found.passed
    assert near_stock(found) == [("shank of tool 1", 65, 0.0)]
    assert found.near[0].place[2] == pytest.approx(-1.5, abs=1.5)
    assert "rubs" in str(found.near[0])
    assert "rubs" in found.verdict
    trunnion.write_report(found, tmp_path / "rubs.html")
    page = (tmp_path / "rubs.html").read_text(encoding="utf-8")
    assert "<td class=n></td><th scope=row>rubs</th>" in page
    assert "nothing found but 1 place where a shank rubs" in page.lower()
    again = simulate(tmp_path, deeper, tools=["1=flat:10,length=60,flutes=6"], near=2.0)
    assert [one[1:] for one in near_stock(again) if one[1] == 65] == [(65, 0.0)]
    for other in ("flutes=6,shank=9.8", "flutes=6,neck=9.8,shank=10,neck_length=9", "flutes=9"):
        assert not near_stock(simulate(tmp_path, deeper, tools=[f"1=flat:10,length=60,{other}"]))
    (one,) = simulate(tmp_path, SLOT.replace("Z-5", "Z-9"), tools=["1=flat:10,length=60,flutes=6"]).findings
    assert one.kind == "shank into stock"
    wider = deeper.replace("N60 G1 X70 F500", "N60 G1 X70 F500\nG1 Y1\nX-20\nY-1\nX70\nY0")
    assert not near_stock(simulate(tmp_path, wider, tools=["1=flat:10,length=60,flutes=6"]))
