"""Blocks of very many plain words: no fast pattern tries every division of them; they are refused at once."""

from pathlib import Path

import pytest

import trunnion

_LONG = "M3S50" * 1600


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"])
@pytest.mark.parametrize("end", ["#", "[", "X", "=", "$", " (comment"])
def test_a_long_block_with_a_strange_end_is_refused(machine: str, end: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(f"G21 G90 G94\n{_LONG}{end}\nG1 X1. F100.\nM30\n", encoding="utf-8")
    assert trunnion.read_program(program, machine=machine).errors


@pytest.mark.parametrize(
    "text", ["#1=50" + "+50" * 2000 + "X", "IF[#1EQ" + "1" * 4000 + "GOTO", "#1=1" + "MOD1234567" * 600 + "="]
)
def test_a_long_expression_is_refused(text: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(f"G21 G90 G94\n{text}\nG1 X1. F100.\nM30\n", encoding="utf-8")
    assert trunnion.read_program(program, machine="matsuura_mx330").errors
