"""The feeds that the axes reach on the way to each CL point, under the feeds that these may have at most.

In:     a run, the path of the CL files with their own feeds, and their matching.
Out:    for each CL row the highest feed that is reached, timed anew (``trunnion.timing``).

Blocks that lead to one CL point together share the highest feed of them, the lines for an arc the highest that is
steady; those that turn rotary axes while the tip rests keep that of the CL file. Rapids, holes and feeds per revolution
have no feed to reach.
"""

from dataclasses import replace
from functools import cached_property
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.deviations import Deviations
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Operation, Phase
from trunnion.records import dataclass
from trunnion.timing import reached_feeds, steady
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.matching.pairs import Matching

#: By how much a program with the feeds that the axes reach may move longer than at the feeds of the CL files: this
#: share, and this many seconds.
_LONGER: Final = 0.05
_LONGER_SECONDS: Final = 1.0

#: Part of that which is left to what is printed: feeds have three digits here, and fewer where a control prints fewer.
_LEFT: Final = 0.1

#: A row that takes longer than at the feed of the CL file by this share, and these seconds, is one that does.
_SLOWER: Final = 0.02
_SLOWER_SECONDS: Final = 1e-3

#: A way at 45 degrees does not go deeper than across, within this share; an arc that turns by less, radians, is a whole
#: circle.
_SLOPE: Final = 1e-6
_CLOSED: Final = 1e-4
_TURN: Final = 2.0 * np.pi

#: Feeds are the same within this share: without TCP they follow from lengths and times.
_SAME: Final = 1e-3

#: After so many looks for rows that take longer, all keep their feeds.
_MOST_LOOKS: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class ReachedRows:
    """The m rows of an expected path.

    most     (m,)  greatest feed that they may have, mm/min; NaN: theirs is not one to be reached
    feed     (m,)  highest feed that the axes reach under these; NaN: it is not known
    own      (m,)  feed of the CL files, ``most`` where they have none, or a higher one: what rows keep if they keep it
    seconds        that the axes move in the whole run at the feeds of the CL files
    """

    most: Floats
    feed: Floats
    own: Floats
    seconds: float


def longest(seconds: float) -> float:
    """How long the axes may move in a program that takes so many seconds at the feeds of the CL files."""
    return (1.0 + _LONGER) * seconds + _LONGER_SECONDS


def reached_rows(run: Run, expected: ExpectedPath, matching: Matching, limit: float | None) -> ReachedRows:
    """Find what the axes reach.

    expected  with the feeds of the CL files
    limit     greatest feed of cuts, mm/min; None: that of the CL files
    """
    return _TimedRows(run, expected, matching, limit).reached


def worthwhile_feeds(
    run: Run, expected: ExpectedPath, matching: Matching, limit: float | None
) -> tuple[ReachedRows, Flags]:
    """Find what the axes reach, and at which rows the feed of the CL file is kept since lower ones take far longer.

    A control that keeps the least limit over a whole ramp may be slower for a feed that it reaches.
    """
    timed = _TimedRows(run, expected, matching, limit)
    return timed.reached, timed.kept()


def with_feeds_of_program(run: Run, expected: ExpectedPath, matching: Matching, limit: float | None) -> ExpectedPath:
    """Return the path with the program's own feeds as its declaration, where no post has left one.

    Declared are feeds that are not those of the CL files, and those of rows that keep theirs.
    """
    timed = _TimedRows(run, expected, matching, limit)
    feed, kept = timed.asked(), timed.kept()
    sections = []
    for section in expected.sections:
        rows = slice(section.first, section.end)
        asked, cl_feed, most = feed[rows], section.operation.moves.feed, timed.reached.most[rows]
        same = np.abs(asked - cl_feed) <= np.maximum(2.0 * section.tolerances.feed, _SAME * cl_feed)
        asked = np.where(same & kept[rows], timed.reached.own[rows], asked)
        declared = np.flatnonzero(np.isfinite(most) & np.isfinite(asked) & (~same | kept[rows]))
        deviations = replace(Deviations.none(), reached_rows=declared, reached_feed=asked[declared])
        sections.append(replace(section, tolerances=replace(section.tolerances, deviations=deviations)))
    return expected.with_sections(sections)


