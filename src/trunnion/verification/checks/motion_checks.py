"""The motions of a program against the CL files: which there are, in which order, and of what kind."""

from collections.abc import Iterator

import numpy as np

from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.cuts_left_out import cuts_left_out
from trunnion.verification.checks.passages import passage_rows, settings_to_repeat
from trunnion.verification.checks.skipped_ways import ways_behind_skipped
from trunnion.verification.context import MAX_PLACES, ComparedContext, Faults
from trunnion.verification.expected.arcs import arc_of
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.positioning_moves import stands_still
from trunnion.verification.matching.hole_approaches import hole_approach_rows
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.matching.rewind_retracts import RewindRetract, find_rewind_retracts
from trunnion.verification.matching.unstated_axes import unstated_axes
from trunnion.verification.results import Check, Place

_KINDS = {Kind.RAPID: "at_rapid", Kind.LINEAR: "on_line", Kind.ARC: "on_circle"}

#: Tool axes are the same when no component differs by more than this.
_SAME_AXIS = 1e-6


def check_order(context: ComparedContext) -> Check:
    """Every CL point has its block, and every block its point."""
    run, expected, matching = context.run, context.expected, context.matching
    tolerance = expected.max_tip_tolerance
    retracts = find_rewind_retracts(run, matching.extra, tolerance)
    lawful = {row for retract in retracts for row in range(retract.first, retract.end)}
    passages = passage_rows(context)
    ways = ways_behind_skipped(context)
    lawful |= passages | ways
    lawful |= hole_approach_rows(run, matching.extra, match_holes(run, expected), tolerance)
    machine_positions = MachinePositions.of(run)
    measurable = [row for row in matching.extra if not machine_positions.crossed(np.array([row]))[0]]
    lawful |= {row for row in measurable if _retracts_before_home(run, row, tolerance)}
    stands = stands_still(run, np.array(matching.extra, np.int64)).tolist()
    still = [row for row, stays in zip(matching.extra, stands, strict=True) if stays]
    extra = [row for row, stays in zip(matching.extra, stands, strict=True) if not stays and row not in lawful]
    missing, no_point = Wording("order", "no_block"), Wording("order", "no_point")
    places = [context.place_of_missing(cl, missing) for cl in matching.missing[:MAX_PLACES]]
    to_repeat = settings_to_repeat(context) if extra else {}
    posted = [
        context.settings.repeated(no_point, **to_repeat[row]) if row in to_repeat else no_point
        for row in extra[:MAX_PLACES]
    ]
    places += [context.place(row, 0.0, told) for row, told in zip(extra[:MAX_PLACES], posted, strict=True)]
    left_out = list(cuts_left_out(context, {*extra, *ways}))
    left_out += [
        context.place(row, 0.0, Wording("order", "not_stated" if row in matching.nc else "not_stated_above", axes=axes))
        for row, axes in unstated_axes(run, matching, passages)
    ]
    places += left_out[:MAX_PLACES]
    if not places:
        return _in_order(context, retracts, still)
    count = len(matching.missing) + len(extra) + len(left_out)
    found = Faults(sorted(places, key=lambda place: place.nc_line), count)
    return found.check("order", None)


def _in_order(context: ComparedContext, retracts: list[RewindRetract], still: list[int]) -> Check:
    """Return the check of a program with all points in their order, and its rows that are explained without a point."""
    matching = context.matching
    notes = [
        context.place(
            retract.first,
            retract.distance,
            Wording("order", "draws_back", distance=retract.distance),
        )
        for retract in retracts
    ]
    notes += [context.place(row, 0.0, Wording("order", "repeats")) for row in still]
    left_out = len(context.expected) - len(matching.cl)
    parts = {"more_between": len(matching.intermediate[0]), "left_out": left_out}
    parts |= {"retracts": len(retracts), "still": len(still)}
    more = (Wording("order", variant, count=count) for variant, count in parts.items() if count)
    good = Wording("order", "good", parts=(Wording("order", "points", count=len(matching.cl)), *more))
    return Check("order", True, good, places=tuple(notes[:MAX_PLACES]))


def _retracts_before_home(run: Run, row: int, tolerance: float) -> bool:
    """Whether a rapid only draws the tool back along its axis, and the next motion goes to a machine position."""
    retracts = any(event.kind == "retract" and event.before_row == row + 1 for event in run.events)
    goes_home = row + 1 < len(run) and bool(run.state.machine_frame[row + 1])
    if row == 0 or run.kind[row] != Kind.RAPID or not (retracts or goes_home):
        return False
    positions = run.positions(np.array([row - 1, row]))
    step, axis = positions.tip[1] - positions.tip[0], positions.axis[1]
    back = float(step @ axis)
    straight = float(np.linalg.norm(step - back * axis)) <= 4.0 * tolerance
    turned = float(np.abs(positions.axis[0] - axis).max()) > _SAME_AXIS
    return back > 0.0 and straight and not turned


