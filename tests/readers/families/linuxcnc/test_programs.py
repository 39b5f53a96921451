"""LinuxCNC programs: kinematics that are switched, what its words do, and real files."""

import math
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.locations import SHARED
from tests.support.reading import Runner, close
from tests.support.run_comparison import same
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program
from trunnion.readers.families.linuxcnc.interpreter import LinuxcncInterpreter

FOLDER = SHARED / "data" / "linuxcnc"
XYZAC = load_machine("xyzac_trt")
XYZBC = load_machine("xyzbc_trt")

QUICK = settings(max_examples=examples(30), suppress_health_check=[HealthCheck.function_scoped_fixture])


def trt(machine: str, x: float, y: float, z: float, tilt: float, c: float) -> list[float]:
    """Joints X Y Z as LinuxCNC's documentation of its table-rotary-tilting kinematics derives them, tool length 0.

    The table turns the part by C about Z, then by A about X or B about Y; the tilting axis is offset from C's.
    """
    c, tilt = math.radians(c), math.radians(tilt)
    x, y = x * math.cos(c) - y * math.sin(c), x * math.sin(c) + y * math.cos(c)
    if machine == "xyzac_trt":
        dy, dz = 20.0, 10.0
        y, z = y - dy, z - dz
        return [x, y * math.cos(tilt) - z * math.sin(tilt) + dy, y * math.sin(tilt) + z * math.cos(tilt) + dz]
    dx, dz = -20.0, -15.0
    x, z = x - dx, z - dz
    return [x * math.cos(tilt) + z * math.sin(tilt) + dx, y, -x * math.sin(tilt) + z * math.cos(tilt) + dz]


def at(run: Run, names: str) -> np.ndarray:
    """Values of axes, (n, k)."""
    return run.joints[:, [run.machine.column(name) for name in names]]


@QUICK
@given(
    machine=st.sampled_from([XYZAC, XYZBC]),
    points=st.lists(
        st.tuples(*[st.floats(-60, 60).map(lambda v: round(v, 3))] * 3, st.floats(-49, 49), st.floats(-400, 400)),
        min_size=1,
        max_size=4,
    ),
)
def test_switched_kinematics_bring_the_joints_where_linuxcnc_does(
    machine: Machine, points: list[tuple[float, ...]], tmp_path: Path
) -> None:
    tilt = "A" if machine is XYZAC else "B"
    blocks = [f"G0 X{x:.3f} Y{y:.3f} Z{z:.3f} {tilt}{t:.5f} C{c:.5f}" for x, y, z, t, c in points]
    path = tmp_path / "p.ngc"
    path.write_text("\n".join(["M428", *blocks, "M429", "G0 X1", "M2", ""]))
    run = run_program(path, machine)
    assert run.diagnostics == ()
    wanted = [trt(machine.key, x, y, z, round(t, 5), round(c, 5)) for x, y, z, t, c in points]
    close(at(run, "XYZ")[:-1], wanted, atol=1e-9)
    close(run.tip[:-1], [point[:3] for point in points], atol=1e-9)
    assert run.tcp.tolist() == [True] * len(points) + [False]
    # Without TCP the numbers are those of the axes, and only X goes anywhere.
    close(at(run, "XYZ")[-1], [1.0, *wanted[-1][1:]], atol=1e-9)


@pytest.mark.skipif(not FOLDER.is_dir(), reason="shared/data/linuxcnc is not beside the repository")
@pytest.mark.parametrize("name", ["boat-xyzac", "boat-xyzbc", "impeller-7bl-xyzac"])
def test_real_programs_are_read_whole(name: str) -> None:
    path = FOLDER / f"{name}.ngc"
    run = run_program(path, XYZBC if "xyzbc" in name else XYZAC)
    # One of them takes its tool length with the table turned, where the slides jump in LinuxCNC as well, and goes home
    # with TCP on: by the tip.
    noted = [("NC364", 12), ("NC341", 1863), ("NC341", 1864)] if name == "boat-xyzbc" else []
    assert [(each.code, each.line) for each in run.diagnostics] == noted
    assert run.tcp.all()
    # Every line with an axis word is a motion, and positions are the numbers that a plain look at the text finds.
    lines = [re.sub(r"\(.*?\)|;.*", "", line) for line in path.read_text().splitlines()]
    words = [dict(re.findall(r"([XYZABC])\s*(-?[0-9.]+)", line)) for line in lines]
    moving = [number for number, found in enumerate(words, 1) if found]
    assert run.line.tolist() == moving
    # Under G53 numbers are the same here: the workpiece zero of these machines is that of their axes.
    for axis in range(3):
        told = [float(found["XYZ"[axis]]) for found in words if "XYZ"[axis] in found]
        assert (run.tip[:, axis].min(), run.tip[:, axis].max()) == pytest.approx(
            (min([*told, 0.0]), max(told)) if axis == 0 else (min(told), max(told)), abs=1e-9
        )
    arcs = sum(bool(re.search(r"G0?[23](?![0-9])", line)) for line in lines)
    assert Counter(run.kind.tolist())[int(Kind.ARC)] >= arcs


