"""Rewinds in the cut: inserted rows, refusals, and messages."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.operations import moves_of, operation_of
from tests.support.path_strategies import BC, CA, directions, winding, with_limits
from tests.support.rewind_paths import round_part
from trunnion.arrays import Floats
from trunnion.cl.write import write_cl
from trunnion.cli import main
from trunnion.errors import Severity
from trunnion.machines import Machine, forward, load_machine, slide_positions
from trunnion.model.motion import DecisionTopic, Motion, Plan
from trunnion.model.toolpath import Arcs, CutterComp, Dwell, Kind, Message, Moves, Operation, Phase, SpindleOn, Toolpath
from trunnion.planning import Clearance, ClearanceSurface, PlanOptions, plan
from trunnion.planning.retracts.clearance import MIN_RETRACT


def planned(operation: Operation, machine: Machine = CA, options: PlanOptions | None = None) -> Plan:
    return plan([Toolpath("part.cls", (operation,))], machine, 0.001, options)


def added(motion: Motion, moves: Moves) -> tuple[int, Moves]:
    """The row before the one rewind of a motion, and the rows of the motion."""
    rows = motion.operation.moves
    inserted = len(rows) - len(moves)
    assert inserted in {3, 5}
    return int(np.argmax(rows.kind == Kind.RAPID)) - 2, rows


def test_the_tool_retracts_turns_and_returns_to_the_same_point() -> None:
    moves = round_part()
    motion = planned(operation_of(moves), options=PlanOptions(clearance=Clearance(30.0))).motions[0]
    row, rows = added(motion, moves)
    there = slice(row + 1, row + 6)
    assert rows.kind[there].tolist() == [Kind.LINEAR, Kind.RAPID, Kind.RAPID, Kind.RAPID, Kind.LINEAR]
    assert rows.phase[there].tolist() == [Phase.RETRACT, Phase.RETRACT, Phase.TRAVERSE, Phase.TRAVERSE, Phase.ENGAGE]
    near, away = (moves.tip[row] + far * moves.axis[row] for far in (2.0, 30.0))
    assert rows.tip[there] == pytest.approx(np.array([near, away, away, near, moves.tip[row]]))
    assert (rows.axis[there] == moves.axis[row]).all()
    assert rows.feed[[row + 1, row + 5]].tolist() == [100.0, 50.0]
    assert (rows.line[there] == moves.line[row]).all()
    c = motion.rotary[:, 0]
    assert c[row + 1] == c[row + 2] == c[row]
    assert abs(c[row + 3] - c[row]) == pytest.approx(360.0)
    assert c[row + 5] == c[row + 4] == c[row + 3]
    assert abs(c[row + 6] - c[row + 5]) < 3.0
    joints = slide_positions(CA, rows.tip, motion.rotary)
    tip, axis = forward(CA, joints)
    assert np.abs(tip - rows.tip).max() < 1e-9
    assert np.abs(axis - rows.axis).max() < 1e-9


@pytest.mark.parametrize(
    ("setting", "clear"),
    [
        (Clearance(90.0, ClearanceSurface.PLANE), lambda tip: abs(tip[2] - 90.0)),
        (Clearance(120.0, ClearanceSurface.SPHERE), lambda tip: abs(np.linalg.norm(tip) - 120.0)),
        (Clearance(-5.0, ClearanceSurface.PLANE), None),
        (Clearance(1.0, ClearanceSurface.SPHERE), None),
    ],
)
def test_the_tool_retracts_to_a_plane_or_out_of_a_sphere(
    setting: Clearance, clear: Callable[[Floats], float] | None
) -> None:
    moves = round_part()
    row, rows = added(planned(operation_of(moves), options=PlanOptions(clearance=setting)).motions[0], moves)
    there = rows.tip[row + 2 if len(rows) == len(moves) + 5 else row + 1]
    way = there - moves.tip[row]
    assert np.linalg.norm(np.cross(way, moves.axis[row])) < 1e-9
    assert way @ moves.axis[row] >= MIN_RETRACT - 1e-9
    if clear is None:  # it is outside already
        assert way @ moves.axis[row] == pytest.approx(MIN_RETRACT)
    else:
        assert clear(there) < 1e-9


def test_a_short_retract_is_at_a_feed_throughout() -> None:
    moves = round_part()
    short = planned(operation_of(moves), options=PlanOptions(clearance=Clearance(3.0))).motions[0]
    assert (short.operation.moves.kind == Kind.RAPID).sum() == 1


def test_many_rewinds_are_one_warning_with_their_number_and_time() -> None:
    path = winding(40.0, 0.0, 3000.0, 900)
    (problem,) = planned(operation_of(replace(path, tip=40.0 * path.axis))).problems
    assert problem.severity is Severity.WARNING
    found = re.search(r"50 mm in the cut to rewind (\d+) times, in lines (\d+), .* some (.*) in all", problem.what)
    assert found
    assert int(found[1]) >= 3
    assert problem.line == int(found[2])


def test_an_axis_that_ends_turns_from_home_is_told_with_the_time_of_its_way_back() -> None:
    path = operation_of(winding(40.0, 0.0, 3600.0, 900), "HELIX")
    adding_up = next(axis for axis in load_machine("generic_head_table_bc").axes if axis.name == "C")
    (problem,) = planned(path, load_machine("generic_head_table_bc")).problems
    assert adding_up.rapid == 18000.0
    assert (problem.severity, problem.line) == (Severity.WARNING, int(path.moves.line[-1]))
    assert problem.what == "HELIX: axis C ends 10 turns from home, and turns back, 12.0 s at its rapid speed"
    assert 'output = "0..360"' in problem.cure
    assert planned(path, load_machine("yl569")).problems == (), "it is displayed within one turn"


def test_a_level_tool_does_not_retract_to_a_plane() -> None:
    moves = winding(89.5, 100.0, 1100.0, 400)
    moves = replace(moves, tip=40.0 * moves.axis)
    found = planned(operation_of(moves), options=PlanOptions(clearance=Clearance(90.0, ClearanceSurface.PLANE)))
    errors = [p for p in found.problems if p.severity is Severity.ERROR]
    assert errors[0].what.endswith("its axis does not lead to the clearance plane:90")
    assert np.isfinite(found.motions[0].operation.moves.tip).all()


def test_a_rewind_is_announced_in_the_program_and_in_a_warning() -> None:
    found = planned(operation_of(round_part()))
    notes = [event for event in found.motions[0].operation.events if isinstance(event, Message)]
    assert len(notes) == 1
    assert notes[0].text.startswith("Rewind: C ")
    assert "above its limit 360 degrees in line" in notes[0].text
    assert [p.severity for p in found.problems] == [Severity.WARNING]
    assert "draws back 50 mm in the cut to rewind" in found.problems[0].what
    row, _ = added(found.motions[0], round_part())
    assert notes[0].row == row + 1


def test_without_rewinds_the_program_is_refused_with_line_axis_value_and_limit() -> None:
    found = planned(operation_of(round_part()), options=PlanOptions(allow_rewinds=False))
    assert len(found.motions[0].operation.moves) == 400
    (problem,) = found.problems
    assert problem.severity is Severity.ERROR
    assert problem.line > 10
    assert "axis C would go to 36" in problem.what
    assert "above its limit 360 degrees in the cut" in problem.what
    assert "setting rewind=insert" in problem.cure


def test_with_a_known_workpiece_zero_a_retract_keeps_the_limits_of_the_slides() -> None:
    known = replace(CA, workpiece_zero=(0.0, 0.0, 100.0))
    assert [p.severity for p in planned(operation_of(round_part()), known).problems] == [Severity.WARNING]
    found = planned(operation_of(round_part()), known, PlanOptions(clearance=Clearance(1800.0))).problems
    errors = [p for p in found if p.severity is Severity.ERROR]
    assert len(errors) == 1
    assert "on the retract for a rewind axis" in errors[0].what
    assert "setting clearance=MM" in errors[0].cure


def test_without_a_workpiece_zero_a_retract_needs_travel_too() -> None:
    found = planned(operation_of(round_part()), options=PlanOptions(clearance=Clearance(3000.0))).problems
    assert any("has room for" in p.what for p in found)


def test_no_rewind_within_radius_compensation() -> None:
    operation = replace(operation_of(round_part()), events=(CutterComp(3, 13, "LEFT"),))
    assert "a rewind within cutter radius compensation" in [p.what for p in planned(operation).problems]
    ended = replace(operation, events=(CutterComp(3, 13, "LEFT"), CutterComp(9, 19, "OFF")))
    assert [p.severity for p in planned(ended).problems] == [Severity.WARNING]


def test_events_and_arcs_stay_at_their_rows() -> None:
    moves = round_part()
    axis, kind = moves.axis.copy(), moves.kind.copy()
    axis[390], kind[390] = axis[389], Kind.ARC
    moves = replace(moves, axis=axis, kind=kind)
    centre = 0.5 * (moves.tip[389] + moves.tip[390])
    arcs = Arcs(np.array([390]), centre[None], np.array([[0.0, 0.0, 1.0]]), np.ones(1), np.zeros(1, np.int64))
    events = (SpindleOn(0, 10, 900.0), Dwell(5, 15, 1.0), Dwell(389, 399, 2.0), Dwell(400, 410, 3.0))
    operation = replace(operation_of(moves), arcs=arcs, events=events)
    after = planned(operation).motions[0].operation
    added_rows = len(after.moves) - 400
    assert added_rows == 5
    assert after.arcs.row.tolist() == [395]
    assert [e.row for e in after.events if not isinstance(e, Message)] == [0, 5, 394, 405]
    assert [event.row for event in after.events] == sorted(event.row for event in after.events)


def posted(folder: Path, moves: Moves, *extra: str, machine: str = "generic_head_head_ca") -> tuple[int, Path]:
    """Exit code and program of a CL file with these moves, through the command line."""
    cl, program = folder / "part.cls", folder / "part.mpf"
    operation = replace(operation_of(moves, "ROUND"), events=(SpindleOn(0, 1, 1000.0),), intol=0.01, outtol=0.01)
    with cl.open("wb") as sink:
        write_cl(Toolpath("part.cls", (operation,)), sink)
    code = main(["post", str(cl), "--machine", machine, "--set", "tool=1", "--output", str(program), *extra])
    return code, program


def test_a_program_with_a_rewind_is_proven(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, program = posted(tmp_path, round_part(), "--explain")
    err = capfd.readouterr().err
    assert code == 0, err
    assert "1 retract along the tool axis to turn" in err
    assert "1 rewind and" in err
    assert "from point to point the nearest pose would have had" in err
    assert "starts at C -350.000 A -40.000; nearest to home is C 10.000 A -40.000, but from there axis C" in err
    assert program.read_text(encoding="utf-8").count(";Rewind: ") == 1


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("rewind=perhaps", "write rewind=insert or rewind=none"),
        ("clearance=far", "write clearance=MM or plane:Z or sphere:R"),
        ("clearance=nan", "write clearance=MM or plane:Z or sphere:R"),
        ("clearance=-5", "write clearance=MM or plane:Z or sphere:R"),
        ("clearance=cone:5", "write clearance=MM or plane:Z or sphere:R"),
        ("clearance=sphere:-5", "write clearance=MM or plane:Z or sphere:R"),
    ],
)
def test_meaningless_settings_are_refused(
    setting: str, message: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, program = posted(tmp_path, round_part(), "--set", setting)
    assert code == 2
    assert message in capfd.readouterr().err
    assert not program.exists()


def test_rewinds_can_be_forbidden(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, program = posted(tmp_path, round_part(), "--set", "rewind=none")
    assert code == 1
    assert "axis C would go to" in capfd.readouterr().err
    assert not program.exists()


# The retract in verification.


def blocks_of(text: str) -> tuple[list[str], int]:
    """Lines of a program without block numbers, and the index at which the retract begins."""
    lines = [line.partition(" ")[2] for line in text.splitlines()]
    note = next(k for k, line in enumerate(lines) if line.startswith(";Rewind"))
    return lines, note + 2


def shifted(block: str, letter: str, by: float) -> str:
    """A block with one of its numbers changed."""
    words = block.split(" ")
    return " ".join(f"{letter}{float(w[1:]) + by:.5f}" if w[0] == letter else w for w in words)


#: From the first block of the retract on: out to 2 mm, to the clearance at rapid, a phase, the turn, back to 2 mm, a
#: phase, the way back to the cut.
FAULTS: dict[str, Callable[[list[str], int], list[str]]] = {
    "comes back elsewhere": lambda lines, k: [*lines[: k + 6], shifted(lines[k + 6], "X", 0.01), *lines[k + 7 :]],
    "leaves to the side": lambda lines, k: [*lines[: k + 1], shifted(lines[k + 1], "X", 1.0), *lines[k + 2 :]],
    "turns at the part": lambda lines, k: [
        *lines[:k], f"G0 {lines[k + 3]}", f"G1 {lines[k]}", *lines[k + 1 : k + 3], *lines[k + 4 :]
    ],
    "comes back at rapid": lambda lines, k: [
        *lines[: k + 6], lines[k + 6].replace("G1 ", "").replace(" F50.", ""), "G1 F50.", *lines[k + 7 :]
    ],
    "comes back faster than it goes on": lambda lines, k: [
        *lines[: k + 6], lines[k + 6].replace("F50.", "F5000."), *lines[k + 7 :]
    ],
    "leaves at rapid": lambda lines, k: [*lines[:k], f"G0 {lines[k]}", *lines[k + 1 :]],
    "leaves at rapid at once": lambda lines, k: [*lines[:k], *lines[k + 1 :]],
    "never turns": lambda lines, k: [*lines[: k + 3], *lines[k + 4 :]],
    "does not come back": lambda lines, k: [*lines[: k + 4], f"G1 {lines[k + 8]}", *lines[k + 9 :]],
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_verification_reports_a_faulty_retract(fault: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, program = posted(tmp_path, round_part())
    assert code == 0, capfd.readouterr().err
    lines, k = blocks_of(program.read_text(encoding="utf-8"))
    program.write_text("\n".join(FAULTS[fault](lines, k)) + "\n", encoding="utf-8")
    code = main(["verify", str(program), "--machine", "generic_head_head_ca", "--tool", "1",
                 "--cl", str(tmp_path / "part.cls")])  # fmt: skip
    said = "".join(capfd.readouterr())
    assert code == 1, said
    assert "order         FAIL" in said or "tip           FAIL" in said


def test_the_same_program_without_a_fault_is_proven(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    _, program = posted(tmp_path, round_part())
    lines, _ = blocks_of(program.read_text(encoding="utf-8"))
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    code = main(["verify", str(program), "--machine", "generic_head_head_ca", "--tool", "1",
                 "--cl", str(tmp_path / "part.cls")])  # fmt: skip
    said = capfd.readouterr()
    assert code == 0, said.out + said.err
    assert "1 retract along the tool axis to turn" in said.out + said.err


def test_a_move_into_the_part_is_no_retract(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    _, program = posted(tmp_path, round_part())
    lines, k = blocks_of(program.read_text(encoding="utf-8"))
    out, back = (np.array([float(w[1:]) for w in lines[i].split(" ") if w[0] in "XYZ"]) for i in (k, k + 6))
    x, y, z = 2.0 * back - out
    lines[k] = f"X{x:.5f} Y{y:.5f} Z{z:.5f}"
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    capfd.readouterr()
    code = main(["verify", str(program), "--machine", "generic_head_head_ca", "--tool", "1",
                 "--cl", str(tmp_path / "part.cls")])  # fmt: skip
    assert code == 1
    assert "goes to a position that is not a CL point" in "".join(capfd.readouterr())


# Messages and the log.


def test_over_travel_names_the_missing_angle_and_the_other_pose() -> None:
    axis: Floats = directions(np.array([110.0]), np.array([0.0]))
    (problem,) = planned(operation_of(moves_of(np.zeros((1, 3)), axis)), load_machine("yl569")).problems
    assert problem.what == "axis B would go to 110.00000, above its limit 100 degrees"
    assert problem.cure.startswith("tilt the workpiece by 10.000 degrees (in the other pose B would go to -110.00000)")


def test_every_start_change_and_rewind_is_in_the_log() -> None:
    found = planned(operation_of(round_part(), "ROUND"), options=PlanOptions(explain=True))
    assert [d.topic for d in found.decisions] == [DecisionTopic.START, DecisionTopic.REWIND, DecisionTopic.NEAREST]
    assert all(d.operation == "ROUND" and d.file == "part.cls" and d.line >= 10 for d in found.decisions)
    near = planned(operation_of(winding(40.0, 100.0, 200.0)), options=PlanOptions(explain=True))
    assert [d.topic for d in near.decisions] == [DecisionTopic.START, DecisionTopic.NEAREST]
    assert "the pose nearest to home" in near.decisions[0].text
    assert not planned(operation_of(round_part(), "ROUND")).decisions, "nobody asked"


def test_a_path_over_the_pole_is_in_the_log() -> None:
    moves = moves_of(np.zeros((121, 3)), directions(np.linspace(-60.0, 60.0, 121), np.full(121, 30.0)))
    log = planned(operation_of(moves), options=PlanOptions(explain=True)).decisions
    assert [d.topic for d in log] == [DecisionTopic.START, DecisionTopic.POLE, DecisionTopic.NEAREST]
    assert "goes through the pole" in log[1].text


@settings(deadline=None, max_examples=examples(25))
@given(st.floats(5.0, 80.0), st.floats(-400.0, 400.0), st.floats(-3000.0, 3000.0), st.integers(200, 900))
def test_inserted_rows_keep_limits_and_points(tilt: float, start: float, sweep: float, n: int) -> None:
    moves = winding(tilt, start, start + sweep, n)
    found = planned(operation_of(replace(moves, tip=40.0 * moves.axis)))
    motion = found.motions[0]
    rows = motion.operation.moves
    tip, axis = forward(CA, slide_positions(CA, rows.tip, motion.rotary))
    assert np.abs(tip - rows.tip).max() < 1e-6
    assert np.abs(axis - rows.axis).max() < 1e-7
    assert np.abs(motion.rotary[:, 0]).max() <= 360.0
    kept = np.ones(len(rows), bool)
    for k in np.flatnonzero(rows.kind == Kind.RAPID):
        kept[k - 1 : k + 2] = False  # the rapids, and the lines before and behind them
    assert np.array_equal(rows.tip[kept], 40.0 * moves.axis)
    steps = np.abs(np.diff(motion.rotary, axis=0))[rows.kind[1:] != Kind.RAPID]
    assert steps.max() < 20.0 + 2.0 * abs(sweep) / n, "in the cut no axis winds back"


def test_a_step_too_coarse_for_a_branch_change_is_refused() -> None:
    narrow = with_limits(BC, C=(-80, 80), B=(-110, 110))
    moves = moves_of(np.zeros((3, 3)), directions(np.full(3, 40.0), np.array([60.0, 70.0, 110.0])))
    (problem,) = planned(operation_of(moves), narrow).problems
    assert (problem.severity, problem.line) == (Severity.ERROR, 12)
    assert "flip between these two points, C 70.000 B 40.000 to C -70.000 B -40.000" in problem.what
    assert "points nearer to each other" in problem.cure
