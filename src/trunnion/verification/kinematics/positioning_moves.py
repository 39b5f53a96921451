"""Motions that position the machine and go to no CL point.

In:     a run.
Out:    rows, increasing, or flags of consecutive rows.
"""

from bisect import bisect_right
from collections.abc import Iterable, Iterator
from weakref import WeakKeyDictionary

import numpy as np

from trunnion.arrays import Codes, Flags, Ints, distinct
from trunnion.model.programmed_words import POSITION_WORDS, ROTARY_WORDS, names_no_axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.row_ranges import CHUNK

#: How far a motion may deviate from the tool axis and still be along it, mm; and how much the axis may change.
_STRAIGHT = 1e-6
_SAME_AXIS = 1e-9

#: A linear axis has arrived within this, mm: positions in a plane are rounded. Another one is as near to home as
#: this, mm, or on its way: the tool may be longer or shorter than the one that the program was posted for.
_ARRIVED = 0.01
_FROM_HOME = 200.0

#: Axes that move by less than this, mm or degrees, stand still.
_STILL = 1e-9

#: Events of planes, whose blocks may turn rotary axes.
_PLANES = ("plane", "tilt", "cycle800")

#: Rows that are searched at first.
_FEW = 64


def oriented_by_vector(run: Run) -> Flags:
    """Rows whose tool axis comes from a programmed vector, their own or the last before them, (n,) bool."""
    by_vector = np.asarray((run.programmed & int(ProgrammedWord.VECTOR)) != 0)
    if not by_vector.any():
        return by_vector
    orients = by_vector | ((run.programmed & int(ROTARY_WORDS)) != 0)
    last = np.maximum.accumulate(np.where(orients, np.arange(len(run)), 0))
    # What turns rotary axes without words of theirs, as home positions and planes do, ends it too.
    return np.asarray(by_vector[last] & (run.rotary == run.rotary[last]).all(axis=1))


def rotary_positioning_flags(run: Run, start: int, end: int) -> Flags:
    """Which of consecutive rows only position rotary axes, with TCP and M114 off, (end - start,) bool.

    At rapid, or at a feed from home or in a block that turns to a plane: nothing is cut there.
    """
    turns = _turns_only(run.programmed[start:end])
    if not turns.any():
        return turns
    turns = turns & ~run.state.follows(start, end)
    return np.asarray(turns & ((run.kind[start:end] == Kind.RAPID) | _at_feed(run, np.arange(start, end), turns)))


def only_positions_rotary_axes(run: Run, rows: Ints) -> Flags:
    """As ``rotary_positioning_flags`` for rows in any order, (k,) bool."""
    turns = _turns_only(run.programmed[rows]) & ~run.state.follows_at(rows)
    return np.asarray(turns & ((run.kind[rows] == Kind.RAPID) | _at_feed(run, rows, turns)))


def _at_feed(run: Run, rows: Ints, turns: Flags) -> Flags:
    """Which of the rows (k,) that ``turns`` (k,) are at a feed that cuts nothing."""
    at_feed = np.asarray(turns & (run.kind[rows] == Kind.LINEAR))
    if at_feed.any():
        at_feed[at_feed] = np.isin(rows[at_feed], _turns_at_feed(run))
    return at_feed


def _turns_at_feed(run: Run) -> Ints:
    """Rows that turn rotary axes alone at a feed, from home, behind a retract or in the block of a plane."""
    found = _feed_turns.get(run)
    if found is None:
        alone = _turns_only(run.programmed)
        rows = np.flatnonzero(alone & (run.kind == Kind.LINEAR))
        before = np.maximum.accumulate(np.where(alone & ~run.machine_frame, -1, np.arange(len(run))))[rows]
        retracts = np.sort(np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64))
        retracted = np.searchsorted(retracts, before, "right") < np.searchsorted(retracts, rows, "right")
        planes = {(event.before_row, event.line) for event in run.events if event.kind in _PLANES}
        to_plane = np.array([(row, int(run.lines[row])) in planes for row in rows.tolist()], np.bool_)
        found = rows[to_plane | (before < 0) | run.machine_frame[before] | retracted]
        _feed_turns[run] = found
    return found


#: Kept as long as the runs.
_feed_turns: WeakKeyDictionary[Run, Ints] = WeakKeyDictionary()


def _turns_only(programmed: Codes) -> Flags:
    return np.asarray(~_positions(programmed) & ((programmed & int(ROTARY_WORDS)) != 0))


def _positions(programmed: Codes) -> Flags:
    return np.asarray((programmed & int(POSITION_WORDS)) != 0)


def tool_axis_exit_rows(run: Run) -> Ints:
    """Rows in which the tool leaves the part by a distance along its own axis.

    Such a row goes straight out at rapid, and the next one goes to a machine position.
    """
    announced = [event.before_row for event in run.events if event.kind == "leave"]
    if not announced:
        return np.zeros(0, np.int64)
    rows = distinct(np.array(announced, np.int64))
    rows = rows[(rows > 0) & (rows + 1 < len(run))]
    rows = rows[run.state.machine_frame.at(rows + 1) & (run.kind[rows] == Kind.RAPID)]
    before, after = run.positions(rows - 1), run.positions(rows)
    step = after.tip - before.tip
    out = np.einsum("ij,ij->i", step, after.axis)
    aside = np.abs(step - out[:, None] * after.axis).max(axis=1, initial=0.0)
    same_axis = np.abs(after.axis - before.axis).max(axis=1, initial=0.0) < _SAME_AXIS
    return np.asarray(rows[(out > 0.0) & (aside < _STRAIGHT) & same_axis])


