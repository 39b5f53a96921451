"""The reader of Sinumerik 840D programs."""

import re
from typing import Final

from trunnion.readers.families.sinumerik.interpreter import SinumerikInterpreter
from trunnion.readers.families.sinumerik.words import (
    G_WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT_CALLS,
    WITHOUT_PATH_EFFECT_VALUES,
)
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.work_offsets import WorkOffsetWords, first_number, g_word

#: G54 to G57 and G505 to G599.
WORK_OFFSETS: Final = WorkOffsetWords(
    "G54 to G57, or G505 to G599", re.compile(r"G(5[4-7]|5(?:0[5-9]|[1-9][0-9]))"), first_number, g_word
)

READER: Final = FamilyReader(
    SinumerikInterpreter,
    WITHOUT_PATH_EFFECT
    | WITHOUT_PATH_EFFECT_VALUES
    | WITHOUT_PATH_EFFECT_CALLS
    | {f"G{code}" for code in G_WITHOUT_PATH_EFFECT},
    WORK_OFFSETS,
    comments=rb';[^\n]*|"[^"\n]*"',
)
