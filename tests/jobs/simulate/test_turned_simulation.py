"""``trunnion.simulate`` with a part that is clamped turned and tilted: bodies and places are those of the drawing."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.reports import waves
from tests.support.simulating import SLOT, cuboid, simulate
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.observer import SILENT
from trunnion.jobs.simulate.setups import prepare_setup
from trunnion.machines import load_machine
from trunnion.model.clamping import Clamping
from trunnion.model.columns import StepColumn
from trunnion.simulation.meshes import box_mesh
from trunnion.simulation.setup_findings import SimulationFinding
from trunnion.simulation.turned_parts import run_of_drawn_part

#: The slot of ``SLOT`` goes along X of the machine. A part that is turned by 90 degrees has it along its own -Y.
DRAWN = "box:40,50,10,-20,-50,-10"


def test_a_slot_along_x_of_the_machine_is_along_y_of_a_part_that_is_turned_by_a_quarter(tmp_path: Path) -> None:
    clamp = cuboid((-5, -65, -20), (5, -55, -3))  # as drawn; on the machine at X 55 to 65
    found = simulate(tmp_path, SLOT, stock=DRAWN, fixtures=clamp, turn=90.0)
    assert found.removed == pytest.approx(2500.0, rel=1e-3)
    (hit,) = found.findings
    assert (hit.kind, hit.block, hit.between) == ("collision", 60, ("fixture 1", "cutter of 1"))
    assert hit.depth == pytest.approx(2.0, abs=0.1)
    x, y, z = hit.place
    assert abs(x) <= 5.0
    assert -65.0 <= y <= -55.0
    assert -5.0 <= z <= -3.0
    assert (found.turn, found.tilt) == (90.0, 0.0)
    straight = simulate(tmp_path, SLOT, stock=DRAWN, fixtures=clamp)
    # Without the turn it goes along the edge of the stock at Y0, where half of it cuts, and not to the clamp.
    assert straight.removed == pytest.approx(40.0 * 5.0 * 5.0, rel=0.01)
    assert not [one for one in straight.findings if one.kind == "collision"]


def test_a_gouge_is_told_where_it_is_in_the_drawing(tmp_path: Path) -> None:
    sunk = box_mesh(np.array([-20.0, -50.0, -10.0]), np.array([20.0, 0.0, -4.5]), "part")  # the slot is 5 deep
    (gouge,) = simulate(tmp_path, SLOT, stock=DRAWN, part=sunk, turn=-270.0, cell=1.0).findings
    assert gouge.kind == "gouge"
    assert gouge.depth == pytest.approx(0.5, abs=0.02)
    assert -50.0 <= gouge.place[1] <= 0.0
    assert -5.0 <= gouge.place[0] <= 5.0


def test_a_tilt_comes_first_and_lifts_the_y_side(tmp_path: Path) -> None:
    """Tilted by 90 degrees about X, +Y of the drawing is up: the slot is cut into its side at Y0, 5 deep to -Y."""
    found = simulate(tmp_path, SLOT, stock="box:50,10,40,0,-10,-20", tilt=90.0)
    assert found.removed == pytest.approx(2500.0, rel=1e-3)
    slot = box_mesh(np.array([0.0, -10.0, -20.0]), np.array([50.0, -4.0, 20.0]), "part")
    gouged = simulate(tmp_path, SLOT, stock="box:50,10,40,0,-10,-20", part=slot, tilt=90.0)
    assert gouged.gouge is not None
    assert gouged.gouge.largest == pytest.approx(1.0, abs=0.02)
    assert gouged.findings[0].place[1] == pytest.approx(-4.5, abs=0.6)
    # Turned after that: what was along X is along Y of the machine, and the slot along X is across it.
    across = simulate(tmp_path, SLOT, stock="box:40,10,50,-20,-10,0", turn=90.0, tilt=90.0)
    assert across.removed == pytest.approx(2500.0, rel=1e-3)


@pytest.mark.parametrize(("turn", "hits"), [(90.0, True), (0.0, False)])
def test_the_head_hits_a_fixture_where_it_is_clamped(tmp_path: Path, turn: float, hits: bool) -> None:
    """A box on the head stands 100 mm before the tip in X, and passes what is clamped at X120 to X130, Y0."""
    (tmp_path / "own.toml").write_text(
        'extends = "xyzac_trt"\n[spindle]\ngauge_point_mm = [0, 0, 0]\n'
        '[[body]]\nname = "nozzle"\nlink = "spindle"\nshape = "box"\n'
        "size_mm = [10, 10, 10]\ncentre_mm = [100, 0, -105]\n"
    )
    drawn = cuboid((-5, -130, -10), (5, -120, 20))  # with a turn of 90 degrees at X120 to X130 of the machine
    found = simulate(
        tmp_path,
        SLOT,
        stock=DRAWN,
        fixtures=drawn,
        turn=turn,
        zero="0,0,100",
        machine=tmp_path / "own.toml",
        cell=2.0,
    )
    pairs = {one.between for one in found.findings if one.kind == "collision"}
    assert (("nozzle", "fixture 1") in pairs or ("fixture 1", "nozzle") in pairs) == hits
    for one in found.findings:
        if "nozzle" in one.between and "fixture 1" in one.between:
            assert -130.0 <= one.place[1] <= -120.0
            assert -5.0 <= one.place[0] <= 5.0


def _operation(steps: list[tuple[float, float, float]], lean: float, toward: float) -> str:
    """A CL file with one tool axis: it comes and goes along it, from 120 mm away, and cuts along ``steps``."""
    i, j = math.sin(lean) * math.cos(toward), math.sin(lean) * math.sin(toward)
    k = math.cos(lean)

    def goto(x: float, y: float, z: float, up: float = 0.0) -> str:
        return f"GOTO/{x + up * i:.6f},{y + up * j:.6f},{z + up * k:.6f},{i:.9f},{j:.9f},{k:.9f}\n"

    first, last = steps[0], steps[-1]
    return (
        "TOOL PATH/CUT,TOOL,D10\nTLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000\n"
        "MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000\n"
        "PAINT/PATH\nLOAD/TOOL,1,ADJUST,1\nSPINDL/RPM,1000,CLW\nRAPID\n"
        + goto(*first, up=120.0)
        + "FEDRAT/MMPM,500.0\n"
        + "".join(goto(*step) for step in steps)
        + "RAPID\n"
        + goto(*last, up=120.0)
        + "END-OF-PATH\n"
    )


def _key(one: SimulationFinding) -> tuple[str, tuple[str, str], int]:
    return one.kind, one.between, one.cl_line


places = st.tuples(st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.floats(-4.0, 1.0))


@settings(
    max_examples=examples(6), deadline=None, phases=[Phase.explicit, Phase.generate],
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)  # fmt: skip
@given(
    turn=st.sampled_from([90.0, -180.0]) | st.floats(-360.0, 360.0),
    tilt=st.just(0.0) | st.floats(-40.0, 40.0),
    steps=st.lists(places, min_size=2, max_size=4),
    lean=st.floats(0.0, 0.3),
    toward=st.floats(-3.0, 3.0),
)
def test_a_turned_program_with_its_angles_does_what_the_unturned_one_does(
    tmp_path: Path, turn: float, tilt: float, steps: list[tuple[float, float, float]], lean: float, toward: float
) -> None:
    cl, plain, turned = tmp_path / "cut.cls", tmp_path / "plain.mpf", tmp_path / "turned.mpf"
    cl.write_text(_operation(steps, lean, toward), "utf-8")
    trunnion.post(cl, machine="yl569", output=plain)
    trunnion.post(cl, machine="yl569", output=turned, turn=turn, tilt=tilt)
    bodies: dict[str, Any] = {
        "machine": "yl569", "stock": "box:30,30,8,-15,-15,-8", "tools": ["1=ball:10,length=60,flutes=4,shank=12"],
        "part": box_mesh(np.array([-15.0, -15.0, -8.0]), np.array([15.0, 15.0, -2.0]), "part"), "cl": cl,
        "fixtures": [cuboid((9, -15, -1), (15, 15, 3))], "cell": 0.5,
    }  # fmt: skip
    one = trunnion.simulate(plain, **bodies)
    other = trunnion.simulate(turned, **bodies, turn=turn, tilt=tilt)
    assert not [each for each in other.remarks if each.code == "PLC230"]
    assert other.removed == pytest.approx(one.removed, rel=2e-3, abs=0.5)
    assert other.simulation.stock.lattice.counts == one.simulation.stock.lattice.counts
    assert one.gouge is not None
    assert other.gouge is not None
    assert other.gouge.largest == pytest.approx(one.gouge.largest, abs=0.02)
    # What only just counts may count in one of them.
    clear = [each for each in one.findings if each.depth > one.limit + 0.05]
    for each in clear:
        same = [its for its in other.findings if _key(its) == _key(each)]
        assert same, each
        # How deep bodies are in each other depends on where the facets of the tool meet those of the fixture.
        assert each.kind == "collision" or min(abs(its.depth - each.depth) for its in same) < 0.1


@settings(max_examples=examples(25), deadline=None)
@given(
    machine=st.sampled_from(["yl569", "xyzac_trt", "xyzbc_trt", "dmu65"]),
    turn=st.floats(-360.0, 360.0),
    tilt=st.floats(-90.0, 90.0),
    zero=st.none() | st.tuples(*[st.floats(-300.0, 300.0)] * 3),
    joints=st.lists(st.lists(st.floats(-90.0, 90.0), min_size=5, max_size=5), min_size=1, max_size=5),
    is_tip=st.booleans(),
)
def test_the_run_past_the_drawn_part_has_the_same_axes_and_its_tips_turned_back(
    machine: str,
    turn: float,
    tilt: float,
    zero: tuple[float, float, float] | None,
    joints: list[list[float]],
    is_tip: bool,
) -> None:
    placed = replace(load_machine(machine), workpiece_zero=zero, tool_length=70.0)
    run = waves(len(joints), machine=placed).run
    slides = [placed.column(name) for name in "XYZ"]
    values = np.array(joints)
    run = replace(run, xyz=values[:, slides], rotary=values[:, list(placed.rotary)])
    if is_tip:
        state = replace(run.state, xyz_is_tip=StepColumn.constant(len(run), 1, np.bool_))
        run = replace(run, xyz=run.tip, state=state)
    found = run_of_drawn_part(run, Clamping(turn, tilt).rotation)
    angle, lean = math.radians(turn), math.radians(tilt)
    x, y, z = found.tip.T
    y, z = y * math.cos(lean) - z * math.sin(lean), y * math.sin(lean) + z * math.cos(lean)
    x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
    np.testing.assert_allclose(np.column_stack((x, y, z)), run.tip, atol=1e-8)
    x, y, z = found.axis.T
    y, z = y * math.cos(lean) - z * math.sin(lean), y * math.sin(lean) + z * math.cos(lean)
    x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
    np.testing.assert_allclose(np.column_stack((x, y, z)), run.axis, atol=1e-12)
    np.testing.assert_allclose(found.joints, run.joints, atol=1e-8)


def test_a_word_of_the_turned_program_makes_known_what_it_names(tmp_path: Path) -> None:
    """After a machine position of Z the tool's height is not known; X and Y of the program do not make it so."""
    program = SLOT.replace("G0 X-20 Y0 Z20\n", "G0 X-20 Y0 Z20\nG53 G0 Z0\nG0 X-20 Y0\nG0 Z20\n")
    straight = simulate(tmp_path, program)
    turned = simulate(tmp_path, program, stock=DRAWN, turn=90.0)
    tilted = simulate(tmp_path, program, stock="box:50,10,40,0,-10,-20", tilt=90.0)
    for found in (turned, tilted):
        assert found.removed == pytest.approx(straight.removed, rel=1e-6)
        assert [(one.code, one.line) for one in found.remarks] == [(one.code, one.line) for one in straight.remarks]


