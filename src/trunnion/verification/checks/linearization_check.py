"""How far the tool leaves its path between the points: motions, lines and arcs for arcs, and splines."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import fields
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording, phrase
from trunnion.model.columns import StepColumn
from trunnion.model.feed_path import NO_ROTATION
from trunnion.model.run import Orientation, Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.checks.coverage import coverage_of
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, ExpectedValues, Faults
from trunnion.verification.deviations.linearization import LinearizationErrors
from trunnion.verification.deviations.tip_limits import DIVIDED_TO
from trunnion.verification.expected.arcs import circle_of
from trunnion.verification.expected.path import WrittenSpline
from trunnion.verification.expected.splines import dense_points, span_counts
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.kinematics.positioning_moves import rotary_positioning_flags
from trunnion.verification.kinematics.seen_rows import SeenRows
from trunnion.verification.matching.pairs import ArcSegments
from trunnion.verification.results import Check, Place
from trunnion.verification.row_ranges import chunk_bounds

#: What comes of arithmetic only, mm.
_NOISE: Final = 1e-9

#: Fractions of a circle at which it is compared with the arc that it is a piece of.
_WAY: Final = np.linspace(0.125, 0.875, 7)

#: A point whose three coordinates are off by one each is off by this much.
_DIAGONAL: Final = math.sqrt(3.0) + 1e-6

#: Share by which a chord may be higher than its tolerance: arithmetic, and ends of arcs that the CL file rounds.
_SHARE: Final = 1.01

#: What digits of positions come to is told from here on, mm or degrees.
_LEAST_DIGITS: Final = 5e-7

#: What the digits of coefficients come to, mm.
_COEFFICIENTS: Final = 2e-5


@dataclass(frozen=True, slots=True, eq=False)
class SplineFaults:
    """What is wrong with the splines of a program, and how far one leaves that of the CL file at most, mm, before the
    end of which row; 0 and -1 for none.
    """

    places: tuple[Place, ...] = ()
    deviation: float = 0.0
    row: int = -1


def spline_faults(context: ComparedContext) -> SplineFaults:
    """Find splines that leave those of the CL files, or along which something changes."""
    written = context.expected.written_splines
    if not written:
        return SplineFaults()
    events = np.sort(np.array([event.before_row for event in context.run.events], np.int64))
    places: list[Place] = []
    deviation, row = 0.0, -1
    for spline in written:
        off = _deviations(context, spline)
        if float(off.max()) > deviation:
            deviation, row = float(off.max()), spline.last
        places += _too_far(context, spline, off)
        if changed := _change_inside(context.run, spline, events):
            places.append(context.place(spline.last, 0.0, changed))
    return SplineFaults(tuple(places), deviation, row)


def _too_far(context: ComparedContext, written: WrittenSpline, off: Floats) -> Iterator[Place]:
    """Yield the end of the spline of the program that is farthest from that of the CL file, if that is too far."""
    limit = context.expected.sections[written.section].tolerances.tip + _COEFFICIENTS
    worst = float(off.max())
    if not worst <= limit:
        splines, end = context.run.splines, written.begin + written.count
        ends = np.cumsum(span_counts(splines)[written.begin : end])
        own = written.begin + int(np.searchsorted(ends, int(np.argmax(off.max(axis=1))), "right"))
        yield context.place(int(splines.last[own]), worst, Wording("span", "spline_off", off=worst, limit=limit))


def _deviations(context: ComparedContext, written: WrittenSpline) -> Floats:
    """(s, 9): the greatest deviation of a coordinate at points of each span, mm."""
    wanted = context.expected.sections[written.section].operation.splines
    actual = dense_points(context.run.splines, written.begin, written.begin + written.count)
    return np.asarray(np.abs(actual - dense_points(wanted, written.number, written.number + 1)).max(axis=2))


def _change_inside(run: Run, written: WrittenSpline, events: Ints) -> Wording | None:
    """Return what changes between the rows of a spline; None for nothing.

    ``events`` are their rows, sorted.
    """
    first, last = written.first, written.last
    if (run.kind[first : last + 1] != Kind.LINEAR).any():
        return Wording("span", "spline_motion")
    for each in fields(run.state):
        column: StepColumn = getattr(run.state, each.name)
        if _is_one_inside(column.rows, first, last):
            return Wording("span", "spline_state", name=each.name)
    return Wording("span", "spline_command") if _is_one_inside(events, first, last) else None


def _is_one_inside(rows: Ints, first: int, last: int) -> bool:
    """Whether one of sorted rows is behind ``first`` and up to ``last``."""
    return bool(np.searchsorted(rows, first, "right") < np.searchsorted(rows, last, "right"))


def check_between_points(context: Context, motion: AxisMotion, errors: LinearizationErrors) -> Check:
    """Tip and tool axis between the points: at several positions of each motion, or else half-way.

    Where the settings give no limit, the tool axis is judged by that of the control's definition.
    """
    settings = context.settings
    asked = settings.span is not None or settings.span_tip is not None
    axis = errors.axis if settings.span is not None or errors.axis.count else motion.axis_deviation
    in_cuts = not asked and not errors.tip.count and errors.cuts.row >= 0
    tip = errors.cuts if in_cuts else errors.tip if asked or errors.tip.count else motion.tip_deviation
    on_way = axis is errors.axis
    deviation, deviation_row = _largest_deviation(context)
    splines = spline_faults(context) if isinstance(context, ComparedContext) else SplineFaults()
    if splines.deviation > max(deviation, _NOISE):
        deviation, deviation_row = splines.deviation, splines.row
    off_tip, row = (tip.value, tip.row) if tip.value > deviation else (deviation, deviation_row)
    places = []
    if axis.row >= 0:
        rows = axis.rows or [(axis.row, axis.value)]
        variant = "axis_on_way" if on_way else "axis_half_way"
        places += [context.place(r, v, Wording("span", variant, off=v)) for r, v in rows]
    faults = [*arc_chord_faults(context), *splines.places] if isinstance(context, ComparedContext) else []
    if row >= 0 and off_tip > 0.0 and not (faults and row == deviation_row):
        rows = tip.rows or [(row, off_tip)]
        unasked = not asked and errors.tip.count > 0
        for r, v in rows:
            variant = "tip_off" if not unasked else "tip_off_long" if errors.is_long(r) else "tip_off_cut"
            places.append(context.place(r, v, Wording("span", variant, off=v)))
    answer = Wording("span", "on_way" if on_way else "half_way", tip=off_tip, axis=axis.value)
    if axis.row >= 0:
        answer = Wording("span", "in_block", measured=answer, block=context.block_name(axis.row))
    judged = tip.row if not asked and tip is not motion.tip_deviation else -1
    tips = _allowed_tip(settings, errors, judged)
    axes = _allowed_axis(settings, errors, axis.row)
    if limits := (
        *_with_digits(tips, errors.limits.tip_tolerance, "mm"),
        *_with_digits(axes, errors.limits.rounding, "deg"),
    ):
        answer = Wording("span", "allowed", measured=answer, limits=limits)
    if faults:
        answer = Wording("span", "with_faults", measured=answer, fault=Faults(faults, len(faults)).answer())
        places = [*faults[:MAX_PLACES], *places]
    passed = not errors.axis.count + errors.tip.count + len(faults)
    seen = coverage_of(context, _seen(context, rapids=settings.span_tip is not None))
    missing = _missing(context, motion, errors)
    return Check("span", passed, answer, axis.value, settings.span, "deg", tuple(places), missing, seen)


def _missing(context: Context, motion: AxisMotion, errors: LinearizationErrors) -> tuple[Wording, ...]:
    """Return what would say whether the tip may be as far off as it is."""
    if context.settings.span_tip is not None:
        return ()
    if not isinstance(context, ComparedContext):
        return (phrase("no_cl_file"),) if motion.tip_deviation.value > DIVIDED_TO else ()
    return (Wording("span", "no_tolerance", off=errors.unstated.value),) if errors.unstated.count else ()


def _seen(context: Context, *, rapids: bool) -> SeenRows:
    """Return the motions that are judged between their ends; ``rapids``: of rapids those without TCP too."""
    run, seen = context.run, SeenRows()
    for first, end in chunk_bounds(len(run)):
        kind, state = run.kind[first:end], run.state
        here = (kind == Kind.RAPID) & ~(rapids & ~state.tcp.part(first, end))
        on_arc = (kind == Kind.ARC) & (run.orientation_between(first, end) == Orientation.ANGLES)
        on_arc[on_arc] = _turning(run, first + np.flatnonzero(on_arc))
        in_machine = phrase("left_in_machine"), state.machine_frame.part(first, end)
        turns = phrase("left_turns"), rotary_positioning_flags(run, first, end) & ~here
        reasons = (in_machine, (phrase("left_rapid"), here), turns, (phrase("left_turns_on_arc"), on_arc))
        seen.add(first, end - first, reasons)
    return seen


def _turning(run: Run, rows: Ints) -> Flags:
    """Which rows turn a rotary axis, (k,)."""
    start = np.asarray(run.start)[list(run.machine.rotary)]
    before = np.where((rows > 0)[:, None], run.rotary[np.maximum(rows - 1, 0)], start)
    return np.asarray(np.abs(run.rotary[rows] - before).max(axis=1, initial=0.0) > NO_ROTATION)


def _with_digits(limits: Iterable[Wording], digits: float, unit: str) -> Iterator[Wording]:
    """Yield limits with what the digits of positions come to, which is allowed as well."""
    for limit in limits:
        counts = digits >= _LEAST_DIGITS and limit.variant != "no_limit"
        yield Wording("span", "with_digits", limit=limit, digits=digits, unit=unit) if counts else limit


def _allowed_tip(settings: ExpectedValues, errors: LinearizationErrors, row: int) -> Iterator[Wording]:
    """Yield the tolerance of the tip that counts in a row; -1: none is judged."""
    if settings.span_tip is not None:
        yield Wording("span", "limit_tip", limit=settings.span_tip)
    elif row >= 0 and not errors.is_long(row):
        limit, is_stated = errors.limit_at(row)
        yield Wording("span", "limit_tip_stated" if is_stated else "limit_tip_default", limit=limit)


def _allowed_axis(settings: ExpectedValues, errors: LinearizationErrors, row: int) -> Iterator[Wording]:
    """Yield the tolerance of the tool axis that counts in a row; -1: no row turns it, and none counts."""
    if settings.span is not None:
        yield Wording("span", "limit_axis", limit=settings.span)
    elif row >= 0:
        default, allowed = settings.axis_tolerance, errors.allowed_by_default(row)
        if math.isinf(allowed):
            yield Wording("span", "no_limit")
        elif errors.is_divided(row):
            yield Wording("span", "limit_between", limit=allowed)
        elif allowed > max(default.cutting, default.finishing) + _NOISE:
            yield Wording("span", "limit_of_turn", limit=allowed)
        else:
            is_finishing = abs(allowed - default.finishing) < _NOISE and default.finishing != default.cutting
            yield Wording("span", "limit_finishing" if is_finishing else "limit_axis", limit=allowed)


def _largest_deviation(context: Context) -> tuple[float, int]:
    """How far lines and circles that replace an arc leave it at most, mm, and the row; 0 and -1 without any."""
    largest, row = _NOISE, -1
    if isinstance(context, ComparedContext):
        for segments in context.matching.arc_segments:
            nc = segments.nc
            off = chord_heights(context, segments) if segments.pieces is None else _off_helix(context, segments)
            if len(off) and off.max() > largest:
                largest, row = float(off.max()), int(nc[min(int(np.argmax(off)), len(nc) - 1)])
    return (0.0, -1) if row < 0 else (largest, row)


def _off_helix(context: ComparedContext, segments: ArcSegments) -> Floats:
    """How far the pieces of an arc are off it on their way, in their order, (k + 1,) mm."""
    assert segments.pieces is not None
    rows = [*segments.nc.tolist(), context.matching.nc[context.matching.cl.count_before(segments.cl)]]
    ends = [0.0, *segments.pieces.tolist(), 1.0]
    off = []
    for row, begin, end in zip(rows, ends, ends[1:], strict=False):
        away = circle_of(context.run, row).at(_WAY) - segments.arc.at(begin + (end - begin) * _WAY)
        off.append(float(np.linalg.norm(away, axis=1).max()))
    return np.array(off)


def arc_chord_faults(context: ComparedContext) -> Iterator[Place]:
    """Chords that are too high for their arc, and those that go back along it, in the order of the program."""
    for segments in context.matching.arc_segments:
        if segments.pieces is None:
            yield from _faults(context, segments)


def chord_heights(context: ComparedContext, segments: ArcSegments) -> Floats:
    """How far each line that stands for an arc is off it, (k + 1,) mm; the last one goes to its end."""
    return _heights(segments.arc.radius, _turns(context, segments))


def _turns(context: ComparedContext, segments: ArcSegments) -> Floats:
    """How far each line goes round, (k + 1,) radians; less than 0 where it goes back."""
    arc = segments.arc
    fractions = np.concatenate(([0.0], arc.fractions(context.run.positions(segments.nc).tip), [1.0]))
    return np.asarray(np.diff(fractions) * arc.sweep)


def _heights(radius: float, turns: Floats) -> Floats:
    # A line in place of a whole turn, or of several, is off by the diameter.
    return np.asarray(radius * (1.0 - np.cos(np.minimum(0.5 * np.abs(turns), np.pi))))


def _faults(context: ComparedContext, segments: ArcSegments) -> Iterator[Place]:
    arc, tolerances = segments.arc, context.expected.section_at(segments.cl).tolerances
    turns = _turns(context, segments)
    heights = _heights(arc.radius, turns)
    # Both ends of a chord are rounded, and seen from the axis each is off by this angle at most.
    rounding = math.asin(min(1.0, _DIAGONAL * tolerances.tip / max(arc.radius, 1e-9)))
    half = 2.0 * math.asin(math.sqrt(min(1.0, 0.5 * _SHARE * tolerances.chord / max(arc.radius, 1e-9))))
    back = turns < -2.0 * rounding - 1e-9
    limit = half + rounding + 1e-9
    bad = (0.5 * np.abs(turns) > limit) | back
    for k in np.flatnonzero(bad).tolist():
        if back[k]:
            value = 2.0 * arc.radius * math.sin(min(-0.5 * float(turns[k]), 0.5 * math.pi))
            said = Wording("span", "arc_back", off=value)
        else:
            value = float(heights[k])
            said = Wording("span", "arc_off", off=value, limit=float(_heights(arc.radius, np.array(2.0 * limit))))
        yield context.place_with_cl(_row(context, segments, k), value, said, segments.cl)


def _row(context: ComparedContext, segments: ArcSegments, k: int) -> int:
    """Return the row of the k-th line; the last one is paired with the end of the arc."""
    matching = context.matching
    if k < len(segments.nc):
        return int(segments.nc[k])
    if segments.cl in matching.cl:
        return matching.nc[matching.cl.count_before(segments.cl)]
    return int(segments.nc[-1])
