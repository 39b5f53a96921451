"""Collisions where the answer is known by hand, and none over the published programs."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import TESTS
from tests.support.machines import five_axis_machines
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine, link_transforms, load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.simulation.collisions import (
    Body,
    BodyKind,
    body_pairs,
    check_collisions,
    fixture_body,
    machine_bodies,
    part_body,
)
from trunnion.simulation.collisions.queries import Solid, touches
from trunnion.simulation.meshes import TriangleMesh, box_mesh, save_mesh
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import flat
from trunnion.simulation.tools.sizes import BodyPiece

HEAD = "G710 G90 G500 D0\nTRAFOOF\n"


def block(name: str, low: tuple[float, float, float], high: tuple[float, float, float]) -> TriangleMesh:
    return box_mesh(np.array(low), np.array(high), name)


def iron(link: str, mesh: TriangleMesh) -> Body:
    return Body(mesh.name, link, mesh, BodyKind.MACHINE)


@pytest.fixture(scope="module")
def machine() -> Machine:
    return replace(load_machine("yl569"), workpiece_zero=(0.0, 0.0, 0.0), bodies=(), spindle_point_is_stated=True)


def run_text(text: str, machine: Machine, folder: Path) -> Run:
    program = folder / "part.mpf"
    program.write_text(text, encoding="utf-8")
    found = run_program(program, machine)
    assert not found.errors, found.errors
    return found


def mill(gauge_length: float = 150.0) -> ToolShape:
    """A mill of 10 mm in a holder of 50 mm that begins 60 mm above its tip."""
    return flat(10.0, flute_length=20.0, length=60.0, gauge_length=gauge_length, holder=(BodyPiece(50.0, 50.0, 60.0),))


def test_boxes_on_crossing_slides_meet_where_they_must(machine: Machine, tmp_path: Path) -> None:
    # X- takes the table, with the small box, to X+: its face at +10 meets the head's at 100 after 90 of 200 mm, and its
    # other face leaves that at 130 after 140. Once inside, 15 mm sideways bring it out again.
    run = run_text(f"{HEAD}G0 SUPA X0 Y0 Z0\nG1 SUPA X-200 F1000\nM30\n", machine, tmp_path)
    bodies = [
        iron("workpiece", block("vise", (-10.0, -5.0, -5.0), (10.0, 5.0, 5.0))),
        iron("Z", block("head", (100.0, -10.0, -10.0), (130.0, 10.0, 10.0))),
    ]
    (found,) = check_collisions(run, bodies, {})
    assert (found.between, found.rows) == (("vise", "head"), (1, 1))
    assert found.begin == pytest.approx(0.45, abs=0.5 / 200.0)
    assert found.depth == pytest.approx(15.0, abs=0.01)
    assert not found.is_near
    # 10 mm further along Y they pass 5 mm beside each other.
    run = run_text(f"{HEAD}G0 SUPA X0 Y20 Z0\nG1 SUPA X-200 F1000\nM30\n", machine, tmp_path)
    assert check_collisions(run, bodies, {}) == []
    (found,) = check_collisions(run, bodies, {}, near=6.0)
    assert found.is_near
    assert found.depth == pytest.approx(5.0, abs=1e-3)


def test_a_table_that_tilts_meets_the_head_at_the_angle_of_its_edge(machine: Machine, tmp_path: Path) -> None:
    run = run_text(f"{HEAD}G0 SUPA X0 Y0 Z0 B0\nG1 SUPA B90 F1000\nM30\n", machine, tmp_path)
    plate = iron("workpiece", block("plate", (-100.0, -40.0, -20.0), (100.0, 40.0, -10.0)))
    head = iron("spindle", block("head", (-300.0, -300.0, 50.0), (300.0, 300.0, 60.0)))
    (found,) = check_collisions(run, [plate, head], {})
    # The upper edge is 100 mm out and 10 mm below the line of B: it rises to 50 where 100 sin b - 10 cos b = 50.
    angle = math.degrees(math.asin(50.0 / math.hypot(100.0, 10.0)) + math.atan2(10.0, 100.0))
    assert found.rows[0] == 1
    assert 90.0 * found.begin == pytest.approx(angle, abs=0.3)
    # At the worst pose what is told lies in both of them, seen from the workpiece.
    assert -100.0 <= found.place[0] <= 100.0
    assert -40.0 <= found.place[1] <= 40.0


def test_a_holder_meets_what_its_cutter_may_cut(machine: Machine, tmp_path: Path) -> None:
    machine = replace(machine, tool_length=150.0, workpiece_zero=(0.0, 0.0, -200.0))
    text = 'G710 G90 G54\nT="MILL" M6\nD1\nS1000 M3\nG0 X0 Y0 Z20\nG1 Z-{depth} F500\nG0 Z20\nM30\n'
    part = block("part", (-50.0, -50.0, -80.0), (50.0, 50.0, 0.0))
    tools = {"MILL": mill()}
    names = []
    for depth in ("59.9", "65"):
        run = run_text(text.format(depth=depth), machine, tmp_path)
        names.append([c.between for c in check_collisions(run, [part_body(part, machine)], tools)])
        fixed = check_collisions(run, [fixture_body(part.named("clamp"), machine)], tools)
        assert ("clamp", "cutter of MILL") in {c.between for c in fixed}
        assert min(c.begin for c in fixed if c.between[1].startswith("cutter")) < 1.0
    assert [{pair[1].split()[0] for pair in pairs} for pairs in names] == [{"shank"}, {"shank", "holder"}]


def test_a_body_that_begins_inside_of_another_is_found(machine: Machine, tmp_path: Path) -> None:
    run = run_text(f"{HEAD}G0 SUPA X0 Y0 Z0\nG1 SUPA X-1 F1000\nM30\n", machine, tmp_path)
    inner = iron("workpiece", block("inner", (-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)))
    outer = iron("Z", block("outer", (-50.0, -50.0, -50.0), (50.0, 50.0, 50.0)))
    (found,) = check_collisions(run, [inner, outer], {})
    # 51 mm bring it out again: 50 of the larger one, and 1 of its own.
    assert found.rows == (0, 1)
    assert found.depth == pytest.approx(51.0)


def test_what_overlaps_at_home_on_one_side_is_no_pair_and_is_said(machine: Machine) -> None:
    bodies = [
        iron("C", block("table", (-10.0, -10.0, -10.0), (10.0, 10.0, 0.0))),
        iron("B", block("cradle", (-20.0, -20.0, -20.0), (20.0, 20.0, -5.0))),
        iron("workpiece", block("plate", (-5.0, -5.0, 0.0), (5.0, 5.0, 5.0))),
        iron("Z", block("head", (-5.0, -5.0, -3.0), (5.0, 5.0, 50.0))),
        iron("bed", block("floor", (-90.0, -90.0, -90.0), (90.0, 90.0, -60.0))),
    ]
    pairs = body_pairs(machine, bodies)
    assert pairs.left_out == ((0, 1),)
    # Table and plate are one link; the head that stands in the table at home is checked, and found.
    assert (0, 2) not in pairs.checked
    assert {(0, 3), (1, 2), (2, 3), (0, 4), (3, 4)} <= set(pairs.checked)


def test_what_is_not_known_is_asked_for(machine: Machine, tmp_path: Path) -> None:
    text = 'G710 G90 G54\nT="MILL" M6\nD1\nG0 X0 Y0 Z20\nM30\n'
    table = iron("C", block("table", (-10.0, -10.0, -90.0), (10.0, 10.0, -80.0)))
    nowhere = replace(machine, workpiece_zero=None)
    run = run_text(text, nowhere, tmp_path)
    with pytest.raises(InputError) as caught:
        check_collisions(run, [table], {})
    told = str(caught.value)
    assert "tool MILL is not known: only its number is; say which tool it is" in told
    assert "needs the workpiece zero" in told
    run = run_text(text, machine, tmp_path)
    with pytest.raises(InputError, match="the length of tool MILL is not known"):
        check_collisions(run, [table], {"MILL": replace(mill(), length=0.0)})


def test_a_mesh_beside_the_definition_becomes_a_body(tmp_path: Path) -> None:
    save_mesh(block("x", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0)), tmp_path / "guard.stl")
    text = (
        'extends = "yl569"\nname = "Ours"\n[spindle]\ngauge_point_mm = [0, 0, 400]\n[[body]]\nname = "guard"\n'
        'link = "spindle"\nshape = "file"\nfile = "guard.stl"\nunit = "inch"\norigin_mm = [10, 0, 0]\n'
        "turn_deg = [0, 0, 90]\n"
    )
    (tmp_path / "ours.toml").write_text(text, encoding="utf-8")
    machine = load_machine(tmp_path / "ours.toml")
    guard = {body.name: body for body in machine_bodies(machine)}["guard"]
    wanted = np.array([[10.0 - 50.8, 0.0, 400.0], [10.0, 25.4, 400.0 + 76.2]])
    np.testing.assert_allclose(guard.mesh.bounds, wanted, atol=1e-4)
    (tmp_path / "guard.stl").unlink()
    with pytest.raises(InputError, match=r"ours\.toml:6: error: body guard: .*guard\.stl file not found"):
        machine_bodies(machine)


def test_a_gauge_point_that_is_not_stated_is_told() -> None:
    said: list[Problem] = []
    for name in ("yl569", "matsuura_mx330"):  # turns no head: work offset and tool length say where the nose is
        machine_bodies(load_machine(name), said.append)
    assert said == []
    machine_bodies(replace(load_machine("generic_head_table_bc"), spindle_point_is_stated=False), said.append)
    assert [str(each).partition(": ")[2].partition(";")[0] for each in said] == [
        "warning: has no spindle.gauge_point_mm: spindle and tools are not checked against the rest of the machine"
    ]


@pytest.mark.third
@pytest.mark.parametrize("name", five_axis_machines())
def test_the_bodies_of_shipped_machines_are_free_at_home(name: str) -> None:
    machine = replace(load_machine(name), spindle_point_is_stated=True)
    bodies = machine_bodies(machine)
    solids = [Solid(body.mesh) for body in bodies]
    home = {link: poses[0] for link, poses in link_transforms(machine, machine.home[None]).items()}
    checked = body_pairs(machine, bodies).checked
    assert len(bodies) >= 5
    assert len(checked) >= 7
    hit = [
        (bodies[i].name, bodies[j].name)
        for i, j in checked
        if touches(solids[i], solids[j], np.linalg.inv(home[bodies[j].link]) @ home[bodies[i].link])
    ]
    assert hit == []


#: Published programs, their machines, and the height of the spindle nose above the crossing of its axes.
PROGRAMS = [
    ("yl569/3_blade_finish.expected.mpf", "yl569", 450.0, 40.0),
    ("fanuc/blade.expected.nc", "matsuura_mx330", 670.0, 40.0),
    ("haas/blade.expected.nc", "haas_umc750", 450.0, 40.0),
    ("hs664rt/radial_holes.expected.txt", "hs664rt", 450.0, 40.0),
    ("linuxcnc/blade.expected.ngc", "xyzac_trt", 300.0, 60.0),
]


@pytest.mark.parametrize(("program", "name", "height", "zero"), PROGRAMS)
def test_published_programs_hit_nothing_and_a_long_part_does(
    program: str, name: str, height: float, zero: float
) -> None:
    x, y, _ = load_machine(name).spindle_point
    changes = {"spindle": {"gauge_point_mm": [x, y, height]}, "workpiece": {"zero_mm": [0, 0, zero]}}
    machine = load_machine(name, changes)
    run = run_program(TESTS / "golden" / program, machine)
    tools = {tool: mill(120.0) for tool in run.tools if tool not in ("", "0")}
    bodies = machine_bodies(machine)
    assert check_collisions(run, bodies, tools) == []
    # A clamp where the part is cannot be missed.
    clamp = fixture_body(block("clamp", (-80.0, -80.0, -50.0), (80.0, 80.0, 100.0)), machine)
    assert any("clamp" in each.between for each in check_collisions(run, [clamp], tools))


@pytest.mark.nightly
def test_what_is_at_a_nose_of_unknown_place_hits_nothing_where_the_machine_states_positions() -> None:
    unknown = load_machine("yl569", {"workpiece": {"zero_mm": [0, 0, 0]}})
    stated = load_machine("yl569", {"workpiece": {"zero_mm": [0, 0, 0]}, "spindle": {"gauge_point_mm": [0, 0, 0]}})
    clamp = fixture_body(block("clamp", (-80.0, -80.0, -50.0), (80.0, 80.0, 100.0)), unknown)
    hit = {}
    for machine in (unknown, stated):
        run = run_program(TESTS / "golden/yl569/3_blade_finish.expected.mpf", machine)
        tools = {tool: mill(120.0) for tool in run.tools if tool not in ("", "0")}
        bodies = [clamp, *machine_bodies(machine)]
        hit[machine is stated] = {each.between for each in check_collisions(run, bodies, tools)}
    assert hit[False]
    assert all("clamp" in between for between in hit[False])
    assert any("clamp" not in between for between in hit[True])  # the table, which starts beside the nose there


@pytest.mark.third
@pytest.mark.parametrize("depth", [0.3, 1.9, 2.1, 3.0, 4.2])
@pytest.mark.parametrize("sideways", [False, True])
def test_the_block_that_goes_too_far_is_told_with_its_depth(
    depth: float, sideways: bool, machine: Machine, tmp_path: Path
) -> None:
    # Row 1 goes into the plate, row 2 out of it: the worst pose is where the motion turns.
    axis, begin = ("X", "X0 Y0 Z0") if sideways else ("Z", "X0 Y0 Z60")
    way = f"G0 SUPA {axis}{-depth - 40}\nG0 SUPA {axis}60"
    run = run_text(f"{HEAD}G0 SUPA {begin}\n{way}\nM30\n", machine, tmp_path)
    high = (-40.0, 100.0, 100.0) if sideways else (100.0, 100.0, -40.0)
    plate = iron("workpiece", block("plate", (-100.0, -100.0, -100.0), high))
    ram = iron("spindle", block("ram", (0.0, -5.0, 0.0), (60.0, 5.0, 60.0)))
    (found,) = check_collisions(run, [plate, ram], {})
    assert (found.rows, found.worst) == ((1, 2), 1)
    assert found.depth == pytest.approx(depth, abs=1e-6)
    assert found.fraction == pytest.approx(1.0)


@pytest.mark.parametrize(("apart", "near"), [(0.1, 0.15), (0.3, 0.5), (0.9, 1.0), (0.02, 0.5), (0.3, 0.35)])
def test_the_nearest_pose_is_told_where_the_motion_turns(
    apart: float, near: float, machine: Machine, tmp_path: Path
) -> None:
    run = run_text(f"{HEAD}G0 SUPA X0 Y0 Z60\nG0 SUPA Z{apart - 40}\nG0 SUPA Z60\nM30\n", machine, tmp_path)
    plate = iron("workpiece", block("plate", (-100.0, -100.0, -100.0), (100.0, 100.0, -40.0)))
    ram = iron("spindle", block("ram", (0.0, -5.0, 0.0), (60.0, 5.0, 60.0)))
    (found,) = check_collisions(run, [plate, ram], {}, near=near)
    assert (found.is_near, found.worst) == (True, 1)
    assert found.fraction == pytest.approx(1.0)
    assert found.depth == pytest.approx(apart, abs=1e-6)