class _TimedRows:
    """A run that is timed with the feeds of CL rows."""

    def __init__(self, run: Run, expected: ExpectedPath, matching: Matching, limit: float | None) -> None:
        self._run, self._limit = run, limit
        self._most = greatest_feeds(expected, limit)
        own = greatest_feeds(expected, None)
        self._own = np.where(np.isnan(self._most), np.nan, np.fmin(own, self._most))
        self._leads_to = _rows_led_to(run, expected, matching)
        self._guided = self._leads_to >= 0
        self._segments = matching.arc_segments
        self._extra = np.array(matching.extra, np.int64)
        # Without limit these are the greatest feeds; where the CL file has none, the program's stand.
        self._cl_feeds = self._most if limit is None else own

    @cached_property
    def reached(self) -> ReachedRows:
        leads_to, most = self._leads_to, self._most
        given = self._of_rows(most)
        found = reached_feeds(self._run, given, self._of_rows(self._own))
        known = np.flatnonzero(self._guided & np.isfinite(given) & np.isfinite(found.feed))
        feed = np.full(len(most), -np.inf)
        np.maximum.at(feed, leads_to[known], found.feed[known])
        feed[np.isinf(feed)] = np.nan
        for segments in self._segments:
            rows = np.append(segments.nc, segments.nc[-1] + 1) if len(segments.nc) else segments.nc
            along = found.feed[
                rows[(rows < len(leads_to)) & (leads_to[rows.clip(max=len(leads_to) - 1)] == segments.cl)]
            ]
            along = along[np.isfinite(along)]
            if len(along):
                feed[segments.cl] = steady(along)
        seconds = found.seconds if self._limit is None else self._own_seconds
        return ReachedRows(most, feed, self._own, float(seconds.sum()))

    def asked(self) -> Floats:
        """Return the feeds that the program asks for on the way to CL rows, (m,) mm/min; NaN: it is not known."""
        asked = reached_feeds(self._run, np.full(len(self._run), np.nan)).asked
        known = np.flatnonzero(self._guided & np.isfinite(asked))
        feed = np.full(len(self._most), -np.inf)
        np.maximum.at(feed, self._leads_to[known], asked[known])
        feed[np.isinf(feed)] = np.nan
        return feed

    @cached_property
    def _own_seconds(self) -> Floats:
        """Seconds of each row of the run at the feeds of the CL files, (n,)."""
        return reached_feeds(self._run, self._of_rows(self._cl_feeds)).seconds

    def kept(self) -> Flags:
        """CL rows that keep their feeds, (m,)."""
        own, lowered = self._own, np.fmin(_three_digits(self.reached.feed), self._most)
        kept = np.zeros(len(own), np.bool_)
        seconds_at_own = self.reached.seconds
        allowed = longest(seconds_at_own) - _LEFT * (longest(seconds_at_own) - seconds_at_own)
        for _ in range(_MOST_LOOKS):
            feeds = np.where(kept, own, lowered)
            seconds = reached_feeds(self._run, self._of_rows(feeds), self._of_rows(own)).seconds
            if seconds.sum() <= allowed:
                return kept
            slower = self._guided & (seconds > (1.0 + _SLOWER) * self._own_seconds + _SLOWER_SECONDS)
            kept[self._leads_to[slower]] = True
        return np.ones(len(own), np.bool_)

    def _of_rows(self, feeds: Floats) -> Floats:
        """For the rows of the run the feeds of the CL rows that they lead to, (n,).

        Lines without a CL row, which rewind an axis, have that of the cut that they lead back to: their own is a share
        of the feed that this cut has, which is what is to be found.
        """
        given = np.full(len(self._run), np.nan)
        given[self._guided] = feeds[self._leads_to[self._guided]]
        after = np.flatnonzero(self._guided)
        rows = self._extra[self._run.kind[self._extra] != Kind.RAPID]
        following = np.searchsorted(after, rows)
        known = following < len(after)
        given[rows[known]] = given[after[following[known]]]
        return given


def _three_digits(feed: Floats) -> Floats:
    """Return feeds, (k,), rounded down to three digits."""
    with np.errstate(divide="ignore", invalid="ignore"):
        digit = 10.0 ** (np.floor(np.log10(feed)) - 2.0)
        return np.asarray(np.floor(feed / digit) * digit)


def greatest_feeds(expected: ExpectedPath, limit: float | None) -> Floats:
    """Return the greatest feed of each row, (m,) mm/min; NaN in rapids, per revolution, and where there is none.

    A cut that plunges has at most that of the CL file.
    """
    every = [np.zeros(0)]
    for section in expected.sections:
        moves = section.operation.moves
        feed = moves.feed
        if limit is not None:
            deeper = _goes_deeper(section.whole)[slice(None) if section.kept is None else section.kept]
            feed = np.where(moves.phase == Phase.CUT, np.where(deeper & ~(feed > limit), feed, limit), feed)
        every.append(np.where((moves.kind == Kind.RAPID) | moves.per_rev, np.nan, feed))
    return np.concatenate(every)


def _goes_deeper(operation: Operation) -> Flags:
    """Return moves that lead the tool farther down along its axis than across, (n,); the first always counts as one.

    The slope of an arc is that of its helix, the slope of a spline that of the line between its ends.
    """
    tip, splines = operation.moves.tip, operation.splines
    from_row, to_row = np.arange(-1, len(tip) - 1), np.arange(len(tip))
    for first, last, _ in (splines[k] for k in range(len(splines))):
        from_row[first : last + 1], to_row[first : last + 1] = first - 1, last
    way = tip[to_row] - tip[from_row]
    along = (way * operation.moves.axis).sum(axis=1)
    length = np.linalg.norm(way, axis=1)
    arcs = operation.arcs
    chord = np.sqrt(np.maximum(length**2 - along**2, 0.0))
    start, end = tip[arcs.row - 1] - arcs.centre, tip[arcs.row] - arcs.centre
    beside = start - (start * arcs.normal).sum(axis=1, keepdims=True) * arcs.normal
    angle = np.mod(np.arctan2((np.cross(arcs.normal, beside) * end).sum(axis=1), (beside * end).sum(axis=1)), _TURN)
    angle = np.where(np.minimum(angle, _TURN - angle) < _CLOSED, _TURN, angle)
    chord[arcs.row] = arcs.radius * (angle + _TURN * arcs.full_turns)
    deeper = -along > chord * (1.0 + _SLOPE)
    deeper[:1] = True
    return np.asarray(deeper)


def _rows_led_to(run: Run, expected: ExpectedPath, matching: Matching) -> Ints:
    """Return the CL row that each row at feed leads to, (n,); -1: none."""
    leads_to = np.full(len(run), -1, np.int64)
    for nc, cl in matching.all_pair_chunks():
        leads_to[nc] = cl
    for segments in matching.arc_segments:
        leads_to[segments.nc] = segments.cl
    for spline in expected.written_splines:
        leads_to[spline.first : spline.last] = leads_to[spline.last]
    leads_to[run.kind == Kind.RAPID] = -1
    return leads_to
