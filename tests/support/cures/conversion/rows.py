"""What makes rows of conversions: by lines of a program, or by a line in place of another."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, marked
from trunnion.errors import TrunnionError

_ARGUMENTS: Final = ("machine", "to_machine", "to_cl", "to_dialect", "dialect", "units", "zero", "tool_length", "force",
                     "positions")  # fmt: skip
FANUC: Final = "matsuura_mx330"
TNC: Final = "dmu65"


def converting(**fixed: str) -> Trial:
    """Return what converts a file; settings are arguments, and settings of the new program."""

    def converted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        stated = {**fixed, **settings}
        file = folder / ("part.h" if stated.get("machine") == TNC else "part.nc")
        file.write_text(text, encoding="utf-8")
        given: dict[str, Any] = {key: value for key, value in stated.items() if key in _ARGUMENTS}
        for key in ("to_cl", "force"):
            given |= {key: True} if key in given else {}
        if "tool_length" in given:
            given["tool_length"] = float(given["tool_length"])
        more = {key: value for key, value in stated.items() if key not in _ARGUMENTS}
        try:
            found = trunnion.convert(file, settings=more or None, **given)
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        return Outcome(found.problems, found.passed)

    return converted


PROGRAMS: Final = {
    FANUC: (
        "%\nO0001\nG21 G17 G90 G94 G40 G80 G54\nT1 M6\nS1000 M3\nG0 G43 H1 X0. Y0. Z50.\n",
        "G1 Z-1. F100\nX10.\nG0 X20.\nZ50.\nM5\nG53 G0 Z0.\nM30\n%\n",
    ),
    "yl569": (
        "G710 G17 G90 G94 G54\nT1\nM6\nS1000 M3\nG0 X0 Y0 Z50 D1\n",
        "G1 Z-1 F100\nX10\nG0 X20\nZ50\nM5\nSUPA G0 Z0 D0\nM30\n",
    ),
    TNC: (
        "BEGIN PGM A MM\nCYCL DEF 247 DATUM SETTING Q339=1\nTOOL CALL 1 Z S1000\nM3\nL X+0 Y+0 Z+50 R0 FMAX\n",
        "L Z-1 F100\nL X+10\nL X+20 FMAX\nL Z+50 FMAX\nM5\nL Z+560 R0 FMAX M91\nEND PGM A MM\n",
    ),
}


def within(message: str, *lines: str, on: str = FANUC, cl: bool = True, **given: str) -> Cure:
    """Lines of a program above its first cut, converted to a CL file, or for another machine."""
    head, foot = PROGRAMS[on]
    target = {"to_cl": "yes"} if cl else {"to_machine": "yl569" if on != "yl569" else TNC}
    return marked(message, converting(machine=on, **target, **given), *lines, head=head, foot=foot)


def edited(message: str, wrong: str, cured: str, on: str = FANUC, cl: bool = True, **given: str) -> Cure:
    """A line of a program in place of one of it, and that line."""
    code, _, variant = message.partition(" ")
    text = "".join(PROGRAMS[on])
    assert cured in text
    target = {"to_cl": "yes"} if cl else {"to_machine": "yl569" if on != "yl569" else TNC}
    return Cure(code, variant, converting(machine=on, **target, **given), text.replace(cured, wrong), ((wrong, cured),))
