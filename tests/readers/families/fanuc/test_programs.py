"""Fanuc programs: numbers without a point, frames and planes, cycles, macros."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.reading import Runner, close, slides
from tests.support.run_comparison import same
from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program
from trunnion.readers.families.fanuc.interpreter import FanucInterpreter

CONTROL = {"family": "fanuc_30i"}
MACHINE = load_machine("yl569", {"control": CONTROL})
CALCULATOR = load_machine("yl569", {"control": {**CONTROL, "reading": {"whole_numbers": "calculator"}}})
ENDLESS_A = load_machine("dmu65", {"control": CONTROL})

FRESH = [HealthCheck.function_scoped_fixture]


def fanuc(run: Runner, text: str, **more: object) -> Run:
    """Run a text on the machine."""
    return run(text, MACHINE, **more)


def about(axis: int, angle: float) -> Floats:
    """Textbook rotation about X, Y or Z."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return np.array(
        [[[1, 0, 0], [0, c, -s], [0, s, c]], [[c, 0, s], [0, 1, 0], [-s, 0, c]], [[c, -s, 0], [s, c, 0], [0, 0, 1]]][
            axis
        ]
    )


# Numbers


@settings(max_examples=examples(30), suppress_health_check=FRESH)
@given(n=st.integers(-200000, 200000), inches=st.booleans())
def test_whole_numbers_count_least_increments(n: int, inches: bool, run: Runner) -> None:
    got = fanuc(run, f"{'G20' if inches else 'G21'} G90 G0 X{n} B{n % 90000}\nX{n}.\n")
    unit = 25.4 if inches else 1.0
    close(slides(got)[0, 0], n * (0.0001 if inches else 0.001) * unit, atol=1e-9)
    if abs(n) < 1000:
        close(slides(got)[1, 0], n * unit)
    close(got.joints[0, MACHINE.column("B")], (n % 90000) / 1000.0)


def test_a_calculator_takes_whole_numbers_as_they_stand(run: Runner) -> None:
    got = run("G90 G1 X10 Y-3 B20 F500\nX2\n", CALCULATOR)
    close(slides(got), [[10.0, -3.0, 0.0], [2.0, -3.0, 0.0]])
    assert got.diagnostics == ()


def test_feeds_dwells_and_speeds_without_a_point(run: Runner) -> None:
    got = fanuc(
        run, "G94 G1 X1. F1200\nG95 X2. F20\nG20 G94 X3. F1000\nG93 X4. F12\nG21 G4 X2500\nG4 X1.5\nG4 P700\nS1200 M3\n"
    )
    close(got.feed, [1200.0, 0.2, 254.0, 12.0])
    assert [event.value for event in got.events if event.kind == "dwell"] == [2.5, 1.5, 0.7]
    assert [each.code for each in got.diagnostics] == ["NC224"]


# Motion


def test_circles_helices_and_planes(run: Runner) -> None:
    got = fanuc(run, "G17 G2 X10. Y-10. I0 J-10. F100.\nG3 X20. Y0. R10.\nG18 G3 X30. Z10. I0. K10.\nG2 I5.\n")
    assert [Kind(kind) for kind in got.kind] == [Kind.ARC] * 4
    close(got.arcs.radius, [10.0, 10.0, 10.0, 5.0])
    close(got.arcs.centre[:2], [[0.0, -10.0, 0.0], [10.0, 0.0, 0.0]], atol=1e-9)
    assert got.diagnostics == ()


@settings(max_examples=examples(30), suppress_health_check=FRESH)
@given(b=st.floats(5.0, 80.0), c=st.floats(-170.0, 170.0))
def test_vectors_and_rotary_words_stand_the_tool_alike(b: float, c: float, run: Runner) -> None:
    b, c = round(b, 3), round(c, 3)
    by_words = fanuc(run, f"G43.4 H1\nG1 X10. Y5. Z3. B{b:.3f} C{c:.3f} F100.\nG49\n")
    i, j, k = by_words.axis[0]
    by_vector = fanuc(run, f"G43.5 H1\nG1 X10. Y5. Z3. I{i:.12f} J{j:.12f} K{k:.12f} F100.\nX11.\nG49\nX1.\n")
    close(by_vector.axis[0], by_words.axis[0], atol=1e-9)
    close(by_vector.tip[0], [10.0, 5.0, 3.0], atol=1e-9)
    close(by_vector.axis[1], by_words.axis[0], atol=1e-9)
    close(by_words.tip[0], [10.0, 5.0, 3.0], atol=1e-9)
    assert by_vector.tcp.tolist() == [True, True, False]
    assert by_words.diagnostics == by_vector.diagnostics == ()


