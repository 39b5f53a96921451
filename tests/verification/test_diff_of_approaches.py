"""``diff`` compares how the tool comes to its first points: from which height, and in which work offset it turns."""

from pathlib import Path

import pytest

import trunnion

FIDIA = """G71 G90 G17 G40
M306 T.1
G55 O1
G01 C0. A0. F3000
S500 M3
G1 X15. Y0. F3000
Z50.
G81 X15. Y0. Z10. E-12. R5. F300
G80
X15. Y0. Z50. F3000
M242
S500 M3
G1 X40. Y9. F3000
Z50.
G81 X40. Y9. Z10. E-12. R5. F300
G80
X40. Y9. Z50. F3000
M5
M242
M02
"""

DATUM = "CYCL DEF 247 DATUM SETTING ~\n  Q339=+{} ;DATUM NUMBER\n"
KLARTEXT = (
    "BEGIN PGM A MM\n" + DATUM + "TOOL CALL 1 Z S1000\nL A+0 C+0 R0 FMAX\nM3\nL X+0 Y+0 Z+50 R0 FMAX\nL Z+0 F200\n"
    "L Z+50 FMAX\nL Z+0 R0 FMAX M91\n"
    + DATUM
    + "L A+0 C+0 R0 FMAX\n"
    + DATUM
    + "L A+0 C+0 R0 FMAX\nL X+9 Y+9 Z+50 R0 FMAX\nL Z+0 F200\n"
    "L Z+50 FMAX\nM5\nL Z+0 R0 FMAX M91\nM30\nEND PGM A MM\n"
)


def is_same(folder: Path, machine: str, one: str, two: str) -> bool:
    """Whether two programs are the same."""
    files = [folder / "one.nc", folder / "two.nc"]
    for file, text in zip(files, (one, two), strict=True):
        file.write_text(text, encoding="utf-8")
    return trunnion.diff(*files, machine=machine).same


@pytest.mark.parametrize("left_out", ["G1 X15. Y0. F3000\n", "G1 X40. Y9. F3000\n"])
def test_a_tool_that_comes_down_elsewhere_and_goes_across_then_is_a_difference(left_out: str, tmp_path: Path) -> None:
    assert is_same(tmp_path, "hs664rt", FIDIA, FIDIA)
    assert not is_same(tmp_path, "hs664rt", FIDIA, FIDIA.replace(left_out, ""))


@pytest.mark.parametrize("numbers", [(1, 2, 1), (2, 1, 1), (1, 1, 2), (1, 2, 2)])
def test_rotary_axes_that_are_stated_in_another_datum_are_a_difference(
    numbers: tuple[int, int, int], tmp_path: Path
) -> None:
    one = KLARTEXT.format(1, 1, 1)
    assert is_same(tmp_path, "dmu65", one, one)
    assert not is_same(tmp_path, "dmu65", one, KLARTEXT.format(*numbers))
