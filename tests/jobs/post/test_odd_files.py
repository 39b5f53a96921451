"""CL files that are odd and sound: events without motion, tools without a number, cycles inside cuts."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import CLEAR, FOOT, HEAD

#: One machine of each family of controls.
MACHINES = ("yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt")

HOLES = "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/50,0,0\nGOTO/60,0,0\n"
SECOND = HEAD.replace("OP1", "OP2")
UNNUMBERED = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "")

ODD = {
    "coolant after the last point": HEAD + "COOLNT/MIST\n" + FOOT,
    "coolant after the last END-OF-PATH": HEAD + FOOT + "COOLNT/FLOOD\n",
    "coolant twice": HEAD + "COOLNT/MIST\nCOOLNT/FLOOD\nGOTO/20,0,5\nCOOLNT/OFF\nGOTO/20,0,50\n" + FOOT,
    "spindle after the last point": HEAD + "SPINDL/RPM,500,CLW\n" + FOOT,
    "spindle after the last END-OF-PATH": HEAD + FOOT + "SPINDL/RPM,500,CCLW\n",
    "spindle after the last hole": CLEAR + HOLES + "SPINDL/RPM,500,CLW\nCYCLE/OFF\n" + FOOT,
    "spindle after the last cycle": CLEAR + HOLES + "CYCLE/OFF\nSPINDL/RPM,500,CLW\n" + FOOT,
    "spindle twice": HEAD + "SPINDL/RPM,500,CLW\nSPINDL/RPM,900,CLW\nGOTO/20,0,5\n" + FOOT,
    "a tool before the operation that loads its own": "LOAD/TOOL,9\n" + HEAD + FOOT,
    "a tool between operations": HEAD + FOOT + "LOAD/TOOL,2\n" + UNNUMBERED.replace("OP1", "OP2") + FOOT,
    "holes inside a cut": HEAD + "GOTO/20,0,5\n" + HOLES + "CYCLE/OFF\nGOTO/60,0,5\nGOTO/30,0,5\n" + FOOT,
    "holes at the end of a cut": HEAD + "RAPID\nGOTO/20,0,50\n" + HOLES + FOOT,
}


@pytest.mark.parametrize("machine", MACHINES)
def test_an_odd_file_that_is_sound_is_posted_and_proven(tmp_path: Path, machine: str) -> None:
    refused = {}
    for name, text in ODD.items():
        (tmp_path / "part.cls").write_text(text)
        try:
            assert trunnion.post(tmp_path / "part.cls", machine=machine).passed
        except trunnion.RefusedError as error:
            refused[name] = str(error)
    assert refused == {}


@pytest.mark.parametrize("machine", ["yl569", "dmu65"])
def test_a_tool_without_a_number_before_one_that_has_one(tmp_path: Path, machine: str) -> None:
    (tmp_path / "part.cls").write_text(UNNUMBERED + FOOT + SECOND + FOOT)
    assert trunnion.post(tmp_path / "part.cls", machine=machine).passed


def test_of_two_tools_before_the_first_point_the_last_is_called(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text("LOAD/TOOL,9\n" + HEAD + FOOT)
    result = trunnion.post(tmp_path / "part.cls", machine="yl569")
    assert result.run is not None
    assert [event.value for event in result.run.events if event.kind == "tool_change"] == ["1"]


@pytest.mark.parametrize(
    ("old", "new", "check"),
    [("M7", "M8", "coolant"), ("S500", "S600", "spindle"), ("T=1", "T=7", "tool")],
)
def test_what_the_file_never_asks_for_is_still_found(tmp_path: Path, old: str, new: str, check: str) -> None:
    cl, file = tmp_path / "part.cls", tmp_path / "part.mpf"
    cl.write_text(HEAD + "COOLNT/MIST\nSPINDL/RPM,500,CLW\n" + FOOT)
    text = trunnion.post(cl, machine="yl569").text
    assert text is not None
    assert old in text
    file.write_text(text.replace(old, new))
    found = trunnion.verify(file, machine="yl569", cl=cl)
    assert check in {each.key for each in found.checks if not each.passed}


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("statement", "what"),
    [
        ("GOTO/1e12,0.0,5.0", "a coordinate of 1e+12 mm"),
        ("GOTO/0.0,0.0,-2000000.0", "a coordinate of 2000000 mm"),
        ("DELAY/1e12", "a dwell of 1e+12 s"),
        ("FEDRAT/MMPM,1e11", "word F1e+11 is beyond"),
        ("LOAD/TOOL,99999999999", "LOAD has 1e+11"),
    ],
)
def test_a_number_that_no_machine_has_is_an_input_error_with_its_line(
    tmp_path: Path, machine: str, statement: str, what: str
) -> None:
    (tmp_path / "part.cls").write_text(HEAD + f"{statement}\nGOTO/20.0,0.0,5.0\n" + FOOT)
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(tmp_path / "part.cls", machine=machine)
    (problem,) = (problem for problem in caught.value.problems if str(problem.severity) == "error")
    assert problem.line in (12, 13)
    assert what in problem.what
    assert problem.cure


@pytest.mark.parametrize("machine", MACHINES)
def test_a_spindle_speed_beyond_its_word_is_an_input_error_with_a_line(tmp_path: Path, machine: str) -> None:
    (tmp_path / "part.cls").write_text(HEAD.replace("4000.0000", "1e11") + FOOT)
    # Beyond the word it is an error of the file; beyond the machine alone, the program is refused.
    with pytest.raises(trunnion.TrunnionError, match=r"part.cls:\d+: error: .*(1e\+11|100000000000)"):
        trunnion.post(tmp_path / "part.cls", machine=machine)


def test_a_frame_too_far_away_is_an_input_error(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(HEAD.replace("MSYS/0.0000", "MSYS/1e11") + FOOT)
    with pytest.raises(trunnion.InputError, match=r"origin 1e\+11 mm away"):
        trunnion.post(tmp_path / "part.cls", machine="yl569")


def test_another_tool_with_the_speed_of_the_one_before_is_warned_of(tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    second = SECOND.replace("LOAD/TOOL,1,ADJUST,1", "LOAD/TOOL,2,ADJUST,2").replace("T1", "T2")
    speed = next(line for line in HEAD.splitlines(keepends=True) if line.startswith("SPINDL"))
    for text, count in ((HEAD + FOOT + second.replace(speed, "") + FOOT, 1), (HEAD + FOOT + second + FOOT, 0)):
        cl.write_text(text)
        result = trunnion.post(cl, machine="yl569", columns=False)
        assert sum("with the spindle speed of OP1" in problem.what for problem in result.problems) == count
