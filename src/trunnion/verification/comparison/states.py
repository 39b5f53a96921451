"""What holds in two programs from one motion to the next: feed, tool, offsets and the like.

In:     rows of both runs that go to the same point, in their order.
Out:    the stretches of them in which something differs. One that goes on is one difference, however many motions it
        has: it has one cause.
"""

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Flags, Ints
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Values of rows of the first run and of as many of the second, (k,) each.
Values: TypeAlias = tuple[NDArray[Any], NDArray[Any]]


@dataclass(frozen=True, slots=True, eq=False)
class ComparedState:
    """Something that holds until it changes. All functions take rows of the first run and of the second, (k,) each.

    counts  in which of them it counts in both runs, (k,) bool: the others neither begin nor end a stretch
    same    in which of them it is the same, (k,) bool
    values  what it is: where these change a new stretch begins
    said    what differs in one row of either run
    """

    counts: Callable[[Ints, Ints], Flags]
    same: Callable[[Ints, Ints], Flags]
    values: Callable[[Ints, Ints], Values]
    said: Callable[[int, int], Wording]


@dataclass(slots=True, eq=False)
class DifferentStretch:
    """Motions in which a state differs in one way: from ``i`` and ``j``, in rows ``a`` and ``b``, to ``last``."""

    i: int
    j: int
    a: int
    b: int
    state: ComparedState
    values: tuple[float, float]
    last: tuple[int, int]

    @property
    def wording(self) -> Wording:
        """What differs."""
        return self.state.said(self.a, self.b)


class StateComparison:
    """Follows the states of two programs; ``follow`` takes the motions that go to the same points, in their order."""

    def __init__(self, states: Sequence[ComparedState]) -> None:
        self._states = list(states)
        self._open: list[DifferentStretch | None] = [None] * len(self._states)

    def follow(self, i: int, j: int, a: Ints, b: Ints) -> list[DifferentStretch]:
        """Return the stretches that begin in motions from ``i`` and ``j`` on, which are the rows ``a`` and ``b``, (k,)
        each.

        The last one of a state goes on with the next call, where it still differs in the same way.
        """
        found: list[DifferentStretch] = []
        for n, state in enumerate(self._states):
            at = np.flatnonzero(state.counts(a, b))
            if not len(at):
                continue
            differs = ~state.same(a[at], b[at])
            before, self._open[n] = self._open[n], None
            if not differs.any():
                continue
            values = np.stack(state.values(a[at], b[at]), axis=1).astype(np.float64)
            changes = np.ones(len(at), np.bool_)
            changes[0] = before is None or before.values != tuple(values[0].tolist())
            changes[1:] = (values[1:] != values[:-1]).any(axis=1) | ~differs[:-1]
            ends = at[differs & np.append(~differs[1:] | changes[1:], True)].tolist()
            if before is not None and differs[0] and not changes[0]:
                before.last = i + ends[0], j + ends[0]
                del ends[0]
            last = before
            for k, end in zip(np.flatnonzero(differs & changes).tolist(), ends, strict=True):
                m = int(at[k])
                one, two = values[k].tolist()
                last = DifferentStretch(
                    i + m, j + m, int(a[m]), int(b[m]), state, (one, two), (i + end, j + end)
                )  # fmt: skip
                found.append(last)
            self._open[n] = last if differs[-1] else None
        return found
