"""Fidia programs: the published one, planes of the present rotary position, its own cycles."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.locations import TESTS
from tests.support.reading import Runner, close
from tests.support.run_comparison import same
from trunnion.arrays import Floats
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program
from trunnion.readers.families.fidia.interpreter import FidiaInterpreter

GOLDEN = TESTS / "golden" / "hs664rt"
MACHINE = load_machine("hs664rt")
FRESH = [HealthCheck.function_scoped_fixture]


def fidia(run: Runner, text: str, **more: object) -> Run:
    """Run a text on the machine."""
    return run(text, MACHINE, **more)


def table(a: float, c: float) -> Floats:
    """What the table turns a direction of the machine to, seen from the part: Rz(C) Rx(A)."""
    sa, ca, sc, cc = (f(math.radians(v)) for v in (a, c) for f in (math.sin, math.cos))
    about_x = np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]])
    return np.asarray(np.array([[cc, -sc, 0], [sc, cc, 0], [0, 0, 1]]) @ about_x)


def holes() -> list[tuple[Floats, Floats]]:
    """Position and axis of every hole of the CL file, by a plain look at its text."""
    found = []
    axis = np.zeros(3)
    drilling = False
    for line in (GOLDEN / "radial_holes.cls").read_text().splitlines():
        drilling = line.startswith("CYCLE/DRILL") or (drilling and not line.startswith("CYCLE/OFF"))
        if line.startswith("GOTO/"):
            numbers = np.array([float(text) for text in line.removeprefix("GOTO/").split(",")])
            axis = numbers[3:] if len(numbers) == 6 else axis
            if drilling:
                found.append((numbers[:3], axis))
    return found


def test_the_published_program_drills_the_holes_of_its_cl_file() -> None:
    run = run_program(GOLDEN / "radial_holes.expected.txt", MACHINE)
    assert run.diagnostics == ()
    cycles = [
        k + 1 for k, line in enumerate((GOLDEN / "radial_holes.expected.txt").read_text().splitlines()) if "G83" in line
    ]
    assert len(cycles) == len(holes()) == 4
    for block, (top, axis) in zip(cycles, holes(), strict=True):
        rows = run.line == block
        tips, cut = run.tip[rows], run.kind[rows] == int(Kind.LINEAR)
        close(run.axis[rows], np.tile(axis, (rows.sum(), 1)), atol=2e-5)
        heights = (tips - top) @ axis
        # Everything happens on the line of the hole: from 18 mm over it at rapid, from 3 mm at feed, down to -2 mm.
        close(tips - top - heights[:, None] * axis, np.zeros_like(tips), atol=2e-3)
        assert heights[cut].tolist() == pytest.approx([2.0, 1.0, 0.0, -1.0, -2.0], abs=2e-3)
        assert heights[-1] == pytest.approx(18.0, abs=2e-3)
        assert heights[~cut].min() >= -1.0
        assert set(run.feed[rows][cut]) == {70.0}
    others = ~np.isin(run.line, cycles)
    assert set(run.feed[others]) == {3000.0}
    assert [event.value for event in run.events if event.kind == "tool_change"] == ["1"]
    assert [event.kind for event in run.events][-3:] == ["coolant", "retract", "end"]


@settings(max_examples=examples(30), suppress_health_check=FRESH)
@given(a=st.floats(-105, 105), c=st.floats(-180, 540), x=st.floats(-50, 50), y=st.floats(-50, 50), z=st.floats(-50, 50))
def test_g154_takes_the_plane_of_the_present_rotary_position(
    a: float, c: float, x: float, y: float, z: float, run: Runner
) -> None:
    a, c, x, y, z = (round(value, 3) for value in (a, c, x, y, z))
    got = fidia(run, f"G1 A{a:.3f} C{c:.3f} F3000\nG154\nX{x:.3f} Y{y:.3f} Z{z:.3f}\nA0. C0.\nG69\nX1. Y2. Z3.\n")
    assert got.diagnostics == ()
    turn = table(a, c)
    close(got.tip[1], turn @ np.array([x, y, z]), atol=1e-9)
    close(got.axis[1], turn[:, 2], atol=1e-9)
    # The slides stand still while the axes turn, and then the spindle nose goes to their own positions.
    slides = [MACHINE.column(name) for name in "XYZ"]
    close(got.joints[2, slides], got.joints[1, slides], atol=1e-9)
    close(got.joints[3, slides] + MACHINE.spindle_point, [1.0, 2.0, 3.0], atol=1e-9)


def test_centres_are_absolute(run: Runner) -> None:
    got = fidia(run, "G0 X10. Y5. Z0.\nG2 X20. Y-5. I10. J-5. F500\nG3 X10. Y5. I20. J5.\nG18 G2 X10. Z0 I15. K0\n")
    assert [Kind(kind) for kind in got.kind] == [Kind.RAPID, Kind.ARC, Kind.ARC, Kind.ARC]
    close(got.arcs.centre, [[10, -5, 0], [20, 5, 0], [15, 5, 0]], atol=1e-12)
    assert got.diagnostics == ()
    assert fidia(run, "G2 X1. Y1. I1. F9\n").errors


def test_tcp_is_switched(run: Runner) -> None:
    got = fidia(run, "G0 X5. Y6. Z7.\nG196\nG1 X1. Y2. Z3. A20. C30. F9\nG197\nG0 X5.\n")
    assert got.tcp.tolist() == [False, True, False]
    close(got.tip[1], [1.0, 2.0, 3.0], atol=1e-9)
    assert got.diagnostics == ()


CYCLES = {
    "G81 X1. Z20. R2. E-5. F90": [(0, 20), (0, 2), (1, -5), (0, 20)],
    "G82 X1. Z20. R2. E-5. H1.5 F90": [(0, 20), (0, 2), (1, -5), (0, 20)],
    "G83 X1. Z20. R2. E-5. D3. F90": [
        (0, 20),
        (0, 2),
        (1, -1),
        (0, 2),
        (0, 0),
        (1, -4),
        (0, 2),
        (0, -3),
        (1, -5),
        (0, 20),
    ],
    "G84 X1. Z20. R2. E-5. F90": [(0, 20), (0, 2), (1, -5), (1, 2), (0, 20)],
    "G85 X1. Z20. R2. E-5. F90": [(0, 20), (0, 2), (1, -5), (1, 2), (0, 20)],
    "G86 X1. Z2. R2. E-5. F90": [(0, 2), (1, -5), (0, 2)],
    "G89 X1. Z20. R20. E-5. H1 F90": [(0, 20), (1, -5), (1, 20)],
}


@pytest.mark.parametrize("block", CYCLES)
@pytest.mark.parametrize("start", [50.0, 0.0])
def test_cycles_mean_their_words_in_fidias_way(block: str, start: float, run: Runner) -> None:
    got = fidia(run, f"G0 X0 Z{start}\n{block}\nX2.\nG80\nX3.\n")
    assert got.diagnostics == ()
    for line in (2, 3):
        rows = got.line == line
        motions = list(zip(got.kind[rows].tolist(), got.tip[rows][:, 2].round(9).tolist(), strict=True))
        # First over the hole, on the higher one of both heights.
        begin = next(k for k, motion in enumerate(motions) if motion[1] == float(CYCLES[block][0][1]))
        assert [m for k, m in enumerate(motions[begin:]) if k == 0 or m != motions[begin:][k - 1]] == [
            (kind, float(height)) for kind, height in CYCLES[block]
        ]
        down = got.tip[rows][got.kind[rows] == 1]
        assert set(down[:, 0].tolist()) == {float(line - 1)}
    assert got.line[-1] == 5


def test_what_is_not_known_is_named(run: Runner) -> None:
    got = fidia(
        run,
        "G93 X1. F2\nG21 X1.\nG41 D1\nX#1\nG83 X1. Z5. R2. F9\nG80\nT3\nX1. K2.\nG200\nG83 X1. Z1. R2. E3. D1.\nG80\n"
        "B5.\nG55 O100\nG22 X1. Y1. I0 J0 P90\n",
    )
    assert sorted({finding.line for finding in got.diagnostics}) == [1, 2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14]


words = st.sampled_from(
    [
        "G0", "G1", "G00", "g01", "G2", "G 1", "G90", "G91", "G70", "G71", "G55 O1", "X1", "X-.5", "Y+2.", "Z 3.",
        "A10.", "C-20.5", "C 400", "B5", "F100", "F0", "S5", "M3", "I1.", "R3.", "N7", "N08", "X1X2", "X", "1",
        ".", "-", "(c)", "(c", "/", "%", "X1.2.3", "X1 2", "G154", "G69", "G196", "G197", "G80", "G81 Z9. E1. R3.",
    ]
)  # fmt: skip


@settings(max_examples=examples(60), suppress_health_check=FRESH)
@given(lines=st.lists(st.lists(words, max_size=5).map(" ".join), max_size=8), glue=st.booleans())
def test_the_kernel_and_the_interpreter_read_any_words_alike(
    lines: list[str], glue: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "G1 F100\n" + "\n".join(lines)
    path = tmp_path / "p.txt"
    path.write_text(re.sub(" ", "", text) if glue else text)
    fast = run_program(path, MACHINE)
    with monkeypatch.context() as patch:
        patch.setattr(FidiaInterpreter, "_may_scan", lambda *_: False)
        slow = run_program(path, MACHINE)
    assert sorted(map(str, fast.diagnostics)) == sorted(map(str, slow.diagnostics))
    for one in (fast, slow):
        object.__setattr__(one, "diagnostics", ())
    same(fast, slow)


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("G1 X1. C350. F100\nX2. C357.\nX3. C0.\nX4. C9.\nX5. C357.\n", [2, 4, 6]),
        ("G1 X1. C350. F100\nX2. C10. A5.\nG0 X3. C350.\nG1 X4. C0. A9.\n", [2, 3, 5]),
        ("G1 X1. C10. F100\nX2. C180.\nX3. C350.\nX4. C200.\nX5. C50.\n", []),
    ],
)
def test_a_cut_that_passes_the_end_of_a_turn_is_noted(run: Runner, text: str, lines: list[int]) -> None:
    got = fidia(run, f"G196\n{text}G197\n")
    assert [each.line for each in got.diagnostics if each.code == "NC342"] == lines


def test_a_control_without_arithmetic_takes_no_operators(run: Runner) -> None:
    for block in ("X[1+2]", "X[SIN[3]]", "X[1*2]", "X[[1]"):
        assert fidia(run, f"G0 {block}\nM30").errors


@pytest.mark.parametrize("block", ["X[1]", "X[-1]", "X-[1]", "X#1", "X--1", "X+-1"])
def test_a_control_without_expressions_takes_numbers_alone(run: Runner, block: str) -> None:
    assert fidia(run, f"G0 {block}\nM30").errors
