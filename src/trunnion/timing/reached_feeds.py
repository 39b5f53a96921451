"""The feeds that the axes reach in the rows of a run, under feeds of the tip that they may have at most.

In:     a run, and for some of its rows the greatest feed of the tip.
Out:    seconds and the highest feed of each row.
Units:  mm/min; where the tip rests, degrees/min of the rotary axis that turns farther. Seconds.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.feed_path import NO_ROTATION, FeedPath
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.timing.row_feeds import FeedRow, RowFeeds
from trunnion.timing.run_timer import RunTimer

#: A tip that moves by less than this, mm, rests for a writer without TCP: the feed is that of the rotary axis.
_RESTS: Final = 1e-4

#: In a row in which rotary axes turn and the tip moves by less than this, mm, a feed says little: controls differ in
#: what they count there, and a digit of a coordinate makes another feed of it.
HARDLY_MOVES: Final = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class ReachedFeeds:
    """n rows of a run in time.

    seconds  (n,)  of the motion of the axes; what they wait for is not in it
    feed     (n,)  highest feed of the tip; NaN where no axis moves, or the tip hardly does while rotary axes turn
    asked    (n,)  feed of the tip that the program asks for; NaN there as well, and in rapids
    """

    seconds: Floats
    feed: Floats
    asked: Floats


def reached_feeds(run: Run, most: Floats, resting: Floats | None = None) -> ReachedFeeds:
    """Time a run with other feeds.

    run      the program as its control ran it
    most     (n,) float64: feeds of the tip that rows have in place of the programmed ones; NaN: they have these
    resting  (n,) float64: what stands for these in rows in which rotary axes turn and the tip hardly moves; None: the
             same
    """
    feeds, timer = RowFeeds(run), RunTimer(run)
    share, known, programmed = np.empty(len(run)), np.empty(len(run), np.bool_), np.empty(len(run))
    for first, end, positions in run.chunks():
        of_rows = feeds.part(first, end, positions)
        turned = np.abs(np.diff(positions.joints[:, list(run.machine.rotary)], axis=0)).max(axis=1, initial=0.0)
        share[first:end] = _tip_share(run, first, end, turned, of_rows)
        known[first:end] = (turned <= NO_ROTATION) | (of_rows[FeedRow.TRAVEL] >= HARDLY_MOVES)
        programmed[first:end] = of_rows[FeedRow.RATE]
        given = most[first:end]
        if resting is not None:
            given = np.where(known[first:end], given, resting[first:end])
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = np.where(share[first:end] > 0.0, given / share[first:end], np.inf)
        of_rows[FeedRow.RATE] = np.where(np.isnan(given), of_rows[FeedRow.RATE], rate)
        timer.add(first, positions, of_rows)
    seconds, speed = timer.reached()
    known &= np.isfinite(speed) & (speed > 0.0)
    asked = known & np.isfinite(programmed)
    with np.errstate(invalid="ignore"):
        return ReachedFeeds(
            seconds, np.where(known, speed * share, np.nan), np.where(asked, programmed * share, np.nan)
        )


def _tip_share(run: Run, first: int, end: int, turned: Floats, feeds: Floats) -> Floats:
    """How far the tip goes while the feed counts one mm or degree, (k,); degrees of a rotary axis where it rests."""
    length, travel, counts = feeds[FeedRow.LENGTH], feeds[FeedRow.TRAVEL], feeds[FeedRow.COUNTS]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(travel < _RESTS, turned, travel) / length
    # Of these F is the feed of the tip, as it is programmed.
    path, mode = run.state.feed_path.part(first, end), run.state.feed_mode.part(first, end)
    tcp = run.state.tcp.part(first, end)
    by_tip = (counts == 0.0) | ((path == FeedPath.TIP) & (mode != 93) & ~tcp & (turned > NO_ROTATION))
    return np.where(by_tip | (counts == 2.0), 1.0, np.where(length > 0.0, share, 0.0))
