"""LinuxCNC, Fanuc and Fidia programs from anybody: run or refused, whatever they hold, and always at an end."""

import random
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.fuzz import oracle
from tests.support.fuzz.mangle import mangle
from tests.support.fuzz.rs274 import FANUC, LANGUAGES, LINUXCNC, Language

languages = pytest.mark.parametrize("language", LANGUAGES, ids=lambda language: str(language.family))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with subprograms in it, and one beside it that nobody may read."""
    path = tmp_path_factory.mktemp("programs") / "inside"
    path.mkdir()
    (path / "a.ngc").write_text("o<a> sub\nG0 X#1\no<a> endsub\n")
    (path / "O9010.nc").write_text("O9010\nG91 G0 X1.\nG90\nM99\n")
    (path.parent / "secret.ngc").write_text("o<secret> sub\nG0 X666\no<secret> endsub\n")
    (path.parent / "O0666.nc").write_text("G0 X666.\nM99\n")
    return path


@languages
@settings(max_examples=examples(60))
@given(data=st.data())
def test_a_program_of_random_words_is_run_or_refused(folder: Path, language: Language, data: st.DataObject) -> None:
    program = language.program(data.draw(st.integers(1, 25)), lambda choices: data.draw(st.sampled_from(choices)))
    language.judge(program, folder, data.draw(st.sampled_from(language.machines)))


@languages
@settings(max_examples=examples(30))
@given(text=st.text(alphabet="NXYZACGMFOIJKRPQL0123456789=[]#<>;()%/.,+-*IFGOTOWHILEDO \n\r\t", max_size=300))
def test_random_letters_are_run_or_refused(folder: Path, language: Language, text: str) -> None:
    language.judge(text.encode(), folder)


@languages
@settings(max_examples=examples(20))
@given(data=st.binary(max_size=400))
def test_random_bytes_are_run_or_refused(folder: Path, language: Language, data: bytes) -> None:
    language.judge(data, folder)


@pytest.mark.third
@languages
@pytest.mark.parametrize("seed", range(6))
def test_mangled_programs_are_run_or_refused(folder: Path, language: Language, seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(20):
        data = mangle(rng.choice(language.sound), language.sound, rng)
        one = language.judge(data, folder, rng.choice(language.machines))
        if one is not None:
            assert np.isfinite(one.joints).all()


@languages
def test_what_is_mangled_is_understood_when_it_is_whole(folder: Path, language: Language) -> None:
    # Offsets that a program writes count from a workpiece zero that is known.
    on = replace(oracle.machine(language.machines[0]), workpiece_zero=(0.0, 0.0, 0.0))
    for data in language.sound:
        run = language.judge(data, folder, on)
        assert run is not None
        assert run.errors == ()


@languages
def test_a_program_runs_twice_alike(folder: Path, language: Language) -> None:
    rng = random.Random(7)
    for _ in range(15):
        data = mangle(rng.choice(language.sound), language.sound, rng)
        one, two = language.judge(data, folder), language.judge(data, folder)
        assert (one is None) == (two is None)
        if one is not None and two is not None:
            assert one.diagnostics == two.diagnostics
            assert one.events == two.events
            np.testing.assert_array_equal(one.tip, two.tip)


def test_files_of_other_folders_are_never_read(folder: Path) -> None:
    for text in ("o<../secret> call\n", "o</../secret> call\n", "o<..\\secret> call\n"):
        run = LINUXCNC.judge(text.encode(), folder)
        assert run is not None
        assert len(run) == 0
        assert run.errors
    run = FANUC.judge(b"M98 P666\nG65 P0666\nM198 P666\n", folder)
    assert run is not None
    assert len(run) == 0
    assert [finding.line for finding in run.errors] == [1, 2, 3]


BOUNDED = {
    "linuxcnc": (
        "G2 I5 P1000000000 F9", "G2 X1 R9999999 F9", "G0 X99999999999", "G10 L2 P1 X99999999999", "G92 X-9999999999",
        "X[" + "[" * 4000 + "1" + "]" * 4000 + "]", "X" + "-" * 3000 + "1", "#1=[9**999]", "F1 G83 Z-99999 R1 Q.0001",
        "o1 repeat [99999999999]\nG0 X1\no1 endrepeat", "G0 X" + "1" * 4000, "o<a> call [1/0]",
        "G10 L2 P1 R1" + "0" * 300,
        "o1 if [1]\n" * 70, "#<" + "A" * 4000 + ">=1", "M428\nG0 A" + "9" * 20,
    ),
    "fanuc_30i": (
        "G68 X9999999999. R30.", "G68 I0 J0 K0 R3.", "G68.2 X0 Y0 Z0 I9999999999. J0 K0", "G10 L2 P1 X99999999999.",
        "X[" + "[" * 4000 + "1" + "]" * 4000 + "]", "#1=POW[9,999]", "G99 G83 Z-99999. R1. Q.001 F9.",
        "M98 P2 L999999999",
        "#33333333333=1", "#1=#1.5", "O1\nM98 P1", "G43.5\nG1 X1. I0 J0 K0 F1.", "G81 Z-1. R1. K999999999 F9.",
        "#1=2147483648.AND3", "DO1\n" * 70,
    ),
    "fidia_nc15": (
        "G83 X1. Z9. E-99999. R3. D.001 F9", "G2 X1. Y1. I99999999. J99999999. F9", "A99999999999.",
        "G83 Z1. E2. R3. D1. F1",
    ),
}  # fmt: skip


@languages
def test_numbers_and_depths_without_sense_are_named(folder: Path, language: Language) -> None:
    for text in BOUNDED[language.family]:
        run = language.judge(text.encode(), folder, limit=3000)
        assert run is None or run.diagnostics or "R9999999" in text, text[:80]


CONSTANT = 40 << 20
EACH_BYTE = 400

LARGE = {
    "comments": b"(c)\n" * 20_000,
    "words": b"M8" * 2000 + b"\n",
    "one line": b"X1. " * 10_000,
    "no line end": b"1" * 1_000_000,
    "unknown words": b"M20 K1\n" * 12_000,
    "NUL bytes": b"\0" * 300_000,
    "motion": b"G0 X1.\n" + b"".join(b"X%d. Y1.\n" % (k % 1000) for k in range(50_000)),
    "numbers": b"".join(b"N%d\n" % k for k in range(20_000)) + b"GOTO7\no1 call\n",
}


#: Each of them in every other language; nightly has the others.
LARGE_IN_LANGUAGES = [
    pytest.param(language, data, id=f"{kind}-{language.family}", marks=[pytest.mark.nightly] * ((k + other) % 2))
    for k, (kind, data) in enumerate(LARGE.items())
    for other, language in enumerate(LANGUAGES)
]


@pytest.mark.third
@pytest.mark.parametrize(("language", "data"), LARGE_IN_LANGUAGES)
def test_memory_grows_with_the_program_and_no_faster(folder: Path, language: Language, data: bytes) -> None:
    language.judge(data[:100], folder)
    tracemalloc.start()
    try:
        language.judge(data, folder)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak <= CONSTANT + EACH_BYTE * len(data)
