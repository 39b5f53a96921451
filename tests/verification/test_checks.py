"""Each check by a program of a few lines."""

from dataclasses import replace

import numpy as np
import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD, FOOT, HEAD, Verifier, check
from trunnion.machines import Machine
from trunnion.verification import ExpectedValues, Tolerances

CUT = "G0 X0 Y0 Z50\nG1 X10 Z5 F500\nX20\n"
CL = CL_HEAD + "GOTO/10,0,5\nGOTO/20,0,5\n" + CL_FOOT


def first_line(text: str, block: str) -> int:
    """Line of a block in a program, from 1."""
    return text.splitlines().index(block) + 1


def test_a_program_that_does_what_its_cl_file_says_passes_every_check(verified: Verifier) -> None:
    found = verified(HEAD + CUT + FOOT, CL)
    assert [c.key for c in found.checks if not c.passed] == []
    assert found.passed
    assert found.cl_line[found.run.kind == 1].tolist() == [11, 12]


@pytest.mark.parametrize(
    ("old", "new", "key", "block"),
    [
        ("X20\n", "X20.1\n", "tip", "X20.1"),
        ("X20\n", "X20 B1\n", "axis", "X20 B1"),
        ("X20\n", "", "order", "SUPA G0 Z0 D0"),
        ("X20\n", "X15 Y1\nX20 Y0\n", "order", "X15 Y1"),
        ("X20\n", "G0 X20\n", "kind", "G0 X20"),
        ("G1 X10", "G2 CR=6 X10", "kind", "G2 CR=6 X10 Z5 F500"),
        ("X20\n", "X20 F501\n", "feed", "X20 F501"),
        ("X20\n", "G95 X20 F500\n", "feed", "G95 X20 F500"),
        ("S1000", "S1100", "spindle", "S1100 M3"),
        ("1000 M3", "1000 M4", "spindle", "S1000 M4"),
        ("X20\n", "X20 M5\nM4\n", "spindle", "M4"),
        ("T1", "T2", "tool", "M6"),
        ("X20\n", "X20 D2\n", "tool", "X20 D2"),
        ("X20\n", "X20 M8\n", "coolant", "X20 M8"),
        ("G54", "G55", "offset", "G0 X0 Y0 Z50"),
        ("SUPA G0 Z0 D0\nSUPA G0 X0 Y0 B0 C0 D1\nM5", "SUPA G0 X0 Y0 B0 C0 D1\nM5", "home", "SUPA G0 X0 Y0 B0 C0 D1"),
        ("SUPA G0 X0 Y0 B0 C0 D1\nM5", "SUPA G0 X9 Y0 B0 C0 D1\nM5", "home", "SUPA G0 X9 Y0 B0 C0 D1"),
        (FOOT[:14], "SUPA G1 Z0 D0\n", "home", "SUPA G1 Z0 D0"),
        ("M30\n", "", "modal", "M5"),
        ("X20\n", "X20\nFROBNICATE(1)\n", "words", "FROBNICATE(1)"),
        ("G17", "G17 G41", "words", "G17 G41 G710 G90 G94"),
    ],
)  # fmt: skip
def test_a_fault_fails_its_check_at_its_block(old: str, new: str, key: str, block: str, verified: Verifier) -> None:
    text = (HEAD + CUT + FOOT)[::-1].replace(old[::-1], new[::-1], 1)[::-1]
    found = verified(text, CL, settings=ExpectedValues(work_offset=54, edge=1))
    failed = check(found, key)
    assert not failed.passed, failed
    lines = text.splitlines()
    assert block in [lines[place.nc_line - 1] for place in failed.places]


def test_a_block_that_repeats_its_position_is_reported_and_passes(verified: Verifier) -> None:
    found = verified(HEAD + CUT + "X20\n" + FOOT, CL)
    assert found.passed
    assert "1 block without motion" in check(found, "order").summary


def test_points_that_repeat_the_one_before_need_no_block(verified: Verifier) -> None:
    cl = CL.replace("GOTO/20,0,5\n", "GOTO/10,0,5\nGOTO/10.0000001,0,5\nGOTO/20,0,5\nGOTO/20,0,5\n")
    found = verified(HEAD + CUT + FOOT, cl)
    assert found.passed
    assert "3 repeated points left out" in check(found, "order").summary


