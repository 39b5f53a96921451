"""The motions of a program against what the CL file asks for: which there are, of what kind, at which feed."""

import math

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.feed_path import FeedPath, counted
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import NAMED, Case, judged
from trunnion.verification.matching.declared_deviations import Believed, needless_feeds
from trunnion.verification.matching.expected_arcs import arc_of
from trunnion.verification.matching.expected_path import Allowed
from trunnion.verification.matching.hole_matching import leads, made_in
from trunnion.verification.matching.retracts import retreats
from trunnion.verification.results import Check, Place

_KINDS = {Kind.RAPID: "at rapid", Kind.LINEAR: "at feed on a line", Kind.ARC: "on a circle"}

#: A tip that moves by less than this, mm, or by less than rounding comes to, may be said to rest.
_RESTS = 1e-3

#: No control makes a block in less than this, minutes.
_QUICKEST = 1e-6

#: A number is the greatest if it is less by no more than this.
_LAST = 1e-6


def order(case: Case) -> Check:
    """Every point has its block, and every block its point."""
    wanted, pairs = case.wanted, case.pairs
    assert wanted is not None
    assert pairs is not None
    title = "every CL point has its block, every block its point"
    places = [case.missing(cl, "no block goes to this CL point") for cl in pairs.missing[:NAMED]]
    told: list[Place] = []
    count = len(pairs.missing)
    allowed = max(part.allowed.tip for part in wanted.parts)
    back = retreats(case.run, pairs.extra, allowed)
    lawful = {row for retreat in back for row in range(retreat.first, retreat.end)}
    lawful |= leads(case.run, pairs.extra, made_in(case.run, wanted), allowed)
    for retreat in back:
        text = f"draws back {retreat.distance:.3f} mm along the tool axis, turns, and comes back"
        told.append(case.place(retreat.first, retreat.distance, text))
    for row in pairs.extra:
        if row in lawful:
            continue
        if _stands_still(case.run, row):
            told.append(case.place(row, 0.0, "repeats the position before it: nothing moves"))
            continue
        count += 1
        if len(places) < 2 * NAMED:
            places.append(case.place(row, 0.0, "goes to a position that is no CL point"))
    places.sort(key=lambda place: place.nc_line)
    if places:
        return judged("order", title, places, "", count)
    left_out = len(wanted) - len(pairs.cl)
    summary = f"{len(pairs.cl)} points in their order"
    if len(pairs.between[0]):
        summary += f", {len(pairs.between[0])} more on the way between them"
    if left_out:
        summary += f", {left_out} repeated ones left out"
    if back:
        summary += f", {len(back)} {'retreat' if len(back) == 1 else 'retreats'} along the tool axis to turn"
    if len(told) > len(back):
        summary += f", {len(told) - len(back)} blocks that move nothing"
    return Check("order", title, True, summary, places=tuple(told[:NAMED]))


def _stands_still(run: Run, row: int) -> bool:
    before, after = run.poses(np.array([row - 1, row])).joints
    still = bool((np.abs(after - before) < 1e-9).all())
    return still and int(run.kind[row]) != Kind.ARC


def kind(case: Case) -> Check:
    """Rapid, line or circle, and for circles the centre, the way round and the turns."""
    wanted, pairs, run = case.wanted, case.pairs, case.run
    assert wanted is not None
    assert pairs is not None
    title = "rapid, line or circle as the CL file says"
    by_lines = {pieces.cl for pieces in pairs.pieces}
    places: list[Place] = []
    count = 0
    for nc, cl in pairs.all_chunks():
        for k in np.flatnonzero(run.kind[nc] != wanted.kind(cl)).tolist():
            row, point = int(nc[k]), int(cl[k])
            is_, want = Kind(int(run.kind[row])), wanted.point(point).kind
            if want is Kind.ARC and is_ is Kind.LINEAR and (point in by_lines or _is_flat(case, point)):
                continue
            if is_ is Kind.RAPID and want is Kind.LINEAR and wanted.point(point).feed == case.settings.rapid_feed:
                continue  # a cut as fast as rapids are here
            count += 1
            if len(places) < NAMED:
                text = f"moves {_KINDS[is_]}; the CL file wants it {_KINDS[want]}"
                places.append(case.place(row, 0.0, text, point))
    for pieces in pairs.pieces:
        for row in pieces.nc[run.kind[pieces.nc] != Kind.LINEAR].tolist():
            count += 1
            places.append(case.place(row, 0.0, "moves at rapid along an arc that is to be cut", pieces.cl))
    circles = _circles(case)
    count += len(circles)
    good = f"{wanted.rapids} rapids, {len(wanted.arcs.row)} circles, the rest lines"
    return judged("kind", title, sorted(places + circles, key=lambda p: p.nc_line), good, count)


