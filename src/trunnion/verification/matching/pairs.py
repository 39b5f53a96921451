"""What a matching is: pairs of motions and CL points, and what is left over on either side."""

from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.records import dataclass
from trunnion.verification.expected.arcs import Arc
from trunnion.verification.row_ranges import CHUNK, RowRanges

#: Pairs that are handed out at a time, for checks that look at little of each.
_PAIR_CHUNK = 65536

_NONE = np.zeros(0, np.int64), np.zeros(0, np.int64)


@dataclass(frozen=True, slots=True, eq=False)
class ArcSegments:
    """Lines of a program that together replace an arc, or circles that are its pieces, in their order.

    nc      their rows, without the one to the end of the arc
    cl      the CL row of the arc
    pieces  of circles: the fractions of the arc (k,) at which they end, by how far they go round; None for lines
    """

    nc: Ints
    cl: int
    arc: Arc
    pieces: Floats | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Matching:
    """Pairs: row ``nc[k]`` of the run goes to CL row ``cl[k]``; both increase.

    missing       CL rows without a motion, repeated points not counted
    extra         motions without a CL row
    arc_segments  lines that replace arcs
    intermediate  (k,) and (k,) int64: motions on the way from one CL point to the next, and the CL row that each leads
                  to
    """

    nc: RowRanges
    cl: RowRanges
    missing: tuple[int, ...] = ()
    extra: tuple[int, ...] = ()
    arc_segments: tuple[ArcSegments, ...] = ()
    intermediate: tuple[Ints, Ints] = _NONE

    def pair_range(self, first: int, end: int) -> tuple[int, int]:
        """First pair and end (exclusive) of the pairs whose CL rows are from ``first`` to the one before ``end``."""
        return self.cl.count_before(first), self.cl.count_before(end)

    def pair_chunks(self, first: int = 0, end: int | None = None) -> Iterator[tuple[Ints, Ints]]:
        """Rows of the run and CL rows of the pairs from ``first`` to the one before ``end``, many at a time."""
        end = len(self.nc) if end is None else end
        for start in range(first, end, _PAIR_CHUNK):
            stop = min(start + _PAIR_CHUNK, end)
            yield self.nc.rows(start, stop), self.cl.rows(start, stop)

    def all_pair_chunks(self) -> Iterator[tuple[Ints, Ints]]:
        """As ``pair_chunks``, followed by the intermediate motions with the CL rows that they lead to."""
        yield from self.pair_chunks()
        nc, cl = self.intermediate
        for start in range(0, len(nc), CHUNK):
            yield nc[start : start + CHUNK], cl[start : start + CHUNK]

    def intermediate_counts(self, cl: Ints) -> Ints:
        """How many intermediate motions lead to each of some CL rows, (k,)."""
        leads_to = self.intermediate[1]
        return np.searchsorted(leads_to, cl, "right") - np.searchsorted(leads_to, cl)

    def on_the_way(self, first: int, last: int) -> tuple[Ints, Ints]:
        """Motions that lead to CL rows ``first`` to ``last`` without going to them, along arcs too, with those rows."""
        nc, cl = self.intermediate
        here = slice(*np.searchsorted(cl, (first, last + 1)))
        arcs = [each for each in self.arc_segments if first <= each.cl <= last]
        nc = np.concatenate([nc[here], *(each.nc for each in arcs)])
        cl = np.concatenate([cl[here], *(np.full(len(each.nc), each.cl) for each in arcs)])
        order = np.argsort(nc, kind="stable")
        return nc[order], cl[order]
