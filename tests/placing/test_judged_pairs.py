"""What is judged where a part is placed is what a simulation checks at that place."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.brute_clearance import box_body
from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.machines import Machine, MachineBody, load_machine
from trunnion.model.rotations import about_z
from trunnion.placing.collisions.guarded_pairs import (
    Changes,
    GuardedPair,
    guarded_machine,
    guarded_on_part,
    guarded_pairs,
    guarded_tool,
    standing,
)
from trunnion.simulation.collisions import BodyKind, body_pairs, fixture_body, machine_bodies, part_body
from trunnion.simulation.collisions.bodies import tool_bodies
from trunnion.simulation.meshes import TriangleMesh, box_mesh
from trunnion.simulation.tools.text import parse_tool

TOOL = parse_tool("1=flat:10,length=80,flutes=20,holder=40x30", {})


def with_bodies(name: str, bodies: Sequence[MachineBody]) -> Machine:
    machine = load_machine(name)
    return replace(
        machine, bodies=tuple(bodies), workpiece_zero=None, spindle_point=(0, 0, 0), spindle_point_is_stated=True
    )


def placed_pairs(machine: Machine, fixture: TriangleMesh, part: TriangleMesh, zero: Floats, turn: Floats) -> list[
    GuardedPair
]:  # fmt: skip
    bodies = guarded_machine(machine_bodies(machine))
    bodies += guarded_tool(TOOL, machine, "1", 80.0, 0)
    bodies += [guarded_on_part(fixture, BodyKind.FIXTURE), guarded_on_part(part, BodyKind.PART)]
    pairs = guarded_pairs(machine, bodies).kept
    left_out = standing(machine, pairs, turn, zero)
    return [pair for pair in pairs if pair not in left_out]


@settings(max_examples=examples(60), deadline=None)
@given(
    seed=st.integers(0, 10**6), turn=st.sampled_from([0.0, 90.0, 217.0]),
    name=st.sampled_from(
        ["yl569", "matsuura_mx330", "generic_head_table_bc", "generic_head_head_ca", "generic_nutated_b45_c"]
    ),
)  # fmt: skip
def test_placing_judges_the_pairs_that_a_simulation_checks(seed: int, turn: float, name: str) -> None:
    random = np.random.default_rng(seed)
    plain = load_machine(name)
    links = ["bed", "workpiece", "spindle", *plain.names]
    bodies = []
    for k in range(7):
        middle, half = random.uniform(-250.0, 250.0, 3), random.uniform(20.0, 150.0, 3)
        bodies.append(box_body(f"iron {k}", str(random.choice(links)), tuple(middle - half), tuple(middle + half)))
    machine = with_bodies(name, bodies)
    fixture = box_mesh(np.array([-90.0, -20, -60]), np.array([150.0, 30, -10]), "fixture")
    part = box_mesh(np.array([-30.0, -30, -30]), np.array([30.0, 30, 0]), "part")
    x, y, z = (zero := random.uniform(-150.0, 150.0, 3)).tolist()
    pose = np.eye(4)
    pose[:3, :3] = about_z(turn)
    there = replace(machine, workpiece_zero=(x, y, z))
    clamped = [fixture_body(fixture.moved(pose), there), part_body(part.moved(pose), there)]
    everything = [*machine_bodies(there), *clamped, *tool_bodies(TOOL, there, "1", 80.0)]
    checked = {frozenset((everything[i].name, everything[j].name)) for i, j in body_pairs(there, everything).checked}
    judged = placed_pairs(machine, fixture, part, zero, about_z(turn))
    assert {frozenset(pair.names) for pair in judged} == checked
    assert len(judged) == len(checked)


def pairs_of(machine: Machine, *fixtures: TriangleMesh) -> tuple[dict[tuple[str, str], GuardedPair], set[str]]:
    found = guarded_pairs(
        machine,
        [*guarded_machine(machine_bodies(machine)), *(guarded_on_part(mesh, BodyKind.FIXTURE) for mesh in fixtures)],
    )
    return {pair.names: pair for pair in found.kept}, {" ".join(sorted(names)) for names in found.left_out}


def test_a_beam_of_the_bed_in_the_way_of_the_ram_is_judged_though_one_axis_joins_them() -> None:
    ram = box_body("ram", "spindle", (-50, -50, 0), (50, 50, 200))
    home = load_machine("yl569").home[load_machine("yl569").names.index("Z")]
    above = box_body("beam", "bed", (-150, -50, home + 380), (150, 50, home + 420))
    kept, left_out = pairs_of(with_bodies("yl569", [ram, above]))
    assert kept["ram", "beam"].changes is Changes.PLACE
    assert kept["ram", "beam"].weight == 1.0
    assert not left_out
    through = box_body("beam", "bed", (-150, -50, home + 180), (150, 50, home + 420))
    kept, left_out = pairs_of(with_bodies("yl569", [ram, through]))
    assert not kept
    assert left_out == {"beam ram"}


def test_a_clamped_bar_is_judged_against_the_cradle_unless_it_stands_in_it() -> None:
    machine = load_machine("yl569")
    bar = box_mesh(np.array([-130.0, -30, -35]), np.array([250.0, 30, -15]), "bar")
    kept, _ = pairs_of(machine, bar)
    assert {names[0] for names in kept if names[1] == "bar"} >= {"cradle", "cradle cheek -", "cradle cheek +"}
    pair = kept["cradle cheek -", "bar"]
    assert pair.changes is Changes.PLACE
    mesh = pair.one.body.mesh
    middle = mesh.bounds.mean(axis=0) - bar.bounds.mean(axis=0)
    assert standing(machine, [pair], np.eye(3), middle) == [pair]
    assert standing(machine, [pair], np.eye(3), middle + np.array([0.0, 0.0, 1000.0])) == []


@pytest.mark.parametrize(
    ("gap", "link", "weight"),
    [(5.0, "Z", 200.0), (0.0001, "Z", 10000.0), (49.0, "Z", 1000.0 / 49.0), (51.0, "Z", 1.0)],
)
def test_what_runs_along_the_bed_counts_by_its_distance_at_home(gap: float, link: str, weight: float) -> None:
    machine = load_machine("yl569")
    z = machine.home[machine.names.index("Z")]
    slide = box_body("slide", link, (-50, 0, 0), (50, 50, 200))
    rail = box_body("rail", "bed", (-50, -90, z - 500), (50, -gap, z + 700))
    kept, _ = pairs_of(with_bodies("yl569", [slide, rail]))
    assert kept["slide", "rail"].weight == pytest.approx(weight, rel=1e-6)


def test_a_tool_beside_the_head_that_tilts_it_does_not_decide() -> None:
    """The tool, 10 wide and 100 long, hangs 30 beside an arm of the link that carries its last axis."""
    machine = load_machine("generic_head_head_ca")
    arm = box_body("arm", machine.names[-2], (35, -20, -100), (60, 20, 0))
    machine = with_bodies("generic_head_head_ca", [arm])
    tool = parse_tool("1=flat:10,length=100,flutes=40", {})
    pairs = guarded_pairs(
        machine, [*guarded_machine(machine_bodies(machine)), *guarded_tool(tool, machine, "1", 100.0, 0)]
    )
    assert {pair.changes for pair in pairs.kept} == {Changes.TURN}
    assert all(pair.weight == pytest.approx(10_000.0 / 30.0, rel=0.01) for pair in pairs.kept)
