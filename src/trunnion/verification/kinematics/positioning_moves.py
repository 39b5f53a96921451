"""Motions that position the machine and go to no CL point.

In:     a run.
Out:    rows, increasing, or flags of consecutive rows.
"""

import numpy as np

from trunnion.arrays import Codes, Flags, Ints
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.row_ranges import RowRanges, chunk_bounds

#: Words that position the tip or the tool axis.
POSITION_WORDS = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR

#: Words that turn rotary axes.
ROTARY_WORDS = ProgrammedWord.FIRST | ProgrammedWord.SECOND

#: How far a motion may deviate from the tool axis and still be along it, mm; and how much the axis may change.
_STRAIGHT = 1e-6
_SAME_AXIS = 1e-9


def rotary_positioning_flags(run: Run, start: int, end: int) -> Flags:
    """Which of consecutive rows only position rotary axes, at rapid with TCP off, (end - start,) bool."""
    turns = _turns_only(run.programmed[start:end])
    return np.asarray(turns & ~run.state.tcp.part(start, end) & (run.kind[start:end] == Kind.RAPID))


def only_positions_rotary_axes(run: Run, rows: Ints) -> Flags:
    """As ``rotary_positioning_flags`` for rows in any order, (k,) bool."""
    turns = _turns_only(run.programmed[rows])
    return np.asarray(turns & ~run.state.tcp.at(rows) & (run.kind[rows] == Kind.RAPID))


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
    rows = np.unique(np.array(announced, np.int64))
    rows = rows[(rows > 0) & (rows + 1 < len(run))]
    rows = rows[run.state.machine_frame.at(rows + 1) & (run.kind[rows] == Kind.RAPID)]
    before, after = run.positions(rows - 1), run.positions(rows)
    step = after.tip - before.tip
    out = np.einsum("ij,ij->i", step, after.axis)
    aside = np.abs(step - out[:, None] * after.axis).max(axis=1, initial=0.0)
    same_axis = np.abs(after.axis - before.axis).max(axis=1, initial=0.0) < _SAME_AXIS
    return np.asarray(rows[(out > 0.0) & (aside < _STRAIGHT) & same_axis])


def comes_from_home(run: Run, row: int) -> bool:
    """Whether a row begins at a machine position, so that nothing says how high above the part.

    Rotary axes may turn in between.
    """
    before = row - 1
    while (
        before >= 0 and not run.state.machine_frame[before] and bool(_turns_only(run.programmed[before : before + 1]))
    ):
        before -= 1
    return before < 0 or bool(run.state.machine_frame[before])


def approach_rows(run: Run) -> Ints:
    """Rows that are the first leg of an approach: X and Y at rapid, with Z alone in the next block.

    The tool was retracted before, or comes from a machine position. How high it is then is not known where the
    machine's travel is not known.
    """
    starts = {event.before_row for event in run.events if event.kind == "retract"}
    starts.update(row for row in run.state.machine_frame.rows_changing_to(False) if row > 0)
    rows = RowRanges.from_flags(
        (first, _positions(run.programmed[first:end]) & ~run.state.machine_frame.part(first, end))
        for first, end in chunk_bounds(len(run))
    )
    following = {rows.count_before(start) for start in starts}
    found = []
    for row in (rows[k] for k in sorted(following) if k < len(rows)):
        if row + 1 >= len(run) or (run.kind[row : row + 2] != Kind.RAPID).any() or run.state.machine_frame[row + 1]:
            continue
        if run.state.tcp[row] and int(run.programmed[row]) & int(ROTARY_WORDS):
            continue
        across, along = (int(bits) & int(POSITION_WORDS) for bits in run.programmed[row : row + 2])
        if not across & ~int(ProgrammedWord.X | ProgrammedWord.Y) and along == int(ProgrammedWord.Z):
            found.append(row)
    return np.array(found, np.int64)