def test_a_circle_is_cut_where_the_part_is_clamped(tmp_path: Path) -> None:
    """A full circle in XY of the program, radius 10 about X25 Y0, 5 deep: a ring of 5 to 15 mm."""
    ring = math.pi * (15.0**2 - 5.0**2) * 5.0
    path = "N50 G0 X15 Y0\nN55 G1 Z-5 F500\nN60 G2 X15 Y0 I10 J0 F500\nN70 G0 Z20\n"
    program = SLOT.replace("N50 G0 Z-5\nN60 G1 X70 F500\nN70 G0 Z20\n", path)
    for angles, stock in (({"turn": 90.0}, DRAWN), ({"tilt": 90.0}, "box:50,10,40,0,-10,-20")):
        assert simulate(tmp_path, program, stock=stock, **angles).removed == pytest.approx(ring, rel=5e-3)


def test_a_post_simulates_the_part_as_it_clamps_it(tmp_path: Path) -> None:
    cl, project = tmp_path / "cut.cls", tmp_path / "part.toml"
    cl.write_text(_operation([(-5.0, 0.0, -2.0), (5.0, 3.0, -3.0)], 0.0, 0.0), "utf-8")
    body = {"stock": "box:30,20,8,-15,-10,-8", "tools": ["1=ball:10,length=60,flutes=40"], "cell": 0.5}
    plain = trunnion.post(cl, machine="yl569", simulation=body).simulation
    turned = trunnion.post(cl, machine="yl569", simulation=body, turn=70.0, tilt=20.0).simulation
    assert plain is not None
    assert turned is not None
    assert turned.removed == pytest.approx(plain.removed, rel=2e-3)
    assert (turned.turn, turned.tilt) == (70.0, 20.0)
    project.write_text(
        'machine = "yl569"\nstock = "box:30,20,8,-15,-10,-8"\ncell_mm = 0.5\n'
        'tools = ["1=ball:10,length=60,flutes=40"]\n'
        'cl = ["cut.cls"]\noutput = "cut.mpf"\nturn_deg = 70\ntilt_deg = 20\n[checks]\nsimulate = "refuse"\n'
    )
    posted = trunnion.post_project(project)
    assert posted.simulation is not None
    assert posted.simulation.removed == pytest.approx(plain.removed, rel=2e-3)
    assert "PART TURNED 70 DEG" in (tmp_path / "cut.mpf").read_text("utf-8")
    again = trunnion.simulate(project)
    assert again.removed == pytest.approx(posted.simulation.removed, rel=1e-9)
    assert not [each for each in again.remarks if each.code == "PLC230"]
    with pytest.raises(trunnion.InputError, match=r"turn_deg is 70, and the part of the post is clamped at 0"):
        trunnion.post(cl, machine="yl569", simulation={"project": project})
    assert trunnion.post(cl, machine="yl569", simulation={"project": project}, turn=70.0, tilt=20.0).passed