def test_lines_may_replace_an_arc_and_their_chords_are_reported(verified: Verifier) -> None:
    cl = CL_HEAD + "GOTO/10,0,5\nCIRCLE/20,0,5,0,0,1,10.0,0.06,0.5,10.0,0.0\nGOTO/30,0,5\n" + CL_FOOT
    angle = np.pi + np.linspace(0.0, np.pi, 201)[1:]
    points = [(20 + 10 * np.cos(a), 10 * np.sin(a)) for a in angle]
    lines = "".join(f"X{x:.5f} Y{y:.5f}\n" for x, y in points)
    text = HEAD + "G0 X0 Y0 Z50\nG1 X10 Z5 F500\n" + lines + FOOT
    found = verified(text, cl, tolerances=Tolerances(6e-6, 6e-6))
    assert found.passed, [c for c in found.checks if not c.passed]
    assert "tip 0.0003" in check(found, "span").summary
    x, y = points[90]
    off = text.replace(f"X{x:.5f} Y{y:.5f}", f"X{x:.5f} Y{y + 0.001:.5f}")
    wrong = check(verified(off, cl, tolerances=Tolerances(6e-6, 6e-6)), "tip")
    assert not wrong.passed
    assert wrong.places[0].nc_line == off.splitlines().index(f"X{x:.5f} Y{y + 0.001:.5f}") + 1


def test_circles_are_compared_by_centre_and_sense(verified: Verifier) -> None:
    cl = CL_HEAD + "GOTO/10,0,5\nCIRCLE/20,0,5,0,0,1,10.0,0.06,0.5,10.0,0.0\nGOTO/30,0,5\n" + CL_FOOT
    text = HEAD + "G0 X0 Y0 Z50\nG1 X10 Z5 F500\nG3 X30 Y0 I10 J0\n" + FOOT
    assert verified(text, cl).passed
    other_way = check(verified(text.replace("G3", "G2"), cl), "kind")
    assert "the other way" in other_way.summary
    centre = check(verified(text.replace("J0", "J.5"), cl), "kind")
    assert "centre is off by 0.5" in centre.summary


def test_operations_in_other_coordinate_systems_are_seen_from_the_first(verified: Verifier) -> None:
    second = CL_HEAD.replace("OP1", "OP2").replace(
        "MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000",
        "MSYS/5.0000,0.0000,0.0000,0.0000000,1.0000000,0.0000000,-1.0000000,0.0000000,0.0000000",
    )
    cl = CL + second + "GOTO/10,0,5\n" + CL_FOOT
    text = HEAD + CUT + "SUPA G0 Z0 D0\nG0 X5 Y0 Z50 D1\nG1 X5 Y10 Z5\n" + FOOT
    assert verified(text, cl).passed


def test_texts_that_the_cl_file_inserts_are_not_checked(verified: Verifier) -> None:
    cl = CL.replace("GOTO/20,0,5", "INSERT/FROBNICATE(1)\nINSERT/G0 Z80\nGOTO/20,0,5")
    text = HEAD + CUT.replace("X20", "FROBNICATE(1)\nG0 Z80\nG1 X20 Z5") + FOOT
    found = verified(text, cl)
    assert found.passed, [c for c in found.checks if not c.passed]


# Without a CL file


@pytest.mark.parametrize(
    ("text", "says", "block"),
    [
        ("G0 X0 Y0 Z50\nG1 X10 Z5\n", "no feed is programmed", "G1 X10 Z5"),
        ("M5\nG0 X0 Y0 Z50\nG1 X10 Z5 F500\n", "spindle off", "G1 X10 Z5 F500"),
        ("TRAORI\nG54\nG0 X0 Y0 Z50\nM6\nTRAFOOF\n", "changes the tool with TCP on", "M6"),
        ("TRAORI\nG54\nG0 X0 Y0 Z50\nSUPA G0 Z100\n", "machine's frame with TCP on", "SUPA G0 Z100"),
        ("TRAORI\nG54\nG0 X0 Y0 Z50 B30\nTRAFOOF\n", "swings a rotary axis by 30.000", "G0 X0 Y0 Z50 B30"),
        ("G0 X0 Y0 Z50\nG1 Z5 F500\nG0 Z50\nX20\nZ6\nX30\n", "sideways 44.000 mm below", "X30"),
    ],
)
def test_modal_faults_are_named_at_their_block(text: str, says: str, block: str, verified: Verifier) -> None:
    program = HEAD.replace("M6\n", "M6 ;first\n") + text + FOOT
    found = check(verified(program), "modal")
    assert not found.passed
    lines = program.splitlines()
    assert [lines[place.nc_line - 1] for place in found.places if says in place.text] == [block], found


