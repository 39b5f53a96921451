"""What the events of a toolpath become in a Sinumerik program."""

from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD, Post
from tests.support.posting import post as post
from tests.support.proof import unproven
from trunnion.cli import main

OFF_AXIS = HEAD.replace("0.0,0.0,50.0,0.0,0.0,1.0", "0.0,0.0,50.0,0.5,0.0,0.8660254")


def motion(lines: list[str]) -> list[str]:
    """The blocks between the work offset and the end of the path, without ORI words and phase comments."""
    part = lines[lines.index("G54") + 1 : lines.index(";End of Path")]
    return [line for line in part if not line.startswith("ORI") and line not in (";Rapid Move", ";Cutting")]


def test_spindle_edge_and_sense_stand_in_the_first_block(post: Post) -> None:
    assert motion(post(HEAD + FOOT)) == ["G0 X0.0 Y0.0 Z50. S4000 D1 M3", "G1 X10. Z5. F500."]


def test_a_counterclockwise_spindle_is_m4_and_a_new_speed_joins_the_next_block(post: Post) -> None:
    text = HEAD.replace("CLW", "CCLW") + "SPINDL/RPM,2000,CCLW\nGOTO/20,0,5\nSPINDL/OFF\nGOTO/30,0,5\n" + FOOT
    lines = motion(post(text, "--set", "standing_spindle=allowed"))
    assert lines[0].endswith("M4")
    assert lines[2:] == ["X20. S2000", "M5", "X30."]


@pytest.mark.parametrize(("word", "code"), [("ON", 8), ("FLOOD", 8), ("MIST", 7), ("THRU", 26), ("TAP", 8)])
def test_coolant_joins_the_next_motion(word: str, code: int, post: Post) -> None:
    assert motion(post(HEAD + f"COOLNT/{word}\nGOTO/20,0,5\n" + FOOT))[2] == f"X20. M{code}"


def test_what_is_switched_off_is_off_before_the_next_motion(post: Post) -> None:
    assert motion(post(HEAD + "COOLNT/OFF\nGOTO/20,0,5\n" + FOOT))[2:] == ["M9", "X20."]


@pytest.mark.parametrize("words", ["FLOOD", "THRU", "THRU FLOOD", "THRU OFF FLOOD"])
def test_coolant_is_off_before_the_end(words: str, post: Post) -> None:
    lines = post(HEAD + "".join(f"COOLNT/{word}\nGOTO/20,{k},5\n" for k, word in enumerate(words.split())) + FOOT)
    assert lines[lines.index(";End of Program") - 1] == "M9"


def test_two_coolants_before_one_motion_are_both_said(post: Post) -> None:
    assert motion(post(HEAD + "COOLNT/FLOOD\nCOOLNT/THRU\nGOTO/20,0,5\n" + FOOT))[2:] == ["M8", "X20. M26"]


def test_what_comes_after_the_last_motion_has_a_block_of_its_own(post: Post) -> None:
    assert motion(post(HEAD + "COOLNT/OFF\n" + FOOT))[2:] == ["M9"]


def test_coolant_that_the_control_does_not_have_is_an_error(post: Post) -> None:
    code, out, err = post.all(HEAD + "COOLNT/AIR\nGOTO/20,0,5\n" + FOOT)
    assert (code, out) == (2, [])
    assert "part.cls:12: error: Sinumerik 840D sl has no coolant AIR" in err


def test_feed_per_revolution_is_g95_and_what_was_in_force_comes_back(post: Post) -> None:
    lines = motion(post(HEAD + "FEDRAT/MMPR,0.25\nGOTO/20,0,5\n" + FOOT))
    assert lines[2:] == ["G95 X20. F.25", "G94"]


def test_a_feed_is_said_again_when_it_means_something_else(post: Post) -> None:
    lines = motion(post(HEAD + "FEDRAT/MMPR,0.5\nGOTO/20,0,5\n" + FOOT))
    assert lines[2:] == ["G95 X20. F.5", "G94"]


def test_dwells_stops_messages_and_inserts_are_blocks_of_their_own(post: Post) -> None:
    text = HEAD + "DELAY/2.5\nDELAY/30,REV\nSTOP\nOPSTOP\nPPRINT/look here\nINSERT/H1=5\nGOTO/10,0,5\n" + FOOT
    own = ["G4 F2.5", "G4 S30.", "M5", "M0", "M1", "M3", ";look here", "H1=5"]
    said_again = ["G94 G1 X10. Y0.0 Z5. B0.0 C0.0 F500.", "G40 G17"]  # H1=5 may have changed anything
    assert motion(post(text))[2:] == own + said_again