def _is_flat(case: Case, cl: int) -> bool:
    """Whether a whole arc is so flat that one line stands for it."""
    assert case.wanted is not None
    arc = arc_of(case.wanted, cl)
    half = min(0.5 * arc.sweep, np.pi)
    return arc.radius * (1.0 - float(np.cos(half))) <= case.wanted.part_of(cl).allowed.chord * 1.01


def _circles(case: Case) -> list[Place]:
    """Circles that go round something else than they should."""
    wanted, pairs, run = case.wanted, case.pairs, case.run
    assert wanted is not None
    assert pairs is not None
    places: list[Place] = []
    if not len(run.arcs.row) or not len(wanted.arcs.row):
        return places
    for k, row in enumerate(wanted.arcs.row.tolist()):
        if row not in pairs.cl:
            continue
        motion = pairs.nc[pairs.cl.before(row)]
        if run.kind[motion] != Kind.ARC or motion == 0:
            continue
        m = int(np.searchsorted(run.arcs.row, motion))
        normal = wanted.arcs.normal[k]
        if float(run.arcs.normal[m] @ normal) < 1.0 - 1e-6:
            places.append(case.place(motion, 0.0, "goes round the circle the other way, or in another plane", row))
            continue
        if run.arcs.turns[m] != wanted.arcs.turns[k]:
            text = f"makes {run.arcs.turns[m]} whole turns besides; the CL file wants {wanted.arcs.turns[k]}"
            places.append(case.place(motion, 0.0, text, row))
        start = run.poses(np.array([motion - 1])).tip[0]
        arm = run.arcs.centre[m] - start - (wanted.arcs.centre[k] - wanted.point(row - 1).tip)
        place = run.arcs.centre[m] - wanted.arcs.centre[k]
        # Some controls are told the centre from the start, others as a place: what is rounded is within the limit.
        off = min(float(np.abs(each - (each @ normal) * normal).max()) for each in (arm, place))
        limits = wanted.part_of(row).allowed
        allowed = limits.tip + limits.centre
        if off > allowed + 1e-9:
            text = f"the circle's centre is off by {off:.6f} mm, {allowed:.6f} is allowed"
            places.append(case.place(motion, off, text, row))
    return places


