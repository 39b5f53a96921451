"""Lengths that a program adds to its tool count for the travel of the axes: DL of Klartext, TOFFL of Sinumerik."""

from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.verification import Check, verify

KLARTEXT = """0 BEGIN PGM PART MM
1 TOOL CALL 1 Z S1000{delta}
2 L Z+500 R0 FMAX M91
3 L X+0 Y+0 R0 FMAX M3
4 L Z+20 R0 FMAX
5 L X+10 F500
6 L Z+500 R0 FMAX M91
7 M30
8 END PGM PART MM
"""

SINUMERIK = """G54 G90 G17 G710 G94
T="1" D1 M6
{delta}
G0 X0 Y0 Z50 S1000 M3
G1 X10 F500
M30
"""


def travel(program: Path, machine: str, zero: tuple[float, float, float], length: float) -> Check:
    placed = replace(load_machine(machine), workpiece_zero=zero, tool_length=length)
    found = verify(run_program(program, placed))
    return next(check for check in found.checks if check.key == "travel")


@pytest.mark.parametrize(("delta", "passed"), [("", True), (" DL+90", False), (" DL-90", True), (" DR+90", True)])
def test_delta_of_klartext_counts(delta: str, passed: bool, tmp_path: Path) -> None:
    program = tmp_path / "part.h"
    program.write_text(KLARTEXT.format(delta=delta))
    found = travel(program, "dmu65", (0.0, 0.0, 400.0), 100.0)
    assert found.passed is passed, found.told
    if delta == " DL+90":
        assert found.summary == (
            "Z goes to 610.000, the tool +90 mm by the program, its limit is 560 mm, 50.000 too far"
        )
        (place,) = found.places
        assert place.nc_line in (5, 6)


@pytest.mark.parametrize(("delta", "passed"), [("", True), ("TOFFL=60", False), ("TOFFL=60\nTOFFL=0", True)])
def test_offset_of_sinumerik_counts(delta: str, passed: bool, tmp_path: Path) -> None:
    program = tmp_path / "part.mpf"
    program.write_text(SINUMERIK.format(delta=delta))
    found = travel(program, "yl569", (0.0, 0.0, 50.0), 100.0)
    assert found.passed is passed, found.told


def test_a_program_whose_added_length_leaves_the_travel_is_not_written(tmp_path: Path) -> None:
    out = tmp_path / "part.h"
    settings = {"zero": "0,0,380", "tool_length": "250"}
    cl = YL569 / "2_hub_rough.cls"
    trunnion.post(cl, machine="dmu65", output=out, settings=settings)
    told = r"Z would go to 566.30996 with a tool of 250 mm, \+90 mm by its call"
    with pytest.raises(trunnion.RefusedError, match=told):
        trunnion.post(cl, machine="dmu65", output=tmp_path / "long.h", settings={**settings, "delta_length": "90"})
    assert not (tmp_path / "long.h").exists()
