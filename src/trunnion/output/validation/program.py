"""The validation of a whole program, motion by motion."""

from trunnion.errors import Problem
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import LoadTool, Sense, SpindleOff, SpindleOn, Stop
from trunnion.output.program import Program
from trunnion.output.validation.compensation import compensation_problems, register_problems, skipped_side_problems
from trunnion.output.validation.compensation_corners import corner_problems
from trunnion.output.validation.cycles import cycle_problems
from trunnion.output.validation.events import block_skip_problems, event_problems
from trunnion.output.validation.feeds import missing_feed_problems, rapid_feed_problems, rounded_feed_problems
from trunnion.output.validation.machine import machine_problems
from trunnion.output.validation.operations import (
    next_axis_problems,
    plane_entry_problems,
    tolerance_problems,
    tool_problems,
)
from trunnion.output.validation.orientation import normal_problems, tool_vector_problems
from trunnion.output.validation.planes import plane_problems
from trunnion.output.validation.spindle import SpindleSpeeds
from trunnion.output.validation.texts import text_problems
from trunnion.output.validation.without_tcp import problems_without_tcp
from trunnion.planning.holes.cycles import SpindleState, SpindleStates


def check_program(program: Program) -> list[Problem]:
    """Return what the program would lack, and what the control would reject; errors mean not to write it."""
    problems: list[Problem] = []
    tool_in_spindle = ""
    rpm: float | None = None
    speeds = SpindleSpeeds(program)
    # A spindle that stands is refused by itself, unless it may: what cycles need of it is asked only then.
    may_stand = program.effective_setting("standing_spindle") == "allowed"
    spindle = None if may_stand else SpindleState(1.0, Sense.CLW)
    for motion in program.motions:
        operation = motion.operation
        problems += cycle_problems(program, motion, spindle)
        spindle = SpindleStates(operation.events, spindle).at(len(operation.moves)) or (None if may_stand else spindle)
        stands_at = -1  # row before which a STOP has stopped the spindle: it turns again with the motion
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        registers = {number for load in loads for number in (load.number, load.adjust)}
        for event in operation.events:
            if isinstance(event, SpindleOn):
                stands_at = -1
            elif isinstance(event, Stop) and not event.optional:
                stands_at = event.row
            turning = None if event.row == stands_at else rpm
            problems += event_problems(program, motion, event, turning, registers)
            rpm = event.rpm if isinstance(event, SpindleOn) else None if isinstance(event, SpindleOff) else rpm
        problems += _motion_problems(program, motion)
        rejected = program.control.family.validate_operation(operation, speeds.turns is not None)
        problems += [Problem(program.file_of(operation), line, why.wording) for line, why in rejected]
        problems += speeds.problems_of(operation)
        if not motion.starts_operation:
            problems += next_axis_problems(program, motion)
            continue
        problems += tool_problems(program, operation, tool_in_spindle)
        tool_in_spindle = operation.tool.name
        problems += tolerance_problems(program, motion)
    problems += [*register_problems(program), *block_skip_problems(program)]
    return [*problems, *machine_problems(program), *text_problems(program)]


def _motion_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return what a motion lacks, whatever its events are."""
    problems = []
    if motion.mode is MachiningMode.TCP and program.control.vectors_exclude_angles:
        problems += tool_vector_problems(program, motion)
    problems += plane_problems(program, motion)
    problems += [*plane_entry_problems(program, motion), *normal_problems(program, motion)]
    problems += [*compensation_problems(program, motion), *corner_problems(program, motion)]
    problems += skipped_side_problems(program, motion)
    if motion.mode.goes_straight and program.template_suffix(motion):
        problems += problems_without_tcp(program, motion)
    problems += [*missing_feed_problems(program, motion), *rounded_feed_problems(program, motion)]
    return [*problems, *rapid_feed_problems(program, motion)]