@settings(max_examples=examples(30), suppress_health_check=FRESH)
@given(
    euler=st.tuples(st.floats(-180, 180), st.floats(1.0, 90), st.floats(-180, 180)),
    origin=st.tuples(*[st.floats(-50, 50)] * 3),
    point=st.tuples(*[st.floats(-50, 50)] * 3),
)
def test_a_tilted_plane_stands_where_its_euler_angles_turn_it(
    euler: tuple[float, ...], origin: tuple[float, ...], point: tuple[float, ...], run: Runner
) -> None:
    euler, origin, point = (tuple(round(value, 3) for value in values) for values in (euler, origin, point))
    words = " ".join(f"{letter}{value:.3f}" for letter, value in zip("XYZIJK", (*origin, *euler), strict=True))
    to = " ".join(f"{letter}{value:.3f}" for letter, value in zip("XYZ", point, strict=True))
    got = fanuc(run, f"G54 G68.2 {words}\nG53.1\nG0 {to}\nG69\nG0 X1. Y2. Z3.\n")
    assert got.errors == ()
    matrix = about(2, euler[0]) @ about(0, euler[1]) @ about(2, euler[2])
    close(got.tip[1], matrix @ np.array(point) + np.array(origin), atol=1e-8)
    close(got.axis[0], matrix[:, 2], atol=1e-8)
    close(got.axis[1], matrix[:, 2], atol=1e-8)
    close(slides(got)[-1], [1.0, 2.0, 3.0], atol=1e-8)


def test_planes_that_nothing_can_stand_on_and_other_forms_are_named(run: Runner) -> None:
    got = fanuc(run, "G68.2 X0 Y0 Z0 I0 J170. K0\nG53.1\nG69\nG68.2 P2 Q1 X0 Y0 Z0 I0 J0 K0\nG53.1\n")
    assert [finding.line for finding in got.errors] == [2, 4, 5]
    assert not fanuc(run, "G68.2 X0 Y0 Z0 I0 J20. K0 R0.\nG53.1\nG69\n").errors
    got = fanuc(run, "G68.2 X0 Y0 Z0 I0 J20. K0 R5.\nG69\n")
    assert [(finding.line, "P, Q or R" in finding.text) for finding in got.errors] == [(1, True)]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("G68.2 X0 Y0 Z0 I0 J20. K0\nG53.1\nG43 H1 Z50.\nG49 G53 G0 Z0\nG69", []),
        ("G43 H1 Z50.\nG69\nG68 X0 Y0 R30.\nG69\nG49 G53 G0 Z0", []),
        ("G68.2 X0 Y0 Z0 I0 J20. K0\nG53.1\nG43 H1 Z50.\nG53 G0 Z0\nG69\nG49", ["G69"]),
        ("G43 H1 Z50.\nG68.2 X0 Y0 Z0 I0 J20. K0\nG53.1\nG49 G53 G0 Z0\nG69", ["G68.2"]),
        ("G43.4 H1 Z50.\nG68 X0 Y0 Z0 I1. J0 K0 R30.\nG69\nG49 G53 G0 Z0", ["G68", "G69"]),
    ],
)
def test_the_tool_length_is_switched_inside_a_plane(lines: str, words: list[str], run: Runner) -> None:
    errors = fanuc(run, f"G90 G54 G0 X0 Y0 Z60.\n{lines}\n").errors
    assert [error.text.split()[0] for error in errors] == words, errors


def test_the_axes_turn_to_a_plane_inside_their_travel_by_whole_turns(run: Runner) -> None:
    nutated = load_machine("generic_nutated_b45_c", {"control": CONTROL})  # B goes from 0 to 200 degrees
    got = run("G54 G0 B195.792 C44.844\nG68.2 X0 Y0 Z0 I55.941 J88.919 K-1.599\nG53.1\nG69\n", nutated)
    assert got.errors == ()
    close(got.rotary, [[44.844, 195.792]] * 2, atol=0.005)


