"""CL files converted to other dialects by the library and by the command."""

import gzip
import io
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cl.writers.ncl import NclWriter
from trunnion.cli import main

CL = YL569 / "2_hub_rough.cls"


@pytest.mark.parametrize(("dialect", "extension"), [("clsf", "cls"), ("catia", "aptsource"), ("ncl", "ncl")])
def test_a_cl_file_becomes_one_of_another_dialect(
    dialect: str, extension: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    into = tmp_path / f"{CL.stem}.{extension}"
    assert main(["convert", str(CL), "--to-cl", "--to-dialect", dialect, "--output", str(tmp_path)]) == 0
    said = capfd.readouterr().err
    assert f"{into}: 23 points, 1 operation" in said
    found = trunnion.convert(CL, to_cl=True, to_dialect=dialect)
    assert found.passed
    assert found.text == into.read_text(encoding="utf-8")
    assert ("phases of motion" in said) is (dialect != "clsf")
    first, second = trunnion.read_cl(CL).operations[0].moves, trunnion.read_cl(into).operations[0].moves
    np.testing.assert_array_equal(first.tip, second.tip)
    np.testing.assert_allclose(first.axis, second.axis, atol=1e-12)


def test_units_are_those_of_the_file_or_of_the_setting(tmp_path: Path) -> None:
    inch = tmp_path / "inch.ncl"
    inch.write_text("UNITS / INCHES\n$$-> CUTTER / 0.5\nLOADTL / 1\nFEDRAT / 10.0, IPM\nGOTO / 1.2345, 2, 3\nFINI\n")
    text = trunnion.convert(inch, to_cl=True, to_dialect="catia").text
    assert text is not None
    assert "UNITS/INCHES" in text
    assert "GOTO  / 1.234500, 2.000000, 3.000000" in text
    assert "FEDRAT/ 10.0000, IPM" in text
    assert "CUTTER/ 0.500000" in text
    text = trunnion.convert(inch, to_cl=True, settings={"units": "mm"}).text
    assert text is not None
    assert "GOTO/31.356300,50.800000,76.200000\n" in text
    assert "FEDRAT/MMPM,254.0000" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--to-cl", "--set", "title=A"], "--set: error: title has no meaning between two CL files"),
        (["--to-cl", "--set", "units=foot"], "--set: error: units is 'foot'; write units=mm or units=inch"),
        (["--to-cl", "--force"], "--force: error: has no meaning for a CL file"),
        (["--to-cl", "--zero", "0,0,0"], "--zero: error: has no meaning for a CL file"),
        (["--to-machine", "dmu65"], "--machine: error: is missing"),
        (
            ["--to-machine", "dmu65", "--machine", "yl569", "--to-dialect", "ncl"],
            "--to-dialect: error: is given",
        ),
    ],
)
def test_arguments_about_programs_are_refused(
    arguments: list[str], said: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["convert", str(CL), *arguments, "--output", str(tmp_path)]) == 2
    assert said in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_program_without_its_machine_is_told_so(tmp_path: Path) -> None:
    program = tmp_path / "a.mpf"
    program.write_text("N10 G0 X1\nN20 M30\n")
    with pytest.raises(trunnion.InputError, match="machine: error: is missing, so that the file is read as a CL file"):
        trunnion.convert(program, to_cl=True)


def test_what_would_read_back_otherwise_is_not_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(NclWriter, "spindle", lambda self, event: self.statement("SPINDL", "OFF"))
    with pytest.raises(trunnion.RefusedError, match="SpindleOff instead of SpindleOn"):
        trunnion.convert(CL, to_cl=True, to_dialect="ncl", output=tmp_path / "a.ncl")
    assert not list(tmp_path.iterdir())


def test_packed_files_and_streams(tmp_path: Path, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    packed = tmp_path / "part.cls.gz"
    packed.write_bytes(gzip.compress(CL.read_bytes()))
    expected = trunnion.convert(CL, to_cl=True, to_dialect="ncl").text
    assert main(["convert", str(packed), "--to-cl", "--to-dialect", "ncl", "--output", str(tmp_path)]) == 0
    assert (tmp_path / "part.ncl").read_text(encoding="utf-8") == expected
    assert trunnion.convert(io.BytesIO(CL.read_bytes()), to_cl=True, to_dialect="ncl").text == expected
