"""Cures of checks: a posted program that was edited by hand fails one, and passes it as soon as the edit is undone."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome
from tests.support.posting import FOOT, HEAD, LEANING
from trunnion.errors import Problem, TrunnionError
from trunnion.messages import foreign

_MACHINE: Final = "yl569"
#: Two operations: three-axis with coolant, compensation, an arc, a dwell and a hole; and one under TCP.
_CL: Final = (
    HEAD.replace("RAPID\n", "COOLNT/FLOOD\nRAPID\n", 1)
    + "CUTCOM/LEFT\nGOTO/20,9,5\nGOTO/20,30,5\nCUTCOM/OFF\nGOTO/40,30,5\nCIRCLE/50,30,5,0,0,1,10\nGOTO/60,30,5\n"
    "DELAY/2\nRAPID\nGOTO/60,30,50\nCYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100\nGOTO/70,0,0\nCYCLE/OFF\n"
    + FOOT
    + LEANING.replace("OP1", "OP2")
    + FOOT
)


@cache
def _posted() -> str:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "part.cls"
        file.write_text(_CL, encoding="utf-8")
        return str(trunnion.post(file, machine=_MACHINE, settings={"numbers": "off"}).text)


def _edited(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify the posted program against its CL file; the text is an edit, such as ``S4000 -> S400``, or nothing."""
    cl, file = folder / "part.cls", folder / "part.mpf"
    cl.write_text(_CL, encoding="utf-8")
    old, _, new = text.partition(" -> ")
    assert old in _posted(), _posted()
    file.write_text(_posted().replace(old, new, 1), encoding="utf-8")
    try:
        found = trunnion.verify(file, machine=_MACHINE, cl=[cl], **settings)  # type: ignore[arg-type]
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    failed = [Problem(str(file), 0, foreign(each.title, code=each.key)) for each in found.checks if not each.passed]
    return Outcome(tuple(failed), found.passed)


def _check(key: str, edit: str) -> Cure:
    return Cure(key, "", _edited, edit, ((edit, ""),))


CURES: Final = (
    _check("axis", "B36.8699 -> B35.8699"),
    _check("compensation", "G41 X20. -> G42 X20."),
    _check("coolant", "M3 M8 -> M3"),
    _check("feed", "Z5. F500. -> Z5. F600."),
    _check("holes", "CYCLE81(3.,0.0,3.,-10.) -> CYCLE81(3.,0.0,3.,-12.)"),
    _check("home", "G0 Z=_Z_HOME D0 -> G0 Z=_Z_HOME-50 D0"),
    _check("kind", "G3 X60. -> G2 X60."),
    _check("offset", "G54\nORIWKS -> G55\nORIWKS"),
    _check("order", "Y30.\n -> "),
    _check("span", "G1 X10. Z5. B36.8699 -> G0 C270\nG1 X10. Z5. B-36.8699 C-90"),
    _check("spindle", "S4000 D1 M3 M8 -> S4000 D1 M4 M8"),
    _check("stops", "G4 F2.\n -> "),
    _check("tip", "G41 X20. Y9. -> G41 X20. Y9.5"),
    _check("tool", "T=1 -> T=2"),
    _check("turns", "X70. Y0.0\nMCALL -> X70. Y0.0\nMCALL\nG0 C45"),
    _check("words", "G4 F2. -> G4 F2.\nG777"),
)  # fmt: skip