@settings(max_examples=examples(20), suppress_health_check=FRESH)
@given(angle=st.floats(-360, 360), x=st.floats(-50, 50), y=st.floats(-50, 50))
def test_g68_turns_about_its_point(angle: float, x: float, y: float, run: Runner) -> None:
    angle, x, y = round(angle, 3), round(x, 3), round(y, 3)
    got = fanuc(run, f"G17 G68 X{x:.3f} Y{y:.3f} R{angle:.3f}\nG0 X10. Y4. Z1.\nG69\nX10. Y4.\n")
    centre = np.array([x, y, 0.0])
    close(slides(got)[0], centre + about(2, angle) @ (np.array([10.0, 4.0, 1.0]) - centre), atol=1e-9)
    close(slides(got)[1], [10.0, 4.0, 1.0], atol=1e-9)


def test_offsets_shifts_and_machine_positions(run: Runner) -> None:
    got = fanuc(
        run,
        "G0 X1. Y1. Z1.\nG52 X10. Y0 Z0\nX1.\nG52 X0 Y0 Z0\nX1.\nG10 L2 P1 X5. Y6. Z7.\nX1. Y0 Z0\nG92 X0\nX2.\n"
        "G90 G53 G0 X3. Z9.\nG91 G28 Z0\nG90 G54.1 P2\nX0 Y0 Z0\n",
    )
    close(
        slides(got),
        [[1, 1, 1], [11, 1, 1], [1, 1, 1], [6, 6, 7], [8, 6, 7], [3, 6, 9], [3, 6, 0], [1, 0, 0]],
        atol=1e-9,
    )
    # Nobody said where the zero is, against which the place in G10 counts.
    assert [(each.code, each.line) for each in got.diagnostics] == [("NC352", 6)]


# Cycles

CYCLES = {
    "G98 G81 X1. Z-10. R2. F100.": [(0, 30), (0, 2), (1, -10), (0, 30)],
    "G99 G81 X1. Z-10. R2. F100.": [(0, 30), (0, 2), (1, -10), (0, 2)],
    "G98 G82 X1. Z-10. R2. P500 F100.": [(0, 30), (0, 2), (1, -10), (0, 30)],
    "G99 G83 X1. Z-7. R2. Q4. F100.": [
        (0, 30), (0, 2), (1, -2), (0, 2), (0, -1), (1, -6), (0, 2), (0, -5), (1, -7), (0, 2),
    ],
    "G98 G73 X1. Z-7. R2. Q4. F100.": [(0, 30), (0, 2), (1, -2), (0, -1), (1, -6), (0, -5), (1, -7), (0, 30)],
    "G98 G84 X1. Z-10. R2. F100.": [(0, 30), (0, 2), (1, -10), (1, 2), (0, 30)],
    "G99 G74 X1. Z-10. R2. F100.": [(0, 30), (0, 2), (1, -10), (1, 2)],
    "G99 G85 X1. Z-10. R2. F100.": [(0, 30), (0, 2), (1, -10), (1, 2)],
    "G98 G86 X1. Z-10. R2. F100.": [(0, 30), (0, 2), (1, -10), (0, 30)],
    "G98 G89 X1. Z-10. R2. P100 F100.": [(0, 30), (0, 2), (1, -10), (1, 2), (0, 30)],
    "G98 G88 X1. Z-10. R2. P100 F100.": [(0, 30), (0, 2), (1, -10), (0, 2), (0, 30)],
    "G98 G76 X1. Z-10. R2. Q.5 P100 F100.": [(0, 30), (0, 2), (1, -10), (0, -10), (0, 30), (0, 30)],
    "G98 G87 X1. Z-5. R-20. Q3. F100.": [
        (0, 30), (0, 30), (0, -20), (0, -20), (1, -5), (0, -5), (0, 30), (0, 30),
    ],
    "G91 G99 G81 X1. Z-12. R-28. F100.": [(0, 30), (0, 2), (1, -10), (0, 2)],
}  # fmt: skip


