"""What becomes of toolpaths in Klartext, and whether the independent reader finds it to be what was asked for."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.control.test_planes import reachable, text_of
from tests.control.test_program import FOOT, HEAD
from tests.paths import GOLDEN
from tests.plan.naive import moves_of, operation_of
from tests.plan.test_optimum import short_paths, smooth_paths
from tests.verify.proven import unproven
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.cli.post import planned_program, write
from trunnion.cli.settings import wishes_of
from trunnion.control import Control, load_control
from trunnion.errors import InputError, Refused
from trunnion.machine import Machine, load_machine, shipped
from trunnion.reader import run_program
from trunnion.toolpath import Arcs, Kind, LoadTool, Moves, SpindleOn, Toolpath
from trunnion.verify import Verification, failures, verify

DMU65 = GOLDEN / "dmu65"
OWN = {name: load_machine(name) for name in ("dmu65", "mikron_600u", "ucp800")}
CONTROLS = {name: load_control(machine.control.fresh()) for name, machine in OWN.items()}

#: Every shipped machine, with the control of one of these.
MACHINES = {name: replace(load_machine(name), control=OWN["mikron_600u"].control.fresh()) for name in shipped()}


class Post:
    """Posts CL text on the DMU 65."""

    def __init__(self, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
        self.folder, self._capfd = folder, capfd

    def __call__(self, text: str, *arguments: str, machine: str = "dmu65") -> list[str]:
        """The blocks of the program without their numbers, which must go on by one from 0."""
        code, out, err = self.all(text, *arguments, machine=machine)
        assert (code, unproven(err)) == (0, "")
        blocks = re.split(r"\n(?! )", out.rstrip("\n"))
        assert [int(block.split(" ", 1)[0]) for block in blocks] == list(range(len(blocks)))
        return [block.split(" ", 1)[1] for block in blocks]

    def all(self, text: str, *arguments: str, machine: str = "dmu65") -> tuple[int, str, str]:
        file = self.folder / "part.cls"
        file.write_text(text, encoding="utf-8")
        code = main(["post", str(file), "--machine", machine, "--output", "-", *arguments])
        out, err = self._capfd.readouterr()
        return code, out, err


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


def between(blocks: list[str], first: str, last: str) -> list[str]:
    begin = blocks.index(first)
    return blocks[begin + 1 : blocks.index(last, begin)]


# Blocks


def motion(blocks: list[str]) -> list[str]:
    """What stands between the spindle's start and its stop, without names of phases."""
    return [block for block in between(blocks, "M3", "M5") if not block.startswith(";")]


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
        "; machining time 6.9 s of 6.9 s",
        "L Z+560 R0 FMAX M91",
        "L X+0 Y+0 R0 FMAX M91",
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
    assert not any(block.startswith("BLK FORM") for block in post(rapids, "--set", "blank=extents"))


SIMULTANEOUS = HEAD + "GOTO/20,0,5,0.5,0.0,0.8660254038\nGOTO/30,0,5,0.0,-0.5,0.8660254038\n" + FOOT
TCP = {"m128": ("M128", "M129"), "function": ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "FUNCTION RESET TCPM")}


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
    assert blocks.count(on) == blocks.count(off) == 1


def test_the_program_of_more_operations_calls_a_tool_only_when_it_is_another(post: Post) -> None:
    second = HEAD.replace("OP1", "OP2").replace("4000", "2500")
    third = HEAD.replace("OP1", "OP3").replace("TOOL,1", "TOOL,2").replace("CLW", "CCLW")
    blocks = post(HEAD + FOOT + second + FOOT + third + FOOT, "--set", "delta_radius=-0.05", "--set", "delta_length=.1")
    calls = [block for block in blocks if block.startswith("TOOL CALL")]
    assert calls == ["TOOL CALL 1 Z S4000 DL+0.1 DR-0.05", "TOOL CALL Z S2500", "TOOL CALL 2 Z S4000 DL+0.1 DR-0.05"]
    assert [block for block in blocks if block in ("M3", "M4", "M5")] == ["M3", "M5", "M3", "M5", "M4", "M5"]


