"""How far the tool axis may be off in steps of the CL file that a program has divided.

A point between two CL points is there to keep the tool nearer to its path. So the tool axis may not leave the great
circle farther than the control would without any point between them, even where a coarse step may be off by more.

Units: degrees.
"""

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints, Lines

#: What a point between may be off wherever it is: what programs without TCP are divided to.
LEAST: Final = 0.05


def divided_limits(cl_row: Lines, whole: Callable[[Ints, Ints], Floats]) -> Floats | None:
    """Return how far the tool axis may be off in each row, (n,); infinite in steps that are not divided. None: none is.

    cl_row  (n,) the CL row that each row leads to on a line, else -1
    whole   takes the first and the last rows of steps, and returns how far off the axes would be in each, turned evenly
    """
    same = (cl_row[1:] == cl_row[:-1]) & (cl_row[1:] >= 0)
    if not same.any():
        return None
    edges = np.diff(np.concatenate(([False], same, [False])).astype(np.int8))
    first, last = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    first, last = first[first > 0], last[first > 0]
    limits = np.full(len(cl_row), math.inf)
    off = np.maximum(whole(first, last), LEAST)
    lengths = last - first + 1
    rows = np.repeat(first, lengths) + np.arange(lengths.sum()) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    limits[rows] = np.repeat(off, lengths)
    return limits
