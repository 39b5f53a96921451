"""The pieces of a motion, against the run and its fine subdivision."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import TESTS
from trunnion.errors import InputError
from trunnion.jobs.twin.serving import twin_program
from trunnion.machines import forward, load_machine
from trunnion.model.run import Run
from trunnion.model.subdivision import subdivide
from trunnion.readers import run_program
from trunnion.timing import MOST_PIECES, SAG, AxisPieces, axis_pieces

ARCS = "G710 G90 G54\nG0 X30 Y0 Z10\nG2 X30 Y0 I-30 J0 F500\nTRAORI\nG3 X-30 Y0 CR=30 B40 C90\nG1 X0 B-10 C300\nM30\n"


@pytest.fixture(scope="module", params=["blade", "arcs"])
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    machine = replace(load_machine("yl569"), workpiece_zero=(10.0, 20.0, 30.0), tool_length=120.0)
    if request.param == "blade":
        return run_program(TESTS / "golden" / "yl569" / "3_blade_finish.expected.mpf", machine)
    program = tmp_path_factory.mktemp("arcs") / "arcs.mpf"
    program.write_text(ARCS, encoding="utf-8")
    return run_program(program, machine)


def whole(run: Run, lengths: dict[int, float]) -> AxisPieces:
    (pieces,) = axis_pieces(run, lengths)
    return pieces


def test_pieces_stay_where_the_control_has_the_axes(run: Run) -> None:
    assert not run.errors
    pieces = whole(run, {})
    dense = subdivide(run, 40)
    at = pieces.row + pieces.done
    places = dense.row + dense.fraction
    for column in range(5):
        linear = np.interp(places, np.concatenate(([0.0], at)), pieces.joints[:, column])
        sag = 1.5 * SAG if not run.machine.axes[column].is_rotary else np.degrees(1.5 * SAG / 500.0)
        np.testing.assert_allclose(linear, dense.joints[:, column], atol=sag)
    ends = np.flatnonzero(pieces.done == 1.0) + 1
    np.testing.assert_allclose(pieces.joints[ends], run.joints, atol=1e-9)
    assert len(pieces.row) < 100 * len(run)


def test_another_tool_length_lifts_the_slides_and_leaves_machine_positions(run: Run) -> None:
    own, longer = whole(run, {}), whole(run, dict.fromkeys(range(9), 150.0))
    rows = np.arange(len(run))
    ends = [np.flatnonzero(pieces.done == 1.0) + 1 for pieces in (own, longer)]
    lifted = (longer.joints[ends[1]] - own.joints[ends[0]])[:, run.machine.column("Z")]
    # A row without Z after one in machine coordinates leaves Z there.
    at_work = ~run.machine_frame & (run.edge != 0) & (np.cumsum((run.programmed & 4 != 0) & ~run.machine_frame) > 0)
    assert at_work.sum() > 2
    np.testing.assert_allclose(lifted[at_work], 30.0, atol=1e-9)
    np.testing.assert_allclose(lifted[run.machine_frame], 0.0, atol=1e-9)
    tip, _ = forward(replace(run.machine, tool_length=150.0), longer.joints[ends[1]])
    np.testing.assert_allclose(tip[rows[at_work]], run.tip[at_work], atol=1e-9)


def test_without_a_zero_machine_positions_are_not_known_at_the_workpiece(run: Run, tmp_path: Path) -> None:
    assert whole(run, {}).known.all()
    pieces = whole(replace(run, machine=replace(run.machine, workpiece_zero=None)), {})
    into_work = np.flatnonzero(pieces.known)
    assert not pieces.known[0]
    assert len(into_work) > len(pieces.row) // 2


def test_a_program_of_more_pieces_than_are_kept_is_refused_before_they_are_made(run: Run) -> None:
    made = len(whole(run, {}).row)
    assert len(next(axis_pieces(run, {}, most=made)).row) == made
    last = int(whole(run, {}).row[-1])
    with pytest.raises(InputError) as caught:
        list(axis_pieces(run, {}, most=made - 1))
    (problem,) = caught.value.problems
    assert problem.line == run.lines[last]


def test_a_few_lines_that_make_a_flood_of_motion_are_refused_with_the_line(tmp_path: Path) -> None:
    program = tmp_path / "flood.mpf"
    loop = f"FOR R1=1 TO {MOST_PIECES // 4096 + 1}\nG2 X0 Y=R1*0.00001 I=9000 J=0 TURN=60\nENDFOR\nM30\n"
    program.write_text(f"G17 G54 G90 G94\nG1 X0 Y0 Z10 F1000\n{loop}", encoding="utf-8")
    with pytest.raises(InputError, match=r"flood\.mpf:4: error: is where the program makes more than 3000000 pieces"):
        twin_program(program, machine="yl569")
