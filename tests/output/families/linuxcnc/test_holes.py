"""Drilling cycles for LinuxCNC: as written, as proven, and as LinuxCNC itself runs them."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.holes import HEIGHTS
from tests.support.jobs import post_job
from tests.support.linuxcnc.interpreter import canonical, needs_linuxcnc
from tests.support.linuxcnc.judge import agree
from tests.support.linuxcnc.posting import FOOT, Post
from tests.support.linuxcnc.posting import post as post
from tests.support.posting import CLEAR
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.errors import InputError, RefusedError
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import load_machine
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import failures, verify

MACHINE = load_machine("xyzac_trt")
CONTROL = load_control(MACHINE.control)

#: So slow that Z follows the spindle within its rapid speed.
SLOW = CLEAR.replace("4000.0", "800.0")


def holes(lines: list[str]) -> list[str]:
    """The blocks between the approach and the end of the path."""
    part = lines[lines.index("G43 H1") + 2 : len(lines) - 1 - lines[::-1].index("G49")]
    return [line for line in part if not line.startswith("; ")]


@pytest.mark.parametrize(
    ("words", "call"),
    [
        ("DRILL,{h}MMPM,250", "G99 G81 X10. Y0. Z-20. R3. F250."),
        ("DRILL,{h}DWELL,0.5,MMPM,250", "G99 G82 X10. Y0. Z-20. R3. P0.5 F250."),
        ("DRILL,{h}DWELL,REV,20,MMPM,250", "G99 G82 X10. Y0. Z-20. R3. P1.5 F250."),
        ("DRILL,CSINK,RAPTO,3.0,CSKDIA,10.0,TLANGL,90.0,MMPM,250", "G99 G81 X10. Y0. Z-5. R3. F250."),
        ("DRILL,DEEP,{h}STEP,6.0,MMPM,250", "G99 G83 X10. Y0. Z-20. R3. Q6. F250."),
        ("DRILL,BRKCHP,{h}STEP,6.0,MMPM,250", "G99 G73 X10. Y0. Z-20. R3. Q6. F250."),
        ("TAP,{h}MMPR,1.25,OPTION", "G99 G84 X10. Y0. Z-20. R3. P0 F1000."),
        ("BORE,{h}MMPM,100", "G99 G85 X10. Y0. Z-20. R3. F100."),
        ("REAM,{h}MMPM,100,DWELL,1", "G99 G89 X10. Y0. Z-20. R3. P1. F100."),
        ("BORE,DRAG,{h}MMPM,100", "G99 G86 X10. Y0. Z-20. R3. P0 F100."),
        ("BORE,DRAG,{h}MMPM,100,DWELL,1", "G99 G86 X10. Y0. Z-20. R3. P1. F100."),
    ],
)
def test_each_cycle_is_said_with_its_first_hole(words: str, call: str, post: Post) -> None:
    text = SLOW + f"CYCLE/{words.format(h=HEIGHTS)}\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n" + FOOT
    assert holes(post(text)) == [call, "X20. Y0.", "G80", "G0 X20. Y0. Z50."]


def test_a_rigid_tap_follows_the_spindle_hole_by_hole(post: Post) -> None:
    words = f"CYCLE/TAP,{HEIGHTS}RTRCTO,10.0,MMPR,1.25\nGOTO/10,0,0\nGOTO/20,0,0\n"
    tap = ["Z3.", "G33.1 Z-20. K1.25", "G0 Z10."]
    assert holes(post(SLOW + words + FOOT)) == ["G0 X10. Y0.", *tap, "G0 X20. Y0.", *tap, "G80"]


def test_the_hand_of_a_thread_is_that_of_the_spindle(post: Post) -> None:
    words = f"CYCLE/TAP,{HEIGHTS}MMPR,1.25,OPTION\nGOTO/10,0,0\n"
    assert holes(post(SLOW.replace("CLW", "CCLW") + words + FOOT))[0].startswith("G99 G74 ")


def test_the_tool_stands_at_the_retract_height_where_a_cycle_draws_back_to_it(post: Post) -> None:
    """From above it comes across the hole first, then down; from below it goes up where it is."""
    back = f"CYCLE/DRILL,{HEIGHTS}RTRCTO,8.0,MMPM,250\n"
    text = CLEAR + back + "GOTO/10,0,0\nCYCLE/OFF\nRAPID\nGOTO/10,0,2\n" + back + "GOTO/20,0,0\nGOTO/20,9,0\n" + FOOT
    assert holes(post(text)) == [
        "X10.", "Z8.", "G98 G81 X10. Y0. Z-20. R3. F250.", "G80",
        "G0 X10. Y0. Z2.",
        "Z8.", "G98 G81 X20. Y0. Z-20. R3.", "X20. Y9.", "G80",
    ]  # fmt: skip


def test_the_feed_of_a_cycle_is_its_own_and_the_modal_one_comes_back(post: Post) -> None:
    head = CLEAR + "FEDRAT/MMPM,500\nGOTO/0,0,40\n"
    text = head + f"CYCLE/DRILL,{HEIGHTS}MMPR,0.2\nRAPID\nGOTO/10,0,50\nGOTO/10,0,0\nCYCLE/OFF\nRAPID\nGOTO/10,0,50\n"
    lines = holes(post(text + "GOTO/10,0,20\n" + FOOT))
    assert lines[lines.index("G95") + 1] == "G99 G81 X10. Y0. Z-20. R3. F0.2"
    assert "G94 G1 Z20. F500." in lines


REFUSED = {
    "TAP,{h}MMPR,1.25,DWELL,1": "leave DWELL out",
    "BORE,NODRAG,90,{h}MMPM,100": "output the holes as motion",
    "BORE,MANUAL,{h}MMPM,100": "output the holes as motion",
}


@pytest.mark.parametrize(("words", "why"), REFUSED.items())
def test_what_a_cycle_cannot_say_is_refused_with_a_cure(words: str, why: str, post: Post) -> None:
    code, out, err = post.all(CLEAR + f"CYCLE/{words.format(h=HEIGHTS)}\nGOTO/10,0,0\n" + FOOT)
    assert (code, out) == (2, [])
    assert "part.cls:10: error: " in err
    assert why in err


@pytest.mark.parametrize("words", ["TAP,{h}MMPR,1.25", "TAP,{h}MMPR,1.25,OPTION", "BORE,DRAG,{h}MMPM,100"])
def test_what_turns_with_the_spindle_wants_it_to_turn(words: str, post: Post) -> None:
    text = CLEAR.replace("RAPID\n", "SPINDL/OFF\nRAPID\n", 1)
    code, _, err = post.all(text + f"CYCLE/{words.format(h=HEIGHTS)}\nGOTO/10,0,0\n" + FOOT)
    assert code == 2
    assert "while the spindle stands still" in err


HEIGHT = st.integers(0, 800).map(lambda n: n / 100.0)
PLACE = st.tuples(*[st.integers(-6000, 6000).map(lambda n: n / 100.0)] * 2, st.sampled_from([0.0, 12.5, -4.0]))
MODES = st.sampled_from(
    [
        "DRILL,{h}MMPM,250",
        "DRILL,{h}DWELL,{d},MMPM,250",
        "DRILL,{h}MMPR,0.125",
        "DRILL,DEEP,{h}STEP,{s},MMPM,250",
        "DRILL,BRKCHP,{h}STEP,{s},MMPM,250",
        "DRILL,DEEP,{h}STEP,{s},0.5,1.0,MMPM,250",
        "DRILL,BRKCHP,{h}STEP,{s},DWELL,{d},MMPM,250",
        "TAP,{h}MMPR,1.25",
        "TAP,{h}MMPM,1100",
        "TAP,{h}MMPR,0.7,OPTION",
        "REAM,{h}MMPM,100",
        "REAM,{h}DWELL,REV,9,MMPM,100",
        "BORE,DRAG,{h}MMPM,100",
    ]
)


@st.composite
def drilled(draw: st.DrawFn) -> str:
    """A few cycles of any heights, one behind the other or with a way between."""
    text = CLEAR.replace("CLW", draw(st.sampled_from(["CLW", "CCLW"]))).replace("4000.0", "333.0")
    for _ in range(draw(st.integers(1, 4))):
        above, depth = draw(HEIGHT), draw(st.integers(50, 3000)) / 100.0
        back = draw(st.sampled_from(["", "RTRCTO,AUTO,", f"RTRCTO,{above + draw(HEIGHT):.2f},"]))
        heights = f"RAPTO,{above},FEDTO,{-depth},{back}"
        numbers = {"d": draw(st.integers(1, 500)) / 100.0, "s": draw(st.integers(100, 900)) / 100.0}
        text += f"CYCLE/{draw(MODES).format(h=heights, **numbers)}\n"
        text += "".join(f"GOTO/{x},{y},{z}\n" for x, y, z in draw(st.lists(PLACE, min_size=1, max_size=4)))
        if draw(st.booleans()):
            text += f"CYCLE/OFF\nRAPID\nGOTO/{draw(HEIGHT)},{draw(HEIGHT)},{draw(st.sampled_from([30.0, 80.0]))}\n"
    return text + FOOT


@needs_linuxcnc
@settings(max_examples=examples(30))
@given(text=drilled())
def test_holes_of_all_cycles_are_proven_and_linuxcnc_makes_them_as_our_reader_does(
    text: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.getbasetemp()
    cl, target = folder / "holes.cls", folder / "holes.ngc"
    cl.write_text(text, encoding="utf-8")
    path = read_cl(cl)
    try:
        program = plan_program([path], post_job(MACHINE, CONTROL, parse_plan_options({}, CONTROL), {}))[0]
    except (InputError, RefusedError):
        return  # a retract height by AUTO below the hole, or a cut that ends too low
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    found = verify(run_program(target, MACHINE), [path], tolerances=expected.tolerances, settings=expected.settings)
    assert not failures(found), [(check.key, check.summary, check.places[:2]) for check in failures(found)]
    # The judge's own tools have no length, and its stand-alone interpreter knows no remapped words.
    target.write_text(target.read_text(encoding="utf-8").replace("M429", ""), encoding="utf-8")
    agree(run_program(target, replace(MACHINE, workpiece_zero=(0.0, 0.0, 0.0))), canonical(target))