@pytest.mark.parametrize("block", CYCLES)
def test_cycles_make_the_motions_of_the_manual(block: str, run: Runner) -> None:
    got = fanuc(run, f"G90 G0 X0. Y0. Z30.\n{block}\nG80\n")
    rows = got.line == 2
    assert list(zip(got.kind[rows].tolist(), slides(got)[rows][:, 2].tolist(), strict=True)) == [
        (kind, float(height)) for kind, height in CYCLES[block]
    ]
    assert got.diagnostics == ()


@pytest.mark.parametrize("between", ["", "M8\n", "G99\nG98\n", "G82\nG81\n", "G4 P500\n"])
def test_a_cycle_may_be_selected_before_its_words(between: str, run: Runner) -> None:
    got = fanuc(run, f"G90 G0 X0. Y0. Z30.\nG98 G81\n{between}X1. Z-10. R2. F100.\nG80\n")
    assert slides(got)[1:].tolist() == [[1, 0, 30], [1, 0, 2], [1, 0, -10], [1, 0, 30]]
    assert got.diagnostics == ()


@pytest.mark.parametrize(
    ("lines", "at"),
    [
        ("G98 G81\nG80", [(2, "NC218")]),
        ("G98 G81\nG0 X1.", [(2, "NC218")]),
        ("G98 G81", [(2, "NC218")]),
        ("G81\nG83\nG80", [(2, "NC218")]),
        ("G81\nG80\nG81\nX1. Z-10. R2. F100.\nG80", [(2, "NC218")]),
        ("G81\nX1. Y2.\nG80", [(2, "NC218"), (3, "NC210")]),
        ("G81 X1. Z-10. R2. F100.\nG80\nG81\nX2.", [(4, "NC218"), (5, "NC210")]),
    ],
)
def test_a_cycle_whose_words_never_come_is_an_error(lines: str, at: list[tuple[int, str]], run: Runner) -> None:
    got = fanuc(run, f"G90 G0 X0. Y0. Z30.\n{lines}\n")
    assert [(error.line, error.code) for error in got.errors] == at


def test_words_of_a_block_that_drills_nothing_do_not_stay(run: Runner) -> None:
    got = fanuc(run, "G90 G0 X0. Y0. Z30.\nG83\nQ4.\nX1. Z-10. R2. F100.\nG80\n")
    assert [error.line for error in got.errors if "the cycle has no Q" in error.text] == [4]
    assert [(each.line, each.code) for each in got.diagnostics if each.line == 3] == [(3, "NC213")]


#: Where the tool is beside the hole, and where it waits: what the manual says of the cycles that shift it or dwell.
ASIDE = {
    "G98 G76 X1. Z-10. R2. Q.5 P100 F100.": ([0, 0, 0, 0.5, 0.5, 0], {-10: 0.1}),
    "G99 G76 X1. Z-10. R2. Q-.5 F100.": ([0, 0, 0, 0.5, 0.5, 0], {}),
    "G98 G87 X1. Z-5. R-20. Q3. P250 F100.": ([0, 3, 3, 0, 0, 3, 3, 0], {-5: 0.25}),
    "G98 G88 X1. Z-10. R2. P100 F100.": ([0, 0, 0, 0, 0], {-10: 0.1}),
    "G98 G89 X1. Z-10. R2. P100 F100.": ([0, 0, 0, 0, 0], {-10: 0.1}),
    "G98 G82 X1. Z-10. R2. P500 F100.": ([0, 0, 0, 0], {-10: 0.5}),
    "G99 G84 X1. Z-10. R2. P200 F100.": ([0, 0, 0, 0], {-10: 0.2}),
}


@pytest.mark.parametrize("block", ASIDE)
def test_cycles_shift_the_tool_and_wait_where_the_manual_says(block: str, run: Runner) -> None:
    got = fanuc(run, f"G90 G0 X0. Y0. Z30.\n{block}\nG80\n")
    rows = np.flatnonzero(got.line == 2)
    aside, dwells = ASIDE[block]
    close(slides(got)[rows][:, 0] - 1.0, aside)
    close(slides(got)[rows][:, 1], 0.0)
    waited = {float(slides(got)[e.before_row - 1][2]): e.value for e in got.events if e.kind == "dwell"}
    assert waited == dwells
    assert got.errors == ()
    assert ["Q without its sign" in each.text for each in got.diagnostics] == [True] * ("Q-" in block)


