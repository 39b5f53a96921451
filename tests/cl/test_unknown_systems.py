"""Statements that nobody knows and that look like a coordinate system: they may turn the points behind them."""

import pytest

from tests.support.cl_reading import Fail, Read
from trunnion.cl import other_system
from trunnion.model.toolpath import UnknownStatement

HEAD = ["PARTNO/1", "UNITS/MM", "CUTTER/10,1", "LOADTL/3"]
FOOT = ["FEDRAT/MMPM,100", "GOTO/0,0,10", "FINI"]


@pytest.mark.parametrize(
    ("numbers", "acts"),
    [
        ("1,0,0,0,0,1,0,-1,0,0,0,0", True),
        ("1,0,0,0,1,0,0,0,1,5,0,0", True),
        ("0,1,0,-1,0,0,0,0,1", True),
        ("1,0,0,0,1,0,0,0,1", False),
        ("1,0,0,0,1,0,0,0,1,0,0,0", False),
        ("1,0,0,0,0,1,0,0,0,0,1,0", False),
        ("1,0,0,0,0,1", False),
    ],
)
@pytest.mark.parametrize("dialect", ["apt", "clsf"])
def test_a_matrix_that_turns_or_shifts_is_never_left_out(read: Read, dialect: str, numbers: str, acts: bool) -> None:
    lines = [*HEAD, f"MCS/{numbers}", *FOOT]
    if dialect == "clsf":
        lines = ["TOOL PATH/A,TOOL,T", lines[4], FOOT[1], "END-OF-PATH"]
    (operation,) = read("\n".join(lines) + "\n").operations
    (event,) = (event for event in operation.events if isinstance(event, UnknownStatement))
    assert event.acts == acts
    assert str(event.what) == (
        "MCS may be the coordinate system of the points behind it" if acts else "MCS is not known"
    )


def test_an_alias_of_creo_for_its_system_is_taken_for_it(read: Read) -> None:
    """A real file has it; points are in the machine's system, whatever that of the model."""
    head = ["$$* Pro/CLfile Version 8.0", "UNITS / MM", "LOADTL / 5", "FEDRAT / 100.0,  MMPM"]
    system = "CAMERA/ 1,0,0,$\n-106.609375,  $\n0,1,0,$\n-121.28125,0,0,1,40.5"
    toolpath = read("\n".join([*head, system, "GOTO / 1,2,3", "FINI"]) + "\n")
    assert toolpath.system == (1, 0, 0, -106.609375, 0, 1, 0, -121.28125, 0, 0, 1, 40.5)
    assert [remark.what for remark in toolpath.remarks] == ["CAMERA is taken for CSYS, under an alias"]


def test_another_system_under_an_alias_is_refused(fails: Fail) -> None:
    head = ["$$* Pro/CLfile Version 8.0", "UNITS / MM", "LOADTL / 5", "CAMERA/1,0,0,0,0,1,0,0,0,0,1,0", "GOTO / 1,2,3"]
    (problem,) = fails("\n".join([*head, "CAMERA/0,1,0,0,1,0,0,0,0,0,-1,0", "GOTO / 4,2,3", "FINI"]) + "\n")
    assert (problem.line, "changes within the file" in problem.what) == (6, True)


PLAIN = {
    "clsf": "TOOL PATH/B,TOOL,T\nGOTO/0,0,5\nEND-OF-PATH\n",
    "apt": "\n".join([*HEAD, *FOOT]) + "\n",
    "ncl": "$$* Pro/CLfile Version 8.0\nLOADTL / 5\n$$-> CSYS / 1,0,0,0,0,1,0,0,0,0,1,0\nGOTO / 1,2,3\nFINI\n",
    "catia": "$$*CATIA0\n$$ A\n$$ 1 0 0 0\n$$ 0 1 0 0\n$$ 0 0 1 0\nTLAXIS/0,0,1\nGOTO/1,2,3\nFINI\n",
}


@pytest.mark.parametrize("dialect", PLAIN)
def test_a_file_that_states_no_system_is_no_job_with_an_msys_off_the_absolute_one(read: Read, dialect: str) -> None:
    """The MSYS would move its points by as much as it says."""
    stated = "TOOL PATH/A,TOOL,T\nMSYS/{},0,0,1,0,0,0,1,0\nGOTO/0,0,5\nEND-OF-PATH\n"
    absolute, off, plain = read(stated.format(0)), read(stated.format(100)), read(PLAIN[dialect])
    for job in ([off, plain], [plain, off], [absolute, off, plain]):
        problem = other_system(job)
        assert problem is not None
        assert "does not state where its points are" in problem.what
    assert other_system([absolute, plain]) is None
    assert other_system([absolute, off]) is None
    assert other_system([plain, plain]) is None
