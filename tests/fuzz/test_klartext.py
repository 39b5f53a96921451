"""Klartext programs from anybody: run or refused, whatever they hold, and always at an end."""

import random
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples, seeds_of
from tests.support.fuzz import klartext
from tests.support.fuzz.mangle import mangle
from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with subprograms in it."""
    path = tmp_path_factory.mktemp("klartext")
    klartext.prepare(path)
    (path.parent / "SECRET.H").write_text("L X+666\n")
    return path


@st.composite
def _grown(draw: st.DrawFn) -> bytes:
    """A program of sound pieces, put together without sense."""
    return klartext.program(draw(st.integers(1, 25)), lambda choices: draw(st.sampled_from(choices))).encode()


@settings(max_examples=examples(100))
@given(data=_grown(), key=st.sampled_from(klartext.MACHINES))
def test_a_program_of_random_words_is_run_or_refused(folder: Path, data: bytes, key: str) -> None:
    klartext.judge(data, folder, key)


@settings(max_examples=examples(40))
@given(text=st.text(alphabet="LCXYZABQFMRDNPT0123456789+-.,=;:~\"'*/()<>ENDIFORGOT_ \n\r\t", max_size=300))
def test_random_letters_of_the_language_are_run_or_refused(folder: Path, text: str) -> None:
    klartext.judge(text.encode(), folder, "dmu65")


@settings(max_examples=examples(25))
@given(data=st.binary(max_size=400))
def test_random_bytes_are_run_or_refused(folder: Path, data: bytes) -> None:
    klartext.judge(data, folder, "dmu65")


@pytest.mark.parametrize("seed", seeds_of(20))
def test_mangled_programs_are_run_or_refused(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(20):
        data = mangle(rng.choice(klartext.SOUND), klartext.SOUND, rng)
        klartext.judge(data, folder, rng.choice(klartext.MACHINES))


@pytest.mark.parametrize("data", klartext.SOUND)
def test_what_is_mangled_is_understood_when_it_is_whole(folder: Path, data: bytes) -> None:
    run = klartext.judge(data, folder, "dmu65")
    assert run is not None
    delta = ["DL adds 0.1 mm to the tool: the path is that without it"] if b"DL+0.1" in data else []
    found = [finding.text for finding in run.diagnostics]
    assert [text for text in found if not text.startswith("ends with a datum")] == delta


STOPPED = "(more than [0-9]+ (blocks|motions in cycles and curves)|no condition ends it); does it end"

ENDLESS = {
    "a jump back": "LBL 1\nL IX+1\nFN 9: IF +1 EQU +1 GOTO LBL 1",
    "repeats of repeats": "LBL 1\nLBL 2\nL IX+1\nCALL LBL 2 REP 60000\nCALL LBL 1 REP 60000",
    "a repeat by name": 'LBL "A"\nCALL LBL "A" REP 65000',
    "plain blocks without end": "LBL 1\n" + "L X+1 Y+1\n" * 50 + "FN 9: IF +1 EQU +1 GOTO LBL 1",
    "drilling without end": "CYCL DEF 200 Q200=2 Q201=-20 Q206=1 Q202=.03 Q203=0\nM89\nLBL 1\nL IX+1\n"
    "FN 9: IF +1 EQU +1 GOTO LBL 1",
    "long comments without end": "LBL 1\n;" + "x" * 4000 + "\nFN 9: IF +1 EQU +1 GOTO LBL 1",
}


@pytest.mark.third
@pytest.mark.parametrize("text", ENDLESS.values(), ids=ENDLESS.keys())
def test_a_program_without_end_is_stopped_with_a_message(folder: Path, text: str) -> None:
    path = folder / "MAIN.H"
    path.write_text(text)
    with pytest.raises(InputError, match=STOPPED):
        run_program(path, load_machine("dmu65"), RunOptions(step_limit=3000))


DEEP = {
    "a label that calls itself": "LBL 1\nCALL LBL 1\nLBL 0",
    "a program that calls itself": "CALL PGM SELF",
    "this program": "CALL PGM MAIN",
}


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP.keys())
def test_calls_inside_calls_have_an_end(folder: Path, text: str) -> None:
    path = folder / "MAIN.H"
    path.write_text(text)
    with pytest.raises(InputError, match="deeper than"):
        run_program(path, load_machine("dmu65"), RunOptions(subprograms=sorted(folder.glob("*.H"))))


BOUNDED = {
    "positions far away": "L X+99999999999",
    "pecks without number": "CYCL DEF 200 Q200=2 Q201=-20000 Q206=1 Q202=.003 Q203=0\nL X+1 M99",
    "turns of a helix": "CC X+0 Y+0\nL X+5\nCP IPA+999999999 DR+",
    "parameters without end": "Q1 = 99999\nQ1 = Q1 * Q1\nQ1 = Q1 * Q1",
    "powers": "Q1 = 99999 ^ 99999",
    "parentheses": "Q1 = " + "(" * 1000 + "1" + ")" * 1000,
    "functions of functions": "Q1 = " + "SIN " * 500 + "1",
    "signs": "Q1 = " + "-" * 2000 + "1",
    "a scale of nothing": "CYCL DEF 11.0\nCYCL DEF 11.1 SCL0\nL X+1",
    "a scale larger than anything": "CYCL DEF 26.0\nCYCL DEF 26.1 X9999999 Y0.00001\nL X+99999",
    "a long word": "L X" + "1" * 3000,
    "a long line": "L X+1 " + "Y+1 " * 3000,
    "a block of many lines": "CYCL DEF 200 ~\n" + "Q200=1 ~\n" * 2000 + "Q201=1",
    "a block that never ends": "L X+1 ~",
    "a retract without end": "M140 MB9999999999",
    "files outside": "CALL PGM ../SECRET",
    "files outside, as the control names them": "CALL PGM TNC:\\..\\SECRET.H",
    "no such file": "CALL PGM /etc/passwd",
}


@pytest.mark.third
@pytest.mark.parametrize("text", BOUNDED.values(), ids=BOUNDED.keys())
def test_numbers_and_depths_without_sense_are_named(folder: Path, text: str) -> None:
    run = klartext.judge(text.encode(), folder, "dmu65", limit=5000)
    assert run is not None
    assert run.diagnostics or text == "L X+1 ~"
    assert 666.0 not in run.joints


LARGE = {
    "comments": b";\n" * 20_000,
    "unknown words": b"QUX 5\n" * 12_000,
    "NUL bytes": b"\0" * 300_000,
    "labels": b"".join(b"LBL %d\n" % k for k in range(5_000)) + b"CALL LBL 7\n",
    "parameters": b"".join(b"Q%d = %d\n" % (k, k) for k in range(5_000)),
    "motion": b"".join(b"L X%d Y1\n" % (k % 1000) for k in range(50_000)),
}


@pytest.mark.third
@pytest.mark.parametrize("data", LARGE.values(), ids=LARGE.keys())
def test_memory_grows_with_the_program_and_no_faster(folder: Path, data: bytes) -> None:
    klartext.judge(data[:100], folder, "dmu65")
    tracemalloc.start()
    try:
        klartext.judge(data, folder, "dmu65")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak <= (40 << 20) + 400 * len(data)


@pytest.mark.third
@pytest.mark.parametrize("seed", range(10))
def test_a_program_runs_twice_alike(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    data = mangle(rng.choice(klartext.SOUND), klartext.SOUND, rng)
    one, two = klartext.judge(data, folder, "dmu65"), klartext.judge(data, folder, "dmu65")
    assert (one is None) == (two is None)
    if one is not None and two is not None:
        assert one.diagnostics == two.diagnostics
        assert one.events == two.events
        for name in ("line", "kind", "tip", "axis", "joints", "feed", "tool", "programmed"):
            np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
