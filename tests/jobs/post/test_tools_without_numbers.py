"""CL files without LOAD/TOOL: each operation has the tool of its name, whatever the settings call it."""

from tests.support.posting import FOOT, HEAD, Post
from tests.support.posting import post as post

_BARE = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "")
_SIDEWAYS = "GOTO/20.0,0.0,5.0\n"
_OTHER = _BARE.replace("OP1", "OP2").replace("D10", "M8").partition("FEDRAT")[0]
_HOLE = "CYCLE/{},FEDTO,-10,RAPTO,5,RTRCTO,5,{}\nGOTO/10,10,0,0,0,1\nCYCLE/OFF\n"
_DRILL = _OTHER.replace("MILL", "DRILL") + _HOLE.format("DRILL", "MMPM,100")
_TAP = _OTHER.replace("4000.0000", "500.0000") + _HOLE.format("TAP", "MMPR,1.25")


def test_a_tool_by_its_name_passes_beside_a_numbered_one(post: Post) -> None:
    code, program, err = post.all(_BARE + _SIDEWAYS + FOOT + _DRILL + FOOT, "--set", "tool=OP1:1")
    assert code == 0, err
    assert any("M8" in line for line in program)


def test_a_mill_is_no_tap_for_the_cycle_of_another_tool(post: Post) -> None:
    code, _, err = post.all(_BARE + _SIDEWAYS + FOOT + _TAP + FOOT, "--set", "tool=OP1:1,OP2:3")
    assert code == 0, err


def test_a_tap_that_moves_sideways_is_refused_by_its_name(post: Post) -> None:
    mill = _BARE.replace("D10", "M8")
    code, _, err = post.all(mill + _SIDEWAYS + FOOT + _TAP + FOOT, "--set", "tool=3")
    assert code == 1
    assert "PLN350" in err
