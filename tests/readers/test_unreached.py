"""Blocks behind the return of a subprogram: once for each return, and not where the operator may skip it."""

from pathlib import Path

import pytest

import trunnion
from tests.support.haas import HEAD


@pytest.mark.parametrize(("back", "count"), [("M99", 1), ("/M99", 0), ("N7 /M99", 0)])
def test_blocks_behind_a_return_are_named_once_unless_it_may_be_skipped(back: str, count: int, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(f"{HEAD}M98 P2\nM98 P2\nM30\nO00002\nX1.\n{back}\nX2.\nM99\n%\n")
    found = trunnion.read_program(program, machine="haas_umc750").diagnostics
    assert [each.code for each in found].count("NC161") == count
