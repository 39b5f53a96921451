"""Work offsets that a program writes behind its last motion are left to the next program."""

from pathlib import Path

import pytest

from tests.support.verifying import check
from trunnion import verify

HEADS = {
    "matsuura_mx330": "%\nO1\nG21 G90 G54\nG0 X1. Y1. Z50.\n",
    "haas_umc750": "%\nO1\nG21 G90 G54\nG0 X1. Y1. Z50.\n",
    "xyzac_trt": "G21 G90 G54\nG0 X1. Y1. Z50.\n",
    "dmu65": "BEGIN PGM A MM\nL X+1 Y+1 Z+50 R0 FMAX\n",
}
ENDS = {"dmu65": "M30\nEND PGM A MM\n"}


def faults(folder: Path, machine: str, blocks: str, *, head: str | None = None) -> list[int]:
    """Lines at which a work offset is said to be left to the next program."""
    file = folder / ("a.h" if machine == "dmu65" else "a.nc")
    begin = HEADS[machine] if head is None else head
    file.write_text(f"{begin}{blocks}\n{ENDS.get(machine, 'M30')}\n", encoding="utf-8")
    found = check(verify(file, machine=machine, zero=(0.0, 0.0, 0.0)), "words")
    return [place.nc_line for place in found.places if "the next program" in place.text]


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "xyzac_trt"])
@pytest.mark.parametrize(
    ("blocks", "lines"),
    [
        ("G10 L2 P1 X5.", [1]),
        ("G10 L20 P2 X5.", [1]),
        ("M9\nG10 L2 P1 X5.\nG10 L2 P2 Y0.", [2, 3]),
        ("G10 L2 P1 X5.\nG0 X2.", []),
        ("G10 L2 P1 X5.\nG0 X2.\nG10 L2 P1 X6.", [3]),
        # Tidies up what it wrote itself.
        ("G10 L2 P1 X5. Y0. Z0.\nG0 X2.\nG10 L2 P1 X0. Y0. Z0.", []),
        ("G10 L2 P1 X5. Y0. Z0.\nG0 X2.\nG10 L2 P2 X0. Y0. Z0.", [3]),
    ],
)
def test_an_offset_behind_the_last_motion(machine: str, blocks: str, lines: list[int], tmp_path: Path) -> None:
    before = HEADS[machine].count("\n")
    assert faults(tmp_path, machine, blocks) == [before + line for line in lines]


def test_a_program_without_motions_sets_up_the_machine(tmp_path: Path) -> None:
    assert faults(tmp_path, "matsuura_mx330", "G10 L2 P1 X5.", head="%\nO1\nG21 G90\n") == []


@pytest.mark.parametrize(
    ("blocks", "lines"),
    [
        ("CYCL DEF 247 DATUM SETTING ~\n Q339=+5", [3]),
        ("CYCL DEF 247 DATUM SETTING ~\n Q339=+5\nL X+2 R0 FMAX", []),
        ("CYCL DEF 247 Q339=+5\nL X+2 R0 FMAX\nCYCL DEF 247 Q339=+5", []),
        ("CYCL DEF 247 Q339=+5\nL X+2 R0 FMAX\nCYCL DEF 247 Q339=+6", [5]),
    ],
)
def test_a_preset_behind_the_last_motion(blocks: str, lines: list[int], tmp_path: Path) -> None:
    assert faults(tmp_path, "dmu65", blocks) == lines
