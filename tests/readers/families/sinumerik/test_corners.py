"""RND, RNDM, CHF, CHR with FRC and FRCM, and CT."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.support.reading import Runner, close
from trunnion.errors import Severity
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

HEAD = "G17 G90 G710 G94\nG54\nG0 X0 Y0 Z0\nG1 F100\n"


def _texts(found: Run, severity: Severity) -> list[str]:
    return [each.text for each in found.diagnostics if each.severity is severity]


def test_words_of_one_block_round_or_chamfer_the_corner_at_its_end(run: Runner) -> None:
    found = run(f"{HEAD}X40 RND=10\nY40 CHR=2\nX80 CHF=2 FRC=50\nY20\n")
    assert found.diagnostics == ()
    cut = math.sqrt(2.0)  # of a chamfer of length 2 at a right angle
    wanted = [[30, 0], [40, 10], [40, 38], [42, 40], [80 - cut, 40], [80, 40 - cut], [80, 20]]
    close(found.tip[1:, :2], wanted, atol=1e-9)
    assert found.kind[1:].tolist() == [Kind.LINEAR, Kind.ARC, *[Kind.LINEAR] * 5]
    assert found.feed[1:].tolist() == [100, 100, 100, 100, 100, 50, 100]
    assert found.line[1:].tolist() == [5, 5, 6, 6, 7, 7, 8]
    close(found.arcs.centre, [[30, 10, 0]], atol=1e-9)


def test_a_chamfer_by_length_and_by_side_at_another_angle(run: Runner) -> None:
    # The contour turns by 60 degrees: a side of 2 makes a chamfer of 2 * 2 * cos(30).
    end = "X=40+20*COS(60) Y=20*SIN(60)"
    by_side, by_length = (run(f"{HEAD}X40 {word}\n{end}\n") for word in ("CHR=2", f"CHF={4 * math.cos(math.pi / 6)}"))
    close(by_side.tip[1:3, :2], [[38, 0], [41, math.sqrt(3.0)]], atol=1e-9)
    close(by_length.tip, by_side.tip, atol=1e-9)


def test_modal_rounding_counts_until_it_is_switched_off(run: Runner) -> None:
    found = run(f"{HEAD}X40\nX60 RNDM=3 FRCM=70\nY20\nG3 X50 Y30 CR=10\nG1 X20\nY60 RNDM=0 FRCM=0\nX0\nG0 Z9\n")
    assert found.diagnostics == ()
    # No corner is where the circle begins and ends.
    wanted = [[40, 0], [57, 0], [60, 3], [60, 20], [50, 30], [23, 30], [20, 33], [20, 60], [0, 60], [0, 60]]
    wanted[5:7] = [[23, 30], [20, 33]]
    close(found.tip[1:, :2], wanted, atol=1e-9)
    assert found.feed[[3, 7]].tolist() == [70, 70]
    assert found.feed[[2, 4, 8]].tolist() == [100, 100, 100]


def test_modal_rounding_leaves_out_moves_across_the_plane(run: Runner) -> None:
    found = run(f"{HEAD}X40 RNDM=3\nZ5\nY20\nX0\n")
    assert found.diagnostics == ()
    close(found.tip[1:], [[40, 0, 0], [40, 0, 5], [40, 17, 5], [37, 20, 5], [0, 20, 5]], atol=1e-9)


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ("X40 RND=3\nZ5", "RND: the contour leaves the working plane"),
        ("X40 RND=3", "RND: no line or circle follows"),
        ("X40 RND=3\nG18 Z20", "RND: the contour leaves the working plane"),
        ("X40 CHR=3\nTRANS X5\nX60", "CHR: no line or circle follows"),
    ],
)
def test_a_corner_that_the_control_leaves_out_is_a_warning(blocks: str, said: str, run: Runner) -> None:
    found = run(f"{HEAD}{blocks}\n")
    assert not found.errors
    assert any(said in text for text in _texts(found, Severity.WARNING))
    assert not len(found.arcs.row)


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ("X40 RND=50\nY90", "RND: 50.0000 mm of an element that is 40.0000 mm long"),
        ("X40 RND=5\nY9 Z5", "RND: an element leaves the working plane"),
        ("X40 RND=5\nG0 Y9", "RND: an element is at rapid"),
        ("X40 RND=5\nG41 Y9", "RND: radius compensation begins or ends"),
        ("X40 RND=5\nY9 C5", "RND: rotary axes turn"),
        ("X40 CHF=5\nG3 X30 Y10 CR=10", "CHF: a chamfer stands between two straight lines"),
        ("X40 RND=5 CHF=1\nY9", "RND and CHF in one block"),
        ("X40\nRND=5\nY9", "RND in a block without motion"),
        ("X40 RND=-5\nY9", "RND=-5: it is not below zero"),
        ("X40 RND=5\nR1=1\nM8\nM9\nM8\nM9\nY9", "more than three blocks without motion"),
        ("X40 RND=5\nY9 F200", "RND without a feed of its own (FRC) between F100 and F200"),
    ],
)
def test_a_corner_of_which_nobody_knows_is_an_error(blocks: str, said: str, run: Runner) -> None:
    errors = _texts(run(f"{HEAD}{blocks}\n"), Severity.ERROR)
    assert any(said in text for text in errors), errors


@pytest.mark.parametrize(("setting", "feed"), [("block_before", 100.0), ("block_behind", 200.0)])
def test_a_definition_says_whose_feed_a_corner_has(setting: str, feed: float, run: Runner, tmp_path: Path) -> None:
    definition = tmp_path / "own.toml"
    definition.write_text(f'extends = "yl569"\n[control.reading]\ncorner_feed = "{setting}"\n', encoding="utf-8")
    found = run(f"{HEAD}X40 RND=5\nY9 F200\n", machine=load_machine(str(definition)))
    assert found.diagnostics == ()
    assert found.feed[1:].tolist() == [100.0, feed, 200.0]


# CT


def test_ct_goes_on_in_the_direction_of_the_motion_before(run: Runner) -> None:
    found = run(f"{HEAD}X40\nCT X60 Y20\nX40 Y40\nX20\nG1 X0\n")
    assert found.diagnostics == ()
    assert found.kind[1:].tolist() == [Kind.LINEAR, Kind.ARC, Kind.ARC, Kind.LINEAR, Kind.LINEAR]
    close(found.arcs.centre[:, :2], [[40, 20], [40, 20]], atol=1e-9)
    close(found.arcs.normal, [[0, 0, 1], [0, 0, 1]])


def test_ct_of_the_manual(run: Runner) -> None:
    # The last line before goes by (16.707, -30); the circle to (18.146, -12) further on touches it.
    found = run("G18 G90 G710 G94\nG54\nG0 X0 Y0 Z0\nG1 F100 X23.293 Z0\nX40 Z-30\nCT X58.146 Z-42\n")
    assert found.diagnostics == ()
    centre, way = found.arcs.centre[0], np.array([16.707, 0, -30])
    assert (found.tip[1] - centre) @ (found.tip[1] - centre) > found.arcs.radius[0] ** 2
    assert (found.tip[2] - centre) @ way == pytest.approx(0.0, abs=1e-6)
    assert np.linalg.norm(found.tip[3] - centre) == pytest.approx(np.linalg.norm(found.tip[2] - centre))


def test_ct_without_a_direction_is_an_error(run: Runner) -> None:
    beside = [f"{word} has no use in this block" for word in ("AR", "CR", "I")]
    for word, said in zip(("AR=30", "CR=20", "I20"), beside, strict=True):
        assert said in _texts(run(f"{HEAD}X40\nCT X60 Y20 {word}\n"), Severity.ERROR)
    assert any("no direction" in text for text in _texts(run(f"{HEAD}Z5\nCT X60 Y20\n"), Severity.ERROR))


# ANG


def test_the_other_coordinate_follows_from_the_angle(run: Runner) -> None:
    found = run(f"{HEAD}X40 ANG=30\nY40 ANG=90 RND=2\nX0 ANG=180\nG91 X-5 ANG=225\nG18 G90 Z10 ANG=-45\n")
    assert found.diagnostics == ()
    rise = 40 / math.sqrt(3.0)
    wanted = [[40, rise, 0], [40, 38, 0], [38, 40, 0], [0, 40, 0], [-5, 35, 0], [-15, 35, 10]]
    close(found.tip[1:], wanted, atol=1e-9)


@pytest.mark.parametrize(
    ("block", "said"),
    [
        ("ANG=30", "ANG=30 with both coordinates or none"),
        ("X5 Y5 ANG=45", "ANG=45 with both coordinates or none"),
        ("X5 ANG=90", "ANG=90 without a straight line, or along the axis"),
        ("X5 ANG=180", "ANG=180 leads away from X"),
        ("G2 X5 ANG=10 CR=9", "ANG=10 without a straight line"),
    ],
)
def test_an_angle_that_makes_no_line_is_an_error(block: str, said: str, run: Runner) -> None:
    errors = _texts(run(f"{HEAD}{block}\n"), Severity.ERROR)
    assert any(said in text for text in errors), errors