def test_a_spindle_that_changes_within_an_operation_has_blocks_of_its_own(post: Post) -> None:
    lines = "SPINDL/RPM,2000,CLW\nGOTO/20,0,5\nSPINDL/OFF\nGOTO/30,0,5\nSPINDL/RPM,2000,CCLW\nGOTO/40,0,5\nSPINDL/OFF\n"
    blocks = post(HEAD + lines + FOOT)
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


ARC = "CIRCLE/{centre},0.0,0.0,{sense},10.0,0.06,0.5,10.0,0.0{turns}\nGOTO/{end}\n"


@pytest.mark.parametrize(
    ("arc", "blocks"),
    [
        ({"end": "0.0,10.0,5.0", "sense": "1.0"}, ["CC X+0 Y+0", "C X+0 Y+10 DR+"]),
        ({"end": "10.0,0.0,5.0", "sense": "-1.0"}, ["CC X+0 Y+0", "C X+10 Y+0 DR-"]),
        ({"end": "0.0,10.0,2.5", "sense": "1.0"}, ["CC X+0 Y+0", "CP IPA+90 IZ-2.5 DR+"]),
        ({"end": "0.0,10.0,2.5", "sense": "-1.0"}, ["CC X+0 Y+0", "CP IPA-270 IZ-2.5 DR-"]),
        ({"end": "10.0,0.0,2.5", "sense": "-1.0", "turns": ",TIMES,3"}, ["CC X+0 Y+0", "CP IPA-1080 IZ-2.5 DR-"]),
    ],
)  # fmt: skip
def test_arcs_have_their_centre_before_them_and_rise_as_polar_ones(
    arc: dict[str, str], blocks: list[str], post: Post
) -> None:
    text = ARC.format(**{"centre": "0.0,0.0,5.0", "turns": "", **arc})
    after = post(HEAD + text + "GOTO/10.0,20.0,2.5\n" + FOOT)
    at = after.index(blocks[0])
    assert after[at : at + 2] == blocks
    rises = blocks[1].startswith("CP")
    assert after[at + 2].startswith("L X+10 Y+20" if rises else "L ")
    assert ("Z+2.5" in after[at + 2]) is True, "nothing is left out that the polar block has not said"


def test_an_arc_in_another_plane_becomes_lines(post: Post) -> None:
    text = "CIRCLE/0.0,0.0,5.0,0.0,1.0,0.0,10.0,0.06,0.5,10.0,0.0\nGOTO/0.0,0.0,-5.0\n"
    blocks = post(HEAD + text + FOOT)
    assert not any(block.startswith(("CC", "C ", "CP")) for block in blocks)
    assert len(blocks) > 40


WRONG = {
    "disengage": "5",
    "program": "A B",
    "blank": "0,0,0,1,1",
    "work_offset": "G54",
    "plane": "euler",
    "tcpm": "m130",
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


# Planes


@pytest.mark.parametrize("line", (DMU65 / "expected_planes.txt").read_text(encoding="utf-8").splitlines())
def test_the_planes_are_those_of_the_programs_that_ran(line: str, post: Post) -> None:
    name, block = line.split(": ", 1)
    text = (DMU65 / name).read_text(encoding="utf-8")
    blocks = post(text.replace("$$ center", "INTOL/0.01\nOUTTOL/0.01\n$$ center"))
    assert block in blocks
    assert blocks.index(block) < blocks.index("M3") < blocks.index("PLANE RESET STAY", blocks.index(block))


SAYING = {
    "spatial": "PLANE SPATIAL SPA+0.0 SPB+30. SPC+0.0",
    "vector": "PLANE VECTOR BX+0.8660254 BY+0 BZ-0.5 NX+0.5 NY+0 NZ+0.8660254",
    "cycle19": "CYCL DEF 19.1 A+0.0 B+30. C+0.0",
}
TILTED = HEAD.replace("0.0,0.0,50.0,0.0,0.0,1.0", "0.0,0.0,50.0,0.5,0.0,0.866025403784") + FOOT
MOVES = {"turn": " TURN FMAX", "move": " MOVE ABST0 FMAX", "stay": " STAY"}


@pytest.mark.parametrize(("way", "block"), SAYING.items())
@pytest.mark.parametrize(("move", "words"), MOVES.items())
@pytest.mark.parametrize("solution", ["SEQ", "SYM"])
def test_a_plane_in_every_spelling(way: str, block: str, move: str, words: str, solution: str, post: Post) -> None:
    given = ("--set", f"plane={way}", "--set", f"plane_move={move}", "--set", f"plane_solution={solution}")
    blocks = post(TILTED, *given, machine="mikron_600u")
    assert block + ("" if way == "cycle19" else f"{words} {solution}+") in blocks


# Whatever is planned


def toolpath_of(moves: Moves, arcs: Arcs | None = None) -> Toolpath:
    """A CL file of one operation, with all that a program needs besides."""
    operation = replace(operation_of(moves), arcs=arcs or Arcs.none())
    events = (LoadTool(0, 1, 1), SpindleOn(0, 2, 1000.0))
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))


