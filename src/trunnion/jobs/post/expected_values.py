"""What the proof of a program holds against it, besides its toolpaths.

In:     a program as it was planned, and the options of the planner.
Out:    tolerances and settings for ``trunnion.verification.verify``.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from trunnion.controls import Control
from trunnion.jobs.inputs.settings import m_code, work_offset_setting
from trunnion.jobs.post.tolerances import program_tolerances
from trunnion.model.motion import MachiningMode
from trunnion.output.program import Program
from trunnion.planning import PlanOptions
from trunnion.verification import ExpectedValues, OperationSettings, Tolerances


@dataclass(frozen=True, slots=True, eq=False)
class Expectation:
    """What the proof of a program holds against it, besides its toolpaths.

    tolerances  one for each operation: half the last digit that it prints, and what follows from it
    settings    what the settings of the post say and the toolpaths do not
    """

    tolerances: list[Tolerances]
    settings: ExpectedValues


#: Settings for the tolerance of the control's own smoothing, and for what tool calls add to the tool, by their words.
_SMOOTHING: Final = ("tolerance", "three_axis_tolerance", "fallback_tolerance")
_TOOL_DELTAS: Final = {"delta_length": "DL", "delta_radius": "DR"}


def expectation(program: Program, options: PlanOptions | None = None) -> Expectation:
    """What the proof holds against a program that was planned with these options."""
    return Expectation(program_tolerances(program), _expected_settings(program, options or PlanOptions()))


def _expected_settings(program: Program, options: PlanOptions) -> ExpectedValues:
    """What the settings of the post say and the CL files do not."""
    without_tcp = any(motion.mode is MachiningMode.WITHOUT_TCP for motion in program.motions)
    axis_tolerance = options.axis_tolerance_between_points
    values = program.effective_settings()
    operations = {motion.operation.name: motion.operation for motion in program.motions}
    by_operation = {
        name: OperationSettings(*_operation_settings(program, program.effective_settings(operation)))
        for name, operation in operations.items()
        if name in program.own_settings
    }
    every = [values, *(program.effective_settings(motion.operation) for motion in program.motions)]
    tool, work_offset, edge = _operation_settings(program, values)
    inverse_time = program.control.formats.get("inverse_time")
    rapid_feed = float(values["rapid_feed"]) if values.get("rapid_feed") else None
    return ExpectedValues(
        tool=tool,
        work_offset=work_offset,
        edge=edge,
        by_operation=by_operation,
        span=axis_tolerance if without_tcp or math.isfinite(axis_tolerance) else None,
        span_tip=options.tip_tolerance if without_tcp else None,
        blocks_in_compensation=program.control.blocks_in_compensation,
        stops_in_compensation=program.control.stops_in_compensation,
        axis_tolerance=options.default_axis_tolerance,
        absolute=options.absolute_frame,
        max_inverse_time_feed=inverse_time.five_axis.greatest if inverse_time else None,
        max_feed=program.control.formats["feed"].five_axis.greatest,
        fastest_feed=options.fastest_feed,
        feed_limit=options.feed_limit,
        rapid_feed=rapid_feed,
        below_rapid_feed=None if rapid_feed is None else rapid_feed - program.control.formats["feed"].five_axis.digit,
        smoothing=max(float(each.get(key) or 0.0) for each in every for key in _SMOOTHING),
        rigid_tap=m_code(values.get("rigid_tap", "")),
        tool_deltas={
            word: tuple({_as_printed(program.control, key, float(each[key])) for each in every if each.get(key)})
            for key, word in _TOOL_DELTAS.items()
        },
    )


def _as_printed(control: Control, name: str, value: float) -> float:
    """A setting as the digits of its templates print it."""
    fields = {field for template in control.templates.values() for field in template.fields()}
    formats = [
        control.formats[number_format] for field, number_format in sorted(fields) if field == name and number_format
    ]
    return formats[0].three_axis.rounded(value) if formats else value


def _operation_settings(program: Program, values: Mapping[str, str]) -> tuple[str, int | None, int | None]:
    """Tool, work offset and edge as settings give them."""
    edge = int(values["edge"]) if "edge" in values else None
    return values["tool"].strip('"'), work_offset_setting(values["work_offset"], program.machine), edge
