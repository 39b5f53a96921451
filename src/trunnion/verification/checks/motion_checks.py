"""The motions of a program against what the CL file asks for: which there are, of what kind, at which feed."""

import math

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.feed_path import FeedPath, row_feed_path_lengths
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import MAX_PLACES, Context, check_from_places
from trunnion.verification.deviations.declared_deviations import AcceptedDeviations, needlessly_lowered_feeds
from trunnion.verification.expected.arcs import arc_of
from trunnion.verification.expected.path import Tolerances
from trunnion.verification.matching.hole_matching import hole_approach_rows, match_holes
from trunnion.verification.matching.rewind_retracts import find_rewind_retracts
from trunnion.verification.results import Check, Place

_KINDS = {Kind.RAPID: "at rapid", Kind.LINEAR: "at feed on a line", Kind.ARC: "on a circle"}

#: A tip that moves by less than this, mm, or by less than rounding comes to, may be said to rest.
_RESTS = 1e-3

#: No control makes a block in less than this, minutes.
_QUICKEST = 1e-6

#: A number is the greatest if it is less by no more than this.
_LAST = 1e-6


def order(context: Context) -> Check:
    """Every point has its block, and every block its point."""
    expected, matching = context.expected, context.matching
    assert expected is not None
    assert matching is not None
    title = "every CL point has its block, every block its point"
    places = [context.place_of_missing(cl, "no block goes to this CL point") for cl in matching.missing[:MAX_PLACES]]
    told: list[Place] = []
    count = len(matching.missing)
    allowed = max(section.tolerances.tip for section in expected.sections)
    back = find_rewind_retracts(context.run, matching.extra, allowed)
    lawful = {row for retreat in back for row in range(retreat.first, retreat.end)}
    lawful |= hole_approach_rows(context.run, matching.extra, match_holes(context.run, expected), allowed)
    for retreat in back:
        text = f"draws back {retreat.distance:.3f} mm along the tool axis, turns, and comes back"
        told.append(context.place(retreat.first, retreat.distance, text))
    for row in matching.extra:
        if row in lawful:
            continue
        if _stands_still(context.run, row):
            told.append(context.place(row, 0.0, "repeats the position before it: nothing moves"))
            continue
        count += 1
        if len(places) < 2 * MAX_PLACES:
            places.append(context.place(row, 0.0, "goes to a position that is no CL point"))
    places.sort(key=lambda place: place.nc_line)
    if places:
        return check_from_places("order", title, places, "", count)
    left_out = len(expected) - len(matching.cl)
    summary = f"{len(matching.cl)} points in their order"
    if len(matching.between[0]):
        summary += f", {len(matching.between[0])} more on the way between them"
    if left_out:
        summary += f", {left_out} repeated ones left out"
    if back:
        summary += f", {len(back)} {'retreat' if len(back) == 1 else 'retreats'} along the tool axis to turn"
    if len(told) > len(back):
        summary += f", {len(told) - len(back)} blocks that move nothing"
    return Check("order", title, True, summary, places=tuple(told[:MAX_PLACES]))


def _stands_still(run: Run, row: int) -> bool:
    before, after = run.positions(np.array([row - 1, row])).joints
    still = bool((np.abs(after - before) < 1e-9).all())
    return still and int(run.kind[row]) != Kind.ARC