def test_cl_files_are_turned_as_the_part_is() -> None:
    given = SetupInput(
        ["tests/golden/yl569/2_hub_rough.expected.mpf"], "yl569", cl="tests/golden/yl569/2_hub_rough.cls", turn=90.0
    )
    drawn = trunnion.read_cl("tests/golden/yl569/2_hub_rough.cls").operations[0].moves
    turned = prepare_setup(given, [], SILENT).toolpaths[0].operations[0].moves
    np.testing.assert_allclose(turned.tip, drawn.tip @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-4)
    np.testing.assert_allclose(turned.axis, drawn.axis @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-9)


def test_angles_that_are_none_and_angles_of_several_set_ups_are_refused(tmp_path: Path) -> None:
    for name, value in (("turn", math.nan), ("turn", 361.0), ("tilt", "5"), ("tilt", True)):
        with pytest.raises(trunnion.InputError, match=name):
            simulate(tmp_path, SLOT, **{name: value})
    with pytest.raises(trunnion.InputError, match="all set-ups"):
        trunnion.simulate("examples/simulation/plate.toml", turn=5.0)


def test_a_project_states_how_each_set_up_is_clamped(tmp_path: Path) -> None:
    """The plate of the example; its second side is cut by a program of the plate turned by a quarter."""
    (tmp_path / "top.ngc").write_text(SLOT)
    (tmp_path / "part.toml").write_text(
        f'machine = "xyzac_trt"\nstock = "{DRAWN}"\ncell_mm = 1.0\ntools = ["1=flat:10,length=60,flutes=20"]\n'
        '[[setup]]\nprograms = ["top.ngc"]\nturn_deg = 90\n'
        '[[setup]]\nprograms = ["top.ngc"]\nturn_deg = 90\npose = { origin_mm = [10, 0, 0] }\n'
    )
    found = trunnion.simulate(tmp_path / "part.toml")
    assert [round(each.removed, -1) for each in found.setups] == [2500.0, 2500.0]
    assert [each.turn for each in found.setups] == [90.0, 90.0]
