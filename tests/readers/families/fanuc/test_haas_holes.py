"""Bolt holes of a Haas, and the cycles of that control that are not followed, by their names."""

from pathlib import Path

import numpy as np
import pytest

from tests.support.haas import errors, read
from tests.support.reading import close

CYCLE = "G98 G81 Z-5. R2. F100. L0\n"


def test_a_circle_and_an_arc_of_holes_about_the_tool(tmp_path: Path) -> None:
    for words, angles in (
        ("G70 I5. J15. L12", [15 + 30 * k for k in range(12)]),
        ("G71 I5. J15. K-30. L3", [15, -15, -45]),
    ):
        run = read(tmp_path, f"G0 X10. Y20.\n{CYCLE}{words}\nG80\nX1.")
        assert run.errors == ()
        holes = run.tip[np.isclose(run.tip[:, 2], -5.0)][:, :2]
        at = np.radians(np.array(angles, dtype=float))
        close(holes, np.column_stack((10 + 5 * np.cos(at), 20 + 5 * np.sin(at))), atol=1e-9)
        assert sum(event.kind == "hole" for event in run.events) == len(angles)


@pytest.mark.parametrize(
    "lines",
    [
        "G0 X10. Y20.\nG98 G81 Z-5. R2. F100. G71 I5. J15. K-30. L3\nG80\nX1.",
        f"G0 X1. Y20.\n{CYCLE}G71 X10. I5. J15. K-30. L3\nG80\nX1.",
        "G0 X1. Y2.\nG98 G81 X10. Y20. Z-5. R2. F100. G71 I5. J15. K-30. L3\nG80\nX1.",
    ],
)
def test_holes_with_their_cycle_or_their_centre_in_one_block(lines: str, tmp_path: Path) -> None:
    run = read(tmp_path, lines)
    assert run.errors == ()
    at = np.radians(np.array([15.0, -15.0, -45.0]))
    holes = run.tip[np.isclose(run.tip[:, 2], -5.0)][:, :2]
    close(holes, np.column_stack((10 + 5 * np.cos(at), 20 + 5 * np.sin(at))), atol=1e-9)
    assert sum(event.kind == "hole" for event in run.events) == len(at)


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        ("G70 I5. J15. L12", "G70 drills with the cycle that it or a block before has selected"),
        (f"{CYCLE}G80\nG70 I5. J15. L12", "none is in force"),
        (f"{CYCLE}G70 I5. J15.", "G70 has no L"),
        (f"{CYCLE}G71 I5. L3", "G71 has no J and K"),
        (f"{CYCLE}G70 I5. J15. L0", "L of a cycle is how often it drills"),
        (f"{CYCLE}G70 I-5. J15. L4", "G70 has I-5: pages of the manual differ"),
        (f"{CYCLE}G70 I0. J15. L4", "G70 has I0: pages of the manual differ"),
        (f"{CYCLE}G71 I-5. J15. K30. L3", "G71 has I-5: pages of the manual differ"),
        (f"{CYCLE}G71 I5. J15. K0. L3", "G71 has K0: all holes would lie in one place"),
        (f"{CYCLE}G72 I5. J15. L3", "G72: holes on a line are not simulated"),
        ("G12 I5. D1 F100. Z-1.", "G12: a circular pocket is not simulated"),
        ("G13 I5. K9. Q2. D1 F100. Z-1.", "G13: a circular pocket is not simulated"),
        ("G150 P100 X0. Y0. Z-5. Q1. I2. D1 F100.", "G150: a pocket is not simulated"),
        ("G47 P0 X1. Y1. I0. J5. R1. Z-.5 F10. (TEXT)", "G47: engraving is not simulated"),
        ("G107 A0. Q20.", "G107: a path on a cylinder is not simulated"),
        ("G101 X0.", "G101: mirror images about the zero of the work offset"),
        ("G100 X0.", "G100: mirror images about the zero of the work offset"),
        ("G16", "unknown word G16"),
    ],
)
def test_what_is_not_followed_is_named_in_one_line(lines: str, what: str, tmp_path: Path) -> None:
    found = errors(tmp_path, lines)
    assert what in found[0]
    assert len(found) == 1
