"""Files that are nothing for the control are told what they are, before their errors; programs for it never are."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.errors import Severity
from trunnion.readers.program.kinds import KINDS, recognize

FILES = {
    "lathe.nc": "a program for a lathe",
    "wire.nc": "a program for a wire eroding machine",
    "fagor.pim": "a Fagor program",
    "fadal.nc": "a Fadal program",
    "okuma.min": "an Okuma program",
    "acramatic.nc": "an Acramatic program",
    "iso.i": "a Heidenhain DIN/ISO program",
    "millplus.pm": "a MillPlus program",
    "mach3.tap": "a Mach3 program",
    "listing.txt": "a listing of a postprocessor",
    "prose.nc": "a text, and no program",
}

GOLDEN = {"yl569": "sinumerik", "dmu65": "heidenhain", "matsuura_mx330": "fanuc", "linuxcnc": "linuxcnc"}


@pytest.mark.parametrize(("name", "kind"), FILES.items())
def test_a_foreign_file_is_told_what_it_is_first(name: str, kind: str) -> None:
    run = trunnion.read_program(TESTS / "data" / "kinds" / name, machine="haas_umc750")
    assert run.errors[0].text.startswith(f"this looks like {kind}")


def test_each_kind_has_a_file_or_a_reader() -> None:
    assert {kind.name.what for kind in KINDS if not kind.languages} <= {
        *FILES.values(),
        "a tape with $ at the end of its blocks",
    }


def test_values_behind_equals_signs_are_words_of_a_program(tmp_path: Path) -> None:
    program = tmp_path / "increments.mpf"
    program.write_text("X1\nX=IC(1)\nX=IC(2)\nY = IC(3)\n")
    assert recognize(program) is None


def test_a_tape_is_known_by_the_end_of_its_blocks(tmp_path: Path) -> None:
    tape = tmp_path / "tape.nc"
    tape.write_text("N1G01X+0010000Y+0020000F10$\nN2X+0030000$\nN3M02$\n", encoding="utf-8")
    found = recognize(tape)
    assert found
    assert found.kind.name.what.startswith("a tape with $")


def test_a_lathe_is_known_by_words_of_a_sinumerik(tmp_path: Path) -> None:
    program = tmp_path / "shaft.mpf"
    program.write_text('N10 G18 G90 G95 DIAMON\nN20 LIMS=3000\nN60 CYCLE95("A",2,0.1,0.2,,0.3,0.2,0.1,1)\nM30\n')
    run = trunnion.read_program(program, machine="yl569")
    assert run.errors[0].text.startswith("this looks like a program for a lathe")


@pytest.mark.parametrize("data", ["%\nO0005\nG90 G54\nM30\n%\n".encode("utf-16"), bytes(range(256)) * 8])
def test_what_is_no_text_does_not_look_like_one(tmp_path: Path, data: bytes) -> None:
    program = tmp_path / "part.nc"
    program.write_bytes(data)
    assert recognize(program) is None
    with pytest.raises(trunnion.TrunnionError) as refused:
        trunnion.read_program(program, machine="matsuura_mx330")
    assert [each.code for each in refused.value.problems] == ["NC110"]


@pytest.mark.parametrize("folder", sorted(path.name for path in (TESTS / "golden").iterdir() if path.is_dir()))
def test_no_golden_program_looks_like_another_machine(folder: str) -> None:
    for program in (TESTS / "golden" / folder).glob("*.expected.*"):
        found = recognize(program)
        assert not found or not found.found or found.kind.languages, program


def test_a_program_with_an_error_of_its_own_is_not_doubted(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text("%\nO0001\nG21 G17 G40 G80 G90 G94\nG43.4 H1\nG999\nM30\n%\n", encoding="utf-8")
    run = trunnion.read_program(program, machine="matsuura_mx330")
    assert [each.severity for each in run.errors] == [Severity.ERROR] * len(run.errors)
    assert not any("looks like" in each.text for each in run.diagnostics)


def test_a_program_for_another_control_is_doubted_where_nothing_else_is_known(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text("".join(f"N{k} J{k} K{k} @{k}\n" for k in range(9)), encoding="utf-8")
    run = trunnion.read_program(program, machine="matsuura_mx330")
    assert "more lines are not understood" in run.errors[0].text
