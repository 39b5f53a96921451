"""Events that a control cannot carry out, or not where they are."""

from collections.abc import Collection
from typing import TypeGuard

from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.controls.inches import literal_length
from trunnion.controls.vocabulary import RADIUS_NUMBER_WORD
from trunnion.errors import Problem, Severity
from trunnion.model.motion import Motion
from trunnion.model.toolpath import BlockSkip, Coolant, CutterComp, Dwell, Event, GoHome, Insert, LoadTool, SelectTool
from trunnion.output.program import Program


def event_problems(
    program: Program, motion: Motion, event: Event, rpm: float | None, registers: Collection[int]
) -> list[Problem]:
    """Return what is wrong with an event.

    Parameters
    ----------
    rpm
        The spindle speed; None while it is stopped.
    registers
        Numbers of the tools that the motion loads, and of the registers that LOAD/TOOL names.
    """
    control, location = program.control, (program.file_of(motion.operation), event.line)
    if isinstance(event, Dwell):
        if event.revolutions and not rpm:
            what = "a dwell in spindle revolutions while the spindle stands: it would never end"
            return [Problem(*location, what, "put SPINDL before it, or write DELAY in seconds", code="CTL420")]
        try:
            control.family.dwell(event, rpm, control.number_formats(motion.three_axis))
        except UnsupportedFeatureError as why:
            return [Problem(*location, why.what, why.cure, code=why.code)]
    if isinstance(event, LoadTool) and (event.row > 0 or not motion.starts_operation):
        return [
            Problem(
                *location, "tool change within an operation", "begin a new operation with the new tool", code="CTL430"
            )
        ]
    if isinstance(event, CutterComp) and event.side == "ON":
        return [
            Problem(
                *location, "CUTCOM/ON does not say on which side", "write CUTCOM/LEFT or CUTCOM/RIGHT", code="CTL230"
            )
        ]
    takes_tool_radius = RADIUS_NUMBER_WORD not in control.family.WORDS
    if takes_tool_radius and _compensates_by_register(event) and event.register not in registers:
        what = f"CUTCOM names the register {event.register}, and {control.name} takes the radius of the tool"
        return [
            Problem(*location, what, "write CUTCOM without a register, or with the number of the tool", code="CTL230")
        ]
    if isinstance(event, GoHome) and event.row < len(motion.operation.moves):
        return [
            Problem(*location, "GOHOME before the operation's end", "begin a new operation after it", code="CTL430")
        ]
    if isinstance(event, SelectTool) and not control.family.tool_preselection("1"):
        what = f"SELECT/TOOL,{event.number} is not written: how {control.name} preselects a tool is not known"
        return [Problem(*location, what, "preselect the tool by INSERT/", Severity.WARNING, code="CTL440")]
    if isinstance(event, Insert) and control.unit != 1.0 and not event.template:
        literal = literal_length(control, event.text)
        if literal:
            what = f"INSERT/{event.text.strip()}: {literal} may be a length, and nobody says whether in mm or inches"
            return [Problem(*location, what, "leave it out, or write setting units=mm", code="CTL450")]
    if isinstance(event, Coolant) and event.kind not in control.coolant:
        cure = (
            f"use one of {', '.join(control.coolant)}, or write its M code into the machine's definition:"
            f" {event.kind} = … under [control.coolant]"
        )
        return [Problem(*location, f"{control.name} has no coolant {event.kind}", cure, code="CTL410")]
    return []


def _compensates_by_register(event: Event) -> TypeGuard[CutterComp]:
    """Whether an event switches radius compensation on and names the register of the radius."""
    return isinstance(event, CutterComp) and event.side != "OFF" and event.register != 0


def block_skip_problems(program: Program) -> list[Problem]:
    """Return operations that end, or turn to another plane, among blocks that may be skipped.

    The way home is for every run of the program, so that it gets no skip sign. A turn to another plane can have none
    either: without it, the blocks after it would be somewhere else.
    """
    motions = program.motions
    problems: list[Problem] = []
    skip: BlockSkip | None = None
    for k, motion in enumerate(motions):
        for event in motion.operation.events:
            if isinstance(event, BlockSkip):
                skip = event if event.on else None
        if skip is None:
            continue
        if k + 1 == len(motions) or motions[k + 1].starts_operation:
            what = f"OPSKIP/ON ends with operation {motion.operation.name}: the way home cannot be skipped"
            problems.append(
                Problem(
                    program.file_of(motion.operation),
                    skip.line,
                    what,
                    "write OPSKIP/OFF",
                    Severity.WARNING,
                    code="CTL460",
                )
            )
            skip = None
        else:
            line = int(motions[k + 1].operation.moves.line[0])
            what = "the tool axis turns to another plane between blocks that may be skipped"
            problems.append(
                Problem(
                    program.file_of(motion.operation),
                    line,
                    what,
                    "write OPSKIP/OFF before it, and OPSKIP/ON after it",
                    code="CTL460",
                )
            )
    return problems