def test_a_q_whose_sign_does_not_count_and_a_bore_without_one_are_named(run: Runner) -> None:
    head = "G90 G0 X0. Y0. Z30.\n"
    for block, said in (
        ("G83 X1. Z-10. R2. Q-3. F100.", "Q-3: the control takes Q without its sign"),
        ("G76 X1. Z-10. R2. F100.", "G76 without Q: the tool leaves the hole along its wall"),
        ("G76 X1. Z-10. R2. Q0 F100.", "G76 without Q: the tool leaves the hole along its wall"),
        ("G76 X1. Z-10. R2. Q.5 F100.", ""),
    ):
        texts = [each.text for each in fanuc(run, f"{head}{block}\nX2.\nG80\n").diagnostics]
        assert [text.startswith(said) for text in texts[:1]] == [True] * bool(said), block


def test_back_boring_needs_g98_and_shifts_by_i_and_j_too(run: Runner) -> None:
    got = fanuc(run, "G90 G0 X0. Y0. Z30.\nG98 G87 X1. Z-5. R-20. I-1. J2. F100.\nG80\nG99 G87 X9. Z-5. R-20. Q1.\n")
    rows = got.line == 2
    close(slides(got)[rows][:, :2] - [1.0, 0.0], [[0, 0], [-1, 2], [-1, 2], [0, 0], [0, 0], [-1, 2], [-1, 2], [0, 0]])
    assert [(finding.line, "G98" in finding.text) for finding in got.errors] == [(4, True)]


def test_words_of_a_cycle_hold_until_it_ends(run: Runner) -> None:
    got = fanuc(run, "G90 G0 Z20.\nG99 G81 X1. Z-10. R2. F100.\nX2.\nZ-5.\nG91 X1. K3\nG90 G80\nX0.\n")
    drilled = got.kind == int(Kind.LINEAR)
    close(slides(got)[drilled][:, [0, 2]][:3], [[1, -10], [2, -10], [2, -5]])
    # How often a cycle drills is no length, though K has no point.
    close(slides(got)[drilled][:, 0], [1, 2, 2, 3, 4, 5])
    assert got.diagnostics == ()


def test_a_repeat_without_a_point_is_no_length(run: Runner) -> None:
    got = fanuc(run, "G90 G0 X0. Z20.\nG91 G99 G81 X1. Z-10. R-2. F100. K2\nG80\nG81 X1. Z-10. R-2. K0\nG80\n")
    close(slides(got)[got.kind == int(Kind.LINEAR)][:, 0], [1, 2])


def test_cycles_that_lack_something_are_named(run: Runner) -> None:
    got = fanuc(
        run, "G99 G83 X1. Z-10. R2. F100.\nG80\nG81 X1. F9.\nG80\nG99 G87 X1. Z1. R1. Q1.\nG80\nG81 X1. Z-1. R1. B5.\n"
    )
    assert [finding.line for finding in got.errors] == [1, 3, 5, 7]


# Macros


def test_loops_jumps_and_conditions(run: Runner) -> None:
    got = fanuc(
        run,
        "O1\n#100=#0\n#1=0\nWHILE[#1LT3]DO1\n#1=#1+1\nIF[#1EQ2]GOTO5\nG0 X#1\nN5\nEND1\nIF[#9 EQ #0] THEN #2=7\n"
        "G0 X[#2+SIN[30]*2]\nGOTO 20\nX99.\nN20 X[ROUND[2.5]+FIX[-1.5]+#100]\nY[10MOD4*2]\nZ#9\nM30\n",
    )
    assert got.errors == ()
    close(slides(got)[:, 0], [1.0, 3.0, 8.0, 2.0, 2.0])
    close(slides(got)[-1], [2.0, 4.0, 0.0])


