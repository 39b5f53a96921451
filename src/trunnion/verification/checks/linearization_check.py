"""How far the tool leaves its path between the points."""

import numpy as np

from trunnion.verification.context import ComparedContext, Context, ExpectedValues
from trunnion.verification.deviations.linearization import LinearizationErrors
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.results import Check


def check_between_points(context: Context, motion: AxisMotion, errors: LinearizationErrors) -> Check:
    """Tip and tool axis between the points: at several positions of each motion, or else half-way.

    Where the settings give no limit, the tool axis is judged by that of the control's definition.
    """
    settings = context.settings
    asked = settings.span is not None or settings.span_tip is not None
    axis = errors.axis if settings.span is not None or errors.axis.count else motion.axis_deviation
    tip = errors.tip if asked else motion.tip_deviation
    where = "on the way" if axis is errors.axis else "half-way"
    sagitta, sagitta_row = _largest_sagitta(context)
    off_tip, row = (tip.value, tip.row) if tip.value > sagitta else (sagitta, sagitta_row)
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
        summary += f", in {context.block_name(axis.row)}"
    summary += f", allowed {_allowed(settings)}"
    passed = not errors.axis.count + errors.tip.count
    title = "tool between the points"
    return Check("span", title, passed, summary, axis.value, settings.span, "deg", tuple(places))


def _allowed(settings: ExpectedValues) -> str:
    """What is allowed, in words."""
    tip = [] if settings.span_tip is None else [f"{settings.span_tip:g} mm"]
    if settings.span is not None:
        return " and ".join([*tip, f"{settings.span:g} deg"])
    default = settings.axis_tolerance
    axis = f"{default.cutting:g} deg, {default.finishing:g} in finishing, a sixth of a coarse turn"
    return " and ".join([*tip, axis])


def _largest_sagitta(context: Context) -> tuple[float, int]:
    """How far the lines that replace an arc leave it at most, mm, and the row of that line; 0 and -1 without any."""
    largest, row = 0.0, -1
    if isinstance(context, ComparedContext):
        for segments in context.matching.arc_segments:
            arc, nc = segments.arc, segments.nc
            fractions = np.concatenate(([0.0], arc.fractions(context.run.positions(nc).tip), [1.0]))
            sagitta = arc.radius * (1.0 - np.cos(0.5 * np.abs(np.diff(fractions)) * arc.sweep))
            if len(sagitta) and sagitta.max() > largest:
                largest, row = float(sagitta.max()), int(nc[min(int(np.argmax(sagitta)), len(nc) - 1)])
    return largest, row
