"""Where G30 goes, as ``reference_positions`` under ``[control.reading]`` states it, and what is judged there."""

from pathlib import Path

import numpy as np
import pytest

from tests.support.verifying import check
from trunnion import verify
from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import run_program

PROGRAM = """%
O0001
G21 G17 G40 G80 G90 G94
G49 G53 G0 Z0.
G53 G0 X0. Y0. A0. C0.
T1 M6
G54
S4000 M3
G0 X10. Y0.
G43 H1 Z50.
G1 Z5. F500.
G0 Z50.
G49
G91 G30 {words}
G90 M5
M30
%
"""

CL = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,4000.0000,CLW
RAPID
GOTO/10.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/10.0,0.0,5.0
RAPID
GOTO/10.0,0.0,50.0
END-OF-PATH
"""


def _definition(folder: Path, base: str, positions: str) -> Path:
    path = folder / "own.toml"
    stated = f"[control.reading]\nreference_positions = {{ {positions} }}\n" if positions else ""
    path.write_text(f'schema = 1\nextends = "{base}"\nname = "Own"\n{stated}', encoding="utf-8")
    return path


def _program(folder: Path, words: str, program: str = PROGRAM) -> Path:
    path = folder / "p.nc"
    path.write_text(program.format(words=words), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("positions", "words", "ends", "told"),
    [
        ("P2 = { Z = -110.0 }", "P2 Z0.", {"Z": -110.0}, False),
        ("P2 = { Z = -110.0 }", "Z0.", {"Z": -110.0}, False),  # without P it is the second
        ("P2 = { Z = -110.0 }, P3 = { X = -20.0, Y = -30.0 }", "P3 X0. Y0.", {"X": -20.0, "Y": -30.0}, False),
        ("P2 = { Z = -110.0 }", "P3 Z0.", {"Z": 0.0}, True),  # stated for another P
        ("P2 = { Z = -110.0 }", "P2 X0. Z0.", {"X": 0.0, "Z": -110.0}, True),  # X is not stated
        ("", "P2 Z0.", {"Z": 0.0}, True),
    ],
)
def test_an_axis_goes_where_it_is_stated_and_only_the_others_are_told(
    positions: str, words: str, ends: dict[str, float], told: bool, tmp_path: Path
) -> None:
    machine = load_machine(_definition(tmp_path, "matsuura_mx330", positions))
    run = run_program(_program(tmp_path, words), machine)
    last = run.positions(np.array([len(run) - 1])).joints[0]
    home = {name: float(machine.axis(name).home) for name in ends}
    assert {name: last[machine.column(name)] for name in ends} == pytest.approx(
        {name: home[name] if value == 0.0 else value for name, value in ends.items()}
    )
    assert ("second_reference" in [each.wording.variant for each in run.diagnostics]) is told


def test_a_program_that_ends_there_is_not_at_home(tmp_path: Path) -> None:
    """It passes only where it is stated that this place is home."""
    program, cl = _program(tmp_path, "P2 Z0.\nG28 X0. Y0."), tmp_path / "p.cls"
    cl.write_text(CL, encoding="utf-8")
    states = [
        check(verify(program, machine=_definition(tmp_path, "matsuura_mx330", positions), cl=cl), "home").state
        for positions in ("P2 = { Z = -110.0 }", "P2 = { Z = 0.0 }", "")
    ]
    assert states == ["FAIL", "ok", "FAIL"]


@pytest.mark.parametrize("positions", ["P5 = { Z = -110.0 }", "P2 = { W = -110.0 }", 'P2 = { Z = "low" }'])
def test_what_no_control_has_is_refused(positions: str, tmp_path: Path) -> None:
    program = _program(tmp_path, "P2 Z0.")
    with pytest.raises(InputError):
        run_program(program, load_machine(_definition(tmp_path, "matsuura_mx330", positions)))
