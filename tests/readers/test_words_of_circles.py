"""A coordinate of a circle's centre that has no meaning in its plane, or beside a line, is an error: it was meant for
something.
"""

from pathlib import Path

import pytest

from trunnion.machines import load_machine
from trunnion.readers import run_program

HEADS = {
    "matsuura_mx330": "%\nO0001\nG21 G17 G40 G80 G90 G94\nT1 M6\nG54\n",
    "haas_umc750": "%\nO0001\nG21 G17 G40 G80 G90 G94\nT1 M6\nG54\n",
    "xyzac_trt": "G21 G17 G40 G80 G90 G94\nT1 M6\nG54\n",
    "yl569": "G71 G17 G40 G90 G94\nT1 M6\nG54\n",
    "hs664rt": "G17\nG90\nG71\nM306 T.1\nG55 O1\n",
}


@pytest.mark.parametrize("machine", list(HEADS)[:4])
@pytest.mark.parametrize(("plane", "end", "centre", "other"), [
    ("G17", "X20. Y0.", "I10. J0.", "K"), ("G18", "X20. Z0.", "I10. K0.", "J"), ("G19", "Y20. Z0.", "J10. K0.", "I"),
])  # fmt: skip
def test_a_word_of_another_plane_is_an_error(
    machine: str, plane: str, end: str, centre: str, other: str, tmp_path: Path
) -> None:
    def errors(word: str) -> list[str]:
        file = tmp_path / "p.nc"
        text = f"{plane}\nG0 X0. Y0. Z0.\nG1 F100. X0.\nG2 {end} {centre}{word}\nM30\n"
        file.write_text(HEADS[machine] + text, encoding="utf-8")
        return [each.wording.variant for each in run_program(file, load_machine(machine)).errors]

    assert errors(f" {other}3.") == ["no_word_of_circle"]
    assert errors(f" {other}0.") == []
    assert errors("") == []


@pytest.mark.parametrize("machine", HEADS)
def test_beside_a_line_each_is_an_error(machine: str, tmp_path: Path) -> None:
    """Also in a block of its own, where the mode of lines stays in force."""
    file = tmp_path / "p.nc"
    blocks = "G1 X10. Y0. I5. F100.\nX20. J3. K0.\nX30.\n"
    file.write_text(HEADS[machine] + "G1 X0. Y0. F100.\n" + blocks + "M2\n", encoding="utf-8")
    found = run_program(file, load_machine(machine)).errors
    assert [(each.wording.variant, each.wording.what[0]) for each in found] == [("unused_word", word) for word in "IJK"]
