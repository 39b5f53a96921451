"""The setting ``compensation``: CUTCOM is left out where it is stated, told, and proven."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.errors import InputError, Severity

_CUT = "CUTCOM/LEFT\nGOTO/20,9,5\nGOTO/20,20,5\nCUTCOM/OFF\nGOTO/30,20,5\n"
MACHINES = {
    "matsuura_mx330": "G41",
    "haas_umc750": "G41",
    "xyzac_trt": "G41",
    "hs664rt": "G41",
    "yl569": "G41",
    "dmu65": "RL",
}


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """Two operations with CUTCOM."""
    path = tmp_path / "part.cls"
    path.write_text(HEAD + _CUT + FOOT + HEAD.replace("OP1", "OP2") + _CUT + FOOT)
    return path


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("stated", "left"), [(None, 2), ("OP2:left_out", 1), ("left_out,OP1:programmed", 1), ("left_out", 0)]
)
def test_cutcom_is_left_out_where_it_is_stated(part: Path, machine: str, stated: str | None, left: int) -> None:
    settings = {"compensation": stated} if stated else {}
    program = part.with_suffix(".nc")
    found = trunnion.post(part, machine=machine, settings=settings, output=program)
    assert found.passed
    assert program.read_text(encoding="utf-8").split().count(MACHINES[machine]) == left
    told = [each for each in found.problems if each.wording.variant == "cutcom_left_out"]
    assert [each.severity for each in told] == [Severity.WARNING] * (2 - left)
    assert trunnion.verify(program, machine=machine, cl=[part], settings=settings).passed
    assert trunnion.verify(program, machine=machine, cl=[part]).passed is (left == 2)


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        ("left", "compensation"),
        ("OP9:left_out", "none of that name"),
        ("OP1:left_out,OP1:programmed", "two values"),
    ],
)
def test_what_cannot_be_stated_is_refused(part: Path, stated: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        trunnion.post(part, machine="yl569", settings={"compensation": stated})


@pytest.mark.parametrize("contour", ["$$ contour data\n", ""])
def test_points_of_a_contour_are_not_cut_by_the_tools_centre(part: Path, contour: str) -> None:
    part.write_text(HEAD + contour + _CUT + FOOT)
    stated = {"compensation": "left_out"} | ({} if contour else {"cutcom": "contour"})
    with pytest.raises(InputError, match="cut into the part by its radius"):
        trunnion.post(part, machine="yl569", settings=stated)
