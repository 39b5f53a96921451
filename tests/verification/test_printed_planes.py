"""The default tolerance of ``verify`` in tilted planes, whose origins and angles are rounded in the program."""

import math
import re
from pathlib import Path

import pytest

import trunnion

TILT, TURN = math.radians(17.3337), math.radians(41.0071)


def cl_file(folder: Path) -> Path:
    """A contour and a hole in a plane far from the zero, at no round angle and no round origin."""
    x = (math.cos(TURN), math.sin(TURN), 0.0)
    y = (-math.sin(TURN) * math.cos(TILT), math.cos(TURN) * math.cos(TILT), math.sin(TILT))
    points = [(0, 0, 50), (0.0137, 20.0071, 5.0033), (71.0049, 20.0071, 5.0033), (71.0049, -33.3353, 5.0033)]
    lines = [
        "UNITS/MM", "TOOL PATH/TOP,TOOL,EM10", "TLDATA/MILL,10,0,70,0,0", "MSYS/0,0,0,1,0,0,0,1,0", "LOAD/TOOL,1",
        "SPINDL/RPM,1000,CLW", "RAPID", "GOTO/0,0,100", "FEDRAT/MMPM,200", "GOTO/0,0,90", "GOTO/0,0,100", "END-OF-PATH",
        "TOOL PATH/TILTED,TOOL,EM10", "TLDATA/MILL,10,0,70,0,0",
        "MSYS/113.0413,-61.0227,30.0091," + ",".join(f"{value:.12f}" for value in (*x, *y)),
        "SPINDL/RPM,1000,CLW", "RAPID", "GOTO/{},{},{}".format(*points[0]), "FEDRAT/MMPM,200",
        *("GOTO/{},{},{}".format(*point) for point in points[1:]), "RAPID", "GOTO/71.0049,-33.3353,50",
        "CYCLE/DRILL,RAPTO,3,FEDTO,-8,RTRCTO,10,MMPM,120", "GOTO/15.0077,12.0031,0", "CYCLE/OFF", "RAPID",
        "GOTO/15.0077,12.0031,50", "END-OF-PATH",
    ]  # fmt: skip
    path = folder / "plane.cls"
    path.write_text("\n".join(lines) + "\n")
    return path


MACHINES = [("matsuura_mx330", "inch"), ("yl569", "inch"), ("dmu65", "mm")]


@pytest.mark.parametrize(("machine", "units"), MACHINES)
def test_a_program_that_was_proven_is_verified_and_a_digit_more_is_found(
    machine: str, units: str, tmp_path: Path
) -> None:
    cl, nc = cl_file(tmp_path), tmp_path / "plane.nc"
    at = {"zero": (0.0, 0.0, 0.0), "tool_length": 100.0}
    trunnion.post(cl, machine=machine, output=nc, settings={"units": units, "zero": "0,0,0", "tool_length": "100"})
    found = trunnion.verify(nc, machine=machine, cl=cl, columns=False, **at)  # type: ignore[arg-type]
    failed = [check.summary for check in found.checks if not check.passed]
    assert not failed
    twin = tmp_path / "twin.nc"
    if units == "inch":
        trunnion.post(cl, machine=machine, output=twin, settings={"zero": "0,0,0", "tool_length": "100"})
        assert trunnion.diff(nc, twin, machine=machine).same
    # The last coordinate of a cut in the plane, by some digits.
    text = nc.read_text()
    k = next(match.start() for match in re.finditer(r"-?33\.3353|-?33\.335(?!\d)|-?1\.3124\d?", text))
    number = re.match(r"-?[0-9.]+", text[k:])[0]  # type: ignore[index]
    changed = f"{float(number) - (0.01 if units == 'mm' else 0.0005):.{len(number.split('.')[1])}f}"
    nc.write_text(text[:k] + changed + text[k + len(number) :])
    found = trunnion.verify(nc, machine=machine, cl=cl, columns=False, **at)  # type: ignore[arg-type]
    assert "tip" in [check.key for check in found.checks if not check.passed]
    assert units == "mm" or not trunnion.diff(nc, twin, machine=machine).same
