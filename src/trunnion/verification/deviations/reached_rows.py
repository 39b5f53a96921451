"""The feeds that the axes reach on the way to each CL point, under the feeds that these may have at most.

In:     a run, the path of the CL files with their own feeds, and their matching.
Out:    for each CL row the highest feed that is reached, timed anew (``trunnion.timing``).

Blocks that lead to one CL point together, such as the lines for an arc, share the highest feed of them. Rapids, holes
and feeds per revolution have no feed to reach.
"""

from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Phase
from trunnion.timing import reached_feeds
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.matching.pairs import Matching


@dataclass(frozen=True, slots=True, eq=False)
class ReachedRows:
    """The m rows of an expected path.

    most     (m,)  greatest feed that they may have, mm/min; NaN: theirs is not one to be reached
    feed     (m,)  highest feed that the axes reach under these; NaN: it is not known
    seconds        that the axes move in the whole run at the greatest feeds
    """

    most: Floats
    feed: Floats
    seconds: float


def reached_rows(run: Run, expected: ExpectedPath, matching: Matching, limit: float | None) -> ReachedRows:
    """Find what the axes reach.

    Parameters
    ----------
    expected
        With the feeds of the CL files.
    limit
        Greatest feed of cuts, mm/min; None: that of the CL files.
    """
    most = greatest_feeds(expected, limit)
    leads_to = _rows_led_to(run, expected, matching)
    guided = leads_to >= 0
    given = np.full(len(run), np.nan)
    given[guided] = most[leads_to[guided]]
    _fill_rewinds(run, given, guided, matching)
    found = reached_feeds(run, given)
    known = np.flatnonzero(guided & np.isfinite(given) & np.isfinite(found.feed))
    feed = np.full(len(most), -np.inf)
    np.maximum.at(feed, leads_to[known], found.feed[known])
    feed[np.isinf(feed)] = np.nan
    return ReachedRows(most, feed, float(found.seconds.sum()))


def _fill_rewinds(run: Run, given: Floats, guided: Flags, matching: Matching) -> None:
    """Give lines without a CL row, which rewind an axis, the greatest feed of the cut that they lead back to.

    Their own is a share of the feed that this cut has, which is what is to be found.
    """
    after = np.flatnonzero(guided)
    rows = np.array(matching.extra, np.int64)
    rows = rows[run.kind[rows] != Kind.RAPID]
    following = np.searchsorted(after, rows)
    known = following < len(after)
    given[rows[known]] = given[after[following[known]]]


def greatest_feeds(expected: ExpectedPath, limit: float | None) -> Floats:
    """The greatest feed of each row, (m,) mm/min; NaN in rapids, per revolution, and where there is none."""
    every = [np.zeros(0)]
    for section in expected.sections:
        moves = section.operation.moves
        feed = moves.feed if limit is None else np.where(moves.phase == Phase.CUT, limit, moves.feed)
        every.append(np.where((moves.kind == Kind.RAPID) | moves.per_rev, np.nan, feed))
    return np.concatenate(every)


def _rows_led_to(run: Run, expected: ExpectedPath, matching: Matching) -> Ints:
    """The CL row that each row at feed leads to, (n,); -1: none."""
    leads_to = np.full(len(run), -1, np.int64)
    for nc, cl in matching.all_pair_chunks():
        leads_to[nc] = cl
    for segments in matching.arc_segments:
        leads_to[segments.nc] = segments.cl
    for spline in expected.written_splines:
        leads_to[spline.first : spline.last] = leads_to[spline.last]
    leads_to[run.kind == Kind.RAPID] = -1
    return leads_to
