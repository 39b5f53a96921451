"""Tip and tool axis at every CL point, and along arcs that the program replaces by lines."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.messages import Wording, phrase
from trunnion.model.arcs import ARC_POINT_TOLERANCE
from trunnion.verification.context import MAX_PLACES, ComparedContext, Faults
from trunnion.verification.deviations.declared_deviations import AcceptedDeviations, misplaced_lean_positions
from trunnion.verification.deviations.nominal_values import (
    LONGER,
    depends_on_length,
    depends_on_zero,
    moved_tips,
    with_linear_positions,
)
from trunnion.verification.deviations.point_deviations import DeviationSummary
from trunnion.verification.expected.arcs import great_circle_points
from trunnion.verification.kinematics.axis_difference import degrees_apart
from trunnion.verification.matching.pairs import ArcSegments
from trunnion.verification.results import Check, Place

#: A point whose three coordinates are off by one each is off by this much.
_DIAGONAL = math.sqrt(3.0) + 1e-6

#: An arc may miss the end of its circle by this much, mm: both its ends may be off the radius.
_MAX_CLOSURE_ERROR = 2.0 * ARC_POINT_TOLERANCE


#: Of what the checks measure.
_UNITS: Final = {"tip": "mm", "axis": "deg"}


def check_tip(context: ComparedContext, deviations: DeviationSummary) -> Check:
    """Return the tip at every CL point."""
    run, expected, matching = context.run, context.expected, context.matching
    places = []
    for k, value in deviations.bad:
        row, cl = matching.nc[k], matching.cl[k]
        actual, wanted = run.positions(np.array([row])).tip[0], expected.point(cl).tip
        axes = tuple(
            Wording("tip", "axis_off", axis=name, now=now, then=then)
            for name, now, then in zip("XYZ", actual, wanted, strict=True)
            if not abs(now - then) <= deviations.limit
        )
        said = Wording("tip", "off_in_inches" if run.state.inches[row] else "off", off=value, axes=axes)
        places.append(context.place_with_cl(row, value, said, cl))
    if places:
        first = min(matching.nc[k] for k, _ in deviations.bad)
        positioned = None if run.state.tcp[first] else context.rotary_positioning_place(first)
        places += [positioned] if positioned is not None else []
    on_arcs = [place for segments in matching.arc_segments for place in _tips_off_arc(context, segments)]
    nominal = Faults()
    missing, most = _depends_on_values(context, nominal)
    count = deviations.count + len(on_arcs) + nominal.count
    places += [*on_arcs, *nominal.places]
    check = _measured("tip", context, deviations, places, count)
    if nominal.count:
        # What was measured is of the run with the length as it is; the fault is that of the longer tool.
        longer = Wording(
            "tip", "longer_off", measured=check.answer, longer=LONGER, off=most * LONGER, rows=nominal.count
        )
        check = replace(check, answer=longer)
    return replace(check, missing=missing)


def _depends_on_values(context: ComparedContext, found: Faults) -> tuple[tuple[Wording, ...], float]:
    """Take the points at which the tip moves with the tool length.

    Returns what points stand on and nobody has stated, and how far the tip moves at most for each millimetre of length.

    Only where positions are those of the linear axes: elsewhere the control knows the length.
    """
    run = context.run
    if run.state.xyz_is_tip.values.all():
        return (), 0.0
    on_length = on_zero = False
    most = 0.0
    for nc, cl in context.matching.pair_chunks():
        rows = with_linear_positions(run, nc)
        if not len(rows):
            continue
        on_length, on_zero = on_length or depends_on_length(run, rows), on_zero or depends_on_zero(run, rows)
        moved = moved_tips(run, rows)
        most = max([most, *(tip.share for tip in moved)])
        points = cl[np.searchsorted(nc, [tip.row for tip in moved])].tolist()
        found.add_rows(
            len(moved),
            (
                context.place_with_cl(tip.row, tip.share, tip.said, point)
                for tip, point in zip(moved, points, strict=True)
            ),
        )
    return (*((phrase("no_zero"),) if on_zero else ()), *((phrase("no_tool_length"),) if on_length else ())), most


def _tips_off_arc(context: ComparedContext, segments: ArcSegments) -> Iterator[Place]:
    """Yield ends of lines that are off the arc that they replace."""
    arc, tolerances = segments.arc, context.expected.section_at(segments.cl).tolerances
    tips = context.run.positions(segments.nc).tip
    off = arc.deviation(tips) if segments.pieces is None else tips - arc.at(segments.pieces)
    away = np.sqrt((off**2).sum(axis=1))
    # A point that is off along the arc is off in height too, because the height is that at its own angle.
    limit = _DIAGONAL * tolerances.tip * math.hypot(1.0, arc.slope)
    for k in np.flatnonzero(away > limit + 1e-6 + min(arc.closure_error, _MAX_CLOSURE_ERROR)).tolist():
        said = Wording("tip", "off_arc", off=away[k])
        yield context.place_with_cl(int(segments.nc[k]), float(away[k]), said, segments.cl)


def check_axis(context: ComparedContext, deviations: DeviationSummary, accepted: AcceptedDeviations) -> Check:
    """Return the tool axis at every CL point, as far as it was not declared to lean."""
    matching = context.matching
    places = []
    for k, value in deviations.bad:
        said = Wording("axis", "off", off=value)
        places.append(context.place_with_cl(matching.nc[k], value, said, matching.cl[k]))
    if places:
        positioned = context.rotary_positioning_place(min(matching.nc[k] for k, _ in deviations.bad))
        places += [positioned] if positioned is not None else []
    faults = [*accepted.axis, *misplaced_lean_positions(context.run, context.expected, matching)]
    named = [context.place_of_cl_row(fault.cl, fault.value, fault.said) for fault in faults[:MAX_PLACES]]
    on_arcs = [place for segments in matching.arc_segments for place in _axes_off_arc(context, segments)]
    count = deviations.count + len(faults) + len(on_arcs)
    check = _measured("axis", context, deviations, [*named, *places, *on_arcs], count)
    lean, rows = accepted.lean
    if not rows:
        return check
    return replace(check, answer=Wording("axis", "leans", measured=check.answer, lean=lean, rows=rows))


def _axes_off_arc(context: ComparedContext, segments: ArcSegments) -> Iterator[Place]:
    """Yield ends of lines that replace an arc under a wrong tool axis."""
    arc, tolerances = segments.arc, context.expected.section_at(segments.cl).tolerances
    begin, end = context.expected.point(segments.cl - 1).axis, context.expected.point(segments.cl).axis
    actual = context.run.positions(segments.nc)
    away = degrees_apart(actual.axis, great_circle_points(begin, end, arc.fractions(actual.tip)))
    total = 2.0 * float(np.arcsin(min(0.5 * float(np.linalg.norm(end - begin)), 1.0)))
    # It is not known better than this where on the arc a rounded point is.
    uncertainty = total * _DIAGONAL * tolerances.tip / max(arc.radius * arc.sweep, 1e-9)
    limit = _DIAGONAL * tolerances.angle + np.degrees(uncertainty) + 1e-6
    for k in np.flatnonzero(away > limit).tolist():
        said = Wording("axis", "off_on_arc", off=away[k])
        yield context.place_with_cl(int(segments.nc[k]), float(away[k]), said, segments.cl)


def _measured(
    key: str, context: ComparedContext, deviations: DeviationSummary, places: list[Place], count: int
) -> Check:
    unit = _UNITS[key]
    if not len(context.matching.nc) and len(context.expected):
        return Check(key, False, Wording("all", "no_block_at_points"), unit=unit)
    largest, limit = deviations.largest, deviations.limit
    answer = Wording(key, "measured", largest=largest, rms=deviations.rms, limit=limit)
    if count:
        first = min(places, key=lambda p: p.nc_line).block_name
        answer = Wording(key, "some_off", measured=answer, count=count, block=first)
    return Check(key, not count, answer, largest, limit, unit, tuple(places))
