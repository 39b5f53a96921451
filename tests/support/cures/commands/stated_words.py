"""Cures of messages about what is stated for one run besides the definition."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.program_heads import HEADS
from trunnion.errors import Problem, TrunnionError

_ON: Final = "matsuura_mx330"
_CUTS: Final = {"mikron_600u": "L X+1 F100", "yl569": "G1 X1 F100"}
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


def _assuming(machine: str) -> Trial:
    """Return what reads a program; settings are what its words do."""

    def assumed(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file = folder / "part.nc"
        file.write_text(text, encoding="utf-8")
        run = trunnion.verify(file, machine=machine, assume=settings).run
        return Outcome(tuple(Problem(each.file, each.line, each.wording) for each in run.errors), not run.errors)

    return assumed


def _varied(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a program; settings are its variables."""
    file = folder / "part.nc"
    file.write_text(text, encoding="utf-8")
    try:
        run = trunnion.verify(file, machine="yl569", settings=settings).run
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome((), not run.errors)


def _called(variant: str, machine: str, block: str, call: str) -> Cure:
    """A call of a subprogram that nobody has, and the statement that it moves nothing."""
    text = HEADS[machine].format(lines=f"{block}\n{_CUTS.get(machine, 'G1 X1. F100.')}")
    return Cure("NC132", variant, _assuming(machine), text, ({call: "moves nothing"},))


def _beside(variant: str, word: str, line: str, cured: str) -> Cure:
    text = HEADS[_ON].format(lines=f"{line}\nG1 X1. F100.")
    return Cure("NC213", variant, _assuming(_ON), text, ((line, cured),), {word: "no effect"})


CURES: Final = (
    _beside("letters_beside", "G187", "G187 X20.", "G187\nG1 X20. F100."),
    _beside("codes_beside", "G65 P9810", "G65 P9810 G17", "G65 P9810\nG17"),
    _called("missing_called_number", _ON, "M98 P77", "M98 P77"),
    _called("missing_called_number", _ON, "N5 M98P0077 L2", "M98 P0077"),
    _called("missing_called_number", _ON, "G65 P9810 Z9.", "G65 P9810"),
    _called("missing_called_program", "mikron_600u", r"CALL PGM TNC:\NC\SUB.H", r"CALL PGM TNC:\NC\SUB.H"),
    _called("unknown_or_missing_word", "yl569", "N70 HOLES(1, 2)", "HOLES"),
    Cure(
        "ARG230",
        "variable_stated_twice",
        _varied,
        HEADS["yl569"].format(lines="G1 X=_DEPTH F100"),
        ({"_depth": None},),
        {"_DEPTH": "2", "_depth": "3"},
    ),
    Cure("ARG210", "no_variable", _compared, _TEXT, ({"R5": None, "#100": "1"},), {"R5": "2"}),
    Cure("ARG220", "no_number_of_variable", _compared, _TEXT, ({"#100": "0.5"},), {"#100": "two"}),
)
