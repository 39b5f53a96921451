"""One number, or one name, that operations give to different tools: the operator can put in only one of them."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import Post
from tests.support.posting import post as post

MACHINES = ["yl569", "dmu65", "matsuura_mx330", "xyzac_trt", "hs664rt"]
BY_NAME = MACHINES[:2]

OPERATION = """TOOL PATH/{name},TOOL,{tool}
{data}
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,{number}
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,500
GOTO/0,0,5
GOTO/0,0,3
RAPID
GOTO/0,0,50
END-OF-PATH
"""
MILL = "TLDATA/MILL,20,0,75,0,0"

#: Tools that are not ``MILL``, with what differs.
OTHERS = {
    "TLDATA/MILL,6,0,75,0,0": "diameter 20 and 6",
    "TLDATA/MILL,20,2,75,0,0": "corner radius 0 and 2",
    "TLDATA/MILL,20,0,80,0,0": "length 75 and 80",
    "TLDATA/MILL,20,0,75,45,0": "taper angle 0 and 45",
    "TLDATA/MILL,20,0,75,0,10": "tip angle 0 and 10",
    "TLDATA/DRILL,20,0,75,118,50": "form MILL and DRILL",
}


def operation(name: str, data: str = MILL, tool: str = "TOOL", number: int = 1) -> str:
    return OPERATION.format(name=name, data=data, tool=tool, number=number)


@pytest.mark.parametrize("machine", MACHINES)
def test_different_tools_under_one_number_are_refused(post: Post, machine: str) -> None:
    text = operation("A") + operation("B", "TLDATA/DRILL,6,0,80,118,50")
    code, out, err = post.all(text, machine=machine)
    assert (code, out) == (1, [])
    what = "operations A and B both call tool 1, and their CL data differ: form MILL and DRILL, diameter 20 and 6"
    assert f"part.cls:15: error: {what}" in err
    assert "number the tools apart in the CAM, or write --set tool=OPERATION:NUMBER for one of them" in err
    assert post.all(text, "--set", "tool=B:2", machine=machine)[0] == 0


@pytest.mark.parametrize("data", OTHERS)
def test_every_size_that_differs_is_named(post: Post, data: str) -> None:
    code, _, err = post.all(operation("A") + operation("B", data) + operation("C", data))
    assert code == 1
    assert err.count(f"operations A and B both call tool 1, and their CL data differ: {OTHERS[data]}") == 1
    assert "operations A and C" not in err
    assert "operations B and C" not in err


@pytest.mark.parametrize("machine", MACHINES)
def test_one_tool_setting_for_different_tools_is_refused(post: Post, machine: str) -> None:
    text = operation("A") + operation("B", "TLDATA/MILL,6,0,75,0,0", number=2)
    assert post.all(text, machine=machine)[0] == 0
    code, _, err = post.all(text, "--set", "tool=5", machine=machine)
    assert code == 1
    assert "operations A and B both call tool 5" in err


@pytest.mark.parametrize("machine", BY_NAME)
def test_different_tools_of_one_name_are_refused(post: Post, machine: str) -> None:
    text = operation("A") + operation("B", "TLDATA/MILL,6,0,75,0,0", number=2)
    code, _, err = post.all(text, "--set", "tool_call=name", machine=machine)
    assert code == 1
    assert 'operations A and B both call tool "TOOL"' in err


@pytest.mark.parametrize("machine", MACHINES)
def test_a_tool_that_is_loaded_again_is_one_tool(post: Post, machine: str) -> None:
    same = "TLDATA/MILL,20.0005,0,75,0,0"
    code, _, err = post.all(operation("A") + operation("B") + operation("C", same), machine=machine)
    assert code == 0
    assert "call tool" not in err


@pytest.mark.parametrize("machine", MACHINES)
def test_another_name_alone_is_a_warning(post: Post, machine: str) -> None:
    text = operation("A") + operation("B", tool="OTHER") + operation("C", tool="OTHER")
    code, _, err = post.all(text, machine=machine)
    assert code == 0
    assert err.count("warning: tool 1 is TOOL in operation A, and OTHER in B") == 1
    assert "in C" not in err


@pytest.mark.parametrize("unstated", ["TLDATA/MILL,0,0,0,0,0", "TLDATA/FANCY,1,2,3"])
def test_what_a_file_does_not_state_differs_from_nothing(post: Post, unstated: str) -> None:
    assert post.all(operation("A") + operation("B", unstated))[0] == 0


def test_the_problem_is_in_the_file_of_the_operation(tmp_path: Path) -> None:
    files = [tmp_path / "a.cls", tmp_path / "b.cls"]
    for file, data in zip(files, (MILL, "TLDATA/MILL,6,0,75,0,0"), strict=True):
        file.write_text(operation("A") + operation(file.stem, data), encoding="utf-8")
    with pytest.raises(trunnion.RefusedError) as refused:
        trunnion.post(files, machine="yl569")
    places = [(Path(problem.file).name, problem.line) for problem in refused.value.problems[:-1]]
    assert places == [("b.cls", 15)]


def test_force_says_so_in_the_head(post: Post) -> None:
    text = operation("A") + operation("B", "TLDATA/MILL,6,0,75,0,0")
    out = post.all(text, "--force")[1]
    assert any("MUST NOT RUN AS IT IS" in line and "both call tool 1" in line for line in out)


@pytest.mark.parametrize(("machine", "refused"), [("yl569", False), ("matsuura_mx330", True), ("xyzac_trt", True)])
def test_two_tools_with_one_length_register_are_refused_where_it_counts(
    post: Post, machine: str, refused: bool
) -> None:
    text = operation("A") + operation("B", tool="OTHER", number=2).replace("LOAD/TOOL,2", "LOAD/TOOL,2,ADJUST,1")
    code, out, err = post.all(text, machine=machine)
    assert (code, bool(out)) == ((1, False) if refused else (0, True))
    said = "part.cls:15: error: tool 2 of operation B has length register 1, as tool 1 has"
    assert (said in err) is refused
    assert post.all(text, "--set", "tool=B:3", machine=machine)[0] == 0


@pytest.mark.parametrize(
    ("machine", "more", "said"),
    [
        ("yl569", (), "takes the length of a cutting edge: D1"),
        ("yl569", ("--set", "edge=3"), "takes the length of a cutting edge: D3"),
        ("yl569", ("--set", "edge=5"), ""),
        ("hs664rt", (), "takes the length of the tool"),
        ("dmu65", (), "takes the length of the tool"),
        ("matsuura_mx330", (), ""),
    ],
)
def test_a_length_register_that_the_control_does_not_take_is_warned_of(
    machine: str, more: tuple[str, ...], said: str, post: Post
) -> None:
    text = OPERATION.format(name="OP1", tool="D20", data=MILL, number="2,ADJUST,5")
    code, _, err = post.all(text, *more, machine=machine)
    assert code == 0
    assert ("CTL715" in err) == bool(said)
    assert said in err
