"""The jog table is derived apart from the maps, agrees with them, and changes with all that a definition says."""

import numpy as np
import pytest
from hypothesis import example, given, settings

from tests.support.examples import examples
from tests.support.machine_mutants import mutants
from tests.support.machine_strategies import joints, machines
from tests.support.machines import five_axis_machines
from trunnion.cli.machine.machine_text import machine_lines
from trunnion.jobs.describe.machines import describe_machine
from trunnion.machines import Axis, AxisKind, Machine, Mount, forward, load_machine, shipped_machines
from trunnion.machines.jog_table import jog_table, rotary_pose

#: What is seen at the shipped machines: for each axis the tool, and the iron.
SEEN = {
    "dmu65": {
        "C": (
            "the tool axis stays at (0, 0, 1)",
            "the table turns 10° clockwise seen from +Z; what is at +X of it goes to -Y",
        ),
        "A": (
            "the tool axis points to (0, -0.174, 0.985) of the workpiece, leaning to -Y",
            "the table turns 10° clockwise seen from +X; its -Y edge goes to +Z, its +Y edge to -Z",
        ),
        "X": ("the tool goes 10 mm to +X of the workpiece", "the head goes 10 mm to +X"),
    },
    "yl569": {
        "B": (
            "the tool axis points to (0.174, 0, 0.985) of the workpiece, leaning to +X",
            "the table turns 10° clockwise seen from +Y; its +X edge goes to +Z, its -X edge to -Z",
        ),
        "X": ("the tool goes 10 mm to +X of the workpiece", "the table goes 10 mm to -X"),
        "Z": ("the tool goes 10 mm to +Z of the workpiece", "the head goes 10 mm to +Z"),
    },
    "ucp800": {
        "C": (
            "the tool axis stays",
            "the table turns 10° counter-clockwise seen from +Z; what is at +X of it goes to +Y",
        ),
        "A": (
            "the tool axis points to (0, 0.174, 0.985) of the workpiece, leaning to +Y",
            "the table turns 10° counter-clockwise seen from +X; its +Y edge goes to +Z, its -Y edge to -Z",
        ),
    },
    "linuxcnc_5axis": {
        "C": ("the tool axis stays", "the head turns 10° counter-clockwise seen from +Z; the tip stays"),
        "B": ("leaning to -X", "the head turns 10° clockwise seen from +Y; the tip of the tool swings to +X"),
    },
    "generic_head_head_ca": {
        "A": ("leaning to -Y", "the head turns 10° counter-clockwise seen from +X; the tip of the tool swings to +Y"),
    },
    "generic_head_table_bc": {
        "C": ("the tool axis stays", "the table turns 10° clockwise seen from +Z"),
        "B": ("leaning to +X", "the head turns 10° counter-clockwise seen from +Y; the tip of the tool swings to -X"),
    },
}


#: Spindle along X: the head turns about it, so that neither the tip nor what is at +X of the head swings.
ALONG_X = Machine(
    "any",
    "Any machine",
    tuple(
        Axis(name, AxisKind.ROTARY if name in "AC" else AxisKind.LINEAR, Mount.TOOL, direction)
        for name, direction in {
            "X": (1.0, 0.0, 0.0),
            "Y": (0.0, 1.0, 0.0),
            "Z": (0.0, 0.0, 1.0),
            "C": (0.0, 0.0, 1.0),
            "A": (1.0, 0.0, 0.0),
        }.items()
    ),
    spindle_direction=(1.0, 0.0, 0.0),
)


def shown(machine: Machine) -> list[str]:
    """What `trunnion check` shows of a machine, without the texts of its control."""
    lines = list(machine_lines(describe_machine(machine)))
    return lines[: next(k for k, line in enumerate(lines) if line.startswith("Texts of"))]


def moved(machine: Machine) -> list[object]:
    """What moves how: the numbers and words of the table without those that the definition itself states."""
    table = jog_table(machine)
    jogs = [(jog.tool, jog.iron, jog.tool_step, jog.iron_turn) for jog in table.axes]
    return [*jogs, *((tuple(pose.values.items()), pose.tool_axis, pose.gauge_point) for pose in table.poses)]


@pytest.mark.parametrize("key", SEEN)
def test_a_jog_is_told_as_it_is_seen_at_the_machine(key: str) -> None:
    table = {jog.axis.name: jog for jog in jog_table(load_machine(key)).axes}
    for name, (tool, iron) in SEEN[key].items():
        assert tool in table[name].tool
        assert iron in table[name].iron


def test_the_poses_can_be_checked_by_hand() -> None:
    lines = shown(load_machine("hs664rt"))
    assert "  A+30 C+0   tool axis (0, -0.5, 0.866)          gauge point (0, 0, 0)" in lines
    assert "The same tool axis: A+30 C+30, and A-30 C-150." in lines
    assert "  A-90 C+0   tool axis (0, 1, 0)                 gauge point (217.5, 670, -232.5)" in shown(
        load_machine("matsuura_mx330")
    )


def agrees(machine: Machine, values: dict[str, float]) -> None:
    """Compare a pose with the forward map."""
    pose = rotary_pose(machine, values)
    tip, axis = forward(machine, np.array([[values.get(name, 0.0) for name in machine.names]]), 0.0)
    np.testing.assert_allclose(pose.gauge_point, tip[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(pose.tool_axis, axis[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("key", shipped_machines())
def test_the_table_of_a_shipped_machine_agrees_with_the_forward_map(key: str) -> None:
    machine = load_machine(key)
    table = jog_table(machine)
    assert table.poses
    for pose in (*table.poses, *table.same_axis):
        agrees(machine, dict(pose.values))
    for jog in table.axes:
        agrees(machine, {jog.axis.name: jog.step})


@settings(deadline=None, max_examples=examples(50))
@given(machines(), joints)
def test_a_pose_of_any_machine_agrees_with_the_forward_map(machine: Machine, values: list[float]) -> None:
    agrees(machine, dict(zip(machine.names, values, strict=True)))


@settings(deadline=None, max_examples=examples(50))
@given(machines())
@example(ALONG_X)
def test_both_positions_of_the_rotary_axes_point_the_tool_the_same_way(machine: Machine) -> None:
    one, other = jog_table(machine).same_axis
    np.testing.assert_allclose(one.tool_axis, other.tool_axis, rtol=0, atol=1e-7)
    assert list(one.values) == list(other.values)


@pytest.mark.parametrize("key", five_axis_machines())
def test_every_mistake_in_a_definition_changes_what_is_shown(key: str) -> None:
    machine = load_machine(key)
    before = shown(machine)
    assert [name for name, mutant in mutants(machine) if shown(mutant) == before] == []


@pytest.mark.parametrize("key", five_axis_machines())
def test_senses_sides_orders_and_offsets_change_what_moves_and_not_only_what_is_repeated(key: str) -> None:
    machine = load_machine(key)
    before = moved(machine)
    told = (
        "sense",
        "direction",
        "direction rolled",
        "side",
        "point mirrored",
        "spindle direction",
        "gauge point mirrored",
    )
    for name, mutant in mutants(machine):
        if name.endswith(told):
            assert moved(mutant) != before, name


def test_a_machine_that_cannot_stand_at_zero_has_poses_inside_its_travel() -> None:
    machine = load_machine("yl569", {"axis": [{"name": "B", "limits_deg": [40, 55], "home_deg": 40}]})
    table = jog_table(machine)
    assert {pose.values["B"] for pose in table.poses} == {40.0, 55.0}
    assert all(pose.in_travel for pose in table.poses)
