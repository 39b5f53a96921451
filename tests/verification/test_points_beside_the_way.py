"""A program may have more points than its CL file, if they lie on the way within the tolerance of the tip."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS

CONTOUR = TESTS / "data" / "cases" / "contour.cls"


@pytest.mark.parametrize(("aside", "passes"), [(0.0005, True), (0.003, False), (-0.004, False)])
def test_an_added_point_lies_on_the_way(aside: float, passes: bool, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    trunnion.post(CONTOUR, machine="matsuura_mx330", output=program)
    lines = program.read_text(encoding="utf-8").splitlines()
    at = next(k for k, line in enumerate(lines) if line.endswith("G1 X0. F800."))
    added = f"G1 X15. Y{-15.0 + aside:.4f} F800."
    program.write_text("\n".join([*lines[:at], added, f"{lines[at]} Y-15.", *lines[at + 1 :], ""]), encoding="utf-8")
    order = trunnion.verify(program, machine="matsuura_mx330", cl=CONTOUR).checks[0]
    assert order.key == "order"
    assert order.passed is passes
