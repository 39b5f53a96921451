"""Two programs are the same only if they are so wherever the workpiece stands and however long the tool is."""

from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS

CASES = TESTS / "data" / "cases"

#: Machines with the word that tilts their plane.
PLANES = {
    "yl569": "CYCLE800(0", "dmu65": "PLANE SPATIAL", "matsuura_mx330": "G68.2", "haas_umc750": "G254",
    "hs664rt": "G154", "generic_head_head_ca": "CYCLE800(0",
}  # fmt: skip


def posted(machine: str, folder: Path) -> Path:
    program = folder / "one.nc"
    trunnion.post(CASES / "tilted_flood.cls", machine=machine, output=program)
    return program


def without(program: Path, word: str) -> Path:
    """The program without the first block that has a word."""
    lines = program.read_text(encoding="utf-8").splitlines()
    del lines[next(k for k, line in enumerate(lines) if word in line)]
    other = program.with_name("other.nc")
    other.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return other


@pytest.mark.parametrize("machine", PLANES)
def test_a_program_without_its_plane_is_another_one(machine: str, tmp_path: Path) -> None:
    program = posted(machine, tmp_path)
    assert trunnion.diff(program, program, machine=machine).same
    found = trunnion.diff(program, without(program, PLANES[machine]), machine=machine)
    assert not found.same
    assert found.first is not None


def test_the_values_that_nobody_has_stated_are_named(tmp_path: Path) -> None:
    program = posted("yl569", tmp_path)
    other = without(program, PLANES["yl569"])
    found = trunnion.diff(program, other, machine="yl569")
    stated = "with workpiece zero 137, -91, 53 and tool length 100, as nobody has stated them"
    assert found.first is not None
    assert found.first.text.endswith(stated)
    machine = trunnion.load_machine("yl569")
    runs = [trunnion.read_program(each, machine=machine) for each in (program, other)]
    assert not trunnion.diff(*runs, machine=machine).same
    # In the middle of the table both go to the same places.
    there = replace(machine, workpiece_zero=(0.0, 0.0, 0.0), tool_length=0.0)
    assert trunnion.diff(program, other, machine=there).same


def test_a_frame_in_another_plane_of_the_length_is_another_program(tmp_path: Path) -> None:
    program, other = tmp_path / "one.mpf", tmp_path / "other.mpf"
    text = "G17 G71 G90\nT1 M6\nG54 D1\nS1000 M3\n{}G0 X0 Y0 Z50\nG1 Z1 F200\nX50\nG0 Z50\nSUPA G0 Z0 D0\nM30\n"
    program.write_text(text.format(""), encoding="utf-8")
    other.write_text(text.format("G18\n"), encoding="utf-8")
    found = trunnion.diff(program, other, machine="yl569")
    assert found.first is not None
    assert "plane G17 against G18" in found.first.text
    found = trunnion.diff(program, other, machine="yl569", path=True)
    assert found.first is not None
    assert "tool length 100" in found.first.text


def test_positions_of_the_linear_axes_under_turned_tables_are_the_same_in_other_words(tmp_path: Path) -> None:
    program, other = tmp_path / "one.mpf", tmp_path / "other.mpf"
    head = "G17 G71 G90\nT1 M6\nG54 D1\nS1000 M3\nG0 B30 C20\n"
    text = head + "{}G1 Z1 F200\nG2 X20 Y0 I10 J0\nG0 Z50\nSUPA G0 Z0 D0\nM30\n"
    program.write_text(text.format("G0 X0 Y0 Z50\n"), encoding="utf-8")
    other.write_text(text.format("G0 X0. Y0. Z50.\n").replace("X20 Y0", "X20"), encoding="utf-8")
    assert trunnion.diff(program, other, machine="yl569").same
