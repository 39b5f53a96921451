"""Tilts by a fixture against the inverse map, and against all orientations of a dense grid."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.placed_paths import brute_margin, limited_machines, random_rows, turned_by
from trunnion.arrays import Floats
from trunnion.errors import Problem
from trunnion.machines import Machine, load_machine
from trunnion.model.clamping import Clamping
from trunnion.model.clamping_notices import HeadNotices
from trunnion.model.rotations import about_x
from trunnion.placing.best_turn import Grid, best_of_turn, best_orientations
from trunnion.placing.path_rows import PathRows
from trunnion.placing.program_heads import placed_notices, stated_place, unlike_bodies, unlike_cl_files, unlike_zero
from trunnion.placing.turns import TurnedPath, choices_of

YL569 = load_machine("yl569")

PHASES = [Phase.explicit, Phase.generate]


def tilted_by(degrees: float, vectors: Floats) -> Floats:
    """Vectors (n, 3) turned about X, in the plainest way: +Y goes up to +Z."""
    angle = np.radians(degrees)
    y, z = vectors[:, 1], vectors[:, 2]
    return np.column_stack(
        (vectors[:, 0], np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z)
    )


def paths_at(machine: Machine, rows: PathRows, tilt: float) -> list[TurnedPath]:
    tilted = rows.turned(about_x(tilt))
    return [TurnedPath.of(machine, choice, each, np.zeros(3)) for choice, each in choices_of(tilted)]


def test_the_tilt_comes_first_and_both_are_right_handed() -> None:
    assert (Clamping(0.0, 90.0).rotation @ [0.0, 1.0, 0.0]).tolist() == [0.0, 0.0, 1.0]
    assert (Clamping(90.0, 0.0).rotation @ [1.0, 0.0, 0.0]).tolist() == [0.0, 1.0, 0.0]
    assert (Clamping(90.0, 90.0).rotation @ [0.0, 1.0, 0.0]).tolist() == [0.0, 0.0, 1.0]
    assert (Clamping(90.0, 90.0).rotation @ [0.0, 0.0, 1.0]).tolist() == [1.0, 0.0, 0.0]  # to -Y, and on to +X


@settings(max_examples=examples(3), deadline=None, phases=PHASES)
@given(machine=limited_machines(), seed=st.integers(0, 10**6))
def test_the_best_orientation_is_as_good_by_the_inverse_map_and_as_any_of_the_grid(machine: Machine, seed: int) -> None:
    rows = random_rows(seed, 8)
    assume(np.isfinite(machine.limits[list(machine.linear)]).any())
    grid = Grid(np.array([0.0, 100.0, 250.0]), np.array([-40.0, 0.0, 40.0]))
    results, best = best_orientations(lambda tilt: paths_at(machine, rows, tilt), grid, lambda _: None)
    assume(best.best is not None and best.path is not None and best.cuts is not None)
    assert best.best is not None
    assert best.path is not None
    assert best.cuts is not None
    assume(all(np.abs(part.forms.normals).max() < 20.0 for part in best.cuts.parts))
    # The winning place again, with tips and axes that are turned here.
    chosen = next(each for choice, each in choices_of(rows.turned(about_x(best.tilt))) if choice == best.path.choice)
    turned = replace(
        rows, tip=tilted_by(best.tilt, rows.tip), axis=tilted_by(best.tilt, rows.axis), branch=chosen.branch
    )
    assert brute_margin(machine, turned, best.turn, best.best.zero) == pytest.approx(best.margin, abs=1e-5) or (
        best.margin == 2000.0
    )
    # No orientation of the grid, judged by itself, is better.
    for turn in grid.turns.tolist():
        for tilt in grid.tilts.tolist():
            alone = best_of_turn(paths_at(machine, rows, tilt), turn)
            assert best.margin >= alone.margin - 0.01 * max(alone.margin, 0.0) - 1e-5
    keys = [(one.tilt, one.turn) for one in results]
    assert keys == sorted(set(keys))
    assert max(abs(one.tilt) for one in results) <= 40.0


def test_refined_orientations_reach_what_a_dense_search_finds() -> None:
    machine = load_machine("xyzbc_trt")
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-240.0, high=240.0) for axis in machine.axes)
    machine = replace(machine, axes=axes, tool_length=100.0)
    rows = random_rows(5, 12)
    rows = replace(rows, axis=np.abs(rows.axis), branch=np.zeros(12, np.uint8))
    _, best = best_orientations(
        lambda tilt: paths_at(machine, rows, tilt)[:1],
        Grid(np.arange(0.0, 360.0, 30.0), np.arange(-90.0, 91.0, 30.0), True, True),
        lambda _: None,
    )
    dense = 0.0
    for tilt in np.arange(-84.0, 85.0, 12.0).tolist():
        paths = paths_at(machine, rows, tilt)[:1]
        dense = max(dense, *(best_of_turn(paths, turn).margin for turn in np.arange(0.0, 360.0, 20.0).tolist()))
    assert dense > 0.0
    assert best.margin >= 0.98 * dense


def test_of_turns_with_like_margins_the_one_whose_rotary_axes_have_most_room_is_taken() -> None:
    """The slides are long enough at every turn: A, which tilts the table, decides."""
    machine = load_machine("xyzac_trt")
    axes = tuple(
        replace(axis, low=-60.0, high=60.0) if axis.name == "A" else replace(axis, low=-9e4, high=9e4)
        for axis in machine.axes
    )
    machine = replace(machine, axes=axes, tool_length=100.0)
    tip, lean = np.zeros((40, 3)), np.radians(np.linspace(0.0, 40.0, 40))
    rows = random_rows(1, 40)
    rows = replace(rows, tip=tip, axis=np.column_stack((np.zeros(40), np.sin(lean), np.cos(lean))))
    rows = replace(rows, branch=np.zeros(40, np.uint8))
    grid = Grid(np.array([0.0]), np.array([0.0, 10.0, 20.0, 30.0]))
    results, best = best_orientations(lambda tilt: paths_at(machine, rows, tilt)[:1], grid, lambda _: None)
    assert [one.margin for one in results] == pytest.approx([2000.0] * 4)
    # The axes lean 0 to 40 degrees to +Y; a tilt of 20 brings them to -20 to 20 about +Z.
    assert best.tilt == 20.0


def test_a_part_that_no_table_reaches_as_it_is_drawn_is_placed_and_posted_tilted(tmp_path: Path) -> None:
    """The tool comes from 20 degrees below the horizon; B ends at 100 degrees."""
    cl = tmp_path / "under.cls"
    lean = np.radians(110.0)
    axis = f"0.0000000,{-np.sin(lean):.7f},{np.cos(lean):.7f}"
    cl.write_text(
        "TOOL PATH/UNDER,TOOL,D10\nTLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000\n"
        "MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000\n"
        "PAINT/PATH\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\n"
        f"GOTO/0.0000,-60.0000,0.0000,{axis}\nFEDRAT/MMPM,200.0\nGOTO/0.0000,-30.0000,0.0000,{axis}\n"
        f"GOTO/20.0000,-30.0000,0.0000,{axis}\nRAPID\nGOTO/20.0000,-60.0000,0.0000,{axis}\nEND-OF-PATH\n",
        "utf-8",
    )
    drawn = trunnion.place(cl, machine="yl569", tool_length=80.0, turns=[0.0])
    assert drawn.best is None
    assert "B would have to leave its travel, -11 to 100 degrees" in drawn.turns[0].obstacle
    found = trunnion.place(cl, machine="yl569", tool_length=80.0, turns=[0.0, 90.0], tilts=15.0)
    assert found.fits
    assert found.tilt_deg is not None
    assert found.tilt_deg <= -10.0  # that brings it up
    assert [turn.fits for turn in found.turns if turn.tilt_deg == 0.0] == [False, False]
    assert found.zero_mm is not None
    assert found.turn_deg is not None
    assert found.margin_at(found.zero_mm, found.turn_deg, found.tilt_deg) == found.margin_mm
    posted = trunnion.post_placed(found, machine="yl569", settings={"tool_length": 80.0})
    assert posted.passed


def unlike_head(
    program: Path, turn: float, tilt: float, of_cl: Clamping | None = None, machine: Machine = YL569
) -> list[Problem]:
    """What a comparison with CL files warns of that are turned by these angles."""
    clamped = (of_cl or Clamping()).then(turn, tilt)
    assert clamped is not None
    return unlike_cl_files(program, Clamping(turn, tilt), clamped, of_cl, machine)


def head(path: Path, *notices: str) -> Path:
    path.write_text("\n".join(f"({text})" for text in notices) + "\nN10 G21\n", "utf-8")
    return path


def test_notices_are_found_again(tmp_path: Path) -> None:
    notices = placed_notices(Clamping(-45.0, 30.0), (1.0, -2.0, 3.5), 120.25)
    assert notices[1].startswith("PART TURNED 315 DEG ABOUT Z, COUNTER-CLOCKWISE")
    longest = placed_notices(Clamping(312.656, -37.125), (-246.014, -407.304, -136.189), 1120.125)
    assert max(map(len, longest)) <= 76  # one line each
    assert notices[3] == "ZERO FOR TOOL LENGTH 120.25 MM, FROM GAUGE POINT TO TIP"
    program = head(tmp_path / "head.nc", *notices)
    assert unlike_head(tmp_path, 315.0, 30.0) == unlike_head(tmp_path / "none.nc", 0.0, 0.0) == []
    assert unlike_head(program, 315.0, 30.0) == unlike_head(program, -45.0, 30.0) == []
    assert [problem.code for problem in unlike_head(program, 45.0, 30.0)] == ["PLC220"]
    assert [problem.code for problem in unlike_head(program, 315.0, 0.0)] == ["PLC220"]
    assert stated_place(program) == HeadNotices(Clamping(315.0, 30.0), (1.0, -2.0, 3.5), 120.25)


def test_a_comparison_is_told_the_angles_that_lead_from_the_cl_file_to_the_head(tmp_path: Path) -> None:
    program = head(tmp_path / "head.nc", *placed_notices(Clamping(45.0, 20.0)))
    stated = Clamping(30.0, 20.0)
    assert unlike_head(program, 15.0, 0.0, stated) == unlike_head(program, -345.0, 0.0, stated) == []
    (plain,) = unlike_head(program, 0.0, 0.0, stated)
    assert plain.cure.startswith("give the turn 15, so that")
    assert "the CL file states that it is tilted by 20 degrees about X and turned by 30 degrees about Z" in plain.what
    (more,) = unlike_head(program, 10.0, 0.0, stated)
    assert "what is given makes that tilted by 20 degrees about X and turned by 40 degrees about Z" in more.what
    (drawn,) = unlike_head(program, 0.0, 0.0)
    assert drawn.cure.startswith("give the turn 45 and the tilt 20, so that")
    (upright,) = unlike_head(program, 0.0, 0.0, Clamping(0.0, 5.0))
    assert upright.cure.startswith("give the turn 45 and the tilt 15, so that")
    (other,) = unlike_head(program, 0.0, 0.0, Clamping(30.0, 5.0))
    assert other.cure.startswith("no turn and tilt lead from one to the other")


def test_a_zero_and_a_tool_length_other_than_those_of_the_head_are_told(tmp_path: Path) -> None:
    program = tmp_path / "head.nc"
    program.write_text("\n".join(f"({text})" for text in placed_notices(Clamping(), (1.0, -2.0, 3.5), 120.0)), "utf-8")
    machine = load_machine("yl569")
    same = replace(machine, workpiece_zero=(1.0, -2.001, 3.5), tool_length=120.0)
    assert unlike_zero(program, machine) == unlike_head(program, 0.0, 0.0, None, same) == []
    (other,) = unlike_zero(program, replace(machine, workpiece_zero=(1.0, -2.0, 3.6)))
    assert other.code == "PLC240"
    assert "the workpiece zero is at 1,-2,3.5, and the linear axes are judged with zero 1,-2,3.6" in other.what
    (longer,) = unlike_bodies(program, Clamping(), replace(machine, tool_length=150.0))
    assert "holds for a tool length of 120 mm" in longer.what
    # It says that the part is not turned: a turn is another clamping.
    assert [problem.code for problem in unlike_head(program, 45.0, 0.0)] == ["PLC220"]
    assert "clamped as it is drawn" in unlike_bodies(program, Clamping(45.0), machine)[0].what
    unknown = placed_notices(Clamping(), (1.0, -2.0, 3.5), None)
    assert unknown[2] == "ZERO FOR TOOL LENGTH 0 MM: NO LENGTH WAS STATED"
    program.write_text("\n".join(f"; {text}" for text in unknown), "utf-8")
    found = stated_place(program)
    assert found.zero == (1.0, -2.0, 3.5)
    assert found.tool_length is None


def test_a_plain_turn_of_rows_is_what_was_turned_before() -> None:
    rows = random_rows(2, 6)
    assert np.allclose(rows.turned(Clamping(33.0, 0.0).rotation).tip, turned_by(33.0, rows.tip))
    assert np.allclose(rows.turned(Clamping(33.0, 21.0).rotation).tip, turned_by(33.0, tilted_by(21.0, rows.tip)))
