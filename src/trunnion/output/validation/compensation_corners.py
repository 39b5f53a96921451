"""Events within radius compensation across which the control would not see the next corner."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import (
    BlockSkip,
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

#: A motion no longer than this may be none once it is printed, mm.
_NOT_PRINTED: Final = 1e-3

#: Motions across the tool between CUTCOM on and off: with fewer nobody knows where the tool goes.
_LEAST_MOTIONS: Final = 2

#: A line that begins so is a comment.
_COMMENT_SIGNS: Final = ("(", ";")


def corner_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse stops, and more blocks without motion than the control reads ahead, within CUTCOM: as the blocks are, and
    with those skipped that may be.
    """
    events = motion.operation.events
    if motion.mode.goes_straight or not any(isinstance(event, CutterComp) for event in events):
        return []
    operation = motion.as_written()
    across, skipped = _moves_across(operation), _skipped(operation)
    found = _corner_problems(program, motion, operation, across)
    if found or not skipped.any():
        return found
    # A block that is skipped is one without motion.
    operation = replace(operation, events=tuple(_not_skipped(operation.events)))
    found = _corner_problems(program, motion, operation, np.where(skipped & (across != 0), -1, across))
    if found or not program.control.own_blocks:  # words within a motion begin and end with it
        return found
    return list(_sides_alone(program.file_of(motion.operation), operation, across > 0, skipped))


def _sides_alone(file: str, operation: Operation, across: Flags, skipped: Flags) -> Iterator[Problem]:
    """Yield CUTCOM of which less than the motion that begins it and another one are left without the skipped ones."""
    sides = [event for event in operation.events if isinstance(event, CutterComp)]
    for event, end in pairwise(sides):
        rows = slice(event.row, end.row)
        left = np.count_nonzero(across[rows] & ~skipped[rows])
        if event.side != "OFF" and end.side == "OFF" and skipped[rows].any() and left < _LEAST_MOTIONS:
            yield Problem(file, event.line, Wording("CTL460", "side_alone", side=event.side, off=end.line))


def _skipped(operation: Operation) -> Flags:
    """Which rows (n,) may be skipped."""
    skipped, begin = np.zeros(len(operation.moves), np.bool_), -1
    for event in operation.events:
        if isinstance(event, BlockSkip):
            if not event.on and begin >= 0:
                skipped[begin : event.row] = True
            begin = event.row if event.on else -1
    return skipped


def _not_skipped(events: Iterable[Event]) -> Iterator[Event]:
    """Yield the events but for the sides of compensation that may be skipped."""
    skips = False
    for event in events:
        skips = event.on if isinstance(event, BlockSkip) else skips
        if not (skips and isinstance(event, CutterComp)):
            yield event


def _corner_problems(program: Program, motion: Motion, operation: Operation, across: Ints) -> list[Problem]:
    """As ``corner_problems`` of an operation; ``across``: as ``_moves_across`` has it."""
    events, rows = operation.events, len(operation.moves)
    control = program.control
    ahead = control.blocks_in_compensation
    sides = [event for event in events if isinstance(event, CutterComp)]
    idle = _ends_without_motion(operation, sides)
    offs = [event.row for event in sides if event.side == "OFF" and event not in idle]
    ends, last = {*offs, rows}, _last_row_across(across, offs)
    problems = list[Problem]()
    side, count, under_way, next_row, ended = "OFF", 0, False, 0, False

    def add(line: int, blocks: int) -> None:
        """Count blocks without motion; the first one too many is a problem."""
        nonlocal count
        if count <= ahead < count + blocks and not ended:
            what = f"more than {ahead} block{'s' * (ahead != 1)} without motion between two motions within CUTCOM"
            problems.append(_problem(program, motion, line, what))
        count += blocks

    for event in (*operation.events, Event(rows, 0)):
        for row in range(next_row, event.row) if side != "OFF" and not ended else ():
            if across[row] > 0:
                count, under_way = 0, True
            elif across[row] < 0 and under_way and row < last[row]:
                add(int(operation.moves.line[row]), 1)
        next_row = max(next_row, event.row)
        if isinstance(event, CutterComp):
            if side != "OFF" and event in idle:
                ended, count = under_way, count + int(control.own_blocks)
                continue
            if ended and event.side != "OFF":
                count += int(control.own_blocks)
                if count > ahead and event.row <= last[event.row]:
                    wording = Wording("CTL240", "sides_at_once", side=event.side, control=control.name)
                    problems.append(Problem(program.file_of(motion.operation), event.line, wording))
                side, ended = event.side, False
                continue
            if event.side == "OFF" or side == "OFF":
                side, count, under_way = event.side, 0, False
                continue
            side = event.side
        # Before the first motion and behind the last one there is no corner.
        if side == "OFF" or not under_way or event.row in ends or event.row > last[event.row]:
            continue
        if isinstance(event, Stop) and not control.stops_in_compensation and not ended:
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


def _ends_without_motion(operation: Operation, sides: Sequence[CutterComp]) -> frozenset[CutterComp]:
    """Return each CUTCOM/OFF behind which nothing moves before CUTCOM begins again, with blocks skipped or not."""
    moves = operation.moves
    moving = np.abs(np.diff(moves.tip, axis=0, prepend=moves.tip[:1])).max(axis=1, initial=0.0) > _NOT_PRINTED
    moving |= moves.kind == Kind.ARC
    skips = [(event.row, event.on) for event in operation.events if isinstance(event, BlockSkip)]
    for (row, on), (end, _) in zip(skips, [*skips[1:], (len(moves), False)], strict=False):
        moving[row:end] &= not on
    begins, found = len(moves) + 1, list[CutterComp]()
    for event in reversed(sides):
        if event.side != "OFF":
            begins = event.row
        elif begins <= len(moves) and not moving[event.row : begins].any():
            found.append(event)
    return frozenset(found)


def _last_row_across(across: Ints, offs: Iterable[int]) -> Ints:
    """For each row (n,) the last one before the next of some rows that moves across the tool; -1 if there is none."""
    last = np.full(len(across), -1)
    first = 0
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
