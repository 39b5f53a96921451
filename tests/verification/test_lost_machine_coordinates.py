"""A retract that has lost its word for machine coordinates goes to the same number in the workpiece: no retract."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.block_of_holes import BLOCK
from tests.support.verifying import check
from trunnion import diff, verify
from trunnion.cli import main

#: The word for machine coordinates of each control; ``first``: what stands for it there.
WORDS = {
    "yl569": "SUPA ",
    "dmu65": " M91",
    "mikron_600u": " M91",
    "matsuura_mx330": "G53 ",
    "xyzac_trt": "G53 ",
}

Programs = Callable[[str], tuple[Path, list[str]]]


@pytest.fixture(scope="module")
def posted(tmp_path_factory: pytest.TempPathFactory) -> Programs:
    """CL file and lines of a program with three planes; written once for each machine."""
    folder = tmp_path_factory.mktemp("machine_coordinates")
    done: dict[str, tuple[Path, list[str]]] = {}

    def post(machine: str) -> tuple[Path, list[str]]:
        if machine not in done:
            cl, program = folder / "part.cls", folder / f"{machine}.nc"
            cl.write_text(BLOCK, encoding="utf-8")
            assert main(["post", str(cl), "--machine", machine, "--output", str(program)]) == 0
            done[machine] = cl, program.read_text(encoding="utf-8").splitlines()
        return done[machine]

    return post


@pytest.mark.parametrize("machine", sorted(WORDS))
def test_every_machine_position_that_loses_its_word_is_found(machine: str, posted: Programs, tmp_path: Path) -> None:
    cl, lines = posted(machine)
    changed = tmp_path / "changed.nc"
    at = [k for k, line in enumerate(lines) if WORDS[machine] in line]
    assert len(at) > 5
    for k in at:
        changed.write_text("\n".join([*lines[:k], lines[k].replace(WORDS[machine], ""), *lines[k + 1 :]]) + "\n")
        found = verify(changed, machine=machine, cl=cl)
        assert not found.passed, lines[k]
        failed = {each.key for each in found.checks if not each.passed}
        assert failed & {"order", "home", "turns"}, (lines[k], failed)


@pytest.mark.parametrize("machine", sorted(WORDS))
def test_without_a_cl_file_no_turn_counts_as_retracted_by_it(machine: str, posted: Programs, tmp_path: Path) -> None:
    """The block that draws the tool back between two planes: what follows would turn at the part."""
    _, lines = posted(machine)
    frame = [k for k, line in enumerate(lines) if WORDS[machine] in line]
    along = [k for k in frame if "Z" in lines[k] and "Y" not in lines[k]]
    between = [k for k in along if along[0] < k < along[-1]]
    found_any = False
    changed = tmp_path / "changed.nc"
    for k in between:
        changed.write_text("\n".join([*lines[:k], lines[k].replace(WORDS[machine], ""), *lines[k + 1 :]]) + "\n")
        found_any |= not check(verify(changed, machine=machine), "turns").passed
    assert found_any


@pytest.mark.parametrize("machine", sorted(WORDS))
def test_the_same_number_in_other_coordinates_is_a_difference(machine: str, posted: Programs, tmp_path: Path) -> None:
    _, lines = posted(machine)
    k = next(k for k, line in enumerate(lines) if WORDS[machine] in line)
    good, changed = tmp_path / "good.nc", tmp_path / "changed.nc"
    good.write_text("\n".join(lines) + "\n")
    changed.write_text("\n".join([*lines[:k], lines[k].replace(WORDS[machine], ""), *lines[k + 1 :]]) + "\n")
    assert diff(good, good, machine=machine).same
    assert not diff(good, changed, machine=machine).same


def test_a_retract_by_its_word_stands_before_every_tool_change(tmp_path: Path) -> None:
    lines = "G71\nM242\nT.1 M306\nG55 O1\nS500 M3\nG1 X0 Y0 Z5. F500\nX50.\nM5\nM242\nT.2 M306\nG55 O1\nM242\nM02\n"
    nc, cl = tmp_path / "words.nc", tmp_path / "words.cls"
    cl.write_text("UNITS/MM\nTOOL PATH/A,TOOL,T\nLOAD/TOOL,1\nFEDRAT/MMPM,500\nGOTO/0,0,5\nGOTO/50,0,5\nEND-OF-PATH\n")
    for text, passed in ((lines, True), (lines.replace("M5\nM242", "M5"), False)):
        nc.write_text(text)
        assert check(verify(nc, machine="hs664rt", cl=cl), "home").passed is passed
