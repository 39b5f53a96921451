"""The first motion whose state is wrong, among those that go to some CL rows."""

from collections.abc import Callable

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.verification.matching.pairs import Matching


def first_wrong_pair(
    matching: Matching, first: int, end: int, is_wrong: Callable[[Ints], Flags]
) -> tuple[int, int] | None:
    """Rows of run and CL files of the first wrong pair, from pair ``first`` to the one before ``end``.

    Motions on the way to the CL points of these pairs count, too. ``is_wrong`` tells which of some rows of the run are
    wrong, (k,) bool.
    """
    if first >= end:  # no motion goes to any of the CL rows
        return None
    found = [_first(is_wrong, *matching.on_the_way(int(matching.cl[first]), int(matching.cl[end - 1])))]
    for nc, cl in matching.pair_chunks(first, end):
        found.append(_first(is_wrong, nc, cl))
        if found[-1] is not None:
            break
    return min((pair for pair in found if pair is not None), default=None)


def _first(is_wrong: Callable[[Ints], Flags], nc: Ints, cl: Ints) -> tuple[int, int] | None:
    """Return the first pair of which the row of the run is wrong."""
    wrong = is_wrong(nc) if len(nc) else np.zeros(0, np.bool_)
    k = int(np.argmax(wrong)) if wrong.any() else -1
    return None if k < 0 else (int(nc[k]), int(cl[k]))
