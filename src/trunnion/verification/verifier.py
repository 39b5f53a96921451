"""One program, all checks."""

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from trunnion.arrays import Lines
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.verification.checks import modal_checks as modal
from trunnion.verification.checks import motion_checks as demands
from trunnion.verification.checks import state_checks as in_force
from trunnion.verification.checks.hole_checks import holes
from trunnion.verification.checks.normal_checks import normals
from trunnion.verification.checks.stop_checks import stops
from trunnion.verification.checks.turn_checks import turns
from trunnion.verification.context import MAX_PLACES, Context, Settings
from trunnion.verification.deviations.declared_deviations import (
    AcceptedDeviations,
    accept_deviations,
    misplaced_lean_positions,
)
from trunnion.verification.deviations.point_deviations import DeviationSummary, PointDeviations
from trunnion.verification.expected.arcs import Arc, turned
from trunnion.verification.expected.path import ExpectedPath, Tolerances
from trunnion.verification.kinematics.axis_motion import AxisMotion, AxisMotionAnalyzer, WorstRows
from trunnion.verification.kinematics.rapid_feeds import restore_rapids
from trunnion.verification.matching.intermediate_points import LinearizationErrors
from trunnion.verification.matching.path_matching import Matching, match_by_count, match_by_position
from trunnion.verification.results import Check, OperationRows, Place, Verification

#: Three coordinates off by one each are a point off by this.
_DIAGONAL = math.sqrt(3.0) + 1e-6


def verify(
    run: Run,
    toolpaths: Sequence[Toolpath] = (),
    *,
    tolerances: Tolerances | Sequence[Tolerances] | None = None,
    settings: Settings | None = None,
    columns: bool = True,
) -> Verification:
    """Put every question to a program.

    Parameters
    ----------
    run
        The program as the machine's control ran it.
    toolpaths
        What it was made from, in that order; without, the program is looked at by itself.
    allowed
        How far it may be from its CL points: one for all, or one for each operation that moves.
    settings
        What the CL files do not say.
    columns
        Whether the columns of the result are wanted, as a report needs them. The checks do not: without, programs of
        any length take the memory of the run and a few chunks.

    Raises
    ------
    InputError
        When the toolpaths have no motion.
    """
    settings = settings or Settings()
    run = restore_rapids(run, settings.rapid_feed)
    expected = ExpectedPath(toolpaths, tolerances or Tolerances(), settings.absolute) if toolpaths else None
    walker = AxisMotionAnalyzer(run, MAX_PLACES, math.inf, times=columns)
    if expected is not None:
        context, spans, checks, last = _held_against(Context(run, expected, None, settings), walker)
    else:
        alone = _spans(run, settings)
        _go_by(run, walker, *alone)
        spans = alone[0] if alone else None
        context = Context(run, None, None, settings)
        checks, last = [in_force.offset(context)], _of_itself(context)
    way = walker.result()
    checks += [
        _span(context, way, spans),
        _travel(context, way),
        _speed(context, way),
        _acceleration(context, way),
        *last,
    ]
    cl_line = _cl_lines(context) if columns else np.zeros(0, np.int32)
    operations = tuple(_operations(context))
    return Verification(run.files[0], run.machine, run, tuple(checks), way.seconds, way.tip_feed, cl_line, operations)


def _held_against(
    context: Context, walker: AxisMotionAnalyzer
) -> tuple[Context, LinearizationErrors | None, list[Check], list[Check]]:
    """Checks against what was wanted: the case with its pairs, what was seen between points, checks, the last checks.

    Partners are by counting if that fits, else by position. Where the tool is takes half of the time, and what is asked
    besides is found out meanwhile.
    """
    run, expected = context.run, context.expected
    assert expected is not None
    believed = accept_deviations(expected, run.machine)
    counted = match_by_count(run, expected)
    context = replace(context, matching=counted or _by_position(context))
    with ThreadPoolExecutor(1) as aside:
        asked = aside.submit(_asked_besides, context, believed)
        spans = _spans(run, context.settings, expected, context.matching)
        off = _deviations(context)
        _go_by(run, walker, off, *spans)
    if counted and any(one.count for one in off.result()):
        context = replace(context, matching=_by_position(context))
        spans = _spans(run, context.settings, expected, context.matching)
        off = _deviations(context)
        _go_by(run, off, *spans)
        order, besides, last = _asked_besides(context, believed)
    else:
        order, besides, last = asked.result()
    off_tip, off_axis = off.result()
    checks = [order, _tip(context, off_tip), _axis(context, off_axis, believed), *besides]
    return context, spans[0] if spans else None, checks, last


