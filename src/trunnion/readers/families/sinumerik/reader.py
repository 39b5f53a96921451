"""The reader of Sinumerik 840D programs."""

from typing import Final

from trunnion.readers.families.sinumerik.interpreter import SinumerikInterpreter
from trunnion.readers.families.sinumerik.words import (
    G_WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT_CALLS,
    WITHOUT_PATH_EFFECT_VALUES,
)
from trunnion.readers.program.family_reader import FamilyReader

READER: Final = FamilyReader(
    SinumerikInterpreter,
    WITHOUT_PATH_EFFECT
    | WITHOUT_PATH_EFFECT_VALUES
    | WITHOUT_PATH_EFFECT_CALLS
    | {f"G{code}" for code in G_WITHOUT_PATH_EFFECT},
    comments=rb';[^\n]*|"[^"\n]*"',
)
