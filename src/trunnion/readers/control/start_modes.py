"""Modes in which a program leaves the control as it finds it: the reader takes it to start with the usual ones.

In:     the modes with which a family starts, what its definition states of them, and from which row on a program says
        each.
Out:    the words that a program relies on although neither it nor the definition states them.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.definitions import Table
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.program.settings import reading_of

#: The mode that any word of a motion says: on these controls it ends a cycle as G80 does.
MOTION: Final = "motion"

_KEY: Final = "start_modes"
_POSITIONS: Final = (
    ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.FIRST | ProgrammedWord.SECOND
)


def check_start_modes(table: Table, modes: Mapping[str, str]) -> None:
    """Add a problem to ``[control.reading]`` for each word that is none with which the reader starts."""
    known = tuple(modes.values())
    for word in table.texts(_KEY, ()):
        if word not in known:
            table.add_problem(_KEY, Wording("DEF330", "no_start_mode", name=word, known=known))


def assumed_modes(
    machine: Machine, modes: Mapping[str, str], said_from: Mapping[str, int], kind: Codes, programmed: Codes
) -> tuple[str, ...]:
    """Return the words of modes that hold at the first motion, and that nobody has stated.

    modes      the word with which the control starts, by mode
    said_from  the row from which on the program has said a mode
    kind       of all rows
    programmed the words of all rows
    """
    stated = reading_of(machine).texts(_KEY, ())
    moves = np.flatnonzero((programmed & int(_POSITIONS)) != 0)[:1]
    cuts = np.flatnonzero(kind != Kind.RAPID)[:1]
    first = {mode: cuts if mode == "feed" else moves for mode in modes}
    return tuple(
        word
        for mode, word in modes.items()
        if word not in stated and len(first[mode]) and said_from.get(mode, len(kind)) > first[mode][0]
    )
