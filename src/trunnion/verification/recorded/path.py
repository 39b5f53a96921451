"""Where a program goes: pieces of its motion in which every axis moves evenly, and the tool at their ends.

In:     a ``Run``.
Out:    a ``ProgramPath``.
Units:  mm and degrees, workpiece frame.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.timing import MOST_PIECES, axis_pieces

#: How far the tip may be from the straight line between the ends of a piece, mm; and the pieces of one piece at most.
SAG: Final = 0.005
_MOST_PARTS: Final = 256


@dataclass(frozen=True, slots=True, eq=False)
class ProgramPath:
    """m pieces of a run of n rows, in order.

    row         (m,)    row of each
    begin, end  (m, 5)  axis values at its ends, machine order
    known       (m,)    it is known where the tool is at the workpiece
    tip         (2, m, 3)  tool tip at its begin and its end
    axis        (2, m, 3)  tool axis there
    first       (n + 1,)   first piece of each row
    """

    machine: Machine
    row: Ints
    begin: Floats
    end: Floats
    known: Flags
    tip: Floats
    axis: Floats
    first: Ints

    @staticmethod
    def of(run: Run) -> "ProgramPath":
        """Return the path of a run."""
        parts = []
        for pieces in axis_pieces(run, {}, most=MOST_PIECES):
            before, after = pieces.joints[:-1], pieces.joints[1:]
            counts = _counts(run.machine, before, after)
            of = np.repeat(np.arange(len(counts)), counts)
            place = np.arange(len(of)) - np.repeat(np.cumsum(counts) - counts, counts)
            way = (after - before)[of]
            begin = before[of] + (place / counts[of])[:, None] * way
            end = np.where(
                (place + 1 == counts[of])[:, None], after[of], before[of] + ((place + 1) / counts[of])[:, None] * way
            )
            parts.append((pieces.row[of], begin, end, pieces.known[of]))
        if not parts:
            none = np.zeros((0, 5))
            parts.append((np.zeros(0, np.int64), none, none, np.zeros(0, np.bool_)))
        row, begin, end, known = (np.concatenate(column) for column in zip(*parts, strict=True))
        ends = [forward(run.machine, joints) for joints in (begin, end)]
        tip, axis = np.stack([one[0] for one in ends]), np.stack([one[1] for one in ends])
        known &= np.isfinite(tip).all(axis=(0, 2))
        return ProgramPath(
            run.machine, row, begin, end, known, tip, axis, np.searchsorted(row, np.arange(len(run) + 1))
        )

    def __len__(self) -> int:
        return len(self.row)

    def lengths(self) -> Floats:
        """Way of the tip in each piece, (m,), a degree of the tool axis counting as a millimetre; 0 where not known."""
        steps = np.nan_to_num(np.linalg.norm(self.tip[1] - self.tip[0], axis=1))
        turned = np.linalg.norm(np.nan_to_num(self.axis[1] - self.axis[0]), axis=1)
        return np.asarray(steps + np.degrees(turned))


def _counts(machine: Machine, before: Floats, after: Floats) -> Ints:
    """How many parts pieces are cut into, so that the tip goes straight in each."""
    middle = forward(machine, (before + after) / 2.0)[0]
    sag = np.linalg.norm(middle - (forward(machine, before)[0] + forward(machine, after)[0]) / 2.0, axis=1)
    parts = np.ceil(np.sqrt(np.nan_to_num(sag) / SAG))
    return np.asarray(np.clip(parts, 1, _MOST_PARTS), np.int64)