def _by_position(context: Context) -> Matching:
    """Partners by where they are."""
    assert context.expected is not None
    span = context.settings.span
    bend = span if span is not None or context.settings.span_tip is None else 180.0
    return match_by_position(context.run, context.expected, bend=bend)


def _deviations(context: Context) -> PointDeviations:
    assert context.expected is not None
    assert context.matching is not None
    return PointDeviations(context.run.machine, context.expected, context.matching, MAX_PLACES, context.run.programmed)


def _asked_besides(context: Context, believed: AcceptedDeviations) -> tuple[Check, list[Check], list[Check]]:
    """All that neither asks where the tool is nor how it gets there: the order, demands, and ``_of_itself``."""
    besides = [
        demands.kind(context),
        demands.feed(context, believed),
        in_force.spindle(context),
        in_force.tool(context),
    ]
    besides += [in_force.coolant(context), in_force.compensation(context), stops(context)]
    besides += [in_force.offset(context), in_force.home(context), holes(context)]
    besides += normals(context)
    return demands.order(context), besides, _of_itself(context)


def _of_itself(context: Context) -> list[Check]:
    """What every program must do."""
    return [turns(context), modal.modal(context), modal.words(context)]


def _operations(context: Context) -> Iterator[OperationRows]:
    """Which rows belong to which operation; an operation that no motion answers to has none."""
    if context.expected is None or context.matching is None:
        return
    first, last = 0, len(context.expected.sections) - 1
    for number, section in enumerate(context.expected.sections):
        k = context.matching.cl.before(section.end)
        end = max(first, context.matching.nc[k - 1] + 1) if k else first
        end = len(context.run) if number == last else end
        yield OperationRows(section.operation.name, section.operation.tool.name, section.file, first, end)
        first = end


def _spans(
    run: Run, settings: Settings, expected: ExpectedPath | None = None, matching: Matching | None = None
) -> tuple[LinearizationErrors, ...]:
    """What goes along to judge the way between the points, if anything is to be."""
    if settings.span is None and settings.span_tip is None:
        return ()
    limits = [section.tolerances for section in expected.sections] if expected is not None else [Tolerances()]
    rounded = max(limit.tip for limit in limits)
    tip = math.inf if settings.span_tip is None else settings.span_tip + rounded
    axis = math.inf if settings.span is None else settings.span + 2.0 * max(limit.angle for limit in limits)
    return (LinearizationErrors(run, MAX_PLACES, tip, axis, rounded, expected, matching),)


def _cl_lines(context: Context) -> Lines:
    """Line of the CL file that each row answers to, (n,), 0 where there is none."""
    lines = np.zeros(len(context.run), np.int32)
    if context.expected is not None and context.matching is not None:
        for nc, cl in context.matching.all_pair_chunks():
            lines[nc] = context.expected.line(cl)
        for pieces in context.matching.pieces:
            lines[pieces.nc] = context.expected.point(pieces.cl).line
    return lines


def _go_by(run: Run, *each: AxisMotionAnalyzer | PointDeviations | LinearizationErrors) -> None:
    """Show all rows of a run to whoever looks at them, a chunk at a time, while it is in the processor's cache."""
    for first, end, poses in run.chunks():
        for one in each:
            one.take(first, end, poses)


def _tip(context: Context, off: DeviationSummary) -> Check:
    expected, matching = context.expected, context.matching
    assert expected is not None
    assert matching is not None
    places = []
    for k, value in off.bad:
        row, cl = matching.nc[k], matching.cl[k]
        is_, want = context.run.positions(np.array([row])).tip[0], expected.point(cl).tip
        axes = [
            f"{name}{now:.5f} for {then:.5f}"
            for name, now, then in zip("XYZ", is_, want, strict=True)
            if not abs(now - then) <= off.limit
        ]
        inches = " (the program counts in inches here)" if context.run.state.inches[row] else ""
        places.append(context.place(row, value, f"the tip is {value:.6f} mm off: {', '.join(axes)}{inches}", cl))
    count = off.count
    if places:
        first = min(matching.nc[k] for k, _ in off.bad)
        by = None if context.run.state.tcp[first] else context.rotary_positioning_block(first)
        places += [by] if by is not None else []
    for pieces in matching.pieces:
        section = expected.section_at(pieces.cl)
        away = np.sqrt((pieces.arc.deviation(context.run.positions(pieces.nc).tip) ** 2).sum(axis=1))
        # A point that is off along the way round is off in height too, for it is measured where it stands.
        limit = _DIAGONAL * section.tolerances.tip * math.hypot(1.0, pieces.arc.slope)
        for k in np.flatnonzero(away > limit + 1e-6 + _ragged(pieces.arc)).tolist():
            count += 1
            text = f"the tip is {away[k]:.6f} mm off the arc that the CL file asks for"
            places.append(context.place(int(pieces.nc[k]), float(away[k]), text, pieces.cl))
    return _measured("tip", "tool tip against the CL points", context, off, "mm", places, count)


