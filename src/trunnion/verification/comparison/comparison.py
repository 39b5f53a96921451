"""Whether two programs make the tool do the same.

In:     two runs, possibly of different machines.
Out:    whether tip, tool axis, kind of motion, feed, spindle, tool, coolant, the registers of offsets, lengths and
        radii, stops and dwells are the same throughout; the first difference and the worst.

Only what the words do matters: block numbers, modal habits and number formats may differ, and either program may have
additional points on the path of the other. Motions in the machine frame count if both run on the same machine.
"""

from trunnion.model.run import Run
from trunnion.verification.comparison.comparer import Comparer
from trunnion.verification.comparison.result import Alignment, Comparison


def compare(
    one: Run, two: Run, tolerance: float = 0.001, *, axis_tolerance: float | None = None, path: bool = False
) -> Comparison:
    """Compare two runs.

    tolerance       how far tips, mm, and tool axes, degrees, may be apart
    axis_tolerance  another tolerance for tool axes, degrees
    path            compare only where the tool goes, and whether at rapid; not feed, spindle, tool, coolant, stops and
                    dwells
    """
    return Comparer(one, two, tolerance, tolerance if axis_tolerance is None else axis_tolerance, path).compare()


def align(one: Run, two: Run, tolerance: float = 0.001) -> Alignment:
    """Follow two runs together, and return which of their rows go to the same points, and where they differ.

    tolerance  how far tips, mm, and tool axes, degrees, may be apart
    """
    return Comparer(one, two, tolerance, tolerance, False).follow()
