"""Fanuc programs: the whole text of a few, and random operations of all machining modes, written and proven."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.fanuc import CONTROL, FANUC, MACHINES, SLOW, body, machine, posted, proven, read
from tests.support.fidia import CYCLES, END, HEIGHTS, START, circles, holes_in
from tests.support.jobs import post_job
from tests.support.naive.chains import turned as about
from tests.support.path_strategies import short_paths, smooth_paths
from tests.support.planes import ANGLES, SHARES, reachable
from tests.support.posting import HEAD, LEANING
from tests.support.read_back import toolpath_of
from trunnion.controls import load_control
from trunnion.controls.words import BlockNumbers
from trunnion.conversion import convert
from trunnion.errors import InputError, RefusedError
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import load_machine
from trunnion.model.toolpath import LoadTool, Moves
from trunnion.output.coordinates.euler_angles import euler_zxz_angles
from trunnion.output.families.fanuc.writer import comment, escape_comment, validate_settings
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import failures, verify


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fanuc")


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=examples(5), suppress_health_check=SLOW, phases=[Phase.generate])
@given(moves=smooth_paths(60.0) | short_paths(12))
def test_simultaneous_motion_is_proven(name: str, moves: Moves, folder: Path) -> None:
    try:
        text = proven(toolpath_of(moves), folder, machine(name))
    except (RefusedError, InputError):
        assume(False)
        return
    assert "G43.5" not in text


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=examples(4), suppress_health_check=SLOW, phases=[Phase.generate])
@given(moves=smooth_paths(40.0) | short_paths(6))
def test_motion_without_tcp_is_proven(name: str, moves: Moves, folder: Path) -> None:
    model = machine(name)
    model = replace(model, workpiece_zero=(37.0, -21.0, 110.0), tool_length=83.7 if model.has_rotary_head else None)
    try:
        text = proven(toolpath_of(moves), folder, model, tcp="off", mode="auto")
    except (RefusedError, InputError):
        assume(False)
        return
    assert "G43.4" not in text


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=examples(4), suppress_health_check=SLOW, phases=[Phase.generate])
@given(data=st.data(), shares=st.lists(SHARES, min_size=1, max_size=2))
def test_milling_in_planes_with_circles_is_proven(
    name: str, data: st.DataObject, shares: list[tuple[float, float]], folder: Path
) -> None:
    model = machine(name)
    parts = [data.draw(circles(reachable(model, share))) for share in shares]
    text = "".join(START.replace("OP1", f"OP{k}") + part + END for k, part in enumerate(parts))
    proven(read(text, folder), folder, model)


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=examples(4), suppress_health_check=SLOW, phases=[Phase.generate])
@given(data=st.data(), shares=st.lists(SHARES, min_size=1, max_size=3))
def test_holes_of_all_cycles_are_proven(
    name: str, data: st.DataObject, shares: list[tuple[float, float]], folder: Path
) -> None:
    model = machine(name)
    axes = [reachable(model, share) for share in shares]
    text = START + data.draw(holes_in([np.array([0.0, 0.0, 1.0]), *axes])) + END
    proven(read(text, folder), folder, model)


UPRIGHT = START + "RAPID\nGOTO/10,5,50,0,0,1\n"


def test_a_whole_program_with_tcp(folder: Path) -> None:
    text = proven(read(LEANING + END, folder), folder, load_machine("matsuura_mx330"), title="Läufer (Größe 5): 50%")
    assert (
        text
        == """\
