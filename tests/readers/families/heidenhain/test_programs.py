"""Random programs against their naive counterparts, and the kernel against the interpreter."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext_reading import of_blocks
from tests.support.machines import at_zero
from tests.support.naive import klartext as naive
from tests.support.naive import reading as angles
from tests.support.reading import close
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program
from trunnion.readers.families.heidenhain.interpreter import HeidenhainInterpreter

DMU65 = at_zero("dmu65")


def ran(text: str, factory: pytest.TempPathFactory) -> Run:
    """Run a text."""
    path = factory.getbasetemp() / "PROGRAM.H"
    path.write_text(text)
    return of_blocks(run_program(path, DMU65))


@settings(max_examples=examples(80), deadline=None)
@given(program=naive.programs())
def test_blocks_lead_where_the_twin_says(program: naive.Program, tmp_path_factory: pytest.TempPathFactory) -> None:
    run = ran("\n".join(program.lines), tmp_path_factory)
    # A shift behind the last motion is left to the next program.
    assert all(found.code == "NC351" and any(program.shift) for found in run.diagnostics)
    assert len(run) == len(program.rows)
    if not len(run):
        return
    wanted = np.array(program.rows)
    close(run.tip, wanted[:, :3], atol=1e-9)
    np.testing.assert_array_equal(run.feed, wanted[:, 3])
    np.testing.assert_array_equal(run.kind == Kind.RAPID, wanted[:, 4] > 0)


poses = st.lists(
    st.tuples(
        *[st.integers(-50_000, 50_000).map(lambda n: n / 1000.0)] * 3,
        st.integers(-90_000, 0).map(lambda n: n / 1000.0),
        st.integers(-720_000, 720_000).map(lambda n: n / 1000.0),
    ),
    min_size=1,
    max_size=8,
)


@settings(max_examples=examples(40), deadline=None)
@given(poses=poses, shorter=st.booleans(), word=st.sampled_from(["M128", "FUNCTION TCPM F TCP AXIS POS"]))
def test_with_tcp_the_tip_is_what_is_programmed(
    poses: list[tuple[float, ...]], shorter: bool, word: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    lines = ["M126" if shorter else "M127", word]
    lines += [f"L X{x:+.3f} Y{y:+.3f} Z{z:+.3f} A{a:+.3f} C{c:+.3f} F900" for x, y, z, a, c in poses]
    run = ran("\n".join(lines), tmp_path_factory)
    assert run.diagnostics == ()
    table = np.array(poses)
    close(run.tip, table[:, :3], atol=1e-9)
    held = 0.0
    for k, (_, _, _, a, c) in enumerate(poses):
        before, held = held, angles.angle_reached(held, c, "shortest" if shorter else "plain")
        reached = float(run.joints[k, DMU65.column("C")])
        # Either way round is half a turn: which one is a matter of the last bit.
        half = shorter and abs(abs(held - before) - 180.0) < 1e-9
        assert reached == pytest.approx(held, abs=1e-9) or (half and abs(abs(reached - held) - 360.0) < 1e-9)
        held = reached
        # u = Rz(C) Rx(A) z
        sine, cosine = math.sin(math.radians(a)), math.cos(math.radians(a))
        turned = math.radians(c)
        close(run.axis[k], [sine * math.sin(turned), -sine * math.cos(turned), cosine], atol=1e-12)
    assert run.tcp.all()


words = st.sampled_from(
    [
        "L", "L ", "X1", "Y-2.5", "Z+.5", "Z,5", "Z 25.000", "X", "X+", "A-30", "C+45", "C 7", "B2", "F100", "F 100",
        "FMAX", "F MAX", "FAUTO", "R0", "RL", "R5", "R0.", "IX1", "M3", "M99", ";c", "; a ~", "~", "X1.2.3", "x4",
        "fmax", "FQ1", "X1234567890123456", "X123456", "Y1,2,3", "1", "12", "/", "*", "-", "DR+", "LN", "TX.6",
        "TY-.8", "TZ 1", "TX0", "NZ1", "NX.5", "CC X1", "X1Y2", "F9Z1", "M128", "M129", "M126", "M89",
        "PLANE SPATIAL SPA-9 SPB0 SPC30 STAY", "PLANE RESET STAY", "BEGIN PGM A INCH", "CYCL DEF 7.1 X+3",
        "CYCL DEF 10.1 ROT30",
    ]
)  # fmt: skip


@settings(max_examples=examples(100), deadline=None)
@given(
    lines=st.lists(st.tuples(st.sampled_from(["", "L ", "LN "]), st.lists(words, max_size=6)), max_size=8),
    numbered=st.booleans(),
    tcp=st.booleans(),
)
def test_the_kernel_and_the_interpreter_read_any_words_alike(
    lines: list[tuple[str, list[str]]], numbered: bool, tcp: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    texts = [begun + " ".join(said) for begun, said in lines]
    text = "\n".join(f"{k} {line}" if numbered else line for k, line in enumerate(["M128" if tcp else "", *texts]))
    fast = ran(text, tmp_path_factory)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(HeidenhainInterpreter, "_may_scan", lambda *_: False)
        slow = ran(text, tmp_path_factory)
    assert fast.diagnostics == slow.diagnostics
    assert fast.events == slow.events
    assert fast.comments == slow.comments
    for name in ("line", "block_number", "kind", "programmed", "xyz", "rotary", "tip", "axis", "joints", "feed", "tcp"):
        np.testing.assert_array_equal(getattr(fast, name), getattr(slow, name), err_msg=name)


@settings(max_examples=examples(80), deadline=None)
@given(value=st.floats(-99999, 99999), decimals=st.integers(0, 9))
def test_numbers_are_read_to_the_last_bit(
    value: float, decimals: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = f"{value:.{decimals}f}"
    run = ran(f"L X{text}", tmp_path_factory)
    assert run.joints[0, DMU65.column("X")] == float(text)


def test_chunks_of_a_long_program_are_one_program(tmp_path: Path) -> None:
    path = tmp_path / "LONG.H"
    path.write_text("".join(f"{k} L X{k % 97} Y{k % 89} F{k % 7 + 1}\n" for k in range(60_000)))
    run = of_blocks(run_program(path, DMU65))
    assert run.diagnostics == ()
    k = np.arange(60_000)
    np.testing.assert_array_equal(run.tip[:, 0], k % 97)
    np.testing.assert_array_equal(run.block_number, k)
    np.testing.assert_array_equal(run.feed, k % 7 + 1)
