"""The feeds of a program against those of the CL files."""

import math

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording
from trunnion.model.feed_path import NO_ROTATION, FeedPath, row_feed_path_lengths
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.timing import HARDLY_MOVES
from trunnion.verification.context import ComparedContext, Faults
from trunnion.verification.deviations.declared_deviations import AcceptedDeviations, needlessly_lowered_feeds
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.expected.tolerances import feed_per_rev_tolerance
from trunnion.verification.results import Check

#: What is said of several feeds in a unit, by what is said of one.
_RANGES = {"per_minute": "range_per_minute", "per_revolution": "range_per_revolution"}

#: A tip that moves by less than this, mm, or by less than rounding, may be taken to rest.
_TIP_RESTS = 1e-3

#: No control executes a block in less than this, minutes.
_SHORTEST_BLOCK = 1e-6

#: Share by which the time of a block may be off.
_TIME_SHARE = 1e-3

#: A number is the largest one possible if it is less by no more than this.
_LARGEST = 1e-6


def check_feed(context: ComparedContext, accepted: AcceptedDeviations, original: ExpectedPath) -> Check:
    """Return feeds of all rows that are not rapids, as far as they were not declared to be lowered.

    ``original`` has the feeds of the CL files.
    """
    found = Faults()
    declared = [*accepted.feed, *needlessly_lowered_feeds(context.run, context.expected, context.matching)]
    found.add_rows(len(declared), (context.place_of_cl_row(fault.cl, fault.value, fault.said) for fault in declared))
    ranges = _compare_points(context, original, found)
    for segments in context.matching.arc_segments:
        wanted, tolerances = (
            context.expected.point(segments.cl).feed,
            context.expected.section_at(segments.cl).tolerances,
        )
        asked = np.full(len(segments.nc), wanted)
        per_rev = context.expected.per_rev(np.array([segments.cl]))[0]
        digit = feed_per_rev_tolerance(asked) if per_rev else np.full(len(asked), tolerances.feed)
        near, feed = _compare_feeds(context, segments.nc, asked, tolerances.tip, digit)
        for k in np.flatnonzero(~near).tolist():
            said = Wording("feed", "other_on_arc", has=feed[k], wanted=wanted)
            found.add(context.place_with_cl(int(segments.nc[k]), float(feed[k]), said, segments.cl))
    feeds = tuple(_range(unit, *ends) for unit, ends in sorted(ranges.items()))
    good = Wording("feed", "feeds", feeds=feeds) if feeds else Wording("feed", "nothing_cuts")
    lowest, rows = accepted.slowed
    return found.check("feed", Wording("feed", "lowered", feeds=good, rows=rows, lowest=lowest) if rows else good)


def _range(unit: str, low: float, high: float) -> Wording:
    return Wording("feed", unit, feed=low) if low == high else Wording("feed", _RANGES[unit], low=low, high=high)


def _compare_points(context: ComparedContext, original: ExpectedPath, found: Faults) -> dict[str, tuple[float, float]]:
    """Compare the feeds of all motions that go or lead to a CL point; return the lowest and highest by unit."""
    run, expected = context.run, context.expected
    ranges: dict[str, tuple[float, float]] = {}
    feed_tolerance = max(section.tolerances.feed for section in expected.sections)
    for nc, cl in context.matching.all_pair_chunks():
        at_feed = (run.kind[nc] != Kind.RAPID) & (expected.kind(cl) != Kind.RAPID)
        per_rev, asked, mode = expected.per_rev(cl), expected.feed(cl), run.state.feed_mode.at(nc)
        digit = np.where(per_rev, feed_per_rev_tolerance(asked), feed_tolerance)
        if context.settings.fastest_feed:
            asked, either = _asked_at_rest(context, nc, asked, original.feed(cl))
        near, feed = _compare_feeds(context, nc, asked, expected.max_tip_tolerance, digit)
        if context.settings.fastest_feed and len(either):
            own = original.feed(cl[either])
            near[either] |= _compare_feeds(context, nc[either], own, expected.max_tip_tolerance, digit[either])[0]
        stated = at_feed & ~np.isnan(asked)
        wrong = at_feed & ((mode == 95) != per_rev)
        wrong |= stated & ~near
        for unit, rows in (("per_minute", stated & ~per_rev), ("per_revolution", stated & per_rev)):
            if rows.any():
                low, high = ranges.get(unit, (np.inf, -np.inf))
                ranges[unit] = min(low, float(asked[rows].min())), max(high, float(asked[rows].max()))
        if not wrong.any():
            continue
        texts = (
            (int(k), _feed_fault(float(feed[k]), int(mode[k]), float(asked[k]), 95 if per_rev[k] else 94))
            for k in np.flatnonzero(wrong)
        )
        places = (context.place_with_cl(int(nc[k]), float(feed[k]), said, int(cl[k])) for k, said in texts)
        found.add_rows(int(wrong.sum()), places)
    return ranges


def _feed_fault(feed: float, mode: int, asked: float, mode_asked: int) -> Wording:
    """Return a feed that is wrong, and the one asked for."""
    has = Wording("feed", "no_feed") if math.isnan(feed) else _feed_in(mode, feed)
    return Wording("feed", "other", has=has, wanted=_feed_in(mode_asked, asked))


