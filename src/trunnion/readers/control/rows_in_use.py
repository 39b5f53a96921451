"""Which rows use what a program has set: of words behind the last of them only the next program sees something.

Moves to machine positions (G53, M91, SUPA, G28) count from no offset, shift or plane, and rotary axes that turn alone
without TCP do not either: with these nearly every program ends.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control.modal_builder import ModalBuilder
from trunnion.readers.control.row_buffer import RowBuffer

_ROTARY: Final = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND)
_POSITION: Final = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR)


class RowsInUse:
    """The ends of what has been used, each the row behind its last one, 0 without any; ``update`` adds the new rows.

    at_part  rows that use work offset, shifts and planes
    at_feed  these, and all others that are no rapids
    cuts     some of the first are no rapids
    """

    def __init__(self) -> None:
        self.at_part = self.at_feed = 0
        self.cuts = False
        self._judged = 0

    def update(self, columns: RowBuffer, modal: ModalBuilder) -> None:
        """Judge the rows since the last time."""
        first, end = self._judged, columns.n
        if first == end:
            return
        programmed = columns.programmed[first:end]
        turns = ((programmed & _ROTARY) != 0) & ((programmed & _POSITION) == 0) & ~modal.tcp.part(first, end)
        at_part = ~(turns | modal.machine_frame.part(first, end))
        feeds = columns.kind[first:end] != Kind.RAPID
        self.cuts |= bool((at_part & feeds).any())
        self.at_part = _end_of(at_part, first) or self.at_part
        self.at_feed = _end_of(at_part | feeds, first) or self.at_feed
        self._judged = end


def _end_of(used: Flags, first: int) -> int:
    """Return the row behind the last one of ``used`` (n,), which begins with row ``first``; 0 if there is none."""
    return first + len(used) - int(np.argmax(used[::-1])) if used.any() else 0
