"""The unit of programs that state none: ``units`` of ``[control.reading]``, for lengths and feeds."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.errors import TrunnionError
from trunnion.model.run import Run

HEAD = "T5 M6\nSUPA G0 Z0 D0\nG54 {word} G90 G17 G40 G94 S500 M3\nG0 X0 Y0 Z2 D1\n"
CUTS = "".join(f"G1 X{0.01 * k:.3f} Y{0.02 * k:.3f} Z-0.1 F5\n" for k in range(60))
ARC_AND_HOLE = "G2 X1 Y1 CR=2\nMCALL CYCLE81(2,0,0.1,-0.3)\nX1.5\nMCALL\n"
PROGRAM = f"{HEAD}{CUTS}{ARC_AND_HOLE}G0 Z2\nM5\nSUPA G0 Z0 D0\nM30\n"


def run_with(folder: Path, word: str, unit: str = "") -> Run:
    """Run the program with a word for the unit, on a control that counts in ``unit`` until then."""
    program, machine = folder / "part.mpf", folder / "ours.toml"
    program.write_text(PROGRAM.format(word=word), encoding="utf-8")
    key = f'[control.reading]\nunits = "{unit}"\n' if unit else ""
    machine.write_text(f'extends = "yl569"\n{key}', encoding="utf-8")
    return trunnion.read_program(program, machine=machine)


def same(one: Run, other: Run) -> bool:
    found = one.tip, one.feed, one.arcs.centre
    others = other.tip, other.feed, other.arcs.centre
    return all(np.array_equal(*each, equal_nan=True) for each in zip(found, others, strict=True))


@pytest.mark.parametrize(("unit", "word"), [("inch", "G700"), ("mm", "G710")])
def test_a_program_without_a_unit_counts_as_the_definition_says(tmp_path: Path, unit: str, word: str) -> None:
    assert same(run_with(tmp_path, "", unit), run_with(tmp_path, word))


@pytest.mark.parametrize("word", ["G70", "G71", "G700", "G710"])
@pytest.mark.parametrize("unit", ["inch", "mm"])
def test_what_the_program_says_takes_its_place(tmp_path: Path, unit: str, word: str) -> None:
    assert same(run_with(tmp_path, word, unit), run_with(tmp_path, word))


def test_a_stated_unit_is_not_assumed(tmp_path: Path) -> None:
    assert "G71" in run_with(tmp_path, "").assumed_modes
    for unit in ("mm", "inch"):
        run = run_with(tmp_path, "", unit)
        assert "G71" not in run.assumed_modes
        assert run.first_without_units is None


def test_another_unit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TrunnionError, match="units"):
        run_with(tmp_path, "", "cm")