def kind(context: Context) -> Check:
    """Rapid, line or circle, and for circles the centre, the way round and the turns."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    title = "rapid, line or circle as the CL file says"
    by_lines = {pieces.cl for pieces in matching.pieces}
    places: list[Place] = []
    count = 0
    for nc, cl in matching.all_pair_chunks():
        for k in np.flatnonzero(run.kind[nc] != expected.kind(cl)).tolist():
            row, point = int(nc[k]), int(cl[k])
            is_, want = Kind(int(run.kind[row])), expected.point(point).kind
            if want is Kind.ARC and is_ is Kind.LINEAR and (point in by_lines or _is_flat(context, point)):
                continue
            if is_ is Kind.RAPID and want is Kind.LINEAR and expected.point(point).feed == context.settings.rapid_feed:
                continue  # a cut as fast as rapids are here
            count += 1
            if len(places) < MAX_PLACES:
                text = f"moves {_KINDS[is_]}; the CL file wants it {_KINDS[want]}"
                places.append(context.place(row, 0.0, text, point))
    for pieces in matching.pieces:
        for row in pieces.nc[run.kind[pieces.nc] != Kind.LINEAR].tolist():
            count += 1
            places.append(context.place(row, 0.0, "moves at rapid along an arc that is to be cut", pieces.cl))
    circles = _circles(context)
    count += len(circles)
    good = f"{expected.rapids} rapids, {len(expected.arcs.row)} circles, the rest lines"
    return check_from_places("kind", title, sorted(places + circles, key=lambda p: p.nc_line), good, count)


def _is_flat(context: Context, cl: int) -> bool:
    """Whether a whole arc is so flat that one line stands for it."""
    assert context.expected is not None
    arc = arc_of(context.expected, cl)
    half = min(0.5 * arc.sweep, np.pi)
    return arc.radius * (1.0 - float(np.cos(half))) <= context.expected.section_at(cl).tolerances.chord * 1.01


def _circles(context: Context) -> list[Place]:
    """Circles that go round something else than they should."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    places: list[Place] = []
    if not len(run.arcs.row) or not len(expected.arcs.row):
        return places
    for k, row in enumerate(expected.arcs.row.tolist()):
        if row not in matching.cl:
            continue
        motion = matching.nc[matching.cl.before(row)]
        if run.kind[motion] != Kind.ARC or motion == 0:
            continue
        m = int(np.searchsorted(run.arcs.row, motion))
        normal = expected.arcs.normal[k]
        if float(run.arcs.normal[m] @ normal) < 1.0 - 1e-6:
            places.append(context.place(motion, 0.0, "goes round the circle the other way, or in another plane", row))
            continue
        if run.arcs.full_turns[m] != expected.arcs.full_turns[k]:
            text = (
                f"makes {run.arcs.full_turns[m]} whole turns besides; the CL file wants {expected.arcs.full_turns[k]}"
            )
            places.append(context.place(motion, 0.0, text, row))
        start = run.positions(np.array([motion - 1])).tip[0]
        arm = run.arcs.centre[m] - start - (expected.arcs.centre[k] - expected.point(row - 1).tip)
        place = run.arcs.centre[m] - expected.arcs.centre[k]
        # Some controls are told the centre from the start, others as a place: what is rounded is within the limit.
        off = min(float(np.abs(each - (each @ normal) * normal).max()) for each in (arm, place))
        limits = expected.section_at(row).tolerances
        allowed = limits.tip + limits.centre
        if off > allowed + 1e-9:
            text = f"the circle's centre is off by {off:.6f} mm, {allowed:.6f} is allowed"
            places.append(context.place(motion, off, text, row))
    return places


