"""What a program says about its tools and times, and which tools it calls, by setting, on every control."""

import re
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.model.toolpath import Kind

OPERATION = """TOOL PATH/{name},TOOL,MILL_{tool}
TLDATA/MILL,{tool}0,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,{tool}
{select}SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,500
GOTO/0,0,5
GOTO/9,0,5
END-OF-PATH
"""

MACHINES = ["yl569", "dmu65", "matsuura_mx330", "xyzac_trt", "hs664rt"]

#: The word that selects a tool before its change, where it is known, and the call of the change.
SELECTED = {"yl569": "T={}", "dmu65": "TOOL DEF {}", "matsuura_mx330": "T{}", "xyzac_trt": "T{}"}
CALLED = {
    "yl569": r"T=(\d)\n(?:N\d+ )?M6",
    "dmu65": r"TOOL CALL (\d) Z",
    "matsuura_mx330": r"T(\d) M6",
    "xyzac_trt": r"T(\d) M6",
    "hs664rt": r"M306 T\.(\d)",
}


def program(machine: str, folder: Path, tools: str = "1223", select: str = "", **settings: str) -> str:
    """A proven program with an operation for each of the tools."""
    cl = folder / "part.cls"
    cl.write_text(
        "".join(OPERATION.format(name=f"OP{k}", tool=tool, select=select) for k, tool in enumerate(tools)),
        encoding="utf-8",
    )
    result = trunnion.post(cl, machine=machine, settings={"numbers": "off", **settings} if settings else None)
    assert result.passed
    return result.text or ""


def calls(machine: str, text: str) -> list[str]:
    return re.findall(CALLED[machine], text)


@pytest.mark.parametrize("machine", SELECTED)
def test_the_next_tool_is_selected_after_a_change(machine: str, tmp_path: Path) -> None:
    text = program(machine, tmp_path, preselect="on")
    assert calls(machine, text) == ["1", "2", "3"]
    words = [SELECTED[machine].format(tool) for tool in "23"]
    lines = [line for line in text.splitlines() if line.split(" ", 1)[-1] in words or line in words]
    found = [line if line in words else line.split(" ", 1)[-1] for line in lines]
    changes = [*words, *words] if machine == "yl569" else words  # a Sinumerik names the tool in a block of its own
    assert sorted(found) == sorted(changes)
    after = text.split("TOOL CALL 1 Z" if machine == "dmu65" else "M6")[1]
    assert words[0] in after.split(";Initial Move" if machine == "yl569" else "X", 1)[0]


@pytest.mark.parametrize("machine", MACHINES)
def test_select_tool_is_written_or_told(machine: str, tmp_path: Path) -> None:
    text = program(machine, tmp_path, "12", "SELECT/TOOL,7\n")
    if machine in SELECTED:
        assert SELECTED[machine].format(7) in text
    else:
        assert "T.7" not in text


@pytest.mark.parametrize("machine", MACHINES)
def test_tools_are_listed_once_at_the_head(machine: str, tmp_path: Path) -> None:
    head = program(machine, tmp_path, tool_list="on").upper().split("OP0")[0]
    assert "TOOL LIST" in head
    for tool in "123":
        assert len(re.findall(rf"T{tool} MILL_{tool}, DIAMETER {tool}0, CORNER 0, LENGTH 75", head)) == 1
    assert "TOOL LIST" not in program(machine, tmp_path).upper()


@pytest.mark.parametrize("machine", MACHINES)
def test_every_operation_calls_its_tool_to_be_entered_there(machine: str, tmp_path: Path) -> None:
    assert calls(machine, program(machine, tmp_path)) == ["1", "2", "3"]
    assert calls(machine, program(machine, tmp_path, restart="on")) == ["1", "2", "2", "3"]


@pytest.mark.parametrize("machine", MACHINES)
def test_times_are_shown_by_setting(machine: str, tmp_path: Path) -> None:
    shown = program(machine, tmp_path, times="on").lower()
    assert len(re.findall(r"machining time\s?:? [\d.]+ s of [\d.]+ s", shown)) == 4
    assert "machining time" not in program(machine, tmp_path, times="off").lower()
    assert ("machining time" in program(machine, tmp_path).lower()) == (machine == "dmu65")


