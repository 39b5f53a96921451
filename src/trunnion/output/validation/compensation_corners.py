"""Events within radius compensation across which the control would not see the next corner."""

from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import (
    Coolant,
    CutterComp,
    Dwell,
    Event,
    Insert,
    Kind,
    Message,
    Operation,
    SelectTool,
    SpindleOff,
    SpindleOn,
    Stop,
)
from trunnion.output.program import Program

#: A smaller motion in the plane, mm, is none.
_STILL: Final = 1e-6

#: A line that begins so is a comment.
_COMMENT_SIGNS: Final = ("(", ";")


def corner_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse stops, and more blocks without motion than the control reads ahead, within CUTCOM."""
    events = motion.operation.events
    if motion.mode.goes_straight or not any(isinstance(event, CutterComp) for event in events):
        return []
    operation = motion.as_written()
    across, rows = _moves_across(operation), len(operation.moves)
    last = _last_row_across(operation, across)
    ahead = program.control.blocks_in_compensation
    ends = {event.row for event in events if isinstance(event, CutterComp) and event.side == "OFF"} | {rows}
    problems = list[Problem]()
    side, count, under_way, next_row = "OFF", 0, False, 0

    def add(line: int, blocks: int) -> None:
        """Count blocks without motion; the first one too many is a problem."""
        nonlocal count
        if count <= ahead < count + blocks:
            what = f"more than {ahead} block{'s' * (ahead != 1)} without motion between two motions within CUTCOM"
            problems.append(_problem(program, motion, line, what))
        count += blocks

    for event in (*operation.events, Event(rows, 0)):
        for row in range(next_row, event.row) if side != "OFF" else ():
            if across[row] > 0:
                count, under_way = 0, True
            elif across[row] < 0 and under_way and row < last[row]:
                add(int(operation.moves.line[row]), 1)
        next_row = max(next_row, event.row)
        if isinstance(event, CutterComp):
            if event.side == "OFF" or side == "OFF":
                side, count, under_way = event.side, 0, False
                continue
            side = event.side
        # Before the first motion and behind the last one there is no corner.
        if side == "OFF" or not under_way or event.row in ends or event.row > last[event.row]:
            continue
        if isinstance(event, Stop) and not program.control.stops_in_compensation:
            what = f"{'OPSTOP' if event.optional else 'STOP'} within CUTCOM, where the control reads no further"
            problems.append(_problem(program, motion, event.line, what))
        else:
            add(event.line, _blocks(program, event))
    return problems


def _problem(program: Program, motion: Motion, line: int, what: str) -> Problem:
    return Problem(
        program.file_of(motion.operation),
        line,
        Wording("CTL240", "would_not_see", subject=what, control=program.control.name),
    )


def _moves_across(operation: Operation) -> Ints:
    """For each row (n,): 1 if it moves across the tool, -1 if along it only, 0 if not at all."""
    moves = operation.moves
    way = np.diff(moves.tip, axis=0, prepend=moves.tip[:1])
    across = way - np.einsum("ij,ij->i", way, moves.axis)[:, None] * moves.axis
    found = np.where(np.abs(way).max(axis=1, initial=0.0) > _STILL, -1, 0)
    found[(np.abs(across).max(axis=1, initial=0.0) > _STILL) | (moves.kind == Kind.ARC)] = 1
    return found


def _last_row_across(operation: Operation, across: Ints) -> Ints:
    """For each row (n,) the last one before the next CUTCOM/OFF that moves across the tool; -1 if there is none."""
    last = np.full(len(across), -1)
    first = 0
    offs = [event.row for event in operation.events if isinstance(event, CutterComp) and event.side == "OFF"]
    for end in (*offs, len(across)):
        rows = np.flatnonzero(across[first:end] > 0)
        last[first:end] = first + rows[-1] if len(rows) else -1
        first = end
    return last


def _blocks(program: Program, event: Event) -> int:
    """How many blocks of its own an event has."""
    control = program.control
    if isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF"):
        return 1
    if isinstance(event, SpindleOn | Coolant | CutterComp):
        return int(control.own_blocks)
    if isinstance(event, Message):
        return sum(not line.startswith(_COMMENT_SIGNS) for line in control.family.message(event))
    if isinstance(event, Insert):
        return sum(not line.lstrip().startswith(_COMMENT_SIGNS) for line in event.text.split("\n"))
    return int(isinstance(event, Dwell | SelectTool | Stop))
