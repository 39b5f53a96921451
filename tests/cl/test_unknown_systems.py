"""Statements that nobody knows and that look like a coordinate system: they may turn the points behind them."""

import pytest

from tests.support.cl_reading import Read
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
    assert event.what == ("MCS may be the coordinate system of the points behind it" if acts else "MCS is not known")
