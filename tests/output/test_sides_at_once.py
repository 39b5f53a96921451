"""CUTCOM/OFF behind which nothing moves before CUTCOM begins again: no program is written that fails its own proof."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD

#: A shipped machine for each family.
MACHINES = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")

#: Those of controls that read one block ahead within compensation.
ONE_AHEAD = ("matsuura_mx330", "haas_umc750", "hs664rt")

_BEFORE = "GOTO/10,0,5\nCUTCOM/LEFT\nGOTO/20,0,5\nGOTO/40,0,5\n"
_BEHIND = "GOTO/60,0,5\nGOTO/80,0,5\nCUTCOM/OFF\nGOTO/90,0,5\n"


def post(folder: Path, machine: str, between: str) -> str:
    """What a post is refused for; empty: its program is proven."""
    file = folder / "part.cls"
    file.write_text(HEAD + _BEFORE + between + _BEHIND + FOOT, encoding="utf-8")
    try:
        assert trunnion.post(file, machine=machine).passed
    except trunnion.TrunnionError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    "between",
    [
        "CUTCOM/OFF\nCUTCOM/RIGHT\n",
        "CUTCOM/OFF\nCUTCOM/LEFT\n",
        "CUTCOM/OFF\nCOOLNT/ON\nCUTCOM/RIGHT\n",
        "CUTCOM/OFF\nGOTO/40,0,5\nCUTCOM/RIGHT\n",
        "CUTCOM/OFF\nGOTO/40.0001,0,5\nCUTCOM/RIGHT\n",
        "CUTCOM/RIGHT\nCUTCOM/OFF\nCUTCOM/RIGHT\n",
        "OPSKIP/ON\nCUTCOM/OFF\nGOTO/45,20,5\nOPSKIP/OFF\nCUTCOM/RIGHT\n",
    ],
)
def test_a_side_right_behind_off_is_refused_before_it_is_written(machine: str, between: str, tmp_path: Path) -> None:
    told = post(tmp_path, machine, between)
    assert "fails its proof" not in told
    if machine in ONE_AHEAD:
        assert "behind CUTCOM/OFF, with no motion between them" in told
        assert "write a GOTO across the tool between them" in told


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("between", ["CUTCOM/OFF\nGOTO/40,20,5\nCUTCOM/RIGHT\n", "CUTCOM/OFF\nCUTCOM/OFF\n"])
def test_a_way_between_is_proven(machine: str, between: str, tmp_path: Path) -> None:
    assert not post(tmp_path, machine, between)