def test_the_text_of_a_stop_is_displayed_until_the_program_goes_on(post: Post) -> None:
    lines = motion(post(HEAD + 'STOP/CHECK THE "INSERT"\nGOTO/20,0,5\nOPSTOP/LOOK\nGOTO/30,0,5\n' + FOOT))
    assert lines[2:6] == ["M5", "MSG(\"CHECK THE 'INSERT'\")", "M0", "MSG()"]
    at = lines.index('MSG("LOOK")')
    assert lines[at + 1 : at + 3] == ["M1", "MSG()"]
    long = motion(post(HEAD + f"STOP/{'WORD ' * 60}\nGOTO/20,0,5\n" + FOOT))
    assert [line for line in long if line.startswith("MSG(") and len(line) > 100]
    assert sum(line.count("WORD") for line in long if line.startswith(";")) == 60


def test_a_message_is_ended_only_where_one_is_displayed(post: Post) -> None:
    text = HEAD + "DISPLY/LOOK\nDISPLY/\nGOTO/20,0,5\n" + FOOT
    assert 'MSG("LOOK")' in post(text)
    assert "MSG()" in post(text)
    fanuc = post.all(text, machine="matsuura_mx330")[1]
    assert "(LOOK)" in fanuc
    assert "()" not in fanuc


def test_cutter_compensation_joins_the_next_motion_and_is_taken_back(post: Post) -> None:
    lines = motion(post(HEAD + "CUTCOM/LEFT\nGOTO/20,0,5\nCUTCOM/OFF\nGOTO/30,0,5\n" + FOOT))
    assert lines[2:] == ["G41 X20.", "G40 X30."]
    left_on = motion(post(HEAD + "CUTCOM/RIGHT\nGOTO/20,0,5\n" + FOOT))
    assert left_on[2:] == ["G42 X20.", "G40"]


def test_block_skip_marks_the_blocks_between_on_and_off(post: Post) -> None:
    lines = post(HEAD + "OPSKIP/ON\nGOTO/20,0,5\nOPSKIP/OFF\nGOTO/30,0,5\n" + FOOT)
    assert sum(line.startswith("/") for line in lines) == 1


ARC = "CIRCLE/{centre},{normal},10.0,0.06,0.5,10.0,0.0\nGOTO/{end}\n"


@pytest.mark.parametrize(
    ("centre", "normal", "end", "block"),
    [
        ("20,0,5", "0,0,1", "30,0,5", "G3 X30. Y0.0 I10. J0.0"),
        ("20,0,5", "0,0,-1", "30,0,5", "G2 X30. Y0.0 I10. J0.0"),
        ("20,0,5", "0,0,1", "10,0,5", "G3 X10. Y0.0 I10. J0.0"),
        ("20,0,5", "0,0,1", "30,0,2", "G3 X30. Y0.0 Z2. I10. J0.0"),
    ],
)
def test_arcs_are_written_in_their_plane_with_a_relative_centre(
    centre: str, normal: str, end: str, block: str, post: Post
) -> None:
    lines = motion(post(HEAD + ARC.format(centre=centre, normal=normal, end=end) + FOOT))
    assert lines[2] == block


@pytest.mark.parametrize(
    ("centre", "normal", "end", "block"),
    [
        ("20,0,5", "0,1,0", "30,0,5", "G18 G3 X30. Z5. I10. K0.0"),
        ("10,10,5", "1,0,0", "10,20,5", "G19 G3 Y20. Z5. J10. K0.0"),
    ],
)
def test_other_planes_are_used_only_where_the_tools_length_stays_in_z(
    centre: str, normal: str, end: str, block: str, post: Post, tmp_path: Path
) -> None:
    text = HEAD + ARC.format(centre=centre, normal=normal, end=end) + FOOT
    assert not any(line.startswith(("G18", "G19")) for line in post(text))
    assert post(text, "--set", "zero=0,0,0", "--set", "tool_length=80"), "proven with a tool"
    own = tmp_path / "own.toml"
    planes = 'extends = "yl569"\n[control.arcs]\nabout = "XYZ"\n'
    own.write_text(planes, encoding="utf-8")
    code, _, err = post.all(text, machine=str(own))
    assert code
    assert "the tip is elsewhere with a longer tool" in err
    assert "with a tool 100 mm longer the tip is up to 141.421356 mm elsewhere, at 1 point" in err
    own.write_text(planes + "[control.reading]\nlength_along_z = true\n", encoding="utf-8")
    assert motion(post(text, machine=str(own)))[2] == block
    with_tool = post(text, "--set", "zero=0,0,0", "--set", "tool_length=80", machine=str(own))
    assert motion(with_tool)[2] == block


