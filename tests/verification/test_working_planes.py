"""A working plane that no arc, cycle or radius compensation needs is a word that nobody asked for."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.verification.results import State

CASES = TESTS / "data" / "cases"
MACHINES = ["yl569", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"]


def posted(tmp_path: Path, machine: str, cl: str) -> tuple[Path, list[str]]:
    program = tmp_path / "sound.nc"
    trunnion.post(CASES / cl, machine=machine, output=program)
    return program, program.read_text(encoding="utf-8").splitlines()


def last_cut(lines: list[str]) -> int:
    """The last line that goes to a point before the last retract along Z."""
    going = [k for k, line in enumerate(lines) if re.search(r" [XY]-?\d", line) and not re.search("SUPA|G53|G28", line)]
    return going[-2]


def with_plane(tmp_path: Path, lines: list[str], at: int, word: str = "G18") -> Path:
    program = tmp_path / "plane.nc"
    number = re.match(r"N\d+ ", lines[at])
    line = (number[0] if number else "") + word
    program.write_text("\n".join([*lines[:at], line, *lines[at:]]) + "\n", "utf-8")
    return program


@pytest.mark.parametrize("word", ["G18", "G19"])
@pytest.mark.parametrize("machine", MACHINES)
def test_a_plane_over_lines_that_nobody_asked_for_fails(machine: str, word: str, tmp_path: Path) -> None:
    sound, lines = posted(tmp_path, machine, "tilted_flood.cls")
    assert trunnion.verify(sound, machine=machine, cl=CASES / "tilted_flood.cls").passed
    program = with_plane(tmp_path, lines, last_cut(lines), word)
    found = trunnion.verify(program, machine=machine, cl=CASES / "tilted_flood.cls")
    told = [place.text for check in found.checks if check.key == "modal" for place in check.places]
    assert any(f"plane {word}" in text for text in told)


@pytest.mark.parametrize("machine", MACHINES[1:])
def test_without_a_cl_file_it_is_named(machine: str, tmp_path: Path) -> None:
    _, lines = posted(tmp_path, machine, "tilted_flood.cls")
    found = trunnion.verify(with_plane(tmp_path, lines, last_cut(lines)), machine=machine)
    modal = next(check for check in found.checks if check.key == "modal")
    assert modal.state == State.NOT_CHECKED
    assert any("nobody asked for the working plane G18" in each.what for each in modal.missing)


@pytest.mark.parametrize("machine", MACHINES[1:])
def test_two_programs_in_other_planes_differ(machine: str, tmp_path: Path) -> None:
    sound, lines = posted(tmp_path, machine, "tilted_flood.cls")
    assert not trunnion.diff(sound, with_plane(tmp_path, lines, last_cut(lines)), machine=machine).same


@pytest.mark.parametrize("machine", MACHINES)
def test_a_plane_behind_the_last_cut_changes_nothing_of_it(machine: str, tmp_path: Path) -> None:
    _, lines = posted(tmp_path, machine, "tilted_flood.cls")
    ends = max(k for k, line in enumerate(lines) if re.search(r"\bM(30|5|05)\b", line))
    found = trunnion.verify(with_plane(tmp_path, lines, ends), machine=machine, cl=CASES / "tilted_flood.cls")
    told = [place.text for check in found.checks if check.key == "modal" for place in check.places]
    assert not any("plane" in text for text in told)