def _ragged(arc: Arc) -> float:
    """By how much an arc's end is off its circle, or off its start where it is a full one, mm, if that is rounding."""
    return min(arc.open, 1e-3)


def _axis(context: Context, off: DeviationSummary, believed: AcceptedDeviations) -> Check:
    matching = context.matching
    assert matching is not None
    assert context.expected is not None
    places = []
    for k, value in off.bad:
        text = f"the tool axis is off, a rotary axis by {value:.6f} degrees"
        places.append(context.place(matching.nc[k], value, text, matching.cl[k]))
    count = off.count
    if places:
        by = context.rotary_positioning_block(min(matching.nc[k] for k, _ in off.bad))
        places += [by] if by is not None else []
    broken = [*believed.axis, *misplaced_lean_positions(context.run, context.expected, matching)]
    places = [*(context.place_at_cl(one.cl, one.value, one.text) for one in broken[:MAX_PLACES]), *places]
    count += len(broken)
    for pieces in matching.pieces:
        arc, section = pieces.arc, context.expected.section_at(pieces.cl)
        begin, end = context.expected.point(pieces.cl - 1).axis, context.expected.point(pieces.cl).axis
        is_ = context.run.positions(pieces.nc)
        fraction = arc.fractions(is_.tip)
        total = 2.0 * float(np.arcsin(min(0.5 * float(np.linalg.norm(end - begin)), 1.0)))
        away = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(is_.axis - turned(begin, end, fraction), axis=1), 1.0))
        # Where on the arc a rounded point is, is known no better than this.
        unsure = total * _DIAGONAL * section.tolerances.tip / max(arc.radius * arc.sweep, 1e-9)
        limit = _DIAGONAL * section.tolerances.angle + np.degrees(unsure) + 1e-6
        for k in np.flatnonzero(np.degrees(away) > limit).tolist():
            count += 1
            value = float(np.degrees(away[k]))
            text = f"the tool axis is off by {value:.6f} degrees on its way round an arc"
            places.append(context.place(int(pieces.nc[k]), value, text, pieces.cl))
    check = _measured("axis", "tool axis against the CL points", context, off, "deg", places, count)
    lean, rows = believed.lean
    return replace(check, summary=f"{check.summary}; leans by up to {lean:.6f} at {rows} rows") if rows else check


def _measured(
    key: str, title: str, context: Context, off: DeviationSummary, unit: str, places: list[Place], count: int
) -> Check:
    assert context.matching is not None
    if not len(context.matching.nc) and context.expected is not None and len(context.expected):
        return Check(key, title, False, "no block answers to any CL point", unit=unit)
    each, whole = ("X, Y or Z", "distance") if unit == "mm" else ("a rotary axis", "angle")
    summary = f"largest {off.largest:.6f} {unit} in {each}, rms {whole} {off.rms:.6f}, allowed {off.limit:.6f}"
    if count:
        summary += f", {count} points off, first in {_block(min(places, key=lambda p: p.nc_line))}"
    passed = not count
    return Check(key, title, passed, summary, off.largest, off.limit, unit, tuple(places))


def _block(place: Place) -> str:
    return f"N{place.number}" if place.number >= 0 else f"line {place.nc_line}"


