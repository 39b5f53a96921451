"""``diff`` compares how far rotary axes turn between points on one machine, not only the poses they reach."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import GOLDEN, YL569

BLADE = YL569 / "3_blade_finish.cls"
FLANGE = GOLDEN / "fanuc" / "flange.cls"

#: Programs, words of them, and what takes their place: the poses in the cuts stay.
ANOTHER_WAY = [
    (BLADE, "mikron_600u", "18 M126\n19 L B-59.1862 C-168.9663", "19 L B-59.1862 C+191.0337"),
    (BLADE, "yl569", "G0 B59.18624 C11.03375", "G0 B419.18624 C11.03375"),
    (FLANGE, "matsuura_mx330", "N300 G0 A-60.", "N300 G0 A60."),
    (FLANGE, "matsuura_mx330", "N300 G0 A-60.", "N300 G0 A300."),
]

#: The same, for what makes no difference: the control takes the shorter way, or the turn in which the axis stands;
#: an endless axis turns once more away from the part.
SAME_WAY = [
    (BLADE, "mikron_600u", "L B-59.1862 C-168.9663", "L B-59.1862 C+191.0337"),
    (BLADE, "yl569", "G0 B59.18624 C11.03375", "G0 B59.18624 C-348.96625"),
    (FLANGE, "matsuura_mx330", "N300 G0 A-60. C0.", "N300 G0 A-60. C360."),
]


def compared(source: Path, machine: str, words: str, others: str, folder: Path) -> trunnion.Comparison:
    one, two = folder / "one.nc", folder / "two.nc"
    trunnion.post(source, machine=machine, output=one)
    text = one.read_text(encoding="utf-8")
    assert words in text
    two.write_text(text.replace(words, others, 1), encoding="utf-8")
    return trunnion.diff(one, two, machine=machine)


@pytest.mark.parametrize(("source", "machine", "words", "others"), ANOTHER_WAY)
def test_another_way_to_the_same_pose_is_a_difference(
    source: Path, machine: str, words: str, others: str, tmp_path: Path
) -> None:
    found = compared(source, machine, words, others, tmp_path)
    assert not found.same
    assert found.first is not None
    assert "turns another way" in found.first.text


@pytest.mark.parametrize(("source", "machine", "words", "others"), SAME_WAY)
def test_words_for_the_same_way_are_no_difference(
    source: Path, machine: str, words: str, others: str, tmp_path: Path
) -> None:
    assert compared(source, machine, words, others, tmp_path).same
