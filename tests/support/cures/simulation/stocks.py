"""Cures of messages about the stock of a simulation, stated as text."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Cure, Outcome
from trunnion.errors import InputError
from trunnion.simulation.stock.solids import stock_shape


def _shape(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    try:
        stock_shape(text)
    except InputError as error:
        return Outcome(error.problems, False)
    return Outcome((), True)


CURES: Final = (
    Cure("SIM122", "sizes_of_block", _shape, "120x80x30", (("120x80x30", "box:120,80,30"),)),
    Cure("SIM122", "sizes_alone", _shape, "50,30", (("50,30", "cylinder:50,30"),)),
    Cure("SIM122", "no_list_numbers", _shape, "box:120,80,thick", (("thick", "30"),)),
    Cure("SIM122", "number_beyond_mm", _shape, "box:120,80,300000", (("300000", "30"),)),
    Cure("SIM122", "numbers", _shape, "box:120,80", (("80", "80,30"),)),
    Cure("SIM122", "size_not_above", _shape, "cylinder:50,0", (("50,0", "50,30"),)),
)
