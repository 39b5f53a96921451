"""Cuts in which rotary axes turn without TCP: the tip must stay at the line of the CL file by default, too."""

import math
from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import check
from trunnion.verification import Verification

#: Machine -> height of the workpiece zero at which the program stays within its travel. A Fidia has no such mode.
ZEROS = {
    "yl569": 30.0,
    "dmu65": 30.0,
    "matsuura_mx330": 150.0,
    "haas_umc750": -300.0,
    "xyzac_trt": -120.0,
    "generic_head_head_ca": 30.0,
}
MACHINES = list(ZEROS)


def _setup(machine: str) -> dict[str, str]:
    return {"zero": f"0,0,{ZEROS[machine]}", "tool_length": "60", "tcp": "off", "edited": "replace"}


def _cl(folder: Path, step: float, *, phase: str = "31", tolerance: float = 0.01) -> Path:
    """Lines of 8 mm along which the tool axis leans by so many degrees more each."""
    points = [(10.0 + 8.0 * k, 5.0, -3.0, math.radians(4.0 + step * k)) for k in range(4)]
    lines = [f"GOTO/{x},{y},{z},{math.sin(a):.9f},0.0,{math.cos(a):.9f}" for x, y, z, a in points]
    cl = folder / "part.cls"
    cl.write_text(
        "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nMSYS/0,0,0,1,0,0,0,1,0\n"
        f"INTOL/{tolerance}\nOUTTOL/{tolerance}\nLOAD/TOOL,1\n"
        f"SPINDL/RPM,1000,CLW\nPAINT/COLOR,186\nRAPID\nGOTO/10,5,60,{math.sin(points[0][3]):.9f},0.0,"
        f"{math.cos(points[0][3]):.9f}\nPAINT/COLOR,{phase}\nFEDRAT/MMPM,500\n" + "\n".join(lines) + "\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    return cl


def _verified(machine: str, cl: Path, **given: object) -> Verification:
    """The proof of a program whose tip may leave its lines by 10 mm on purpose."""
    program = cl.with_suffix(".nc")
    coarse = {**_setup(machine), "tip_tolerance": "10", "axis_tolerance": "10"}
    trunnion.post(cl, machine=machine, settings=coarse, output=program)
    zero = (0.0, 0.0, ZEROS[machine])
    return trunnion.verify(program, machine=machine, cl=cl, zero=zero, tool_length=60.0, **given)  # type: ignore[arg-type]


@pytest.mark.parametrize("machine", MACHINES)
def test_a_tip_that_leaves_the_line_of_a_cut_is_a_fault(machine: str, tmp_path: Path) -> None:
    found = check(_verified(machine, _cl(tmp_path, 9.0)), "span")
    assert not found.passed
    said = "rotary axes turn without TCP in the cut; between its ends the tip is"
    assert any(said in place.text for place in found.places)


@pytest.mark.parametrize("machine", MACHINES)
def test_it_may_be_allowed_and_small_turns_and_ways_outside_of_cuts_are_no_fault(machine: str, tmp_path: Path) -> None:
    assert check(_verified(machine, _cl(tmp_path, 9.0), span_tip=10.0, span=90.0), "span").passed
    assert check(_verified(machine, _cl(tmp_path, 0.4)), "span").passed
    assert check(_verified(machine, _cl(tmp_path, 9.0, phase="211"), span=90.0), "span").passed


def test_the_tolerance_of_the_work_counts(tmp_path: Path) -> None:
    assert not check(_verified("yl569", _cl(tmp_path, 3.0)), "span").passed
    assert check(_verified("yl569", _cl(tmp_path, 3.0, tolerance=0.4)), "span").passed


@pytest.mark.parametrize("machine", MACHINES)
def test_a_program_with_points_between_passes(machine: str, tmp_path: Path) -> None:
    cl, program = _cl(tmp_path, 9.0), tmp_path / "fine.nc"
    trunnion.post(cl, machine=machine, settings=_setup(machine), output=program)
    zero = (0.0, 0.0, ZEROS[machine])
    found = trunnion.verify(program, machine=machine, cl=cl, zero=zero, tool_length=60.0)
    assert check(found, "span").passed
