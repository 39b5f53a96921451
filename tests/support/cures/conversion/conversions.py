"""Cures of messages about programs that are converted for another machine."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, post
from trunnion.errors import TrunnionError

_HEAD: Final = "%\nO1\nG21 G17 G40 G49 G69 G80 G90 G94\nT1 M6\nG54 G0 X0. Y0. S900 M3\n"
_BARE: Final = _HEAD + "Z9.\nG1 Z-1. F300.\nX9.\nG0 Z9.\nM30\n%\n"
_UNDER_TCP: Final = """G21 G17 G40 G49 G80 G90 G94
T1 M6
G54
G0 A-20 C0
M428
G0 X0 Y0 Z50 S900 M3
Z9
G1 Z-1 F300
X9
G0 Z50
M429
G49
G53 G0 Z0
M2
"""
_REGISTER: Final = _HEAD + "G43 H1 Z9.\nG1 Z-1. F300.\nG41 D21 X9.\nY9.\nG40 X20.\nG0 Z9.\nG49\nM30\n%\n"
_HOLES: Final = """TOOL PATH/DRILL,TOOL,D8
TLDATA/MILL,8,0,60,0,0
LOADTL/1
SPINDL/RPM,900,CLW
RAPID
GOTO/0,0,50,0,0,1
CYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,20,MMPM,150
GOTO/5,0,0
GOTO/9,0,0
CYCLE/OFF
RAPID
GOTO/9,0,80
END-OF-PATH
"""
_PECKED: Final = _HOLES.replace("CYCLE/DRILL", "CYCLE/DRILL,DEEP").replace("MMPM,150", "MMPM,150,STEP,3")
_TIP: Final = {"positions": "tip"}


def _of_linuxcnc(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Convert a program of a LinuxCNC for a TNC; settings are arguments."""
    return _converted(text, settings, folder, "xyzac_trt")


def _converted(text: str, settings: Mapping[str, str], folder: Path, machine: str = "matsuura_mx330") -> Outcome:
    """Convert a program, of a Fanuc by default, for a TNC; settings are arguments."""
    file, given = folder / "part.nc", dict(settings)
    file.write_text(text, encoding="utf-8")
    registers = dict([given.pop("registers").split("=")]) if "registers" in given else None
    length = float(given.pop("tool_length")) if "tool_length" in given else None
    try:
        found = trunnion.convert(
            file, machine=machine, to_machine="dmu65", registers=registers, tool_length=length,
            **given,  # type: ignore[arg-type]
        )  # fmt: skip
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome(found.problems, found.passed)


def _posted_and_converted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file for a Fanuc, and convert the program that it becomes for a TNC."""
    cl, program = folder / "part.cls", folder / "posted.nc"
    cl.write_text(text, encoding="utf-8")
    trunnion.post(cl, machine="matsuura_mx330", settings=settings, output=program)
    return _converted(program.read_text(encoding="utf-8"), {}, folder)


CURES: Final = (
    Cure("CNV112", "no_register", _converted, _BARE, ({"registers": "D21=tool"},), {**_TIP, "registers": "D21=G5"}),
    Cure("CNV145", "no_length_word", _converted, _BARE, (_TIP,)),
    Cure("CNV145", "no_length_word", _converted, _BARE, ({"positions": "gauge_line", "tool_length": "50"},)),
    Cure(
        "CNV145",
        "gauge_line_without_length",
        _converted,
        _BARE,
        ({"tool_length": "50"},),
        {"positions": "gauge_line"},
    ),
    Cure("CNV145", "no_length_under_tcp", _of_linuxcnc, _UNDER_TCP, (("M428", "G43 H1\nM428"),)),
    Cure("CNV145", "no_length_under_tcp", _of_linuxcnc, _UNDER_TCP, (_TIP,)),
    Cure("CNV163", "cycles_become_motion", _posted_and_converted, _HOLES, (), cured_by=post("dmu65")),
    Cure("CNV163", "pecks_become_motion", _posted_and_converted, _PECKED, (), cured_by=post("dmu65")),
    Cure("CNV146", "registers_not_said", _converted, _REGISTER, ({"registers": "D21=tool"},)),
)