def check_kind(context: ComparedContext) -> Check:
    """Rapid, line or circle; and for circles centre, direction and turns."""
    run, expected, matching = context.run, context.expected, context.matching
    by_lines = {segments.cl for segments in matching.arc_segments if segments.pieces is None}
    found = Faults()
    for nc, cl in matching.all_pair_chunks():
        for k in np.flatnonzero(run.kind[nc] != expected.kind(cl)).tolist():
            row, point = int(nc[k]), int(cl[k])
            actual, wanted = Kind(int(run.kind[row])), expected.point(point).kind
            if wanted is Kind.ARC and actual is Kind.LINEAR and (point in by_lines or _is_flat(context, point)):
                continue
            at_rapid_feed = expected.point(point).feed == context.settings.rapid_feed
            if actual is Kind.RAPID and wanted is Kind.LINEAR and at_rapid_feed:
                continue
            kinds = {"has": Wording("kind", _KINDS[actual]), "wanted": Wording("kind", _KINDS[wanted])}
            found.add(context.place_with_cl(row, 0.0, Wording("kind", "other", **kinds), point))
    others = [*_rapids_on_arcs(context), *_wrong_circles(context)]
    found = Faults(sorted(found.places + others, key=lambda place: place.nc_line), found.count + len(others))
    rapids, arcs = expected.rapid_count, len(expected.arcs.row)
    lines = len(expected) - rapids - arcs
    return found.check("kind", Wording("kind", "good", rapids=rapids, arcs=arcs, lines=lines))


def _is_flat(context: ComparedContext, cl: int) -> bool:
    """Whether a whole arc is so flat that one line may replace it."""
    arc = arc_of(context.expected, cl)
    half = min(0.5 * arc.sweep, np.pi)
    sagitta = arc.radius * (1.0 - float(np.cos(half)))
    return sagitta <= context.expected.section_at(cl).tolerances.chord * 1.01


def _rapids_on_arcs(context: ComparedContext) -> Iterator[Place]:
    """Motions that replace an arc and are no lines."""
    for segments in context.matching.arc_segments:
        if segments.pieces is not None:
            continue
        for row in segments.nc[context.run.kind[segments.nc] != Kind.LINEAR].tolist():
            yield context.place_with_cl(row, 0.0, Wording("kind", "rapid_on_arc"), segments.cl)


def _wrong_circles(context: ComparedContext) -> Iterator[Place]:
    """Circles with a wrong direction, plane, number of turns, or centre."""
    run, expected, matching = context.run, context.expected, context.matching
    if not len(run.arcs.row) or not len(expected.arcs.row):
        return
    pieces = {segments.cl: segments.nc.tolist() for segments in matching.arc_segments if segments.pieces is not None}
    for k, row in enumerate(expected.arcs.row.tolist()):
        if row not in matching.cl:
            continue
        motion = matching.nc[matching.cl.count_before(row)]
        if run.kind[motion] != Kind.ARC or motion == 0:
            continue
        before = pieces.get(row, [])
        for circle in (*before, motion):
            yield from _circle_faults(context, k, circle)
        turns = int(run.arcs.full_turns[np.searchsorted(run.arcs.row, motion)])
        wanted = int(expected.arcs.full_turns[k])
        # Pieces have been matched by how far they go round, so that together they make the turns.
        if not before and turns != wanted:
            said = Wording("kind", "other_turns", turns=turns, wanted=wanted)
            yield context.place_with_cl(motion, 0.0, said, row)


def _circle_faults(context: ComparedContext, k: int, motion: int) -> Iterator[Place]:
    """Yield a wrong direction, plane or centre of the circle in a row of the run, which belongs to arc ``k``."""
    run, expected = context.run, context.expected
    m, row = int(np.searchsorted(run.arcs.row, motion)), int(expected.arcs.row[k])
    normal, centre = expected.arcs.normal[k], expected.arcs.centre[k]
    if float(run.arcs.normal[m] @ normal) < 1.0 - 1e-6:
        yield context.place_with_cl(motion, 0.0, Wording("kind", "other_way"), row)
        return
    start = run.positions(np.array([motion - 1])).tip[0]
    off_from_start = run.arcs.centre[m] - start - (centre - expected.point(row - 1).tip)
    off = run.arcs.centre[m] - centre
    # A control takes the centre from the start or as a position: one of the two is exact but for rounding.
    error = min(float(np.abs(each - (each @ normal) * normal).max()) for each in (off_from_start, off))
    tolerances = expected.section_at(row).tolerances
    limit = tolerances.tip + tolerances.centre
    if error > limit + 1e-9:
        yield context.place_with_cl(motion, error, Wording("kind", "centre_off", off=error, limit=limit), row)