def feed(case: Case, believed: Believed) -> Check:
    """Feeds of all rows that are not rapids."""
    wanted, pairs, run = case.wanted, case.pairs, case.run
    assert wanted is not None
    assert pairs is not None
    places: list[Place] = []
    count = 0
    seen: tuple[float, float] = (np.inf, -np.inf)
    for nc, cl in pairs.all_chunks():
        cuts = (run.kind[nc] != Kind.RAPID) & (wanted.kind(cl) != Kind.RAPID)
        rate, per_rev = run.state.feed.at(nc), wanted.per_rev(cl)
        asked = wanted.feed(cl)
        limits = Allowed(
            tip=max(part.allowed.tip for part in wanted.parts), feed=max(part.allowed.feed for part in wanted.parts)
        )
        mode = run.state.feed_mode.at(nc)
        near = np.abs(rate - asked) <= limits.feed + 1e-9
        _judge_times(case, nc, rate, asked, near, limits)
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
        for k in bad[: max(NAMED - len(places), 0)].tolist():
            unit = {93: "mm/min (inverse time)", 95: "mm/rev"}.get(int(mode[k]), "mm/min")
            want = "mm/rev" if per_rev[k] else "mm/min"
            has = "no feed" if np.isnan(rate[k]) else f"{rate[k]:g} {unit}"
            text = f"moves with {has}; the CL file wants {asked[k]:g} {want}"
            places.append(case.place(int(nc[k]), float(rate[k]), text, int(cl[k])))
    for pieces in pairs.pieces:
        asked_here, limits = wanted.point(pieces.cl).feed, wanted.part_of(pieces.cl).allowed
        rate = run.state.feed.at(pieces.nc)
        near = np.abs(rate - asked_here) <= limits.feed + 1e-9
        _judge_times(case, pieces.nc, rate, np.full(len(rate), asked_here), near, limits)
        for k in np.flatnonzero(~near).tolist():
            count += 1
            text = f"moves with {rate[k]:g} mm/min; the CL file wants {asked_here:g}"
            places.append(case.place(int(pieces.nc[k]), float(rate[k]), text, pieces.cl))
    broken = [*believed.feed, *needless_feeds(run, wanted, pairs)]
    places = [*(case.answering(one.cl, one.value, one.text) for one in broken[:NAMED]), *places]
    count += len(broken)
    good = "nothing is cut" if seen[0] > seen[1] else f"{seen[0]:g} to {seen[1]:g}, as the CL file says"
    least, rows = believed.slowed
    good += f"; lowered at {rows} rows, down to {least:.2f}, for the rotary axes" if rows else ""
    return judged("feed", "feeds as the CL file says", places, good, count)


def _judge_times(case: Case, nc: Ints, rate: Floats, asked: Floats, near: Flags, allowed: Allowed) -> None:
    """Judge blocks whose F is not the tip's by their time: those with inverse time, and those that turn without TCP.

    Written: into ``near`` whether they take as long as they should, into ``rate`` the feed of the tip. Where F is the
    tip's at the start of each block (``FeedPath.TIP``), it is compared as it stands.
    """
    run = case.run
    timed = np.flatnonzero(run.state.feed_mode.at(nc) == 93)
    if len(timed):
        with np.errstate(divide="ignore"):
            minutes = 1.0 / rate[timed]
        top = np.inf if case.settings.top_rate is None else case.settings.top_rate - _LAST
        fastest = np.where(rate[timed] >= top, minutes, _QUICKEST)
        slack = 2.0 * math.sqrt(3.0) * allowed.tip
        near[timed], rate[timed] = _in_time(run, nc[timed], minutes, asked[timed], slack, quickest=fastest)
    way = counted(run, nc)
    led = np.flatnonzero(~np.isnan(way) & (run.state.feed_path.at(nc) != FeedPath.TIP))
    if not len(led):
        return
    with np.errstate(divide="ignore", invalid="ignore"):
        minutes = way[led] / rate[led]
        rounded = allowed.feed / rate[led]
    slack = 2.0 * math.sqrt(3.0) * allowed.tip
    top = np.inf if case.settings.top_feed is None else case.settings.top_feed - allowed.feed
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
    before, after = run.poses(nc - 1), run.poses(nc)
    way = np.sqrt(((after.tip - before.tip) ** 2).sum(axis=1))
    turned = np.abs(after.joints - before.joints)[:, list(run.machine.rotary)].max(axis=1)
    longest = np.where(way < max(_RESTS, slack), np.maximum(way, turned), way) + slack
    soon = minutes < (1.0 - 1e-3 - rounded) * np.maximum(way - slack, 0.0) / asked
    late = minutes > (1.0 + 1e-3 + rounded) * longest / asked + quickest
    with np.errstate(divide="ignore", invalid="ignore"):
        return ~(soon | late | np.isnan(minutes)), way / minutes
