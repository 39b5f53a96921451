"""Tilted planes, datums and retracts."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext_reading import of_blocks
from tests.support.locations import TESTS
from tests.support.naive.klartext import matrix
from tests.support.reading import Runner, close, slides
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program

DMU65 = load_machine("dmu65")
GOLDEN = TESTS / "golden" / "dmu65"


def ran(text: str, factory: pytest.TempPathFactory) -> Run:
    """Run a text."""
    path = factory.getbasetemp() / "PLANE.H"
    path.write_text(text)
    return of_blocks(run_program(path, DMU65))


def axes(run: Run, row: int) -> tuple[float, float]:
    """A and C."""
    return float(run.joints[row, run.machine.column("A")]), float(run.joints[row, run.machine.column("C")])


# What the control of the machine was told


@pytest.mark.parametrize(
    ("name", "block"),
    re.findall(r"(\w+)\.cls: (.+)", (GOLDEN / "expected_planes.txt").read_text(encoding="utf-8")),
)
def test_planes_that_ran_stand_the_tool_where_the_cl_file_has_it(name: str, block: str, run: Runner) -> None:
    operation = read_cl(GOLDEN / f"{name}.cls").operations[0]
    found = run(f"{block}\nL X+0 Y+0 Z+0")
    assert found.diagnostics == ()
    close(found.axis[-1], operation.moves.axis[-1], atol=1e-5)
    assert axes(found, -1)[0] < 0.0


# One plane in five spellings

angle = st.integers(-890, 890).map(lambda n: n / 10.0)
anywhere = st.integers(-1800, 1800).map(lambda n: n / 10.0)


def spellings(a: float, b: float, c: float) -> list[str]:
    """The plane of spatial angles, said in every way."""
    m = matrix(a, b, c)
    z, x = m[:, 2], m[:, 0]
    nutation = math.acos(min(max(z[2], -1.0), 1.0))
    tilted = math.hypot(z[0], z[1]) > 1e-9
    precession = math.atan2(z[0], -z[1]) if tilted else 0.0
    line = np.array([math.cos(precession), math.sin(precession), 0.0])
    rotation = math.atan2(np.cross(line, x) @ z, line @ x)
    u, v, w = (math.degrees(value) for value in (precession, nutation, rotation))
    p, q, r = 5.0 * m[:, 1], 5.0 * m[:, 1] + 3.0 * x, 7.0 * x + 9.0 * m[:, 1]
    points = " ".join(f"P{k}{n}{v:.12f}" for k, at in ((1, p), (2, q), (3, r)) for n, v in zip("XYZ", at, strict=True))
    return [
        f"PLANE SPATIAL SPA{a:+.3f} SPB{b:+.3f} SPC{c:+.3f}",
        "PLANE VECTOR " + " ".join(f"B{n}{v:.14f}" for n, v in zip("XYZ", x, strict=True))
        + " " + " ".join(f"N{n}{2.0 * v:.14f}" for n, v in zip("XYZ", z, strict=True)),
        f"PLANE EULER EULPR{u:.12f} EULNU{v:.12f} EULROT{w:.12f}",
        f"PLANE POINTS {points}",
        f"PLANE SPATIAL SPA+0 SPB+0 SPC{c:+.3f} STAY\nPLANE RELATIV SPB{b:+.3f} STAY\nPLANE RELATIV SPA{a:+.3f}",
    ]  # fmt: skip


@settings(max_examples=examples(25), deadline=None)
@given(a=angle, b=angle, c=anywhere, point=st.tuples(*[st.integers(-50, 50)] * 3))
def test_one_plane_in_every_spelling_is_one_plane(
    a: float, b: float, c: float, point: tuple[int, int, int], tmp_path_factory: pytest.TempPathFactory
) -> None:
    wanted = matrix(a, b, c)
    for text in spellings(a, b, c):
        x, y, z = point
        shift = "CYCL DEF 7.0 SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 Y-20\nCYCL DEF 7.3 Z+5"
        run = ran(f"{shift}\n{text} TURN FMAX SEQ-\nL X{x} Y{y} Z{z} F100", tmp_path_factory)
        assert run.diagnostics == ()
        close(run.axis[-1], wanted[:, 2], atol=1e-7)
        close(run.tip[-1], wanted @ np.array(point) + [10, -20, 5], atol=1e-7)


@settings(max_examples=examples(25), deadline=None)
@given(a=angle, b=angle, c=anywhere, manner=st.sampled_from(["TURN", "MOVE", "MOVE DIST25", "STAY"]))
def test_turn_keeps_the_slides_and_move_the_point(
    a: float, b: float, c: float, manner: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = f"L X+7 Y-8 Z+30 F100\nPLANE SPATIAL SPA{a:+.3f} SPB{b:+.3f} SPC{c:+.3f} {manner} FMAX SEQ-\nL IX+0"
    run = ran(text, tmp_path_factory)
    assert run.diagnostics == ()
    if manner == "STAY":
        close(run.joints[-1], run.joints[0], atol=1e-9)
        return
    close(run.axis[1], matrix(a, b, c)[:, 2], atol=1e-7)
    if manner == "TURN":
        close(slides(run)[1], slides(run)[0], atol=1e-9)
        return
    # The point at the distance below the tip, along the tool, stays on the workpiece.
    distance = 25.0 if "DIST" in manner else 0.0
    close(run.tip[1] - distance * run.axis[1], run.tip[0] - distance * run.axis[0], atol=1e-7)


@pytest.mark.parametrize(
    ("sequence", "expected"), [("SEQ-", (-30.0, -90.0)), ("SYM-", (-30.0, -90.0)), ("", (-30.0, -90.0))]
)
def test_a_sequence_is_the_sign_of_the_axis_next_to_the_tool(
    sequence: str, expected: tuple[float, float], run: Runner
) -> None:
    # B30: the tool leans towards X. A-30 C-90 does it; A30 C90 is outside the travel.
    found = run(f"PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX {sequence}")
    assert found.diagnostics == ()
    close(axes(found, -1), expected, atol=1e-9)


def test_a_sequence_outside_the_travel_is_refused_and_the_axes_stay(run: Runner) -> None:
    found = run("L X+1 FMAX\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX SEQ+\nL X+2 FMAX")
    assert [finding.line for finding in found.errors] == [2]
    assert axes(found, -1) == (0.0, 0.0)


def test_both_sequences_where_both_are_in_the_travel(run: Runner) -> None:
    machine = load_machine("hs664rt")
    low = run("PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX SEQ-", machine=machine)
    high = run("PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX SEQ+", machine=machine)
    close(low.axis[-1], high.axis[-1], atol=1e-9)
    assert axes(low, -1)[0] < 0.0 < axes(high, -1)[0]
    near = run("L A+20 C-80 FMAX\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX", machine=machine)
    close(axes(near, -1), axes(high, -1), atol=1e-9)


def test_a_free_table_axis_turns_for_table_rot_only(run: Runner) -> None:
    for word, angle_of_c in (("TABLE ROT", 40.0), ("COORD ROT", 0.0), ("", 0.0)):
        found = run(f"PLANE SPATIAL SPA+0 SPB+0 SPC+40 TURN FMAX {word}\nL X+10 Y+0 Z+0")
        assert found.diagnostics == ()
        assert axes(found, -1)[1] == pytest.approx(angle_of_c, abs=1e-9)
        close(found.tip[-1], [10 * math.cos(math.radians(40)), 10 * math.sin(math.radians(40)), 0], atol=1e-9)


def test_the_rotary_position_of_a_plane_that_stays_is_in_q120_to_q122(run: Runner) -> None:
    found = run("PLANE SPATIAL SPA-45 SPB+0 SPC-90 STAY SEQ-\nL X+1 Y+2 Z+3\nL A+Q120 C+Q122 R0 FMAX\nL Z+10")
    assert found.diagnostics == ()
    close(axes(found, -1), (-45, -90), atol=1e-9)
    # Only the rotary axes turned: the slides stood, and the tip is called anew.
    close(slides(found)[1], slides(found)[0], atol=1e-9)
    close(found.axis[-1], [math.sqrt(0.5), 0, math.sqrt(0.5)], atol=1e-9)


def test_a_rotary_word_beside_positions_of_a_tilted_plane(run: Runner) -> None:
    found = run("PLANE SPATIAL SPA-45 SPB+0 SPC-90 STAY SEQ-\nL X+1 Y+2 Z+3 A+Q120 C+Q122 R0 FMAX\nL IZ+4")
    close(found.tip[0], matrix(-45, 0, -90) @ [1, 2, 3], atol=1e-9)
    close(found.tip[1], matrix(-45, 0, -90) @ [1, 2, 7], atol=1e-9)


def test_axial_planes_are_those_that_the_tool_stands_on(run: Runner) -> None:
    found = run("PLANE AXIAL A-30 C+50 TURN FMAX\nL X+1 Y+2 Z+3")
    assert found.diagnostics == ()
    close(found.tip[-1], matrix(-30, 0, 50) @ [1, 2, 3], atol=1e-9)
    close(found.axis[-1], matrix(-30, 0, 50)[:, 2], atol=1e-9)


RESETS = ["PLANE RESET STAY", "PLANE RESET TURN FMAX", "CYCL DEF 19.0 PLANE\nCYCL DEF 19.1"]
TILT = "PLANE SPATIAL SPA-45 SPB+0 SPC+0 TURN FMAX SEQ-\n"
SHIFT = "CYCL DEF 7.0 SHIFT\nCYCL DEF 7.1 X+248\nCYCL DEF 7.2 Y+0\nCYCL DEF 7.3 Z-48\n"
NO_SHIFT = "CYCL DEF 7.0 SHIFT\nCYCL DEF 7.1 X+0\nCYCL DEF 7.2 Y+0\nCYCL DEF 7.3 Z+0\n"
HERE = "L A+0 C+0 FMAX\nL X+10 Y+1 Z+2"


def datum(cycle: int, words: str) -> str:
    """The blocks of an older cycle with one line."""
    return f"CYCL DEF {cycle}.0 DATUM\nCYCL DEF {cycle}.1 {words}\n"


@pytest.mark.parametrize("reset", RESETS)
def test_a_shift_that_is_reset_in_the_plane_ends_with_it(reset: str, run: Runner) -> None:
    found = run(SHIFT + TILT + "L X+1 Y+0 Z+0\n" + NO_SHIFT + reset + "\n" + HERE)
    assert found.diagnostics == ()
    close(found.tip[1], [249, 0, -48], atol=1e-9)
    close(found.tip[-1], [10, 1, 2], atol=1e-9)


@pytest.mark.parametrize("reset", RESETS)
def test_a_shift_from_before_the_plane_outlives_it(reset: str, run: Runner) -> None:
    found = run(SHIFT + TILT + reset + "\n" + HERE)
    assert found.diagnostics == ()
    close(found.tip[-1], [258, 1, -46], atol=1e-9)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        # Which of two shifts counts, or whether both do.
        (SHIFT + TILT + datum(7, "X+5") + "L X+1", 8),
        (SHIFT + TILT + datum(7, "X+0") + "L X+1", 8),
        (SHIFT + TILT + datum(7, "IY+5") + "L X+1", 8),
        (SHIFT + TILT + NO_SHIFT + TILT + "L X+1", 11),
        # A part of a shift that is not reset, and shifts that are not reset at all.
        (SHIFT + TILT + datum(7, "X+0") + "PLANE RESET STAY\nL X+100", 9),
        (TILT + datum(7, "X+5") + "L X+1\nPLANE RESET STAY\nL X+1", 6),
        (TILT + datum(7, "X+5") + "L X+1\n" + TILT + "L X+1", 6),
        (TILT + datum(7, "X+5") + "PLANE RELATIV SPA+5 STAY\n" + datum(7, "X+0") + "PLANE RESET STAY\nL X+1", 8),
        # The same with rotation, mirror and scale, with holes and with words of plain blocks.
        (TILT + datum(10, "ROT+5") + "PLANE RESET STAY\nL X+1", 5),
        (datum(8, "X") + TILT + datum(8, "") + "L X+1", 6),
        (datum(11, "SCL2") + TILT + datum(11, "SCL1") + "PLANE RESET STAY\nL X+1", 7),
        (TILT + datum(7, "X+5") + "PLANE RESET STAY\n" + datum(7, "IX+5") + "L X+1", 7),
    ],
)
def test_what_no_source_settles_is_an_error_at_the_first_motion(text: str, line: int, run: Runner) -> None:
    found = run(text + " Y+1 Z+7 R0 FMAX\nL Z+8 F100")
    assert [each.line for each in found.errors] == [line]
    assert "unconfirmed" in found.errors[0].text


def test_motions_in_machine_coordinates_and_what_is_set_anew_are_not_in_doubt(run: Runner) -> None:
    found = run(TILT + datum(7, "X+5") + "PLANE RESET STAY\nL Z+0 R0 FMAX M91\n" + SHIFT + HERE)
    assert found.diagnostics == ()
    close(found.tip[-1], [258, 1, -46], atol=1e-9)


def test_a_rotation_in_a_plane_with_a_shift_from_before_is_the_order_of_the_manuals(run: Runner) -> None:
    found = run(
        SHIFT + TILT + datum(10, "ROT+90") + "L X+1 Y+0 Z+0\n" + datum(10, "ROT+0") + "PLANE RESET STAY\n" + HERE
    )
    assert found.diagnostics == ()
    close(found.tip[1], matrix(-45, 0, 0) @ [0, 1, 0] + [248, 0, -48], atol=1e-9)
    close(found.tip[-1], [258, 1, -46], atol=1e-9)


def test_cycle_19_is_a_plane_without_a_motion(run: Runner) -> None:
    found = run("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A-45 B+0 C-90\nL A+Q120 C+Q122 FMAX\nL X+0 Y+0 Z+10")
    assert found.diagnostics == ()
    close(found.tip[-1], matrix(-45, 0, -90) @ [0, 0, 10], atol=1e-9)
    close(found.axis[-1], matrix(-45, 0, -90)[:, 2], atol=1e-9)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (datum(8, "X"), lambda p: p * [-1, 1, 1]),
        (datum(10, "ROT+90"), lambda p: np.array([-p[1], p[0], p[2]])),
        (datum(10, "ROT+60") + datum(10, "IROT+30"), lambda p: np.array([-p[1], p[0], p[2]])),
        (datum(11, "SCL0.5"), lambda p: 0.5 * p),
        (datum(26, "X2 Y1 CCX+10"), lambda p: p * [2, 1, 1] - [10, 0, 0]),
        (datum(7, "X+1") + datum(7, "IX+2") + datum(8, "Y"), lambda p: p * [1, -1, 1] + [3, 0, 0]),
    ],
)
def test_datums_are_mirrored_turned_and_scaled(text: str, expected: object, run: Runner) -> None:
    found = run(text + "\nL X+3 Y+4 Z+5")
    assert found.diagnostics == ()
    close(found.tip[-1], expected(np.array([3.0, 4.0, 5.0])), atol=1e-12)  # type: ignore[operator]


def test_m140_goes_back_along_the_tool(run: Runner) -> None:
    found = run("PLANE SPATIAL SPA-45 SPB+0 SPC+0 TURN FMAX SEQ-\nL X+0 Y+0 Z+5\nL M140 MB20 F500\nL M140 MB MAX")
    assert found.diagnostics == ()
    close(found.tip[2] - found.tip[1], 20.0 * found.axis[1], atol=1e-9)
    assert found.feed[2] == 500.0
    limits = np.array([[a.low, a.high] for a in DMU65.axes])[[DMU65.column(n) for n in "XYZ"]]
    at = slides(found)[3]
    assert ((at >= limits[:, 0] - 1e-9) & (at <= limits[:, 1] + 1e-9)).all()
    assert np.isclose(at, limits[:, 1]).any()
    # The end of the travel is a position of the machine.
    assert found.machine_frame.tolist() == [False, False, False, True]


def test_a_retract_before_a_plane_is_made_first(run: Runner) -> None:
    found = run("L X+1 Y+2 Z+3 F100\nPLANE SPATIAL SPA-45 SPB+0 SPC+0 TURN MB50 FMAX SEQ-")
    close(found.tip[1], [1, 2, 53], atol=1e-9)
    close(slides(found)[2], [1, 2, 53], atol=1e-9)


@pytest.mark.parametrize(
    "text",
    [
        "PLANE PROJECTED PROPR+24 PROMIN+24 ROT+30 TURN FMAX",
        "PLANE SIDEWAYS SPA+0 SPB+0 SPC+0 STAY",
        "PLANE SPATIAL SPA+0 SPB+0 TURN FMAX",
        "PLANE VECTOR BX1 BY0 BZ0 NX1 NY0 NZ0 STAY",
        "PLANE POINTS P1X0 P1Y0 P1Z0 P2X1 P2Y0 P2Z0 P3X2 P3Y0 P3Z0 STAY",
        "PLANE RELATIV SPA1 SPB2 STAY",
        "PLANE AXIAL B+5 STAY",
        "PLANE SPATIAL SPA+0 SPB+0 SPC+Q77 STAY",
        "PLANE SPATIAL SPA+0 SPB+0 SPC+0 SIDEWAYS",
        "PLANE",
    ],
)
def test_a_plane_that_is_not_understood_is_named_and_the_old_one_stays(text: str, run: Runner) -> None:
    found = run(text + "\nL X+1 Y+2 Z+3")
    assert [finding.line for finding in found.errors] == [1]
    close(found.tip[-1], [1, 2, 3])


@pytest.mark.parametrize(
    "plane",
    [
        "SPATIAL SPA+0 SPB+0 SPC+0", "SPATIAL SPA-30 SPB+0 SPC+0 SEQ-", "SPATIAL SPA+0 SPB+0 SPC+0 FMAX",
        "SPATIAL SPA+0 SPB+0 SPC+0 TABLE ROT", "PROJECTED PROPR+0 PROMIN+0 ROT+0", "EULER EULPR+0 EULNU+0 EULROT+0",
        "VECTOR BX1 BY0 BZ0 NX0 NY0 NZ1", "POINTS P1X0 P1Y0 P1Z0 P2X1 P2Y0 P2Z0 P3X0 P3Y1 P3Z0", "RELATIV SPA+0",
        "AXIAL A+0 C+0", "RESET FMAX",
    ],
)  # fmt: skip
def test_a_plane_says_whether_the_rotary_axes_turn(plane: str, run: Runner) -> None:
    (error,) = run(f"PLANE {plane}\nL X+1 Y+2 Z+3").errors
    assert error.line == 1
    assert f"PLANE {plane.split()[0]} needs one of TURN, MOVE and STAY" in error.text
    assert not run(f"PLANE {plane} MOVE\nL X+1 Y+2 Z+3").errors or plane.startswith("PROJECTED")


def test_a_bare_reset_of_the_plane_turns_nothing(run: Runner) -> None:
    found = run("L A-30 C+20 FMAX\nPLANE RESET\nL X+1 Y+2 Z+3")
    assert found.diagnostics == ()
    assert axes(found, -1) == (-30.0, 20.0)


# TCP


def test_vectors_of_ln_are_the_tool_axis(run: Runner) -> None:
    text = "M128\nLN X+1 Y+2 Z+3 NX+0 NY+0 NZ+1 TX+0.6 TY+0 TZ+0.8 F500\nLN X+2 Y+2 Z+3 TX+0 TY-0.6 TZ+0.8"
    found = run(text)
    assert found.diagnostics == ()
    close(found.axis, [[0.6, 0, 0.8], [0, -0.6, 0.8]], atol=1e-9)
    close(found.tip, [[1, 2, 3], [2, 2, 3]], atol=1e-9)


@settings(max_examples=examples(25), deadline=None)
@given(a=angle, b=angle, c=anywhere)
def test_spatial_angles_of_tcpm_are_the_tool_axis(
    a: float, b: float, c: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = f"FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR\nL X+1 Y+2 Z+3 A{a:+.3f} B{b:+.3f} C{c:+.3f} F500\nL X+2"
    run = ran(text, tmp_path_factory)
    assert run.diagnostics == ()
    wanted: Floats = matrix(a, b, c)[:, 2]
    close(run.axis, [wanted, wanted], atol=1e-7)
    close(run.tip, [[1, 2, 3], [2, 2, 3]], atol=1e-9)
    assert run.orientation.all()


def test_switching_tcp_leaves_the_axes_where_they_are(run: Runner) -> None:
    found = run("L X+10 Y+20 Z+30 A-40 C+70 F100\nM128\nL IX+0\nM129\nL IX+0")
    close(found.joints, np.tile(found.joints[0], (3, 1)), atol=1e-9)
    assert found.tcp.tolist() == [False, True, False]
    # Without TCP the words are those of the slides.
    close(slides(found)[0], [10, 20, 30], atol=1e-9)