def test_macros_have_variables_of_their_own(run: Runner) -> None:
    files = {"O9010.nc": "%\nO9010\nG91 G0 X#24 Y#1\n#100=#100+1\nM99\n%\n"}
    got = fanuc(run, "#24=50.\n#100=0\nG65 P9010 L2 A1. X2.5\nG90 G0 Z#100\nX#24\nM30\n", files=files)
    assert got.errors == ()
    close(slides(got), [[2.5, 1, 0], [5, 2, 0], [5, 2, 2], [50, 2, 2]])


def test_macros_inside_each_other_keep_their_variables_and_are_told_of_where_they_are_too_many(run: Runner) -> None:
    calls = "".join(f"O{n}\nG65 P{n + 1} A[#1+1]\nG0 X#1\nM99\n" for n in range(2, 6))
    got = fanuc(run, f"O1\n#1=50.\nG65 P2 A1.\nG0 X#1\nM30\n{calls}O6\nG0 X#1\nM99\n")
    close(slides(got)[:, 0], [5, 4, 3, 2, 1, 50])
    assert [(finding.line, str(finding.severity)) for finding in got.diagnostics] == [(19, "warning")]
    endless = fanuc(run, "O1\nG65 P2\nM30\nO2\nG0 X1.\nM99\n")
    assert endless.diagnostics == ()
    with pytest.raises(InputError, match="deeper than 16 levels"):
        fanuc(run, "O1\nG65 P1 A1.\nM30\n")


def test_macros_that_are_not_there_or_not_named_are_errors_and_nothing_is_opened(run: Runner, tmp_path: Path) -> None:
    (tmp_path / "O9010.nc").write_text("O9010\nG0 X99.\nM99\n")
    got = fanuc(run, "G65 P9010 A1.\nG66 P9010\nG0 X1.\nG67\nG65 A1.\nG65 P1.5\nG66.1 P1\nM30\n")
    assert [finding.line for finding in got.errors] == [1, 3, 5, 6, 7]
    assert slides(got)[:, 0].tolist() == [1.0]


def test_arguments_become_the_variables_of_their_letters(run: Runner) -> None:
    letters = {
        "A": 1,
        "B": 2,
        "C": 3,
        "I": 4,
        "J": 5,
        "K": 6,
        "D": 7,
        "E": 8,
        "F": 9,
        "H": 11,
        "M": 13,
        "Q": 17,
        "R": 18,
    }
    letters |= {"S": 19, "T": 20, "U": 21, "V": 22, "W": 23, "X": 24, "Y": 25, "Z": 26}
    said = " ".join(f"{letter}{number}." for letter, number in letters.items())
    reads = "\n".join(f"X#{number}" for number in letters.values())
    got = fanuc(run, f"O1\nG65 P2 {said}\nM30\nO2\nG0\n{reads}\nX[#10+#33]\nM99\n")
    assert slides(got)[:, 0].tolist() == [float(number) for number in letters.values()] + [0.0]


def test_a_modal_macro_follows_every_motion(run: Runner) -> None:
    got = fanuc(run, "O1\nG66 P2 A3.\nG0 X1.\nX2.\nG67\nX3.\nM30\nO2\nG0 Z#1\nZ0.\nM99\n")
    assert got.errors == ()
    close(slides(got)[:, [0, 2]], [[1, 0], [1, 3], [1, 0], [2, 0], [2, 3], [2, 0], [3, 0]])


def test_subprograms_of_the_file_and_of_others_that_are_named(run: Runner) -> None:
    files = {"O0200.nc": "O0200\nG0 Y1.\nY0.\nM99\n"}
    got = fanuc(
        run,
        "%\nO1\nM98 P30100\nM98 P200 L2\nM98 P0300\nX9.\nN8 X10.\nM30\nO100\nG91 G0 X1.\nG90\nM99\nO300\nM99 P8\n%\n",
        files=files,
    )
    assert got.errors == ()
    close(slides(got)[:, :2], [[1, 0], [2, 0], [3, 0], [3, 1], [3, 0], [3, 1], [3, 0], [10, 0]])


def test_a_program_that_runs_into_the_next_one_is_named(run: Runner) -> None:
    got = fanuc(run, "O1\nG0 X1.\nO2\nG0 X2.\nM99\n")
    assert len(got) == 1
    assert [finding.line for finding in got.errors] == [3, 4]


