"""Whether moves touch the part: the optimizer may change poses freely only where they do not."""

from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.model.toolpath import Kind, Moves, Phase

NO_CONTACT: Final = 0
MAY_TOUCH: Final = 1
CUTS: Final = 2


def contact_of(moves: Moves, rows: slice = slice(None)) -> Codes:
    """(n,) uint8: whether the move into a row touches the part: NO_CONTACT, MAY_TOUCH or CUTS."""
    code = np.full(len(Phase), MAY_TOUCH, np.uint8)
    code[[Phase.RAPID, Phase.APPROACH, Phase.DEPARTURE, Phase.TRAVERSE]] = NO_CONTACT
    code[Phase.CUT] = CUTS
    return np.where(moves.kind[rows] == Kind.RAPID, np.uint8(NO_CONTACT), code[moves.phase[rows]])
