"""Which linear axes stand where coordinates of the machine have put them.

In:     words and modes of consecutive rows.
Out:    flags of X, Y and Z.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags
from trunnion.model.programmed_words import names_no_axis
from trunnion.model.run import ProgrammedWord

_WORDS: Final = (ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z)


def at_machine(words: Codes, frame: Flags, xyz_is_tip: Flags, before: Flags) -> Flags:
    """Return which of X, Y and Z stand where coordinates of the machine have put them after rows, (n, 3).

    words       (n,)  as in ``Run.programmed``
    frame       (n,)  the row is programmed in coordinates of the machine
    xyz_is_tip  (n,)  its coordinates are those of the tip
    before      (3,)  which of them stand so before the first row
    """
    rows = np.arange(len(words))
    found = np.empty((len(words), 3), np.bool_)
    anything = xyz_is_tip | names_no_axis(words)
    for k, word in enumerate(_WORDS):
        named = ((words & int(word)) != 0) | anything
        last = np.maximum.accumulate(np.where(named, rows, -1))
        found[:, k] = np.where(last >= 0, (frame & ~xyz_is_tip)[last], before[k])
    return found
