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
from trunnion.verification.checks.rotary_turns import turns
from trunnion.verification.checks.stop_checks import stops
from trunnion.verification.context import NAMED, Case, Settings
from trunnion.verification.kinematics.axis_motion import Walk, Walker, Worst
from trunnion.verification.kinematics.point_deviations import Deviations, Off
from trunnion.verification.kinematics.rapid_feeds import with_rapids
from trunnion.verification.matching.declared_deviations import Believed, believe, broken_poses
from trunnion.verification.matching.expected_arcs import Arc, turned
from trunnion.verification.matching.expected_path import Allowed, Wanted
from trunnion.verification.matching.intermediate_points import Spans
from trunnion.verification.matching.path_matching import Pairs, in_order, matched
from trunnion.verification.results import Check, Place, Share, Verification

#: Three coordinates off by one each are a point off by this.
_DIAGONAL = math.sqrt(3.0) + 1e-6


def verify(
    run: Run,
    toolpaths: Sequence[Toolpath] = (),
    *,
    allowed: Allowed | Sequence[Allowed] | None = None,
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
    run = with_rapids(run, settings.rapid_feed)
    wanted = Wanted(toolpaths, allowed or Allowed(), settings.absolute) if toolpaths else None
    walker = Walker(run, NAMED, math.inf, times=columns)
    if wanted is not None:
        case, spans, checks, last = _held_against(Case(run, wanted, None, settings), walker)
    else:
        alone = _spans(run, settings)
        _go_by(run, walker, *alone)
        spans = alone[0] if alone else None
        case = Case(run, None, None, settings)
        checks, last = [in_force.offset(case)], _of_itself(case)
    way = walker.walked()
    checks += [_span(case, way, spans), _travel(case, way), _speed(case, way), _acceleration(case, way), *last]
    cl_line = _cl_lines(case) if columns else np.zeros(0, np.int32)
    operations = tuple(_operations(case))
    return Verification(run.files[0], run.machine, run, tuple(checks), way.seconds, way.tip_feed, cl_line, operations)


def _held_against(case: Case, walker: Walker) -> tuple[Case, Spans | None, list[Check], list[Check]]:
    """Checks against what was wanted: the case with its pairs, what was seen between points, checks, the last checks.

    Partners are by counting if that fits, else by position. Where the tool is takes half of the time, and what is asked
    besides is found out meanwhile.
    """
    run, wanted = case.run, case.wanted
    assert wanted is not None
    believed = believe(wanted, run.machine)
    counted = in_order(run, wanted)
    case = replace(case, pairs=counted or _by_position(case))
    with ThreadPoolExecutor(1) as aside:
        asked = aside.submit(_asked_besides, case, believed)
        spans = _spans(run, case.settings, wanted, case.pairs)
        off = _deviations(case)
        _go_by(run, walker, off, *spans)
    if counted and any(one.count for one in off.found()):
        case = replace(case, pairs=_by_position(case))
        spans = _spans(run, case.settings, wanted, case.pairs)
        off = _deviations(case)
        _go_by(run, off, *spans)
        order, besides, last = _asked_besides(case, believed)
    else:
        order, besides, last = asked.result()
    off_tip, off_axis = off.found()
    checks = [order, _tip(case, off_tip), _axis(case, off_axis, believed), *besides]
    return case, spans[0] if spans else None, checks, last


def _by_position(case: Case) -> Pairs:
    """Partners by where they are."""
    assert case.wanted is not None
    span = case.settings.span
    bend = span if span is not None or case.settings.span_tip is None else 180.0
    return matched(case.run, case.wanted, bend=bend)


def _deviations(case: Case) -> Deviations:
    assert case.wanted is not None
    assert case.pairs is not None
    return Deviations(case.run.machine, case.wanted, case.pairs, NAMED, case.run.programmed)


def _asked_besides(case: Case, believed: Believed) -> tuple[Check, list[Check], list[Check]]:
    """All that neither asks where the tool is nor how it gets there: the order, demands, and ``_of_itself``."""
    besides = [demands.kind(case), demands.feed(case, believed), in_force.spindle(case), in_force.tool(case)]
    besides += [in_force.coolant(case), in_force.compensation(case), stops(case)]
    besides += [in_force.offset(case), in_force.home(case), holes(case)]
    besides += normals(case)
    return demands.order(case), besides, _of_itself(case)


def _of_itself(case: Case) -> list[Check]:
    """What every program must do."""
    return [turns(case), modal.modal(case), modal.words(case)]


def _operations(case: Case) -> Iterator[Share]:
    """Which rows belong to which operation; an operation that no motion answers to has none."""
    if case.wanted is None or case.pairs is None:
        return
    first, last = 0, len(case.wanted.parts) - 1
    for number, part in enumerate(case.wanted.parts):
        k = case.pairs.cl.before(part.end)
        end = max(first, case.pairs.nc[k - 1] + 1) if k else first
        end = len(case.run) if number == last else end
        yield Share(part.operation.name, part.operation.tool.name, part.file, first, end)
        first = end


def _spans(run: Run, settings: Settings, wanted: Wanted | None = None, pairs: Pairs | None = None) -> tuple[Spans, ...]:
    """What goes along to judge the way between the points, if anything is to be."""
    if settings.span is None and settings.span_tip is None:
        return ()
    limits = [part.allowed for part in wanted.parts] if wanted is not None else [Allowed()]
    rounded = max(limit.tip for limit in limits)
    tip = math.inf if settings.span_tip is None else settings.span_tip + rounded
    axis = math.inf if settings.span is None else settings.span + 2.0 * max(limit.angle for limit in limits)
    return (Spans(run, NAMED, tip, axis, rounded, wanted, pairs),)


def _cl_lines(case: Case) -> Lines:
    """Line of the CL file that each row answers to, (n,), 0 where there is none."""
    lines = np.zeros(len(case.run), np.int32)
    if case.wanted is not None and case.pairs is not None:
        for nc, cl in case.pairs.all_chunks():
            lines[nc] = case.wanted.line(cl)
        for pieces in case.pairs.pieces:
            lines[pieces.nc] = case.wanted.point(pieces.cl).line
    return lines


def _go_by(run: Run, *each: Walker | Deviations | Spans) -> None:
    """Show all rows of a run to whoever looks at them, a chunk at a time, while it is in the processor's cache."""
    for first, end, poses in run.stretches():
        for one in each:
            one.take(first, end, poses)


def _tip(case: Case, off: Off) -> Check:
    wanted, pairs = case.wanted, case.pairs
    assert wanted is not None
    assert pairs is not None
    places = []
    for k, value in off.bad:
        row, cl = pairs.nc[k], pairs.cl[k]
        is_, want = case.run.poses(np.array([row])).tip[0], wanted.point(cl).tip
        axes = [
            f"{name}{now:.5f} for {then:.5f}"
            for name, now, then in zip("XYZ", is_, want, strict=True)
            if not abs(now - then) <= off.limit
        ]
        inches = " (the program counts in inches here)" if case.run.state.inches[row] else ""
        places.append(case.place(row, value, f"the tip is {value:.6f} mm off: {', '.join(axes)}{inches}", cl))
    count = off.count
    if places:
        first = min(pairs.nc[k] for k, _ in off.bad)
        by = None if case.run.state.tcp[first] else case.turned_by(first)
        places += [by] if by is not None else []
    for pieces in pairs.pieces:
        part = wanted.part_of(pieces.cl)
        away = np.sqrt((pieces.arc.deviation(case.run.poses(pieces.nc).tip) ** 2).sum(axis=1))
        # A point that is off along the way round is off in height too, for it is measured where it stands.
        limit = _DIAGONAL * part.allowed.tip * math.hypot(1.0, pieces.arc.slope)
        for k in np.flatnonzero(away > limit + 1e-6 + _ragged(pieces.arc)).tolist():
            count += 1
            text = f"the tip is {away[k]:.6f} mm off the arc that the CL file asks for"
            places.append(case.place(int(pieces.nc[k]), float(away[k]), text, pieces.cl))
    return _measured("tip", "tool tip against the CL points", case, off, "mm", places, count)


def _ragged(arc: Arc) -> float:
    """By how much an arc's end is off its circle, or off its start where it is a full one, mm, if that is rounding."""
    return min(arc.open, 1e-3)


def _axis(case: Case, off: Off, believed: Believed) -> Check:
    pairs = case.pairs
    assert pairs is not None
    assert case.wanted is not None
    places = []
    for k, value in off.bad:
        text = f"the tool axis is off, a rotary axis by {value:.6f} degrees"
        places.append(case.place(pairs.nc[k], value, text, pairs.cl[k]))
    count = off.count
    if places:
        by = case.turned_by(min(pairs.nc[k] for k, _ in off.bad))
        places += [by] if by is not None else []
    broken = [*believed.axis, *broken_poses(case.run, case.wanted, pairs)]
    places = [*(case.answering(one.cl, one.value, one.text) for one in broken[:NAMED]), *places]
    count += len(broken)
    for pieces in pairs.pieces:
        arc, part = pieces.arc, case.wanted.part_of(pieces.cl)
        begin, end = case.wanted.point(pieces.cl - 1).axis, case.wanted.point(pieces.cl).axis
        is_ = case.run.poses(pieces.nc)
        fraction = arc.fractions(is_.tip)
        total = 2.0 * float(np.arcsin(min(0.5 * float(np.linalg.norm(end - begin)), 1.0)))
        away = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(is_.axis - turned(begin, end, fraction), axis=1), 1.0))
        # Where on the arc a rounded point is, is known no better than this.
        unsure = total * _DIAGONAL * part.allowed.tip / max(arc.radius * arc.sweep, 1e-9)
        limit = _DIAGONAL * part.allowed.angle + np.degrees(unsure) + 1e-6
        for k in np.flatnonzero(np.degrees(away) > limit).tolist():
            count += 1
            value = float(np.degrees(away[k]))
            text = f"the tool axis is off by {value:.6f} degrees on its way round an arc"
            places.append(case.place(int(pieces.nc[k]), value, text, pieces.cl))
    check = _measured("axis", "tool axis against the CL points", case, off, "deg", places, count)
    lean, rows = believed.lean
    return replace(check, summary=f"{check.summary}; leans by up to {lean:.6f} at {rows} rows") if rows else check


