"""The reader of Klartext programs, of an iTNC 530 and a TNC 640 alike."""

import re
from typing import Final

from trunnion.readers.families.heidenhain.interpreter import HeidenhainInterpreter
from trunnion.readers.families.heidenhain.words import M_WITHOUT_PATH_EFFECT
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.work_offsets import WorkOffsetWords, first_number

#: The number of a preset, as cycle 247 has it.
WORK_OFFSETS: Final = WorkOffsetWords(
    "the number of a preset, such as 1",
    re.compile(r"(?:PRESET )?([0-9]{1,4})"),
    first_number,
    lambda value: f"preset {value}",
)

READER: Final = FamilyReader(
    HeidenhainInterpreter,
    frozenset(f"M{code}" for code in M_WITHOUT_PATH_EFFECT),
    WORK_OFFSETS,
    comments=rb";[^\n]*|^\d+ \*[^\n]*",
)