def test_a_helix_of_several_turns_says_how_many_more(post: Post) -> None:
    lines = motion(post(HEAD + "CIRCLE/20,0,5,0,0,1,10,0.06,0.5,10,0,TIMES,3\nGOTO/10,0,-1\n" + FOOT))
    assert lines[2].startswith("G3 X10. Y0.0 Z-1. I10. J0.0 TURN=")


def test_an_oblique_arc_becomes_lines(post: Post) -> None:
    lines = motion(post(HEAD + ARC.format(centre="20,0,5", normal="0,0.6,0.8", end="30,0,5") + FOOT))
    assert len(lines) > 20
    assert not any("G2" in line or "G3" in line for line in lines)
    assert lines[-1].startswith("X30. Y0.0 Z5.")


def test_an_arc_under_a_tilted_steady_tool_axis_stays_an_arc(post: Post) -> None:
    arc = ARC.format(centre="20,0,5", normal="0,0,1", end="30,0,5")
    assert motion(post(OFF_AXIS + arc + FOOT, "--set", "mode=tcp"))[2] == "G3 X30. Y0.0 I10. J0.0"


def test_a_second_operation_with_the_same_tool_changes_no_tool_and_starts_the_spindle_again(post: Post) -> None:
    second = HEAD.replace("OP1", "OP2").replace("SPINDL/RPM,4000.0000,CLW\n", "")
    lines = post(HEAD + FOOT + second + FOOT)
    assert lines.count("M6") == 1
    assert sum("S4000 D1 M3" in line for line in lines) == 2
    assert lines.count("M30") == 1


def test_a_second_tool_is_changed_after_coolant_off_and_from_home(post: Post) -> None:
    second = HEAD.replace("OP1", "OP2").replace("LOAD/TOOL,1", "LOAD/TOOL,2")
    lines = post(HEAD + "COOLNT/ON\nGOTO/20,0,5\n" + FOOT + second + FOOT)
    change = lines.index(";Tool Change")
    assert lines[change + 1 : change + 3] == ["T=2", "M6"]
    assert "M9" in lines[:change]
    assert lines[change - 1].startswith("SUPA G0 X=_X_HOME")


def test_rotary_axes_are_placed_before_traori(post: Post) -> None:
    lines = post(OFF_AXIS + FOOT, "--set", "mode=tcp")
    assert lines.index("G0 B30. C0.0") < lines.index("TRAORI")
    assert "TRAFOOF" in lines[lines.index(";End of Path") :]


def test_the_mode_may_be_set_for_one_operation(post: Post) -> None:
    both = OFF_AXIS + FOOT + OFF_AXIS.replace("OP1", "OP2") + FOOT
    assert "TRAORI" not in post(both)
    assert post(both, "--set", "mode=OP2:tcp").count("TRAORI") == 1
    assert post(both, "--set", "mode=tcp").count("TRAORI") == 2
    assert post(both, "--set", "mode=tcp,OP1:auto").count("TRAORI") == 1
    for said, why in (
        ("OP3:tcp", "mode is set for operation OP3, and the program has none of that name; write one of OP1, OP2"),
        ("OP1:five", "mode is 'OP1:five'; write one of auto, three-axis, tilted, tcp; OPERATION:WORD says it of one"),
        ("five", "mode is 'five'; write one of auto, three-axis, tilted, tcp"),
    ):
        code, out, err = post.all(both, "--set", f"mode={said}")
        assert (code, out) == (2, [])
        assert why in err


def test_a_cut_without_a_feed_is_an_error(post: Post) -> None:
    code, out, err = post.all(HEAD.replace("FEDRAT/MMPM,500.0\n", "") + FOOT)
    assert (code, out) == (2, [])
    assert "part.cls:10: error: cutting motion without a feed" in err


def test_without_load_tool_the_tool_is_called_by_its_name(post: Post) -> None:
    code, out, err = post.all(HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "") + FOOT)
    assert code == 0
    assert 'T="D10"' in out
    assert "part.cls:1: warning: operation OP1 has no LOAD/TOOL; its tool is called by its name" in err


def test_an_operation_without_load_tool_goes_on_with_the_tool_of_that_name(post: Post) -> None:
    second = HEAD.replace("OP1", "OP2").replace("LOAD/TOOL,1,ADJUST,1\n", "")
    lines = post(HEAD + FOOT + second + FOOT)
    assert [line for line in lines if line.startswith("T=")] == ["T=1"]


def test_a_tool_without_number_and_name_is_an_error_that_names_the_setting(post: Post) -> None:
    code, out, err = post.all(HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "").replace(",TOOL,D10", ",TOOL,") + FOOT)
    assert (code, out) == (2, [])
    assert "operation OP1 has no LOAD/TOOL, and its tool has no name" in err
    assert "--set tool=OPERATION:NUMBER" in err


