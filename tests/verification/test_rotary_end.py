"""Where rotary axes stand at the end of a program: said, and not judged."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.recall_proof.parts import cl_text


def home_line(program: Path, machine: str) -> str:
    cl = program.with_suffix(".cls")
    check = next(each for each in trunnion.verify(program, machine=machine, cl=cl).checks if each.key == "home")
    assert check.passed
    assert check.answer is not None
    return check.answer.what


@pytest.mark.parametrize(
    ("machine", "words", "said"),
    [
        ("yl569", r" B=_B_HOME C=_C_HOME", "B"), ("matsuura_mx330", r" A0\. C0\.", "A"),
        ("haas_umc750", r" B0\. C0\.", "B"), ("xyzac_trt", r" A0\. C0\.", "A"), ("hs664rt", r"G1 C0\. A0\. ", "A"),
        ("dmu65", r"\n\d+ L A\+0 C\+0 .*", "A"),
    ],
)  # fmt: skip
def test_rotary_axes_that_are_left_turned_are_named(machine: str, words: str, said: str, tmp_path: Path) -> None:
    program = tmp_path / ("part.h" if machine == "dmu65" else "part.nc")
    cl = program.with_suffix(".cls")
    cl.write_text(cl_text("leaning"), encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    text = program.read_text(encoding="utf-8")
    ends = [match.span() for match in re.finditer(words, text)]
    assert "not judged" not in home_line(program, machine)
    begin, end = ends[-1]
    program.write_text(text[:begin] + text[end:], encoding="utf-8")
    assert re.search(rf"not judged: .*{said}-?\d", home_line(program, machine))
