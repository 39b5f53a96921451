"""Random passes by the pole with all options, from plan to proof: every program does what it declares."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.jobs import post_job
from tests.support.operations import moves_of, operation_of
from tests.support.pole_paths import MACHINES, around_pole, passes
from trunnion.controls import load_control
from trunnion.errors import RefusedError
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.machines import Machine
from trunnion.model.motion import PoleStrategy
from trunnion.model.toolpath import Arcs, Kind, LoadTool, Operation, SpindleOn, Tool, Toolpath
from trunnion.output.program_writer import write_program
from trunnion.planning import PlanOptions
from trunnion.planning.linearization.arc_chords import arcs_a_control_takes, lines_for_arcs, source_rows
from trunnion.readers import run_program
from trunnion.verification import Verification, verify

NAMES = ("yl569", "generic_head_table_bc", "generic_head_head_ca", "generic_nutated_b45_c")


def proven(machine: Machine, operation: Operation, options: PlanOptions) -> Verification | None:
    """The program, written, read back and verified; None where planning refuses."""
    operation = replace(
        operation, tool=Tool("MILL", "D10", 10.0, 5.0, 50.0), events=(LoadTool(0, 1, 1), SpindleOn(0, 1, 5000.0))
    )
    path = Toolpath("part.cls", (operation,))
    try:
        program = plan_program([path], post_job(machine, load_control(machine.control), options, {}))[0]
    except RefusedError:
        return None
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "part.mpf"
        with target.open("wb") as sink:
            write_program(program, sink)
            expected = expectation(program)
        run = run_program(target, machine)
        return verify(run, [path], tolerances=expected.tolerances, settings=expected.settings)


def failed(found: Verification) -> list[str]:
    return [f"{c.key}: {c.summary}" for c in found.checks if not c.passed and c.key != "home"]


@settings(max_examples=examples(25))
@given(st.data(), st.sampled_from(NAMES), st.sampled_from(list(PoleStrategy)), st.floats(0.01, 0.5), st.booleans())
def test_what_is_planned_is_proven(
    data: st.DataObject, name: str, mode: PoleStrategy, angle: float, lower: bool
) -> None:
    machine = MACHINES[name]
    operation = data.draw(passes(machine))
    found = proven(machine, operation, PlanOptions(pole_strategy=mode, pole_angle=angle, lower_feed=lower))
    if found is None:
        return
    assert failed(found) == []
    if lower:
        slowest = found.run.feed[found.run.kind != 0].min(initial=np.inf)
        rotary = {machine.axes[column].name for column in machine.rotary}
        speed = next(c for c in found.checks if c.key == "speed")
        # Feeds have a lower bound, and motions that lead on from a rewind are not lowered.
        if slowest > 0.2 and not any(e.kind == "message" and "Rewind" in str(e.value) for e in found.run.events):
            assert not [place.text for place in speed.places if place.text.split(" ")[0] in rotary]


def tilting_arcs(past: float, feed: float) -> Operation:
    """A straight pass by the pole, broken by two arcs: one whose tool axis turns, and one that stays an arc."""
    machine = MACHINES["generic_head_table_bc"]
    n = 121
    along = np.linspace(-3.0, 3.0, n)
    tip = np.column_stack((along * 4.0, np.zeros(n), np.zeros(n)))
    axis = around_pole(machine, along, np.full(n, past))
    axis[80] = axis[79]
    kind = np.full(n, Kind.LINEAR, np.uint8)
    kind[[58, 80]] = Kind.ARC
    moves = replace(moves_of(tip, axis), kind=kind, feed=np.full(n, feed), line=np.arange(10, 10 + n, dtype=np.int32))
    rows = np.array([58, 80])
    middle = 0.5 * (tip[rows] + tip[rows - 1])
    radius = 0.5 * np.linalg.norm(tip[rows] - tip[rows - 1], axis=1)
    arcs = Arcs(rows, middle, np.tile([0.0, 0.0, 1.0], (2, 1)), radius, np.zeros(2, np.int64))
    return replace(operation_of(moves), arcs=arcs)


@settings(max_examples=examples(10))
@given(st.sampled_from(list(PoleStrategy)), st.booleans(), st.floats(0.01, 0.2), st.floats(500.0, 5000.0))
def test_arcs_keep_their_tool_axes_and_share_a_feed(mode: PoleStrategy, lower: bool, past: float, feed: float) -> None:
    machine = MACHINES["generic_head_table_bc"]
    found = proven(machine, tilting_arcs(past, feed), PlanOptions(pole_strategy=mode, lower_feed=lower, pole_angle=0.3))
    assert found is not None
    assert failed(found) == []


def test_lines_for_arcs_belong_to_the_arc() -> None:
    before = tilting_arcs(0.05, 1000.0)
    kept = arcs_a_control_takes(before)
    assert kept.tolist() == [False, True]
    after = lines_for_arcs(before, kept, 0.001)
    source = source_rows(before, after)
    assert len(source) == len(after.moves) > len(before.moves)
    assert (np.diff(source) >= 0).all()
    np.testing.assert_array_equal(after.moves.line, before.moves.line[source])
    ends = np.append(np.diff(source) > 0, True)
    np.testing.assert_allclose(after.moves.tip[ends], before.moves.tip, atol=1e-9)
    assert np.count_nonzero(source == 58) == len(after.moves) - len(before.moves) + 1
