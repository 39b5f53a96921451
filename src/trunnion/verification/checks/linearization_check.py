"""How far the tool leaves its path between the points."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.verification.checks.arc_chord_faults import arc_chord_faults, chord_heights
from trunnion.verification.checks.spline_faults import SplineFaults, spline_faults
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, ExpectedValues
from trunnion.verification.deviations.linearization import LinearizationErrors
from trunnion.verification.expected.arcs import circle_of
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.matching.pairs import ArcSegments
from trunnion.verification.results import Check

#: What comes of arithmetic only, mm.
_NOISE: Final = 1e-9

#: Fractions of a circle at which it is compared with the arc that it is a piece of.
_WAY: Final = np.linspace(0.125, 0.875, 7)


def check_between_points(context: Context, motion: AxisMotion, errors: LinearizationErrors) -> Check:
    """Tip and tool axis between the points: at several positions of each motion, or else half-way.

    Where the settings give no limit, the tool axis is judged by that of the control's definition.
    """
    settings = context.settings
    asked = settings.span is not None or settings.span_tip is not None
    axis = errors.axis if settings.span is not None or errors.axis.count else motion.axis_deviation
    tip = errors.tip if asked else motion.tip_deviation
    where = "on the way" if axis is errors.axis else "half-way"
    deviation, deviation_row = _largest_deviation(context)
    splines = spline_faults(context) if isinstance(context, ComparedContext) else SplineFaults()
    if splines.deviation > max(deviation, _NOISE):
        deviation, deviation_row = splines.deviation, splines.row
    off_tip, row = (tip.value, tip.row) if tip.value > deviation else (deviation, deviation_row)
    places = []
    if axis.row >= 0:
        rows = axis.rows or [(axis.row, axis.value)]
        places += [
            context.place(r, v, f"{where} the tool axis is {v:.5f} degrees off the great circle") for r, v in rows
        ]
    faults = [*arc_chord_faults(context), *splines.places] if isinstance(context, ComparedContext) else []
    if row >= 0 and off_tip > 0.0 and not (faults and row == deviation_row):
        rows = tip.rows or [(row, off_tip)]
        places += [context.place(r, v, f"between its ends the tip is {v:.5f} mm off") for r, v in rows]
    summary = f"tip {off_tip:.6f} mm, axis {axis.value:.5f} deg off {where}"
    if axis.row >= 0:
        summary += f", in {context.block_name(axis.row)}"
    if allowed := [*_allowed_tip(settings), *_allowed_axis(settings, errors, axis.row)]:
        summary += f", allowed {' and '.join(allowed)}"
    if faults:
        summary += f"; {faults[0].block_name}: {faults[0].text}"
        summary += f", and {len(faults) - 1} more" if len(faults) > 1 else ""
        places = [*faults[:MAX_PLACES], *places]
    passed = not errors.axis.count + errors.tip.count + len(faults)
    title = "tool between the points"
    return Check("span", title, passed, summary, axis.value, settings.span, "deg", tuple(places))


def _allowed_tip(settings: ExpectedValues) -> Iterator[str]:
    if settings.span_tip is not None:
        yield f"{settings.span_tip:g} mm"


def _allowed_axis(settings: ExpectedValues, errors: LinearizationErrors, row: int) -> Iterator[str]:
    """Yield the tolerance of the tool axis that counts in a row, in words; -1: no row turns it, and none counts."""
    if settings.span is not None:
        yield f"{settings.span:g} deg"
    elif row >= 0:
        default, allowed = settings.axis_tolerance, errors.allowed_by_default(row)
        if math.isinf(allowed):
            yield "any, since it does not cut there"
        elif allowed > max(default.cutting, default.finishing) + _NOISE:
            yield f"{allowed:.5f} deg, a sixth of the turn"
        else:
            is_finishing = abs(allowed - default.finishing) < _NOISE and default.finishing != default.cutting
            yield f"{allowed:g} deg{', as in finishing' if is_finishing else ''}"


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