def _span(context: Context, way: AxisMotion, spans: LinearizationErrors | None) -> Check:
    """How far the tool is off between the points."""
    title = "tool between the points"
    axis, tip = (way.axis_deviation, way.tip_deviation) if spans is None else (spans.axis, spans.tip)
    where = "half-way" if spans is None else "on the way"
    chord, row_of_chord = 0.0, -1
    if context.matching is not None:
        for pieces in context.matching.pieces:
            tips = context.run.positions(pieces.nc).tip
            fraction = np.diff(np.concatenate(([0.0], pieces.arc.fractions(tips), [1.0])))
            sag = pieces.arc.radius * (1.0 - np.cos(0.5 * np.abs(fraction) * pieces.arc.sweep))
            if len(sag) and sag.max() > chord:
                chord, row_of_chord = float(sag.max()), int(pieces.nc[min(int(np.argmax(sag)), len(pieces.nc) - 1)])
    off_tip, row = (tip.value, tip.row) if tip.value > chord else (chord, row_of_chord)
    places = []
    if axis.row >= 0:
        rows = axis.rows or [(axis.row, axis.value)]
        places += [
            context.place(r, v, f"{where} the tool axis is {v:.5f} degrees off the great circle") for r, v in rows
        ]
    if row >= 0 and off_tip > 0.0:
        rows = tip.rows or [(row, off_tip)]
        places += [context.place(r, v, f"between its ends the tip is {v:.5f} mm off") for r, v in rows]
    summary = f"tip {off_tip:.6f} mm, axis {axis.value:.5f} deg off {where}"
    if axis.row >= 0:
        summary += f", in {context.block(axis.row)}"
    asked = [f"{limit:g} {unit}" for limit, unit in _span_limits(context) if limit is not None]
    summary += f", allowed {' and '.join(asked)}" if asked else ""
    return Check(
        "span", title, not axis.count + tip.count, summary, axis.value, context.settings.span, "deg", tuple(places)
    )


def _span_limits(context: Context) -> tuple[tuple[float | None, str], ...]:
    return (context.settings.span_tip, "mm"), (context.settings.span, "deg")


def _travel(context: Context, way: AxisMotion) -> Check:
    """Every axis inside its limits, and the least room that is left."""
    machine = context.run.machine
    title = "travel of the axes"
    told: list[tuple[float, str, float, int, int]] = []
    for k, axis in enumerate(machine.axes):
        low, high = way.extremes[k].tolist()
        if low > high or axis.endless or not (math.isfinite(axis.low) or math.isfinite(axis.high)):
            continue
        unit = "deg" if axis.is_rotary else "mm"
        if not axis.is_rotary and machine.workpiece_zero is None:
            room = (axis.high - axis.low) - (high - low)
            text = f"{axis.name} needs {high - low:.3f} of {axis.high - axis.low:g} mm"
            told.append((room, text, high - low, int(way.places[k, 1]), k))
            continue
        below, above = low - axis.low, axis.high - high
        end = 0 if below < above else 1
        value, limit = (low, axis.low) if end == 0 else (high, axis.high)
        text = f"{axis.name} goes to {value:.3f}, its limit is {limit:g} {unit}"
        told.append((min(below, above), text, value, int(way.places[k, end]), k))
    if not told:
        return Check("travel", title, True, "no limits are stated")
    told.sort(key=lambda t: t[0] / max(machine.axes[t[4]].high - machine.axes[t[4]].low, 1e-9))
    over = [t for t in told if t[0] < -1e-5]
    places = tuple(
        context.place(row, value, f"{text}, {-room:.3f} too far" if room < 0 else f"{text}, {room:.3f} left")
        for room, text, value, row, _ in (over or told)
    )
    room, text, value, _, k = told[0]
    unit = "deg" if machine.axes[k].is_rotary else "mm"
    summary = f"{text}, {abs(room):.3f} {'too far' if over else 'left'}"
    return Check("travel", title, not over, summary, room, 0.0, unit, places)


def _speed(context: Context, way: AxisMotion) -> Check:
    return _asked(context, way.speed, "speed", "speed of the axes at the programmed feed", "rapid speed")


def _acceleration(context: Context, way: AxisMotion) -> Check:
    return _asked(context, way.acceleration, "acceleration", "acceleration of the axes between blocks", "acceleration")


def _asked(context: Context, worsts: Sequence[WorstRows], key: str, title: str, of: str) -> Check:
    """Shares of what the axes can do; more than all of it is told, for the control slows down there."""
    machine = context.run.machine
    stated = [axis.rapid if key == "speed" else axis.acceleration for axis in machine.axes]
    if not any(stated):
        return Check(key, title, True, f"the machine's definition states no {of}")
    places = [
        context.place(row, share, f"{axis.name} would need {100.0 * share:.0f} % of its {of}: the control slows down")
        for axis, worst in zip(machine.axes, worsts, strict=True)
        for row, share in worst.rows
    ]
    places.sort(key=lambda place: -place.value)
    top = max(range(5), key=lambda k: worsts[k].value)
    worst = worsts[top]
    if worst.row < 0:
        return Check(key, title, True, "no axis moves at feed", 0.0, 1.0, "of all")
    count = sum(w.count for w in worsts)
    summary = f"{machine.axes[top].name} at most {100.0 * worst.value:.0f} % of its {of}, in {context.block(worst.row)}"
    if count:
        summary += f"; in {count} places the control slows down"
    return Check(key, title, True, summary, worst.value, 1.0, "of all", tuple(places[:MAX_PLACES]))
