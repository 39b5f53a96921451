"""Cures of messages about what is stated for one run besides the definition."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome
from tests.support.program_heads import HEADS
from trunnion.errors import Problem, TrunnionError

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


def _assumed(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a program; settings are what its words do."""
    file = folder / "part.nc"
    file.write_text(text, encoding="utf-8")
    run = trunnion.verify(file, machine=_ON, assume=settings).run
    return Outcome(tuple(Problem(each.file, each.line, each.wording) for each in run.errors), not run.errors)


def _beside(variant: str, word: str, line: str, cured: str) -> Cure:
    text = HEADS[_ON].format(lines=f"{line}\nG1 X1. F100.")
    return Cure("NC213", variant, _assumed, text, ((line, cured),), {word: "no effect"})


CURES: Final = (
    _beside("letters_beside", "G187", "G187 X20.", "G187\nG1 X20. F100."),
    _beside("codes_beside", "G65 P9810", "G65 P9810 G17", "G65 P9810\nG17"),
    Cure("ARG210", "no_variable", _compared, _TEXT, ({"R5": None, "#100": "1"},), {"R5": "2"}),
    Cure("ARG220", "no_number_of_variable", _compared, _TEXT, ({"#100": "0.5"},), {"#100": "two"}),
)
