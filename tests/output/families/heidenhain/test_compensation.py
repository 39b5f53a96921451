"""R0, RL and RR make no block alone: they wait for the next motion, whatever stands before it."""

from pathlib import Path

import pytest

import trunnion

JOB = """UNITS/MM
TOOL PATH/CONTOUR,TOOL,EM12
TLDATA/MILL,12,0,75,0,0
LOAD/TOOL,5
SPINDL/RPM,1800,CLW
RAPID
GOTO/-40,0,50
FEDRAT/MMPM,200
GOTO/-40,0,20
{left}GOTO/-30,0,20
{skip}GOTO/0,0,20
{off}GOTO/0,-20,20
RAPID
GOTO/0,-20,60
END-OF-PATH
"""


@pytest.mark.parametrize(
    ("left", "skip", "off"),
    [
        ("CUTCOM/LEFT\nDELAY/2\n", "", "CUTCOM/OFF\nDELAY/2\n"),
        ("CUTCOM/LEFT\nPPRINT/A\n", "", "CUTCOM/OFF\nPPRINT/B\n"),
        ("CUTCOM/LEFT\nOPSTOP\n", "", "CUTCOM/OFF\nSTOP\n"),
        ("CUTCOM/LEFT\n", "OPSKIP/ON\n", "OPSKIP/OFF\nCUTCOM/OFF\n"),
        ("CUTCOM/RIGHT\nDELAY/1\nCUTCOM/LEFT\n", "", "CUTCOM/OFF\n"),
    ],
)
def test_radius_compensation_waits_for_the_next_motion(left: str, skip: str, off: str, tmp_path: Path) -> None:
    cl, nc = tmp_path / "contour.cls", tmp_path / "contour.h"
    cl.write_text(JOB.format(left=left, skip=skip, off=off))
    trunnion.post(cl, machine="dmu65", output=nc)
    blocks = [line.split(" ", 1)[1] for line in nc.read_text().splitlines()]
    words = {block: [word for word in block.split() if word in ("R0", "RL", "RR")] for block in blocks}
    assert words["L X-30 RL"] == ["RL"]
    assert next(found for block, found in words.items() if block.startswith("L") and "Y-20" in block) == ["R0"]
    # The program converts with the same words.
    back = tmp_path / "back.h"
    trunnion.convert(nc, machine="dmu65", to_machine="dmu65", output=back)
    assert [line.split()[-1] for line in back.read_text().splitlines() if " RL" in line] == ["RL"]


@pytest.mark.parametrize("machine", ["dmu65", "yl569"])
def test_a_side_that_would_wait_for_a_motion_which_is_not_skipped_is_refused(machine: str, tmp_path: Path) -> None:
    """R0 stands in the block behind OPSKIP/OFF, so that who skips blocks gets it too; G40 has a block of its own."""
    cl, nc = tmp_path / "contour.cls", tmp_path / "contour.nc"
    cl.write_text(JOB.format(left="CUTCOM/LEFT\n", skip="OPSKIP/ON\n", off="CUTCOM/OFF\nOPSKIP/OFF\n"))
    if machine == "yl569":
        assert trunnion.post(cl, machine=machine, output=nc).passed
        return
    with pytest.raises(trunnion.InputError, match="acts in the motion behind OPSKIP/OFF in line 15"):
        trunnion.post(cl, machine=machine, output=nc)


@pytest.mark.parametrize(
    "between", ["", "CUTCOM/OFF\n", "CUTCOM/OFF\nGOTO/0,0,30\n", "CUTCOM/OFF\nOPSKIP/ON\nGOTO/9,9,20\nOPSKIP/OFF\n"]
)
def test_the_other_side_without_a_motion_in_the_plane_between_is_refused_with_its_line(
    between: str, tmp_path: Path
) -> None:
    cl, nc = tmp_path / "contour.cls", tmp_path / "contour.h"
    text = JOB.format(left="CUTCOM/LEFT\n", skip="", off=between + "CUTCOM/RIGHT\nGOTO/40,0,20\nCUTCOM/OFF\n")
    cl.write_text(text)
    with pytest.raises(trunnion.InputError, match="CUTCOM/RIGHT behind CUTCOM/LEFT, with no motion") as refused:
        trunnion.post(cl, machine="dmu65", output=nc)
    assert refused.value.problems[-1].line == text.splitlines().index("CUTCOM/RIGHT") + 1
    text = text.replace("OPSKIP/ON\n", "").replace("OPSKIP/OFF\n", "")
    cl.write_text(text.replace("CUTCOM/RIGHT", "CUTCOM/OFF\nGOTO/20,20,20\nCUTCOM/RIGHT"))
    assert trunnion.post(cl, machine="dmu65", output=nc).passed