def proven(toolpath: Toolpath, machine: Machine, control: Control, folder: Path, **given: str) -> Verification:
    """The proof of the program that a toolpath becomes; fails when the program does not do what was asked for.

    Raises
    ------
    Refused, InputError
        When there is no program, as over-travel and tool axes out of reach leave none.
    """
    wishes = wishes_of(given, control)
    program, _ = planned_program([toolpath], machine, control, given, False, wishes)
    target = folder / "part.h"
    with target.open("wb") as sink:
        claim = write(program, sink, wishes)
    found = verify(run_program(target, machine), [toolpath], allowed=claim.allowed, settings=claim.settings)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    assert not found.run.findings, [finding.text for finding in found.run.findings]
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


PATHS = smooth_paths(25.0) | smooth_paths(100.0) | smooth_paths(3.0) | short_paths(12)


@settings(max_examples=100)
@given(name=st.sampled_from(sorted(MACHINES)), moves=PATHS, way=st.sampled_from(sorted(TCP)))
def test_what_is_planned_is_proven(name: str, moves: Moves, way: str, folder: Path) -> None:
    shift = 20.0 * np.sin(np.arange(len(moves)))[:, None] * [1.0, 0.5, 0.2]
    toolpath = toolpath_of(replace(moves, tip=moves.tip + shift))
    try:
        proven(toolpath, MACHINES[name], CONTROLS["mikron_600u"], folder, tcpm=way)
    except (Refused, InputError):
        assume(False)


#: Of the travel of the rotary axes; right at a limit the last digit of a plane's angles may lie beyond it.
SHARES = st.tuples(st.floats(0.001, 0.999), st.floats(0.001, 0.999))
TIPS = st.tuples(*[st.floats(-80.0, 80.0)] * 3)


@settings(max_examples=80)
@given(
    name=st.sampled_from(sorted(MACHINES)),
    way=st.sampled_from(sorted(SAYING)),
    move=st.sampled_from(sorted(MOVES)),
    shares=st.lists(SHARES, min_size=1, max_size=3),
    tips=st.lists(TIPS, min_size=1, max_size=3),
)
def test_planes_are_proven_on_every_machine_that_reaches_them(
    name: str,
    way: str,
    move: str,
    shares: list[tuple[float, float]],
    tips: list[tuple[float, float, float]],
    folder: Path,
) -> None:
    machine = MACHINES[name]
    file = folder / "planes.cls"
    file.write_text(text_of([reachable(machine, share) for share in shares], tips), encoding="utf-8")
    try:
        proven(read_cl(file), machine, CONTROLS["mikron_600u"], folder, plane=way, plane_move=move)
    except (Refused, InputError):
        assume(False)


