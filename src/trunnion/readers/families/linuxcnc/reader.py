"""The reader of LinuxCNC programs."""

import re
from typing import Final

from trunnion.readers.families.linuxcnc.interpreter import LinuxcncInterpreter
from trunnion.readers.families.linuxcnc.words import WITHOUT_PATH_EFFECT, WITHOUT_PATH_EFFECT_M
from trunnion.readers.program.family_reader import FamilyReader, g_words
from trunnion.readers.program.work_offsets import WorkOffsetWords, g_word

#: G54 to G59 are 54 to 59, G59.1 to G59.3 are 591 to 593.
WORK_OFFSETS: Final = WorkOffsetWords(
    "G54 to G59, or G59.1 to G59.3",
    re.compile(r"G(5[4-9])|G59\.([1-3])"),
    lambda numbers: numbers[0] or 590 + (numbers[1] or 0),
    lambda value: f"G{value / 10:g}" if value > 590 else g_word(value),
)

READER: Final = FamilyReader(
    LinuxcncInterpreter,
    g_words(WITHOUT_PATH_EFFECT) | {f"M{code}" for code in WITHOUT_PATH_EFFECT_M},
    WORK_OFFSETS,
    uses_length_numbers=True,
)
