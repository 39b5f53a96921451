"""Which rows of a run have a tip that the program determines.

A position of the machine's slides is one of the part only where the workpiece zero and the tool length are known.
Without them the tip is known once X, Y and Z have been programmed in workpiece coordinates, and no longer after motion
to positions of the machine, after the rotary axes have turned without TCP, or after a retract over an unknown travel.
"""

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.machines import Mount
from trunnion.model.run import NO_OFFSET, ProgrammedWord, Run

_XYZ = (ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z)

#: Rotary positions within this, degrees, are the same.
_SAME_ANGLE = 1e-9

#: Events that put other coordinates in the place of those programmed so far.
_OTHER_PLANE = ("tilt", "frame", "cycle800")


def known_positions(run: Run) -> Flags:
    """(n,) bool: the tip at the end of each row follows from the program, and from what is known of the setup."""
    count = len(run)
    zero, length = run.machine.workpiece_zero is not None, run.machine.tool_length is not None
    retracted = behind_retracts(run)
    if zero and length and not retracted.any():
        return np.ones(count, np.bool_)
    heads = any(axis.is_rotary and axis.mount is Mount.TOOL for axis in run.machine.own_axes)
    programmed = (run.programmed & sum(_XYZ)) != 0
    tip_programmed = run.state.xyz_is_tip.column()
    upright = _upright(run)
    before = np.concatenate((run.start[None, list(run.machine.rotary)], run.rotary[:-1]))
    turns = (np.abs(run.rotary - before) > _SAME_ANGLE).any(axis=1)
    # Slide positions of turned axes lead to a tip only through the zero, and through the length where heads turn.
    through_setup = zero and not heads
    meaningful = tip_programmed | upright | through_setup
    leaves = np.zeros(count, np.bool_)
    leaves[[event.before_row for event in run.events if event.kind == "leave" and event.before_row < count]] = True
    of_machine = run.machine_frame | (run.work_offset == NO_OFFSET)
    lost_at = programmed & (of_machine | ~meaningful) & ~leaves
    lost_before = (turns & ~tip_programmed & (not through_setup)) | retracted
    # Twice the row, and one more where the row's own words are lost too.
    lost = np.maximum(2 * _latest(lost_before), 2 * _latest(lost_at) + 1)
    counts = meaningful & ~of_machine & ~leaves
    axes = [2 * _latest(counts & ((run.programmed & word) != 0)) for word in _XYZ]
    latest_of_all = np.minimum.reduce(axes)
    lost = np.maximum(lost, _lost_in_other_planes(run, lost, latest_of_all, upright))
    return np.asarray((latest_of_all >= lost) & (latest_of_all >= 0))


def behind_retracts(run: Run) -> Flags:
    """(n,) bool: rows right behind a retract of which no row tells (M242 where the travel of Z is not known)."""
    found = np.zeros(len(run), np.bool_)
    found[[event.before_row for event in run.events if event.kind == "retract" and event.before_row < len(run)]] = True
    return found & ~run.machine_frame


def _lost_in_other_planes(run: Run, lost: Ints, latest_of_all: Ints, upright: Flags) -> Ints:
    """(n,): twice the latest row at which the plane changed while not all of X, Y and Z were known."""
    found = np.full(len(run), -1)
    changes = {event.before_row for event in run.events if event.kind in _OTHER_PLANE}
    changes |= {int(row) for row in run.state.xyz_is_tip.rows[1:] if row < len(run) and not upright[row - 1]}
    last = -1
    for row in sorted(row for row in changes if 0 < row < len(run)):
        if latest_of_all[row - 1] < max(int(lost[row - 1]), last) or latest_of_all[row - 1] < 0:
            found[row] = last = 2 * row
    return np.asarray(np.maximum.accumulate(found))


def _upright(run: Run) -> Flags:
    """(n,) bool: both rotary axes are at zero, or at whole turns from it."""
    return np.asarray((np.abs((run.rotary + 180.0) % 360.0 - 180.0) < _SAME_ANGLE).all(axis=1))


def _latest(flags: Flags) -> Ints:
    """(n,): the latest True up to each row, -1 before the first."""
    return np.asarray(np.maximum.accumulate(np.where(flags, np.arange(len(flags)), -1)))