def test_a_missing_spindle_speed_is_said(post: Post) -> None:
    text = HEAD.replace("SPINDL/RPM,4000.0000,CLW\n", "") + FOOT
    code, _, err = post.all(text)
    assert code != 0
    assert "part.cls:10: error: operation OP1 cuts while the spindle stands" in err
    assert "--set standing_spindle=allowed" in err
    code, _, err = post.all(text, "--set", "standing_spindle=allowed")
    assert code == 0
    assert "part.cls:1: warning: operation OP1 has no spindle speed" in err


@pytest.mark.parametrize("again", ["", "TOOL PATH"])
def test_a_cut_after_spindl_off_is_refused(post: Post, again: str) -> None:
    cut = "GOTO/77,0,5\n"
    second = FOOT + HEAD.replace("OP1", "OP2").replace("SPINDL/RPM,4000.0000,CLW\n", "") if again else ""
    text = HEAD + "SPINDL/OFF\n" + second + cut + "SPINDL/RPM,900,CLW\nGOTO/78,0,5\n" + FOOT
    code, _, err = post.all(text)
    assert code != 0
    assert f"operation OP{2 if again else 1} cuts while the spindle stands: SPINDL/OFF comes before" in err
    assert post(text, "--set", "standing_spindle=allowed")


def test_only_a_cut_needs_a_spindle(post: Post) -> None:
    late = HEAD.replace("SPINDL/RPM,4000.0000,CLW\n", "").replace("FEDRAT", "SPINDL/RPM,4000,CLW\nFEDRAT") + FOOT
    assert "has no spindle speed" not in post.all(late)[2]


def test_a_cycle_that_begins_below_its_height_is_refused(post: Post) -> None:
    code, out, err = post.all(HEAD + "CYCLE/DRILL,RAPTO,8,FEDTO,-10,MMPM,100\nGOTO/20,0,0\nCYCLE/OFF\n" + FOOT)
    assert (code, out) == (2, [])
    assert "part.cls:12: error: CYCLE while the tool is below the height of RAPTO" in err


def test_a_tool_change_within_an_operation_is_refused(post: Post) -> None:
    code, out, err = post.all(HEAD + "LOAD/TOOL,2\nGOTO/20,0,5\n" + FOOT)
    assert (code, out) == (2, [])
    assert "part.cls:12: error: tool change within an operation" in err


def test_a_tool_that_the_file_selects_is_preselected_there(post: Post) -> None:
    code, out, err = post.all(HEAD + "SELECT/TOOL,8\nGOTO/20,0,5\n" + FOOT)
    assert code == 0, err
    at = out.index("T=8")
    assert out[at - 1 : at + 2] == ["G1 X10. Z5. F500.", "T=8", "X20."]


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("SET/MODE,INCR", "SET/MODE,INCR: the points that follow would count from each other"),
        ("SPINDL/RPM,900,CLW,RANGE,2", "a gear range has no words here: SPINDL with RANGE"),
    ],
)
def test_what_the_program_cannot_follow_is_an_error(statement: str, said: str, post: Post) -> None:
    code, out, err = post.all(HEAD + statement + "\nGOTO/20,0,5\n" + FOOT)
    assert (code, out) == (2, [])
    assert f"part.cls:12: error: {said}" in err


def test_what_every_program_does_needs_no_word(post: Post) -> None:
    _, _, err = post.all(HEAD + "SET/MODE,ABSOL\nMULTAX/ON\nGOTO/20,0,5\n" + FOOT)
    assert "warning" not in err


def test_blocks_go_without_numbers_if_somebody_says_so(post: Post) -> None:
    _, numbered, _ = post.all(HEAD + FOOT)
    code, plain, err = post.all(HEAD + FOOT, "--set", "numbers=off")
    assert (code, unproven(err)) == (0, "")
    assert plain == numbered
    assert post.all(HEAD + FOOT, "--set", "numbers=none")[0] == 2


@pytest.mark.parametrize(("method", "mode"), [("ROUGH", "3"), ("SEMI_FINISH", "2"), ("FINISH", "1")])
def test_older_controls_take_the_kind_of_machining_as_a_number(method: str, mode: str, tmp_path: Path) -> None:
    machine, cl, nc = tmp_path / "old.toml", tmp_path / "a.cls", tmp_path / "a.mpf"
    text = 'extends = "yl569"\nname = "Old"\n[control]\nextends = "sinumerik_840d_sl26"\n'
    machine.write_text(text, encoding="utf-8")
    cl.write_text(HEAD + FOOT, encoding="utf-8")
    command = ["post", str(cl), "--machine", str(machine), "--output", str(nc), "--set", f"method={method}"]
    assert main(command) == 0
    assert f"CYCLE832(0.01, {mode},1)" in nc.read_text(encoding="utf-8")
