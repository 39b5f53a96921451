"""RND, CHF, APPR and DEP, with numbers worked out by hand from the dimensions of the manuals' examples."""

import math

import numpy as np
import pytest

from tests.support.machines import at_zero
from tests.support.reading import Runner, close
from trunnion.errors import Severity
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

HEAD = "L X+10 Y+40 Z+5 FMAX\nL Z-5 F300\n"


def _errors(found: Run) -> list[str]:
    return [each.text for each in found.diagnostics if each.severity is Severity.ERROR]


def test_a_corner_is_rounded_at_its_own_feed(run: Runner) -> None:
    found = run(f"{HEAD}L X+40 Y+25\nRND R5 F100\nL X+10 Y+5\nL X+0")
    assert found.diagnostics == ()
    # The lines turn by the angle whose cosine is -4 / sqrt(65).
    cut = 5.0 * math.sqrt((math.sqrt(65.0) + 4.0) / (math.sqrt(65.0) - 4.0))
    first = np.array([40, 25]) - cut * np.array([2, -1]) / math.sqrt(5.0)
    last = np.array([40, 25]) + cut * np.array([-3, -2]) / math.sqrt(13.0)
    close(found.tip[2:5, :2], [first, last, [10, 5]], atol=1e-9)
    close(first, [32.2937, 28.8531], atol=1e-4)
    assert found.kind.tolist()[2:] == [Kind.LINEAR, Kind.ARC, Kind.LINEAR, Kind.LINEAR]
    assert found.feed[2:].tolist() == [300.0, 100.0, 300.0, 300.0]
    assert found.line[2:].tolist() == [3, 4, 5, 6]
    assert (found.arcs.radius[0], found.arcs.normal[0].tolist()) == (pytest.approx(5.0), [0, 0, -1])
    for end in (first, last):
        assert np.linalg.norm(end - found.arcs.centre[0, :2]) == pytest.approx(5.0)


def test_a_chamfer_cuts_its_length_off_both_lines(run: Runner) -> None:
    found = run("L X+0 Y+30 Z+0 FMAX\nL X+0 F300\nL X+40 IY+5\nCHF 12 F250\nL IX+5 Y+0\n")
    assert found.diagnostics == ()
    first = np.array([40, 35]) - 12 * np.array([8, 1]) / math.sqrt(65.0)
    last = np.array([40, 35]) + 12 * np.array([1, -7]) / math.sqrt(50.0)
    close(found.tip[2:, :2], [first, last, [45, 0]], atol=1e-9)
    assert found.feed[2:].tolist() == [300.0, 250.0, 300.0]
    assert not len(found.arcs.row)


def test_corners_beside_circles_and_one_after_another(run: Runner) -> None:
    found = run(f"{HEAD}L X+40\nRND R2\nCC X+40 Y+60\nC X+60 Y+60 DR+\nRND R3\nL X+60 Y+100\nRND R4\nL X+100")
    assert found.diagnostics == ()
    # The half circle begins straight on (no corner), and ends straight on too.
    assert found.kind.tolist()[2:] == [Kind.LINEAR, Kind.ARC, Kind.LINEAR, Kind.ARC, Kind.LINEAR]
    close(found.tip[3:, :2], [[60, 60], [60, 96], [64, 100], [100, 100]], atol=1e-9)


def test_a_circle_is_cut_short(run: Runner) -> None:
    found = run(f"{HEAD}CC X+10 Y+60\nC X+30 Y+60 DR+\nRND R4\nL X+60 Y+60\n")
    assert found.diagnostics == ()
    # The centre is 4 below the line, and 4 outside of the circle of radius 20 about (10, 60).
    out = math.sqrt(24.0**2 - 4.0**2)
    close(found.tip[3], [10 + out, 60, -5], atol=1e-9)
    close(found.tip[2, :2], np.array([10, 60]) + 20 / 24 * np.array([out, -4]), atol=1e-9)
    close(found.arcs.centre[:, :2], [[10, 60], [10 + out, 56]], atol=1e-9)
    close(found.arcs.radius, [20, 4])


