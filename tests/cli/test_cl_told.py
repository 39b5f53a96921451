"""Every command that reads a CL file says as what it was read, in which unit, and what is odd in it."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import FileIn

_BOX = ("--stock", "box:60,60,20,-20,-20,-20", "--cell", "3")

#: What each command that reads CL files is given; ``part.apt`` is one of them.
_COMMANDS = {
    "post": ["part.apt", "--machine", "yl569", "--output", "other.mpf"],
    "convert": ["part.apt", "--to-cl", "--output", "other.cls"],
    "place": ["part.apt", "--machine", "yl569", "--turn", "0"],
    "verify": ["part.mpf", "--machine", "yl569", "--cl", "part.apt"],
    "simulate": ["part.mpf", "--machine", "yl569", "--cl", "part.apt", *_BOX],
    "reach": ["part.apt", "--machine", "yl569", "--step", "45"],
    "fit": ["part.apt", "--machines", "yl569", "--turns", "360"],
    "view": ["part.apt", "--machine", "yl569", "--output", "view.html"],
    "info": ["part.apt"],
}

_PART = """PARTNO/PART
UNITS/INCHES
CUTTER/0.5
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0.,0.,2.,0.,0.,1.
FEDRAT/20,IPM
FROBNICATE/1
GOTO/0.,0.,0.05
GOTO/1.,0.,0.05
RAPID
GOTO/1.,1.,2.
FINI
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "part.apt").write_text(_PART, encoding="utf-8")
    trunnion.post(tmp_path / "part.apt", machine="yl569", output=tmp_path / "part.mpf")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_list_has_all_commands_that_read_cl_files() -> None:
    kinds = {job.name: [each for each in job.options if isinstance(each.kind, FileIn)] for job in JOBS.values()}
    reads = {name for name, files in kinds.items() if any("CL" in each.value_name.split("|") for each in files)}
    assert set(_COMMANDS) == reads


@pytest.mark.parametrize("command", _COMMANDS)
def test_a_command_says_what_it_reads(command: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main([command, *_COMMANDS[command]])
    told = "".join(capsys.readouterr())
    assert told.count("APT CL data (ISO 4343)") == 1
    assert "lengths in inch" in told
    assert "part.apt:9" in told
    assert "FROBNICATE" in told


def test_what_a_file_does_not_state_is_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = _PART.replace("UNITS/INCHES\n", "").replace("FEDRAT/20,IPM", "FEDRAT/20")
    (folder / "part.apt").write_text(text, encoding="utf-8")
    main(["reach", *_COMMANDS["reach"]])
    assert "lengths in mm, which it does not state" in capsys.readouterr().err


@pytest.mark.parametrize(("units", "told"), [("inch", True), ("mm", False)])
def test_the_unit_of_a_file_of_nx_is_said_where_the_program_has_another(
    units: str, told: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / "part.cls"
    source.write_text(HEAD + FOOT, encoding="utf-8")
    program = str(tmp_path / "part.nc")
    main(["post", str(source), "--machine", "matsuura_mx330", "--set", f"units={units}", "--output", program])
    assert ("lengths in mm" in "".join(capsys.readouterr())) is told
