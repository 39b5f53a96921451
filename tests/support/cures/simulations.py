"""Cures of messages about programs that are simulated."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome
from trunnion.errors import TrunnionError

_CONTOUR: Final = (
    "T5 M6\nG54 S500 M3\nG0 X-20 Y-20 Z50 D1\nG0 Z-1\nG41 G1 X0 Y-10 F300\nG1 Y20\nG40 G1 X-20\nG0 Z50\nM30\n"
)


def _simulated(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    file = folder / "part.mpf"
    file.write_text(text, encoding="utf-8")
    setup = {"stock": "box:40,40,10", "tools": ["5=flat:10,length=60,flutes=30"], "zero": "0,0,0", "tool_length": "100"}
    try:
        found = trunnion.simulate(file, machine="yl569", cell=2.0, **{**setup, **settings})  # type: ignore[arg-type]
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome(tuple(found.remarks), found.passed)


CURES: Final = (
    Cure("SIM147", "radius_compensation_programmed", _simulated, _CONTOUR, ({"radius_register": "difference"},)),
    Cure("SIM147", "radius_compensation_programmed", _simulated, _CONTOUR, ({"radius_register": "radius"},)),
)
