"""Feeds per block that the machine can follow: each as high as the axes reach there, and no higher."""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.timing import reached_feeds
from trunnion.verification.context import ComparedContext, Faults
from trunnion.verification.deviations.reached_rows import ReachedRows, longest, reached_rows
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.results import Check
from trunnion.wording import counted, format_duration

#: Shares by which a feed may be below what is reached, for three digits are printed at least, and above, for the
#: positions of both runs may be rounded.
_BELOW: Final = 0.011
_ABOVE: Final = 0.001

_TITLE: Final = "feeds as the axes reach them"


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
        text = f"has a feed of {feed[row]:g}, and the axes reach {found.feed[row]:.5g} there"
        if above_most[row]:
            text = f"has a feed of {feed[row]:g}, more than the {found.most[row]:g} that it may have"
        elif unknown[row]:
            text = f"has a feed of {feed[row]:g} in place of {found.most[row]:g}, and what the axes reach is not known"
        faults.add(context.place_of_cl_row(row, float(feed[row]), text))
    now = float(reached_feeds(context.run, np.full(len(context.run), np.nan)).seconds.sum())
    times = f"{format_duration(now)} of motion, {format_duration(found.seconds)} at the feeds of the CL file"
    if now > longest(found.seconds):
        return [Check("reach", _TITLE, False, f"far longer than it may be: {times}", places=tuple(faults.places))]
    summary = "nothing is cut at a feed per minute"
    if np.isfinite(found.most).any():
        summary = f"{_summary(context, found, feed, lowered & ~kept, int(np.count_nonzero(kept)))}; {times}"
    return [faults.check("reach", _TITLE, summary)]


def _declared(expected: ExpectedPath) -> tuple[Floats, Floats, Flags]:
    """Return the feeds of all rows, (m,), the last printed digit of each, and which of them are declared."""
    feeds = [section.operation.moves.feed for section in expected.sections]
    digits = [np.full(len(feed), 2.0 * s.tolerances.feed) for feed, s in zip(feeds, expected.sections, strict=True)]
    declared = np.zeros(len(expected), np.bool_)
    for section in expected.sections:
        if section.tolerances.deviations is not None:
            declared[section.first + section.tolerances.deviations.reached_rows] = True
    return np.concatenate(feeds), np.concatenate(digits), declared


def _summary(context: ComparedContext, found: ReachedRows, feed: Floats, lowered: Flags, kept: int) -> str:
    """How many feeds are lower, and by how much."""
    limit = context.settings.feed_limit
    total, count = (int(np.count_nonzero(rows)) for rows in (np.isfinite(found.most), lowered))
    text = f"lower than {'in the CL file' if limit is None else f'{limit:g} mm/min'} at {count} of"
    text += f" {counted(total, 'point')}"
    if count:
        share = 100.0 * float((1.0 - feed[lowered] / found.most[lowered]).max())
        text += f", by {share:.0f} % at most"
    return text + (f"; that of the CL file is kept at {kept}, since the program would take far longer" if kept else "")
