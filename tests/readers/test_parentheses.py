"""Comments in parentheses end at the first one that closes: what stands behind it is no comment."""

from pathlib import Path

import pytest

import trunnion

_HEADS = {"matsuura_mx330": "%\nO1\nG21 G90\n", "xyzac_trt": "G21 G90\n", "hs664rt": "%\nG71 G90\n"}


@pytest.mark.parametrize("machine", _HEADS)
@pytest.mark.parametrize(
    ("line", "said"),
    [("(2 cuts at 3 mm)", False), ("(2 cut(s) at 3 mm)", True), ("G0 X1.)", True), ("G0 X1. (a) (b)", False)],
)
def test_a_comment_within_a_comment_is_told_as_what_it_is(machine: str, line: str, said: bool, tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    program.write_text(f"{_HEADS[machine]}{line}\nM30\n", encoding="utf-8")
    found = trunnion.read_program(program, machine=machine).diagnostics
    assert any("a ) that closes no comment" in str(each.text) for each in found) is said
