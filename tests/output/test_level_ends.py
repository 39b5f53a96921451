"""A hole operation that goes on along Z: no plane of zero angles is turned for it."""

import re
from pathlib import Path

import pytest

from tests.support.posting import CLEAR, FOOT
from tests.support.proof import unproven
from trunnion.cli import main

TILTED = CLEAR.replace("0.0,0.0,50.0,0.0,0.0,1.0", "0.0,40.0,60.0,0.0,0.6,0.8") + (
    "CYCLE/DRILL,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90\nGOTO/0,24,32,0,0.6,0.8\nGOTO/10,24,32\nCYCLE/OFF\n"
    "RAPID\nGOTO/10.0,60.0,80.0\n"
)
UP = "RAPID\nGOTO/10.0,60.0,120.0,0.0,0.0,1.0\n"
HOLE = "CYCLE/DRILL,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90\nGOTO/30,0,40,0,0,1\nGOTO/40,0,40\nCYCLE/OFF\n"
AGAIN = (
    "RAPID\nGOTO/10.0,60.0,80.0,0.0,0.6,0.8\nCYCLE/DRILL,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90\nGOTO/20,24,32\nCYCLE/OFF\n"
)

#: What a plane with three angles is, by control.
PLANES = {
    "dmu65": r"PLANE SPATIAL SPA(\S+) SPB(\S+) SPC(\S+)",
    "mikron_600u": r"PLANE SPATIAL SPA(\S+) SPB(\S+) SPC(\S+)",
    "ucp800": r"PLANE SPATIAL SPA(\S+) SPB(\S+) SPC(\S+)",
    "yl569": r'CYCLE800\(0,"",0,57,[^,]+,[^,]+,[^,]+,([^,]+),([^,]+),([^,]+),',
    "matsuura_mx330": r"G68\.2 X\S+ Y\S+ Z\S+ I(\S+) J(\S+) K(\S+)",
}


def planes(name: str, text: str, folder: Path, capfd: pytest.CaptureFixture[str]) -> list[list[float]]:
    """The angles of the planes of a proven program."""
    file = folder / "part.cls"
    file.write_text(text + FOOT, encoding="utf-8")
    code = main(["post", str(file), "--machine", name, "--output", "-"])
    out, err = capfd.readouterr()
    assert (code, unproven(err)) == (0, "")
    return [[float(angle) for angle in found] for found in re.findall(PLANES[name], out)]


@pytest.mark.parametrize("name", PLANES)
@pytest.mark.parametrize(("text", "count"), [(TILTED, 1), (TILTED + UP, 1), (TILTED + UP + HOLE, 1)])
def test_no_plane_has_angles_of_zero(
    name: str, text: str, count: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    found = planes(name, text, tmp_path, capfd)
    assert len(found) == count
    assert all(any(angles) for angles in found)


@pytest.mark.parametrize("name", PLANES)
def test_holes_along_z_between_tilted_ones_need_none_either(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    found = planes(name, TILTED + UP + HOLE + AGAIN, tmp_path, capfd)
    assert len(found) == 2
    assert all(any(angles) for angles in found)
