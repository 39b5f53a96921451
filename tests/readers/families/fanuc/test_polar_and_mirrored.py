"""G16, positions by radius and angle, and G51.1, mirror images."""

import math
from pathlib import Path

import pytest

import trunnion
from tests.support.reading import close
from trunnion.model.run import Run

HEAD = "%\nO0001\nG17 G90 G21 G94 G54\nG0 X0 Y0 Z0\nG1 F100.\n"


def _run(folder: Path, blocks: str) -> Run:
    program = folder / "part.nc"
    program.write_text(f"{HEAD}{blocks}M30\n%\n", encoding="utf-8")
    return trunnion.read_program(program, machine="matsuura_mx330")


def test_positions_by_radius_and_angle(tmp_path: Path) -> None:
    found = _run(tmp_path, "G16\nX50. Y30.\nY90.\nG91 Y30.\nG90 G2 Y0. R50.\nG15\nG1 X1. Y2.\n")
    assert not found.diagnostics
    half, root = 25.0, 25.0 * math.sqrt(3.0)
    close(found.tip[1:, :2], [[root, half], [0, 50], [-half, root], [50, 0], [1, 2]], atol=1e-9)
    close(found.arcs.centre[:, :2], [[0, 0]], atol=1e-9)
    other = _run(tmp_path, "G18 G16\nZ50. X30.\nG15\nG17\n")
    close(other.tip[1], [half, 0, root], atol=1e-9)


def test_a_bolt_circle(tmp_path: Path) -> None:
    found = _run(tmp_path, "G16 G81 X20. Y45. Z-5. R2.\nY135.\nG91 Y90.\nG90 G80 G15\n")
    assert not found.errors
    bottoms = found.tip[found.tip[:, 2] < 0.0]
    side = 10.0 * math.sqrt(2.0)
    close(bottoms[:, :2], [[side, side], [-side, side], [-side, -side]], atol=1e-9)


def test_mirror_images(tmp_path: Path) -> None:
    one = "G51.1 X10.\nX20. Y5.\nG2 X30. Y15. R10.\nG50.1 X0\nG1 X0 Y0\n"
    found = _run(tmp_path, f"{one}G51.1 X0 Y0\nX5. Y6.\nG50.1 X0 Y0\n")
    assert not found.errors
    close(found.tip[1:, :2], [[0, 5], [-10, 15], [0, 0], [-5, -6]], atol=1e-9)
    close(found.arcs.normal, [[0, 0, 1]], atol=1e-12)  # the circle turns the other way


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ("G16\nY30.\n", "G16 needs a radius X and an angle Y"),
        ("G16\nX5. Y30.\nG91 X5.\n", "G16 with G91 and a radius"),
        ("G51.1 Z5.\nX1.\n", "G51.1 with radius compensation"),
        ("G51.1 X5.\nG41 D1 X1.\n", "G51.1 with radius compensation"),
        ("G51.1 X5.\nG68 X0 Y0 R30.\nX1.\n", "G51.1 with radius compensation"),
        ("G51.1\nX1.\n", "G51.1 needs the axes"),
        ("X1.\nG51.1 X5.\nX2.\n", "ends with G51.1 on"),
    ],
)
def test_what_is_not_simulated_is_an_error(blocks: str, said: str, tmp_path: Path) -> None:
    errors = [each.text for each in _run(tmp_path, blocks).errors]
    assert any(said in text for text in errors), errors


def test_g16_that_is_left_on_is_a_warning(tmp_path: Path) -> None:
    assert any("G16" in each.text for each in _run(tmp_path, "G16\nX5. Y30.\n").diagnostics)
