"""The room that ``travel`` tells: a slide that still stands at home on the first leg is no measure of it."""

from pathlib import Path

import trunnion

_PROGRAM = """%
O1
G21 G17 G40 G49 G80 G90 G94
G53 G0 Z0.
G53 G0 X0. Y0.
T1 M6
G54
G0 X10. Y-200. S3000 M3
G43 H1 Z100.
G1 Z50. F500.
G0 Z100.
M5
G53 G0 Z0.
M30
%
"""


def test_a_slide_at_home_is_not_the_least_margin(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(_PROGRAM, encoding="utf-8")
    found = trunnion.verify(program, machine="haas_umc750", zero=(-300.0, -50.0, -400.0), tool_length=100.0)
    travel = next(check for check in found.checks if check.key == "travel")
    assert " 0.000 mm left" not in travel.summary
    assert "Z " in travel.summary
