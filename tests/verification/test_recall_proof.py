"""Harmful edits of programs in six languages are reported, and edits that change nothing are not."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from tests.support.recall_proof.edits import Edit, harmful
from tests.support.recall_proof.sound_edits import sound

CL_FILES = TESTS / "data" / "cases"
MACHINES = {
    "Sinumerik": "yl569", "Heidenhain": "dmu65", "Fanuc": "matsuura_mx330", "Haas": "haas_umc750",
    "LinuxCNC": "xyzac_trt", "Fidia": "hs664rt",
}  # fmt: skip
#: The proof refuses points that nothing asks for.
NOT_FOR_PROOF = {"a line in two"}


def first_of_each_kind(edits: Iterator[Edit]) -> list[Edit]:
    found: dict[str, Edit] = {}
    for edit in edits:
        found.setdefault(edit.kind, edit)
    return list(found.values())


def passes(program: Path, text: str, family: str, cl: str) -> bool:
    program.write_text(text, encoding="utf-8", newline="")
    try:
        return trunnion.verify(program, machine=MACHINES[family], cl=CL_FILES / cl).passed
    except trunnion.TrunnionError:
        return False


@pytest.mark.nightly
@pytest.mark.parametrize("cl", ["contour.cls", "holes.cls", "tilted_flood.cls"])
@pytest.mark.parametrize("family", MACHINES)
def test_harmful_edits_are_reported_and_sound_ones_are_not(family: str, cl: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    trunnion.post(CL_FILES / cl, machine=MACHINES[family], output=program)
    text, mutant = program.read_text(encoding="utf-8"), tmp_path / "mutant.nc"
    unseen = [
        f"{edit.kind}, line {edit.line}"
        for edit in first_of_each_kind(harmful(text, family))
        if passes(mutant, edit.text, family, cl)
    ]
    refused = [
        f"{edit.kind}, line {edit.line}"
        for edit in first_of_each_kind(sound(text, family))
        if edit.kind not in NOT_FOR_PROOF and not passes(mutant, edit.text, family, cl)
    ]
    assert not unseen
    assert not refused


@pytest.mark.parametrize("family", ["Sinumerik", "Fanuc", "Haas", "LinuxCNC"])
def test_the_feed_of_a_cycle_in_inverse_time_is_reported(family: str, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    trunnion.post(CL_FILES / "holes.cls", machine=MACHINES[family], output=program)
    text = program.read_text(encoding="utf-8")
    assert passes(program, text, family, "holes.cls")
    assert not passes(program, text.replace("G94", "G93"), family, "holes.cls")
