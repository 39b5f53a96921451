"""What the proof of a program holds against it, besides its toolpaths.

In:     a program as it was planned, and the options of the planner.
Out:    tolerances and settings for ``trunnion.verification.verify``.
"""

import math
from dataclasses import replace

from trunnion.jobs.post.tolerances import program_tolerances
from trunnion.jobs.verify.expected_values import expected_values
from trunnion.output.program import Program
from trunnion.planning import PlanOptions
from trunnion.records import dataclass
from trunnion.verification import ExpectedValues, Tolerances


@dataclass(frozen=True, slots=True, eq=False)
class Expectation:
    """What the proof of a program holds against it, besides its toolpaths.

    tolerances  one for each operation: half the last digit that it prints, and what follows from it
    settings    what the settings of the post say and the toolpaths do not
    """

    tolerances: list[Tolerances]
    settings: ExpectedValues


def expectation(program: Program, options: PlanOptions | None = None, *, demands: tuple[str, ...] = ()) -> Expectation:
    """Return what the proof holds against a program that was planned with these options; it must stand on ``demands``
    too.
    """
    settings = _expected_settings(program, options or PlanOptions())
    return Expectation(program_tolerances(program), replace(settings, demands=demands))


def _expected_settings(program: Program, options: PlanOptions) -> ExpectedValues:
    """Return what the settings of the post say and the CL files do not, with what only a post knows of its program."""
    control, settings = program.control, program.effective_settings()
    operations = {motion.operation.name: motion.operation for motion in program.motions}
    by_operation = {name: program.effective_settings(operation) for name, operation in operations.items()}
    own = {name: values for name, values in by_operation.items() if name in program.own_settings}
    without_tcp = any(motion.mode.goes_straight for motion in program.motions)
    axis_tolerance = options.axis_tolerance_between_points
    return replace(
        expected_values(control, program.machine, settings, own),
        span=axis_tolerance if without_tcp or math.isfinite(axis_tolerance) else None,
        span_tip=options.tip_tolerance if without_tcp else None,
        axis_tolerance=options.default_axis_tolerance,
        absolute=options.absolute_frame,
        fastest_feed=options.fastest_feed,
        feed_limit=options.feed_limit,
    )
