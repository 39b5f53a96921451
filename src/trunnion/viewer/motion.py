"""A run as the viewer plays it: pieces in which every axis moves evenly, with their times.

In:     a ``Run``, the seconds of its rows, the lengths of its tools.
Out:    ``MotionColumns``.
Units:  mm, degrees, seconds.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.timing import MOST_PIECES, axis_pieces

#: One count of an axis value, mm or degrees: a fiftieth of what the smallest printed digit is worth at a table's rim.
COUNT: Final = 1e-5

#: Time of a row that nothing times, s: it must still be seen.
_UNTIMED: Final = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class MotionColumns:
    """m pieces of n rows.

    joints   (m + 1, 5) int64    axis values in counts, before the first piece and after each; machine order
    row      (m,)       int64    row of each piece
    seconds  (m,)       float64  time that each takes
    known    (m,)       bool     whether it is known where the tool is at the workpiece
    """

    joints: Ints
    row: Ints
    seconds: Floats
    known: Flags


def motion_columns(run: Run, seconds: Floats, lengths: Mapping[int, float]) -> MotionColumns:
    """Divide a run into pieces in which every axis moves evenly.

    run      the program as its control ran it
    seconds  (n,) float64: of each row; without them, (0,), rows take equal times
    lengths  of tools, from tip to gauge point, mm, by their index in ``Run.tools``
    """
    of_row = seconds if len(seconds) else np.full(len(run), _UNTIMED)
    joints, rows, shares, known = [np.asarray(run.start)[None]], [], [], []
    for pieces in axis_pieces(run, lengths, most=MOST_PIECES):
        joints.append(pieces.joints[1:])
        rows.append(pieces.row)
        shares.append(pieces.done - pieces.begin)
        known.append(pieces.known)
    row = np.concatenate([np.zeros(0, np.int64), *rows])
    share = np.concatenate([np.zeros(0), *shares])
    counts = np.round(np.nan_to_num(np.concatenate(joints)) / COUNT).astype(np.int64)
    return MotionColumns(counts, row, of_row[row] * share, np.concatenate([np.zeros(0, np.bool_), *known]))
