"""How far the tool leaves its path between the points."""

import numpy as np

from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.deviations.linearization import LinearizationErrors
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.results import Check


def check_between_points(context: Context, motion: AxisMotion, errors: LinearizationErrors | None) -> Check:
    """Tip and tool axis between the points: at several positions of each motion, or else half-way.

    Parameters
    ----------
    errors
        None where the settings give no limit; then nothing fails.
    """
    axis, tip = (motion.axis_deviation, motion.tip_deviation) if errors is None else (errors.axis, errors.tip)
    where = "half-way" if errors is None else "on the way"
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
    settings = context.settings
    limits = [
        f"{limit:g} {unit}" for limit, unit in ((settings.span_tip, "mm"), (settings.span, "deg")) if limit is not None
    ]
    summary += f", allowed {' and '.join(limits)}" if limits else ""
    passed = not axis.count + tip.count
    title = "tool between the points"
    return Check("span", title, passed, summary, axis.value, settings.span, "deg", tuple(places))


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
