"""Positions in machine coordinates beyond the travel: found without a workpiece zero, on every control."""

from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import FOOT, HEAD, check
from trunnion import RefusedError
from trunnion.cli import main
from trunnion.machines import Machine, load_machine

#: A program of each family; ``{}`` is a position of the slide in machine coordinates. Then the limit of the definition.
PROGRAMS = {
    "yl569": (HEAD + "G0 X0 Y0 Z50\nSUPA G0 X{} D0\n" + FOOT, "X", 250.0),
    "dmu65": ("BEGIN PGM T MM\nL Z+560 R0 FMAX M91\nL Y{} R0 FMAX M91\nM30\nEND PGM T MM\n", "Y", 325.0),
    "mikron_600u": ("BEGIN PGM T MM\nL Z+450 R0 FMAX M91\nL X{} R0 FMAX M91\nM30\nEND PGM T MM\n", "X", 300.0),
    "matsuura_mx330": ("%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nG53 G0 X{}\nM30\n%\n", "X", 0.0),
    "haas_umc750": ("%\nO00001\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nG53 G0 Y{}\nM30\n%\n", "Y", 0.0),
    "linuxcnc_5axis": ("G21 G17 G40 G80 G90 G94\nG53 G0 Z100\nG53 G0 X{}\nM2\n", "X", 500.0),
    "hs664rt": ("G71 G90\nG290 G0 Z0\nG290 G0 X{}\nM30\n", "X", 400.0),
}


def machine_of(key: str) -> Machine:
    """A shipped machine, whose slides get limits of 400 mm where it has none."""
    machine = load_machine(key)
    axes = tuple(
        axis if axis.is_rotary or axis.has_limits else replace(axis, low=-400.0, high=400.0) for axis in machine.axes
    )
    return replace(machine, axes=axes)


def written(folder: Path, key: str, value: float) -> Path:
    file = folder / "program.nc"
    file.write_text(PROGRAMS[key][0].format(f"{value:+.3f}"), encoding="utf-8")
    return file


@pytest.mark.parametrize("key", sorted(PROGRAMS))
def test_a_slide_sent_beyond_its_travel_fails_on_every_control(key: str, tmp_path: Path) -> None:
    _, slide, limit = PROGRAMS[key]
    machine = machine_of(key)
    assert machine.axis(slide).high == limit
    assert check(trunnion.verify(written(tmp_path, key, limit), machine=machine), "travel").passed
    found = check(trunnion.verify(written(tmp_path, key, limit + 12.5), machine=machine), "travel")
    assert not found.passed
    assert found.summary.startswith(
        f"{slide} goes to {limit + 12.5:.3f} in machine coordinates, its limit is {limit:g} mm, 12.500 too far"
    )
    assert found.worst == -12.5
    line = found.places[0].nc_line
    assert f"{slide}{limit + 12.5:+.3f}" in written(tmp_path, key, limit + 12.5).read_text().splitlines()[line - 1]


def test_both_ends_of_a_travel_are_told(tmp_path: Path) -> None:
    file = tmp_path / "part.mpf"
    file.write_text(HEAD + "SUPA G0 X300 D0\nSUPA G0 X=-250.5 D0\nG53 G0 Y151 D0\nG153 G0 Z251 D0\n" + FOOT)
    found = check(trunnion.verify(file, machine="yl569"), "travel")
    assert sorted((place.value, place.nc_line) for place in found.places) == [
        (-250.5, 9),
        (151, 10),
        (251, 11),
        (300, 8),
    ]


@pytest.mark.parametrize("block", ["SUPA G0 X{:.3f} D0\n", "G0 X{:.3f}\n"])
def test_a_thousandth_beyond_the_travel_is_beyond(block: str, tmp_path: Path) -> None:
    file = tmp_path / "part.mpf"
    for value, is_within in ((250.0, True), (250.001, False)):
        file.write_text(HEAD + "G0 X0 Y0 Z50\n" + block.format(value) + FOOT)
        found = trunnion.verify(file, machine="yl569", zero=(0, 0, 0), tool_length=50.0)
        assert check(found, "travel").passed == is_within


def test_with_a_zero_the_limits_are_the_same(tmp_path: Path) -> None:
    found = trunnion.verify(written(tmp_path, "yl569", 300.0), machine="yl569", zero=(0, 0, 0), tool_length=50.0)
    assert not check(found, "travel").passed
    inside = trunnion.verify(written(tmp_path, "yl569", 250.0), machine="yl569", zero=(0, 0, 0), tool_length=50.0)
    assert check(inside, "travel").passed


def test_home_in_inches_is_home(tmp_path: Path) -> None:
    """A home of 250 mm is 9.84252 inches; four decimals are 250.0004 mm."""
    machine = load_machine("matsuura_mx330")
    axes = tuple(replace(a, low=-100.0, high=250.0, home=250.0) if a.name == "Z" else a for a in machine.axes)
    file = tmp_path / "inch.nc"
    file.write_text("%\nO1\nG20 G17 G40 G80 G90 G94\nG53 G0 Z9.8426\nM30\n%\n")
    assert check(trunnion.verify(file, machine=replace(machine, axes=axes)), "travel").passed
    file.write_text("%\nO1\nG20 G17 G40 G80 G90 G94\nG53 G0 Z9.85\nM30\n%\n")
    assert not check(trunnion.verify(file, machine=replace(machine, axes=axes)), "travel").passed


def test_slides_that_a_block_does_not_name_do_not_count(tmp_path: Path) -> None:
    """X stands at 400 from a workpiece zero that nobody knows; the retract names Z alone."""
    file = tmp_path / "part.mpf"
    file.write_text(HEAD + "G0 X400 Y0 Z50\n" + FOOT)
    assert check(trunnion.verify(file, machine="yl569"), "travel").passed


def test_the_command_fails_and_no_place_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = written(tmp_path, "yl569", 300.0)
    assert main(["verify", str(file), "--machine", "yl569"]) == 1
    assert "X goes to 300.000 in machine coordinates" in capsys.readouterr().out
    with pytest.raises(RefusedError) as refused:
        trunnion.place(file, machine="yl569", turns=[0.0])
    [problem] = refused.value.problems
    assert (problem.code, problem.line) == ("PLC180", 9)
    assert "X goes to 300.000 in machine coordinates, its limit is 250 mm" in str(problem)


def test_steps_from_an_unknown_place_do_not_count(tmp_path: Path) -> None:
    """Z is 200 above a zero that nobody knows, and goes up by 100."""
    file = tmp_path / "part.mpf"
    file.write_text(HEAD + "G0 X0 Y0 Z200\nG91 SUPA G0 Z100 D0\nG90\n" + FOOT)
    assert check(trunnion.verify(file, machine="yl569"), "travel").passed
    known = trunnion.verify(file, machine="yl569", zero=(0, 0, 0), tool_length=0.0)
    assert check(known, "travel").summary.startswith("Z goes to 300.000 in machine coordinates")
