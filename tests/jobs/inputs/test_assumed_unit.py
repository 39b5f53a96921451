"""A CL file that states no length unit: every command says that it is taken to be in mm, and what stands on that."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.verification import Verification

BARE = HEAD.replace("FEDRAT/MMPM,500.0", "FEDRAT/500.0") + FOOT
APT = "PARTNO A\nMULTAX\nLOADTL/1\nSPINDL/4000,CLW\nRAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/500\nGOTO/10,0,5,0,0,1\nFINI\n"
SAID = "nothing says whether it is in mm or inches: assumed mm"


def said_of(text: str, folder: Path, **how: str) -> list[str]:
    file = folder / "a.cls"
    file.write_text(text, encoding="utf-8")
    return [problem.wording.what for problem in trunnion.read_cl(file, **how).remarks if problem.code == "CL420"]  # type: ignore[arg-type]


@pytest.mark.parametrize("text", [BARE, APT])
def test_mm_is_assumed_only_where_neither_file_nor_user_says_the_unit(text: str, tmp_path: Path) -> None:
    assert said_of(text, tmp_path) == [SAID]
    assert said_of(text, tmp_path, units="mm") == []
    assert said_of("UNITS/MM\n" + text, tmp_path) == []
    assert said_of(text.replace("FEDRAT/500", "FEDRAT/MMPM,500"), tmp_path) == []


@pytest.mark.parametrize("command", ["info", "post", "verify", "place", "reach", "fit", "simulate"])
def test_every_command_that_reads_cl_says_so(command: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file, program = tmp_path / "a.cls", tmp_path / "a.mpf"
    file.write_text(BARE, encoding="utf-8")
    on = ["--machine", "yl569"]
    if command in ("verify", "simulate"):
        trunnion.post(file, machine="yl569", output=program)
    arguments = {
        "info": [str(file)],
        "post": [str(file), *on, "--output", str(program)],
        "verify": [str(program), "--cl", str(file), *on],
        "place": [str(file), *on],
        "reach": [str(file), *on],
        "fit": [str(file)],
        "simulate": [str(program), "--cl", str(file), *on, "--stock", "box:30,10,5,-5,-5,0", "--cell", "1"],
    }[command]
    main([command, *arguments])
    assert SAID in capfd.readouterr().err


def test_what_passed_stands_on_the_unit_and_strict_demands_it(tmp_path: Path) -> None:
    file = tmp_path / "a.cls"
    file.write_text(BARE, encoding="utf-8")
    posted = trunnion.post(file, machine="yl569", output=tmp_path / "a.mpf")
    assert posted.standing is not None
    assert posted.standing.assumed_unit == "mm"
    assert "assumed: the CL file is in mm" in posted.standing.line()
    stated = trunnion.post(file, machine="yl569", output=tmp_path / "b.mpf", settings={"cl_units": "mm"})
    assert stated.standing is not None
    assert stated.standing.assumed_unit == ""
    proven = trunnion.verify(tmp_path / "a.mpf", cl=file, machine="yl569", strict=True)
    assert "assumed: the CL file is in mm" in basis_of(proven)
    proven = trunnion.verify(tmp_path / "a.mpf", cl=file, machine="yl569", strict=True, units="mm")
    assert "the CL file" not in basis_of(proven)


def basis_of(proven: Verification) -> str:
    return next(check.told for check in proven.checks if check.key == "basis")
