"""What I, J and K of a circle are where they count from its start, as the key ``arc_vectors`` states.

In:     start and end of the circle, its plane and sense, and the values by axis.
Out:    the centre.
"""

import itertools
import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control.arcs import RADIUS_ERROR, ArcError

#: The key of ``[control.reading]``, and what it may be besides the vector from the start to the centre.
KEY: Final = "arc_vectors"
FROM_CENTRE: Final = "from_centre"
UNSIGNED: Final = "unsigned"

#: How far the ends of a circle within a quadrant may lie beyond it, mm: what is written is rounded.
_BEYOND: Final = RADIUS_ERROR


def centre_of(start: Floats, end: Floats, normal: Floats, given: Mapping[int, float], meaning: str) -> Floats:
    """Return the centre of a circle that turns about ``normal`` by the right-hand rule.

    Raises ``ArcError`` if values without sign belong to no circle within a quadrant.
    """
    if meaning == UNSIGNED:
        return _in_quadrant(start, end, normal, given)
    sign = -1.0 if meaning == FROM_CENTRE else 1.0
    return _at(start, {axis: sign * value for axis, value in given.items()})


def _at(start: Floats, way: Mapping[int, float]) -> Floats:
    centre = start.copy()
    for axis, value in way.items():
        centre[axis] += value
    return centre


def _in_quadrant(start: Floats, end: Floats, normal: Floats, given: Mapping[int, float]) -> Floats:
    """Return the centre about which the circle stays within a quadrant: the one of those with the most equal radii."""
    found: list[tuple[float, Floats]] = []
    for signs in itertools.product(*((1.0, -1.0) if value else (1.0,) for value in given.values())):
        centre = _at(start, {axis: sign * value for (axis, value), sign in zip(given.items(), signs, strict=True)})
        first, last = start - centre, end - centre
        axis = int(np.argmax(np.abs(normal)))
        first[axis] = last[axis] = 0.0
        turned = float(np.cross(first, last) @ normal)
        shares = all(a * b >= 0.0 or min(abs(a), abs(b)) <= _BEYOND for a, b in zip(first, last, strict=True))
        if shares and turned > 0.0:
            found.append((abs(math.hypot(*first) - math.hypot(*last)), centre))
    if not found or any(value < 0.0 for value in given.values()):
        raise ArcError(Wording("NC320", "no_circle_in_quadrant"))
    return min(found, key=lambda each: each[0])[1]
