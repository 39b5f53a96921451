"""Cycles 27 and 28: a contour on a cylinder that turns with the table, against the forward kinematics."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.klartext_cycles import define
from tests.support.locations import GOLDEN
from tests.support.reading import Runner, close
from trunnion.arrays import Floats
from trunnion.machines import Machine, forward, load_machine
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

GROOVE = GOLDEN / "cylinder"

VALUES = {"Q1": -7.0, "Q3": 0.0, "Q6": 2.0, "Q10": 4.0, "Q11": 100.0, "Q12": 250.0, "Q16": 25.0, "Q17": 1.0}
SLOT = {**VALUES, "Q20": 8.0, "Q21": 0.0}

#: A contour in lengths of arc, the same in degrees, and where it goes: arc and coordinate along the axis.
IN_MM = "L C+40 Y+20 R0\nL C+50\nL Y+60\nL IC-20\nL C+40 Y+20\n"
IN_DEGREES = "L C+91.673247 Y+20 R0\nL C+114.591559\nL Y+60\nL IC-45.836624\nL C+91.673247 Y+20\n"
PATH = np.array([(40, 20), (50, 20), (50, 60), (30, 60), (40, 20)], dtype=float)


def program(
    contour: str = IN_MM, number: int = 27, *, before: str = "L X+0 Y+0 R0 FMAX\nL Z+60 FMAX\n", label: str = "1",
    tilt: str = "L A-90 C+0 R0 FMAX\n", **others: float,
) -> str:  # fmt: skip
    values = {**(SLOT if number == 28 else VALUES), **others}
    return (
        f"TOOL CALL 1 Z S2000\n{tilt}{before}CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL{label}\n"
        f"{define(number, **values)}CYCL CALL M3\nM30\nLBL 1\n{contour}LBL 0\n"
    )


@pytest.fixture
def run(run: Runner, dmu65: Machine) -> Runner:
    """Run a text on a machine whose zero is known: the crossing of A and C."""
    placed = replace(dmu65, workpiece_zero=(0.0, 0.0, 0.0))
    return lambda text, machine=placed: run(text, machine)


def unrolled(run: Run, kind: Kind, radius: float = 25.0) -> Floats:
    """Arc at a radius, coordinate along the axis and distance from it of the tips of one kind, in the workpiece."""
    tip = run.tip[run.kind == kind]
    # Turning the table by +C takes the tool round the part by -C about +Z of the part; it starts at +Y.
    turn = np.unwrap(np.arctan2(tip[:, 0], tip[:, 1]))
    return np.stack((np.mod(turn, 2 * math.pi) * radius, tip[:, 2], np.hypot(tip[:, 0], tip[:, 1])), axis=1)


@pytest.mark.parametrize(("contour", "dimension"), [(IN_MM, 1.0), (IN_DEGREES, 0.0)])
def test_the_tip_lies_on_the_cylinder_below_the_surface(contour: str, dimension: float, run: Runner) -> None:
    found = run(program(contour, Q17=dimension))
    assert not found.errors
    cuts = unrolled(found, Kind.LINEAR)
    along = np.abs(cuts[:, 1])
    assert set(np.round(cuts[:, 2], 6)) == {21.0, 18.0}
    close(along, np.tile(PATH[:, 1], 2), atol=1e-6)
    arcs = cuts[:, 0] if abs(cuts[0, 0] - 40.0) < 1.0 else 2 * math.pi * 25.0 - cuts[:, 0]
    close(arcs, np.tile(PATH[:, 0], 2), atol=1e-5)


def test_between_two_points_the_tool_stays_on_its_cylinder(run: Runner) -> None:
    """Rotary and linear axis go together, so that the middle of a motion is as deep as its ends."""
    found = run(program())
    joints = found.joints[np.flatnonzero(found.kind == Kind.LINEAR)]
    middles = forward(found.machine, 0.5 * (joints[1:5] + joints[:4]))[0]
    close(np.hypot(middles[:, 0], middles[:, 1]), np.full(4, 21.0), atol=1e-9)


def test_rapids_are_above_the_surface_and_end_over_the_first_point(run: Runner) -> None:
    rapids = unrolled(run(program()), Kind.RAPID)
    assert (rapids[2:, 2] > 27.0 - 1e-6).all()
    close(rapids[-1, 2], 27.0, atol=1e-9)
    close(abs(rapids[-1, 1]), 20.0, atol=1e-9)


def test_a_tool_that_stands_lower_goes_up_first(run: Runner) -> None:
    found = run(program(before="L X+0 Y+70 R0 FMAX\nL Z+10 FMAX\n"))
    assert not found.errors
    tips = found.tip[found.kind == Kind.RAPID]
    first = int(np.flatnonzero(np.abs(np.hypot(tips[:, 0], tips[:, 1]) - 10.0) < 1e-9)[0]) + 1
    close(np.hypot(*tips[first, :2]), 27.0, atol=1e-9)
    close(abs(tips[first, 2]), 70.0, atol=1e-9)


def test_feeds_are_those_of_the_cycle_and_count_the_way_of_the_tip(run: Runner) -> None:
    found = run(program())
    cuts = np.flatnonzero(found.kind == Kind.LINEAR)
    assert [float(found.state.feed[int(row)]) for row in cuts[:3]] == [100.0, 250.0, 250.0]
    assert {int(found.state.feed_path[int(row)]) for row in cuts} == {int(FeedPath.TIP)}


def test_corners_are_rounded_and_chamfered_in_the_unrolled_plane(run: Runner) -> None:
    rounded = run(program("L C+0 Y+20 R0\nL C+30\nRND R5\nL Y+60\nCHF 3\nL C+0\n", Q10=7.0))
    assert not rounded.errors
    cuts = unrolled(rounded, Kind.LINEAR)
    arcs, along = np.minimum(cuts[:, 0], 2 * math.pi * 25.0 - cuts[:, 0]), np.abs(cuts[:, 1])
    within = (arcs > 25.0 + 1e-6) & (along < 25.0 - 1e-6)
    assert within.sum() > 10
    close(np.hypot(arcs[within] - 25.0, along[within] - 25.0), np.full(int(within.sum()), 5.0), atol=1e-6)
    close([arcs[-3], along[-3]], [30.0, 57.0], atol=1e-6)
    close([arcs[-2], along[-2]], [27.0, 60.0], atol=1e-6)


def test_more_than_a_turn_goes_on(run: Runner) -> None:
    found = run(program("L C+0 Y+20 R0\nL C+800 Y+60\n", Q17=0.0))
    turned = found.joints[:, found.machine.column("C")]
    cut = np.flatnonzero(found.kind == Kind.LINEAR)
    assert turned[cut[1]] - turned[cut[0]] == pytest.approx(800.0)


def test_parameters_count_as_they_are_at_the_call(run: Runner) -> None:
    text = program(IN_MM.replace("C+50", "C+Q50")).replace("CYCL CALL", "Q50 = 45\nQ1 = -4\nCYCL CALL")
    found = run(text)
    assert not found.errors
    assert set(np.round(unrolled(found, Kind.LINEAR)[:, 2], 6)) == {21.0}


def test_a_slot_is_its_middle_with_a_warning(run: Runner) -> None:
    found = run(program(number=28))
    assert not found.errors
    assert any("middle of the slot" in each.text for each in found.diagnostics)
    close(run(program()).tip, found.tip, atol=1e-12)


def test_a_compensated_contour_is_the_wall_with_a_warning(run: Runner) -> None:
    found = run(program(IN_MM.replace("R0", "RL")))
    assert not found.errors
    assert any("radius is the control's" in each.text for each in found.diagnostics)
    assert not any("cycle 27" in each.text for each in run(program()).diagnostics)


def test_a_call_by_m99_and_a_contour_by_another_label(run: Runner) -> None:
    text = program().replace("CYCL CALL M3", "L M3 M99").replace("LBL 1\n", "LBL 2\nLBL 0\nLBL 1\n")
    close(run(text).tip[-5:], run(program()).tip[-5:], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (program().replace("CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1\n", ""), "has no contour"),
        (program(label="1/2"), "several labels"),
        (program(label=""), "without a label"),
        (program(label="7"), "label 7"),
        (program("L C+0 Y+20 R0\n"), "fewer than two"),
        (program("L C+0 Y+20 R0\nL C+9\nRND R2\n"), "ends in RND"),
        (program("L C+0 Y+20 R0\nL C+9\nRND R20\nL Y+60\n"), "without room"),
        (program("L C+0 Y+20 R0\nRND R2\nL Y+60\n"), "RND needs a line"),
        (program("L C+0 Y+20 R0\nCC C+0 Y+0\nL Y+60\n"), "CC in the contour"),
        (program("L C+0 Y+20 R0\nL C+9 F100\n"), "F"),
        (program("L C+0 Y+20 R0\n/L C+9\nL Y+60\n"), "/ in the contour"),
        (program("L C+0 Y+20 R0\nL C+9 ~\nY+60\n"), "~ in the contour"),
        (program("L X+0 Y+20 R0\nL X+9\n"), "one rotary axis"),
        (program("L B+0 Y+20 R0\nL B+9\n"), "no rotary axis"),
        (program("L C+0 Y+20 R0\nL X+9\n"), "X"),
        (program(Q17=2.0), "Q17=2"),
        (program(Q1=7.0), "above the surface"),
        (program(Q1=0.0), "depth 0"),
        (program(Q1=-25.0), "radius Q16"),
        (program(Q10=0.0), "Q10"),
        (program(Q6=0.0), "Q6"),
        (program(number=28, Q20=0.0), "Q20"),
        (program().replace("Q16=+25 ~\n", ""), "Q16"),
        (program(tilt="L A-45 C+0 R0 FMAX\n"), "square to the axis of C"),
        (program("L C+0 X+20 R0\nL C+9\n"), "X along it"),
        (program(before="L X+3 Y+0 R0 FMAX\nL Z+60 FMAX\n"), "3.000 mm beside"),
        (program().replace("CYCL CALL", "M128\nCYCL CALL"), "with TCP"),
        (program().replace("CYCL CALL", "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30\nCYCL CALL"), "rotated"),
    ],
)  # fmt: skip
def test_what_is_not_known_or_impossible_is_refused(text: str, fault: str, run: Runner) -> None:
    found = run(text)
    assert any(fault in each.text for each in found.errors), [each.text for each in found.errors]
    assert not (found.kind == Kind.LINEAR).any()


@pytest.mark.parametrize("missing", [name for name in SLOT if name != "Q21"])
def test_each_value_must_be_given(missing: str, run: Runner) -> None:
    less = "\n".join(line for line in program(number=28).split("\n") if not line.startswith(f"{missing}="))
    assert any(f"has no {missing}:" in each.text for each in run(less.replace("Q20=+8 ~\nCYCL", "Q20=+8\nCYCL")).errors)


def test_without_a_zero_nobody_knows_where_the_cylinder_turns(run: Runner, dmu65: Machine) -> None:
    found = run(program(), machine=replace(dmu65, workpiece_zero=None))
    assert any("workpiece zero is not known" in each.text for each in found.errors)


def test_a_table_whose_centres_lie_apart(run: Runner) -> None:
    """The cylinder lies about the axis that turns, wherever the chain and the zero place it."""
    machine = load_machine("mikron_600u")
    machine = replace(machine, workpiece_zero=(0.0, 0.0, 100.0))
    found = run(
        program(IN_MM.replace("Y", "X"), tilt="L B-90 C+0 R0 FMAX\n", before="L X+0 Y+0 R0 FMAX\nL Z+60 FMAX\n"),
        machine,
    )
    assert not found.errors, found.errors
    cuts = found.tip[found.kind == Kind.LINEAR]
    close(np.unique(np.round(np.hypot(cuts[:, 0], cuts[:, 1]), 6)), [18.0, 21.0], atol=1e-9)


def test_the_golden_groove(tmp_path: Path) -> None:
    """What the program does, byte for byte."""
    out = tmp_path / "groove.cls"
    trunnion.convert(GROOVE / "groove.h", machine="dmu65", to_cl=True, zero="0,0,200", tool_length=150, output=out)
    assert out.read_bytes() == (GROOVE / "groove.expected.cls").read_bytes()


@pytest.mark.parametrize(("number", "contour"), [(27, "L C+0 Y-240 R0\nL C+360\n"), (28, "L C+0 Y-240 R0\nL C+360\n")])
def test_a_ring_cut_from_the_stock_has_its_volume(number: int, contour: str, tmp_path: Path) -> None:
    """A flat mill of 8 mm takes a ring from the radius 25 down to 18."""
    nc = tmp_path / "ring.h"
    nc.write_text(f"BEGIN PGM RING MM\n{program(contour, number, Q17=0.0)}END PGM RING MM\n")
    found = trunnion.simulate(
        nc, machine="dmu65", zero="0,0,200", tool_length=150, stock="cylinder:50,80,0", cell=1,
        tools=["1=flat:8,length=30,flutes=20"],
    )  # fmt: skip
    assert found.removed == pytest.approx(math.pi * (25.0**2 - 18.0**2) * 8.0, rel=0.02)


def test_what_follows_the_call_goes_on_as_before_it(run: Runner) -> None:
    text = program().replace("L Z+60 FMAX", "L Z+60 FMAX\nL Z+61 F777").replace("M30", "L Z+90\nM30")
    found = run(text)
    assert not found.errors
    assert math.hypot(*found.tip[-1][:2]) == pytest.approx(90.0)
    last = len(found.kind) - 1
    assert (found.kind[last], float(found.state.feed[last])) == (Kind.LINEAR, 777.0)
    assert int(found.state.feed_path[last]) == int(FeedPath.AXES)


def test_two_corners_share_the_line_between_them(run: Runner) -> None:
    contour = "L C+0 Y+0 R0\nL C+20\nRND R{}\nL Y+20\nRND R{}\nL C+0\n"
    assert not run(program(contour.format(10, 10))).errors
    assert any("without room" in each.text for each in run(program(contour.format(12, 9))).errors)
