"""Cycles that nothing ends: refused, unless a setting states what becomes of each."""

from pathlib import Path

import pytest

import trunnion
from tests.support.open_cycles import CUT, CYCLE, HEAD, LOOKS, NEXT, OPEN
from trunnion.cl import ClReading, read_cl
from trunnion.cl.open_cycles import OpenCycle
from trunnion.errors import InputError, Severity
from trunnion.model.toolpath import CycleOff, CycleOn


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """A CL file with a cycle that nothing ends."""
    path = tmp_path / "part.apt"
    path.write_text(OPEN)
    return path


def _asked(error: InputError) -> dict[str, str]:
    values = {"cycle_line_still_holes": "goes_on", "cycle_line_still_where": "ends"}
    return {str(each.wording.parameter("operation")): values[each.wording.variant] for each in error.problems}


def test_each_operation_is_asked_at_once_by_what_it_looks_like(part: Path) -> None:
    with pytest.raises(InputError) as caught:
        read_cl(part)
    assert _asked(caught.value) == LOOKS


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"])
def test_what_is_stated_is_done_proven_and_told(part: Path, machine: str) -> None:
    settings = {"open_cycle": ",".join(f"{name}:{value}" for name, value in LOOKS.items())}
    program = part.with_suffix(".nc")
    found = trunnion.post(part, machine=machine, settings=settings, output=program)
    assert found.passed
    told = [str(each.wording.parameter("operation")) for each in found.problems if each.code == "CL840"]
    assert told == [*LOOKS]
    again = trunnion.verify(program, machine=machine, cl=[part], settings=settings)
    assert again.passed
    assert [str(each.answer) for each in again.checks if each.key == "holes"] == ["4 holes"]


def test_points_at_rapid_are_ways_to_the_first_hole(part: Path) -> None:
    toolpath = read_cl(part, ClReading(open_cycles={"": OpenCycle.GOES_ON, "OPERATION 4": OpenCycle.ENDS}))
    third = toolpath.operations[2]
    (cycle,) = [event for event in third.events if isinstance(event, CycleOn)]
    assert (cycle.row, cycle.line) == (1, toolpath.operations[0].events[-1].line)
    assert not [event for event in toolpath.operations[3].events if isinstance(event, CycleOn | CycleOff)]


def test_a_cycle_that_has_ended_is_not_asked_for_again(part: Path) -> None:
    part.write_text(OPEN.replace("FINI\n", f"LOAD/TOOL,8\n{NEXT}{CUT}FINI\n"))
    with pytest.raises(InputError) as caught:
        read_cl(part, ClReading(open_cycles={"OPERATION 3": OpenCycle.ENDS}))
    assert _asked(caught.value) == {"OPERATION 2": "goes_on"}


def test_curves_within_a_cycle_that_goes_on_are_refused(part: Path) -> None:
    part.write_text(OPEN.replace("GOTO/50.,50.,-1.\n", "CIRCLE/45.,50.,-1.,0,0,1.\nGOTO/50.,50.,-1.\n"))
    with pytest.raises(InputError) as caught:
        read_cl(part, ClReading(open_cycles={"": OpenCycle.GOES_ON}))
    assert [each.code for each in caught.value.problems] == ["CL620"]


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        ("OPERATION 2:stays", "open_cycle"),
        ("OPERATION 2:ends,OPERATION 2:goes_on", "two values"),
        ("goes_on,OPERATION 4:ends,OPERATION 9:ends", "none of that name"),
    ],
)
def test_what_cannot_be_stated_is_refused(part: Path, stated: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        trunnion.post(part, machine="yl569", settings={"open_cycle": stated})


def test_a_cycle_off_behind_holes_that_go_on_is_no_surprise(part: Path) -> None:
    holes = f"{CYCLE}GOTO/10.,10.,0\n{NEXT}GOTO/20.,20.,0\nCYCLE/OFF\n"
    part.write_text(f"{HEAD}{holes}RAPID/\nGOTO/20.,20.,25.\nFINI\n")
    remarks = read_cl(part, ClReading(open_cycles={"": OpenCycle.GOES_ON})).remarks
    assert [each.code for each in remarks if each.severity is Severity.WARNING] == ["CL840"]
