"""Programs from anybody: run or refused, whatever they hold, and always at an end."""

import random
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples, seeds_of
from tests.support.fuzz import oracle, pieces, seeds
from tests.support.fuzz.mangle import mangle
from trunnion.errors import InputError
from trunnion.model.run import Run
from trunnion.model.subdivision import subdivide
from trunnion.readers.families.sinumerik.interpreter import SinumerikInterpreter
from trunnion.readers.families.sinumerik.text import SinumerikText
from trunnion.readers.program.limits import MAX_SUBPROGRAMS
from trunnion.readers.program.options import RunOptions


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with subprograms in it."""
    path = tmp_path_factory.mktemp("programs")
    oracle.prepare(path)
    return path


@st.composite
def _grown(draw: st.DrawFn) -> bytes:
    """A program of sound pieces, put together without sense."""
    return pieces.program(draw(st.integers(1, 25)), lambda choices: draw(st.sampled_from(choices))).encode()


@settings(max_examples=examples(60))
@given(data=_grown(), key=st.sampled_from(oracle.MACHINES))
def test_a_program_of_random_words_is_run_or_refused(folder: Path, data: bytes, key: str) -> None:
    oracle.judge_program(data, folder, key)


@settings(max_examples=examples(40))
@given(data=st.binary(max_size=400))
def test_random_bytes_are_run_or_refused(folder: Path, data: bytes) -> None:
    oracle.judge_program(data, folder)


@settings(max_examples=examples(40))
@given(text=st.text(alphabet="NXYZGRLM0123456789=()[]\"';,.+-*/<>ENDIFORGOT_$ \n\r\t", max_size=300))
def test_random_letters_of_the_language_are_run_or_refused(folder: Path, text: str) -> None:
    oracle.judge_program(text.encode(), folder)


@pytest.mark.parametrize("seed", seeds_of(20))
def test_mangled_programs_are_run_or_refused(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(20):
        oracle.judge_program(mangle(rng.choice(seeds.programs()), seeds.programs(), rng), folder)


@pytest.mark.third
@pytest.mark.parametrize("data", sorted(set(seeds.programs()) - {seeds.SUBPROGRAMS["SELF.SPF"]}))
def test_what_is_mangled_is_read_when_it_is_whole(folder: Path, data: bytes) -> None:
    assert oracle.judge_program(data, folder) is not None


@pytest.mark.third
@pytest.mark.parametrize("seed", range(30))
def test_a_program_runs_twice_alike(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    data = mangle(rng.choice(seeds.programs()), seeds.programs(), rng)
    one, two = oracle.judge_program(data, folder), oracle.judge_program(data, folder)
    assert (one is None) == (two is None)
    if one is not None and two is not None:
        assert one.diagnostics == two.diagnostics
        assert one.events == two.events
        for name in ("line", "kind", "tip", "axis", "joints", "feed", "tool", "programmed"):
            np.testing.assert_array_equal(getattr(one, name), getattr(two, name))


# The end

STOPPED = "(more than [0-9]+ (blocks|motions in cycles and curves)|no condition ends it); does it end"

ENDLESS = {
    "a loop to a number that counting never reaches": "FOR R1=0 TO 1EX299\nX1\nENDFOR",
    "counting that no longer changes the number": "FOR R1=1EX298 TO 1EX299\nENDFOR",
    "a condition that always holds": "WHILE TRUE\nENDWHILE",
    "a condition that is no number": 'MARK: IF 1 GOTOB MARK\nX="A"',
    "a jump back": "MARK: X1\nGOTOB MARK",
    "a jump to the start": "X1\nGOTOS",
    "loops inside loops": "LOOP\n" * 60 + "X1\n" + "ENDLOOP\n" * 60,
    "a loop variable that the loop sets back": "DEF INT _I\nFOR _I=1 TO 5\n_I=1\nENDFOR",
    "a subprogram many times": "L10 P999999999",
    "a subprogram at every position, without end": "MCALL L10\nLOOP\nX1\nENDLOOP",
    "drilling without end": "MCALL CYCLE83(50,0,2,-20,,-.03,,0)\nLOOP\nX1\nX2\nENDLOOP",
    "plain blocks without end": "LOOP\n" + "X1 Y1\nX2 Y2\n" * 100 + "ENDLOOP",
    "long comments without end": "LOOP\n;" + "x" * 50_000 + "\nENDLOOP",
    "long blocks without end": "LOOP\nR1=" + "1+" * 2000 + "1\nENDLOOP",
    "long comments between plain blocks without end": "LOOP\n" + ("X1;" + "x" * 5000 + "\nX2\n") * 5 + "ENDLOOP",
}


@pytest.mark.third
@pytest.mark.parametrize("text", ENDLESS.values(), ids=ENDLESS.keys())
def test_a_program_without_end_is_stopped_with_a_message(folder: Path, text: str) -> None:
    path = folder / "MAIN.MPF"
    path.write_text(text)
    with pytest.raises(InputError, match=STOPPED) as caught:
        interpreter_run(path, 3000)
    (problem,) = caught.value.problems
    assert Path(problem.file).parent == folder
    assert problem.line > 0


TALKATIVE = {
    "messages": "LOOP\n" + 'MSG("A")' * 400 + "\nENDLOOP",
    "stops": "LOOP\n" + "M1" * 500 + "\nENDLOOP",
    "tools with ever new names": 'LOOP\nR1=R1+1\nT="A"<<R1 T="B"<<R1 T="C"<<R1\nENDLOOP',
    "comments": "LOOP\n;1\n;2\n;3\nENDLOOP",
    "comments of plain blocks": "LOOP\n" + "X1;abc\n" * 50 + "ENDLOOP",
    "long texts": 'DEF STRING[999] _S\n_S="' + "x" * 900 + '"\nLOOP\nMSG(_S<<R1)\nENDLOOP',
}


@pytest.mark.third
@pytest.mark.parametrize("text", TALKATIVE.values(), ids=TALKATIVE.keys())
def test_what_a_loop_says_is_bounded(folder: Path, text: str) -> None:
    assert oracle.judge_program(text.encode(), folder, limit=3000) is None


BOUNDED = {
    "repeating by labels": "MARK: X1\nENDE: X2\nREPEAT MARK ENDE P=1000000000",
    "turns of a circle": "G2 I5 TURN=1000000000",
    "turns that are no number": "G2 I5 TURN=1EX308",
    "pecks without number": "CYCLE83(50,0,2,-1EX6,,-.0001,,0)",
    "tapping pecks without number": "CYCLE84(50,0,2,-20,,0,3,,1,0,100,100,3,1,1,1,.000001)",
    "a huge circle": "G2 X1 CR=9999999",
    "a circle larger than that": "G2 X1 CR=1EX200",
    "a centre farther away than anything": "G2 X1 I1EX300",
    "an angle of nothing": "X1\nG2 X10 AR=1EX-323",
    "circles through points far away": "CIP X10 Y2 I1=1EX200 J1=1EX250",
    "positions far away": "X1EX300\nX=-1EX299*10\nG91\nX9999999\nX9999999",
    "a frame larger than anything": "TRANS X1EX308\nASCALE X1EX200\nASCALE X1EX200\nX1",
    "a frame smaller than anything": "ROT Y-.25\nASCALE X1EX-320\nX1\nSCALE X0\nX2",
    "angles without end": "ROT X1EX300 Y1EX300 Z1EX300\nX1\nAROT RPL=1EX308\nX2",
    "vectors without length": "TRAORI\nA3=0 B3=0 C3=0\nA3=1EX308 B3=1EX308 C3=1EX308\nA3=1EX-320",
    "quotients without end": "R1=1EX299 DIV 1EX-20\nR2=1EX299/1EX-20\nR3=1EX299 MOD 1EX-320",
    "a feed without end": "G700\nF=1EX308\nG1 X1",
    "a pitch without end": "S=1EX300\nCYCLE84(50,0,2,-20,,,3,,1EX100)",
    "turns of a rotary axis": "TRAORI\nC=1EX7\nC=DC(-1EX7)\nG91\nC1EX7\nC1EX7",
    "parentheses": "X=" + "(" * 4000 + "1" + ")" * 4000,
    "functions of functions": "X=" + "SIN(" * 600 + "1" + ")" * 600,
    "signs": "X=" + "-" * 3000 + "1",
    "indices of indices": "X=R" + "[R" * 300 + "[1]" + "]" * 300,
    "control structures": "IF 1\n" * 70 + "ENDIF\n" * 70,
    "arguments": "CYCLE81(" + "," * 4000 + ")",
    "a loop without its variable": "FOR R=0 TO 3\nX1\nENDFOR\nFOR =1 TO 2\nENDFOR\nFOR R[1,2]=0 TO 2\nENDFOR",
    "a long word": "X" + "1" * 4000 + "\n" + "A" * 4000,
    "a subprogram that calls itself": "SELF",
    "a program that calls itself": "MAIN",
    "variables without number": "DEF INT _I\nFOR _I=0 TO 900\n_A[_I,_I]=1\nENDFOR",
}


@pytest.mark.third
@pytest.mark.parametrize("text", BOUNDED.values(), ids=BOUNDED.keys())
def test_numbers_and_depths_without_sense_are_named(folder: Path, text: str) -> None:
    run = oracle.judge_program(text.encode(), folder, limit=5000)
    assert run is None or run.diagnostics or "CR=9999999" in text


def test_pieces_of_a_huge_circle_are_finite(folder: Path) -> None:
    run = oracle.judge_program(b"G2 X1 CR=9999999\nG3 I-1000000 TURN=999\nX2 I9999999", folder)
    assert run is not None
    samples = subdivide(run, 64)
    assert np.isfinite(samples.tip).all()
    assert np.isfinite(samples.joints).all()


def test_blocks_of_a_program_without_loops_are_never_too_many(folder: Path) -> None:
    data = b"".join(b"N%d M%d T%d X%d ;" % (k, k % 2 + 7, k, k) + b"c" * 300 + b"\n" for k in range(200))
    run = oracle.judge_program(data, folder, limit=0)
    assert run is not None
    assert len(run) == 200


def test_labels_of_a_subprogram_are_looked_for_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    searched: list[int] = []
    real = SinumerikText._match_structures

    def counted(text: SinumerikText) -> dict[int, tuple[int, int]]:
        searched.append(1)
        return real(text)

    monkeypatch.setattr(SinumerikText, "_match_structures", counted)
    oracle.judge_program(b"SUB\n" * 50, folder)
    assert len(searched) == 1


def test_a_program_calls_so_many_files_and_no_more(tmp_path: Path) -> None:
    for k in range(MAX_SUBPROGRAMS + 1):
        (tmp_path / f"P_{k}.SPF").write_text("RET")
    path = tmp_path / "MAIN.MPF"
    path.write_text("".join(f"P_{k}\n" for k in range(MAX_SUBPROGRAMS)))
    assert len(interpreter_run(path, 10).files) == MAX_SUBPROGRAMS + 1
    path.write_text("".join(f"P_{k}\n" for k in range(MAX_SUBPROGRAMS + 1)))
    with pytest.raises(InputError, match="calls more than 1000 subprograms"):
        interpreter_run(path, 10)


# Memory

#: What a run may take at most: so much, and so much for every byte of the program.
CONSTANT = 40 << 20
EACH_BYTE = 400

LARGE = {
    "comments": b";\n" * 20_000,
    "words": b"M1" * 2000 + b"\n",
    "distinct long blocks": b"".join(b"%d" % k + b"-" * 3000 + b"\n" for k in range(30)),
    "one line": b"X1 " * 200_000,
    "no line end": b"1" * 1_000_000,
    "variables": b"".join(b"_V%d=%d\n" % (k, k) for k in range(5_000)),
    "labels": b"".join(b"MARK%d:\n" % k for k in range(5_000)) + b"GOTOB MARK7\n",
    "unknown words": b"Q1\n" * 12_000,
    "NUL bytes": b"\0" * 300_000,
    "texts": b'DEF STRING[999] _S\n_S="xxxxxxxxxx"\nLOOP\nMSG(_S)\n_S=_S<<_S\nENDLOOP\n',
    "motion": b"".join(b"X%d Y1\n" % (k % 1000) for k in range(50_000)),
}


@pytest.mark.third
@pytest.mark.parametrize("data", LARGE.values(), ids=LARGE.keys())
def test_memory_grows_with_the_program_and_no_faster(folder: Path, data: bytes) -> None:
    oracle.judge_program(data[:100], folder)
    tracemalloc.start()
    try:
        oracle.judge_program(data, folder)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak <= CONSTANT + EACH_BYTE * len(data)


def test_a_loop_before_a_long_tail_asks_for_no_room_that_it_does_not_need(folder: Path) -> None:
    data = b"MARK:\n" + b"X1\nX2\n" * 50 + b"GOTOB MARK\n" + (b";" + b"x" * 60 + b"\n") * 30_000
    tracemalloc.start()
    try:
        assert oracle.judge_program(data, folder, limit=150_000) is None
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak <= CONSTANT + EACH_BYTE * len(data)


def interpreter_run(path: Path, limit: int) -> Run:
    """Run a program of a folder."""
    named = oracle.beside(path, "sinumerik_840d")
    return SinumerikInterpreter(path, oracle.machine("yl569"), RunOptions(tuple(named), limit)).run()