def test_a_proper_end_is_missed_and_tcp_left_on_at_it_is_seen(verified: Verifier) -> None:
    body = HEAD + "TRAORI\nG54\nG0 X0 Y0 Z50\nG1 X10 F500\n"
    assert "no end" in check(verified(body + "TRAFOOF\n"), "modal").summary
    assert "ends the program with TCP on" in check(verified(body + "M30\n"), "modal").summary
    assert check(verified(body + "TRAFOOF\nM30\n"), "modal").passed
    assert check(verified(body + "trafoof\nM30\n"), "modal").passed
    for silent in (";TRAFOOF", 'MSG("TRAFOOF")', "M0 ;TRAFOOF", "_TRAFOOF=1"):
        assert "ends the program with TCP on" in check(verified(f"{body}{silent}\nM30\n"), "modal").summary
    assert check(verified(body + "TRAFOOF\nM5\nT2\nM6\nM30\n"), "modal").passed


def test_a_rotary_word_beyond_its_limit_fails_and_the_margin_is_reported(verified: Verifier) -> None:
    program = HEAD + "G0 X0 Y0 Z50\nG1 X10 F500 B{}\n" + FOOT
    inside = check(verified(program.format(98)), "travel")
    assert inside.passed
    assert "B 2.000 deg left in" in inside.summary
    assert "at 98.000" in inside.summary
    outside = check(verified(program.format(101)), "travel")
    assert not outside.passed
    assert "1.000 too far" in outside.summary
    assert outside.places[0].nc_line == first_line(program.format(101), "G1 X10 F500 B101")


def test_slides_have_limits_where_the_zero_is_known_and_total_travel_where_not(
    verified: Verifier, yl569: Machine
) -> None:
    program = HEAD + "G0 X200 Y0 Z50\nG1 X260 F500\n" + FOOT
    free = check(verified(program), "travel")
    assert free.passed
    placed = replace(yl569, workpiece_zero=(0.0, 0.0, 0.0))
    outside = check(verified(program, machine=placed), "travel")
    assert not outside.passed
    assert "X goes to 260.000" in outside.summary
    wide = HEAD + "G0 X-251 Y0 Z50\nG1 X250 F500\n" + FOOT
    assert not check(verified(wide), "travel").passed


def test_feeds_that_an_axis_cannot_follow_are_reported_and_pass(verified: Verifier) -> None:
    program = HEAD + "TRAORI\nG54\nG0 X0 Y0 Z50\nG1 X0.1 C90 F500\n" + FOOT.replace("SUPA", "TRAFOOF\nSUPA", 1)
    found = verified(program)
    told = check(found, "speed")
    assert told.passed
    assert "the control slows down" in told.summary
    # 90 degrees in 0.1 mm at 500 mm/min: 0.0002 min, where 9720 deg/min takes 90/9720 min
    assert told.worst == pytest.approx(90.0 / (0.1 / 500.0) / 9720.0)
    cut = int(np.flatnonzero(found.run.kind == 1)[0])
    assert found.seconds[cut] == pytest.approx(60.0 * 90.0 / 9720.0)


def test_acceleration_is_checked_where_the_machine_states_it(verified: Verifier, yl569: Machine) -> None:
    program = HEAD + "G0 X0 Y0 Z50\nG1 X1 F3000\nX0\n" + FOOT
    silent = check(verified(program), "acceleration")
    assert (silent.state, silent.told) == ("not checked", "no acceleration stated")
    axes = tuple(replace(axis, acceleration=100.0) if axis.name == "X" else axis for axis in yl569.axes)
    told = check(verified(program, machine=replace(yl569, axes=axes)), "acceleration")
    # from +50 to -50 mm/s within 20 ms
    assert told.worst == pytest.approx(100.0 / 0.02 / 100.0)
    assert "no acceleration of C, B, Y, Z stated" in told.told
    assert told.passed


