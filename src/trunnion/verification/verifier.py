"""One program, all checks."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from trunnion.arrays import Flags, Floats, Lines
from trunnion.compensation.centre_runs import CentreRun
from trunnion.model.recording import Recording
from trunnion.model.run import Run
from trunnion.model.tool_additions import with_added_lengths
from trunnion.model.toolpath import Operation, Toolpath
from trunnion.verification.checks.driven_path import driven_path
from trunnion.verification.checks.skip_faults import lost_skips, stretch_levels
from trunnion.verification.checks.table import Compared, Measured, all_checks
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, ExpectedValues
from trunnion.verification.deviations.declared_deviations import accept_deviations
from trunnion.verification.deviations.linearization import LinearizationErrors, SpanLimits
from trunnion.verification.deviations.point_deviations import PointDeviations
from trunnion.verification.deviations.reached_rows import with_feeds_of_program, worthwhile_feeds
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.expected.tolerances import Tolerances
from trunnion.verification.kinematics.axis_motion import AxisMotion, AxisMotionAnalyzer
from trunnion.verification.kinematics.positioning_moves import oriented_by_vector
from trunnion.verification.kinematics.rapid_feeds import restore_rapids
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.matching.pairs import Matching
from trunnion.verification.matching.path_matching import match_by_count, match_by_position
from trunnion.verification.matching.spline_matching import written_splines
from trunnion.verification.results import OperationRows, Verification


def verify(
    run: Run,
    toolpaths: Sequence[Toolpath] = (),
    *,
    tolerances: Tolerances | Sequence[Tolerances] | Callable[[Operation], Tolerances] | None = None,
    settings: ExpectedValues | None = None,
    columns: bool = True,
) -> Verification:
    """Make all checks of a program.

    run         the program as the machine's control ran it
    toolpaths   the CL files that it was made from, in that order; without them, the program is checked by itself
    tolerances  how far it may be from its CL points: for all operations, one for each operation that moves, or a
                function of the operation, in the program's frame
    settings    what the CL files leave open
    columns     whether the result has its columns, as a report needs them. The checks do not: without columns, a
                program of any length takes the memory of the run and a few chunks

    Raises ``InputError`` when the toolpaths have no motion.
    """
    settings = settings or ExpectedValues()
    run = restore_rapids(run, settings.rapid_feed)
    analyzer = AxisMotionAnalyzer(run, MAX_PLACES, times=columns)
    if toolpaths:
        seen: Measured = _compare_all(_expected_path(run, toolpaths, tolerances, settings), run, settings, analyzer)
    else:
        seen = _measure_alone(run, settings, analyzer)
    centre = driven_path(seen.context).centre
    seen = replace(seen, motion=_as_the_tool_goes(centre, run, seen.motion))
    context, motion = seen.context, seen.motion
    cl_line = _cl_lines(context) if columns else np.zeros(0, np.int32)
    operations = tuple(_operation_rows(context))
    levels = stretch_levels(context) if isinstance(context, ComparedContext) else ()
    lost = lost_skips(context, levels) if isinstance(context, ComparedContext) else {}
    assumes_unit = isinstance(context, ComparedContext) and context.expected.assumes_unit
    return Verification(
        run.files[0], run.machine, run, all_checks(seen), motion.seconds, motion.tip_feed, cl_line, operations,
        waiting=motion.waiting, skip_levels=levels, lost_skips=lost, driven=None if centre.run is run else centre,
        assumes_unit=assumes_unit,
    )  # fmt: skip


def reachable_feeds(
    run: Run, toolpaths: Sequence[Toolpath], tolerances: Sequence[Tolerances], settings: ExpectedValues
) -> list[tuple[Floats, Flags]]:
    """Return the feeds that the axes reach on the way to the points of each operation that moves, (n,) mm/min, (n,)
    bool each.

    NaN where that is no question (rapids, holes, feeds per revolution) or not known. True where the feed of the CL file
    is kept, as lower ones would take far longer. Parameters as for ``verify``; the program has the greatest feeds.
    """
    run = restore_rapids(run, settings.rapid_feed)
    original = _expected_path(run, toolpaths, tolerances, settings)
    compared, _, _ = _compare(accept_deviations(original, run.machine).expected, run, settings)
    found, keeps = worthwhile_feeds(run, original, compared.matching, settings.feed_limit)
    feeds = []
    operations = (operation for path in toolpaths for operation in path.operations if len(operation.moves))
    for section, operation in zip(original.sections, operations, strict=True):
        feed, kept = np.full(len(operation.moves), np.nan), np.zeros(len(operation.moves), np.bool_)
        rows = slice(None) if section.kept is None else section.kept
        feed[rows], kept[rows] = found.feed[section.first : section.end], keeps[section.first : section.end]
        feeds.append((feed, kept))
    return feeds


def _expected_path(
    run: Run,
    toolpaths: Sequence[Toolpath],
    tolerances: Tolerances | Sequence[Tolerances] | Callable[[Operation], Tolerances] | None,
    settings: ExpectedValues,
) -> ExpectedPath:
    """Return the path that the CL files ask for, with the splines that the program writes."""
    path = partial(
        ExpectedPath, toolpaths, tolerances or Tolerances(), settings.absolute, settings.for_operation,
        left_out=settings.left_out,
    )  # fmt: skip
    expected = path()
    written = written_splines(run, expected)
    return path(written) if written else expected


def with_recording(verification: Verification, recording: Recording, tolerance: float) -> Verification:
    """Return a verification with the check of a recording of the machine.

    verification  of the program
    recording     what the machine showed
    tolerance     how far its positions may be off the path, mm and degrees

    Raises ``InputError`` if the recording has not all axes of the machine.
    """
    from trunnion.verification.recorded import (  # most verifications have none
        by_program_rows,
        check_recorded,
        compare_recording,
    )

    driven = verification.driven
    compared = compare_recording(verification.run if driven is None else driven.run, recording, tolerance)
    if driven is not None:
        compared = by_program_rows(compared, driven)
    check = check_recorded(Context(verification.run, ExpectedValues()), compared)
    return replace(verification, checks=(*verification.checks, check), recorded=compared)


def _as_the_tool_goes(centre: CentreRun, run: Run, motion: AxisMotion) -> AxisMotion:
    """Return the motion with the extremes of the axes as the tool really goes: where the program makes it longer, and
    where the control compensates its radius.
    """
    real = with_added_lengths(centre.run)
    if real is run:
        return motion
    analyzer = AxisMotionAnalyzer(real, 0, times=False)
    for first, end, positions in real.chunks():
        analyzer.add(first, end, positions)
    found = analyzer.result()
    # What is inserted before a row belongs to it.
    rows = np.searchsorted(centre.row_of, found.extreme_rows)
    return replace(
        motion, extremes=found.extremes, extreme_rows=np.where(found.extreme_rows < 0, -1, rows),
        within_lines=found.within_lines, unknown=found.unknown if len(real) == len(run) else motion.unknown,
    )  # fmt: skip


def _measure_alone(run: Run, settings: ExpectedValues, analyzer: AxisMotionAnalyzer) -> Measured:
    """Return what is known of a program without CL files."""
    context = Context(run, settings)
    errors = _linearization_errors(context, [Tolerances()])
    _add_rows(run, analyzer, errors)
    return Measured(context, errors, analyzer.result())


def _compare_all(original: ExpectedPath, run: Run, settings: ExpectedValues, analyzer: AxisMotionAnalyzer) -> Compared:
    """Return what is known of a program beside its expected path, which has the feeds and tool axes of the CL files."""
    if settings.fastest_feed and settings.feeds_as_programmed:
        compared, _, _ = _compare(original, run, settings)
        original = with_feeds_of_program(run, original, compared.matching, settings.feed_limit)
    accepted = accept_deviations(original, run.machine)
    context, errors, deviations = _compare(accepted.expected, run, settings, analyzer)
    tip, axis = deviations.result()
    return Compared(context, errors, analyzer.result(), original, accepted, tip, axis)


def _compare(
    expected: ExpectedPath, run: Run, settings: ExpectedValues, analyzer: AxisMotionAnalyzer | None = None
) -> tuple[ComparedContext, LinearizationErrors, PointDeviations]:
    """Match motions and points, by count if that fits, else by position, and measure how far they are apart."""
    counted = match_by_count(run, expected)
    context = ComparedContext(run, settings, expected, counted or _match_by_position(expected, run, settings))
    errors, deviations = _measure(context, analyzer)
    if counted and any(summary.count for summary in deviations.result()):
        context = ComparedContext(run, settings, expected, _match_by_position(expected, run, settings))
        errors, deviations = _measure(context)
    return context, errors, deviations


def _match_by_position(expected: ExpectedPath, run: Run, settings: ExpectedValues) -> Matching:
    """With intermediate points within the limits for the tool between points.

    By default only where rotary axes turn so far that the tool axis may need them.
    """
    if settings.span is None and settings.span_tip is None:
        tolerance = settings.axis_tolerance
        least = math.degrees(2.0 * math.sqrt(math.radians(0.5 * min(tolerance.cutting, tolerance.finishing))))
        return match_by_position(run, expected, axis_deviation=tolerance.cutting, least_turn=least)
    return match_by_position(run, expected, axis_deviation=180.0 if settings.span is None else settings.span)


def _measure(
    context: ComparedContext, analyzer: AxisMotionAnalyzer | None = None
) -> tuple[LinearizationErrors, PointDeviations]:
    """Errors between points and deviations at points; the analyzer gets the same rows."""
    run, sections = context.run, context.expected.sections
    errors = _linearization_errors(context, [section.tolerances for section in sections])
    deviations = PointDeviations(run.machine, context.expected, context.matching, MAX_PLACES, oriented_by_vector(run))
    _add_rows(run, analyzer, deviations, errors)
    return errors, deviations


def _linearization_errors(context: Context, tolerances: Sequence[Tolerances]) -> LinearizationErrors:
    """Return the collector of errors between points."""
    settings = context.settings
    limits = SpanLimits(
        tip=math.inf if settings.span_tip is None else settings.span_tip,
        axis=math.inf if settings.span is None else settings.span,
        tip_tolerance=max(each.tip for each in tolerances),
        rounding=2.0 * max(each.angle for each in tolerances),
        by_default=settings.axis_tolerance if settings.span is None else None,
    )
    path = (context.expected, context.matching) if isinstance(context, ComparedContext) else (None, None)
    return LinearizationErrors(context.run, MAX_PLACES, limits, *path)


def _add_rows(run: Run, *collectors: AxisMotionAnalyzer | PointDeviations | LinearizationErrors | None) -> None:
    """Give all rows of a run to each collector, chunk by chunk, while a chunk is in the processor's cache."""
    for first, end, positions in run.chunks():
        for collector in collectors:
            if collector is not None:
                collector.add(first, end, positions)


def _cl_lines(context: Context) -> Lines:
    """Line of the CL file that each row belongs to, (n,), 0 for none."""
    lines = np.zeros(len(context.run), np.int32)
    if isinstance(context, ComparedContext):
        for nc, cl in context.matching.all_pair_chunks():
            lines[nc] = context.expected.line(cl)
        for segments in context.matching.arc_segments:
            lines[segments.nc] = context.expected.point(segments.cl).line
        for spline in context.expected.written_splines:
            lines[spline.first : spline.last] = lines[spline.last]
    return lines


def _operation_rows(context: Context) -> Iterator[OperationRows]:
    """Which rows belong to which operation; an operation without a motion has none."""
    if not isinstance(context, ComparedContext):
        return
    matching, sections = context.matching, context.expected.sections
    holes = match_holes(context.run, context.expected) if context.expected.holes else []
    first = 0
    for number, section in enumerate(sections):
        k = matching.cl.count_before(section.end)
        end = max(first, matching.nc[k - 1] + 1) if k else first
        end = max([end, *(hole.end for hole in holes if hole.index < context.expected.hole_ends[number])])
        end = len(context.run) if number == len(sections) - 1 else end
        yield OperationRows(section.operation.name, section.operation.tool.name, section.file, first, end)
        first = end
