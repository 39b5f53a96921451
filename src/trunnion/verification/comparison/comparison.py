"""Whether two programs make the tool do the same.

In:     two runs, possibly of different machines.
Out:    whether tip, tool axis, kind of motion, feed, spindle, tool, coolant, the registers of offsets, lengths and
        radii, stops and dwells are the same throughout; the first difference and the worst.

Only what the words do matters: block numbers, modal habits and number formats may differ, and either program may have
additional points on the path of the other. Motions in the machine frame count if both run on the same machine.
"""

from collections.abc import Callable
from typing import Final

from trunnion.model.run import Run
from trunnion.verification.comparison.comparer import Comparer
from trunnion.verification.comparison.control_rules import ANY_RULES, ControlRules
from trunnion.verification.comparison.moving_rows import unknown_points
from trunnion.verification.comparison.nominal_runs import missing_values, with_nominal_values
from trunnion.verification.comparison.on_path import PointTolerances
from trunnion.verification.comparison.result import Alignment, Comparison

#: How far tips, mm, and tool axes, degrees, may be apart where two programs are shown side by side.
_TOLERANCE: Final = 0.001


def compare(
    one: Run,
    two: Run,
    tolerance: float = 0.001,
    *,
    axis_tolerance: float | None = None,
    path: bool = False,
    rules: tuple[ControlRules, ControlRules] = (ANY_RULES, ANY_RULES),
) -> Comparison:
    """Compare two runs.

    tolerance       how far tips, mm, and tool axes, degrees, may be apart
    axis_tolerance  another tolerance for tool axes, degrees
    path            compare only where the tool goes, and whether at rapid; not feed, spindle, tool, coolant, stops and
                    dwells
    rules           of either control
    """
    tolerances = PointTolerances.of(tolerance, tolerance if axis_tolerance is None else axis_tolerance)
    left_out = (unknown_points(one), unknown_points(two)) if path else (None, None)

    def compared(first: Run, second: Run) -> Comparison:
        return Comparer(first, second, tolerances, path=path, rules=rules, left_out=left_out).compare()

    found = compared(one, two)
    return _elsewhere(one, two, compared) or found if found.same else found


def _elsewhere(one: Run, two: Run, compared: Callable[[Run, Run], Comparison]) -> Comparison | None:
    """Return how programs differ that are the same only with a zero and a length of 0, which nobody has stated."""
    runs = with_nominal_values(one), with_nominal_values(two)
    if runs == (one, two):
        return None
    found = compared(*runs)
    if found.same:
        return None
    values = tuple(dict.fromkeys(missing_values(one.machine) + missing_values(two.machine)))
    return found.within("with_nominal", values=values)


def align(one: Run, two: Run) -> Alignment:
    """Follow two runs together, and return which of their rows go to the same points, and where they differ."""
    return Comparer(one, two, PointTolerances.of(_TOLERANCE, _TOLERANCE), rules=(ANY_RULES, ANY_RULES)).follow()
