"""The reader of Klartext programs, of an iTNC 530 and a TNC 640 alike."""

from typing import Final

from trunnion.readers.families.heidenhain.interpreter import HeidenhainInterpreter
from trunnion.readers.families.heidenhain.words import M_WITHOUT_PATH_EFFECT
from trunnion.readers.program.family_reader import FamilyReader

READER: Final = FamilyReader(
    HeidenhainInterpreter,
    frozenset(f"M{code}" for code in M_WITHOUT_PATH_EFFECT),
    comments=rb";[^\n]*|^\d+ \*[^\n]*",
)
