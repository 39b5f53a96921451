"""What becomes of toolpaths in Klartext, block by block."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, MACHINES, SHARES, SIMULTANEOUS, TCP, TILTED, Post, motion, proven
from tests.support.planes import reachable, text_of
from tests.support.posting import FOOT, HEAD
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.errors import InputError, RefusedError


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


def test_a_three_axis_program_whole(post: Post) -> None:
    text = HEAD + "COOLNT/FLOOD\nGOTO/20.5,-3.25,5.0\n" + FOOT
    assert post(text, "--set", "program=OP_10", "--set", "blank=-10,-10,-25.5,110,90,0") == [
        "BEGIN PGM OP_10 MM",
        "; DMG DMU 65",
        "BLK FORM 0.1 Z X-10 Y-10 Z-25.5",
        "BLK FORM 0.2 X+110 Y+90 Z+0",
        "PLANE RESET STAY",
        "* - OP1",
        "; tool D10, milling tool, diameter 10, corner 0",
        "; machining time 6.9 s of 6.9 s + rapids",
        "M129",
        "PLANE RESET STAY",
        "M137",
        "L Z+560 R0 FMAX M91",
        "L X+0 Y+0 R0 FMAX M91",
        "CYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ;DATUM NUMBER",
        "L A+0 C+0 R0 FMAX",
        "TOOL CALL 1 Z S4000",
        "CYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ;DATUM NUMBER",
        "CYCL DEF 32.0 TOLERANCE",
        "CYCL DEF 32.1 T0.02",
        "M126",
        "L A+0 C+0 R0 FMAX",
        "M3",
        "L X+0 Y+0 Z+50 FMAX",
        "; cut",
        "L X+10 Z+5 F500",
        "L X+20.5 Y-3.25 M8",
        "M5",
        "M9",
        "M127",
        "L Z+560 R0 FMAX M91",
        "L X+0 Y+0 R0 FMAX M91",
        "L A+0 C+0 R0 FMAX",
        "CYCL DEF 32.0 TOLERANCE",
        "CYCL DEF 32.1",
        "M30",
        "END PGM OP_10 MM",
    ]


def test_the_block_form_can_be_the_box_round_all_that_is_cut(post: Post) -> None:
    arc = "CIRCLE/0.0,0.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0\nGOTO/0.0,10.0,5.0\n"
    hole = "RAPID\nGOTO/0,10,50\nCYCLE/DRILL,RAPTO,3.0,FEDTO,-20.5,MMPM,250\nGOTO/0.5,-3.25,5\nCYCLE/OFF\n"
    hole += "RAPID\nGOTO/90,0,50\n"
    blocks = post(HEAD + arc + hole + FOOT, "--set", "blank=extents")
    assert blocks[2:4] == ["BLK FORM 0.1 Z X-10 Y-10 Z-16", "BLK FORM 0.2 X+10 Y+10 Z+50"]
    rapids = HEAD.replace("FEDRAT/MMPM,500.0\n", "RAPID\n") + FOOT
    assert not any(
        block.startswith("BLK FORM") for block in post(rapids, "--set", "blank=extents", "--set", "cl_units=mm")
    )


@pytest.mark.parametrize(("way", "on", "off"), [(way, *words) for way, words in TCP.items()])
@pytest.mark.parametrize("machine", ["dmu65", "mikron_600u", "ucp800"])
def test_tcp_comes_on_after_the_rotary_axes_are_placed_and_goes_off_before_the_retract(
    machine: str, way: str, on: str, off: str, post: Post
) -> None:
    blocks = post(SIMULTANEOUS, "--set", f"tcpm={way}", machine=machine)
    begin, end = blocks.index("M126"), blocks.index("M5")
    assert blocks[begin + 1].startswith("L ")
    assert blocks[begin + 1].endswith(" R0 FMAX")
    assert blocks[begin + 2] == on
    assert blocks[end : end + 4] == ["M5", "M9", off, "M127"]
    assert blocks[end + 4].startswith("L Z+")
    assert blocks[end + 4].endswith(" R0 FMAX M91")
    assert blocks[end + 6].endswith("+0 R0 FMAX")
    assert blocks.count(on) == 1
    assert blocks.count(off) == 2  # at the start too: an aborted run may have left it on


def test_the_program_of_more_operations_calls_a_tool_only_when_it_is_another(post: Post) -> None:
    second = HEAD.replace("OP1", "OP2").replace("4000", "2500")
    third = HEAD.replace("OP1", "OP3").replace("TOOL,1,ADJUST,1", "TOOL,2,ADJUST,2").replace("CLW", "CCLW")
    blocks = post(HEAD + FOOT + second + FOOT + third + FOOT, "--set", "delta_radius=-0.05", "--set", "delta_length=.1")
    calls = [block for block in blocks if block.startswith("TOOL CALL")]
    assert calls == ["TOOL CALL 1 Z S4000 DL+0.1 DR-0.05", "TOOL CALL Z S2500", "TOOL CALL 2 Z S4000 DL+0.1 DR-0.05"]
    assert [block for block in blocks if block in ("M3", "M4", "M5")] == ["M3", "M5", "M3", "M5", "M4", "M5"]


def test_a_spindle_that_changes_within_an_operation_has_blocks_of_its_own(post: Post) -> None:
    lines = "SPINDL/RPM,2000,CLW\nGOTO/20,0,5\nSPINDL/OFF\nGOTO/30,0,5\nSPINDL/RPM,2000,CCLW\nGOTO/40,0,5\nSPINDL/OFF\n"
    blocks = post(HEAD + lines + FOOT, "--set", "standing_spindle=allowed")
    begin = blocks.index("L X+10 Z+5 F500")
    part = ["L X+10 Z+5 F500", "TOOL CALL Z S2000", "M3", "L X+20", "M5", "L X+30", "M4", "L X+40", "M5"]
    assert blocks[begin : begin + 9] == part


def test_feed_per_turn_is_m136_and_ends_with_the_operation(post: Post) -> None:
    blocks = post(HEAD + "FEDRAT/MMPR,0.1\nGOTO/20,0,5\n" + FOOT)
    assert motion(blocks)[-2:] == ["L X+20 F0.1 M136", "M137"]


def test_a_dwell_is_cycle_9_in_seconds(post: Post) -> None:
    blocks = post(HEAD + "DELAY/2.5\nGOTO/20,0,5\nDELAY/100,REV\n" + FOOT)
    first, second = (["CYCL DEF 9.0 DWELL TIME", f"CYCL DEF 9.1 DWELL {seconds}"] for seconds in ("2.5", "1.5"))
    assert motion(blocks)[2:] == [*first, "L X+20", *second]


def test_radius_compensation_is_rl_rr_and_r0(post: Post) -> None:
    code, out, _ = post.all(HEAD + "CUTCOM/LEFT\nGOTO/20,0,5\nGOTO/20,9,5\nCUTCOM/OFF\nGOTO/30,9,5\n" + FOOT, "--force")
    blocks = [line.split(" ", 1)[1] for line in out.splitlines()]
    assert code == 0
    assert motion(blocks)[2:] == ["L X+20 RL", "L Y+9", "L X+30 R0"]


def test_texts_cannot_reach_into_other_blocks(post: Post) -> None:
    blocks = post(HEAD.replace("OP1", "OP1 ~") + "PPRINT/SEE ~\nGOTO/20,0,5\nOPSTOP/LOOK ~\n" + FOOT)
    assert "* - OP1 -" in blocks
    assert motion(blocks)[2:] == ["L X+20", "M1"]
    assert "; SEE -" in blocks
    assert "; LOOK -" in blocks


WRONG = {
    "disengage": "5",
    "program": "A B",
    "blank": "0,0,0,1,1",
    "work_offset": "G54",
    "plane": "sideways",
    "tcpm": "m130",
    "retract_distance": "-5",
    "normals": "on",
}


@pytest.mark.parametrize(("key", "value"), WRONG.items())
def test_settings_that_make_no_sense_are_errors(key: str, value: str, post: Post) -> None:
    code, out, err = post.all(HEAD + FOOT, "--set", f"{key}={value}")
    assert (code, out) == (2, "")
    assert f"{key} is {value!r}" in err


REFUSED = {
    "DELAY/4000\n": "the control waits 0.001 to 3600 s",
    "CUTCOM/LEFT,ZXPLAN\n": "radius compensation in the plane ZXPLAN",
}


@pytest.mark.parametrize(("text", "what"), REFUSED.items())
def test_what_klartext_cannot_say_is_refused(text: str, what: str, post: Post) -> None:
    code, out, err = post.all(HEAD + text + "GOTO/20,0,5\n" + FOOT)
    assert (code, out) == (2, "")
    assert what in err


@pytest.mark.parametrize("text", [SIMULTANEOUS, TILTED])
def test_the_tool_can_leave_along_its_own_axis(text: str, post: Post) -> None:
    along = post(text, "--set", "retract=m140")
    at = along.index("L M140 MB MAX")
    assert along[at - 1] == "M9"
    assert along[at + 1] in ("M129", "L Z+560 R0 FMAX M91")
    assert [block for block in along if block != "L M140 MB MAX"] == post(text)


#: Machines whose slides are known to end.
ENDED = sorted(name for name, each in MACHINES.items() if np.isfinite(each.limits[list(each.linear)]).all())


@settings(max_examples=examples(25))
@given(
    name=st.sampled_from(ENDED),
    shares=st.lists(SHARES, min_size=1, max_size=2),
    manner=st.booleans(),
    distance=st.sampled_from(["", "0.5", "40"]),
)
def test_a_retract_along_the_tool_axis_is_proven(
    name: str, shares: list[tuple[float, float]], manner: bool, distance: str, folder: Path
) -> None:
    machine, file = MACHINES[name], folder / "retract.cls"
    text = text_of([reachable(machine, share) for share in shares], [(0.0, 0.0, 0.0), (30.0, -5.0, 2.0)])
    file.write_text(text, encoding="utf-8")
    said = {"retract_distance": distance, **({"mode": "tcp"} if manner else {})}
    try:
        proven(read_cl(file), machine, CONTROLS["mikron_600u"], folder, retract="m140", **said)
    except (RefusedError, InputError):
        assume(False)


def test_the_tool_can_leave_along_its_own_axis_by_a_distance(post: Post) -> None:
    given = ("--set", "retract=m140", "--set", "retract_distance=12.5")
    for text in (SIMULTANEOUS, TILTED):
        along = post(text, *given)
        assert [block for block in along if block != "L M140 MB12.5"] == post(text)
        assert "L M140 MB12.5" in along


FAULTS = [
    ("MB12.5", "MB-12.5"),  # into the part
    ("L M140 MB12.5", "L M140 MB12.5 F200"),  # at a feed, which nobody asked for
    ("L M140 MB12.5", "L M140 MB12.5\nL M140 MB12.5"),  # and once more
]


@pytest.mark.parametrize(("right", "wrong"), FAULTS)
def test_a_wrong_retract_by_a_distance_is_found(
    right: str, wrong: str, post: Post, capfd: pytest.CaptureFixture[str]
) -> None:
    _, out, _ = post.all(SIMULTANEOUS, "--set", "retract=m140", "--set", "retract_distance=12.5")
    program = post.folder / "part.h"
    for text, code in ((out, 0), (out.replace(right, wrong), 1)):
        program.write_text(text, encoding="utf-8")
        assert main(["verify", str(program), "--machine", "dmu65", "--cl", str(post.folder / "part.cls")]) == code
    assert "order         FAIL" in capfd.readouterr().out