@st.composite
def circles(draw: st.DrawFn) -> tuple[Moves, Arcs]:
    """Arcs about the tool axis that follow one another: parts of circles, whole ones, helices, several turns."""
    n = draw(st.integers(1, 5))
    tip, centre, radius, sense, turns = [np.array([30.0, -20.0, 4.0])], [], [], [], []
    for _ in range(n):
        r, at, side = draw(st.floats(0.5, 200.0)), draw(st.floats(-np.pi, np.pi)), draw(st.sampled_from([-1.0, 1.0]))
        sweep = draw(st.one_of(st.floats(0.05, 6.2), st.just(2.0 * np.pi)))
        rise = draw(st.integers(-500, 500)) / 100.0 if draw(st.booleans()) else 0.0
        middle = tip[-1] - r * np.array([np.cos(at), np.sin(at), 0.0])
        angle = at + side * sweep
        end = middle + r * np.array([np.cos(angle), np.sin(angle), 0.0]) + [0.0, 0.0, rise]
        tip.append(tip[-1] + [0.0, 0.0, rise] if sweep == 2.0 * np.pi else end)
        centre.append(middle)
        radius.append(r)
        sense.append([0.0, 0.0, side])
        turns.append(draw(st.integers(0, 3)))
    rows = np.arange(1, n + 1)
    points = np.round([*tip, tip[-1] + [1.0, 0.0, 0.0]], 4)  # as CL files print them
    kind = np.full(n + 2, Kind.ARC, np.uint8)
    kind[[0, -1]] = Kind.LINEAR
    moves = replace(moves_of(points, np.tile([0.0, 0.0, 1.0], (len(points), 1))), kind=kind)
    return moves, Arcs(rows, np.array(centre), np.array(sense), np.array(radius), np.array(turns))


@settings(max_examples=80)
@given(path=circles())
def test_arcs_and_helices_are_proven(path: tuple[Moves, Arcs], folder: Path) -> None:
    machine = OWN["ucp800"]  # whose slides have no limits
    proven(toolpath_of(*path), machine, CONTROLS["ucp800"], folder)


# Holes

CLEAR = HEAD.replace("FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n", "")
HEIGHTS = "RAPTO,3.0,FEDTO,-20.0"

#: What a CYCLE asks for, what the definition is called, and its Q parameters.
CYCLES = [
    (f"DRILL,{HEIGHTS},RTRCTO,5.0,MMPM,250", "200 DRILLING", "200+3 201-20 206+250 202+20 210+0 203+0 204+5 211+0"),
    (f"DRILL,{HEIGHTS},DWELL,REV,20,MMPR,0.1", "200 DRILLING", "200+3 201-20 206+400 202+20 210+0 203+0 204+3 211+0.3"),
    (
        "DRILL,CSINK,RAPTO,3.0,CSKDIA,10.0,TLANGL,90.0,MMPM,250",
        "200 DRILLING",
        "200+3 201-5 206+250 202+5 210+0 203+0 204+3 211+0",
    ),
    (f"REAM,{HEIGHTS},MMPM,100,DWELL,1", "201 REAMING", "200+3 201-20 206+100 211+1 208+100 203+0 204+3"),
    (
        f"DRILL,DEEP,{HEIGHTS},STEP,6.0,1.0,2.0,MMPM,250",
        "205 UNIVERSAL PECKING",
        "200+3 201-20 206+250 202+6 203+0 204+3 212+1 205+2 258+0.2 259+0.2 257+0 256+0 211+0 379+0 253+250",
    ),
    (
        f"DRILL,BRKCHP,{HEIGHTS},STEP,6.0,MMPM,250",
        "205 UNIVERSAL PECKING",
        "200+3 201-20 206+250 202+20 203+0 204+3 212+0 205+0 258+0.2 259+0.2 257+6 256+0.2 211+0 379+0 253+250",
    ),
    (
        f"DRILL,BRKCHP,{HEIGHTS},STEP,6.0,1.0,2.0,MMPM,250",
        "203 UNIVERSAL DRILLING",
        "200+3 201-20 206+250 202+6 210+0 203+0 204+3 212+1 213+99999 205+2 211+0 208MAX 256+0.2",
    ),
    (
        f"BORE,DRAG,{HEIGHTS},MMPM,100,DWELL,0.5",
        "202 BORING",
        "200+3 201-20 206+100 211+0.5 208MAX 203+0 204+3 214+0 336+0",
    ),
    (
        f"BORE,NODRAG,90,{HEIGHTS},MMPM,100",
        "202 BORING",
        "200+3 201-20 206+100 211+0 208MAX 203+0 204+3 214+3 336+90",
    ),
    (
        f"TAP,BRKCHP,{HEIGHTS},STEP,5.0,MMPR,1.25",
        "209 TAPPING W/ CHIP BRKG",
        "200+3 201-20 239+1.25 203+0 204+3 257+5 256+1 336+0 403+1",
    ),
    (
        f"TAP,DEEP,{HEIGHTS},STEP,30.0,MMPR,1.25",
        "209 TAPPING W/ CHIP BRKG",
        "200+3 201-20 239+1.25 203+0 204+3 257+20 256+0 336+0 403+1",
    ),
    (f"TAP,{HEIGHTS},MMPR,1.25", "207 RIGID TAPPING NEW", "200+3 201-20 239+1.25 203+0 204+3"),
    (f"TAP,{HEIGHTS},MMPR,1.25,OPTION", "206 TAPPING NEW", "200+3 201-20 206+5000 211+0 203+0 204+3"),
]


