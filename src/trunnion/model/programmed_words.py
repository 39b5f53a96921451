"""Which words of a block move the machine."""

from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags
from trunnion.model.run import ProgrammedWord

#: Words that position the tip or the tool axis.
POSITION_WORDS: Final = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR

#: Words that turn rotary axes.
ROTARY_WORDS: Final = ProgrammedWord.FIRST | ProgrammedWord.SECOND


def names_no_axis(programmed: Codes) -> Flags:
    """Which rows are of blocks that name no axis and move all the same: circles by their centre, and cycles."""
    return np.asarray((programmed & int(POSITION_WORDS | ROTARY_WORDS)) == 0)
