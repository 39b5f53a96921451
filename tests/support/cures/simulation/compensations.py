"""Cures of messages about radius compensation: what its register holds, and where a control cannot do it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, post
from tests.support.cures.simulation.simulations import on
from trunnion.compensation.centre_toolpaths import toolpaths_of_centre

_CONTOUR: Final = (
    "T5 M6\nG54 S500 M3\nG0 X-20 Y-20 Z50 D1\nG0 Z-1\nG41 G1 X0 Y-10 F300\nG1 Y20\nG40 G1 X-20\nG0 Z50\nM30\n"
)
_TOOL: Final = "5=flat:10,length=60,flutes=30"


def _centre(machine: str = "yl569", **given: str) -> Trial:
    """Return what simulates a contour at the edge of a block, whose compensation is by the radius of the tool."""
    how = {"tools": _TOOL, "radius_register": "radius", "zero": "0,0,0", "tool_length": "100", **given}
    return on(machine, stock="box:40,40,10", **how)


_UNSTATED: Final = on("yl569", tools=_TOOL, stock="box:40,40,10", zero="0,0,0", tool_length="100")
_NARROW: Final = _CONTOUR.replace("G1 Y20\n", "G1 Y20\nG1 X-4\nG1 Y0\n")
_LINUXCNC: Final = (
    "G21 G90 G17 G40 G49\nT5 M6\nG43 H5 S1000 M3\nG0 X-20 Y-20 Z20\nG0 Z-1\nG41 G1 X-16 Y-20 F500\nG1 Y20\nG40 X-30\n"
    "G0 Z20\nG49\nM5\nM2\n"
)
_CIRCLE: Final = _CONTOUR.replace("G41 G1 X0 Y-10", "G41 G2 X0 Y-10 CR=30")

_CL: Final = """TOOL PATH/POCKET,TOOL,EM12
TLDATA/MILL,12,0,75,0,0
$$ contact contour data
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,5300,CLW
RAPID
GOTO/0,0,50,0,0,1
RAPID
GOTO/0,0,2
FEDRAT/MMPM,300
GOTO/0,0,-9
GOTO/0,-14,-9
CUTCOM/LEFT,ADJUST,1
GOTO/10,-14,-9
GOTO/10,-30,-9
GOTO/46,-30,-9
GOTO/46,30,-9
GOTO/-46,30,-9
GOTO/-46,-30,-9
GOTO/20,-30,-9
CUTCOM/OFF
GOTO/10,-14,-9
RAPID
GOTO/10,-14,50
END-OF-PATH
"""
_OF_CENTRE: Final = _CL.replace("$$ contact contour data\n", "")
_NO_SIZE: Final = ("TLDATA/MILL,12,0,75,0,0\n", "")


def _centre_of(style: int) -> Trial:
    """Return what makes the path of the centre of a CL file, as a control of a style goes."""

    def made(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.cls").write_text(text, encoding="utf-8")
        _, problems = toolpaths_of_centre([trunnion.read_cl(folder / "part.cls")], style)
        return Outcome(tuple(problems), True)

    return made


def _posted_and_simulated(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file, and simulate the program with it."""
    cl, program = folder / "part.cls", folder / "posted.mpf"
    cl.write_text(text, encoding="utf-8")
    trunnion.post(cl, machine="yl569", output=program)
    return on("yl569", stock="box:120,80,10,-60,-40,-9", tools="1=flat:12,length=75,flutes=30", cl=cl)(
        program.read_text(encoding="utf-8"), settings, folder
    )


CURES: Final = (
    Cure("SIM147", "radius_compensation_programmed", _UNSTATED, _CONTOUR, ({"radius_register": "difference"},)),
    Cure("SIM147", "radius_compensation_programmed", _UNSTATED, _CONTOUR, ({"radius_register": "radius"},)),
    Cure("SIM164", "tight", _centre(), _NARROW, (), cured_by=_centre(tools=_TOOL.replace("10", "3", 1))),
    Cure("SIM164", "tight", _centre(), _NARROW, (("G1 X-4\nG1 Y0\n", ""),)),
    Cure("SIM164", "on_circle", _centre(), _CIRCLE, (("G2 X0 Y-10 CR=30", "G1 X0 Y-10"),)),
    Cure(
        "SIM164",
        "short_entry",
        _centre("xyzac_trt", zero="0,-20,12", tool_length="60"),
        _LINUXCNC,
        (("X-16 Y-20", "X2 Y-10"),),
    ),
    Cure("SIM164", "no_contour", _centre(), _CONTOUR.replace("G1 Y20\n", ""), (("G41 ", ""), ("G40 ", ""))),
    Cure("SIM164", "unsure", _centre(), _CONTOUR.replace("G41", "KONT G41"), (("KONT G41 ", ""), ("G40 ", ""))),
    Cure("SIM164", "corners_unsure", _centre_of(0), _CL, (("$$ contact contour data\n", ""),)),
    Cure(
        "SIM147",
        "contour_radius_not_known",
        _centre_of(1),
        _CL.replace(*_NO_SIZE),
        (("TOOL,EM12\n", "TOOL,EM12\nTLDATA/MILL,12,0,75,0,0\n"),),
    ),
    Cure(
        "SIM147",
        "difference_not_known",
        post("yl569"),
        _OF_CENTRE.replace(*_NO_SIZE),
        (("TOOL,EM12\n", "TOOL,EM12\nTLDATA/MILL,12,0,75,0,0\n"),),
    ),
    Cure("SIM147", "taken_for_radius", _posted_and_simulated, _CL, ({"radius_register": "radius"},)),
)