@pytest.mark.parametrize(("words", "name", "values"), CYCLES)
def test_each_cycle_is_defined_once_and_called_at_each_hole(words: str, name: str, values: str, post: Post) -> None:
    text = CLEAR + f"CYCLE/{words}\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n" + FOOT
    blocks = motion(post(text, "--set", "disengage=3"))
    definition = next(block for block in blocks if "Q200" in block)
    lines = definition.split("\n")
    assert all(line.endswith(" ~") for line in lines[:-1])
    assert not lines[-1].endswith("~")
    assert lines[0] == f"CYCL DEF {name} ~"
    found = [re.match(r"  Q(\d+)=([-+][\d.]+|MAX) ;[A-Z0-9 .-]+$", line.removesuffix(" ~")) for line in lines[1:]]
    assert " ".join("".join(q.groups()) for q in found if q) == values
    after = blocks[blocks.index(definition) + 1 :]
    assert after == ["L X+10 Y+0 FMAX M99", "L X+20 Y+0 FMAX M99", "L X+20 Y+0 Z+50 FMAX"]


def test_a_left_hand_tap_has_a_negative_pitch(post: Post) -> None:
    blocks = post(CLEAR.replace("CLW", "CCLW") + f"CYCLE/TAP,{HEIGHTS},MMPR,1.25\nGOTO/10,0,0\n" + FOOT)
    assert any("Q239=-1.25 ;" in block for block in blocks)


UNSAID = {
    "BORE,NODRAG,90,RAPTO,3.0,FEDTO,-20.0,MMPM,100": "--set disengage=1",
    "BORE,MANUAL,RAPTO,3.0,FEDTO,-20.0,MMPM,100": "no cycle of the control",
    "DRILL,BRKCHP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,MMPM,250": "write STEP,first,less,shortest",
    "TAP,BRKCHP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,2.0,MMPR,1.25": "write STEP with one number",
    "TAP,BRKCHP,RAPTO,3.0,FEDTO,-20.0,MMPR,1.25": "write STEP,first stroke",
    "DRILL,DEEP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,MMPM,250": "write STEP,first,less,shortest",
    "TAP,RAPTO,3.0,FEDTO,-20.0,MMPR,1.25,DWELL,1": "leave DWELL out",
}


@pytest.mark.parametrize(("words", "why"), UNSAID.items())
def test_a_cycle_that_klartext_does_not_have_is_refused(words: str, why: str, post: Post) -> None:
    code, out, err = post.all(CLEAR + f"CYCLE/{words}\nGOTO/10,0,0\n" + FOOT)
    assert (code, out) == (2, "")
    assert why in err


