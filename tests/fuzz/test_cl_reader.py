"""CL files from anybody: read or refused, whatever they hold."""

import random
import tracemalloc
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.fuzz import oracle, pieces, seeds
from tests.support.fuzz.mangle import mangle

HEAD = b"TOOL PATH/A,TOOL,B\nTLDATA/MILL,10,1,50,0,0\nGOTO/0,0,9,0,0,1\n"
FOOT = b"END-OF-PATH\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for CL files."""
    return tmp_path_factory.mktemp("cl")


@st.composite
def _grown(draw: st.DrawFn) -> bytes:
    """A CL file of sound pieces, put together without sense."""
    return pieces.cl_file(draw(st.integers(1, 25)), lambda choices: draw(st.sampled_from(choices))).encode()


@settings(max_examples=examples(80))
@given(data=_grown(), strict=st.booleans())
def test_a_file_of_random_statements_is_read_or_refused(folder: Path, data: bytes, strict: bool) -> None:
    oracle.judge_cl(data, folder, strict=strict)


@settings(max_examples=examples(60))
@given(data=st.binary(max_size=400))
def test_random_bytes_inside_an_operation_are_read_or_refused(folder: Path, data: bytes) -> None:
    oracle.judge_cl(HEAD + data + b"\n" + FOOT, folder)
    oracle.judge_cl(data, folder)


@settings(max_examples=examples(60))
@given(text=st.text(alphabet="GOTODLA/CIRE0123456789.,-+$ \n\r\tPS", max_size=300))
def test_random_letters_of_the_language_are_read_or_refused(folder: Path, text: str) -> None:
    oracle.judge_cl(HEAD + text.encode() + b"\n" + FOOT, folder)


@pytest.mark.third
@pytest.mark.parametrize("seed", range(20))
def test_mangled_files_are_read_or_refused(folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(30):
        oracle.judge_cl(mangle(rng.choice(seeds.cl_files()), seeds.cl_files(), rng), folder)


@pytest.mark.parametrize("data", sorted(set(seeds.cl_files())))
def test_what_is_mangled_is_read_when_it_is_whole(folder: Path, data: bytes) -> None:
    assert oracle.judge_cl(data, folder) is not None


NASTY = {
    "nothing": b"",
    "one NUL": b"\0",
    "a byte order mark": b"\xef\xbb\xbf",
    "UTF-16": "GOTO/1,2,3\n".encode("utf-16"),
    "lone carriage returns": (HEAD + FOOT).replace(b"\n", b"\r"),
    "continuation without end": HEAD + b"GOTO/1,$\n" * 3000,
    "continuation with a comment": HEAD + b"GOTO/1,$ $$ here\n2,3\n" + FOOT,
    "continuation with carriage returns": HEAD + b"PAIN$\r$$\rL$\r$$\rT/PATH\nGOTO/A\n" + FOOT,
    "a statement of a megabyte": HEAD + b"CYCLE/" + b"A," * 600_000 + b"\n" + FOOT,
    "many words of one statement": HEAD + b"CYCLE/DRILL" + b",A" * 20_000 + b"\n" + FOOT,
    "digits without end": HEAD + b"GOTO/" + b"1" * 100_000 + b",2,3\n" + FOOT,
    "decimals without end": HEAD + b"GOTO/1." + b"0" * 100_000 + b",2,3\n" + FOOT,
    "exponents": HEAD + b"GOTO/1E999,1D-999,1E308\n" + FOOT,
    "commas": HEAD + b"GOTO/" + b"," * 100_000 + b"\n" + FOOT,
    "turns without number": HEAD + b"GOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5,TIMES,1e12\nGOTO/0,5,0\n" + FOOT,
    "turns that are too many": HEAD + b"GOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5,TIMES,1e300\nGOTO/0,5,0\n" + FOOT,
    "a vector of nothing": HEAD + b"GOTO/5,0,0,0,0,0\n" + FOOT,
    "a row after many empty lines": b"\n" * 200_000 + HEAD + FOOT,
    "rows with nothing in them": HEAD + b"GOTO/\n" * 50_000 + FOOT,
    "operations": (HEAD + FOOT) * 500,
    "no line end": HEAD + FOOT[:-1],
}


@pytest.mark.third
@pytest.mark.parametrize("data", NASTY.values(), ids=NASTY.keys())
def test_nasty_files_are_read_or_refused(folder: Path, data: bytes) -> None:
    oracle.judge_cl(data, folder)
    oracle.judge_cl(data, folder, strict=True)


#: What reading may take at most: so much, and so much for every byte of the file.
CONSTANT = 40 << 20
EACH_BYTE = 400


@pytest.mark.third
@pytest.mark.parametrize("data", NASTY.values(), ids=NASTY.keys())
def test_memory_grows_with_the_file_and_no_faster(folder: Path, data: bytes) -> None:
    tracemalloc.start()
    try:
        oracle.judge_cl(data, folder)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak <= CONSTANT + EACH_BYTE * len(data)