def stands_still(run: Run, rows: Ints) -> Flags:
    """Which rows repeat the position before them, (k,) bool; an arc goes round to it.

    From a machine position to one of the workpiece the distance is not known: no such row stands still.
    """
    still = np.zeros(len(rows), np.bool_)
    maybe = np.flatnonzero((run.kind[rows] != Kind.ARC) & (rows > 0))
    maybe = maybe[~MachinePositions.of(run).crossed(rows[maybe])]
    if len(maybe):
        way = run.positions(rows[maybe]).joints - run.positions(rows[maybe] - 1).joints
        still[maybe] = (np.abs(way) < _STILL).all(axis=1)
    return still


def repeats_position(run: Run, rows: Ints) -> Flags:
    """Which rows stand still and state no axis that the row before them does not, (k,) bool.

    Behind a way home another axis may move, though its number is the one from before.
    """
    words = int(POSITION_WORDS | ROTARY_WORDS)
    new = run.programmed[rows] & ~run.programmed[np.maximum(rows - 1, 0)] & words
    return np.asarray(stands_still(run, rows) & (new == 0))


def comes_from_home(run: Run, row: int) -> bool:
    """Whether a row begins at a machine position or behind a retract, so that nothing says how high above the part.

    Rotary axes may turn in between.
    """
    before = row - 1
    while (
        before >= 0 and not run.state.machine_frame[before] and bool(_turns_only(run.programmed[before : before + 1]))
    ):
        before -= 1
    if before < 0 or run.state.machine_frame[before]:
        return True
    first, end = (bisect_right(run.events, each, key=lambda event: event.before_row) for each in (before, row))
    return any(run.events[k].kind == "retract" for k in range(first, end))


def approach_rows(run: Run) -> Ints:
    """Rows that are the first leg of an approach: X and Y at rapid, with Z alone in the next block, or down in a cycle.

    Where a head tilts the tool in a plane, it is a leg of linear axes (``is_leg_of_axes``).

    The tool was retracted before, comes from a machine position, or is where the operator has left it: a program may
    begin so. How high it is then is not known where the machine's travel is not known. A leg may be repeated, and X
    and Y may go one after the other.
    """
    starts = {0, *(event.before_row for event in run.events if event.kind == "retract")}
    starts.update(row for row in run.state.machine_frame.rows_changing_to(False) if row > 0)
    found: list[int] = []
    for row in _rows_that_follow(run, starts):
        after = _behind_repeats(run, row + 1)
        across = int(run.programmed[row]) & int(POSITION_WORDS)
        if after < len(run) and _is_other_half(run, after, across):
            across |= int(run.programmed[after]) & int(POSITION_WORDS)
            after = _behind_repeats(run, after + 1)
        legs = np.array([row, after])
        if after >= len(run) or (run.kind[legs] != Kind.RAPID).any() or run.state.machine_frame[after]:
            continue
        if run.state.follows_at(np.array([row]))[0] and int(run.programmed[row]) & int(ROTARY_WORDS):
            continue
        along = int(run.programmed[after]) & int(POSITION_WORDS)
        by_cycle = bool(names_no_axis(run.programmed[after : after + 1])[0])
        comes_down = along == int(ProgrammedWord.Z) or by_cycle
        x_and_y = not across & ~int(ProgrammedWord.X | ProgrammedWord.Y)
        if (x_and_y and comes_down) or is_leg_of_axes(run, row):
            found += range(row, after)
    return np.array(found, np.int64)


def _behind_repeats(run: Run, row: int) -> int:
    while row < len(run) and repeats_position(run, np.array([row]))[0]:
        row += 1
    return row


def _is_other_half(run: Run, row: int, stated: int) -> bool:
    """Whether a row states the one of X and Y, at rapid, where the row before states the other alone."""
    halves = {int(ProgrammedWord.X), int(ProgrammedWord.Y)}
    words = int(run.programmed[row])
    other = {words & int(POSITION_WORDS), stated} == halves
    turns = bool(words & int(ROTARY_WORDS))
    return other and not turns and run.kind[row] == Kind.RAPID and not run.state.machine_frame[row]


def is_leg_of_axes(run: Run, row: int) -> bool:
    """Whether a motion in a plane of a tilted head brings some linear axes to where the next one needs them.

    The others stay near home, or go on to where the next one leads. That is known with zero and tool length.
    """
    machine, columns = run.machine_at(row), list(run.machine.linear)
    if machine.workpiece_zero is None or machine.tool_length is None or run.state.plane[row] < 0:
        return False
    if not machine.has_rotary_head:
        return False
    joints = run.positions(np.array([row - 1, row, row + 1])).joints[:, columns]
    begin, end, following = joints
    way, rest = end - begin, following - end
    arrives, stays = np.abs(rest) <= _ARRIVED, (np.abs(way) <= _FROM_HOME) | (way * rest >= 0.0)
    return bool((arrives | stays).all() and arrives.any() and not arrives.all())


def _rows_that_follow(run: Run, starts: Iterable[int]) -> Iterator[int]:
    """Yield the first row from each start on that goes to a position in workpiece coordinates: each once, ascending."""
    row = -1
    for start in sorted(starts):
        if row >= start:
            continue
        found = first_workpiece_position(run, start, len(run))
        if found is None:
            return
        row = found
        yield row


def first_workpiece_position(run: Run, first: int, end: int) -> int | None:
    """Return the first of the rows ``first`` to ``end`` (exclusive) that goes to a position in workpiece
    coordinates.
    """
    count = _FEW
    while first < end:
        stop = min(first + count, end)
        goes = _positions(run.programmed[first:stop]) & ~run.state.machine_frame.part(first, stop)
        if goes.any():
            return first + int(np.argmax(goes))
        first, count = stop, min(2 * count, CHUNK)
    return None
