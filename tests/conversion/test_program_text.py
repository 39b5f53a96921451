"""The text of a program by line: its sparse words, as a search of the whole text finds them."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.conversion import program_text
from trunnion.conversion.program_text import ProgramText
from trunnion.families import FAMILIES, load_reader

#: What lines are made of: dense motion, words that are sparse or nearly so, comments, what ends in another line.
WORDS = (
    "X1.5",
    "Y-2",
    "G0",
    "G1",
    "G01",
    "G03",
    "G0.",
    "G04",
    "G1.5",
    "G5",
    "G91",
    "g2",
    "G",
    "GX",
    "M3",
    "m30",
    "N10",
    "A3=0.5",
    "TRAORI",
    "SIN",
    "FMAX",
    "R0",
    "L",
    "XG1",
    "_A",
)
OTHERS = ("12 * - name", "; G5 M3", "(M3)", "(", ")", '"M3', '"', "%", "é", "/", " ", "\r", "\n", "\n", "\n\n")


def _in_the_whole_text(text: str, comments: bytes) -> list[tuple[int, list[str]]]:
    """The same without a choice of lines."""
    found = dict[int, list[str]]()
    data = text.encode()
    for match in re.finditer(comments + b"|(" + program_text._SPARSE_WORDS + b")", data, re.IGNORECASE | re.MULTILINE):
        if match[1] is not None:
            found.setdefault(data.count(b"\n", 0, match.start()) + 1, []).append(match[0].decode().upper())
    return list(found.items())


@given(
    st.lists(st.sampled_from(WORDS + OTHERS), max_size=60).map("".join),
    st.sampled_from(sorted(FAMILIES)),
    st.integers(1, 40),
)
def test_sparse_words_are_those_of_the_whole_text(text: str, family: str, chunk: int) -> None:
    comments = load_reader(family).comments
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(program_text, "_CHUNK", chunk)
        patched.setattr(Path, "read_bytes", lambda _: text.encode())
        assert list(ProgramText("any", "N", comments).sparse_words()) == _in_the_whole_text(text, comments)