%
O0001 (LAEUFER [GROESSE 5]- 50-)
(MACHINE MATSUURA MX-330)
N10 G21 G17 G40 G80 G90 G94
(OPERATION OP1)
(T1 D10, MILLING TOOL, DIAMETER 10, CORNER 0)
N20 G49 G53 G0 Z0.
N30 G69
N40 G53 G0 X0. Y0. A0. C0.
N50 T1 M6
N60 G54
N70 G0 A-30. C0.
N80 G05.1 Q1
N90 S4000 M3
N100 G0 G43.4 H1 X0. Y0. Z50.
(CUT)
N110 G1 X10. Z5. A-36.87 F500.
N120 G49 G53 G0 Z0.
N130 G53 G0 X0. Y0. A0. C0.
N140 G05.1 Q0
N150 M5
N160 M9
N170 M30
%
"""
    )


def test_three_axes_with_circles_compensation_and_stops(folder: Path) -> None:
    statements = """COOLNT/ON
CUTCOM/LEFT
GOTO/20,0,5
CIRCLE/20.0,10.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0
GOTO/30,10,5
CIRCLE/20.0,10.0,5.0,0.0,0.0,-1.0,10.0,0.06,0.5,10.0,0.0
GOTO/30,10,5
CUTCOM/OFF
DELAY/1.5
OPSTOP/Späne
FEDRAT/MMPR,0.125
GOTO/30,10,9
RAPID
GOTO/30,10,50
"""
    text = proven(read(HEAD + statements + END, folder), folder, load_machine("matsuura_mx330"), contour="G05")
    assert "(SPAENE)" in text.splitlines()
    assert body(text) == [
        "G54",
        "G0 A0. C0.",
        "G05 P10000",
        "S4000 M3",
        "G0 X0. Y0.",
        "G43 H1 Z50.",
        "G1 X10. Z5. F500.",
        "M8",
        "G41 D1",
        "X20.",
        "G3 X30. Y10. I0. J10.",
        "G2 X30. Y10. I-10. J0.",
        "G40 G1",  # the control stops with an alarm where G2 or G3 is in force
        "G4 P1500",
        "M1",
        "M3",
        "M8",
        "G95 Z9. F0.125",
        "G0 Z50.",
        "G94",
        "G49 G53 G0 Z0.",
        "G53 G0 X0. Y0. A0. C0.",
        "G05 P0",
        "M5",
    ]


def test_holes_in_two_planes_with_the_plane_off_before_the_axes_turn(folder: Path) -> None:
    holes = (
        "RAPID\nGOTO/10,36,53,0.0,0.6,0.8\nCYCLE/DRILL,RAPTO,3,FEDTO,-20,RTRCTO,5,MMPM,250\nGOTO/10,0,0\nGOTO/20,0,0\n"
    )
    more = "GOTO/0,0,0,0.6,0.0,0.8\nCYCLE/OFF\n"
    text = proven(read(START + holes + more + END, folder), folder, load_machine("matsuura_mx330"), contour="none")
    assert body(text) == [
        "G54",
        "G0 A-36.87 C0.",
        "G68.2 X0. Y0. Z0. I180. J36.87 K180.",
        "G53.1",
        "S4000 M3",
        "G0 X10. Y-3.",
        "G43 H1 Z64.",
        "Y0.",
        "Z5.",
        "G98 G81 X10. Y0. Z-20. R3. F250.",
        "X20. Y0.",
        "G80",
        "G49 G53 G0 Z0.",
        "G69",
        "G0 A-36.87 C270.",
        "G68.2 X0. Y0. Z0. I90. J36.87 K-90.",
        "G53.1",
        "S4000 M3",
        "G0 X0. Y0.",
        "G43 H1 Z5.",
        "G98 G81 X0. Y0. Z-20. R3. F250.",
        "G80",
        "G49 G53 G0 Z0.",
        "G69",
        "G53 G0 X0. Y0. A0. C0.",
        "M5",
    ]


def test_without_options_the_slides_are_led_with_inverse_time(folder: Path) -> None:
    model = replace(load_machine("matsuura_mx330"), workpiece_zero=(0.0, 0.0, 40.0), tool_length=100.0)
    text = proven(
        read(LEANING + END, folder), folder, model, tcp="off", contour="none", tip_tolerance="10", axis_tolerance="5"
    )
    assert body(text) == [
        "G54",
        "G0 A-30. C0.",
        "S4000 M3",
        "G0 G43 H1 X0. Y-45. Z37.942",
        "G93 G1 X10. Y-27. Z-4. A-36.87 F10.847",
        "G94",
        "G49 G53 G0 Z0.",
        "G53 G0 X0. Y0. A0. C0.",
        "M5",
    ]


ALL_CYCLES = {
    **{mode: (code, "", words) for mode, (code, words) in CYCLES.items() if mode != "BORE,DWELL"},
    "DRILL,BRKCHP": ("G73", " Q2.5", HEIGHTS + "STEP,2.5,RTRCTO,9,MMPM,90"),
    "DRILL,DEEP": ("G83", " Q2.5", HEIGHTS + "STEP,2.5,RTRCTO,9,MMPM,90"),
    "DRILL,DWELL": ("G82", " P500", HEIGHTS + "MMPM,90,DWELL,0.5"),
    "BORE,DWELL": ("G89", " P300", HEIGHTS + "MMPM,90,DWELL,REV,20"),
    "TAP,DWELL": ("G84", " P250", HEIGHTS + "MMPR,1.25,DWELL,0.25"),
    "TAP,OPTION": ("G84", "", HEIGHTS + "MMPR,1.25,OPTION"),
    "BORE,NODRAG": ("G76", " Q0.5", HEIGHTS + "MMPM,90"),
    "BORE,MANUAL": ("G88", "", HEIGHTS + "MMPM,90"),
}


@pytest.mark.third
@pytest.mark.parametrize("mode", ALL_CYCLES)
@pytest.mark.parametrize("sense", ["CLW", "CCLW"])
def test_each_cycle_has_its_words(mode: str, sense: str, folder: Path) -> None:
    code, more, words = ALL_CYCLES[mode]
    major = mode.removesuffix(",DWELL").removesuffix(",OPTION")
    text = UPRIGHT.replace("CLW", sense) + f"CYCLE/{major},{words}\nGOTO/10,5,2\nGOTO/20,5,2\nCYCLE/OFF\n" + END
    lines = body(proven(read(text, folder), folder, load_machine("matsuura_mx330"), bore_lift="0.5"))
    at = next(k for k, line in enumerate(lines) if re.match(r"G9[89] ", line))
    tap = "TAP" in mode
    back = "G98" if "RTRCTO" in words else "G99"
    feed = "5000." if tap else "90."
    left = "G74" if tap and sense == "CCLW" else code
    assert lines[at] == f"{back} {left} X10. Y5. Z-10. R5.{more} F{feed}"
    assert lines[at + 1 : at + 3] == ["X20. Y5.", "G80"]
    assert (lines[at - 1] == "M29 S4000") == (tap and "OPTION" not in mode)


def test_a_control_that_taps_rigidly_by_itself_needs_no_m29(folder: Path) -> None:
    control = load_control(FANUC)
    bare = replace(control, settings={**control.settings, "rigid_tap": ""})
    path = read(UPRIGHT + f"CYCLE/TAP,{HEIGHTS}MMPR,1\nGOTO/10,5,2\nCYCLE/OFF\n" + END, folder)
    program = plan_program([path], post_job(load_machine("matsuura_mx330"), bare, parse_plan_options({}, bare), {}))[0]
    target = folder / "tap.nc"
    with target.open("wb") as sink:
        write_program(program, sink)
    assert "M29" not in target.read_text(encoding="ascii")


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (f"CYCLE/BORE,NODRAG,{HEIGHTS}MMPM,90\nGOTO/10,5,2\n", "how far the tool lifts off"),
        (f"CYCLE/BORE,NODRAG,90,{HEIGHTS}MMPM,90\nGOTO/10,5,2\n", "a parameter of the control"),
        (f"SPINDL/OFF\nCYCLE/TAP,{HEIGHTS}MMPR,1\nGOTO/10,5,2\n", "spindle stands still"),
        ("FEDRAT/MMPM,100\nCUTCOM/LEFT\nGOTO/10,5,2\nGOTO/10,5,3,0,0.6,0.8\n", "while the tool axis changes"),
    ],
)
def test_what_cannot_be_said_is_refused(text: str, what: str, folder: Path) -> None:
    with pytest.raises((RefusedError, InputError), match=what):
        posted(read(UPRIGHT + text + END, folder), folder, load_machine("matsuura_mx330"))


def test_a_helix_has_a_block_for_each_turn(folder: Path) -> None:
    helix = "CIRCLE/20.0,10.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0{}\nGOTO/30,10,2\n"
    start = HEAD + "GOTO/20,0,5\n"
    for turns, wanted in (("", 1), (",TIMES,2", 2), (",TIMES,5", 5)):
        text = proven(read(start + helix.format(turns) + END, folder), folder, load_machine("matsuura_mx330"))
        blocks = body(text)
        first = next(k for k, line in enumerate(blocks) if line.startswith("G3 "))
        assert sum(" I" in line or line.startswith("I") for line in blocks[first:]) == wanted
        assert len(blocks) < 30


@pytest.mark.parametrize(
    ("said", "code", "name"), [("G55", 55, "G55"), ("G54.1 P3", 603, "G54.1 P3"), ("G54.1P12", 612, "G54.1 P12")]
)
def test_the_work_offset_that_is_asked_for_is_the_one_that_is_proven(
    said: str, code: int, name: str, folder: Path
) -> None:
    """Also the many of G54.1; in force from the first motion on, in every operation, and no other one beside it."""
    model, path = load_machine("matsuura_mx330"), read(LEANING + END, folder)
    found, text = posted(path, folder, model, work_offset=said)
    assert f" {said}\n" in text
    assert set(found.run.work_offset[~found.run.machine_frame].tolist()) <= {0, code}
    check = next(check for check in found.checks if check.key == "offset")
    assert (check.passed, check.summary) == (True, f"{name} throughout")
    program = plan_program([path], post_job(model, CONTROL, parse_plan_options({}, CONTROL), {"work_offset": said}))[0]
    expected = expectation(program).settings
    for other in ("G54", "G54.1 P4"):
        target = folder / "other.nc"
        target.write_text(text.replace(f" {said}\n", f" {other}\n"), encoding="ascii")
        broken = [check.key for check in failures(verify(run_program(target, model), [path], settings=expected))]
        assert "offset" in broken
    again = convert(found.run, CONTROL)
    assert again.settings.get("work_offset") == name


@settings(max_examples=examples(30))
@given(st.text())
def test_comments_are_what_the_control_has_characters_for(text: str) -> None:
    for line in comment(text):
        assert re.fullmatch(r"\([A-Z0-9 .,=+\-*/_#\[\]'!?&<>@]{0,76}\)", line), line
    assert escape_comment(escape_comment(text)) == escape_comment(text)


@given(ANGLES, ANGLES, ANGLES)
def test_euler_angles_make_the_plane_again(first: float, second: float, third: float) -> None:
    matrix = about(2, first) @ about(0, second) @ about(2, third)
    one, two, three = euler_zxz_angles(matrix)
    again = about(2, one) @ about(0, two) @ about(2, three)
    np.testing.assert_allclose(again, matrix, atol=3e-8)  # beside the pole, where two turns become one


@pytest.mark.third
@pytest.mark.parametrize(
    ("name", "value", "good"),
    [
        ("program", "1234", True),
        ("program", "00000012", True),
        ("program", "123456789", False),
        ("program", "0", False),
        ("program", "A", False),
        ("program", "\u0661", False),
        ("bore_lift", "-0.5", False),
        ("bore_lift", "nan", False),
        ("bore_lift", "0.5", True),
    ],
)
def test_settings_that_are_no_numbers_are_named(name: str, value: str, good: bool) -> None:
    assert (validate_settings({name: value}) == []) == good


def test_the_length_is_that_of_the_register_that_the_cl_file_names(folder: Path) -> None:
    """Also in an operation that goes on with the tool; a tool that the run calls instead has its own."""
    model = load_machine("matsuura_mx330")
    first = LEANING.replace("ADJUST,1\n", "ADJUST,17\n")
    second = LEANING.replace("OP1", "OP2").replace("LOAD/TOOL,1,ADJUST,1\n", "")
    text = proven(read(first + END + second + END, folder), folder, model)
    assert re.findall(r"G43.4 H(\d+)", text) == ["17", "17"]
    back = convert(run_program(folder / "part.nc", model), CONTROL).toolpath
    assert {event.adjust for each in back.operations for event in each.events if isinstance(event, LoadTool)} == {17}
    assert re.findall(r"G43.4 H(\d+)", proven(read(first + END, folder), folder, model, tool="5")) == ["5"]


def test_block_numbers_are_every_n_th_or_none(folder: Path) -> None:
    model, path = load_machine("matsuura_mx330"), read(LEANING + END, folder)
    for numbers in (BlockNumbers("N", 5, 5, 9995, True, "%O("), BlockNumbers("N", 10, 10, 99990, False, "%O(")):
        control = replace(CONTROL, block_numbers=numbers)
        program = plan_program([path], post_job(model, control, parse_plan_options({}, control), {}))[0]
        target = folder / "numbers.nc"
        with target.open("wb") as sink:
            write_program(program, sink)
            expected = expectation(program)
        found = verify(run_program(target, model), [path], tolerances=expected.tolerances, settings=expected.settings)
        assert not failures(found)
        words = re.findall(r"(?m)^N(\d+) ", target.read_text(encoding="ascii"))
        assert [int(word) for word in words] == [5 * (k + 1) for k in range(17)] * numbers.numbered


def test_block_numbers_begin_anew_and_nothing_else_has_any(folder: Path) -> None:
    moves = "".join(f"GOTO/{k % 90},{k % 7},5\n" for k in range(10100))
    text = proven(read(HEAD + moves + END, folder), folder, load_machine("matsuura_mx330"))
    numbers = [int(line[1:].split(" ")[0]) for line in text.splitlines() if line.startswith("N")]
    assert (max(numbers), min(numbers)) == (99990, 10)
    assert numbers.count(10) == 2


def test_a_program_number_has_four_digits_unless_a_definition_says_more(tmp_path: Path) -> None:
    part, own = tmp_path / "part.cls", tmp_path / "own.toml"
    part.write_text(HEAD + END, encoding="utf-8")
    with pytest.raises(InputError, match="at most 9999"):
        trunnion.post(part, machine="matsuura_mx330", settings={"program": "12345"})
    rule = 'program = { kind = "whole", at_least = 1, at_most = 99999999 }'
    own.write_text(f'schema = 1\nextends = "matsuura_mx330"\nname = "Own"\n[control.setting_rules]\n{rule}\n')
    text = trunnion.post(part, machine=own, settings={"program": "12345"}).text
    assert text is not None
    assert "O12345" in text


@pytest.mark.parametrize(("on", "off"), [(True, False), (False, True)])
def test_radius_compensation_that_begins_or_ends_on_a_circle_is_refused(on: bool, off: bool, tmp_path: Path) -> None:
    circle = "CIRCLE/20,10,5,0,0,1,10\nGOTO/30,10,5\n"
    way = [
        "CUTCOM/LEFT\n",
        "" if on else "GOTO/20,0,5\n",
        circle,
        "CUTCOM/OFF\n",
        circle if off else "",
        "GOTO/40,40,5\n",
    ]
    part = tmp_path / "part.cls"
    start = "" if not on else "GOTO/20,0,5\n"
    part.write_text(HEAD + start + "".join(way) + END, encoding="utf-8")
    with pytest.raises(InputError, match="before a circle"):
        trunnion.post(part, machine="matsuura_mx330")
