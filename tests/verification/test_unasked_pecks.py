"""Pecks are those of STEP, and what no CL file says of them is named where the program has it otherwise than usual."""

from pathlib import Path

import pytest

import trunnion
from trunnion.verification.results import Check

MACHINES = {
    "Sinumerik": "yl569", "Heidenhain": "dmu65", "Fanuc": "matsuura_mx330", "Haas": "haas_umc750",
    "LinuxCNC": "xyzac_trt", "Fidia": "hs664rt",
}  # fmt: skip
CYCLES = {
    "deep": "DRILL,DEEP,STEP,4.0,RAPTO,3.0,FEDTO,-21.0,RTRCTO,15.0,MMPM,220.0",
    "shorter": "DRILL,DEEP,STEP,6.0,1.0,3.0,RAPTO,3.0,FEDTO,-30.0,RTRCTO,15.0,MMPM,220.0",
    "chips": "DRILL,BRKCHP,STEP,3.0,RAPTO,2.0,FEDTO,-14.0,RTRCTO,12.0,MMPM,180.0",
    "shorter chips": "DRILL,BRKCHP,STEP,6.0,1.0,3.0,RAPTO,2.0,FEDTO,-28.0,RTRCTO,12.0,MMPM,180.0",
    "tap in pecks": "TAP,BRKCHP,STEP,3.0,RAPTO,5.0,FEDTO,-11.0,RTRCTO,9.0,MMPR,1.25",
}


def cl_file(folder: Path, cycle: str) -> Path:
    path = folder / "holes.cls"
    path.write_text(
        "PARTNO/HOLES\nUNITS/MM\nTOOL PATH/HOLES,TOOL,T8\nTLDATA/DRILL,MILL,5.0,0.0,75.0,0.0,0.0\n"
        "MSYS/0,0,0,1,0,0,0,1,0\nPAINT/PATH\nLOAD/TOOL,8,ADJUST,8\nSPINDL/RPM,600,CLW\nRAPID\nGOTO/16,2,40,0,0,1\n"
        f"CYCLE/{CYCLES[cycle]}\nGOTO/16,2,0\nGOTO/-7,13,0\nCYCLE/OFF\nRAPID\nGOTO/-7,13,40\nSPINDL/OFF\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    return path


def holes_of(folder: Path, family: str, cycle: str, found: str, instead: str) -> tuple[Check, Check]:
    """The check of the sound program, and that of one in which a text is another."""
    cl, machine = cl_file(folder, cycle), MACHINES[family]
    sound, other = folder / f"sound.{family[0]}", folder / ("other.h" if family == "Heidenhain" else "other.nc")
    sound = sound.with_suffix(other.suffix)
    trunnion.post(cl, machine=machine, output=sound)
    text = sound.read_text(encoding="utf-8")
    assert found in text
    other.write_text(text.replace(found, instead), encoding="utf-8")
    one, two = (
        next(check for check in trunnion.verify(each, machine=machine, cl=cl).checks if check.key == "holes")
        for each in (sound, other)
    )
    return one, two


@pytest.mark.parametrize(
    ("family", "cycle", "found", "instead", "told"),
    [
        ("Sinumerik", "deep", "0.0,0,0,0)", "0.0,0,0,3)", "DIS1 3"),
        ("Sinumerik", "chips", "0.0,1.,0,0)", "0.0,2.,0,0)", "VRT 2"),
        ("Sinumerik", "tap in pecks", "1,3.,1.", "1,3.,2.", "VRT 2"),
        ("Heidenhain", "deep", "Q258=+0.2", "Q258=+2", "Q258 2"),
        ("Heidenhain", "deep", "Q259=+0.2", "Q259=+0", "Q259 0"),
        ("Heidenhain", "chips", "Q256=+0.2", "Q256=+2", "Q256 2"),
        ("Heidenhain", "shorter chips", "Q256=+0.2", "Q256=+2", "Q256 2"),
        ("Heidenhain", "tap in pecks", "Q256=+1", "Q256=+2", "Q256 2"),
        ("Heidenhain", "tap in pecks", "Q403=+1", "Q403=+2", "Q403 2"),
        ("LinuxCNC", "deep", "G83", "G83 D0.7", "D 0.7"),
        ("LinuxCNC", "chips", "G73", "G73 D0.7", "D 0.7"),
        ("Fidia", "chips", "Z-2.5 F3000", "Z-2.4 F3000", "a lift of 0.6 mm to break chips"),
        ("Fanuc", "shorter chips", "G0 Z-5.5", "G0 Z-5.3", "a lift of 0.7 mm to break chips"),
        ("Haas", "shorter chips", "G0 Z-5.5", "G0 Z-5.3", "a lift of 0.7 mm to break chips"),
    ],
)
def test_what_nobody_asked_for_is_named(
    family: str, cycle: str, found: str, instead: str, told: str, tmp_path: Path
) -> None:
    sound, other = holes_of(tmp_path, family, cycle, found, instead)
    assert sound.passed
    assert not sound.missing
    assert other.passed
    assert any("nobody asked for" in each.what and told in each.what for each in other.missing)


@pytest.mark.parametrize(
    ("family", "cycle", "found", "instead"),
    [
        ("Sinumerik", "shorter", ",6.,1.,", ",6.,0.5,"),
        ("Sinumerik", "shorter", "3,3.,", "3,4.,"),
        ("Sinumerik", "shorter chips", ",6.,1.,", ",6.,0.0,"),
        ("Heidenhain", "shorter", "Q212=+1", "Q212=+0.5"),
        ("Heidenhain", "shorter", "Q205=+3", "Q205=+4"),
        ("Heidenhain", "shorter chips", "Q212=+1", "Q212=+2"),
    ],
)
def test_pecks_get_shorter_as_the_cl_file_says(
    family: str, cycle: str, found: str, instead: str, tmp_path: Path
) -> None:
    sound, other = holes_of(tmp_path, family, cycle, found, instead)
    assert sound.passed
    assert not other.passed
    assert any("STEP of the CL file" in place.text or "pecks" in place.text for place in other.places)
