"""A way to a hole that is a cut: named as that, and not by its height or by the feed of the hole."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import CLEAR, FOOT

_HOLES = "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,200\nGOTO/50,0,0\nGOTO/60,0,0\nGOTO/70,0,0\nCYCLE/OFF\n"


def holes(folder: Path, machine: str, old: str, new: str) -> tuple[str, ...]:
    """What the check of holes says where the block with ``old`` has ``new``."""
    cl, program = folder / "part.cls", folder / "part.nc"
    cl.write_text(CLEAR + _HOLES + FOOT, encoding="utf-8")
    written = trunnion.post(cl, machine=machine, output=program)
    assert written.passed
    text = program.read_text(encoding="utf-8")
    assert text.count(old) == 1
    program.write_text(text.replace(old, new), encoding="utf-8")
    found = trunnion.verify(program, machine=machine, cl=cl)
    (check,) = (each for each in found.checks if each.key == "holes")
    return tuple(str(place.wording) for place in check.places)


@pytest.mark.parametrize(
    ("machine", "old", "new"),
    [
        ("dmu65", "L X+50 Y+0 FMAX M99", "L X+50 Y+0 F100 M99"),
        ("dmu65", "L X+60 Y+0 FMAX M99", "L X+60 Y+0 F100 M99"),
        ("dmu65", "L X+70 Y+0 FMAX M99", "L X+70 Y+0 F200 M99"),
        ("ucp800", "L X+60 Y+0 FMAX M99", "L X+60 Y+0 F100 M99"),
        ("yl569", " X60. Y0.0\n", " G1 X60. Y0.0 F100\n"),
        ("generic_head_head_ca", " X60. Y0.0\n", " G1 X60. Y0.0 F100\n"),
    ],
)
def test_a_way_at_feed_is_named_as_that(machine: str, old: str, new: str, tmp_path: Path) -> None:
    told = holes(tmp_path, machine, old, new)
    assert told
    assert "goes to the hole at a feed" in told[0]
    assert not any("mm above it" in each or "begins to feed" in each for each in told)


def test_a_feed_of_the_hole_is_still_named(tmp_path: Path) -> None:
    told = holes(tmp_path, "dmu65", "Q206=+200", "Q206=+150")
    assert told
    assert all("moves with 150 mm/min" in each for each in told)
