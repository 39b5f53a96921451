"""The reader of Fidia NC15 programs."""

from typing import Final

from trunnion.readers.common.family_reader import FamilyReader, g_words
from trunnion.readers.families.fidia.interpreter import FidiaInterpreter
from trunnion.readers.families.fidia.words import WITHOUT_PATH_EFFECT

READER: Final = FamilyReader(FidiaInterpreter, g_words(WITHOUT_PATH_EFFECT))
