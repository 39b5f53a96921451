"""Modes in which a program leaves the control as it finds it: the reader takes it to start with the usual ones.

In:     the modes with which a family starts, what its definition states of them, and from which row on a program says
        each.
Out:    the words that a program relies on although neither it nor the definition states them.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags
from trunnion.definitions import Table
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.mode_words import END_OF_CYCLES
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.program.settings import control_of, reading_of
from trunnion.records import dataclass

#: The mode that any word of a motion says: on these controls it ends a cycle as G80 does.
MOTION: Final = "motion"

#: How centres of arcs count: it counts for an arc alone.
CENTRES: Final = "centres"

#: A plane that the control takes from the rotary position, where it has words for one.
PLANE_OF_POSE: Final = "plane of the rotary position"

#: What TCP is to a control whose positions of the machine depend on it too.
KINEMATICS: Final = "kinematics"

#: How the tool axis turns under TCP, by angles and by vectors, and of which frame a vector is.
ANGLES: Final = "orientation by angles"
VECTORS: Final = "orientation by vectors"
VECTOR_FRAME: Final = "frame of vectors"

_KEY_OF_TCP_OFF: Final = "tcp_off"

_KEY: Final = "start_modes"
_SLIDES: Final = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z
_ANGLES: Final = ProgrammedWord.FIRST | ProgrammedWord.SECOND
_POSITIONS: Final = _SLIDES | _ANGLES

#: Modes that count for positions of the workpiece, not for those of the machine, and the words that they count for.
_OF_WORKPIECE: Final = {"length": _SLIDES, "tilted plane": _SLIDES, PLANE_OF_POSE: _SLIDES, "TCP": _POSITIONS}

#: Modes that count under TCP, likewise.
_OF_TCP: Final = {
    ANGLES: _ANGLES, VECTORS: ProgrammedWord.VECTOR, VECTOR_FRAME: _ANGLES | ProgrammedWord.VECTOR,
}  # fmt: skip


def with_tcp_off(machine: Machine, mode: str, modes: Mapping[str, str]) -> Mapping[str, str]:
    """Return start modes, and TCP off under a name, by the word that a control with TCP has for it."""
    control = control_of(machine)
    if not machine.own_rotary or not control.flag("tcp", True):
        return modes
    return {**modes, mode: control.table("settings").text(_KEY_OF_TCP_OFF)}


def check_start_modes(table: Table, modes: Mapping[str, str]) -> None:
    """Add a problem to ``[control.reading]`` for each word that is none with which the reader starts."""
    known = tuple(modes.values())
    for word in table.texts(_KEY, ()):
        if word not in known:
            table.add_problem(_KEY, Wording("DEF330", "no_start_mode", name=word, known=known))


@dataclass(frozen=True, slots=True, eq=False)
class Relied:
    """From which rows on a program relies on modes, and says them.

    said_from     the row from which on it has said a mode
    relied_from   the same where it relies on one that counts only for some blocks; others count from the first motion
    kind          of all rows
    programmed    the words of all rows
    in_machine    rows that go to positions of the machine
    tcp           rows under TCP
    """

    said_from: Mapping[str, int]
    relied_from: Mapping[str, int]
    kind: Codes
    programmed: Codes
    in_machine: Flags
    tcp: Flags

    def _is_relied_on(self, mode: str, end: int) -> bool:
        """Whether a row before ``end`` relies on a mode."""
        if mode in (END_OF_CYCLES, CENTRES):
            return self.relied_from.get(mode, end) < end
        if mode == "feed":
            return bool((self.kind[:end] != Kind.RAPID).any())
        rows = self._rows_with(_OF_WORKPIECE.get(mode) or _OF_TCP.get(mode) or _POSITIONS, end)
        if mode in _OF_WORKPIECE:
            rows &= ~self.in_machine[:end]
        elif mode in _OF_TCP:
            rows &= self.tcp[:end]
        return bool(rows.any())

    def _rows_with(self, words: ProgrammedWord, end: int) -> Flags:
        return np.asarray((self.programmed[:end] & int(words)) != 0)

    def is_unsaid(self, mode: str) -> bool:
        """Whether the program relies on a mode before it says it."""
        return self._is_relied_on(mode, min(self.said_from.get(mode, len(self.kind)), len(self.kind)))


def assumed_modes(machine: Machine, modes: Mapping[str, str], relied: Relied) -> tuple[str, ...]:
    """Return the words of modes that a program relies on, and that nobody has stated.

    modes  the word with which the control starts, by mode
    """
    stated = reading_of(machine).texts(_KEY, ())
    return tuple(word for mode, word in modes.items() if word not in stated and relied.is_unsaid(mode))
