"""``--dialect``, and the line that says what a CL file was read as."""

from pathlib import Path

import pytest

from tests.support.cl_dialects import WRITERS, Step
from trunnion.cli import main

PATH = [
    Step("TOOL", (5.0, 10.0, 1.0)),
    Step("SPINDLE", (900.0,), "CLW"),
    Step("RAPID", point=(10.0, 0.0, 50.0)),
    Step("FEED", (300.0,)),
    Step("GOTO", point=(10.0, 0.0, 5.0)),
    Step("ARC", point=(0.0, 10.0, 5.0), centre=(0.0, 0.0, 5.0), start=(10.0, 0.0, 5.0)),
    Step("RAPID", point=(1.0, 2.0, 50.0)),
    Step("CYCLE", (5.0, 2.0, 90.0, 1.0), "DRILL", holes=((1.0, 2.0, 3.0), (4.0, 5.0, 3.0))),
    Step("RAPID", point=(4.0, 5.0, 50.0)),
    Step("TOOL", (6.0, 8.0, 0.0)),
    Step("SPINDLE", (1200.0,), "CLW"),
    Step("RAPID", point=(30.0, 0.0, 60.0), axis=(0.6, 0.0, 0.8)),
    Step("FEED", (250.0,)),
    Step("GOTO", point=(20.0, 0.0, 10.0), axis=(0.6, 0.0, 0.8)),
    Step("GOTO", point=(20.0, 8.0, 10.0), axis=(0.6, 0.0, 0.8)),
    Step("RAPID", point=(30.0, 8.0, 60.0), axis=(0.6, 0.0, 0.8)),
]


def file_in(folder: Path, dialect: str) -> Path:
    """The path in a dialect, under a name that says nothing."""
    file = folder / "part.txt"
    file.write_text(WRITERS[dialect](False).write(PATH), encoding="utf-8")
    return file


def blocks(program: Path) -> list[str]:
    """The blocks of a program without numbers and comments."""
    lines = (line.partition(";")[0].partition(" ")[2].strip() for line in program.read_text().splitlines())
    return [line for line in lines if line and "MSG" not in line and not line.startswith("*")]


@pytest.mark.parametrize("machine", ["yl569", "dmu65"])
@pytest.mark.parametrize("dialect", [name for name in WRITERS if name != "clsf"])
def test_the_program_is_that_of_the_clsf(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], dialect: str, machine: str
) -> None:
    programs = []
    for name in ("clsf", dialect):
        program = tmp_path / "part.nc"
        assert main(["post", str(file_in(tmp_path, name)), "--machine", machine, "--output", str(program)]) == 0
        programs.append(blocks(program))
        assert ("read as" in capsys.readouterr().err) == (name != "clsf")
    assert programs[0] == programs[1]


def test_the_line_says_by_what_it_was_recognized(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = file_in(tmp_path, "ncl")
    assert main(["post", str(file), "--machine", "yl569", "--output", "-"]) == 0
    assert f"{file}: read as Creo NCL: $$*          Pro/CLfile in line 1" in capsys.readouterr().err


def test_the_option_overrules_the_content(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = file_in(tmp_path, "ncl")
    assert main(["post", str(file), "--machine", "yl569", "--output", "-", "--dialect", "clsf"]) == 2
    assert "write TOOL PATH/name,TOOL,tool before it" in capsys.readouterr().err
    program = tmp_path / "a.mpf"
    assert main(["post", str(file), "--machine", "yl569", "--output", str(program), "--set", "dialect=ncl"]) == 0
    assert main(["verify", str(program), "--machine", "yl569", "--cl", str(file), "--dialect", "ncl"]) == 0
    assert main(["verify", str(program), "--machine", "yl569", "--cl", str(file), "--dialect", "clsf"]) == 2


def test_the_dialect_is_given_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [
        "post",
        str(file_in(tmp_path, "ncl")),
        "--machine",
        "yl569",
        "--dialect",
        "ncl",
        "--set",
        "dialect=apt",
    ]
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert "are the same" in capsys.readouterr().err


def test_files_in_different_systems_are_no_job(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = file_in(tmp_path, "ncl").read_text(encoding="utf-8")
    files = []
    for shift in ("0.0", "7.0"):
        files.append(tmp_path / f"{shift}.ncl")
        files[-1].write_text(text.replace("1.0, 0.0, 0.0, 0.0", f"1.0, 0.0, 0.0, {shift}", 1), encoding="utf-8")
    assert main(["post", *map(str, files), "--machine", "yl569", "--output", "-"]) == 2
    assert "its points are in another coordinate system" in capsys.readouterr().err
