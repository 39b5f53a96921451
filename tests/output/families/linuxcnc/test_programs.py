"""LinuxCNC programs of toolpaths, and the messages where LinuxCNC has no words."""

from pathlib import Path

import pytest

from tests.support.linuxcnc.posting import FOOT, Post
from tests.support.linuxcnc.posting import post as post
from tests.support.posting import HEAD, LEANING
from trunnion.cli import main
from trunnion.families import FAMILIES
from trunnion.output.families.linuxcnc.writer import comment

TILTED = HEAD.replace("50.0,0.0,0.0,1.0", "50.0,0.0,0.5,0.8660254037844386")


def motion(lines: list[str]) -> list[str]:
    """The blocks between the tool length and the end of the path, without phase comments."""
    part = lines[lines.index("G43 H1") + 1 : len(lines) - 1 - lines[::-1].index("G49")]
    return [line for line in part if not line.startswith("; ") and line != "M429"]


def test_a_five_axis_operation_goes_home_turns_and_only_then_switches_the_kinematics(post: Post) -> None:
    assert post(LEANING + FOOT, "--set", "title=A LEANING CUT") == [
        "; A LEANING CUT",
        "G21 G17 G40 G49 G80 G90 G91.1 G94",
        "; start of operation",
        "; OP1",
        "; tool D10, milling tool, diameter 10., corner 0.",
        "M429",
        "G49",
        "G53 G0 Z0.",
        "G53 G0 X0. Y0. A0. C0.",
        "T1 M6",
        "G64 P0.02",
        "G54",
        "G0 A30. C0.",
        "G43 H1",
        "M428",
        "G0 X0. Y0. Z50. S4000 M3",
        "; cut",
        "G1 X10. Z5. A36.8699 F500.",
        "M429",
        "G49",
        "G53 G0 Z0.",
        "G53 G0 X0. Y0. A0. C0.",
        "M5",
        "M9",
        "M2",
    ]


def test_a_three_axis_operation_leaves_the_kinematics_alone(post: Post) -> None:
    lines = post(HEAD + FOOT)
    assert "M428" not in lines
    assert motion(lines) == ["G0 X0. Y0. Z50. S4000 M3", "G1 X10. Z5. F500."]


def test_a_tilted_plane_is_made_with_tcp_and_that_is_said(post: Post) -> None:
    code, lines, err = post.all(TILTED + FOOT)
    assert code == 0
    assert "M428" in lines
    assert "operation OP1 is in a tilted plane, which the control does not support; it is made with TCP" in err


def test_a_tilted_plane_that_is_wished_for_is_refused(post: Post) -> None:
    code, lines, err = post.all(TILTED + FOOT, "--set", "mode=tilted")
    assert (code, lines) == (1, [])
    assert "part.cls:1: error: operation OP1: the control does not support the mode tilted plane" in err


def test_without_tcp_feeds_are_times_and_the_slides_follow(post: Post) -> None:
    given = ["--set", "tcp=off", "--set", "zero=0,0,0", "--set", "tool_length=50"]
    lines = motion(post(LEANING + FOOT, *given))
    assert lines[1].startswith("G93 G1 ")
    assert all(" F" in line for line in lines[1:-1])
    assert lines[-1] == "G94"


@pytest.mark.parametrize(
    ("normal", "end", "words"),
    [
        ("0.0,0.0,1.0", "0.0,0.0,5.0", "G3 X0. Y0. I-5. J0."),
        ("0.0,0.0,-1.0", "0.0,0.0,5.0", "G2 X0. Y0. I-5. J0."),
        ("0.0,1.0,0.0", "0.0,0.0,5.0", "G18 G3 X0. Z5. I-5. K0."),
        ("0.0,-1.0,0.0", "0.0,0.0,5.0", "G18 G2 X0. Z5. I-5. K0."),
    ],
)
def test_arcs_turn_as_they_should_in_their_plane(normal: str, end: str, words: str, post: Post) -> None:
    text = HEAD + f"CIRCLE/5.0,0.0,5.0,{normal},5.0,0.06,0.5,10.0,0.0\nGOTO/{end}\n" + FOOT
    assert motion(post(text))[2] == words


def test_whole_turns_count_the_arc_itself(post: Post) -> None:
    # TIMES,3 is two turns besides the one to the end
    text = HEAD + "CIRCLE/5.0,0.0,5.0,0.0,0.0,1.0,5.0,0.06,0.5,10.0,0.0,TIMES,3\nGOTO/0.0,0.0,2.0\n" + FOOT
    assert motion(post(text))[2].endswith("P3")


def test_dwells_are_seconds_also_those_of_spindle_turns(post: Post) -> None:
    assert motion(post(HEAD + "DELAY/2.5\nDELAY/30,REV\nGOTO/20,0,5\n" + FOOT))[2:4] == ["G4 P2.5", "G4 P0.45"]


def test_texts_for_the_operator_lose_their_brackets_and_long_ones_go_on(post: Post) -> None:
    lines = post(HEAD + f"DISPLY/look (here)\nPPRINT/{'x' * 260}\nGOTO/20,0,5\n" + FOOT)
    assert "(MSG, look [here])" in lines
    at = lines.index("; " + "x" * 200)
    assert lines[at + 1] == "; " + "x" * 60


