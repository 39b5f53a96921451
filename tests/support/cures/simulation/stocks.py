"""Cures of messages about the stock and the fixtures of a simulation, stated as text."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Cure, Outcome
from trunnion.errors import InputError
from trunnion.simulation.fixtures import stated_fixture
from trunnion.simulation.stock.solids import stock_shape


def _shape(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    try:
        stock_shape(text)
    except InputError as error:
        return Outcome(error.problems, False)
    return Outcome((), True)


def _fixture(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    try:
        stated_fixture(text)
    except InputError as error:
        return Outcome(error.problems, False)
    return Outcome((), True)


_CHUCK: Final = "chuck:160,height=70,grip=60,jaw=45x30x40"
_VICE: Final = "vice:125,opening=80,jaw=40x50,base=300x60"

CURES: Final = (
    Cure("SIM123", "too_long", _fixture, f"{_VICE}{' ' * 1000},turn=90", ((" " * 1000, ""),)),
    Cure("SIM123", "no_name", _fixture, f"{_CHUCK},3", ((",3", ",jaws=3"),)),
    Cure("SIM123", "no_size", _fixture, f"{_VICE},colour=3", ((",colour=3", ",turn=3"),)),
    Cure("SIM123", "no_size_but_near", _fixture, _VICE.replace("opening", "openning"), (("openning", "opening"),)),
    Cure("SIM123", "size_twice", _fixture, f"{_CHUCK},grip=50", ((",grip=50", ""),)),
    Cure("SIM123", "missing", _fixture, "chuck:160,height=70,grip=60", (("grip=60", "grip=60,jaw=45x30x40"),)),
    Cure("SIM123", "no_numbers", _fixture, _CHUCK.replace("45x30x40", "45x30"), (("45x30", "45x30x40"),)),
    Cure("SIM123", "number_beyond", _fixture, _VICE.replace("300x60", "300000x60"), (("300000x60", "300x60"),)),
    Cure("SIM123", "not_above_zero", _fixture, _CHUCK.replace("grip=60", "grip=0"), (("grip=0", "grip=60"),)),
    Cure("SIM123", "grip_beyond", _fixture, _CHUCK.replace("grip=60", "grip=160"), (("grip=160", "grip=60"),)),
    Cure("SIM123", "grip_beyond", _fixture, _CHUCK.replace("grip=60", "grip=160"), (("chuck:160", "chuck:250"),)),
    Cure("SIM123", "jaws_overlap", _fixture, _CHUCK.replace("45x30", "45x110"), (("45x110", "45x103.9"),)),
    Cure("SIM123", "jaws_overlap", _fixture, _CHUCK.replace("45x30", "45x110"), (("45x110x40", "45x110x40,jaws=2"),)),
    Cure("SIM123", "jaws_overlap", _fixture, _CHUCK.replace("45x30", "45x110"), (("grip=60", "grip=90"),)),
    Cure("SIM123", "jaws_beyond_base", _fixture, _VICE.replace("300x60", "120x60"), (("120x60", "160x60"),)),
    Cure("SIM123", "jaws_beyond_base", _fixture, _VICE.replace("300x60", "150x60"), (("opening=80", "opening=70"),)),
    Cure("SIM123", "jaws_beyond_base", _fixture, _VICE.replace("300x60", "150x60"), (("40x50", "35x50"),)),
    Cure("SIM123", "no_jaws", _fixture, f"{_CHUCK},jaws=2.5", (("2.5", "3"),)),
    Cure("SIM122", "sizes_of_block", _shape, "120x80x30", (("120x80x30", "box:120,80,30"),)),
    Cure("SIM122", "sizes_alone", _shape, "50,30", (("50,30", "cylinder:50,30"),)),
    Cure("SIM122", "no_list_numbers", _shape, "box:120,80,thick", (("thick", "30"),)),
    Cure("SIM122", "number_beyond_mm", _shape, "box:120,80,300000", (("300000", "30"),)),
    Cure("SIM122", "numbers", _shape, "box:120,80", (("80", "80,30"),)),
    Cure("SIM122", "size_not_above", _shape, "cylinder:50,0", (("50,0", "50,30"),)),
)
