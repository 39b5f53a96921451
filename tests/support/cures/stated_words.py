"""Cures of messages about what is stated for one run besides the definition."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome
from tests.support.program_heads import HEADS
from trunnion.errors import TrunnionError

_ON: Final = "matsuura_mx330"
_TEXT: Final = HEADS[_ON].format(lines="G1 X#100 F100.")


def _compared(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Compare a program with itself; settings are its variables."""
    file = folder / "part.nc"
    file.write_text(text, encoding="utf-8")
    try:
        found = trunnion.diff(file, file, machine=_ON, settings=settings)
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome((), found.same)


CURES: Final = (
    Cure("ARG210", "no_variable", _compared, _TEXT, ({"R5": None, "#100": "1"},), {"R5": "2"}),
    Cure("ARG220", "no_number_of_variable", _compared, _TEXT, ({"#100": "0.5"},), {"#100": "two"}),
)