def _feed_in(mode: int, feed: float) -> Wording:
    return Wording("feed", {93: "per_minute_by_time", 95: "per_revolution"}.get(mode, "per_minute"), feed=feed)


def _asked_at_rest(context: ComparedContext, nc: Ints, asked: Floats, own: Floats) -> tuple[Floats, Ints]:
    """Return the feeds asked for where those that the axes reach are declared, (k,), and where that of the CL file may
    stand.

    Rows that turn rotary axes while the tip hardly moves keep ``own``, the feed of the CL file, (k,).
    """
    if context.settings.feed_limit is not None:
        own = np.fmin(own, context.settings.feed_limit)
    rows = np.flatnonzero((asked != own) & ~np.isnan(own) & (nc > 0))
    before, after = context.run.positions(nc[rows] - 1), context.run.positions(nc[rows])
    travel = np.linalg.norm(after.tip - before.tip, axis=1)
    turns = np.abs(after.joints - before.joints)[:, list(context.run.machine.rotary)].max(axis=1, initial=0.0)
    slack = 2.0 * math.sqrt(3.0) * context.expected.max_tip_tolerance
    turning = turns > NO_ROTATION
    asked = asked.copy()
    rests = rows[turning & (travel < HARDLY_MOVES - slack)]
    asked[rests] = own[rests]
    return asked, rows[turning & (np.abs(travel - HARDLY_MOVES) <= slack)]


def _compare_feeds(
    context: ComparedContext, nc: Ints, asked: Floats, tip_tolerance: float, feed_tolerance: Floats
) -> tuple[Flags, Floats]:
    """Whether rows move at the feeds asked for, (k,) bool, and their feeds, (k,).

    Blocks whose F is not the feed of the tip are compared by their time: those with inverse time, and those that turn
    rotary axes without TCP. Where F is the feed of the tip at the start of each block (``FeedPath.TIP``), it is
    compared as programmed. ``feed_tolerance`` (k,) is that of the rounding, in the unit of each feed.
    """
    run, settings = context.run, context.settings
    feed = run.state.feed.at(nc)
    near = np.abs(feed - asked) <= feed_tolerance + 1e-9
    if settings.below_rapid_feed is not None:
        near |= (asked == settings.rapid_feed) & (np.abs(feed - settings.below_rapid_feed) <= 1e-9)
    slack = 2.0 * math.sqrt(3.0) * tip_tolerance
    timed = np.flatnonzero(run.state.feed_mode.at(nc) == 93)
    if len(timed):
        with np.errstate(divide="ignore"):
            minutes = 1.0 / feed[timed]
        limit = np.inf if settings.max_inverse_time_feed is None else settings.max_inverse_time_feed - _LARGEST
        always = np.where(feed[timed] >= limit, minutes, _SHORTEST_BLOCK)
        blocks = _TimedBlocks(nc[timed], minutes, asked[timed], always)
        near[timed], feed[timed] = _compare_times(context, blocks, slack)
    length = row_feed_path_lengths(run, nc)
    free = np.flatnonzero(~np.isnan(length) & (run.state.feed_path.at(nc) != FeedPath.TIP))
    if len(free):
        with np.errstate(divide="ignore", invalid="ignore"):
            minutes = length[free] / feed[free]
            rounding = feed_tolerance[free] / feed[free]
        greatest = np.inf if settings.max_feed is None else settings.max_feed
        always = np.where(feed[free] >= greatest - feed_tolerance[free], minutes, _SHORTEST_BLOCK)
        blocks = _TimedBlocks(nc[free], minutes, asked[free], always)
        near[free], feed[free] = _compare_times(context, blocks, slack, rounding)
    return near, feed


@dataclass(frozen=True, slots=True, eq=False)
class _TimedBlocks:
    """Rows, (k,); their times, minutes; the feeds asked for, mm/min; and the times that they may take at any feed."""

    rows: Ints
    minutes: Floats
    asked: Floats
    always: Floats


def _compare_times(
    context: ComparedContext, blocks: _TimedBlocks, slack: float, rounding: Floats | float = 0.0
) -> tuple[Flags, Floats]:
    """Whether blocks take as long as their distance does at the feed asked for, and their feeds, mm/min.

    They may be off by a thousandth, by the share ``rounding`` by which a printed number is off, and by ``slack`` mm of
    the distance. Where the tip rests, a degree may count as a millimetre.
    """
    run, minutes, asked = context.run, blocks.minutes, blocks.asked
    before, after = run.positions(blocks.rows - 1), run.positions(blocks.rows)
    travel = np.sqrt(((after.tip - before.tip) ** 2).sum(axis=1))
    turned = np.abs(after.joints - before.joints)[:, list(run.machine.rotary)].max(axis=1)
    longest = np.where(travel < max(_TIP_RESTS, slack), np.maximum(travel, turned), travel) + slack
    too_soon = minutes < (1.0 - _TIME_SHARE - rounding) * np.maximum(travel - slack, 0.0) / asked
    too_late = minutes > (1.0 + _TIME_SHARE + rounding) * longest / asked + blocks.always
    with np.errstate(divide="ignore", invalid="ignore"):
        return ~(too_soon | too_late | np.isnan(minutes)), travel / minutes
