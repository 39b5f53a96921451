"""Words of LinuxCNC, one by one."""

import math

import numpy as np
import pytest

from tests.reader.conftest import Runner, close, slides
from trunnion.errors import Severity
from trunnion.toolpath import Kind


def test_form(run: Runner) -> None:
    text = "%\n(all)\nN10 G 0 x 1.5 (there) Y-2 ;end\ng1z+.5f100\n/X9\nN20X[1+2*3]\n(MSG, look)\n%\nX99"
    found = run(text)
    assert found.findings == ()
    close(found.tip, [[1.5, -2, 0], [1.5, -2, 0.5], [9, -2, 0.5], [7, -2, 0.5]])
    assert found.number.tolist() == [10, -1, -1, 20]
    assert [c.text for c in found.comments] == ["all", "there", "end", "MSG, look"]
    assert [(e.kind, e.value) for e in found.events] == [("message", " look")]
    assert run(text, skip=True).tip[:, 0].tolist() == [1.5, 1.5, 7]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("[1+2*3]", 7.0), ("[[1+2]*3]", 9.0), ("[2**3**2]", 64.0), ("[7MOD4]", 3.0), ("[-7MOD4]", 1.0), ("#1", 3.0),
        ("[#1*2]", 6.0), ("-#1", -3.0), ("#<depth>", -4.5), ("SIN[30]", 0.5), ("ATAN[1]/[-1]", 135.0), ("##2", 3.0),
        ("ABS[-2]", 2.0), ("FIX[-2.5]", -3.0), ("FUP[2.1]", 3.0), ("ROUND[2.5]", 3.0), ("SQRT[16]", 4.0),
        ("[1 EQ 1]", 1.0), ("[1 LT 0 OR 1]", 1.0), ("[2 + 3 GT 4 AND 0]", 0.0), ("#99", 0.0), ("[10/4-1]", 1.5),
    ],
)  # fmt: skip
def test_expressions(text: str, value: float, run: Runner) -> None:
    found = run(f"#1=3 #2=1\n#<depth>=-4.5\nG0 X{text}")
    assert found.findings == ()
    assert found.tip[0, 0] == pytest.approx(value, abs=1e-12)


def test_parameters_are_set_after_their_block(run: Runner) -> None:
    assert run("#1=5\nG0 X#1 #1=7\nX#1").tip[:, 0].tolist() == [5, 7]


@pytest.mark.parametrize(
    "text",
    [
        "X", "X[1", "X1]", "X[1/0]", "XSQRT[-1]", "X#5221", "X#<nobody>", "X1X2", "Q", "G5.5", "M1.5", "G", "X--1",
        "W7 X", "#0=1", "X=5", "(open", "X1)", "X" + "[" * 60 + "1" + "]" * 60, "G0.5", "X1e5 ", "FOO[1]", "X[1 NOT 2]",
    ],
)  # fmt: skip
def test_what_is_not_understood_is_named_and_has_no_effect(text: str, run: Runner) -> None:
    found = run(f"G0 X3 Y4\n{text}\nZ7")
    assert [f.line for f in found.errors] == [2]
    close(found.tip[-1], [3, 4, 7])


def test_a_position_needs_a_motion_word(run: Runner) -> None:
    found = run("X1\nG0 X2\nG80\nX3\nG1 X4")
    assert [f.line for f in found.errors] == [1, 4]
    assert found.tip[:, 0].tolist() == [2, 4]


def test_modes(run: Runner) -> None:
    found = run("G20 G1 X1 F10\nG21 X10 F20\nG91 X5 A-10\nA-10\nG90 A-5\nG53 G0 Z8\nG55 G1 X1\nG54 X2")
    assert [(f.line, f.severity) for f in found.findings] == [(8, Severity.WARNING)]
    close(slides(found)[:, 0], [25.4, 10, 15, 15, 15, 15, 1, 2])
    close(found.feed[:2], [254, 20])
    assert found.joints[2:5, found.machine.column("A")].tolist() == [-10, -20, -5]
    assert found.machine_frame.tolist() == [False] * 5 + [True, False, False]
    assert found.offset.tolist() == [0] * 6 + [55, 54]


@pytest.mark.parametrize(
    ("block", "centre", "normal", "turns"),
    [
        ("G3 X0 Y10 I-10 J0", (0, 0, 5), (0, 0, 1), 0), ("G2 X0 Y10 I-10", (0, 0, 5), (0, 0, -1), 0),
        ("G90.1 G3 X0 Y10 I0 J0", (0, 0, 5), (0, 0, 1), 0), ("G3 X0 Y10 R10", (0, 0, 5), (0, 0, 1), 0),
        ("G2 X0 Y10 R-10", (0, 0, 5), (0, 0, -1), 0), ("G3 I-10 P3", (0, 0, 5), (0, 0, 1), 2),
        ("G3 X0 Y10 Z1 I-10 P2", (0, 0, 5), (0, 0, 1), 1), ("G18 G2 X5 Z10 I-5 K0", (5, 0, 5), (0, -1, 0), 0),
    ],
)  # fmt: skip
def test_circles(block: str, centre: tuple[float, ...], normal: tuple[float, ...], turns: int, run: Runner) -> None:
    found = run(f"G0 X10 Y0 Z5\nF100 {block}")
    assert found.findings == ()
    close(found.arcs.centre[0], centre, atol=1e-9)
    close(found.arcs.normal[0], normal, atol=1e-12)
    assert found.arcs.turns.tolist() == [turns]