def _measured(key: str, title: str, case: Case, off: Off, unit: str, places: list[Place], count: int) -> Check:
    assert case.pairs is not None
    if not len(case.pairs.nc) and case.wanted is not None and len(case.wanted):
        return Check(key, title, False, "no block answers to any CL point", unit=unit)
    each, whole = ("X, Y or Z", "distance") if unit == "mm" else ("a rotary axis", "angle")
    summary = f"largest {off.largest:.6f} {unit} in {each}, rms {whole} {off.rms:.6f}, allowed {off.limit:.6f}"
    if count:
        summary += f", {count} points off, first in {_block(min(places, key=lambda p: p.nc_line))}"
    passed = not count
    return Check(key, title, passed, summary, off.largest, off.limit, unit, tuple(places))


def _block(place: Place) -> str:
    return f"N{place.number}" if place.number >= 0 else f"line {place.nc_line}"


def _span(case: Case, way: Walk, spans: Spans | None) -> Check:
    """How far the tool is off between the points."""
    title = "tool between the points"
    axis, tip = (way.bend_axis, way.bend_tip) if spans is None else (spans.axis, spans.tip)
    where = "half-way" if spans is None else "on the way"
    chord, row_of_chord = 0.0, -1
    if case.pairs is not None:
        for pieces in case.pairs.pieces:
            tips = case.run.poses(pieces.nc).tip
            fraction = np.diff(np.concatenate(([0.0], pieces.arc.fractions(tips), [1.0])))
            sag = pieces.arc.radius * (1.0 - np.cos(0.5 * np.abs(fraction) * pieces.arc.sweep))
            if len(sag) and sag.max() > chord:
                chord, row_of_chord = float(sag.max()), int(pieces.nc[min(int(np.argmax(sag)), len(pieces.nc) - 1)])
    off_tip, row = (tip.value, tip.row) if tip.value > chord else (chord, row_of_chord)
    places = []
    if axis.row >= 0:
        rows = axis.rows or [(axis.row, axis.value)]
        places += [case.place(r, v, f"{where} the tool axis is {v:.5f} degrees off the great circle") for r, v in rows]
    if row >= 0 and off_tip > 0.0:
        rows = tip.rows or [(row, off_tip)]
        places += [case.place(r, v, f"between its ends the tip is {v:.5f} mm off") for r, v in rows]
    summary = f"tip {off_tip:.6f} mm, axis {axis.value:.5f} deg off {where}"
    if axis.row >= 0:
        summary += f", in {case.block(axis.row)}"
    asked = [f"{limit:g} {unit}" for limit, unit in _span_limits(case) if limit is not None]
    summary += f", allowed {' and '.join(asked)}" if asked else ""
    return Check(
        "span", title, not axis.count + tip.count, summary, axis.value, case.settings.span, "deg", tuple(places)
    )


