"""The distance between tool and part during a turn, against figures worked out by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest

from trunnion.machines import SweptPart, forward, load_machine, slide_positions, turn_clearance, turns_part_alone

#: The corners of a block of 100 mm on the table.
BLOCK = np.array([[-50.0, -50.0, 0.0], [50.0, 50.0, 100.0]])


def test_a_table_that_turns_alone_sweeps_the_cylinder_around_the_block() -> None:
    machine = load_machine("hs664rt")
    part = SweptPart.around(machine, BLOCK)
    before = slide_positions(machine, np.array([[0.0, -120.0, 50.0]]), np.array([[0.0, 90.0]]))[0]
    after = before + np.where([name == "C" for name in machine.names], 90.0, 0.0)
    assert turns_part_alone(machine, before, after, 1e-6)
    assert turn_clearance(machine, before, after, part) == pytest.approx(120.0 - 50.0 * math.sqrt(2.0), abs=1e-6)


@pytest.mark.parametrize(("height", "distance"), [(150.0, 27.5256), (120.0, 0.0), (200.0, 77.5256)])
def test_a_table_that_tilts_lifts_the_edge_of_the_cylinder(height: float, distance: float) -> None:
    """The edge is sqrt(100^2 + 70.7^2) = 122.5 mm from the axis of the tilt, straight below the tool once."""
    machine = load_machine("hs664rt")
    part = SweptPart.around(machine, BLOCK)
    before = slide_positions(machine, np.array([[0.0, 0.0, height]]), np.array([[0.0, 0.0]]))[0]
    after = before + np.where([name == "A" for name in machine.names], 90.0, 0.0)
    assert not turns_part_alone(machine, before, after, 1e-6)
    assert distance - 0.5 <= turn_clearance(machine, before, after, part) <= distance


def test_a_head_swings_its_tool_into_the_block() -> None:
    """The pivot is 250 mm above the tip: one way the tip swings away from the block, the other way into it."""
    machine = replace(load_machine("generic_head_head_ca"), tool_length=0.0)
    part = SweptPart.around(machine, BLOCK)
    before = slide_positions(machine, np.array([[0.0, 300.0, 150.0]]), np.array([[0.0, 0.0]]))[0]
    tilt = np.where([name == "A" for name in machine.names], 1.0, 0.0)
    distances = [turn_clearance(machine, before, before + turn * tilt, part) for turn in (90.0, -90.0)]
    assert sorted(distance > 200.0 for distance in distances) == [False, True]


@pytest.mark.parametrize("name", ["dmu65", "mikron_600u", "generic_head_table_bc", "generic_head_head_ca"])
def test_it_is_never_more_than_what_many_samples_find(name: str) -> None:
    machine = replace(load_machine(name), tool_length=80.0, workpiece_zero=(10.0, -20.0, 30.0))
    part = SweptPart.around(machine, BLOCK)
    random = np.random.default_rng(3)
    for _ in range(30):
        rotary = random.uniform(-30.0, 30.0, (2, 2))
        tip = random.uniform(-300.0, 300.0, 3) + np.array([0.0, 0.0, 200.0])
        before = slide_positions(machine, tip[None], rotary[:1])[0]
        after = before.copy()
        after[list(machine.rotary)] = rotary[1]
        share = np.linspace(0.0, 1.0, 501)[:, None]
        tips, axes = forward(machine, before + share * (after - before))
        points = (tips[:, None] + np.linspace(0.0, 900.0, 301)[None, :, None] * axes[:, None]).reshape(-1, 3)
        sampled = float(part.distance(points).min())
        found = turn_clearance(machine, before, after, part)
        assert sampled - 3.5 <= found <= sampled + 1e-9
