"""An unknown workpiece zero is not 0: what a program writes over it is a fault, whatever the value."""

from pathlib import Path

import pytest

from tests.support.verifying import check
from trunnion import verify
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program

HEADS = {
    "matsuura_mx330": "%\nO1\nG21 G90 G54\n",
    "haas_umc750": "%\nO00001\nG21 G90 G54\n",
    "xyzac_trt": "G21 G90 G54\n",
}


def read(folder: Path, machine: str, blocks: str) -> Run:
    file = folder / "a.nc"
    file.write_text(f"{HEADS[machine]}{blocks}\nM30\n")
    return run_program(file, load_machine(machine))


def lines(folder: Path, machine: str, blocks: str) -> list[int]:
    """Lines of errors that name the unknown zero, counted behind the head."""
    before = HEADS[machine].count("\n")
    return [error.line - before for error in read(folder, machine, blocks).errors if error.code == "NC352"]


@pytest.mark.parametrize("machine", HEADS)
@pytest.mark.parametrize(
    ("blocks", "expected"),
    [
        ("G10 L2 P1 X0. Y0. Z0.\nG0 X1.", [1]),
        ("G10 L20 P1 Z0.\nG0 X1.", [1]),
        ("G10 L2 P1 X5.\nG10 L2 P2 X5.\nG10 L2 P1 X6.\nG0 X1.", [1, 2]),
        ("G53 G0 X0. Y0. Z0.\nG92 X0. Y0. Z0.\nG1 X5. F100.", [2]),
        ("G0 X0. Y0. Z5.\nG92 X0. Y0. Z5.\nG1 X5. F100.", []),
        ("G0 X1. Y0. Z5.\nG53 G0 Z0.\nG92 X0.\nG0 X1.", []),
        ("G0 X1.\nG10 L2 P1 X0. Y0. Z0.", []),  # nothing moves in it
    ],
)
def test_what_is_written_over_an_unknown_zero(machine: str, blocks: str, expected: list[int], tmp_path: Path) -> None:
    has_no_g92 = machine == "haas_umc750" and "G92" in blocks
    assert lines(tmp_path, machine, blocks) == ([] if has_no_g92 else expected)


@pytest.mark.parametrize("machine", HEADS)
def test_an_offset_that_outlives_the_program_is_named(machine: str, tmp_path: Path) -> None:
    file = tmp_path / "a.nc"
    for blocks, stays in (("G10 L2 P2 X5.", True), ("G10 L2 P1 X5. Y0. Z0.\nG10 L2 P1 X0. Y0. Z0.", False)):
        file.write_text(f"{HEADS[machine]}G0 X1. Y1. Z5.\n{blocks}\nG1 X2. F100.\nM30\n")
        found = check(verify(file, machine=machine, zero=(0.0, 0.0, 0.0)), "words")
        assert any("stays in the control" in place.text for place in found.places) is stays
