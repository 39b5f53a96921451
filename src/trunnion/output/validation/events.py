"""Events that a control cannot carry out, or not where they are."""

from collections.abc import Collection, Iterator
from dataclasses import replace
from itertools import pairwise
from typing import TypeGuard

from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.controls.inches import literal_length
from trunnion.controls.vocabulary import RADIUS_NUMBER_WORD
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    Dwell,
    Event,
    GoHome,
    Insert,
    Kind,
    LoadTool,
    Operation,
    SelectTool,
    SpindleOn,
)
from trunnion.output.program import Program
from trunnion.planning.holes.operations import cycle_row_ranges


def event_problems(
    program: Program, motion: Motion, event: Event, rpm: float | None, registers: Collection[int]
) -> list[Problem]:
    """Return what is wrong with an event.

    rpm        the spindle speed before it; None while it is stopped
    registers  numbers of the tools that the motion loads, and of the registers that LOAD/TOOL names
    """
    control, location = program.control, (program.file_of(motion.operation), event.line)
    if isinstance(event, Dwell):
        if event.revolutions and not rpm:
            return [Problem(*location, Wording("CTL420", "dwell_spindle_revolutions_while"))]
        formats = control.number_formats(motion.three_axis)
        try:
            blocks = control.family.dwell(event, rpm, formats)
        except UnsupportedFeatureError as why:
            return [Problem(*location, why.wording)]
        longer = replace(event, amount=2.0 * event.amount)
        if event.amount < 1.0 and control.family.dwell(longer, rpm, formats) == blocks:
            return [warning(*location, Wording("CTL425", "dwell_rounded_up", amount=event.amount, block=blocks[-1]))]
    if isinstance(event, LoadTool) and (event.row > 0 or not motion.starts_operation):
        return [Problem(*location, Wording("CTL430", "tool_change_within"))]
    if isinstance(event, CutterComp) and event.side == "ON":
        return [Problem(*location, Wording("CTL230", "cutcom_does_not"))]
    takes_tool_radius = RADIUS_NUMBER_WORD not in control.family.WORDS
    if takes_tool_radius and _compensates_by_register(event) and event.register not in registers:
        return [
            Problem(
                *location, Wording("CTL230", "cutcom_names_register", register=event.register, control=control.name)
            )
        ]
    if isinstance(event, SpindleOn) and not (
        printed := control.number_formats(motion.three_axis)["speed"].rounded(event.rpm)
    ):
        return [Problem(*location, Wording("CTL320", "speed_below_least", rpm=event.rpm, printed=printed))]
    if isinstance(event, SpindleOn) and _stops_in_cut(program, motion, event, rpm):
        return [warning(*location, Wording("CTL470", "new_speed_in_cut", rpm=event.rpm, before=rpm))]
    if isinstance(event, GoHome) and event.row < len(motion.operation.moves):
        return [Problem(*location, Wording("CTL430", "gohome_before_operation"))]
    if isinstance(event, SelectTool) and not control.family.tool_preselection("1"):
        return [warning(*location, Wording("CTL440", "select_tool_not", number=event.number, control=control.name))]
    if isinstance(event, Insert) and control.unit != 1.0 and not event.template:
        literal = literal_length(control, event.text)
        if literal:
            return [
                Problem(*location, Wording("CTL450", "insert_may_length", event=event.text.strip(), literal=literal))
            ]
    if isinstance(event, Coolant) and event.kind not in control.coolant:
        return [
            Problem(
                *location,
                Wording("CTL410", "no_coolant", control=control.name, kind=event.kind, coolant=tuple(control.coolant)),
            )
        ]
    return []


def _stops_in_cut(program: Program, motion: Motion, event: SpindleOn, rpm: float | None) -> bool:
    """Whether TCP is switched off and on for a new speed right behind a cut, with the tool where the cut ends."""
    with_tcp = bool(program.control.new_speed_template(motion.mode))
    moves = motion.operation.moves
    behind_cut = 0 < event.row < len(moves) and int(moves.kind[event.row - 1]) != Kind.RAPID
    return with_tcp and behind_cut and rpm not in (None, event.rpm)


def _compensates_by_register(event: Event) -> TypeGuard[CutterComp]:
    """Whether an event switches radius compensation on and names the register of the radius."""
    return isinstance(event, CutterComp) and event.side != "OFF" and event.register != 0


def _skipped_feeds(program: Program, operation: Operation) -> Iterator[Problem]:
    """Yield stretches to skip without a motion or a word between a feed and another one, which no block could skip."""
    moves, events = operation.moves, operation.events
    for on, off in pairwise(events):
        if not (isinstance(on, BlockSkip) and isinstance(off, BlockSkip) and on.on and not off.on):
            continue
        row = on.row
        if row != off.row or not 0 < row < len(moves) or int(moves.kind[row]) == Kind.RAPID:
            continue
        if moves.feed[row] != moves.feed[row - 1]:
            yield Problem(program.file_of(operation), on.line, Wording("CTL460", "feed_alone", off=off.line))


def _from_home(program: Program, motion: Motion) -> Iterator[Problem]:
    """Yield the row behind blocks that may be skipped at the start of a plane, if it is a hole or a cut."""
    operation = motion.operation
    moves, skips = operation.moves, [event for event in operation.events if isinstance(event, BlockSkip)]
    if len(skips) < 2 or not skips[0].on or skips[0].row > 0 or skips[1].row in (0, len(moves)):
        return
    row = skips[1].row
    settings = program.effective_settings(operation) | {"orientation": "angles"}
    # The tool length that the first motion takes on is not skipped.
    has_words = "length" in program.control.family.first_block_words(motion, "1", 1, settings)
    if (
        has_words
        or moves.kind[row] != Kind.RAPID
        or any(cycle.row <= row < end for cycle, end in cycle_row_ranges(operation))
    ):
        yield Problem(program.file_of(operation), int(moves.line[row]), Wording("CTL460", "tool_axis_turns"))


def block_skip_problems(program: Program) -> list[Problem]:
    """Return operations that end, or turn to another plane, among blocks that may be skipped.

    The way home is for every run of the program, so that it gets no skip sign. A turn to another plane can have none
    either: without it, the blocks after it would be somewhere else. Nor may a hole or a cut come right behind what is
    skipped in another plane: the tool would come to it from home.
    """
    motions = program.motions
    problems = [problem for motion in motions for problem in _skipped_feeds(program, motion.operation)]
    problems += [
        problem for motion in motions if not motion.starts_operation for problem in _from_home(program, motion)
    ]
    skip: BlockSkip | None = None
    for k, motion in enumerate(motions):
        for event in motion.operation.events:
            if isinstance(event, BlockSkip):
                skip = event if event.on else None
        if skip is None:
            continue
        if k + 1 == len(motions) or motions[k + 1].starts_operation:
            problems.append(
                warning(
                    program.file_of(motion.operation),
                    skip.line,
                    Wording("CTL460", "opskip_ends_operation", operation=motion.operation.name),
                )
            )
            skip = None
        else:
            line = int(motions[k + 1].operation.moves.line[0])
            problems.append(Problem(program.file_of(motion.operation), line, Wording("CTL460", "tool_axis_turns")))
    return problems
