"""The kernels against their reference implementations; for the scan kernel that is the interpreter itself."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.locations import TESTS
from tests.support.naive import reading as naive
from tests.support.run_comparison import same
from trunnion.errors import InputError
from trunnion.machines import forward, load_machine
from trunnion.model import axis_positions
from trunnion.model.run import Run
from trunnion.model.subdivision import circle_points
from trunnion.readers import run_program
from trunnion.readers.families.sinumerik.interpreter import SinumerikInterpreter
from trunnion.readers.program.options import RunOptions

YL569 = load_machine("yl569")
GOLDEN = sorted((TESTS / "golden" / "yl569").glob("*.mpf"))


SETTINGS = settings(
    deadline=None, max_examples=examples(50), suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def twice(path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Run, Run]:
    """Run a program with and without the scan kernel."""
    fast = run_program(path, YL569)
    with monkeypatch.context() as patch:
        patch.setattr(SinumerikInterpreter, "_may_scan", lambda *_: False)
        return fast, run_program(path, YL569)


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_the_kernel_and_the_interpreter_read_golden_programs_alike(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    same(*twice(path, monkeypatch))


words = st.sampled_from(
    [
        "G0", "G1", "G00", "G01", "G2", "G3", "G90", "G91", "G54", "G4 F1", "X1", "X-.5", "Y+2.50", "Y=3", "Z0.001",
        "X12345678901.5", "Z=1+1", "B10", "C-20.5", "C400", "B=IC(1)", "F100", "F.5", "F=7", "S5", "M3", "A3=.1",
        "B3=-.2", "C3=1", "A3=0", "TRAORI", "TRAFOOF", "TRANS X1", "AROT Z30", "I1", "CR=3", "N7", "N08", "R1=2",
        "X1X2", "X", "1", "=", ".", "-", "+", ";c", "; X1", "/", "SUPA", "G1.0", "X5DIV", "X1.2.3", "A5", "D1", "\t",
        "X=5 MOD 3", "Y5-3", "X5 -3", "B_", "FOO", "G", "N", "C3", "C3=", "C3=1.5X2", "Z1;", "x3", "g1", "c3=.5",
    ]
)  # fmt: skip


@SETTINGS
@given(lines=st.lists(st.lists(words, max_size=5).map(" ".join), max_size=8), glue=st.booleans())
def test_the_kernel_and_the_interpreter_read_any_words_alike(
    lines: list[str], glue: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "\n".join(lines)
    path = tmp_path / "P.MPF"
    path.write_text(text.replace(" ", "") if glue else text)
    same(*twice(path, monkeypatch))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder for the programs of many examples."""
    return tmp_path_factory.mktemp("programs")