def test_what_is_not_known_is_named(run: Runner) -> None:
    got = fanuc(
        run,
        "G0 X1. A5.\nG41 D1\nG123\nG51 X0 Y0 P2\nG0 X1. K2.\nG28\nG1 F0\nX2.\nG12.1\nX#3001\nG65 P77\nGOTO 99\n(open\n"
        "M198 P1\nG54.4 P1\nG10 L50\n",
    )
    assert sorted({finding.line for finding in got.diagnostics}) == [1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15, 16]


ENDLESS = {
    "a loop": "WHILE[1EQ1]DO1\nEND1",
    "a jump": "N1 G0 X1.\nGOTO 1",
    "repetitions": "M98 P2 L999999\nM30\nO2\nM99",
    "drilling": "G99 G83 Z-20. R2. Q.03 F9.\nN1 X1.\nX2.\nGOTO1",
    "plain blocks": "G1 F9.\nN1\n" + "X1. Y1.\nX2. Y2.\n" * 100 + "GOTO1",
}


@pytest.mark.parametrize("text", ENDLESS.values(), ids=ENDLESS.keys())
def test_a_program_without_end_is_stopped(text: str, run: Runner) -> None:
    with pytest.raises(InputError, match=r"executes more than 3[0-9]{3} blocks|motions in cycles|no condition ends it"):
        fanuc(run, text, step_limit=3000)


@pytest.mark.parametrize("text", ["WHILE[1EQ1]DO1\nDO2\nEND1\nEND2\n", "DO1\n", "END1\n"])
def test_loops_that_are_nested_wrongly_are_refused(text: str, run: Runner) -> None:
    with pytest.raises(InputError, match=r"DO1|DO2|END1"):
        fanuc(run, text)


def test_m99_of_the_program_itself_ends_it_with_a_word(run: Runner) -> None:
    got = fanuc(run, "O1\nG0 X1.\nM99\n")
    assert [str(finding.severity) for finding in got.diagnostics] == ["warning"]


def test_wrong_settings_are_refused(tmp_path: Path) -> None:
    wrong = load_machine("yl569", {"control": {**CONTROL, "reading": {"whole_numbers": "pocket"}}})
    (tmp_path / "p.nc").write_text("M30\n")
    with pytest.raises(InputError, match="whole_numbers"):
        run_program(tmp_path / "p.nc", wrong)


words = st.sampled_from(
    [
        "G0", "G1", "G00", "g01", "G2", "G 1", "G90", "G91", "G93", "G94", "G95", "G54", "X1", "X-.5", "Y+2.",
        "X0", "Z 3.", "X[1+1]", "B10.", "C-20.5", "C 400", "A5", "F100", "F.5", "F 7", "F0", "S5", "M3", "I1.", "R3.",
        "N7", "N08", "#1=2", "X#1", "X1X2", "X", "1", "=", ".", "-", "+", ";c", ";", "(c)", "(c", "/", "%", "O5",
        "X1.2.3", "X1 2", "G20", "G21", "G43.4", "G49", "G52 X1.", "G53", "G80", "G81 Z-1. R1.", "G68 R30.", "G69",
        "G66 P7", "G67", "G43.5", "J-.5", "K1.", "K0", "I1", "Q2.",
    ]
)  # fmt: skip


