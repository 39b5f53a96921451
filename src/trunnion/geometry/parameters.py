"""Parameters of points that a curve passes."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats

#: How far apart the parameters of two points are: as their distance, or as its square root (Lee 1989), which follows
#: sharp bends more calmly.
PARAMETERIZATIONS: Final = ("chord-length", "centripetal")


def parameters_of(points: Floats, parameterization: str = "chord-length") -> Floats:
    """Parameters (n,) from 0 to 1 of points (n, 3), of which no two in turn are the same.

    points            mm
    parameterization  one of ``PARAMETERIZATIONS``
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if parameterization == "centripetal":
        steps = np.sqrt(steps)
    found = np.r_[0.0, np.cumsum(steps)]
    return np.asarray(found / found[-1])
