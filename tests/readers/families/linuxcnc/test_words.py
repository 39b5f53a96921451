"""Words of LinuxCNC, one by one."""

import numpy as np
import pytest

from tests.support.reading import Runner, close
from trunnion.model.toolpath import Kind


def test_form(run: Runner) -> None:
    text = "%\n(all)\nN10 G 0 x 1.5 (there) Y-2 ;end\ng1z+.5f100\n/X9\nN20X[1+2*3]\n(MSG, look)\n%\nX99"
    found = run(text)
    assert [(each.line, each.wording.code) for each in found.diagnostics] == [(9, "NC161")]  # behind the end
    close(found.tip, [[1.5, -2, 0], [1.5, -2, 0.5], [9, -2, 0.5], [7, -2, 0.5]])
    assert found.block_number.tolist() == [10, -1, -1, 20]
    assert [c.text for c in found.comments] == ["all", "there", "end", "MSG, look"]
    assert [(e.kind, e.value) for e in found.events] == [("block_skip", 1.0), ("message", "look")]
    assert run(text, skip=True).tip[:, 0].tolist() == [1.5, 1.5, 7]


@pytest.mark.parametrize("comment", ["(py, import os)", "; PyRun,x.py", "( abort ,now)"])
def test_comments_that_are_executed_are_errors(comment: str, run: Runner) -> None:
    found = run(f"G0 X1 {comment}\nG0 X2 (python, logged)")
    assert [(error.line, error.code) for error in found.errors] == [(1, "NC220")]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("[1+2*3]", 7.0), ("[[1+2]*3]", 9.0), ("[2**3**2]", 64.0), ("[7MOD4]", 3.0), ("[-7MOD4]", 1.0), ("#1", 3.0),
        ("[#1*2]", 6.0), ("-#1", -3.0), ("#<depth>", -4.5), ("SIN[30]", 0.5), ("ATAN[1]/[-1]", 135.0), ("##2", 3.0),
        ("ABS[-2]", 2.0), ("FIX[-2.5]", -3.0), ("FUP[2.1]", 3.0), ("ROUND[2.5]", 3.0), ("SQRT[16]", 4.0),
        ("[1 EQ 1]", 1.0), ("[1 LT 0 OR 1]", 1.0), ("[2 + 3 GT 4 AND 0]", 0.0), ("[10/4-1]", 1.5),
    ],
)  # fmt: skip
def test_expressions(text: str, value: float, run: Runner) -> None:
    found = run(f"#1=3 #2=1\n#<depth>=-4.5\nG0 X{text}")
    assert found.diagnostics == ()
    assert found.tip[0, 0] == pytest.approx(value, abs=1e-12)


def test_parameters_are_set_after_their_block(run: Runner) -> None:
    assert run("#1=5\nG0 X#1 #1=7\nX#1").tip[:, 0].tolist() == [5, 7]


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
    assert found.diagnostics == ()
    close(found.arcs.centre[0], centre, atol=1e-9)
    close(found.arcs.normal[0], normal, atol=1e-12)
    assert found.arcs.full_turns.tolist() == [turns]


def test_inverse_time_counts_no_inches(run: Runner) -> None:
    found = run("G20 G93 G1 X1 F7\nX2 F8\nX[3] F9\nG94 X4 F10")
    assert found.diagnostics == ()
    close(found.feed, [7, 8, 9, 254])


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
        ("G84 X3 Y4 Z-10 R2", "R50 R2 F-10 F50"),
        ("M4 G74 X3 Y4 Z-10 R2", "R50 R2 F-10 F50"),
        ("G85 X3 Y4 Z-10 R2", "R50 R2 F-10 F2 R50"),
        ("G86 X3 Y4 Z-10 R2 P1", "R50 R2 F-10 R50"),
        ("G89 X3 Y4 Z-10 R2 P1", "R50 R2 F-10 F50"),
        ("Z-5\nG99 G81 X3 Y4 Z-10 R2", "R-5 R2 R2 F-10 R2"),
    ],
)
def test_cycles(block: str, expected: str, run: Runner) -> None:
    found = run(BEFORE + "G98\n" + block)
    assert found.diagnostics == ()
    rapid = (found.kind == Kind.RAPID).tolist()[1:]
    heights = np.round(found.tip[1:, 2], 6).tolist()
    assert " ".join(f"{'R' if r else 'F'}{z:g}" for r, z in zip(rapid, heights, strict=True)) == expected


def test_cycles_go_on_until_they_are_cancelled(run: Runner) -> None:
    found = run(BEFORE + "G99 G81 X1 Y1 Z-10 R2\nX2\nY5 Z-12\nG80\nG0 X9\nG91 G98 G81 X1 Z-4 R-3 L3\nG80")
    assert found.diagnostics == ()
    deep = found.tip[found.kind == Kind.LINEAR]
    close(deep, [[1, 1, -10], [2, 1, -10], [2, 5, -12], [10, 5, -5], [11, 5, -5], [12, 5, -5]])
