"""``diff`` compares the modes that only one of two programs says, and those that no path shows."""

import re
from functools import cache
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS

CASES = TESTS / "data" / "cases"


@cache
def posted(machine: str, cl: str, folder: Path) -> str:
    program = folder / f"{machine}_{cl}.nc"
    trunnion.post(CASES / f"{cl}.cls", machine=machine, output=program)
    return program.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("posted")


def compared(folder: Path, machine: str, one: str, two: str) -> trunnion.Comparison:
    paths = folder / "one.nc", folder / "two.nc"
    for path, text in zip(paths, (one, two), strict=True):
        path.write_text(text, encoding="utf-8")
    return trunnion.diff(*paths, machine=machine)


#: Machine, CL file, what is found, what takes its place the first time, what the difference says.
FAULTS = [
    ("yl569", "tilted_flood", " G17", "", "plane stated against not stated"),
    ("yl569", "tilted_flood", " G90", "", "distances stated against not stated"),
    ("yl569", "tilted_flood", " G94", "", "feed stated against not stated"),
    ("yl569", "tilted_flood", " G60", " G64", "path control G60 against G64"),
    ("yl569", "tilted_flood", " FNORM", "", "course of the feed FNORM against not stated"),
    ("yl569", "tilted_flood", " FNORM", " FNORM SOFT", "acceleration not stated against SOFT"),
    ("yl569", "tilted_flood", "_ORI_SEMIFIN", "_ORI_FINISH", "CYCLE832 mode 12 against mode 11"),
    ("yl569", "tilted_flood", 'CYCLE800(0,""', 'CYCLE800(0,"TC2"', "swivel data none, _FR 0 against TC2, _FR 0"),
    ("yl569", "tilted_flood", r"(TRAORI\nN\d+) G54", r"\1 ;", "work offset G54 against none since TRAORI"),
    ("yl569", "tilted_flood", r"M5(?=\nN\d+ ;End of Program)", "M3", "spindle off behind the last motion"),
    ("matsuura_mx330", "tilted_flood", " G17", "", "plane stated against not stated"),
    ("matsuura_mx330", "tilted_flood", " G90", "", "distances stated against not stated"),
    ("matsuura_mx330", "tilted_flood", r"G05\.1 Q1", "G05.1 Q0", "G5.1 Q1 against G5.1 Q0"),
    ("matsuura_mx330", "tilted_flood", r"M5(?=\nN\d+ M9\nN\d+ M30)", "M3", "spindle off behind the last motion"),
    ("haas_umc750", "tilted_flood", " G17", "", "plane stated against not stated"),
    ("xyzac_trt", "tilted_flood", r" G91\.1", "", "centres stated against not stated"),
    ("hs664rt", "tilted_flood", r"G90", "M9", "distances stated against not stated"),
    ("dmu65", "tilted_flood", r"(M9\n\d+ L Z\+560 R0 FMAX M91\n\d+) PLANE RESET STAY", r"\1 M9", "plane is on"),
    ("dmu65", "contour", "PLANE RESET STAY", "M9", "tilted plane stated against not stated"),
    ("dmu65", "tilted_flood", "HSC-MODE:1", "HSC-MODE:0", "HSC-MODE 1 against 0"),
    ("matsuura_mx330", "contour", r"(G41 D2\n[^\n]*\n)", r"\1M8\nM8\n", "2 blocks without motion within radius comp"),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "cl", "found", "new", "told"), FAULTS)
def test_a_mode_that_only_one_program_says_is_a_difference(
    machine: str, cl: str, found: str, new: str, told: str, folder: Path
) -> None:
    text = posted(machine, cl, folder)
    # A plane may be reset twice before the first cut.
    pattern = re.escape(found) if found.startswith("CYCLE") else found
    changed = re.sub(pattern, new, text, count=0 if found == "PLANE RESET STAY" else 1)
    assert changed != text
    result = compared(folder, machine, text, changed)
    assert not result.same
    assert result.first is not None
    assert told in result.first.text


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "dmu65"])
def test_a_mode_said_again_is_none(machine: str, folder: Path) -> None:
    text = posted(machine, "contour", folder)
    again = {"yl569": ("N440", "N435 G17 G90 G94 G60\nN440"), "matsuura_mx330": ("N120", "N115 G17 G90 G94\nN120")}
    old, new = again.get(machine, (" PLANE RESET STAY", " PLANE RESET STAY\n3 PLANE RESET STAY"))
    assert old in text
    assert compared(folder, machine, text, text.replace(old, new, 1)).same