words = st.sampled_from(
    [
        "G0", "G1", "G00", "g01", "G2", "G 1", "G90", "G91", "G93", "G94 F9", "G54", "G55", "X1", "X-.5", "Y+2.",
        "X12345678901.5", "X[1+1]", "A10", "C-20.5", "C 400", "B5", "F100", "F.5", "F 7", "F0", "S5", "M3", "I1", "R3",
        "N7", "N08", "#1=2", "X#1", "X1X2", "X", "1", "=", ".", "-", "+", ";c", "; X1", "(c)", "(c", "/", "G1.0", "%",
        "X1.2.3", "X1 2", "G20", "G21", "M428", "M429", "G92 X1", "G92 C5", "G53", "o1 if [1]", "o1 endif", "\t", "G80",
    ]
)  # fmt: skip


@settings(max_examples=examples(80), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(lines=st.lists(st.lists(words, max_size=5).map(" ".join), max_size=8), glue=st.booleans())
def test_the_kernel_and_the_interpreter_read_any_words_alike(
    lines: list[str], glue: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "G0 F100\n" + "\n".join(lines)
    path = tmp_path / "p.ngc"
    path.write_text(text.replace(" ", "") if glue else text)
    results: list[Run | tuple[Problem, ...]] = []
    for plain in (True, False):
        with monkeypatch.context() as patch:
            if not plain:
                patch.setattr(LinuxcncInterpreter, "_may_scan", lambda *_: False)
            try:
                results.append(run_program(path, XYZAC))
            except InputError as error:
                results.append(error.problems)
    fast, slow = results
    if isinstance(fast, Run) and isinstance(slow, Run):
        assert sorted(map(str, fast.diagnostics)) == sorted(map(str, slow.diagnostics))
        same(without_findings(fast), without_findings(slow))
    else:
        assert fast == slow


def without_findings(run: Run) -> Run:
    """The run, whose findings may stand in another order."""
    object.__setattr__(run, "diagnostics", ())
    return run


def test_subprograms_have_parameters_of_their_own_and_give_a_value_back(run: Runner) -> None:
    text = (
        "o<add> sub\n#1=[#1+#2]\n#<own>=7\no<add> endsub [#1]\n"
        "#1=5 #<own>=1\no<add> call [10] [20]\nG0 X#<_value> Y#1 Z#<own>\nM2\n"
    )
    got = run(text, XYZAC)
    assert got.errors == ()
    close(at(got, "XYZ"), [[30.0, 5.0, 1.0]])


def test_a_subprogram_is_a_file_that_is_named(run: Runner) -> None:
    file = {"Hop.ngc": "o<hop> sub\nG0 X#1\no<hop> endsub\n"}
    got = run("o<hop> call [3]\nG0 Y1\nM2\n", XYZAC, files=file)
    assert got.errors == ()
    assert got.file.tolist() == [1, 0]
    close(at(got, "XY"), [[3.0, 0.0], [3.0, 1.0]])
    assert [f.line for f in run("o<../hop> call\nM2\n", XYZAC).errors] == [1]


def test_continue_goes_to_the_next_round(run: Runner) -> None:
    text = "#1=0\no1 do\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\nG0 X#1\no1 while [#1 LT 4]\nM2\n"
    close(at(run(text, XYZAC), "X")[:, 0], [1.0, 3.0, 4.0])


def test_a_program_ends_at_its_second_percent_sign(run: Runner) -> None:
    got = run("\n%\nG0 X1\n%\nG0 X2\n", XYZAC)
    assert len(got) == 1
    assert [each.line for each in got.diagnostics if each.code == "NC161"] == [5]  # what never runs


def test_tool_coolant_and_stops_are_events(run: Runner) -> None:
    got = run("T3 M6\nG43 H3\nS900 M3 M8\nG0 X1 M0\nG4 P2\nM9 M5\nM30\n", XYZAC)
    assert got.diagnostics == ()
    assert [(event.kind, event.value) for event in got.events] == [
        ("tool", "3"), ("tool_change", "3"), ("speed", 900.0), ("spindle", "clockwise"), ("coolant", "flood"),
        ("stop", None), ("dwell", 2.0), ("coolant", "off"), ("spindle", "off"), ("end", "M30"),
    ]  # fmt: skip
    assert got.tools[got.tool[0]] == "3"


def test_g53_with_tcp_is_a_position_of_the_tip_in_the_machines_frame(run: Runner) -> None:
    machine = load_machine("xyzac_trt", {"workpiece": {"zero_mm": [5, 6, 7]}})
    got = run("M428\nG0 A-30 C20\nG0 X1 Y2 Z3\nG53 G0 Z10\nG53 G0 A0\nM2\n", machine)
    close(got.tip[-2], [1.0, 2.0, 3.0], atol=1e-9)
    assert got.errors == ()
    assert [(each.code, each.line) for each in got.diagnostics] == [("NC341", 4)], "a rotary axis is the same"


def test_words_of_other_machines_and_without_use_are_named(run: Runner) -> None:
    got = run("G0 X1 B5\nG0 X2 K1\nM20\nG41 D1\nG5.1 X1 Y1 I1 J1\nM110 P1\nG0 X3\nM2\n", XYZAC)
    assert [finding.line for finding in got.diagnostics] == [1, 2, 3, 4, 5, 6]
    close(at(got, "X")[-1], [3.0])


ENDLESS = {
    "a loop": "o1 while [1]\no1 endwhile",
    "a do loop": "o1 do\nG0 X1\no1 while [1]",
    "a repetition": "o1 repeat [1e12]\no1 endrepeat".replace("1e12", "999999999999"),
    "plain blocks": "o1 while [1]\n" + "G0 X1 Y1\nX2 Y2\n" * 100 + "o1 endwhile",
    "repetitions of repetitions": "".join(f"o{k} repeat [99]\n" for k in range(9)) + "G0 X1\n"
    + "".join(f"o{8 - k} endrepeat\n" for k in range(9)),
    "drilling": "F9\no1 while [1]\nG83 X1 Z-20 R2 Q.03\nX2\no1 endwhile",
}  # fmt: skip


@pytest.mark.parametrize("text", ENDLESS.values(), ids=ENDLESS.keys())
def test_a_program_without_end_is_stopped(text: str, run: Runner) -> None:
    with pytest.raises(InputError, match=r"executes more than 3[0-9]{3} blocks|motions in cycles|no condition ends it"):
        run(text, XYZAC, step_limit=3000)


def test_a_subprogram_that_calls_itself_is_stopped(run: Runner) -> None:
    with pytest.raises(InputError, match="deeper than 16"):
        run("o1 sub\no1 call\no1 endsub\no1 call\nM2\n", XYZAC)


@pytest.mark.parametrize(
    "text", ["o1 if [1]\n", "o1 endif\n", "o1 while [1]\no2 endwhile\n", "o1 sub\nM2\n", "o1 break\n"]
)
def test_what_is_nested_wrongly_is_refused(text: str, run: Runner) -> None:
    with pytest.raises(InputError, match=r"O word|begin|without|never ends|outside"):
        run(text, XYZAC)


@pytest.mark.parametrize("key", ["xyzac_trt", "xyzbc_trt"])
def test_the_length_of_the_tool_counts_as_linuxcnc_counts_it(key: str, run: Runner) -> None:
    machine = replace(load_machine(key), tool_length=80.0)
    tilt = "A" if key == "xyzac_trt" else "B"
    text = f"G43\nG0 X1 Y2 Z3\nM428\nX4 Y5 Z6 {tilt}-30 C40\nG53 G0 Z100\nM429\n"
    text += "G53 G0 Z7\nG10 L20 P1 Z1\nZ2\nG49\nZ5\nM2\n"
    got = run(text, machine)
    assert {error.code for error in got.errors} <= {"NC352"}
    close(at(got, "XYZ")[0], [1.0, 2.0, 83.0])
    close(got.tip[1], [4.0, 5.0, 6.0], atol=1e-9)
    # LinuxCNC's kinematics have the position of the gauge point over the tip, and the tilting axis as far below.
    x, y, z = trt(key, 4.0, 5.0, 6.0, -30.0, 40.0)
    close(at(got, "XYZ")[1], [x, y, z + 80.0], atol=1e-9)
    close(got.tip[2], [4.0, 5.0, 20.0], atol=1e-9)
    close(at(got, "Z")[3:, 0], [7.0, 8.0, 11.0 - 80.0], atol=1e-9)
