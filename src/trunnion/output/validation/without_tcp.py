"""What a control cannot do without TCP, where X Y Z are positions of the linear axes."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.words import NumberFormat
from trunnion.errors import Problem, Severity, warning
from trunnion.machines import Mount
from trunnion.messages import Wording
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CutterComp, Kind
from trunnion.output.coordinates.axis_coordinates import (
    FEED_AT_TIP,
    AxisCoordinates,
    feed_format,
    feed_rule,
    feed_words,
    to_axis_coordinates,
)
from trunnion.output.program import Program
from trunnion.output.validation.feeds import REFUSED_ERROR, TOLD_ERROR

#: Of computing, as a share.
_NOISE: Final = 1e-6


def problems_without_tcp(program: Program, motion: Motion) -> list[Problem]:
    """Return what is wrong with a motion without TCP, or with M114, where blocks hold tips and F is that of the tip."""
    operation, problems = motion.operation, list[Problem]()
    moves, control = operation.moves, program.control
    if any(isinstance(event, CutterComp) and event.side != "OFF" for event in operation.events):
        problems.append(
            Problem(program.file_of(operation), operation.line, Wording("CTL220", "cutter_radius_compensation_without"))
        )
    if motion.mode is MachiningMode.M114:
        return problems
    decimals = control.number_formats(motion.three_axis)["angle"].decimals
    coordinates = to_axis_coordinates(program.machine_of(motion), motion, decimals)
    cuts = np.flatnonzero(coordinates.rotary_moves & (moves.kind != Kind.RAPID) & (moves.feed > 0))
    problems += _feed_problems(program, motion, coordinates, cuts)
    wraps = np.flatnonzero(coordinates.wraps.any(axis=1))
    if len(wraps) and "primary_shortest" not in control.family.WORDS and not control.shorter_way:
        problems.append(
            Problem(program.file_of(operation), int(moves.line[wraps[0]]), Wording("CTL630", "rotary_axis_goes"))
        )
    return problems


def _feed_problems(program: Program, motion: Motion, coordinates: AxisCoordinates, cuts: Ints) -> list[Problem]:
    """Return what is wrong with the feeds of cuts in which rotary axes turn: rows of the motion."""
    operation, problems = motion.operation, list[Problem]()
    moves, settings = operation.moves, program.effective_settings()
    per_rev = cuts[moves.per_rev[cuts]]
    if len(per_rev):
        problems.append(
            Problem(
                program.file_of(operation),
                int(moves.line[per_rev[0]]),
                Wording("CTL330", "feed_per_revolution_without"),
            )
        )
    rule = feed_rule(program.control, settings)
    if len(cuts) and program.control.unit != 1.0 and rule in ("all_axes", "slides"):
        problems.append(
            Problem(program.file_of(operation), int(moves.line[cuts[0]]), Wording("CTL340", "rotary_axes_turn"))
        )
    number_format = program.control.number_formats(motion.three_axis)[feed_format(rule)]
    value, below, above = feed_words(coordinates.select(cuts), moves.feed[cuts], rule, number_format)
    if below.any():
        row = int(cuts[np.argmax(below)])
        if rule == "inverse_time":
            minutes, most = coordinates.tip_length[row] / moves.feed[row], 1.0 / number_format.least
        problems.append(
            Problem(
                program.file_of(operation),
                int(moves.line[row]),
                Wording("CTL340", "block_takes_minutes", minutes=minutes, most=most)
                if rule == "inverse_time"
                else Wording("CTL340", "f_block_would", least=number_format.least),
            )
        )
    if above.any():
        location = program.file_of(operation), int(moves.line[cuts[np.argmax(above)]])
        problems.append(
            warning(
                *location, Wording("CTL340", "block_so_short", sum=int(above.sum()), greatest=number_format.greatest)
            )
        )
    problems += _rounding_problems(program, motion, cuts, value, rule, number_format)
    heads = [axis.name for axis in program.machine.own_axes if axis.is_rotary and axis.mount is Mount.TOOL]
    if rule == FEED_AT_TIP and heads:
        problems.append(
            Problem(
                program.file_of(operation), operation.line, Wording("CTL340", "rotary_feed_tip", heads=tuple(heads))
            )
        )
    return problems


def _rounding_problems(
    program: Program, motion: Motion, cuts: Ints, value: Floats, rule: str, number_format: NumberFormat
) -> list[Problem]:
    """Return what the digits of F make of the feed of blocks; with inverse time a block may be off by a thousandth."""
    printed = number_format.values(number_format.counts(value))
    error = np.abs(printed - value) / np.maximum(value, number_format.least)
    inverse_time = rule == "inverse_time"
    wrong = np.flatnonzero(error > (TOLD_ERROR + _NOISE if inverse_time else REFUSED_ERROR))
    if not len(wrong):
        return []
    worst = int(np.argmax(error))
    severity = Severity.ERROR if inverse_time else Severity.WARNING
    return [
        Problem(
            program.file_of(motion.operation),
            int(motion.operation.moves.line[cuts[worst]]),
            Wording("CTL340", "f_block_up", count=len(wrong), error=100.0 * error[worst]),
            severity=severity,
        )
    ]
