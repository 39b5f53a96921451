"""Feeds per block that the machine can follow: each as high as the axes reach there, and no higher."""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.messages import Wording
from trunnion.timing import reached_feeds
from trunnion.verification.context import ComparedContext, Faults
from trunnion.verification.deviations.reached_rows import ReachedRows, longest, reached_rows
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.results import Check
from trunnion.wording import format_duration

#: Shares by which a feed may be below what is reached, for three digits are printed at least, and above, for the
#: positions of both runs may be rounded.
_BELOW: Final = 0.011
_ABOVE: Final = 0.001


def check_reach(context: ComparedContext, original: ExpectedPath) -> list[Check]:
    """One check where feeds are those that the axes reach; none elsewhere.

    ``original`` has the feeds of the CL files, the path of the context those that are declared.
    """
    settings = context.settings
    if not settings.fastest_feed:
        return []
    found = reached_rows(context.run, original, context.matching, settings.feed_limit)
    feed, digit, declared = _declared(context.expected)
    with np.errstate(invalid="ignore"):
        kept = np.abs(feed - found.own) <= 0.5 * digit
        above_most = feed > found.most * (1.0 + 1e-9) + 0.5 * digit
        too_high = feed > found.feed * (1.0 + _ABOVE) + digit
        too_low = feed < np.minimum(found.feed * (1.0 - _BELOW), found.most) - digit
        lowered = feed < found.most - 0.5 * digit
    unknown = lowered & np.isnan(found.feed) & ~kept
    kept &= declared & (too_high | too_low)
    bad = np.flatnonzero(above_most | ((too_high | too_low) & ~kept) | unknown)
    faults = Faults()
    for row in bad.tolist():
        said = Wording("reach", "above_reached", feed=feed[row], reached=found.feed[row])
        if above_most[row] or unknown[row]:
            variant = "above_most" if above_most[row] else "reach_unknown"
            said = Wording("reach", variant, feed=feed[row], most=found.most[row])
        faults.add(context.place_of_cl_row(row, float(feed[row]), said))
    now = float(reached_feeds(context.run, np.full(len(context.run), np.nan)).seconds.sum())
    times = {"now": format_duration(now), "own": format_duration(found.seconds)}
    if now > longest(found.seconds):
        return [Check("reach", False, Wording("reach", "far_longer", **times), places=tuple(faults.places))]
    good = Wording("reach", "no_feeds")
    if np.isfinite(found.most).any():
        how = _lowered(context, found, feed, lowered & ~kept, int(np.count_nonzero(kept)))
        good = Wording("reach", "good", lowered=how, **times)
    return [faults.check("reach", good)]


def _declared(expected: ExpectedPath) -> tuple[Floats, Floats, Flags]:
    """Return the feeds of all rows, (m,), the last printed digit of each, and which of them are declared."""
    feeds = [section.operation.moves.feed for section in expected.sections]
    digits = [np.full(len(feed), 2.0 * s.tolerances.feed) for feed, s in zip(feeds, expected.sections, strict=True)]
    declared = np.zeros(len(expected), np.bool_)
    for section in expected.sections:
        if section.tolerances.deviations is not None:
            declared[section.first + section.tolerances.deviations.reached_rows] = True
    return np.concatenate(feeds), np.concatenate(digits), declared


def _lowered(context: ComparedContext, found: ReachedRows, feed: Floats, lowered: Flags, kept: int) -> Wording:
    """How many feeds are lower, and by how much."""
    limit = context.settings.feed_limit
    total, count = (int(np.count_nonzero(rows)) for rows in (np.isfinite(found.most), lowered))
    said = Wording("reach", "below_cl", count=count, points=total)
    if limit is not None:
        said = Wording("reach", "below_limit", limit=limit, count=count, points=total)
    if count:
        share = 100.0 * float((1.0 - feed[lowered] / found.most[lowered]).max())
        said = Wording("reach", "at_most", lowered=said, share=share)
    return Wording("reach", "kept", lowered=said, count=kept) if kept else said
