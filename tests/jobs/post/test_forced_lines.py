"""With ``force``: all that is told of lines and blocks holds for the file that is written, notices included."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer

CL = """UNITS/MM
TOOL PATH/SIDE,TOOL,BALL_6
TLDATA/MILL,6.0,3.0,70.0,0.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,900,CLW
RAPID
GOTO/0.,0.,50.,0.,0.,1.
FEDRAT/MMPM,500.
GOTO/0.,0.,-2.,0.,0.,1.
GOTO/30.,0.,-2.,0.,0.,1.
RAPID
GOTO/30.,0.,50.,0.,0.,1.
END-OF-PATH
"""


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "hs664rt", "haas_umc750", "xyzac_trt", "matsuura_mx330"])
def test_rows_have_the_lines_of_the_forced_file(tmp_path: Path, machine: str) -> None:
    cl = tmp_path / "side.cls"
    cl.write_text(CL)
    place = tmp_path / "side.nc"
    tall = {"stock": "box:40,10,70,-5,-5,-10", "cell": 2.0}
    result = trunnion.post(cl, machine=machine, output=place, force=True, simulation=tall)
    assert [check.key for check in result.checks if not check.passed] == ["removal"]
    text = place.read_text()
    assert "MUST NOT RUN" in text
    read = trunnion.read_program(place, machine=machine)
    assert result.run is not None
    assert result.run.line.tolist() == read.line.tolist()
    assert result.run.block_number.tolist() == read.block_number.tolist()


class Told(Observer):
    """Keeps what it is told."""

    def __init__(self) -> None:
        self.found: list[Problem] = []

    def problems(self, problems: "list[Problem] | tuple[Problem, ...]") -> None:  # type: ignore[override]
        self.found += problems


def test_a_notice_quotes_blocks_of_its_own_file_and_the_simulation_does(tmp_path: Path) -> None:
    place, told = tmp_path / "hub.mpf", Told()
    given = {"stock": "box:80,40,40,-10,-20,-40", "cell": 2.0}
    result = trunnion.post(
        YL569 / "2_hub_rough.cls", machine="yl569", output=place, force=True, simulation=given, observer=told
    )
    lines = place.read_text().splitlines()
    assert result.simulation is not None
    for found in result.simulation.findings:
        assert lines[found.line - 1].startswith(f"N{found.block} ")
        assert "G0" in "".join(lines[found.line - 4 : found.line])
    (removal,) = [check for check in result.checks if not check.passed]
    assert lines[removal.places[0].nc_line - 1].startswith(f"N{removal.places[0].number} ")
    remarks = [each for each in told.found if each.file == str(place)]
    assert len(remarks) == len(set(remarks)) > 0


def test_a_place_of_a_check_is_in_the_forced_file(tmp_path: Path) -> None:
    cl, place = tmp_path / "wide.cls", tmp_path / "wide.mpf"
    cl.write_text(CL.replace("30.,0.,50.", "1400.,0.,50."))
    settings = {"zero": "0,0,0", "tool_length": "100"}
    result = trunnion.post(cl, machine="yl569", output=place, force=True, settings=settings)
    lines = place.read_text().splitlines()
    (travel,) = [check for check in result.checks if not check.passed]
    assert lines[travel.places[0].nc_line - 1].startswith(f"N{travel.places[0].number} G0 X1400.")
    assert sum("MUST NOT RUN" in line for line in lines) == 2