@settings(max_examples=examples(80), suppress_health_check=FRESH)
@given(lines=st.lists(st.lists(words, max_size=5).map(" ".join), max_size=8), glue=st.booleans())
def test_the_kernel_and_the_interpreter_read_any_words_alike(
    lines: list[str], glue: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "G1 F100\n" + "\n".join(lines)
    path = tmp_path / "p.nc"
    path.write_text(text.replace(" ", "") if glue else text)
    results: list[Run | tuple[Problem, ...]] = []
    for plain in (True, False):
        with monkeypatch.context() as patch:
            if not plain:
                patch.setattr(FanucInterpreter, "_may_scan", lambda *_: False)
            try:
                results.append(run_program(path, MACHINE))
            except InputError as error:
                results.append(error.problems)
    fast, slow = results
    if isinstance(fast, Run) and isinstance(slow, Run):
        assert sorted(map(str, fast.diagnostics)) == sorted(map(str, slow.diagnostics))
        for one in (fast, slow):
            object.__setattr__(one, "diagnostics", ())
        same(fast, slow)
    else:
        assert fast == slow


def test_the_length_of_the_tool_counts_from_g43_to_g49(run: Runner) -> None:
    machine = replace(MACHINE, tool_length=50.0)
    got = run("G0 X1. Y2. Z3.\nG43 H1 Z3.\nG43.4 H1\nX4. Y5. Z6. B30. C40.\nG49\nG53 X0 Y0 Z0\nZ5.\n", machine)
    assert got.errors == ()
    close(slides(got)[:2], [[1, 2, 3], [1, 2, 53]])
    close(got.tip[2], [4.0, 5.0, 6.0], atol=1e-9)
    close(slides(got)[3:], [[0, 0, 0], [0, 0, 5]], atol=1e-9)


def test_a_length_is_in_force_from_g43_to_g49_and_its_number_is_kept(run: Runner) -> None:
    heights = "G0 X1.\nG43 H7 Z9.\nX2.\nG49 G53 G0 Z0.\nX3.\nG43 Z8.\nH8\nX4.\nG43.4 H9 X5.\nG49 X6.\n"
    assert fanuc(run, heights).edge.tolist() == [-1, 7, 7, -1, -1, 7, 8, 9, -1]


def test_contour_control_says_on_or_off(run: Runner) -> None:
    assert fanuc(run, "G21\nG5.1 Q1\nG5.1 Q0\n").diagnostics == ()
    assert [each.line for each in fanuc(run, "G21\nG5.1\nG5.1 Q-1\n").errors] == [2, 3]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("G1 X9. F100.\nG41 D1\nG1 X20.\nG40\nG1 X30.\n", []),
        ("G1 X9. F100.\nG2 X10. Y1. R1.\nG41 D1\nG1 X20.\nG40 X30.\n", [4]),
        ("G1 X9. F100.\nG2 X10. Y1. R1.\nG1 G41 D1\nX20.\nG3 X22. R1.\nG40\nG1 X30.\n", [7]),
        ("G1 X9. F100.\nG2 X10. Y1. R1.\nG1 G41 D1\nX20.\nG3 X22. R1.\nG1 G40\nX30.\nG2 X32. R1.\nG40\n", []),
        ("G1 X9. F100.\nG41 D1\nG2 X10. Y1. R1.\nG1 X20.\nG40 X30.\n", [4]),
    ],
)
def test_radius_compensation_begins_and_ends_on_lines(run: Runner, text: str, lines: list[int]) -> None:
    found = fanuc(run, f"G0 X0. Y0. Z0.\n{text}M30\n")
    errors = [each.line for each in found.diagnostics if "radius compensation begins or ends" in each.text]
    assert errors == lines


def test_back_boring_without_a_shift_does_not_go_into_the_hole(run: Runner) -> None:
    found = fanuc(run, "G90 G0 X0. Y0. Z30.\nG98 G87 X1. Z-5. R-20. F100.\nG80\n")
    assert any("without a shift" in fault.text for fault in found.errors)


def test_numbers_without_a_point_are_told_once_unless_it_is_stated_how_they_count(run: Runner, tmp_path: Path) -> None:
    text = "G90 G1 X0 Y0. F100.\nX10\nX20.\nX3000 Y5.\nM98 P2\nM30\nO2\nX7\nM99\n"
    found = fanuc(run, text)
    told = [(each.line, each.text) for each in found.diagnostics if each.code == "NC224"]
    said = "X10 has no decimal point and is taken for 0.01, as nothing states how such numbers count"
    assert told == [
        (2, f"{said} (the first of 3 of this kind); write the point, or state whole_numbers under [control.reading]")
    ]
    assert [each.text.count("the first of") for each in fanuc(run, "G1 X10 F100.\nM30\n").diagnostics] == [0]
    for word in ("increments", "calculator"):
        toml = tmp_path / f"{word}.toml"
        toml.write_text(f'extends = "matsuura_mx330"\n[control.reading]\nwhole_numbers = "{word}"\n', encoding="utf-8")
        assert not [each for each in run(text, load_machine(toml)).diagnostics if each.code == "NC224"]
