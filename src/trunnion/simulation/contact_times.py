"""When a block reaches a place: the part of it that is done as the tool first covers the place.

In:     a run, a row, the body of its tool and a place.
Out:    a fraction of the row.
Units:  mm, workpiece frame.
"""

from collections.abc import Collection
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.run import Run
from trunnion.model.subdivision import subdivide
from trunnion.simulation.tools.profile import Element, Role, ToolShape

#: Pieces into which a block is cut.
_PIECES: Final = 256

#: Points of each element of an outline.
_POINTS: Final = 9


def reached(
    run: Run, row: int, shape: ToolShape, roles: Collection[Role], place: tuple[float, float, float], slack: float
) -> float:
    """Return the part of a row that is done when some sections of the tool first cover a place, within ``slack`` mm.

    Where none ever does, it is when they are nearest.
    """
    samples = subdivide(run, _PIECES, slice(row, row + 1))
    way = np.array(place) - samples.tip
    height = np.einsum("ij,ij->i", way, samples.axis)
    radius = np.linalg.norm(way - height[:, None] * samples.axis, axis=1)
    off = np.full(len(height), np.inf)
    for section in shape.sections:
        if section.role in roles:
            profile = np.array([point for element in section.outline for point in _points(element)])
            wide = np.interp(height, profile[:, 1], profile[:, 0])
            beyond = np.maximum(section.bottom - height, height - section.top)
            off = np.minimum(off, np.maximum(radius - wide, beyond))
    covered = np.flatnonzero(off <= slack)
    at = int(covered[0]) if len(covered) else int(off.argmin())
    return float(samples.fraction[at])


def _points(element: Element) -> Floats:
    """Radius and height of points of an element, from below to above."""
    start, end = np.array(element.start), np.array(element.end)
    if end[1] <= start[1]:
        return np.stack((start, end))
    heights = np.linspace(start[1], end[1], _POINTS)
    return np.array([(element.radius_at(float(z)), z) for z in heights])
