"""A coordinate of a circle's centre that has no meaning in its plane is an error: it was meant for something."""

from pathlib import Path

import pytest

from trunnion.machines import load_machine
from trunnion.readers import run_program

HEADS = {
    "matsuura_mx330": "%\nO0001\nG21 G17 G40 G80 G90 G94\nT1 M6\nG54\n",
    "haas_umc750": "%\nO0001\nG21 G17 G40 G80 G90 G94\nT1 M6\nG54\n",
    "xyzac_trt": "G21 G17 G40 G80 G90 G94\nT1 M6\nG54\n",
    "yl569": "G71 G17 G40 G90 G94\nT1 M6\nG54\n",
}


@pytest.mark.parametrize("machine", HEADS)
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
