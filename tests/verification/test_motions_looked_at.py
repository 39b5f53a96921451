"""How many motions ``span``, ``speed``, ``acceleration`` and ``rpm`` look at, and why not at the others."""

from pathlib import Path

import trunnion

PROGRAM = """G71 G90 G94
G0 B0 C0
TRAORI
G54
G0 X0 Y0 Z50
M3 S1000
G1 Z10 F500
G1 X10
G1 X20 B5
G0 Z60
M5
G1 X0
G1 X-5
SUPA G0 Z0
M30
"""


def test_each_motion_is_counted_or_left_out_with_a_reason(tmp_path: Path) -> None:
    file = tmp_path / "part.mpf"
    file.write_text(PROGRAM, encoding="utf-8")
    found = trunnion.verify(file, machine="yl569")
    checks = {check.key: check for check in found.checks}
    seen = {key: check.coverage for key, check in checks.items() if key in ("span", "speed", "rpm") and check.coverage}
    told = {key: (each.checked, [(place.nc_line, place.text) for place in each.left_out]) for key, each in seen.items()}
    rapid, still = (2, "it is a rapid"), (2, "the spindle does not turn")
    assert told == {
        "span": (5, [rapid, (14, "it goes to a position of the machine, which the check home judges")]),
        "speed": (5, [rapid]),
        "rpm": (4, [still]),
    }
    assert all(each.motions == len(found.run) == 9 for each in seen.values())
    assert "checked 5 of 9 motions; 4 are left out, the first line 2: it is a rapid" in checks["speed"].told


def test_a_change_of_speed_needs_two_motions_at_feed(tmp_path: Path) -> None:
    file = tmp_path / "part.mpf"
    file.write_text(PROGRAM, encoding="utf-8")
    found = trunnion.verify(file, machine="generic_head_table_bc")
    (check,) = (each for each in found.checks if each.key == "acceleration")
    assert check.coverage is not None
    assert (check.coverage.checked, check.coverage.motions) == (3, 9)
    assert [(place.nc_line, place.text) for place in check.coverage.left_out] == [
        (2, "it is a rapid"), (7, "no motion at feed comes before it"),
    ]  # fmt: skip
