"""The reader of Fidia NC15 programs."""

from typing import Final

from trunnion.readers.families.fidia.interpreter import FidiaInterpreter
from trunnion.readers.families.fidia.words import WITHOUT_PATH_EFFECT
from trunnion.readers.program.family_reader import FamilyReader, g_words

READER: Final = FamilyReader(FidiaInterpreter, g_words(WITHOUT_PATH_EFFECT))