def test_corners_of_a_scaled_and_turned_plane_are_those_of_the_plane(run: Runner) -> None:
    blocks = "L X+10 Y+0 Z+0 FMAX\nL X+40 F300\nRND R5\nL Y+30\n"
    plain, turned = run(blocks), run(f"CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+90\n{blocks}")
    assert turned.errors == ()
    close(turned.tip, plain.tip[:, [1, 0, 2]] * [-1, 1, 1], atol=1e-9)
    tilted = run(f"PLANE SPATIAL SPA-30 SPB+0 SPC+0 TURN FMAX\n{blocks}")
    assert tilted.errors == ()
    half, root = 0.5, math.sqrt(0.75)
    close(tilted.tip[-4:], plain.tip[-4:] @ [[1, 0, 0], [0, root, -half], [0, half, root]], atol=1e-9)


def test_other_tool_axes_have_other_planes(run: Runner) -> None:
    found = run("TOOL CALL 1 Z S100\nTOOL CALL 1 Y S100\nL X+10 Y+0 Z+0 FMAX\nL X+40 F300\nRND R5\nL Z+30")
    rows = found.tip[-4:]
    close(rows, [[10, 0, 0], [35, 0, 0], [40, 0, 5], [40, 0, 30]], atol=1e-9)


def test_inches_are_those_of_the_program(run: Runner) -> None:
    found = run("BEGIN PGM A INCH\nL X+1 Y+0 Z+0 FMAX\nL X+4 F300\nRND R0.5 F40\nL Y+3\nEND PGM A INCH")
    assert found.errors == ()
    close(found.tip[1:3] / 25.4, [[3.5, 0, 0], [4, 0.5, 0]], atol=1e-9)
    close(found.feed[1:], [762.0, 101.6, 762.0])


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ("L X+40\nRND R50\nL Y+20", "RND: 50.0000 mm of an element that is 30.0000 mm long would be cut off"),
        ("L X+40\nRND R5\nL Y+44", "RND: 5.0000 mm of an element that is 4.0000 mm long would be cut off"),
        ("L X+40\nCHF 5\nL Y+44", "CHF: 5.0000 mm of an element that is 4.0000 mm long would be cut off"),
        ("CC X+10 Y+60\nC X+30 Y+60 DR+\nCHF 4\nL X+60", "CHF: a chamfer stands between two straight lines"),
        ("L X+40\nCC X+40 Y+60\nC X+60 Y+60 DR+\nCHF 4\nL Y+80", "CHF: a chamfer stands between two straight lines"),
        ("L X+40\nRND R5\nL X+20", "RND: the contour goes back the way it came"),
        ("L X+40\nRND R5\nL Z+20", "RND: an element leaves the working plane"),
        ("L X+40\nRND R5\nL Y+60 FMAX", "RND: an element is at rapid"),
        ("L X+40\nRND R5\nL Y+60 C+90", "RND: rotary axes turn in an element"),
        ("L X+40\nRND R5\nL Y+60 RL", "RND: radius compensation begins or ends at the corner"),
        ("L X+40\nRND R5", "RND: no line or circle follows"),
        ("L X+40\nRND R5\nCYCL DEF 7.0\nCYCL DEF 7.1 X+5\nL Y+60", "RND: no line or circle follows"),
        ("L X+40\nRND R5\nRND R5\nL Y+60", "RND: no line or circle stands before it"),
        ("L X+40 M91\nRND R5\nL Y+60", "RND: no line or circle stands before it"),
        ("L X+40\nRND R5 X+5\nL Y+60", "besides its size RND takes a feed only"),
        ("L X+40\nRND F5\nL Y+60", "RND R needs a size above zero"),
        ("L X+40\nCHF 0\nL Y+60", "CHF needs a size above zero"),
    ],
)
def test_a_corner_that_cannot_be_made_is_an_error(blocks: str, said: str, run: Runner) -> None:
    errors = _errors(run(f"{HEAD}{blocks}"))
    assert any(said in text for text in errors), errors


# Approaches

START = "L X+40 Y+10 Z+50 R0 FMAX\n"


