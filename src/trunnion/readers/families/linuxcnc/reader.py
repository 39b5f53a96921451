"""The reader of LinuxCNC programs."""

from typing import Final

from trunnion.readers.families.linuxcnc.interpreter import LinuxcncInterpreter
from trunnion.readers.families.linuxcnc.words import WITHOUT_PATH_EFFECT, WITHOUT_PATH_EFFECT_M
from trunnion.readers.program.family_reader import FamilyReader, g_words

READER: Final = FamilyReader(
    LinuxcncInterpreter,
    g_words(WITHOUT_PATH_EFFECT) | {f"M{code}" for code in WITHOUT_PATH_EFFECT_M},
    uses_length_numbers=True,
)