MODES = [
    "DRILL", "REAM", "DRILL,DEEP,STEP,4.0", "DRILL,DEEP,STEP,6.0,1.0,2.0", "DRILL,BRKCHP,STEP,4.0",
    "DRILL,BRKCHP,STEP,6.0,1.0,2.0", "BORE,DRAG", "BORE,NODRAG,30", "TAP", "TAP,DEEP,STEP,6.0", "TAP,BRKCHP,STEP,6.0",
]  # fmt: skip
HEIGHT = st.integers(0, 800).map(lambda n: n / 100.0)
HOLE = st.tuples(*[st.integers(-6000, 6000).map(lambda n: n / 100.0)] * 2, st.sampled_from([0.0, 12.5, -4.0]))


@settings(max_examples=60)
@given(
    name=st.sampled_from(sorted(MACHINES)),
    mode=st.sampled_from(MODES),
    above=HEIGHT,
    back=HEIGHT,
    depth=st.integers(50, 3000).map(lambda n: n / 100.0),
    shares=st.lists(SHARES, min_size=1, max_size=3),
    holes=st.lists(HOLE, min_size=1, max_size=4),
)
def test_holes_are_proven_on_every_machine_also_where_the_axis_changes_between_them(
    name: str,
    mode: str,
    above: float,
    back: float,
    depth: float,
    shares: list[tuple[float, float]],
    holes: list[tuple[float, float, float]],
    folder: Path,
) -> None:
    machine, lines = MACHINES[name], []
    feed = "MMPR,1.25" if mode.startswith("TAP") else "MMPM,250"
    for share in shares:
        axis = reachable(machine, share)
        vector = ",".join(f"{v:.9f}" for v in axis)
        side = np.cross(axis, [0.6, 0.8, 0.0] if abs(axis[2]) > 0.5 else [0.0, 0.0, 1.0])
        side /= np.linalg.norm(side)
        points = [u * side + v * np.cross(axis, side) + w * axis for u, v, w in holes]
        lines += [f"GOTO/{','.join(f'{v:.5f}' for v in point)},{vector}" for point in points]
    words = f"CYCLE/{mode},RAPTO,{above},FEDTO,{-depth},RTRCTO,{back},{feed}\n"
    start = CLEAR.split("RAPID")[0]
    file = folder / "holes.cls"
    file.write_text(start + words + "\n".join(lines) + "\nCYCLE/OFF\n" + FOOT, encoding="utf-8")
    try:
        proven(read_cl(file), machine, CONTROLS["mikron_600u"], folder, disengage="2")
    except (Refused, InputError):
        assume(False)


# Retract along the tool axis


@pytest.mark.parametrize("text", [SIMULTANEOUS, TILTED])
def test_the_tool_can_leave_along_its_own_axis(text: str, post: Post) -> None:
    along = post(text, "--set", "retract=m140")
    at = along.index("L M140 MB MAX")
    assert along[at - 1] == "M9"
    assert along[at + 1] in ("M129", "L Z+560 R0 FMAX M91")
    assert [block for block in along if block != "L M140 MB MAX"] == post(text)


#: Machines whose slides are known to end.
ENDED = sorted(name for name, each in MACHINES.items() if np.isfinite(each.limits[list(each.linear)]).all())


@settings(max_examples=25)
@given(name=st.sampled_from(ENDED), shares=st.lists(SHARES, min_size=1, max_size=2), manner=st.booleans())
def test_a_retract_along_the_tool_axis_is_proven(
    name: str, shares: list[tuple[float, float]], manner: bool, folder: Path
) -> None:
    machine, file = MACHINES[name], folder / "retract.cls"
    text = text_of([reachable(machine, share) for share in shares], [(0.0, 0.0, 0.0), (30.0, -5.0, 2.0)])
    file.write_text(text, encoding="utf-8")
    said = {"manner": "tcp"} if manner else {}
    try:
        proven(read_cl(file), machine, CONTROLS["mikron_600u"], folder, retract="m140", **said)
    except (Refused, InputError):
        assume(False)
