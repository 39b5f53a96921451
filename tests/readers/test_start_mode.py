"""G80 ends a cycle: the motion before it is in force again, and before any motion that is the mode of the start."""

from pathlib import Path

import pytest

import trunnion
from trunnion.model.toolpath import Kind

_HEADS = {"matsuura_mx330": "%\nO0001\n", "haas_umc750": "%\nO00001\n", "hs664rt": ""}


@pytest.mark.parametrize("machine", _HEADS)
@pytest.mark.parametrize("words", ["G90 G17", "G90 G17 G80", "G80"])
def test_g80_before_any_motion_leaves_the_mode_of_the_start(machine: str, words: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(f"{_HEADS[machine]}G71\n{words}\nX1. Y1. Z9.\nG1 X2. F900.\nM2\n".replace(
        "G71\n", "G71\n" if machine == "hs664rt" else "G21\n"
    ))  # fmt: skip
    run = trunnion.read_program(program, machine=machine)
    assert run.kind.tolist() == [Kind.RAPID, Kind.LINEAR]
    assert not run.errors


def test_g80_behind_a_cycle_brings_the_motion_before_it_back(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    text = "%\nO0001\nG21 G90 G54\n{before}X1. Y1. Z9.\nG98 G81 Z-1. R1. F90.\nG80\nX5. F90.\nM30\n"
    for before, kind in (("", Kind.RAPID), ("G0 ", Kind.RAPID), ("G1 F90. ", Kind.LINEAR)):
        program.write_text(text.format(before=before))
        run = trunnion.read_program(program, machine="matsuura_mx330")
        assert run.kind[-1] == kind, before
