"""Corners that a Fanuc rounds and chamfers: ,R and ,C."""

from pathlib import Path

import pytest

import trunnion
from tests.support.reading import close
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

HEAD = "%\nO0001\nG17 G90 G21 G94 G54\nG0 X0 Y0 Z0\nG1 F100.\n"


def _run(folder: Path, blocks: str, machine: str = "matsuura_mx330") -> Run:
    program = folder / "part.nc"
    program.write_text(f"{HEAD}{blocks}M30\n%\n", encoding="utf-8")
    return trunnion.read_program(program, machine=machine)


def test_corners_are_rounded_and_chamfered(tmp_path: Path) -> None:
    found = _run(tmp_path, "X40. ,R10.\nY40. ,C2.\nX80. ,R5000\nG3 X100. Y60. R20.\nG1 Y90. ,R4.\nX0\n")
    assert not found.errors
    # Whole numbers are increments, and where the circle begins and ends the contour goes on.
    wanted = [[30, 0], [40, 10], [40, 38], [42, 40], [80, 40], [100, 60], [100, 86], [96, 90], [0, 90]]
    close(found.tip[1:, :2], wanted, atol=1e-9)
    close(found.arcs.radius, [10, 20, 4])
    assert found.line[1:5].tolist() == [6, 6, 7, 7]


def test_a_contour_that_hardly_turns_has_no_corner(tmp_path: Path) -> None:
    found = _run(tmp_path, "X40. ,R10.\nX80. Y.5\n")
    assert not found.errors
    assert found.kind[1:].tolist() == [Kind.LINEAR, Kind.LINEAR]


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ("X40. ,R50.\nY90.\n", ",R: 50.0000 mm of an element that is 40.0000 mm long"),
        ("X40. ,R5.\nM8\nY90.\n", ",R: no line or circle follows"),
        ("X40. ,R5.\nG0 Y90.\n", ",R: an element is at rapid"),
        ("X40. ,R5.\nZ9.\n", ",R: an element leaves the working plane"),
        ("X40. ,R5. ,C1.\nY90.\n", ",R and ,C in one block"),
        ("X40. ,R-1.\nY90.\n", ",R needs a size above zero"),
        ("X40. ,C1.\nG3 X30. Y10. R10.\n", ",C: a chamfer stands between two straight lines"),
        ("X40. ,R5.\nY90. F50.\n", ",R between F100 and F50"),
        ("X40. ,A5.\n", "','"),
        (",R5. M8\n", "R"),
    ],
)
def test_a_corner_that_cannot_be_made_is_an_error(blocks: str, said: str, tmp_path: Path) -> None:
    errors = [each.text for each in _run(tmp_path, blocks).errors]
    assert any(said in text for text in errors), errors


def test_linuxcnc_has_no_such_words(tmp_path: Path) -> None:
    program = tmp_path / "part.ngc"
    program.write_text("G21 G90 G17\nG0 X0 Y0 Z0\nG1 X40. ,R10. F100\nY40\nM2\n", encoding="utf-8")
    assert trunnion.read_program(program, machine="linuxcnc_5axis").errors


def test_a_corner_of_size_zero_stays_sharp_and_is_said(tmp_path: Path) -> None:
    for word in (",R", ",C"):
        run = _run(tmp_path, f"X40. {word}0.\nY90.\n")
        assert not run.errors
        assert f"{word}0 makes no corner: it stays sharp" in [each.text for each in run.diagnostics]