REFUSED = {
    "a compensation": ("CUTCOM/LEFT,YZPLAN\nGOTO/20,0,5\n", "cutter radius compensation in the plane YZ"),
    "the other side": (
        "CUTCOM/LEFT\nGOTO/20,0,5\nCUTCOM/RIGHT\nGOTO/30,0,5\n",
        "CUTCOM/RIGHT before CUTCOM/OFF has ended CUTCOM/LEFT: the control refuses it",
    ),
    "a side before one motion": (
        "CUTCOM/RIGHT\nCUTCOM/LEFT\nGOTO/20,0,5\n",
        "CUTCOM/LEFT before CUTCOM/OFF has ended CUTCOM/RIGHT",
    ),
    "the same side if its end is skipped": (
        "CUTCOM/LEFT\nGOTO/20,0,5\nOPSKIP/ON\nCUTCOM/OFF\nGOTO/30,0,5\nOPSKIP/OFF\nCUTCOM/LEFT\nGOTO/40,0,5\n",
        "CUTCOM/LEFT before CUTCOM/OFF has ended CUTCOM/LEFT",
    ),
    "a coolant": ("COOLNT/THRU\nGOTO/20,0,5\n", "LinuxCNC has no coolant THRU"),
}


@pytest.mark.parametrize(("text", "what"), REFUSED.values(), ids=REFUSED.keys())
def test_what_it_has_no_words_for_is_refused(text: str, what: str, post: Post) -> None:
    code, lines, err = post.all(HEAD + text + FOOT)
    assert (code, lines) == (2, [])
    assert what in err


SIDES = {
    "said twice": "CUTCOM/LEFT\nGOTO/20,0,5\nCUTCOM/LEFT\nGOTO/30,0,5\n",
    "ended between": "CUTCOM/LEFT\nGOTO/20,0,5\nCUTCOM/OFF\nGOTO/30,0,5\nCUTCOM/RIGHT\nGOTO/40,0,5\n",
    "begun after a skip": "OPSKIP/ON\nGOTO/20,0,5\nOPSKIP/OFF\nCUTCOM/LEFT\nGOTO/30,0,5\n",
}


@pytest.mark.parametrize("text", SIDES.values(), ids=SIDES.keys())
def test_a_side_that_begins_once_is_taken(text: str, post: Post) -> None:
    _, lines, err = post.all(HEAD + text + "CUTCOM/OFF\nGOTO/50,9,5\n" + FOOT)
    assert lines, err


def test_feed_per_revolution_wants_a_spindle_speed(post: Post) -> None:
    text = HEAD.replace("SPINDL/RPM,4000.0000,CLW\n", "").replace("FEDRAT/MMPM,500.0", "FEDRAT/MMPR,0.1")
    code, lines, err = post.all(text + FOOT)
    assert (code, lines) == (2, [])
    assert "part.cls:10: error: a feed per revolution before the spindle has a speed; put SPINDL before it" in err


def test_tools_have_no_names(post: Post) -> None:
    code, lines, err = post.all(HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "") + FOOT)
    assert (code, lines) == (2, [])
    assert "LinuxCNC: tools are called by number, and not as D10; write --set tool=OPERATION:NUMBER" in err


def test_a_line_longer_than_the_control_reads_is_refused(post: Post) -> None:
    code, lines, err = post.all(HEAD + f"INSERT/(MSG, {'x' * 250})\n" + FOOT)
    assert (code, lines) == (1, [])
    assert "255" in err


def test_what_was_written_is_posted_again_for_another_machine_and_control(post: Post, tmp_path: Path) -> None:
    (tmp_path / "part.ngc").write_text("".join(f"N1 {line}\n" for line in post(LEANING + FOOT)))
    given = ["--machine", "xyzac_trt", "--to-machine", "yl569", "--output", str(tmp_path / "part.mpf")]
    assert main(["convert", str(tmp_path / "part.ngc"), *given]) == 0
    assert "TRAORI" in (tmp_path / "part.mpf").read_text()


def test_a_program_that_nobody_can_read_back_is_written_by_force_only_and_says_so(
    post: Post, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(FAMILIES, "linuxcnc", FAMILIES["linuxcnc"]._replace(reader=None))
    code, lines, err = post.all(HEAD + FOOT)
    assert (code, lines) == (1, [])
    assert "xyzac_trt: error: programs for LinuxCNC cannot be read back yet: nothing proves this one" in err
    code, lines, err = post.all(HEAD + FOOT, "--force")
    assert code == 1
    assert lines[0].startswith("; MUST NOT RUN AS IT IS, written by --force: programs for LinuxCNC cannot be read back")
    assert "nothing has been checked" in err


#: Texts that LinuxCNC would execute as the beginning of a comment.
EXECUTED = [
    "py,import os",
    "PyRun , x.py",
    "logopen,x.txt",
    "LOGCLOSE",
    "probeopen x",
    "abort,now",
    "print,#1",
    "axis,stop",
]


@pytest.mark.parametrize("text", EXECUTED)
def test_no_text_of_a_cl_file_is_a_comment_that_is_executed(text: str, post: Post) -> None:
    lines = post(HEAD.replace("OP1", text) + f"PPRINT/{text}\n" + FOOT, "--set", f"title={text}")
    assert [line for line in lines if line.startswith("; -")] == [f"; - {text}"] * 3


def test_a_comment_that_goes_on_in_the_next_line_is_not_executed_there(post: Post) -> None:
    assert comment("x" * 200 + "py,import os") == ["; " + "x" * 200, "; - py,import os"]
    rooms = range(225, 255)  # one of them is what a line of a template has room for
    for room in rooms:
        lines = post(HEAD + FOOT, "--set", "title=" + "x" * room + "py,import os" * 3)
        assert not [line for line in lines if line.startswith("; py,")]


@pytest.mark.parametrize("text", ["printed in red", "logo", "Python", "message, shown", "log", "- py,import os"])
def test_other_comments_stay_as_they_are(text: str) -> None:
    assert comment(text) == [f"; {text}"]