def test_axes_stay_from_their_limits_by_a_margin(tmp_path: Path) -> None:
    """C of this machine ends at 360 degrees; a margin makes it turn back before."""
    machine, cl = tmp_path / "ends.toml", tmp_path / "part.cls"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "B"\nlimits_deg = [-30, 60]\n', encoding="utf-8")
    tilted = OPERATION.format(name="OP", tool=1, select="").replace("50,0,0,1", "50,0.8660254,0,0.5")
    cl.write_text(tilted, encoding="utf-8")
    assert trunnion.post(cl, machine=machine).passed
    with pytest.raises(trunnion.RefusedError, match="B"):
        trunnion.post(cl, machine=machine, settings={"limit_margin": "0.5"})
    with pytest.raises(trunnion.InputError, match="no travel left"):
        trunnion.post(cl, machine=machine, settings={"limit_margin": "45"})


LEANING = """TOOL PATH/{name},TOOL,MILL
TLDATA/MILL,10,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/10,0,50,0.5,0,0.8660254
FEDRAT/MMPM,500
GOTO/10,0,5
GOTO/30,0,5{more}
COOLNT/OFF
END-OF-PATH
"""


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("more", ["", ",0.6,0,0.8"])
def test_the_tool_leaves_along_its_axis_before_it_goes_home(machine: str, more: str, tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text("".join(LEANING.format(name=name, more=more) for name in ("ONE", "TWO")), encoding="utf-8")
    plain = trunnion.post(cl, machine=machine).run
    result = trunnion.post(cl, machine=machine, settings={"tool_retract": "40"})
    run = result.run
    assert result.passed
    assert plain is not None
    assert run is not None
    assert len(run) == len(plain) + 2
    axis = np.array([0.6, 0.0, 0.8]) if more else np.array([0.5, 0.0, 0.8660254])
    away = np.abs(run.tip - (np.array([30.0, 0.0, 5.0]) + 40.0 * axis)).max(axis=1)
    rows = np.flatnonzero(away < 0.002)
    assert len(rows) >= 2
    assert (run.kind[rows] == Kind.RAPID).all()


def test_a_retract_aside_is_no_retract(tmp_path: Path) -> None:
    cl, program_file = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(LEANING.format(name="ONE", more=""), encoding="utf-8")
    text = trunnion.post(cl, machine="xyzac_trt", settings={"tool_retract": "40"}).text or ""
    for wrong in (text.replace("X50. ", "X51. "), text.replace("Z39.64102", "Z3.9")):
        assert wrong != text
        program_file.write_text(wrong, encoding="utf-8")
        checks = trunnion.verify(program_file, cl=cl, machine="xyzac_trt").checks
        assert "order" in [check.key for check in checks if not check.passed]


HOLES = """TOOL PATH/HOLES,TOOL,DR8
TLDATA/DRILL,MILL,8,0,100,118,60
LOAD/TOOL,2
SPINDL/RPM,2500,CLW
RAPID
GOTO/10,20,60,0.5,0,0.8660254
CYCLE/DRILL,RAPTO,3,FEDTO,-22,RTRCTO,20,MMPM,250
GOTO/0,0,10
CYCLE/OFF
RAPID
GOTO/10,20,60
RAPID
GOTO/0,0,80,-0.5,0,0.8660254
CYCLE/DRILL,RAPTO,3,FEDTO,-18,RTRCTO,25,MMPM,300
GOTO/-20,0,10
CYCLE/OFF
{end}END-OF-PATH
"""


@pytest.mark.third
@pytest.mark.parametrize("end", ["", "SPINDL/OFF\nCOOLNT/OFF\n"])
@pytest.mark.parametrize("machine", [*MACHINES, "generic_head_head_ca", "haas_umc750"])
def test_after_a_hole_there_is_no_retract_and_no_second_hole(machine: str, end: str, tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HOLES.format(end=end), encoding="utf-8")
    result = trunnion.post(cl, machine=machine, settings={"tool_retract": "30"})
    assert result.passed, "the proof counts the holes"
    assert result.run is not None
    away = np.abs(result.run.tip - np.array([25.0, 20.0, 85.980762])).max(axis=1)
    assert away.min() < 0.002, "before the next plane there is one, after the rapid off the hole"