@pytest.mark.parametrize("block", ["G2 X0 Y10", "G2 X0 Y10 I3", "G2 X0 Y99 R1", "G2 X0 Y10 I-10 P.5", "G3 X1 K5 I1"])
def test_circles_that_are_none_are_named(block: str, run: Runner) -> None:
    assert [f.severity for f in run(f"G0 X10 Y0\n{block}").findings] == [Severity.ERROR]


def test_tcp_and_inverse_time(run: Runner) -> None:
    found = run("M428\nG93\nG1 X1 Y2 Z3 A-30 C40 F12\nX2 F13\nX3\nX3 Y[1]\nM429\nG94 G1 X1 F100")
    assert [f.line for f in found.errors] == [5, 6]
    a, c = math.radians(-30), math.radians(40)
    close(found.tip[0], [1, 2, 3], atol=1e-9)
    close(found.axis[0], [math.sin(a) * math.sin(c), -math.sin(a) * math.cos(c), math.cos(a)], atol=1e-12)
    assert found.tcp.tolist() == [True] * 4 + [False]
    assert found.feed_mode.tolist() == [93] * 4 + [94]


def test_inverse_time_counts_no_inches(run: Runner) -> None:
    found = run("G20 G93 G1 X1 F7\nX2 F8\nX[3] F9\nG94 X4 F10")
    assert found.findings == ()
    close(found.feed, [7, 8, 9, 254])


def test_tools_and_machine(run: Runner) -> None:
    found = run("T5 M6 G43 H5\nS600 M3 M8\nG0 X1\nM9 M5\nM101\nG4 P0.5\nM0\nG0 X2 M30\nX3")
    assert found.findings == ()
    assert [(e.kind, e.value) for e in found.events] == [
        ("tool", "5"), ("tool_change", "5"), ("speed", 600.0), ("spindle", "clockwise"), ("coolant", "flood"),
        ("coolant", "off"), ("spindle", "off"), ("m", 101.0), ("dwell", 0.5), ("stop", None), ("end", "M30"),
    ]  # fmt: skip
    assert found.tools[found.tool[0]] == "5"
    assert len(found) == 2


@pytest.mark.parametrize("text", ["O100 sub", "o<drill> call [1]", "N5 O1 if [1]", "M98 P100", "M99"])
def test_calls_end_the_program_and_are_named(text: str, run: Runner) -> None:
    found = run(f"G0 X1\n{text}\nX2")
    assert [f.line for f in found.errors] == [2]
    assert len(found) == 1


@pytest.mark.parametrize("code", ["G10 L2 P1 X5", "G28 Z5", "G92 X5", "G38.2 Z-5", "G5.2 X1", "G43.1 Z10"])
def test_words_that_would_change_the_path_are_errors(code: str, run: Runner) -> None:
    assert [f.line for f in run(f"G0 X1\n{code}\nG0 X2").errors] == [2]


# Cycles

BEFORE = "S1000 M3\nG0 X3 Y4 Z50\nF150\n"


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ("G81 X3 Y4 Z-10 R2", "R50 R2 F-10 R50"),
        ("G99 G81 X3 Y4 Z-10 R2", "R50 R2 F-10 R2"),
        ("G82 X3 Y4 Z-10 R2 P1", "R50 R2 F-10 R50"),
        ("G83 X3 Y4 Z-10 R2 Q5", "R50 R2 F-3 R2 R-2.746 F-8 R2 R-7.746 F-10 R50"),
        ("G73 X3 Y4 Z-10 R2 Q6", "R50 R2 F-4 R-3.746 F-10 R50"),
        ("G84 X3 Y4 Z-10 R2", "R50 R2 F-10 F2 R50"),
        ("G74 X3 Y4 Z-10 R2", "R50 R2 F-10 F2 R50"),
        ("G85 X3 Y4 Z-10 R2", "R50 R2 F-10 F2 R50"),
        ("G86 X3 Y4 Z-10 R2 P1", "R50 R2 F-10 R50"),
        ("G89 X3 Y4 Z-10 R2 P1", "R50 R2 F-10 F2 R50"),
        ("Z-5\nG99 G81 X3 Y4 Z-10 R2", "R-5 R2 R2 F-10 R2"),
    ],
)
def test_cycles(block: str, expected: str, run: Runner) -> None:
    found = run(BEFORE + block)
    assert found.findings == ()
    rapid = (found.kind == Kind.RAPID).tolist()[1:]
    heights = np.round(found.tip[1:, 2], 6).tolist()
    assert " ".join(f"{'R' if r else 'F'}{z:g}" for r, z in zip(rapid, heights, strict=True)) == expected


def test_cycles_go_on_until_they_are_cancelled(run: Runner) -> None:
    found = run(BEFORE + "G99 G81 X1 Y1 Z-10 R2\nX2\nY5 Z-12\nG80\nG0 X9\nG91 G98 G81 X1 Z-4 R-3 L3\nG80")
    assert found.findings == ()
    deep = found.tip[found.kind == Kind.LINEAR]
    close(deep, [[1, 1, -10], [2, 1, -10], [2, 5, -12], [10, 5, -5], [11, 5, -5], [12, 5, -5]])


@pytest.mark.parametrize(
    "block", ["G81 X1", "G81 X1 Z5 R2", "G83 X1 Z-5 R2", "G81 X1 Z-5 R2 A5", "G76 P1", "G81 Z-1 R2 L.5"]
)
def test_cycles_that_make_no_sense_are_named(block: str, run: Runner) -> None:
    assert len(run(BEFORE + block).errors) >= 1
