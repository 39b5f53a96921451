"""The first motion whose state is wrong, among those that go to some CL rows."""

from collections.abc import Callable

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.verification.matching.pairs import Matching


def first_wrong_pair(
    matching: Matching, first: int, end: int, is_wrong: Callable[[Ints], Flags]
) -> tuple[int, int] | None:
    """Rows of run and CL files of the first wrong pair, from pair ``first`` to the one before ``end``.

    ``is_wrong`` tells which of some rows of the run are wrong, (k,) bool.
    """
    for nc, cl in matching.pair_chunks(first, end):
        found = is_wrong(nc)
        if found.any():
            k = int(np.argmax(found))
            return int(nc[k]), int(cl[k])
    return None