@pytest.mark.parametrize(
    ("block", "beside"),
    [
        ("APPR LT X+20 Y+20 Z-10 LEN15 RR F100", [20 - 7.5 * math.sqrt(2), 20 - 7.5 * math.sqrt(2)]),
        ("APPR LN X+20 Y+20 Z-10 LEN15 RR F100", [20 + 7.5 * math.sqrt(2), 20 - 7.5 * math.sqrt(2)]),
        ("APPR LN X+20 Y+20 Z-10 LEN15 RL F100", [20 - 7.5 * math.sqrt(2), 20 + 7.5 * math.sqrt(2)]),
        ("APPR CT X+20 Y+20 Z-10 CCA180 R+10 RR F100", [20 + 10 * math.sqrt(2), 20 - 10 * math.sqrt(2)]),
        ("APPR CT X+20 Y+20 Z-10 CCA180 R-10 RR F100", [20 - 10 * math.sqrt(2), 20 + 10 * math.sqrt(2)]),
        ("APPR CT X+20 Y+20 Z-10 CCA90 R+10 RL F100", [20 - 10 * math.sqrt(2), 20]),
        ("CC X+10 Y+20\nAPPR PLT PR+10 PA+0 Z-10 LEN15 RR F100", [20 - 7.5 * math.sqrt(2), 20 - 7.5 * math.sqrt(2)]),
    ],
)
def test_an_approach_goes_beside_the_contour_then_down_then_to_it(block: str, beside: list[float], run: Runner) -> None:
    found = run(f"{START}{block}\nL X+35 Y+35\n")
    assert found.errors == ()
    close(found.tip[1:], [[*beside, 50], [*beside, -10], [20, 20, -10], [35, 35, -10]], atol=1e-9)
    last = Kind.ARC if "CT" in block else Kind.LINEAR
    assert found.kind.tolist() == [Kind.RAPID, Kind.RAPID, Kind.RAPID, last, Kind.LINEAR]
    side = -1 if "RR" in block else 1
    assert found.compensation.tolist() == [0, side, side, side, side]
    assert found.feed[3:].tolist() == [100.0, 100.0]
    if last is Kind.ARC:
        centre, normal = found.arcs.centre[0], found.arcs.normal[0]
        close(np.cross(normal, found.tip[3] - centre) / 10.0, [math.sqrt(0.5), math.sqrt(0.5), 0], atol=1e-9)
        assert normal[2] == side * (-1 if "R-" in block else 1)


def test_the_way_beside_the_contour_has_the_feed_before(run: Runner) -> None:
    found = run("L X+40 Y+0 Z+0 FMAX\nL Y+10 F800\nAPPR LT X+20 Y+20 LEN15 RR F100\nL X+35 Y+35")
    assert found.feed[1:].tolist() == [800.0, 800.0, 100.0, 100.0]


def test_a_line_and_an_arc_approach_in_all_axes_at_once(run: Runner) -> None:
    found = run(f"{START}APPR LCT X+10 Y+20 Z-10 R10 RR F100\nL X+20 Y+35")
    assert found.errors == ()
    assert found.kind.tolist() == [Kind.RAPID, Kind.LINEAR, Kind.ARC, Kind.LINEAR]
    way = np.array([10, 15]) / math.sqrt(325)
    centre = np.array([10, 20]) + 10 * np.array([way[1], -way[0]])
    close(found.arcs.centre[0], [*centre, -10], atol=1e-9)
    beside = found.tip[1]
    assert beside[2] == -10.0
    assert np.linalg.norm(beside[:2] - centre) == pytest.approx(10.0)
    assert (beside[:2] - centre) @ (beside[:2] - [40, 10]) == pytest.approx(0.0, abs=1e-9)
    assert found.feed[1:].tolist() == [100.0, 100.0, 100.0]


def test_an_approach_to_a_circle_is_tangent_to_that(run: Runner) -> None:
    found = run(f"{START}CC X+0 Y+0\nAPPR LT X+20 Y+0 Z-10 LEN15 RL F100\nC X-20 Y+0 DR+")
    assert found.errors == ()
    close(found.tip[1:3, :2], [[20, -15], [20, -15]], atol=1e-9)


def test_without_a_side_an_itnc_approaches_on_the_right_and_others_stop(run: Runner) -> None:
    block = f"{START}APPR LN X+20 Y+20 LEN15 R0 F100\nL X+35 Y+35"
    assert any("neither RL nor RR" in text for text in _errors(run(block)))
    found = run(block, machine=at_zero("mikron_600u"))
    assert found.errors == ()
    close(found.tip[1, :2], [20 + 7.5 * math.sqrt(2), 20 - 7.5 * math.sqrt(2)], atol=1e-9)


# Departures

CONTOUR = "L X+20 Y+50 Z-10 FMAX\nL Y+45 RR F300\nL Y+20\n"