@settings(deadline=None, max_examples=examples(120))
@given(value=st.floats(-99999, 99999), decimals=st.integers(0, 9))
def test_numbers_are_read_to_the_last_bit(
    value: float, decimals: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = f"{value:.{decimals}f}"
    path = tmp_path_factory.getbasetemp() / "NUMBER.MPF"
    path.write_text(f"G1 X{text}\n")
    assert run_program(path, YL569).joints[0, YL569.column("X")] == float(text)


ways = st.sampled_from(["plain", "shortest", "positive", "negative", "turn"])
CODES = {
    "plain": axis_positions.PLAIN,
    "shortest": axis_positions.SHORTEST,
    "positive": axis_positions.POSITIVE_DIRECTION,
    "negative": axis_positions.NEGATIVE_DIRECTION,
    "turn": axis_positions.SAME_TURN,
}
angles = st.integers(-20000, 20000).map(lambda n: n / 7.0)


@settings(deadline=None, max_examples=examples(120))
@given(held=angles, value=st.one_of(st.none(), angles), turn_rule=ways, lowest=st.sampled_from([0.0, -180.0]))
def test_rotary_words_reach_the_turn_that_the_twin_finds(
    held: float, value: float | None, turn_rule: str, lowest: float
) -> None:
    got = axis_positions.rotary_position(held, math.nan if value is None else value, CODES[turn_rule], lowest)
    assert got == pytest.approx(naive.angle_reached(held, value, turn_rule, lowest), abs=1e-8)


@settings(deadline=None, max_examples=examples(50))
@given(
    b=st.lists(st.floats(1.0, 95.0), min_size=1, max_size=6),
    c=st.lists(st.floats(-170.0, 170.0), min_size=6, max_size=6),
)
def test_vectors_are_followed_on_the_near_branch(b: list[float], c: list[float]) -> None:
    joints = np.zeros((len(b), 5))
    joints[:, YL569.column("B")], joints[:, YL569.column("C")] = b, np.cumsum(c[: len(b)])
    axis = forward(YL569, joints)[1]
    rotary = np.full((len(b), 2), np.nan)
    status = np.zeros(len(b), np.uint8)
    words = axis_positions.RotaryWords(rotary, np.zeros(len(b), np.uint8), axis)
    axis_positions.resolve_angles(YL569, words, np.zeros(2), status)
    got = np.zeros((len(b), 5))
    got[:, list(YL569.rotary)] = rotary
    np.testing.assert_allclose(forward(YL569, got)[1], axis, atol=1e-9)
    assert not status.any()
    # B cannot go below -11, so from 11 on there is one branch; C is then never more than half a turn away.
    if min(b) > 11.5:
        np.testing.assert_allclose(got[:, YL569.column("C")], joints[:, YL569.column("C")], atol=1e-6)


@settings(deadline=None, max_examples=examples(50))
@given(
    angle=st.floats(0.1, 6.2),
    radius=st.floats(0.1, 100.0),
    rise=st.floats(-10.0, 10.0),
    turns=st.integers(0, 3),
    fraction=st.floats(0.0, 1.0),
)
def test_points_on_circles(angle: float, radius: float, rise: float, turns: int, fraction: float) -> None:
    centre = np.array([1.0, 2.0, 3.0])
    normal = np.array([2.0, -1.0, 2.0]) / 3.0
    x = np.array([1.0, 2.0, 0.0]) / math.sqrt(5.0)
    y = np.cross(normal, x)
    start = centre + radius * x
    end = centre + radius * (math.cos(angle) * x + math.sin(angle) * y) + rise * normal
    got = circle_points(start[None], end[None], centre[None], normal[None], np.array([turns]), np.array([fraction]))[0]
    np.testing.assert_allclose(got, naive.point_on_circle(start, end, centre, normal, turns, fraction), atol=1e-8)


mutations = st.lists(
    st.tuples(
        st.integers(0, 10_000), st.sampled_from(["delete", "insert", "replace", "double"]), st.binary(max_size=4)
    ),
    max_size=12,
)


@settings(deadline=None, max_examples=examples(60), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(which=st.integers(0, 3), changes=mutations)
def test_damaged_programs_give_a_run_or_an_input_error(
    which: int, changes: list[tuple[int, str, bytes]], tmp_path: Path
) -> None:
    seeds = [path.read_bytes()[-2500:] for path in GOLDEN] + [
        b"R1=1\nFOR R2=1 TO 3\nIF R2==2\nMCALL CYCLE83(9,0,1,-9,,-3,,1)\nX=R2*(1+SIN(30))\nMCALL\nELSE\nGOTOF N9\n"
        b"ENDIF\nN9 AROT X10 Y=R2\nG2 X1 Y1 CR=5 TURN=2\nENDFOR\nREPEAT\nR1=R1+1\nUNTIL R1>5\n"
        b"CASE R1 OF 6 GOTOF E_1\nE_1:\n"
        b'TRAORI\nX1 A3=.5 C3=1\nCYCLE800(0,"",0,57,0,0,0,10,20,30,0,0,0,1)\nL1 P2\nSUPA Z0\nC=ACN(4)\nM30\n'
    ]
    data = bytearray(seeds[which])
    for place, change, extra in changes:
        at = place % (len(data) + 1)
        if change == "delete":
            del data[at : at + 3]
        elif change == "insert":
            data[at:at] = extra
        elif change == "replace":
            data[at : at + len(extra)] = extra
        else:
            data[at:at] = data[at : at + 40]
    path = tmp_path / "P.MPF"
    path.write_bytes(bytes(data))
    try:
        run = run_program(path, YL569, RunOptions(step_limit=3000))
    except InputError:
        return
    assert len(run.tip) == len(run) == len(run.tool)
    assert np.isfinite(run.tip).all()
    assert np.isfinite(run.joints).all()


@settings(deadline=None, max_examples=examples(50), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=300))
def test_any_bytes_give_a_run_or_an_input_error(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "P.MPF"
    path.write_bytes(data)
    try:
        run_program(path, YL569, RunOptions(step_limit=1000))
    except InputError:
        return
