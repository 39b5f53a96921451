"""Which rows of a run leave the tip where the program alone tells it."""

import numpy as np

from trunnion.arrays import Flags
from trunnion.model.run import ProgrammedWord, Run


class KnownTips:
    """Whether the tip of rows is known: from machine coordinates it is not, until X, Y and Z are programmed again."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._waiting = np.ones(3, np.bool_)

    def part(self, first: int, end: int) -> Flags:
        """Return it for consecutive rows, (end - first,); parts must be asked for in their order."""
        run, rows = self._run, np.arange(1, end - first + 1)
        machine = run.state.machine_frame.part(first, end).astype(np.bool_)
        last_machine = np.maximum.accumulate(np.where(machine, rows, 0))
        known = np.ones(end - first, np.bool_)
        for k, word in enumerate((ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z)):
            stated = ~machine & ((run.programmed[first:end] & int(word)) != 0)
            last_stated = np.maximum.accumulate(np.where(stated, rows, 0))
            unknown = np.where(last_machine > 0, last_stated <= last_machine, self._waiting[k] & (last_stated == 0))
            known &= ~unknown
            self._waiting[k] = unknown[-1]
        return known
