"""Tool, holder and head against the table of the five published machines, as their definitions are shipped."""

from pathlib import Path

import pytest

import trunnion

#: Radius of the rotary table of each, mm; its face is 50 mm below the crossing of the rotary axes.
RADII = {"yl569": 160, "ucp800": 300, "mikron_600u": 225, "hs664rt": 250, "dmu65": 325}
HEAD = (
    "TOOL PATH/OP,TOOL,D10\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\nLOAD/TOOL,1,ADJUST,1\n"
    "SPINDL/RPM,4000,CLW\n"
)


def found(machine: str, folder: Path, tool: str, length: float, *points: str) -> trunnion.SimulationResult:
    """Post rapids at the ends and cuts between them, and simulate the program with the zero in the crossing."""
    first, cut, *others, last = points
    lines = ["RAPID", f"GOTO/{first}", "FEDRAT/MMPM,800", *(f"GOTO/{each}" for each in (cut, *others))]
    cl, nc = folder / "op.cls", folder / "op.nc"
    cl.write_text(HEAD + "\n".join((*lines, "RAPID", f"GOTO/{last}", "END-OF-PATH\n")), encoding="utf-8")
    nc.write_text(str(trunnion.post(cl, machine=machine).text), encoding="utf-8")
    return trunnion.simulate(
        nc,
        machine=machine,
        zero=(0, 0, 0),
        tool_length=length,
        stock="box:60,60,50,-30,-30,-50",
        tools=[tool],
        cell=2.0,
    )


def hit(result: trunnion.SimulationResult) -> set[frozenset[str]]:
    return {frozenset(each.between) for each in result.findings}


@pytest.mark.parametrize("machine", RADII)
def test_tool_holder_and_head_hit_the_table_and_a_sound_job_hits_nothing(machine: str, tmp_path: Path) -> None:
    radius, slim = RADII[machine], "1=flat:10,length=60,flutes=20,holder=40x50"
    upright = found(machine, tmp_path, slim, 110, "-60,0,50,0,0,1", "-60,0,-2", "60,0,-2", "60,0,50")
    assert upright.passed
    leaning = found(machine, tmp_path, slim, 110, "100,0,60,.6,0,.8", "60,0,-2", "-60,0,-2", "100,0,60")
    assert leaning.passed
    tool = found(machine, tmp_path, slim, 110, "100,0,50,0,0,1", "100,0,-55", "110,0,-55", "110,0,50")
    assert hit(tool) == {frozenset({"rotary table", "cutter of 1"})}
    assert tool.findings[0].depth == pytest.approx(5.0, abs=1e-3)
    beside, thick = radius + 10, "1=flat:10,length=25,flutes=20,holder=80x50"
    holder = found(
        machine, tmp_path, thick, 75, f"{beside},0,50,0,0,1", f"{beside},0,-80", f"{beside},5,-80", f"{beside},0,50"
    )
    assert hit(holder) == {frozenset({"rotary table", "holder piece 1 of 1"})}
    far = radius + 100
    head = found(
        machine, tmp_path, "1=flat:10,length=60,flutes=20", 60, f"{far},0,60,1,0,0", "100,0,60", "-100,0,60",
        f"{far},0,60",
    )  # fmt: skip
    assert hit(head) == {frozenset({"rotary table", "head"})}
    where = "where blocks name positions of the machine: no gauge point stated"
    stated = {"mikron_600u", "dmu65", "hs664rt"}  # the last one names none
    assert upright.not_checked == (() if machine in stated else (where,))
