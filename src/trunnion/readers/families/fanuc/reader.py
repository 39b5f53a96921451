"""The reader of Fanuc 30i and 31i programs."""

from typing import Final

from trunnion.readers.families.fanuc.interpreter import FanucInterpreter
from trunnion.readers.families.fanuc.words import WITHOUT_PATH_EFFECT
from trunnion.readers.families.fanuc.work_offsets import WORK_OFFSETS, offsets_of
from trunnion.readers.program.family_reader import FamilyReader, g_words

READER: Final = FamilyReader(
    FanucInterpreter,
    g_words(WITHOUT_PATH_EFFECT),
    WORK_OFFSETS,
    uses_length_numbers=True,
    offsets_of=offsets_of,
)