def _span_limits(case: Case) -> tuple[tuple[float | None, str], ...]:
    return (case.settings.span_tip, "mm"), (case.settings.span, "deg")


def _travel(case: Case, way: Walk) -> Check:
    """Every axis inside its limits, and the least room that is left."""
    machine = case.run.machine
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
        case.place(row, value, f"{text}, {-room:.3f} too far" if room < 0 else f"{text}, {room:.3f} left")
        for room, text, value, row, _ in (over or told)
    )
    room, text, value, _, k = told[0]
    unit = "deg" if machine.axes[k].is_rotary else "mm"
    summary = f"{text}, {abs(room):.3f} {'too far' if over else 'left'}"
    return Check("travel", title, not over, summary, room, 0.0, unit, places)


def _speed(case: Case, way: Walk) -> Check:
    return _asked(case, way.speed, "speed", "speed of the axes at the programmed feed", "rapid speed")


def _acceleration(case: Case, way: Walk) -> Check:
    return _asked(case, way.acceleration, "acceleration", "acceleration of the axes between blocks", "acceleration")


def _asked(case: Case, worsts: Sequence[Worst], key: str, title: str, of: str) -> Check:
    """Shares of what the axes can do; more than all of it is told, for the control slows down there."""
    machine = case.run.machine
    stated = [axis.rapid if key == "speed" else axis.acceleration for axis in machine.axes]
    if not any(stated):
        return Check(key, title, True, f"the machine's definition states no {of}")
    places = [
        case.place(row, share, f"{axis.name} would need {100.0 * share:.0f} % of its {of}: the control slows down")
        for axis, worst in zip(machine.axes, worsts, strict=True)
        for row, share in worst.rows
    ]
    places.sort(key=lambda place: -place.value)
    top = max(range(5), key=lambda k: worsts[k].value)
    worst = worsts[top]
    if worst.row < 0:
        return Check(key, title, True, "no axis moves at feed", 0.0, 1.0, "of all")
    count = sum(w.count for w in worsts)
    summary = f"{machine.axes[top].name} at most {100.0 * worst.value:.0f} % of its {of}, in {case.block(worst.row)}"
    if count:
        summary += f"; in {count} places the control slows down"
    return Check(key, title, True, summary, worst.value, 1.0, "of all", tuple(places[:NAMED]))
