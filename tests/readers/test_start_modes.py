"""Modes that a program relies on without saying them: the verification says that they are assumed."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError

MOVES = "G0 X0. Y0. Z50.\nG1 Z5. F100.\nX10.\nG0 Z50."
FANUC = f"%\nO0001\nG21{{said}}\nT1 M6\nG54 S500 M3\nG43 H1\n{MOVES}\nG49\nM5\nM30\n%\n"
OTHERS = f"{{said}}\nT1 M6\nG54 S500 M3\n{MOVES}\nM5\nM30\n"

#: Machines, their programs, and what is assumed of one that says nothing.
PROGRAMS = [
    ("matsuura_mx330", FANUC, ("G90", "G17", "G40", "G94")),
    ("haas_umc750", FANUC, ("G90", "G17", "G40", "G94")),
    ("xyzac_trt", FANUC.replace("%\nO0001\n", "").replace("%\n", ""), ("G90", "G17", "G40", "G94")),
    ("hs664rt", OTHERS, ("G90", "G17", "G40")),
    ("yl569", OTHERS, ("G90", "G17", "G40", "G94", "G71")),
]


def assumed(machine: str, text: str, folder: Path) -> tuple[str, ...]:
    """What the verification of a program says it assumes."""
    program = folder / "part.nc"
    program.write_text(text, encoding="utf-8")
    return trunnion.verify(program, machine=machine).standing.assumed


@pytest.mark.parametrize(("machine", "text", "words"), PROGRAMS)
def test_what_no_program_says_before_it_moves_is_assumed(
    machine: str, text: str, words: tuple[str, ...], tmp_path: Path
) -> None:
    assert assumed(machine, text.format(said=""), tmp_path) == words
    said = " " + " ".join(words)
    assert assumed(machine, text.format(said=said), tmp_path) == ()
    assert assumed(machine, text.format(said=said.replace(" G17", "")), tmp_path) == ("G17",)


def test_a_word_behind_the_first_motion_comes_too_late(tmp_path: Path) -> None:
    late = FANUC.format(said=" G17 G40 G80").replace("G1 Z5.", "G90 G94 G1 Z5.")
    assert assumed("matsuura_mx330", late, tmp_path) == ("G90",), "the feed mode matters in the first cut"


def test_any_word_of_a_motion_ends_a_cycle(tmp_path: Path) -> None:
    for machine, text, words in PROGRAMS[:2]:
        assert assumed(machine, text.format(said="").replace("G0 X0.", "X0."), tmp_path) == (*words, "G80")


def test_what_only_a_skipped_block_says_is_assumed(tmp_path: Path) -> None:
    text = FANUC.format(said=" G17 G40\n/G90 G94")
    assert assumed("matsuura_mx330", text, tmp_path) == ("G90", "G94")


def test_who_asks_for_start_modes_gets_an_error_and_a_definition_may_state_them(tmp_path: Path) -> None:
    program, machine = tmp_path / "part.nc", tmp_path / "mine.toml"
    program.write_text(FANUC.format(said=" G40 G94"), encoding="utf-8")
    head = 'extends = "matsuura_mx330"\n[proof]\nrequire = ["start_modes"]\n'
    machine.write_text(head, encoding="utf-8")
    found = trunnion.verify(program, machine=machine)
    (basis,) = (check for check in found.checks if not check.passed)
    assert (basis.key, "G90, G17" in basis.told) == ("basis", True)
    assert found.standing.told.endswith("; assumed: the control starts with G90, G17")
    machine.write_text(f'{head}[control.reading]\nstart_modes = ["G90", "G17"]\n', encoding="utf-8")
    assert trunnion.verify(program, machine=machine).standing.assumed == ()
    machine.write_text(f'{head}[control.reading]\nstart_modes = ["G91"]\n', encoding="utf-8")
    with pytest.raises(InputError, match="has G91, with which no program is taken to start"):
        trunnion.verify(program, machine=machine)
