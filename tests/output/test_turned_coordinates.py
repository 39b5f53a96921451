"""Coordinates that were turned have no noise: seven decimals of a direction are not a place on the part."""

import re
from pathlib import Path

import numpy as np
import pytest

from trunnion.cli import main
from trunnion.model.frames import TURNING_NOISE, without_turning_noise

OPERATION = """TOOL PATH/{name},TOOL,D10
TLDATA/MILL,10,0,75,0,0
MSYS/{msys}
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/70,0,50,0,0,1
FEDRAT/MMPM,500
{rows}END-OF-PATH
"""

UPRIGHT = "0,0,0,1,0,0,0,1,0"
#: Turned by 33 degrees about an axis aslant, with seven decimals.
ASLANT = "13.1234,-27.4321,55.8765,0.8501941,0.4136357,0.3256924,-0.4597298,0.8847647,0.0764197"

HOLES = "CYCLE/DRILL,RAPTO,3,FEDTO,-9,RTRCTO,5,MMPM,100\n" + "".join(
    f"GOTO/{point},{z}\n" for z in ("0", "-20") for point in ("70,0", "0,70", "-70,0", "0,-70", "350,120")
)
CUT = "".join(f"GOTO/{point}\n" for point in ("70,0,-5", "0,70,-5", "-70,0,-5", "-70,0,0"))


def test_lengths_near_a_thousandth_are_that_thousandth() -> None:
    assert without_turning_noise(np.array([69.99999, 1e-5, -1e-5, 12.34567, 5.0004])).tolist() == [
        70.0,
        0.0,
        0.0,
        12.34567,
        5.0004,
    ]


@pytest.mark.parametrize("settings", [(), ("plane=frames",)])
@pytest.mark.parametrize(("rows", "cycles"), [(HOLES, 2), (CUT + "CYCLE/OFF\n", 0)])
def test_the_noise_of_turned_coordinates_does_not_reach_the_program(
    rows: str, cycles: int, settings: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "part.cls"
    plain, turned = (
        OPERATION.format(name=name, msys=msys, rows=rows.replace("CYCLE/OFF\n", ""))
        for name, msys in (("PLAIN", UPRIGHT), ("TURNED", ASLANT))
    )
    path.write_text(plain.replace(rows, CUT) + turned, encoding="utf-8")
    said = [f"--set={setting}" for setting in settings]
    code = main(["post", str(path), "--machine", "yl569", "--output", str(tmp_path / "part.mpf"), *said])
    err = capsys.readouterr().err
    assert code == 0, err
    assert "warning" not in err
    lines = (tmp_path / "part.mpf").read_text(encoding="utf-8").splitlines()
    lines = lines[next(k for k, line in enumerate(lines) if "Operation : TURNED" in line) :]
    assert sum("MCALL CYCLE" in line for line in lines) == cycles
    words = [float(number) for line in lines for number in re.findall(r" [XYZ](-?\d*\.\d+)", line)]
    assert words
    assert not [word for word in words if 0.0 < abs(word - round(word, 3)) <= TURNING_NOISE]
