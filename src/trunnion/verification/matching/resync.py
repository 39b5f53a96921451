"""Where two sequences of motions agree again after they have differed."""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Flags, Floats


def find_resync(fits: Flags, ends: Sequence[bool]) -> tuple[int, int] | None:
    """Return the nearest (a, b) at which two motions in a row fit.

    One fit suffices right before the end of either side; where both sides end and nothing fits, it is both ends.

    fits  (a, b) bool: whether each motion of one side fits each one of the other
    ends  whether the window reaches the end of each side
    """
    a, b = fits.shape
    twice = fits.copy()
    twice[:-1, :-1] &= fits[1:, 1:]
    if not ends[0]:
        twice[-1] = False
    if not ends[1]:
        twice[:, -1] = False
    found: Floats = np.argwhere(twice).astype(float)
    candidates = [(int(x), int(y)) for x, y in found if x or y]
    if ends[0] and ends[1]:
        candidates.append((a, b))
    if not candidates:
        return None
    return min(candidates, key=lambda c: (max(c), abs(c[0] - c[1])))