@pytest.mark.parametrize(
    ("block", "ends"),
    [
        ("DEP LT LEN12.5 F100", [[20, 7.5, -10]]),
        ("DEP LN LEN+20 Z+50 F100", [[0, 20, -10], [0, 20, 50]]),
        ("DEP CT CCA 180 R+8 F100", [[4, 20, -10]]),
        ("DEP CT CCA 90 R-8 F100", [[28, 12, -10]]),
        ("DEP CT CCA 90 R+8 Z+50 F100", [[12, 12, -10], [12, 12, 50]]),
    ],
)
def test_a_departure_leaves_the_contour_then_goes_up(block: str, ends: list[list[float]], run: Runner) -> None:
    found = run(f"{CONTOUR}{block}\nL Z+100 FMAX")
    assert found.errors == ()
    close(found.tip[3:-1], ends, atol=1e-9)
    assert found.feed[3:-1].tolist() == [100.0] * len(ends)
    assert found.compensation.tolist() == [0, -1, -1, *[0] * (len(ends) + 1)]
    if "CT" in block:
        close(found.arcs.centre, [[12 if "R+" in block else 28, 20, -10]], atol=1e-9)


def test_a_departure_on_an_arc_and_a_line_ends_at_its_point(run: Runner) -> None:
    found = run(f"{CONTOUR}DEP LCT X+10 Y+12 Z+5 R+8 F100")
    assert found.errors == ()
    beside = found.tip[3]
    close(found.arcs.centre, [[12, 20, -10]], atol=1e-9)
    assert np.linalg.norm(beside[:2] - [12, 20]) == pytest.approx(8.0)
    assert (beside[:2] - [12, 20]) @ (np.array([10, 12]) - beside[:2]) == pytest.approx(0.0, abs=1e-9)
    close(found.tip[4], [10, 12, 5])
    polar = run(f"{CONTOUR}CC X+10 Y+10\nDEP PLCT PR+2 PA+90 Z+5 R+8 F100")
    close(polar.tip, found.tip, atol=1e-9)


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        (f"{START}APPR LT X+20 Y+20 LEN15 RR F100\nL Z+60", "APPR LT: an element leaves the working plane"),
        (f"{START}APPR LT X+20 Y+20 LEN15 RR F100", "APPR LT: no line or circle follows"),
        (f"{START}APPR LCT X+20 Y+20 R50 RR F100\nL X+35 Y+35", "APPR LCT: the point lies inside the arc"),
        (f"{START}APPR LCT X+20 Y+20 R5 RL F100\nL X+35 Y+35", "on the other side of the contour"),
        (f"{START}APPR LT X+20 Y+20 RR F100\nL X+35 Y+35", "APPR LT needs LEN above zero"),
        (f"{START}APPR CT X+20 Y+20 R5 CCA400 RR F100\nL X+35 Y+35", "APPR CT needs R and CCA above zero"),
        (f"{START}APPR LT Z+20 LEN5 RR F100\nL X+35 Y+35", "APPR LT needs a point"),
        (f"{START}APPR LT X+20 Y+20 C+5 LEN5 RR F100\nL X+35 Y+35", "APPR LT with rotary axes"),
        (f"{START}APPR X+20 Y+20\nL X+35 Y+35", "APPR needs LT, LN, CT or LCT"),
        (f"{CONTOUR}DEP LT LEN5 X+20", "DEP LT takes no point"),
        (f"{CONTOUR}DEP LCT R5", "DEP LCT needs a point"),
        (f"{CONTOUR}DEP LCT X+20 Y+5 R5", "DEP LCT: the point lies in the direction of the contour"),
        (f"{CONTOUR}L Z+5\nDEP LT LEN5", "DEP LT: an element leaves the working plane"),
        (f"{CONTOUR}L Y+10 R0\nDEP LN LEN5", "DEP LN: neither RL nor RR"),
        (f"{CONTOUR}DEP CT CCA90 R5 FMAX", "DEP CT: an element is at rapid"),
        ("DEP LT LEN5", "DEP LT: no line or circle stands before it"),
    ],
)
def test_a_lead_that_cannot_be_made_is_an_error(blocks: str, said: str, run: Runner) -> None:
    errors = _errors(run(blocks))
    assert any(said in text for text in errors), errors
