"""The tools of CL files without tool numbers: told apart by name and form."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from tests.support.verifying import check

_BARE = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "")
_NEXT = _BARE.replace("OP1", "OP2")
_SMALL = "TLDATA/MILL,8.0000"
_HOLES = "CYCLE/DRILL,FEDTO,-10,RAPTO,5,MMPM,100\nGOTO/10,10,0,0,0,1\nCYCLE/OFF\n"
_DRILL = _NEXT.partition("RAPID")[0].replace("TLDATA/MILL,10.0000", "TLDATA/DRILL,5.0000").replace("D10", "D5") + _HOLES


def _by_name(name: str) -> str:
    return _NEXT.replace("D10", name)


def _by_form(form: str) -> str:
    return _NEXT.replace("TLDATA/MILL,10.0000", form)


def _proof(folder: Path, cl: str, machine: str, old: str, new: str) -> trunnion.Check:
    """The check ``tool`` of a program that is posted with numbers for the tools, after a change."""
    file, program = folder / "part.cls", folder / "part.nc"
    file.write_text(cl, encoding="utf-8")
    settings = {"tool": "OP1:1,OP2:2" if "OP2" in cl else "OP1:1", "numbers": "off"}
    text = str(trunnion.post(file, machine=machine, settings=settings).text)
    assert old in text, text
    program.write_text(text.replace(old, new), encoding="utf-8")
    return check(trunnion.verify(program, machine=machine, cl=[file]), "tool")


@pytest.mark.parametrize("machine", ["matsuura_mx330", "xyzac_trt"])
@pytest.mark.parametrize("second", [_by_name("D8"), _by_form(_SMALL), _DRILL], ids=["name", "form", "holes"])
def test_a_missing_change_shows_by_what_the_cl_file_says(tmp_path: Path, machine: str, second: str) -> None:
    cl = _BARE + FOOT + second + FOOT
    assert _proof(tmp_path, cl, machine, "T2 M6", "T2 M6").state == "ok"
    found = _proof(tmp_path, cl, machine, "T2 M6", "")
    assert found.state == "FAIL"
    assert "tool 1 is in the spindle, that of OP1; the CL file has another tool here (" in found.told


def test_the_first_change_is_missed_as_well(tmp_path: Path) -> None:
    cl = _BARE + FOOT + _by_name("D8") + FOOT
    found = _proof(tmp_path, cl, "matsuura_mx330", "T1 M6", "")
    assert "no tool is in the spindle; the CL file wants D10" in found.told


def test_a_program_that_calls_no_tool_is_not_checked(tmp_path: Path) -> None:
    found = _proof(tmp_path, _BARE + FOOT, "matsuura_mx330", "T1 M6", "")
    assert found.state == "not checked"
    assert found.told.startswith("the program calls no tool; checked")


def test_a_change_within_an_operation_is_one_too_many(tmp_path: Path) -> None:
    cl = _BARE + "GOTO/20,0,5\nRAPID\nGOTO/20,0,50\n" + FOOT
    found = _proof(tmp_path, cl, "matsuura_mx330", "X20.", "T9 M6\nX20.")
    assert "tool 9 is in the spindle; the CL file goes on with the tool before, which was 1" in found.told


def test_one_tool_is_not_called_by_two_numbers(tmp_path: Path) -> None:
    found = _proof(tmp_path, _BARE + FOOT + _NEXT + FOOT, "matsuura_mx330", "T2 M6", "T2 M6")
    assert "tool 2 is in the spindle; the CL file has the tool of OP1 here, which was 1" in found.told
    assert "--set tool=OP2:2" in found.told


def test_a_tool_of_another_name_is_not_that_of_the_load_before(tmp_path: Path) -> None:
    cl = HEAD + FOOT + _by_name("D8") + FOOT
    file, program = tmp_path / "part.cls", tmp_path / "part.h"
    file.write_text(cl, encoding="utf-8")
    text = str(trunnion.post(file, machine="dmu65", settings={"numbers": "off"}).text)
    assert 'TOOL CALL "D8"' in text
    program.write_text(text.replace('TOOL CALL "D8"', "TOOL CALL 1"), encoding="utf-8")
    found = check(trunnion.verify(program, machine="dmu65", cl=[file]), "tool")
    assert "the CL file has another tool here (name D10 and D8)" in found.told
