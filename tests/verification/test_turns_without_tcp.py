"""Cuts in which rotary axes turn without TCP: the tip must stay at the line of the CL file by default, too."""

import math
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import GOLDEN
from tests.support.verifying import check
from trunnion.verification import Check, Verification

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


def _cl(folder: Path, step: float, *, phase: str = "31", tolerance: float | None = 0.01) -> Path:
    """Lines of 8 mm along which the tool axis leans by so many degrees more each."""
    points = [(10.0 + 8.0 * k, 5.0, -3.0, math.radians(4.0 + step * k)) for k in range(4)]
    lines = [f"GOTO/{x},{y},{z},{math.sin(a):.9f},0.0,{math.cos(a):.9f}" for x, y, z, a in points]
    cl = folder / "part.cls"
    cl.write_text(
        "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nMSYS/0,0,0,1,0,0,0,1,0\n"
        f"{'' if tolerance is None else f'INTOL/{tolerance}{chr(10)}OUTTOL/{tolerance}{chr(10)}'}LOAD/TOOL,1\n"
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


def _divided(machine: str, cl: Path, tip_tolerance: float) -> Path:
    """A program with points between, so far apart that the tip leaves its lines by no more than so much."""
    program = cl.with_suffix(".nc")
    trunnion.post(
        cl, machine=machine, settings={**_setup(machine), "tip_tolerance": str(tip_tolerance)}, output=program
    )
    return program


def _span(machine: str, program: Path, *cl: Path, **given: object) -> Check:
    zero = (0.0, 0.0, ZEROS[machine])
    found = trunnion.verify(program, machine=machine, cl=cl, zero=zero, tool_length=60.0, **given)  # type: ignore[arg-type]
    return check(found, "span")


@pytest.mark.parametrize("machine", MACHINES)
def test_the_tolerance_of_the_work_is_what_it_states(machine: str, tmp_path: Path) -> None:
    cl = _cl(tmp_path, 9.0)
    found = _span(machine, _divided(machine, cl, 0.03), cl)
    assert found.state == "FAIL"
    assert "allowed 0.02 mm (INTOL and OUTTOL)" in found.summary
    assert _span(machine, _divided(machine, cl, 0.018), cl).state == "ok"


def test_a_finer_tolerance_than_programs_are_divided_to_is_none(tmp_path: Path) -> None:
    cl = _cl(tmp_path, 9.0, tolerance=0.001)
    found = _span("yl569", _divided("yl569", cl, 0.005), cl)
    assert found.state == "ok"
    assert "allowed 0.005 mm (INTOL and OUTTOL)" in found.summary


@pytest.mark.parametrize("machine", MACHINES)
def test_where_no_tolerance_is_stated_only_fine_points_are_known_to_be_right(machine: str, tmp_path: Path) -> None:
    cl = _cl(tmp_path, 9.0, tolerance=None)
    found = _span(machine, _divided(machine, cl, 0.03), cl)
    assert found.state == "not checked"
    assert "the CL file has no INTOL and OUTTOL; --span-tip MM allows that" in found.missing[0].what
    assert _span(machine, cl.with_suffix(".nc"), cl, span_tip=0.03, span=1.0).state == "ok"
    assert _span(machine, _divided(machine, cl, 0.005), cl).state == "ok"
    assert _span(machine, _divided(machine, cl, 0.08), cl).state == "FAIL"


def test_without_a_cl_file_no_line_is_known(tmp_path: Path) -> None:
    cl = _cl(tmp_path, 9.0)
    found = _span("yl569", _divided("yl569", cl, 0.03))
    assert found.state == "not checked"
    assert _span("yl569", _divided("yl569", cl, 0.03), span_tip=0.04).state == "ok"


@pytest.mark.parametrize(
    ("angle", "other", "state"),
    [
        ("B-76.6055", "B-76.59", "ok"),
        ("B-76.6055", "B-76.506", "FAIL"),
        ("B-16.3925", "B-16.38", "ok"),  # in a step in which C turns by half a turn at the pole
        ("B-16.3925", "B-16.292", "FAIL"),
    ],
)
def test_a_point_between_may_not_lead_the_tool_axis_off_its_way(
    angle: str, other: str, state: str, tmp_path: Path
) -> None:
    text = (GOLDEN / "mikron_600u" / "cap_m114.expected.h").read_text(encoding="utf-8")
    before, angle_found, behind = text.rpartition(angle)
    assert angle_found
    program = tmp_path / "cap.h"
    program.write_text(before + other + behind, encoding="utf-8")
    cl = GOLDEN / "mikron_600u" / "cap.cls"
    found = trunnion.verify(program, machine="mikron_600u", cl=cl, zero=(0.0, 0.0, 100.0), tool_length=100.0)
    assert check(found, "span").state == state


@pytest.mark.parametrize(
    ("between", "state"), [("B17.5", "ok"), ("B17.54", "ok"), ("B17.6", "FAIL"), ("B17.4", "FAIL")]
)
def test_a_point_between_is_judged_with_tcp_too(between: str, state: str, tmp_path: Path) -> None:
    cl, program = _cl(tmp_path, 9.0), tmp_path / "part.mpf"
    trunnion.post(cl, machine="yl569", settings={**_setup("yl569"), "tcp": "on", "numbers": "off"}, output=program)
    text = program.read_text(encoding="utf-8")
    program.write_text(text.replace("X26. B22.\n", f"X22. {between}\nX26. B22.\n"), encoding="utf-8")
    found = _span("yl569", program, cl)
    assert found.state == state
    assert ("0.05000 deg, as there are points between the CL points" in found.summary) is (state == "FAIL")