def feed(context: Context, believed: AcceptedDeviations) -> Check:
    """Feeds of all rows that are not rapids."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    places: list[Place] = []
    count = 0
    seen: tuple[float, float] = (np.inf, -np.inf)
    for nc, cl in matching.all_pair_chunks():
        cuts = (run.kind[nc] != Kind.RAPID) & (expected.kind(cl) != Kind.RAPID)
        rate, per_rev = run.state.feed.at(nc), expected.per_rev(cl)
        asked = expected.feed(cl)
        limits = Tolerances(
            tip=max(section.tolerances.tip for section in expected.sections),
            feed=max(section.tolerances.feed for section in expected.sections),
        )
        mode = run.state.feed_mode.at(nc)
        near = np.abs(rate - asked) <= limits.feed + 1e-9
        _judge_times(context, nc, rate, asked, near, limits)
        told = cuts & ~np.isnan(asked)
        wrong = cuts & ((mode == 95) != per_rev)
        wrong |= told & ~near
        known = asked if told.all() else asked[told]
        if len(known):
            seen = min(seen[0], float(known.min())), max(seen[1], float(known.max()))
        if not wrong.any():
            continue
        bad = np.flatnonzero(wrong)
        count += len(bad)
        for k in bad[: max(MAX_PLACES - len(places), 0)].tolist():
            unit = {93: "mm/min (inverse time)", 95: "mm/rev"}.get(int(mode[k]), "mm/min")
            want = "mm/rev" if per_rev[k] else "mm/min"
            has = "no feed" if np.isnan(rate[k]) else f"{rate[k]:g} {unit}"
            text = f"moves with {has}; the CL file wants {asked[k]:g} {want}"
            places.append(context.place(int(nc[k]), float(rate[k]), text, int(cl[k])))
    for pieces in matching.pieces:
        asked_here, limits = expected.point(pieces.cl).feed, expected.section_at(pieces.cl).tolerances
        rate = run.state.feed.at(pieces.nc)
        near = np.abs(rate - asked_here) <= limits.feed + 1e-9
        _judge_times(context, pieces.nc, rate, np.full(len(rate), asked_here), near, limits)
        for k in np.flatnonzero(~near).tolist():
            count += 1
            text = f"moves with {rate[k]:g} mm/min; the CL file wants {asked_here:g}"
            places.append(context.place(int(pieces.nc[k]), float(rate[k]), text, pieces.cl))
    broken = [*believed.feed, *needlessly_lowered_feeds(run, expected, matching)]
    places = [*(context.place_at_cl(one.cl, one.value, one.text) for one in broken[:MAX_PLACES]), *places]
    count += len(broken)
    good = "nothing is cut" if seen[0] > seen[1] else f"{seen[0]:g} to {seen[1]:g}, as the CL file says"
    least, rows = believed.slowed
    good += f"; lowered at {rows} rows, down to {least:.2f}, for the rotary axes" if rows else ""
    return check_from_places("feed", "feeds as the CL file says", places, good, count)


def _judge_times(context: Context, nc: Ints, rate: Floats, asked: Floats, near: Flags, allowed: Tolerances) -> None:
    """Judge blocks whose F is not the tip's by their time: those with inverse time, and those that turn without TCP.

    Written: into ``near`` whether they take as long as they should, into ``rate`` the feed of the tip. Where F is the
    tip's at the start of each block (``FeedPath.TIP``), it is compared as it stands.
    """
    run = context.run
    timed = np.flatnonzero(run.state.feed_mode.at(nc) == 93)
    if len(timed):
        with np.errstate(divide="ignore"):
            minutes = 1.0 / rate[timed]
        top = (
            np.inf if context.settings.max_inverse_time_feed is None else context.settings.max_inverse_time_feed - _LAST
        )
        fastest = np.where(rate[timed] >= top, minutes, _QUICKEST)
        slack = 2.0 * math.sqrt(3.0) * allowed.tip
        near[timed], rate[timed] = _in_time(run, nc[timed], minutes, asked[timed], slack, quickest=fastest)
    way = row_feed_path_lengths(run, nc)
    led = np.flatnonzero(~np.isnan(way) & (run.state.feed_path.at(nc) != FeedPath.TIP))
    if not len(led):
        return
    with np.errstate(divide="ignore", invalid="ignore"):
        minutes = way[led] / rate[led]
        rounded = allowed.feed / rate[led]
    slack = 2.0 * math.sqrt(3.0) * allowed.tip
    top = np.inf if context.settings.max_feed is None else context.settings.max_feed - allowed.feed
    fastest = np.where(rate[led] >= top, minutes, _QUICKEST)
    near[led], rate[led] = _in_time(run, nc[led], minutes, asked[led], slack, rounded, fastest)


def _in_time(
    run: Run,
    nc: Ints,
    minutes: Floats,
    asked: Floats,
    slack: float,
    rounded: Floats | float = 0.0,
    quickest: Floats | float = _QUICKEST,
) -> tuple[Flags, Floats]:
    """Whether blocks take as long as their way does at the feed asked for, and their feeds, mm/min.

    They may be off by a thousandth, by the share ``rounded`` that a printed number is off, and by ``slack`` mm of the
    way. Where the tip rests, a degree may count as a millimetre. ``quickest`` is what a block may always take: no
    control is quicker.
    """
    before, after = run.positions(nc - 1), run.positions(nc)
    way = np.sqrt(((after.tip - before.tip) ** 2).sum(axis=1))
    turned = np.abs(after.joints - before.joints)[:, list(run.machine.rotary)].max(axis=1)
    longest = np.where(way < max(_RESTS, slack), np.maximum(way, turned), way) + slack
    soon = minutes < (1.0 - 1e-3 - rounded) * np.maximum(way - slack, 0.0) / asked
    late = minutes > (1.0 + 1e-3 + rounded) * longest / asked + quickest
    with np.errstate(divide="ignore", invalid="ignore"):
        return ~(soon | late | np.isnan(minutes)), way / minutes