def test_the_tool_axis_between_the_points_is_reported_and_checked_on_request(verified: Verifier) -> None:
    cut = "G0 B60 C0\nTRAORI\nG54\nORIAXES\nG0 X50 Y0 Z50\nG1 X50.1 C90 F500\n"
    program = HEAD + cut + FOOT.replace("SUPA", "TRAFOOF\nSUPA", 1)
    # Half-way the angles give (60, 45); the great circle from (60, 0) to (60, 90) leans less.
    ends = np.array([[np.sin(np.pi / 3), 0.0, 0.5], [0.0, np.sin(np.pi / 3), 0.5]])
    middle = ends.sum(axis=0) / np.linalg.norm(ends.sum(axis=0))
    angle = np.degrees(np.arccos(middle @ [np.sin(np.pi / 3) / np.sqrt(2), np.sin(np.pi / 3) / np.sqrt(2), 0.5]))
    told = check(verified(program), "span")
    assert told.passed
    assert told.worst == pytest.approx(angle, abs=1e-9)
    turn = np.degrees(np.arccos(ends[0] @ ends[1]))  # 75.52 degrees, of which a sixth is allowed
    assert f", allowed {turn / 6.0:.5f} deg, a sixth of the turn + 0.0" in told.summary
    asked = check(verified(program, settings=ExpectedValues(span=1.0)), "span")
    assert not asked.passed
    assert ", allowed 1 deg + 0.0" in asked.summary
    slight = check(verified(program.replace("C90", "C2")), "span")
    assert ", allowed 1 deg + 0.0" in slight.summary
    straight = check(verified(HEAD + "G0 X0 Y0 Z50\n" + FOOT), "span")
    assert "allowed" not in straight.summary  # nothing turns
    great = check(verified(program.replace("ORIAXES", "ORIVECT")), "span")
    assert great.worst == 0.0


def test_without_tcp_the_tip_leaves_its_line_where_rotary_axes_turn(verified: Verifier) -> None:
    program = HEAD + "G0 X50 Y0 Z0\nG1 X50 Y0 C10 F500\n" + FOOT
    places = check(verified(program), "span").places
    # on a circle of 50 mm, ten degrees
    assert max(p.value for p in places if "tip" in p.text) == pytest.approx(50 * (1 - np.cos(np.radians(5))), rel=1e-6)


def test_work_offsets_that_change_are_found_without_a_cl_file(verified: Verifier) -> None:
    program = HEAD + "G0 X0 Y0 Z50\nG1 X10 F500\nG55 X20\nG1 X30\nG54 X40\n" + FOOT
    found = check(verified(program), "offset")
    assert not found.passed
    assert "G55" in found.summary


@pytest.mark.parametrize(
    ("body", "passes"),
    [
        ("TRAORI\nG0 X0 Y0 Z50\n", False),
        ("TRAORI\nG0 B30\nX0 Y0 Z50\nG54\n", False),
        ("TRAORI\nG0 B30\nG54\nX0 Y0 Z50\nTRAFOOF\nSUPA G0 Z0 D0\nTRAORI\nTRAFOOF\nX0\n", False),
        ("TRAORI\nG54\nG0 X0 Y0 Z50\n", True),
        ("TRAORI\nG0 B30\nG54\nX0 Y0 Z50\n", True),
    ],
)
def test_a_work_offset_that_traori_has_cleared_is_selected_again(body: str, passes: bool, verified: Verifier) -> None:
    program = HEAD + body + "TRAFOOF\n" + FOOT
    found = check(verified(program), "offset")
    assert found.passed == passes
    if not passes:
        lost = [k + 1 for k, line in enumerate(program.splitlines()) if line == "TRAORI"]
        assert [place.nc_line for place in found.places] == lost[-1:]
    assert check(verified(program.replace("G54\n", "", 1)), "offset").passed or "G54" in body


def test_a_program_may_use_several_work_offsets(verified: Verifier) -> None:
    program = HEAD + "G0 X0 Y0 Z50\nG1 Z5 F500\nG0 Z50\nG55 X20\nG1 Z5\nG0 Z50\n" + FOOT
    found = check(verified(program), "offset")
    assert found.passed
    assert found.summary == "G54, then G55, each as the program chooses"
    assert not check(verified(program, settings=ExpectedValues(work_offset=54)), "offset").passed


@pytest.mark.parametrize(
    "text",
    [
        # Up at feed to where the rapid before had ended, and up in a cycle that ends at its reference plane.
        "G0 X0 Y0 Z50\nG0 Z2\nG1 Z-5 F500\nG1 X10\nG1 Z2 F2000\nG0 X40\nG1 Z-5\n",
        "G0 X0 Y0 Z50\nMCALL CYCLE81(5,0,2,-10)\nX10 F100\nMCALL\nG0 X40\n",
    ],
)
def test_a_retract_at_feed_or_in_a_cycle_is_a_retract(text: str, verified: Verifier) -> None:
    assert check(verified(HEAD + text + FOOT), "modal").passed


def test_a_motion_at_feed_that_ends_below_the_last_rapid_is_no_retract(verified: Verifier) -> None:
    text = "G0 X0 Y0 Z50\nG0 Z2\nG1 Z-5 F500\nG1 X10\nG1 Z-3\nG0 X40\nG1 Z-5\n"
    found = check(verified(HEAD + text + FOOT), "modal")
    assert not found.passed
    assert "sideways" in found.summary
